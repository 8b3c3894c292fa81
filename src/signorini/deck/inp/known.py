# SPDX-License-Identifier: BSD-3-Clause
"""Everything that keywords refer to, and the names that a model has for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.deck.inp.amplitudes import Amplitude, make_amplitudes
from signorini.deck.inp.card import Card
from signorini.deck.inp.grid import DeckGrid, make_grid
from signorini.deck.inp.interactions import Interaction, make_interactions
from signorini.deck.inp.materials import Section, make_materials, make_sections
from signorini.deck.inp.refusals import Refusals
from signorini.deck.inp.sets import Sets, make_sets, unique_label
from signorini.deck.inp.surfaces import ElementFaces, Surfaces, make_surfaces
from signorini.deck.inp.transforms import NodeAxes, make_node_axes
from signorini.model.kind import TWIST


class Places:
    """Boundaries and node sets of the model's mesh.

    Attributes
    ----------
    boundaries : name to nodes of edges or faces, as a mesh has them
    nodes : name to sorted nodes; no name is that of a boundary
    """

    def __init__(self, faces: ElementFaces, surfaces: Surfaces, sets: Sets) -> None:
        self._faces = faces
        self.boundaries: dict[str, tuple[IntArray, ...]] = surfaces.facets()
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
        """The label, or with a number behind it where a place or one of the others has that name."""
        return unique_label(label, {*self.boundaries, *self.nodes, *others})

    def at_faces(self, keys: IntArray, label: str) -> list[str]:
        """Names for faces, one for each order of elements: that of the surface ``label`` if it has just these."""
        names = []
        for kinds in self._faces.facets(keys):
            known = self.boundaries.get(label, ())
            same = len(known) == len(kinds) and all(map(np.array_equal, known, kinds))
            names.append(label if same else unique_label(label, {*self.boundaries, *self.nodes}))
            self.boundaries[names[-1]] = kinds
        return names


@dataclass(frozen=True, kw_only=True, eq=False)
class Known:
    """Everything of a deck that has a number or a name.

    Attributes
    ----------
    grid : nodes and elements
    nodes, elements : their sets
    axes : directions of the nodes
    sections : bodies
    faces : of the elements
    surfaces : by name
    interactions : laws of contact by name in capitals
    amplitudes : by name in capitals
    places : names of the model's boundaries and node sets; it grows as they are needed
    unused_materials : names of materials that no section has
    refusals : gathered while the rest of the deck is read
    """

    grid: DeckGrid
    nodes: Sets
    elements: Sets
    axes: NodeAxes
    sections: Sequence[Section]
    faces: ElementFaces
    surfaces: Surfaces
    interactions: Mapping[str, Interaction]
    amplitudes: Mapping[str, Amplitude]
    places: Places
    unused_materials: tuple[str, ...]
    refusals: Refusals

    @property
    def dimension(self) -> int:
        """Directions of the model's space."""
        return self.grid.dimension

    @property
    def twists(self) -> bool:
        """Whether bodies turn about the axis: direction 5 is an angle then."""
        return self.grid.kind == TWIST

    @property
    def motions(self) -> Mapping[int, int]:
        """Directions of decks, from 1, and which component of a displacement each is."""
        return {1: 0, 2: 1, 5: 2} if self.twists else {i + 1: i for i in range(self.dimension)}

    @property
    def spelled(self) -> str:
        """The directions in words."""
        return "1, 2 or 5" if self.twists else f"1 to {self.dimension}"

    def radii(self, nodes: IntArray) -> Array:
        """(k,) Of nodes (k,), length."""
        return np.asarray(self.grid.points[nodes, 0])


def make_known(cards: Sequence[Card], outside: Sequence[Card], refusals: Refusals) -> Known:
    """Read all that cards outside the steps name or number; sets and amplitudes stand among all cards.

    Parameters
    ----------
    cards, outside : all of the deck, and those outside its steps
    refusals : gathered here, and told before something would follow from them

    Raises
    ------
    DeckError
        Of all that is refused, together.
    """
    materials = make_materials(outside, refusals)
    interactions = make_interactions(outside, refusals)
    with refusals.gather():
        amplitudes = make_amplitudes(cards)
    with refusals.gather():
        grid = make_grid(outside)
    refusals.stop()
    nodes, elements = make_sets(cards, grid)
    with refusals.gather():
        sections = make_sections(outside, grid, elements, materials)
    with refusals.gather():
        axes = make_node_axes(outside, grid, nodes)
    refusals.stop()
    faces = ElementFaces(grid)
    surfaces = make_surfaces(outside, faces, nodes, elements)
    used = {section.substance.card for section in sections}
    return Known(
        grid=grid,
        nodes=nodes,
        elements=elements,
        axes=axes,
        sections=sections,
        faces=faces,
        surfaces=surfaces,
        interactions=interactions,
        amplitudes=amplitudes,
        places=Places(faces, surfaces, nodes),
        unused_materials=tuple(each.name for each in materials.values() if each.card not in used),
        refusals=refusals,
    )
