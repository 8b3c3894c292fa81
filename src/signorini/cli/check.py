# SPDX-License-Identifier: BSD-3-Clause
"""``signorini check``: what would be solved, and what looks wrong; solves nothing."""

from __future__ import annotations

import argparse
import json

from signorini.cli.reading import load_deck
from signorini.errors import InputError


def check(options: argparse.Namespace) -> int:
    """Print a deck as it was understood, and notes on it; 0 unless something is wrong."""
    deck = load_deck(options)
    from signorini.cli.check_json import described
    from signorini.cli.check_text import all_notes, describe  # everything heavy: a wrong deck never waits for it
    from signorini.engine.prepare import examine

    try:
        examined = examine(deck.model)
    except InputError as error:
        raise deck.locate(error) from error
    words = ""
    if options.wellposed:
        from signorini.engine.prepare import prepare
        from signorini.engine.wellposed import assess

        words = assess(prepare(deck.model)).words
    if options.json:
        found = described(deck, examined, all_notes(deck, examined))
        print(json.dumps(found | ({"uniqueness": words} if words else {}), indent=1))
    elif not options.quiet:
        print("\n".join(describe(deck, examined)))
        if words:
            print(f"\nuniqueness\n  {words}")
    return 0
