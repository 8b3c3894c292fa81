# SPDX-License-Identifier: BSD-3-Clause
"""``signorini convert``: any deck as TOML, with its mesh beside it."""

from __future__ import annotations

import argparse
from pathlib import Path

from signorini.cli.reading import load_deck
from signorini.errors import InputError


def convert(options: argparse.Namespace) -> int:
    """Read a deck and write it anew."""
    target = Path(options.output) if options.output else Path(options.deck).with_suffix(".toml")
    if target.suffix.lower() != ".toml":
        raise InputError(f"is '{target}'; expected a name that ends in .toml", where=("-o",))
    if not target.absolute().parent.is_dir():
        raise InputError(f"there is no folder '{target.parent}'", where=("-o",))
    deck = load_deck(options)
    if target.resolve() == Path(options.deck).resolve():
        raise InputError("would replace the deck itself; expected another name", where=("-o",))
    from signorini.deck.write import write_deck

    try:
        files = write_deck(deck.model, target)
    except OSError as error:
        raise InputError(f"cannot write '{target}': {error.strerror}", where=("-o",)) from error
    for note in deck.notes:
        print(f"deck: {note}")
    print(*files, sep="\n")
    return 0
