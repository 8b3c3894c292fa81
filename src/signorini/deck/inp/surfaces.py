# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces by name: edges of elements, from faces, element sets or nodes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.block import Block, Row
from signorini.deck.inp.flatten import Placed, Scope
from signorini.deck.inp.grid import Grid
from signorini.deck.inp.sets import Sets
from signorini.errors import one_of

FACES = 4
"""Room for the faces of an element: face k of element e has the key ``FACES * e + k - 1``."""


class Edges:
    """The edges of all plane elements.

    Attributes
    ----------
    ends : (FACES * elements, 2) end nodes by key; -1 where an element has fewer edges
    outer : (FACES * elements,) whether no other element has the edge
    """

    def __init__(self, grid: Grid) -> None:
        count = sum(len(group.index) for group in grid.groups)
        self.ends = np.full((FACES * count, 2), -1)
        for group in grid.groups:
            k = group.type.corners
            for face in range(k):
                self.ends[FACES * group.index + face] = group.nodes[:, [face, (face + 1) % k]]
        there = np.nonzero(self.ends[:, 0] >= 0)[0]
        low, high = np.sort(self.ends[there], axis=1).T
        _, which, times = np.unique(low * (len(grid.points) + 1) + high, return_inverse=True, return_counts=True)
        self.outer = np.zeros(len(self.ends), bool)
        self.outer[there] = times[which] == 1

    def keys(self, elements: IntArray, face: str, at: Row, name: str) -> IntArray:
        """Keys of one face, as ``S2`` or ``P2``, of elements."""
        number = int(face[1:]) if face[1:].isdigit() else 0
        if not 1 <= number <= FACES:
            raise at.error(f"{name}: face '{face}' is not supported; expected {face[:1]}1 to {face[:1]}4")
        keys: IntArray = FACES * elements + number - 1
        if (self.ends[keys, 0] < 0).any():
            raise at.error(f"{name}: face '{face}' of a triangle; expected {face[:1]}1 to {face[:1]}3")
        return keys

    def outer_of(self, elements: IntArray) -> IntArray:
        """Keys of the edges of elements that no other element has."""
        keys = (FACES * elements[:, None] + np.arange(FACES)).ravel()
        return keys[self.outer[keys]]

    def between(self, nodes: IntArray) -> IntArray:
        """Keys of outer edges whose end nodes are both among ``nodes``."""
        inside = np.zeros(int(max(self.ends.max(initial=0), nodes.max(initial=0))) + 1, bool)
        inside[nodes] = True
        return np.nonzero(self.outer & inside[self.ends].all(axis=1))[0]


class Surfaces:
    """Keys of edges by the name of a surface, and the nodes of surfaces that are made of nodes."""

    def __init__(self) -> None:
        self.keys: dict[str, IntArray] = {}
        self.nodes: dict[str, IntArray] = {}
        self._spelled: dict[str, str] = {}
        self.blocks: dict[str, Block] = {}

    def add(self, name: str, keys: IntArray, block: Block) -> None:
        """Add a surface."""
        if name.upper() in self.keys:
            raise block.error(f"there is another surface '{name}'")
        self.keys[name.upper()] = keys
        self._spelled[name.upper()] = name
        self.blocks[name.upper()] = block

    def find(self, word: str, scope: Scope, at: Block | Row) -> str:
        """The name by which the deck knows a surface, as first spelled.

        Raises
        ------
        DeckError
            If there is no such surface.
        """
        for name in (scope.prefixed(word).upper(), word.upper()):
            if name in self.keys:
                return self._spelled[name]
        raise at.error(one_of(word, self._spelled.values(), "surface"))

    def facets(self, edges: Edges) -> Mapping[str, IntArray]:
        """End nodes of the edges, (m, 2), of every surface that has any."""
        return {name: edges.ends[self.keys[key]] for key, name in self._spelled.items() if len(self.keys[key])}


def make_surfaces(placed: list[Placed], edges: Edges, nodes: Sets, elements: Sets) -> Surfaces:
    """Read all ``*SURFACE`` keywords.

    Raises
    ------
    DeckError
        For faces that do not exist, or a kind of surface that is not supported.
    """
    surfaces = Surfaces()
    for item in placed:
        block = item.block
        if block.keyword != "SURFACE":
            continue
        block.refuse_unknown(("NAME", "TYPE"), ("INTERNAL", "TRIM"))
        name = item.scope.prefixed(block.value("NAME"))
        if block.choice("TYPE", ("ELEMENT", "NODE"), "ELEMENT") == "NODE":
            members = [nodes.find(row.text(0, "a node or a node set"), item.scope, row)[1] for row in block.rows()]
            found = distinct(np.concatenate([np.empty(0, np.int64), *members]))
            surfaces.add(name, edges.between(found), block)
            surfaces.nodes[name.upper()] = found
        else:
            surfaces.add(name, _of_elements(item, edges, elements), block)
    return surfaces


def _of_elements(item: Placed, edges: Edges, elements: Sets) -> IntArray:
    pieces: list[IntArray] = [np.empty(0, np.int64)]
    for row in item.block.rows():
        members = elements.find(row.text(0, "an element or an element set"), item.scope, row)[1]
        face = row.fields[1].upper() if len(row.fields) > 1 else ""
        if not face:
            pieces.append(edges.outer_of(members))
        elif face[:1] != "S":
            raise row.error(f"*SURFACE: face '{face}' is not supported; expected S1 to S4")
        else:
            pieces.append(edges.keys(members, face, row, "*SURFACE"))
    keys: IntArray = distinct(np.concatenate(pieces))
    return keys
