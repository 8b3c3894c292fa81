# SPDX-License-Identifier: BSD-3-Clause
"""Tables that the steps ask for: they go on in later steps until a step asks anew."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from signorini.arrays import IntArray
from signorini.deck.inp.block import Block
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.pairs import Pair
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.steps import DeckStep
from signorini.model.mesh import Mesh
from signorini.model.prints import Table

_KNOWN = {"NODE PRINT": ("U", "RF"), "EL PRINT": ("S",), "CONTACT PRINT": ("CDIS", "CSTR", "CF")}
_SAME = {"CDISP": "CDIS", "CSTRESS": "CSTR", "CFN": "CF", "CFS": "CF"}


def make_tables(
    steps: Sequence[DeckStep], nodes: Sets, elements: Sets, mesh: Mesh, contacts: Sequence[Pair]
) -> Iterator[Table]:
    """``*NODE PRINT`` (U, RF), ``*EL PRINT`` (S) and ``*CONTACT PRINT`` (CDIS, CSTR, CF); others are left out.

    Raises
    ------
    DeckError
        For a set that does not exist.
    """
    order = np.argsort(mesh.cell_labels)
    cell_of = order[np.searchsorted(mesh.cell_labels[order], elements.numbering.labels)]
    asked: dict[str, list[Placed]] = {}
    for k, step in enumerate(steps):
        for keyword in _KNOWN:
            anew = [item for item in step.placed if item.block.keyword == keyword]
            if anew:
                asked[keyword] = anew
        for keyword, items in asked.items():
            for item in items:
                quantities = _quantities(item.block, _KNOWN[keyword])
                if not quantities:
                    continue
                if keyword == "CONTACT PRINT":
                    for i, pair in enumerate(contacts):
                        place = f"slave set {pair.contact.nonmortar}, master set {pair.contact.mortar}"
                        yield Table(
                            step=k, of="contact", place=place, members=np.array([i]), quantities=quantities, totals="no"
                        )
                    continue
                of: Literal["nodes", "cells"] = "nodes" if keyword == "NODE PRINT" else "cells"
                place, members = _members(
                    item, "NSET" if of == "nodes" else "ELSET", nodes if of == "nodes" else elements
                )
                yield Table(
                    step=k,
                    of=of,
                    place=place.upper(),
                    members=members if of == "nodes" else np.sort(cell_of[members]),
                    quantities=quantities,
                    totals=_totals(item.block),
                )


def _members(item: Placed, key: str, sets: Sets) -> tuple[str, IntArray]:
    if item.block.parameters.get(key):
        return sets.find(item.block.parameters[key], item.scope, item.block)
    return "all", np.arange(len(sets.numbering.labels))


def _totals(block: Block) -> Literal["no", "yes", "only"]:
    found = block.get("TOTALS", "NO")
    return "yes" if found == "YES" else "only" if found == "ONLY" else "no"


def _quantities(block: Block, known: tuple[str, ...]) -> tuple[str, ...]:
    found = [_SAME.get(word.upper(), word.upper()) for row in block.rows() for word in row.fields]
    return tuple(dict.fromkeys(word for word in found if word in known))
