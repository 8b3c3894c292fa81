# SPDX-License-Identifier: BSD-3-Clause
"""Contact pairs, and what steps change of them: friction, and pairs that are switched off and on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from signorini.deck.error import DeckError
from signorini.deck.inp.card import Card, Row, to_number
from signorini.deck.inp.cyclic import TIED_SIDES
from signorini.deck.inp.interactions import Interaction, read_friction
from signorini.deck.inp.keywords import look_up, of_keyword
from signorini.deck.inp.known import Known
from signorini.deck.inp.surfaces import DeckSurface
from signorini.law.friction import TabularFriction
from signorini.model.contact import Contact
from signorini.model.varying import NodeValues

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


def make_contacts(cards: Sequence[Card], known: Known, *, large: bool) -> list[Pair]:
    """Read all ``*CONTACT PAIR`` keywords, whose slave side is nonmortar, and then all ``*TIE`` keywords.

    Parameters
    ----------
    cards : outside the steps
    known : surfaces and laws of contact
    large : whether a step has large displacements: pairs follow the bodies then, unless they say otherwise
    """
    clearances = _clearances(cards, known)
    found = list(_gaskets(cards, known))
    for card in of_keyword(cards, "CONTACT PAIR"):
        with known.refusals.gather():
            found += _pairs_of(card, found, known, clearances, large)
    known.refusals.stop()
    sides = {(pair.contact.nonmortar, pair.contact.mortar) for pair in found}
    for (slave_name, master_name), (_, card) in clearances.items():
        if (slave_name, master_name) not in sides:
            raise _no_pair(card, (slave_name, master_name))
    for card, slave, master, reach in _ties(cards, known):
        found.append(_pair(card, slave, master, found, None, **reach))
    return [*found, *_general(cards, known, found, large=large)]


def _gaskets(cards: Sequence[Card], known: Known) -> Iterator[Pair]:
    """Contacts for the gasket elements between two bodies."""
    if known.grid.gaskets or any(of_keyword(cards, "GASKET SECTION")):
        from signorini.deck.inp.gaskets import make_gaskets

        for contact, card in make_gaskets(cards, known):
            yield Pair(contact=contact, card=card)


def _general(cards: Sequence[Card], known: Known, others: Sequence[Pair], *, large: bool) -> Iterator[Pair]:
    """Pairs of general contact beside the others; overlaps are removed, as in Abaqus, unless the sides slide far."""
    opening = next(of_keyword(cards, "CONTACT"), None)
    if opening is None:
        return
    from signorini.deck.inp.general import find_facing

    taken = [
        (
            known.surfaces.find(pair.contact.nonmortar, pair.card).keys,
            known.surfaces.find(str(pair.contact.mortar), pair.card).keys,
        )
        for pair in others
    ]
    found = list(others)
    for facing in find_facing(opening, cards, known, taken):
        law = facing.law or Interaction(card=opening)
        follows = large and law.bond is None
        given: dict[str, Any] = {} if law.tied else {"sliding": "finite"} if follows else {"adjust": 0.0}
        found.append(_pair(opening, facing.slave, facing.master, found, law, **_compliances(law), **given))
        yield found[-1]


def _pairs_of(
    card: Card,
    before: Sequence[Pair],
    known: Known,
    clearances: Mapping[tuple[str, str], tuple[float | NodeValues, Card]],
    large: bool,
) -> list[Pair]:
    """The pairs of a ``*CONTACT PAIR``, with names that the pairs before it leave."""
    card.refuse_unknown(("INTERACTION", "TYPE", "ADJUST"), IGNORED)
    card.choice("TYPE", _TYPES, "")
    law = look_up(card, "INTERACTION", known.interactions, "surface interaction")
    found: list[Pair] = []
    for row, slave, master in _sides(card, known):
        given = _adjusted(card, slave, known)
        if (slave.name, master.name) in clearances:
            given = {"gap": clearances[slave.name, master.name][0]}
        stays = law.tied or law.bond is not None
        if large and not stays and "SMALL SLIDING" not in card.parameters:
            given["sliding"] = "finite"
        given |= _compliances(law)
        found.append(_pair(card.at(row), slave, master, [*before, *found], law, **given))
    return found


def _compliances(law: Interaction) -> dict[str, Any]:
    """What a law of contact says of its pairs besides friction; nothing of tied ones."""
    if law.tied:
        return {}
    if law.bond is not None:
        normal, along = law.bond.compliances
        if law.normal_compliance or law.tangential_compliance:
            raise law.bond.card.error(
                "stands beside another stiffness of the surface interaction; expected one of both"
            )
        rest = {"shear_limit": law.shear_limit, "closure": law.closure, "cohesion": law.bond.cohesion}
        return {"normal_compliance": normal, "tangential_compliance": along, **rest}
    return {
        "normal_compliance": law.normal_compliance,
        "tangential_compliance": law.tangential_compliance,
        "shear_limit": law.shear_limit,
        "closure": law.closure,
    }


def _ties(cards: Sequence[Card], known: Known) -> Iterator[tuple[Card, DeckSurface, DeckSurface, dict[str, Any]]]:
    """Surfaces that neither slip nor open, with how far initial gaps count as filled."""
    for card in of_keyword(cards, "TIE"):
        if TIED_SIDES in card.parameters:
            continue
        card.refuse_unknown(("NAME", "POSITION TOLERANCE", "ADJUST"), ("TYPE", "CONSTRAINT RATIO"))
        given: dict[str, Any] = {}
        if "POSITION TOLERANCE" in card.parameters:
            reach = to_number(card.value("POSITION TOLERANCE", "a distance"))
            if reach is None or not reach > 0.0:
                raise card.error("POSITION TOLERANCE: expected a distance > 0")
            given["search"] = reach
        for row, slave, master in _sides(card, known):
            yield card.at(row), slave, master, given


def _pair(
    card: Card, slave: DeckSurface, master: DeckSurface, others: Sequence[Pair], law: Interaction | None, **given: Any
) -> Pair:
    """A pair with its name: the slave surface's, or both if that has another partner too; tied without a law."""
    taken = any(other.contact.nonmortar == slave.name for other in others)
    contact = Contact(
        slave.name,
        master.name,
        friction="tied" if law is None or law.tied else law.friction,
        name=f"{slave.name} on {master.name}" if taken else slave.name,
        **given,
    )
    return Pair(contact=contact, card=card, interaction="" if law is None else law.name.upper())


