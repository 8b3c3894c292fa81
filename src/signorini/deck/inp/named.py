# SPDX-License-Identifier: BSD-3-Clause
"""What a keyword begins under a name, and the keywords behind it say more of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from signorini.deck.inp.card import Card
from signorini.deck.inp.flatten import Placed

Named = TypeVar("Named")


def gathered(
    placed: list[Placed],
    opening: str,
    words: Sequence[str],
    begun: Callable[[Card], Named],
    extended: Callable[[Named, Card], Named],
) -> dict[str, Named]:
    """All that a keyword begins, by name in capitals.

    Parameters
    ----------
    opening : the keyword, with a NAME
    words : keywords that belong to the last one before them
    begun : what the keyword alone says
    extended : what it says with one of the words

    Raises
    ------
    DeckError
        Where a name is given twice, or a word stands before anything that it could belong to.
    """
    found: dict[str, Named] = {}
    current = ""
    for item in placed:
        card = item.card
        if card.keyword == opening:
            first, current = begun(card), card.value("NAME").upper()
            if current in found:
                raise card.error(f"there is another {opening.lower()} '{card.value('NAME')}'")
            found[current] = first
        elif card.keyword in words:
            if not current:
                raise card.error(f"stands before any *{opening}")
            found[current] = extended(found[current], card)
    return found
