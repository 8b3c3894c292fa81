# SPDX-License-Identifier: BSD-3-Clause
"""Contact pairs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from signorini.deck.inp.block import Block, Row, to_number
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.interactions import Interaction
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.surfaces import Surfaces
from signorini.errors import one_of
from signorini.model.contact import Contact

_TYPES = ("", "NODE TO SURFACE", "SURFACE TO SURFACE", "MORTAR", "LINMORTAR", "PGLINMORTAR", "MASSLESS")
_IGNORED = (
    "SMALL SLIDING",
    "EXTENSION ZONE",
    "MECHANICAL CONSTRAINT",
    "TRACKING",
    "SUPPLEMENTARY CONSTRAINTS",
    "CPSET",
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """A contact, the keyword that it comes from, and the name of its law in capitals."""

    contact: Contact
    block: Block
    interaction: str = ""


def make_contacts(
    placed: list[Placed], interactions: Mapping[str, Interaction], surfaces: Surfaces, nodes: Sets
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
        block = item.block
        if block.keyword != "CONTACT PAIR":
            continue
        block.refuse_unknown(("INTERACTION", "TYPE", "ADJUST"), _IGNORED)
        block.choice("TYPE", _TYPES, "")
        name = block.value("INTERACTION")
        if name.upper() not in interactions:
            known = [law.block.value("NAME") for law in interactions.values()]
            raise block.error(one_of(name, known, "surface interaction"))
        law = interactions[name.upper()]
        if law.tied:
            raise law.block.error("PRESSURE-OVERCLOSURE=TIED is not supported")
        if not block.has_data:
            raise block.error("has no data line; expected the slave and the master surface")
        for row in block.rows():
            slave, master = (_side(item, row, i, surfaces) for i in (0, 1))
            given: dict[str, Any] = _adjusted(block, nodes, item)
            if (slave, master) in clearances:
                given = {"gap": clearances[slave, master]}
            contact = Contact(
                slave,
                master,
                friction=law.friction,
                normal_compliance=law.normal_compliance,
                tangential_compliance=law.tangential_compliance,
                name=slave if not any(other.contact.nonmortar == slave for other in found) else f"{slave} on {master}",
                **given,
            )
            found.append(Pair(contact=contact, block=block, interaction=name.upper()))
    return found


def _side(item: Placed, row: Row, i: int, surfaces: Surfaces) -> str:
    name = surfaces.find(row.text(i, "a surface"), item.scope, row)
    if not len(surfaces.keys[name.upper()]):
        raise row.error(f"surface '{name}' has no edge of an element")
    return name


def _adjusted(block: Block, nodes: Sets, item: Placed) -> dict[str, Any]:
    if "ADJUST" not in block.parameters:
        return {}
    word = block.value("ADJUST", "a distance")
    distance = to_number(word)
    if distance is None:
        nodes.find(word, item.scope, block)
        raise block.error("ADJUST= and a node set is not supported; expected a distance")
    if distance < 0.0:
        raise block.error(f"ADJUST is {distance:g}; expected a distance >= 0")
    return {"adjust": distance}


def _clearances(placed: list[Placed], surfaces: Surfaces) -> dict[tuple[str, str], float]:
    found = {}
    for item in placed:
        if item.block.keyword == "CLEARANCE":
            block = item.block
            block.refuse_unknown(("MASTER", "SLAVE", "VALUE"))
            value = to_number(block.value("VALUE", "a distance"))
            if value is None:
                raise block.error(f"VALUE is '{block.value('VALUE')}'; expected a number")
            slave, master = (surfaces.find(block.value(key), item.scope, block) for key in ("SLAVE", "MASTER"))
            found[slave, master] = value
    return found
