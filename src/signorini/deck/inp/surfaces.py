# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces by name: faces of elements (edges in the plane), from faces, element sets or nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import BoolArray, IntArray, distinct
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.grid import DeckGrid
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.sets import Sets
from signorini.errors import one_of
from signorini.model.mesh import CORNERS

FACES = 6
"""Room for the faces of an element: face k of element e has the key ``FACES * e + k - 1``."""

_MAX_FACE_NODES = 8  # of a quadratic quadrilateral
_NODES_NAMED = 5  # in a message: more would hide what is expected


class ElementFaces:
    """The faces of all elements: edges in the plane.

    Attributes
    ----------
    ends : (FACES * elements, 8) nodes by key, corners first; -1 where there are fewer
    outer : (FACES * elements,) whether no other element has the face
    grid : the elements
    """

    def __init__(self, grid: DeckGrid) -> None:
        self.grid = grid
        count = len(grid.elements.labels)
        self._quadratic = np.zeros(count, bool)
        self.ends = np.full((FACES * count, _MAX_FACE_NODES if grid.dimension == 3 else 2), -1)
        for group in grid.groups:
            self._quadratic[group.index] = CORNERS[group.type.family] < group.type.nodes
            for face, places in enumerate(group.type.faces):
                self.ends[FACES * group.index + face, : len(places)] = group.nodes[:, places]
        there = np.nonzero(self.ends[:, 0] >= 0)[0]
        members = np.sort(self.ends[there], axis=1)
        order = np.lexsort(members.T)
        same = (members[order[1:]] == members[order[:-1]]).all(axis=1)
        shared = np.zeros(len(there), bool)
        shared[order[1:][same]] = shared[order[:-1][same]] = True
        self.outer = np.zeros(len(self.ends), bool)
        self.outer[there] = ~shared

    def nodes(self, keys: IntArray) -> IntArray:
        """Sorted nodes of faces."""
        ends = self.ends[keys]
        return distinct(ends[ends >= 0])

    def facets(self, keys: IntArray) -> list[tuple[IntArray, ...]]:
        """Nodes of faces, (m, k) for each number k of nodes; apart by the order of their elements."""
        count, quadratic = (self.ends[keys] >= 0).sum(axis=1), self._quadratic[keys // FACES]
        return [
            tuple(self.ends[keys[own & (count == k)], :k] for k in distinct(count[own]).tolist())
            for own in (~quadratic, quadratic)
            if own.any()
        ]

    def keys(self, elements: IntArray, face: str, at: Row, name: str) -> IntArray:
        """Keys of one face, as ``S2`` or ``P2``, of elements; the line ``at`` of the keyword ``name`` asks for it."""
        if any(np.isin(elements, group.index).any() for group in self.grid.gaskets):
            raise at.error(f"{name}: gasket elements have no faces here; expected those of the bodies beside them")
        number = int(face[1:]) if face[1:].isdigit() else 0
        keys: IntArray = FACES * elements + min(number, FACES) - 1
        if not 1 <= number <= FACES or (self.ends[keys, 0] < 0).any():
            letter = face[:1]
            raise at.error(f"{name}: these elements have no face '{face}'; expected {letter}1, {letter}2, ...")
        return keys

    def outer_of(self, elements: IntArray) -> IntArray:
        """Keys of the faces of elements that no other element has."""
        keys = (FACES * elements[:, None] + np.arange(FACES)).ravel()
        return keys[self.outer[keys]]

    def all_outer(self) -> IntArray:
        """Keys of all faces that no other element has."""
        return np.nonzero(self.outer)[0]

    def under(self, elements: IntArray) -> IntArray:
        """Keys of the faces of cells that have the nodes of faces or lines among the elements."""
        return self.with_nodes([group.nodes[np.isin(group.index, elements)] for group in self.grid.skins])[0]

    def with_nodes(self, tables: list[IntArray]) -> tuple[IntArray, BoolArray]:
        """Keys of the outer faces that have the nodes of a row of the tables, and which rows are no such face."""
        wanted = _padded(tables)
        if not len(wanted):
            return np.empty(0, np.int64), np.empty(0, np.bool_)
        known = np.zeros(int(max(self.ends.max(), wanted.max())) + 2, bool)
        known[self.ends] = True
        known[-1] = False
        wanted[~known[wanted]] = -1  # middles of edges in the plane, whose keys know the ends
        near = self.between(distinct(wanted[wanted >= 0]))
        both = np.sort(_padded([wanted, self.ends[near]]), axis=1)
        which = np.unique(both, axis=0, return_inverse=True)[1].ravel()
        rows, faces = which[: len(wanted)], which[len(wanted) :]
        return near[np.isin(faces, rows)], ~np.isin(rows, faces)

    def between(self, nodes: IntArray) -> IntArray:
        """Keys of outer faces whose nodes are all among ``nodes``."""
        inside = np.zeros(int(max(self.ends.max(initial=0), nodes.max(initial=0))) + 2, bool)
        inside[nodes] = inside[-1] = True  # the last stands for what is not there
        return np.nonzero(self.outer & inside[self.ends].all(axis=1))[0]


def _padded(tables: list[IntArray]) -> IntArray:
    """Rows of all tables, -1 behind the shorter ones."""
    width = max((table.shape[1] for table in tables), default=0)
    rows = [np.pad(table, ((0, 0), (0, width - table.shape[1])), constant_values=-1) for table in tables]
    return np.concatenate([np.empty((0, width), np.int64), *rows])


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckSurface:
    """A surface of a deck.

    Attributes
    ----------
    name : as the deck first spells it
    keys : of its faces
    given : the nodes of a surface that is made of nodes, None of others
    faces : of all elements
    """

    name: str
    keys: IntArray
    given: IntArray | None
    faces: ElementFaces

    @property
    def nodes(self) -> IntArray:
        """Its sorted nodes."""
        return self.faces.nodes(self.keys) if self.given is None else self.given

    def refuse_bare(self, at: Row) -> None:
        """A surface of nodes stands for the faces that it holds as a whole: nodes of none would be left out."""
        bare = np.setdiff1d(self.nodes, self.faces.nodes(self.keys))
        if len(bare):
            labels = ", ".join(str(label) for label in self.faces.grid.nodes.labels[bare[:_NODES_NAMED]])
            more = f" and {len(bare) - _NODES_NAMED} more" if len(bare) > _NODES_NAMED else ""
            raise at.error(
                f"surface '{self.name}' has nodes of no face that it holds as a whole: {labels}{more}; expected all "
                "nodes of faces, or TYPE=ELEMENT"
            )


class Surfaces:
    """Surfaces by name, in any case."""

    def __init__(self) -> None:
        self._by_name: dict[str, DeckSurface] = {}
        self._of_nodes: dict[str, set[bool]] = {}  # by name: kinds of surfaces that bear it

    def add(self, surface: DeckSurface, card: Card) -> None:
        """Add the surface of a card; where one of nodes has the name of one of faces, as CalculiX allows, faces count.

        Raises
        ------
        DeckError
            Where there is another of its kind by that name.
        """
        name, of_nodes = surface.name.upper(), surface.given is not None
        kinds = self._of_nodes.setdefault(name, set())
        if of_nodes in kinds:
            raise card.error(f"there is another surface '{surface.name}'")
        if not (kinds and of_nodes):
            self._by_name[name] = surface
        kinds.add(of_nodes)

    def find(self, word: str, at: Card | Row) -> DeckSurface:
        """The surface that a card or one of its lines calls ``word``."""
        for name in (at.scope.prefixed(word).upper(), word.upper()):
            if name in self._by_name:
                return self._by_name[name]
        raise at.error(one_of(word, [surface.name for surface in self._by_name.values()], "surface"))

    def facets(self) -> dict[str, tuple[IntArray, ...]]:
        """Nodes of the faces of every surface that has any, all of linear or all of quadratic elements."""
        found = {surface.name: surface.faces.facets(surface.keys) for surface in self._by_name.values()}
        return {name: parts[0] for name, parts in found.items() if len(parts) == 1}


def make_surfaces(cards: Sequence[Card], faces: ElementFaces, nodes: Sets, elements: Sets) -> Surfaces:
    """Read all ``*SURFACE`` keywords among the cards.

    Parameters
    ----------
    faces : of all elements of the deck
    nodes, elements : sets that surfaces are made of
    """
    surfaces = Surfaces()
    for card in of_keyword(cards, "SURFACE"):
        card.refuse_unknown(("NAME", "TYPE"), ("INTERNAL", "TRIM"))
        name = card.scope.prefixed(card.value("NAME"))
        given = None
        if card.choice("TYPE", ("ELEMENT", "NODE"), "ELEMENT") == "NODE":
            members = [nodes.find(row.text(0, "a node or a node set"), row)[1] for row in card.rows()]
            given = distinct(np.concatenate([np.empty(0, np.int64), *members]))
        keys = _of_elements(card, faces, elements) if given is None else faces.between(given)
        surfaces.add(DeckSurface(name=name, keys=keys, given=given, faces=faces), card)
    return surfaces


def _of_elements(card: Card, faces: ElementFaces, elements: Sets) -> IntArray:
    pieces: list[IntArray] = [np.empty(0, np.int64)]
    for row in card.rows():
        members = elements.find(row.text(0, "an element or an element set"), row)[1]
        face = row.fields[1].upper() if len(row.fields) > 1 else ""
        if not face:
            pieces += [faces.outer_of(members), faces.under(members)]
        elif face[:1] != "S":
            raise row.error(f"*SURFACE: face '{face}' is not supported; expected S1, S2, ...")
        else:
            pieces.append(faces.keys(members, face, row, "*SURFACE"))
    keys: IntArray = distinct(np.concatenate(pieces))
    return keys
