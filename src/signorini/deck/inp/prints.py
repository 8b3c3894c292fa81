# SPDX-License-Identifier: BSD-3-Clause
"""Tables that the steps ask for: they go on in later steps until a step asks anew."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.deck.inp.card import Card
from signorini.deck.inp.known import Known
from signorini.deck.inp.links import DeckRigid
from signorini.deck.inp.pairs import Pair, named_sides, pairs_between
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.steps import DeckStep
from signorini.model.mesh import Mesh
from signorini.model.prints import Prints, Table

_TABLES_OF: dict[str, Literal["nodes", "cells", "contacts"]] = {
    "NODE PRINT": "nodes",
    "EL PRINT": "cells",
    "CONTACT PRINT": "contacts",
}
_KNOWN = {
    "nodes": ("U", "RF"),
    "cells": ("S", "E", "PEEQ", "PE"),
    "contacts": ("CDIS", "CSTR", "CELS", "CF", "CFN", "CFS"),
}
_FORCES = ("CF", "CFN", "CFS")
_CALCULIX_WORDS = {"CDISP": "CDIS", "CSTRESS": "CSTR"}


def make_prints(
    steps: Sequence[DeckStep], known: Known, contacts: Sequence[Pair], rigid: Sequence[DeckRigid], mesh: Mesh
) -> Prints:
    """``*NODE PRINT`` (U, RF), ``*EL PRINT`` (S, E, PEEQ, PE) and ``*CONTACT PRINT`` (CDIS, CSTR, CELS, CF, CFN, CFS).

    In the order in which CalculiX prints them: as asked for, forces of contacts last. Other quantities are left out.

    Parameters
    ----------
    steps : whose keywords ask
    known : nodes and elements with their sets, surfaces
    contacts, rigid : contact pairs before ties, and what has reference nodes
    mesh : of the model, whose cells are elements in another order
    """
    labels, cells = known.elements.numbering.labels, mesh.cell_labels
    order = np.argsort(cells)
    near = order[np.minimum(np.searchsorted(cells[order], labels), len(cells) - 1)]
    cell_of = np.where(cells[near] == labels, near, -1)  # faces and lines beside the cells are none
    asked: list[Card] = []
    tables: list[Table] = []
    pairs = [pair for pair in contacts if pair.card.keyword == "CONTACT PAIR"]  # ties are behind them
    for k, step in enumerate(steps):
        anew = [card for card in step.cards if card.keyword in _TABLES_OF]
        words = {card.keyword for card in anew}
        asked = [card for card in asked if card.keyword not in words] + anew
        own = [table for card in asked for table in _tables(k, card, known, pairs, cell_of)]
        tables += sorted(own, key=lambda table: bool(set(table.quantities) & set(_FORCES)))
    turning = {item.turning: item.body.name for item in rigid if item.turning >= 0}
    tables = [replace(table, rotations=turning) if table.of == "nodes" else table for table in tables]
    return Prints(tables=tuple(tables), times=tuple(step.end for step in steps))


def _tables(k: int, card: Card, known: Known, pairs: Sequence[Pair], cell_of: IntArray) -> Iterator[Table]:
    """What one keyword asks for in step k."""
    of = _TABLES_OF[card.keyword]
    quantities = _quantities(card, _KNOWN[of])
    if of == "contacts":
        yield from _contact_tables(k, card, quantities, known, pairs)
    elif quantities:
        nodes = of == "nodes"
        place, members = _members(card, "NSET" if nodes else "ELSET", known.nodes if nodes else known.elements)
        yield Table(
            step=k,
            of=of,
            place=place.upper(),
            members=members if nodes else np.sort(cell_of[members][cell_of[members] >= 0]),
            quantities=quantities,
            totals=_totals(card),
            axes=_axes(card, members, known) if nodes else {},
        )


def _contact_tables(
    k: int, card: Card, quantities: Sequence[str], known: Known, pairs: Sequence[Pair]
) -> Iterator[Table]:
    """Nodal values of all contact pairs in one table each, and the forces of the pair that is named, or of all."""
    nodal = tuple(word for word in quantities if word not in _FORCES)
    forces = tuple(word for word in quantities if word in _FORCES)
    if pairs and nodal:
        members = np.arange(len(pairs))
        totals = _totals(card)
        yield Table(step=k, of="contacts", place="all", members=members, quantities=nodal, totals=totals)
    named: Sequence[int] = range(len(pairs))
    if forces and any(key in card.parameters for key in ("SLAVE", "MASTER")):
        named = pairs_between(pairs, named_sides(card, known, "a surface"), card)
    for quantity in forces:
        for i in named:
            sides = pairs[i].contact.nonmortar.upper(), str(pairs[i].contact.mortar).upper()
            place = "slave set {}, master set {}".format(*sides)
            yield Table(step=k, of="contacts", place=place, members=np.array([i]), quantities=(quantity,))


def _members(card: Card, key: str, sets: Sets) -> tuple[str, IntArray]:
    if card.parameters.get(key):
        return sets.find(card.parameters[key], card)
    return "all", np.arange(len(sets.numbering.labels))


def _axes(card: Card, members: IntArray, known: Known) -> dict[int, Array]:
    """Members whose values are along axes of their own, unless the card asks for those of the model, and these axes."""
    if card.choice("GLOBAL", ("YES", "NO"), "NO") == "YES":
        return {}
    rows = np.flatnonzero(known.axes.own(members))
    return dict(zip(rows.tolist(), known.axes.of(members[rows]), strict=True))


def _totals(card: Card) -> Literal["no", "yes", "only"]:
    found = card.get("TOTALS", "NO")
    return "yes" if found == "YES" else "only" if found == "ONLY" else "no"


def _quantities(card: Card, known: tuple[str, ...]) -> tuple[str, ...]:
    found = [_CALCULIX_WORDS.get(word.upper(), word.upper()) for row in card.rows() for word in row.fields]
    return tuple(dict.fromkeys(word for word in found if word in known))
