# SPDX-License-Identifier: BSD-3-Clause
"""Tables that the steps ask for: they go on in later steps until a step asks anew."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from signorini.arrays import IntArray
from signorini.deck.inp.acting import Known
from signorini.deck.inp.card import Card
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.pairs import Pair
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.steps import DeckStep
from signorini.model.mesh import Mesh
from signorini.model.prints import Prints, Table

_OF: dict[str, Literal["nodes", "cells", "contacts"]] = {
    "NODE PRINT": "nodes",
    "EL PRINT": "cells",
    "CONTACT PRINT": "contacts",
}
_KNOWN = {"nodes": ("U", "RF"), "cells": ("S",), "contacts": ("CDIS", "CSTR", "CELS", "CF", "CFN", "CFS")}
_FORCES = ("CF", "CFN", "CFS")
_SAME = {"CDISP": "CDIS", "CSTRESS": "CSTR"}


def make_prints(steps: Sequence[DeckStep], known: Known, mesh: Mesh, contacts: Sequence[Pair]) -> Prints:
    """``*NODE PRINT`` (U, RF), ``*EL PRINT`` (S) and ``*CONTACT PRINT`` (CDIS, CSTR, CELS, CF, CFN, CFS).

    In the order in which CalculiX prints them: as asked for, forces of contacts last. Other quantities are left out.

    Raises
    ------
    DeckError
        For a set or a contact pair that does not exist.
    """
    labels, cells = known.elements.numbering.labels, mesh.cell_labels
    order = np.argsort(cells)
    near = order[np.minimum(np.searchsorted(cells[order], labels), len(cells) - 1)]
    cell_of = np.where(cells[near] == labels, near, -1)  # faces and lines beside the cells are none
    asked: list[Placed] = []
    tables: list[Table] = []
    for k, step in enumerate(steps):
        anew = [item for item in step.placed if item.card.keyword in _OF]
        words = {item.card.keyword for item in anew}
        asked = [item for item in asked if item.card.keyword not in words] + anew
        own = [table for item in asked for table in _tables(k, item, known, cell_of, contacts)]
        tables += sorted(own, key=lambda table: bool(set(table.quantities) & set(_FORCES)))
    return Prints(tables=tuple(tables), times=tuple(step.end for step in steps))


def _tables(k: int, item: Placed, known: Known, cell_of: IntArray, contacts: Sequence[Pair]) -> Iterator[Table]:
    """What one keyword asks for in step k."""
    of = _OF[item.card.keyword]
    quantities = _quantities(item.card, _KNOWN[of])
    if of == "contacts":
        yield from _contact_tables(k, item, quantities, known, contacts)
    elif quantities:
        nodes = of == "nodes"
        place, members = _members(item, "NSET" if nodes else "ELSET", known.nodes if nodes else known.elements)
        yield Table(
            step=k,
            of=of,
            place=place.upper(),
            members=members if nodes else np.sort(cell_of[members][cell_of[members] >= 0]),
            quantities=quantities,
            totals=_totals(item.card),
            rotations={rigid.turning: rigid.body.name for rigid in known.rigid if nodes and rigid.turning >= 0},
        )


def _contact_tables(
    k: int, item: Placed, quantities: Sequence[str], known: Known, contacts: Sequence[Pair]
) -> Iterator[Table]:
    """Nodal values of all contact pairs in one table each, and the forces of the pair that is named, or of all."""
    every = [i for i, pair in enumerate(contacts) if pair.card.keyword == "CONTACT PAIR"]
    nodal = tuple(word for word in quantities if word not in _FORCES)
    forces = tuple(word for word in quantities if word in _FORCES)
    if every and nodal:
        members = np.array(every)
        totals = _totals(item.card)
        yield Table(step=k, of="contacts", place="all", members=members, quantities=nodal, totals=totals)
    named = _named(item, known, every, contacts) if forces else []
    for quantity in forces:
        for i in named:
            sides = contacts[i].contact.nonmortar.upper(), str(contacts[i].contact.mortar).upper()
            place = "slave set {}, master set {}".format(*sides)
            yield Table(step=k, of="contacts", place=place, members=np.array([i]), quantities=(quantity,))


def _named(item: Placed, known: Known, every: Sequence[int], contacts: Sequence[Pair]) -> Sequence[int]:
    """Contact pairs of ``SLAVE=`` and ``MASTER=``; without them all."""
    card = item.card
    given = [key for key in ("SLAVE", "MASTER") if key in card.parameters]
    if not given:
        return every
    sides = tuple(known.surfaces.find(card.value(key, "a surface"), item.scope, card) for key in ("SLAVE", "MASTER"))
    found = [i for i in every if (contacts[i].contact.nonmortar, contacts[i].contact.mortar) == sides]
    if not found:
        raise card.error(f"there is no contact pair of '{sides[0]}' and '{sides[1]}'")
    return found


def _members(item: Placed, key: str, sets: Sets) -> tuple[str, IntArray]:
    if item.card.parameters.get(key):
        return sets.find(item.card.parameters[key], item.scope, item.card)
    return "all", np.arange(len(sets.numbering.labels))


def _totals(card: Card) -> Literal["no", "yes", "only"]:
    found = card.get("TOTALS", "NO")
    return "yes" if found == "YES" else "only" if found == "ONLY" else "no"


def _quantities(card: Card, known: tuple[str, ...]) -> tuple[str, ...]:
    found = [_SAME.get(word.upper(), word.upper()) for row in card.rows() for word in row.fields]
    return tuple(dict.fromkeys(word for word in found if word in known))