def _sides(card: Card, known: Known) -> Iterator[tuple[Row, DeckSurface, DeckSurface]]:
    """Slave and master surface of every data line."""
    card.row("the slave and the master surface")
    for row in card.rows():
        slave, master = (_side(row, i, known) for i in (0, 1))
        yield row, slave, master


def _side(row: Row, i: int, known: Known) -> DeckSurface:
    surface = known.surfaces.find(row.text(i, "a surface"), row)
    surface.refuse_bare(row)
    if not len(surface.keys):
        raise row.error(f"surface '{surface.name}' has no edge of an element")
    if len(known.faces.facets(surface.keys)) > 1:
        raise row.error(
            f"surface '{surface.name}' has faces of linear and of quadratic elements; expected a pair for each"
        )
    return surface


def _adjusted(card: Card, slave: DeckSurface, known: Known) -> dict[str, Any]:
    """``ADJUST``: gaps up to a distance are closed; or those of a node set, if it holds all slave nodes."""
    if "ADJUST" not in card.parameters:
        return {}
    word = card.value("ADJUST", "a distance or a node set")
    distance = to_number(word)
    if distance is None:
        name, members = known.nodes.find(word, card)
        if not np.isin(slave.nodes, members).all():
            raise card.error(f"ADJUST={name} does not hold all nodes of the slave surface, which is not supported")
        return {"gap": "zero"}
    if distance < 0.0:
        raise card.error(f"ADJUST is {distance:g}; expected a distance >= 0")
    return {"adjust": distance}


def _clearances(cards: Sequence[Card], known: Known) -> dict[tuple[str, str], tuple[float | NodeValues, Card]]:
    """Gap of every pair of slave and master surface, and where it stands."""
    found: dict[tuple[str, str], tuple[float | NodeValues, Card]] = {}
    for card in of_keyword(cards, "CLEARANCE"):
        card.refuse_unknown(("MASTER", "SLAVE", "VALUE", "TABULAR"))
        slave, master = named_sides(card, known, "a name")
        if "TABULAR" in card.parameters:
            found[slave, master] = _clearance_table(card, known.surfaces.find(slave, card), known), card
            continue
        value = to_number(card.value("VALUE", "a distance"))
        if value is None:
            raise card.error(f"VALUE is '{card.value('VALUE')}'; expected a number")
        found[slave, master] = value, card
    return found


