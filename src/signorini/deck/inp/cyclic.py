# SPDX-License-Identifier: BSD-3-Clause
"""``*CYCLIC SYMMETRY MODEL`` and the ``*TIE, CYCLIC SYMMETRY`` between the sides of its sector."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.deck.inp.card import Card
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.known import Known
from signorini.deck.inp.surfaces import DeckSurface
from signorini.errors import InputError, one_of
from signorini.model.links import CyclicSymmetry

TIED_SIDES = "CYCLIC SYMMETRY"
"""Parameter of a ``*TIE`` between the sides of a sector, which are no surfaces that touch."""


def make_cyclic(cards: Sequence[Card], known: Known) -> list[tuple[CyclicSymmetry, Card]]:
    """Read all ``*CYCLIC SYMMETRY MODEL`` keywords, each with the card that errors name."""
    ties = {card.get("NAME").upper(): card for card in of_keyword(cards, "TIE") if TIED_SIDES in card.parameters}
    found = []
    for card in of_keyword(cards, "CYCLIC SYMMETRY MODEL"):
        card.refuse_unknown(("N", "TIE"), ("NGRAPH", "ELSET", "NAME"))
        if not ties:
            raise card.error("has no *TIE, CYCLIC SYMMETRY; expected one between the sides of the sector")
        name = card.get("TIE").upper() or next(iter(ties))
        if name not in ties:
            raise card.error(one_of(card.get("TIE"), ties, "*TIE, CYCLIC SYMMETRY"))
        row = card.row("two points of the axis")
        ends = np.array([row.number(i, "a coordinate") for i in range(6)]).reshape(2, 3)
        axis = ends[1] - ends[0]
        if not axis.any():
            raise row.error("has one point twice; expected two points of the axis")
        if known.dimension == 2 and axis[:2].any():
            raise row.error("has an axis that is not along z; expected one across the plane")
        first, second = _sides(ties[name], known)
        try:
            symmetry = CyclicSymmetry(
                first,
                second,
                sectors=_sectors(card),
                point=tuple(ends[0, : known.dimension].tolist()),
                axis=tuple(axis.tolist()),
            )
        except InputError as error:
            raise card.error(str(error)) from error
        found.append((symmetry, card))
    return found


def _sectors(card: Card) -> int:
    word = card.value("N", "the number of sectors")
    try:
        return int(word)
    except ValueError as error:
        raise card.error(f"N is '{word}'; expected a whole number of sectors, of which all are there") from error


def _sides(card: Card, known: Known) -> tuple[str, str]:
    """Node sets of both sides."""
    row = card.row("the two sides of the sector")
    one, other = (known.surfaces.find(row.text(i, "a surface"), row) for i in (0, 1))
    return _place(one, known), _place(other, known)


def _place(side: DeckSurface, known: Known) -> str:
    """The boundary of a side, or a node set where faces do not hold just its nodes."""
    whole = np.array_equal(side.faces.nodes(side.keys), side.nodes)
    names = known.places.at_faces(side.keys, side.name) if whole else []
    return names[0] if len(names) == 1 else known.places.at_nodes(side.nodes, side.name)
