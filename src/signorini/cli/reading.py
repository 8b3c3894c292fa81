# SPDX-License-Identifier: BSD-3-Clause
"""The deck that the command line names, read as its options say."""

from __future__ import annotations

import argparse

from signorini.deck import Deck, load


def load_deck(options: argparse.Namespace) -> Deck:
    """Read ``options.deck``."""
    return load(
        options.deck,
        small_strain=options.small_strain,
        deck_increments=options.increments == "deck",
        allow=options.allow,
    )