def _clearance_table(card: Card, slave: DeckSurface, known: Known) -> NodeValues:
    """Gaps of the nodes of a slave surface, from rows of a node or set and a distance."""
    if "VALUE" in card.parameters:
        raise card.error("has VALUE and TABULAR; expected one of them")
    card.row("a node or a node set, and a clearance")
    values = np.full(len(known.grid.points), np.nan)
    for row in card.rows():
        if len(row.fields) > 2:
            raise row.error("has a normal beside the clearance, which is not supported; expected a node and a distance")
        values[known.nodes.find(row.text(0, "a node or a node set"), row)[1]] = row.number(1, "a clearance")
    lacks = slave.nodes[np.isnan(values[slave.nodes])]
    if len(lacks):
        number = known.grid.nodes.labels[lacks[0]]
        raise card.error(f"gives node {number} of '{slave.name}' no clearance; expected one at every node there")
    return NodeValues(np.nan_to_num(values))


def named_sides(card: Card, known: Known, what: str) -> tuple[str, str]:
    """Names of the known surfaces that a card has as SLAVE and MASTER; ``what`` is expected there, in words."""
    slave, master = (known.surfaces.find(card.value(key, what), card) for key in ("SLAVE", "MASTER"))
    return slave.name, master.name


def pairs_between(pairs: Sequence[Pair], sides: tuple[str, str], at: Card | Row) -> list[int]:
    """Indices of the contacts of a slave and a master surface.

    Parameters
    ----------
    pairs : all contacts
    sides : names of the surfaces
    at : what is blamed where there is none
    """
    found = [i for i, pair in enumerate(pairs) if (pair.contact.nonmortar, pair.contact.mortar) == sides]
    if not found:
        raise _no_pair(at, sides)
    return found


def _no_pair(at: Card | Row, sides: tuple[str, str]) -> DeckError:
    return at.error(f"there is no contact pair of '{sides[0]}' and '{sides[1]}'")


def make_changes(cards: Sequence[Card], known: Known, pairs: Sequence[Pair]) -> dict[str, Any]:
    """What ``*CHANGE FRICTION``, ``*MODEL CHANGE`` and ``*CHANGE CONTACT PAIR`` change, by keys of the model's step.

    Parameters
    ----------
    cards : of the step
    known : surfaces and laws of contact
    pairs : all contacts
    """
    friction: dict[str, Any] = {}
    switched: dict[str, bool] = {}
    changed: Interaction | None = None
    for card in cards:
        if card.keyword == "CHANGE FRICTION":
            card.refuse_unknown(("INTERACTION",))
            changed = look_up(card, "INTERACTION", known.interactions, "surface interaction")
        elif card.keyword == "FRICTION":
            if changed is None:
                raise card.error("stands in a step without *CHANGE FRICTION before it")
            coefficient, compliance = read_friction(card)
            if "TAUMAX" in card.parameters or changed.shear_limit is not None:
                raise card.error("changes friction with a largest traction, which is not supported")
            if isinstance(coefficient, TabularFriction) or isinstance(changed.friction, TabularFriction):
                raise card.error("changes friction that depends on pressure, which is not supported")
            if compliance != changed.tangential_compliance:
                raise card.error("changes the stick slope, which is not supported; expected that of the model")
            friction |= {pair.contact.label: coefficient for pair in pairs if pair.interaction == changed.name.upper()}
        elif card.keyword in ("MODEL CHANGE", "CHANGE CONTACT PAIR"):
            switched |= _switched(card, known, pairs)
    found: dict[str, Any] = {"friction": friction} if friction else {}
    for key, on in (("active", True), ("inactive", False)):
        names = tuple(name for name, state in switched.items() if state is on)
        if names:
            found[key] = names
    return found


def _switched(card: Card, known: Known, pairs: Sequence[Pair]) -> dict[str, bool]:
    card.refuse_unknown(("TYPE", "ADD", "REMOVE"))
    if card.choice("TYPE", ("CONTACT PAIR", "ELEMENT"), "CONTACT PAIR") == "ELEMENT":
        raise card.error("TYPE=ELEMENT is not supported; expected CONTACT PAIR")
    if ("ADD" in card.parameters) == ("REMOVE" in card.parameters):
        raise card.error("expected either ADD or REMOVE")
    found: dict[str, bool] = {}
    card.row("the slave and the master surface")
    for row in card.rows():
        slave, master = (known.surfaces.find(row.text(i, "a surface"), row).name for i in (0, 1))
        names = [pairs[i].contact.label for i in pairs_between(pairs, (slave, master), row)]
        found |= dict.fromkeys(names, "ADD" in card.parameters)
    return found
