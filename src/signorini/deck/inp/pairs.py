# SPDX-License-Identifier: BSD-3-Clause
"""Contact pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.card import Card, Row, to_number
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.interactions import Interaction
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.surfaces import ElementFaces, Surfaces
from signorini.errors import one_of
from signorini.model.contact import Contact

_TYPES = ("", "NODE TO SURFACE", "SURFACE TO SURFACE", "MORTAR", "LINMORTAR", "PGLINMORTAR", "MASSLESS")
IGNORED = (
    "SMALL SLIDING",
    "EXTENSION ZONE",
    "MECHANICAL CONSTRAINT",
    "TRACKING",
    "SUPPLEMENTARY CONSTRAINTS",
    "CPSET",
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """A contact, the keyword that it comes from, at its line, and the name of its law in capitals."""

    contact: Contact
    card: Card
    interaction: str = ""


def make_contacts(
    placed: list[Placed], interactions: Mapping[str, Interaction], surfaces: Surfaces, nodes: Sets, edges: ElementFaces
) -> list[Pair]:
    """Read all ``*CONTACT PAIR`` keywords: the slave side is nonmortar.

    Raises
    ------
    DeckError
        For an unknown surface or interaction, or a surface without edges.
    """
    clearances = _clearances(placed, surfaces)
    found: list[Pair] = []
    for item in placed:
        card = item.card
        if card.keyword != "CONTACT PAIR":
            continue
        card.refuse_unknown(("INTERACTION", "TYPE", "ADJUST"), IGNORED)
        card.choice("TYPE", _TYPES, "")
        name = card.value("INTERACTION")
        if name.upper() not in interactions:
            known = [law.card.value("NAME") for law in interactions.values()]
            raise card.error(one_of(name, known, "surface interaction"))
        law = interactions[name.upper()]
        card.row("the slave and the master surface")
        for row in card.rows():
            slave, master = (_side(item, row, i, surfaces, edges, nodes) for i in (0, 1))
            faces = edges.ends[surfaces.keys[slave.upper()]]
            given = _adjusted(card, nodes, item, distinct(faces[faces >= 0]))
            if (slave, master) in clearances:
                given = {"gap": clearances[slave, master][0]}
            contact = Contact(
                slave,
                master,
                friction="tied" if law.tied else law.friction,
                normal_compliance=0.0 if law.tied else law.normal_compliance,
                tangential_compliance=0.0 if law.tied else law.tangential_compliance,
                shear_limit=None if law.tied else law.shear_limit,
                name=_label(slave, master, found),
                **given,
            )
            found.append(Pair(contact=contact, card=card.at(row), interaction=name.upper()))
    sides = {(pair.contact.nonmortar, pair.contact.mortar) for pair in found}
    for (slave, master), (_, card) in clearances.items():
        if (slave, master) not in sides:
            raise card.error(f"there is no contact pair of '{slave}' and '{master}'")
    return found


def make_ties(
    placed: list[Placed], surfaces: Surfaces, nodes: Sets, edges: ElementFaces, contacts: Sequence[Pair]
) -> list[Pair]:
    """Read all ``*TIE`` keywords: surfaces that neither slip nor open; initial gaps count as filled.

    Raises
    ------
    DeckError
        For an unknown surface, or what is not tied by its edges.
    """
    found: list[Pair] = []
    for item in placed:
        card = item.card
        if card.keyword != "TIE":
            continue
        card.refuse_unknown(("NAME", "POSITION TOLERANCE", "ADJUST"), ("TYPE", "CONSTRAINT RATIO"))
        given: dict[str, Any] = {}
        if "POSITION TOLERANCE" in card.parameters:
            reach = to_number(card.value("POSITION TOLERANCE", "a distance"))
            if reach is None or not reach > 0.0:
                raise card.error("POSITION TOLERANCE: expected a distance > 0")
            given["search"] = reach
        card.row("the slave and the master surface")
        for row in card.rows():
            slave, master = (_side(item, row, i, surfaces, edges, nodes) for i in (0, 1))
            name = _label(slave, master, [*contacts, *found])
            found.append(Pair(contact=Contact(slave, master, friction="tied", name=name, **given), card=card.at(row)))
    return found


def _label(slave: str, master: str, others: Sequence[Pair]) -> str:
    """The slave surface's name, or both if it has another partner too."""
    return slave if not any(other.contact.nonmortar == slave for other in others) else f"{slave} on {master}"


def _side(item: Placed, row: Row, i: int, surfaces: Surfaces, edges: ElementFaces, nodes: Sets) -> str:
    name = surfaces.find(row.text(i, "a surface"), item.scope, row)
    keys = surfaces.keys[name.upper()]
    surfaces.refuse_bare(name, edges, nodes, row)
    if not len(keys):
        raise row.error(f"surface '{name}' has no edge of an element")
    if len(edges.facets(keys)) > 1:
        raise row.error(f"surface '{name}' has faces of linear and of quadratic elements; expected a pair for each")
    return name


def _adjusted(card: Card, nodes: Sets, item: Placed, slave: IntArray) -> dict[str, Any]:
    """``ADJUST``: gaps up to a distance are closed; or those of a node set, if it holds all slave nodes."""
    if "ADJUST" not in card.parameters:
        return {}
    word = card.value("ADJUST", "a distance or a node set")
    distance = to_number(word)
    if distance is None:
        name, members = nodes.find(word, item.scope, card)
        if not np.isin(slave, members).all():
            raise card.error(f"ADJUST={name} does not hold all nodes of the slave surface, which is not supported")
        return {"gap": "zero"}
    if distance < 0.0:
        raise card.error(f"ADJUST is {distance:g}; expected a distance >= 0")
    return {"adjust": distance}


def _clearances(placed: list[Placed], surfaces: Surfaces) -> dict[tuple[str, str], tuple[float, Card]]:
    """Gap of every pair of slave and master surface, and where it stands."""
    found = {}
    for item in placed:
        if item.card.keyword == "CLEARANCE":
            card = item.card
            card.refuse_unknown(("MASTER", "SLAVE", "VALUE"))
            value = to_number(card.value("VALUE", "a distance"))
            if value is None:
                raise card.error(f"VALUE is '{card.value('VALUE')}'; expected a number")
            slave, master = (surfaces.find(card.value(key), item.scope, card) for key in ("SLAVE", "MASTER"))
            found[slave, master] = value, card
    return found
