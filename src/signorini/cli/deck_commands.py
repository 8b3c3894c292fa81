# SPDX-License-Identifier: BSD-3-Clause
"""Commands that read a deck, ``signorini run``, ``check`` and others: a wrong one waits for no heavy imports."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from signorini._version import __version__
from signorini.cli.progress import open_log, progress
from signorini.deck import Deck, load_deck
from signorini.errors import InputError

_DRAWN = "asks for natural modes of bodies as they are drawn"  # which may be free


def run(options: argparse.Namespace) -> int:
    """Read, solve, write, print; 0 if solved and certified, 3 if not."""
    started = time.perf_counter()
    log = open_log(options.log, f"signorini {__version__} run {options.deck}")
    with progress(quiet=options.quiet or options.json, log=log) as clock, clock.phase("read"):
        deck = _load(options)
    if deck.modes is not None and not deck.modes.preload:
        raise InputError(f"'{deck.path}' {_DRAWN}: use 'signorini modes'")
    from signorini.engine.first_run import helped

    with helped(deck.model):
        from signorini.cli.run_deck import run_deck

        return run_deck(deck, options, clock, started, log)


def modes(options: argparse.Namespace) -> int:
    """Read, solve the steps, find natural modes, write, print; 0 if certified, 3 if not."""
    started = time.perf_counter()
    log = open_log(options.log, f"signorini {__version__} modes {options.deck}")
    deck = _load(options)
    from signorini.engine.first_run import helped

    with helped(deck.model), progress(quiet=options.quiet, log=log) as clock:
        from signorini.cli.run_modes import run_modes

        return run_modes(deck, options, clock, started)


def sensitivities(options: argparse.Namespace) -> int:
    """Read, solve, print the main answers by all that is given; 0 if that is known."""
    deck = _load(options)
    from signorini.engine.first_run import helped

    with helped(deck.model), progress(quiet=options.json) as clock:
        from signorini.cli.run_sensitivities import run_sensitivities

        return run_sensitivities(deck, options, clock)


def check(options: argparse.Namespace) -> int:
    """Print a deck as it was understood, and notes on it; 0 unless something is wrong. Solves nothing."""
    deck = _load(options)
    from signorini.engine.examine import examine
    from signorini.inspection.data import deck_data
    from signorini.inspection.text import all_notes, deck_text

    try:
        examined = examine(deck.model)
    except InputError as error:
        if deck.modes is not None and not deck.modes.preload:
            raise InputError(f"'{deck.path}' {_DRAWN}: 'signorini modes' checks them too") from error
        raise deck.locate(error) from error
    words = ""
    if options.wellposed:
        from signorini.engine.prepare import prepare
        from signorini.engine.wellposed import assess

        words = assess(prepare(deck.model)).words
    if options.json:
        found = deck_data(deck, examined, all_notes(deck, examined))
        print(json.dumps(found | ({"uniqueness": words} if words else {}), indent=1))
    elif not options.quiet:
        print("\n".join(deck_text(deck, examined)))
        if words:
            print(f"\nuniqueness\n  {words}")
    return 0


def convert(options: argparse.Namespace) -> int:
    """Read any deck and write it as TOML, with its mesh beside it."""
    target = Path(options.output) if options.output else Path(options.deck).with_suffix(".toml")
    if target.suffix.lower() != ".toml":
        raise InputError(f"is '{target}'; expected a name that ends in .toml", where=("-o",))
    if not target.absolute().parent.is_dir():
        raise InputError(f"there is no folder '{target.parent}'", where=("-o",))
    deck = _load(options)
    if target.resolve() == Path(options.deck).resolve():
        raise InputError("would replace the deck itself; expected another name", where=("-o",))
    from signorini.deck.write import write_deck

    try:
        files = write_deck(deck.model, target, deck.modes)
    except OSError as error:
        raise InputError(f"cannot write '{target}': {error.strerror}", where=("-o",)) from error
    for note in deck.notes:
        print(f"deck: {note}")
    print(*files, sep="\n")
    return 0


def _load(options: argparse.Namespace) -> Deck:
    """Read ``options.deck`` as the options say."""
    deck = load_deck(
        options.deck,
        small_strain=options.small_strain,
        deck_increments=options.increments == "deck",
        allow=options.allow,
        include=options.include,
    )
    if options.fatigue is None:
        return deck
    from signorini.deck.fatigue import asking_for

    return asking_for(deck, Path(options.fatigue))
