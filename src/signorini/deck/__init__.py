# SPDX-License-Identifier: BSD-3-Clause
"""Decks: a model as a TOML file, and every mistake in it with its line."""

from signorini.deck.deck import Deck
from signorini.deck.error import DeckError
from signorini.deck.load import load_deck, read

__all__ = ["Deck", "DeckError", "load_deck", "read"]
