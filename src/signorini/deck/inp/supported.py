# SPDX-License-Identifier: BSD-3-Clause
"""What would change the answer is never left out in silence."""

from __future__ import annotations

from collections.abc import Sequence

from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.keywords import HARMLESS, MODEL_WORDS, PRINTED, STEP_WORDS


def refuse_unsupported(placed: Sequence[Placed], known: Sequence[str], where: str) -> dict[str, int]:
    """Stop at the first keyword that changes the answer and is not read.

    Parameters
    ----------
    known : keywords that are read here
    where : words for the place, as "in a step"

    Returns
    -------
    Keywords that are left out and the line of the first of each

    Raises
    ------
    DeckError
        With the line of the keyword.
    """
    ignored: dict[str, int] = {}
    for item in placed:
        keyword = item.card.keyword
        if keyword in PRINTED:
            continue
        if keyword in HARMLESS:
            ignored.setdefault(keyword, item.card.line)
        elif keyword not in known:
            elsewhere = keyword in MODEL_WORDS or keyword in STEP_WORDS
            what = f"is not supported {where}" if elsewhere else "is not supported, and it may change the answer"
            raise item.card.error(what)
    return ignored
