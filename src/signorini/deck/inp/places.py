# SPDX-License-Identifier: BSD-3-Clause
"""Names that a model needs for places: those of the deck where they mean the same, otherwise new ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.arrays import IntArray
from signorini.deck.inp.course import unique_label
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.surfaces import ElementFaces, Surfaces


class Places:
    """Boundaries and node sets of the model's mesh.

    Attributes
    ----------
    boundaries : name to nodes of edges or faces, as a mesh has them
    nodes : name to sorted nodes; no name is that of a boundary
    """

    def __init__(self, edges: ElementFaces, surfaces: Surfaces, sets: Sets) -> None:
        self._edges = edges
        self.boundaries: dict[str, tuple[IntArray, ...]] = dict(surfaces.facets(edges))
        self.nodes: dict[str, IntArray] = {}
        self._by_nodes: dict[bytes, str] = {}
        for name in sets.names:
            members = sets[name]
            if len(members):
                label = unique_label(name, self.boundaries)
                self.nodes[label] = members
                self._by_nodes[f"{name}".upper().encode() + members.tobytes()] = label

    def at_nodes(self, nodes: IntArray, label: str) -> str:
        """A name for sorted nodes: that of the set ``label`` if it has just these."""
        key = label.upper().encode() + nodes.tobytes()
        if key not in self._by_nodes:
            name = unique_label(label, {*self.boundaries, *self.nodes})
            self.nodes[name] = nodes
            self._by_nodes[key] = name
        return self._by_nodes[key]

    def unused(self, label: str, others: Sequence[str]) -> str:
        """The label, or with a number behind it where a place or one of the others bears it."""
        return unique_label(label, {*self.boundaries, *self.nodes, *others})

    def at_edges(self, keys: IntArray, label: str) -> list[str]:
        """Names for edges, one for each order of elements: that of the surface ``label`` if it has just these."""
        names = []
        for kinds in self._edges.facets(keys):
            known = self.boundaries.get(label, ())
            same = len(known) == len(kinds) and all(map(np.array_equal, known, kinds))
            names.append(label if same else unique_label(label, {*self.boundaries, *self.nodes}))
            self.boundaries[names[-1]] = kinds
        return names
