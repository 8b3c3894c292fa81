# SPDX-License-Identifier: BSD-3-Clause
"""Nodes and elements of a deck as arrays; element types of Abaqus and CalculiX: what they are here, or why not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.error import DeckError
from signorini.deck.inp.card import NUMBER_LIMIT, Card, Scope
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.numbers import Numbering, number_table, record_table
from signorini.model.kind import Kind
from signorini.model.mesh import CORNERS, NODES_PER_CELL

_PLANES = {"CPE": "plane strain", "CPS": "plane stress", "CAX": "axisymmetric", "CGAX": "axisymmetric twist"}
_PLANE = {"3": "triangle", "4": "quad", "6": "triangle6", "8": "quad8"}
_SOLID = {"4": "tetra", "6": "wedge", "8": "hexahedron", "10": "tetra10", "15": "wedge15", "20": "hexahedron20"}
_LINES = {"line": 2, "line3": 3}  # to their nodes
_SHAPES = {  # of trusses, beams, membranes and shells, which meshers write for edges and faces of bodies
    **dict.fromkeys(("T2D2", "T3D2", "B21", "B31"), "line"),
    **dict.fromkeys(("T2D3", "T3D3", "B22", "B32"), "line3"),
    **{f"{word}{nodes}": family for word in ("S", "M3D") for nodes, family in _PLANE.items()},
}
_GASKETS: dict[str, tuple[str, Kind | None]] = {  # between the faces of two bodies, bottom first, by family and kind
    "GK3D6": ("wedge", "3d"),
    "GK3D8": ("hexahedron", "3d"),
    "GKPS4": ("quad", "plane stress"),
    "GKPE4": ("quad", "plane strain"),
    "GKAX4": ("quad", "axisymmetric"),
}
_FULLY = "reduced integration is not used: all elements are integrated fully"
_VARIANTS = {
    "": "",
    "R": _FULLY,
    "I": "",
    "IH": "",
    "H": "",
    "M": "modified formulation is not used: it is an ordinary quadratic element",
    "MH": "modified formulation is not used: it is an ordinary quadratic element",
    "RH": _FULLY,
    "T": "temperatures of coupled elements are not unknowns here",
}
# faces S1, S2, ... by their corners, from 0
_FACES = {
    "triangle": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
}
# edges of quadratic solids in the order of the nodes on them
_EDGES = {
    "tetra10": ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
    "wedge15": ((0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5), (0, 3), (1, 4), (2, 5)),
    "hexahedron20": (
        *((0, 1), (1, 2), (2, 3), (0, 3), (4, 5), (5, 6), (6, 7), (4, 7)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ),
}


@dataclass(frozen=True, kw_only=True)
class ElementType:
    """An element type of a deck as cells of a model.

    Attributes
    ----------
    name : in the deck, in capitals
    family : of cells, as "quad8", or of lines; the order of its nodes is that of decks
    kind : of the model, as "plane strain"; None of lines and shells, of which there is no model
    incompatible : with incompatible modes
    note : how it differs from what the deck asks for, empty if it does not
    gasket : between two bodies, in whose faces the halves of its nodes lie
    """

    name: str
    family: str
    kind: Kind | None
    incompatible: bool = False
    note: str = ""
    gasket: bool = False

    @property
    def nodes(self) -> int:
        """Number of nodes of an element."""
        return _LINES.get(self.family) or NODES_PER_CELL[self.family]

    @property
    def dimension(self) -> int:
        """1 for lines, 2 for faces and plane models, 3 for solids."""
        return 1 if self.family in _LINES else 3 if self.kind == "3d" else 2

    @property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """Places of the nodes of every face S1, S2, ...: corners; in space the middles of its edges follow."""
        linear = self.family.rstrip("0123456789")
        faces = _FACES[linear]
        if self.family not in _EDGES:
            return faces
        middle = {frozenset(edge): CORNERS[self.family] + k for k, edge in enumerate(_EDGES[self.family])}
        return tuple(
            (*face, *(middle[frozenset((face[i], face[(i + 1) % len(face)]))] for i in range(len(face))))
            for face in faces
        )


def element_type(card: Card) -> ElementType:
    """The type of an ``*ELEMENT`` keyword."""
    name = card.value("TYPE", "an element type").upper()
    if name.rstrip("R") in _SHAPES:
        return ElementType(name=name, family=_SHAPES[name.rstrip("R")], kind=None)
    if name.startswith("GK"):
        return _gasket_type(card, name)
    solid = name.startswith("C3D")
    word = next((word for word in _PLANES if name.startswith(word)), name[:3])
    size = name[len(word) :].rstrip("RIHMT")
    variant = name[len(word) + len(size) :]
    family = (_SOLID if solid else _PLANE).get(size)
    if (solid or word in _PLANES) and family is not None and variant in _VARIANTS:
        if variant.startswith("I") and family not in ("quad", "hexahedron"):
            raise card.error(f"TYPE={name} is not supported; incompatible modes are for 4 nodes, in space 8")
        note = f"{name}: {_VARIANTS[variant]}" if _VARIANTS[variant] else ""
        if family == "wedge15":
            note = note or f"{name}: integrated with 21 points, where CalculiX and Abaqus take 9"
        kind = cast(Kind, "3d" if solid else _PLANES[word])
        return ElementType(name=name, family=family, kind=kind, incompatible=variant.startswith("I"), note=note)
    raise unknown_type(card)


def _gasket_type(card: Card, name: str) -> ElementType:
    """Gasket elements; those that have a behaviour across them alone (N) are the same here."""
    family, kind = _GASKETS.get(name.removesuffix("N"), ("", None))
    if not family:
        raise card.error(
            f"TYPE={name} is not supported; expected {', '.join(_GASKETS)}, each with or without N behind it"
        )
    if name == "GKPS4N":
        kind = None  # of plane strain and of plane stress
    return ElementType(name=name, family=family, kind=kind, gasket=True)


def unknown_type(card: Card) -> DeckError:
    """The error of an ``*ELEMENT`` keyword whose elements no model has."""
    return card.error(
        f"TYPE={card.get('TYPE')} is not supported; expected CPE, CPS, CAX or CGAX with 3, 4, 6 or 8 nodes, or C3D "
        "with 4, 6, 8, 10, 15 or 20 (variants R, I, H, M)"
    )


_PLANE_TOL = 1e-9  # of the size of the mesh: coordinates are written with ten digits


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckGrid:
    """Nodes and elements of a deck by their numbers.

    Attributes
    ----------
    points : (n, 3) coordinates
    nodes, elements : numberings
    groups : one for every ``*ELEMENT`` keyword: its type, its elements' indices and their nodes
    skins : faces and lines that meshers write beside the cells, of lower dimension, for sets and surfaces
    gaskets : elements between two bodies, which are contacts here
    """

    points: Array
    nodes: Numbering
    elements: Numbering
    groups: tuple[ElementGroup, ...]
    skins: tuple[ElementGroup, ...] = ()
    gaskets: tuple[ElementGroup, ...] = ()

    @property
    def all_groups(self) -> tuple[ElementGroup, ...]:
        """Groups of cells, of skins and of gaskets."""
        return self.groups + self.skins + self.gaskets

    @property
    def kind(self) -> Kind:
        """Kind of the model, that of all cells."""
        return cast(Kind, self.groups[0].type.kind)

    @property
    def dimension(self) -> int:
        """Directions of the model's space."""
        return self.groups[0].type.dimension

    @cached_property
    def elements_of_cells(self) -> IntArray:
        """(m,) the element that every cell of the model is: cells are ordered by their families."""
        ordered = [group.index for family in NODES_PER_CELL for group in self.groups if group.type.family == family]
        return np.concatenate([np.empty(0, np.int64), *ordered])

    def at(self, element: int) -> Card:
        """The ``*ELEMENT`` keyword of an element, at its line."""
        group = next(group for group in self.all_groups if element in group.index)
        return group.at(int(np.nonzero(group.index == element)[0][0]))

    def card_of_cell(self, cell: int) -> Card:
        """The ``*ELEMENT`` keyword, at its line, of the element that a cell of the model is."""
        return self.at(int(self.elements_of_cells[cell]))


@dataclass(frozen=True, kw_only=True, eq=False)
class ElementGroup:
    """Elements of one keyword: ``index`` (m,) counts elements, ``nodes`` (m, k) points."""

    card: Card
    type: ElementType
    index: IntArray
    nodes: IntArray

    def at(self, element: int) -> Card:
        """The keyword, at the line of one of its elements, counted from 0."""
        return _at_record(self.card, element, self.type)


def make_grid(cards: Sequence[Card]) -> DeckGrid:
    """Read all ``*NODE`` and ``*ELEMENT`` keywords; those of a plane mesh lie in a plane of constant z."""
    nodes, points = _nodes(cards)
    elements, groups = Numbering("element"), []
    for scope, own in _by_scope(cards, "ELEMENT"):
        tables = []
        for card in own:
            card.refuse_unknown(("TYPE", "ELSET", "INPUT"))
            kind = element_type(card)
            tables.append((card, kind, record_table(card, kind.nodes + 1, f"a number and {kind.nodes} nodes")))
        _refuse_twice(tables)
        elements.add(scope.name, np.concatenate([table[:, 0] for *_, table in tables]))
        for card, kind, table in tables:
            groups.append(
                ElementGroup(
                    card=card,
                    type=kind,
                    index=elements.index(scope, table[:, 0], card),
                    nodes=_members(card, kind, table, nodes),
                )
            )
    gaskets = tuple(group for group in groups if group.type.gasket)
    groups = [group for group in groups if not group.type.gasket]
    top = max((group.type.dimension for group in groups), default=0)
    cells = tuple(group for group in groups if group.type.dimension == top)
    for group in cells:
        if group.type.kind is None:
            raise unknown_type(group.card)
    _refuse_space(points, cells, nodes, elements)
    for group in (*cells, *(group for group in gaskets if group.type.kind is not None)):
        _refuse_other_kind(group, cells[0])
    skins = tuple(group for group in groups if group.type.dimension < top)
    return DeckGrid(points=points, nodes=nodes, elements=elements, groups=cells, skins=skins, gaskets=gaskets)


def _refuse_other_kind(group: ElementGroup, first: ElementGroup) -> None:
    """All cells are of one kind of model, and of families that a model has."""
    if group.type.kind != first.type.kind:
        raise group.card.error(
            f"{group.card.value('TYPE')} is {group.type.kind}, but {first.card.value('TYPE')} of line "
            f"{first.card.line} {first.type.kind}; expected one of them for all elements"
        )
    if group.type.family not in NODES_PER_CELL:
        raise group.card.error(f"TYPE={group.card.value('TYPE')} is not supported")


def _members(card: Card, kind: ElementType, table: IntArray, nodes: Numbering) -> IntArray:
    """(m, k) nodes of elements."""
    found = nodes.index(card.scope, table[:, 1:].ravel(), lambda i: _at_record(card, i // kind.nodes, kind))
    return found.reshape(-1, kind.nodes)


def _at_record(card: Card, record: int, kind: ElementType) -> Card:
    """An ``*ELEMENT`` keyword at the line where one of its elements begins."""
    return card.at(card.row_with(record * (kind.nodes + 1)))


def nodes_of(grid: DeckGrid, elements: IntArray) -> IntArray:
    """The sorted nodes of elements."""
    pieces = [group.nodes[np.isin(group.index, elements)].ravel() for group in grid.all_groups]
    return distinct(np.concatenate([np.empty(0, np.int64), *pieces]))


def _nodes(cards: Sequence[Card]) -> tuple[Numbering, Array]:
    nodes, points = Numbering("node"), [np.empty((0, 3))]
    for scope, own in _by_scope(cards, "NODE"):
        tables = []
        for card in own:
            card.refuse_unknown(("NSET", "INPUT"))
            tables.append(number_table(card, "a number and up to 3 coordinates", least=1, most=7)[:, :4])
        table = np.vstack(tables)
        wrong = (table[:, 0] != np.rint(table[:, 0])) | (table[:, 0] < 1) | (table[:, 0] >= NUMBER_LIMIT)
        if wrong.any():
            raise _at_node(own, tables, int(np.argmax(wrong))).error(
                f"a node has the number {table[wrong, 0][0]:g}; expected a whole number >= 1 of at most ten digits"
            )
        _, where, again = np.unique(table[:, 0].astype(np.int64), return_index=True, return_inverse=True)
        moved = np.nonzero((table[:, 1:] != table[where[again], 1:]).any(axis=1))[0]
        if len(moved):
            raise _at_node(own, tables, int(moved[0])).error(
                f"node {table[moved[0], 0]:.0f} is there twice, at different places"
            )
        first = np.sort(where)
        nodes.add(scope.name, table[first, 0].astype(np.int64))
        points.append(table[first, 1:] @ scope.turn.T + scope.shift)
    return nodes, np.vstack(points)


def _by_scope(cards: Sequence[Card], keyword: str) -> list[tuple[Scope, list[Card]]]:
    """Cards of a keyword by the instance that they belong to."""
    scopes: dict[str, tuple[Scope, list[Card]]] = {}
    for card in of_keyword(cards, keyword):
        scopes.setdefault(card.scope.name, (card.scope, []))[1].append(card)
    return list(scopes.values())


def _at_node(cards: Sequence[Card], tables: list[Array], record: int) -> Card:
    """The ``*NODE`` keyword of a node, at its line; nodes are counted through all of them."""
    for card, table in zip(cards, tables, strict=True):
        if record < len(table):
            return card.at(card.row_of(record))
        record -= len(table)
    raise IndexError("there are fewer nodes")


def _refuse_twice(tables: list[tuple[Card, ElementType, IntArray]]) -> None:
    """Every element has a number of its own, 1 or more."""
    numbers = np.concatenate([table[:, 0] for *_, table in tables])
    first = np.unique(numbers, return_index=True)[1]
    wrong = np.ones(len(numbers), bool)
    wrong[first] = numbers[first] < 1
    if not wrong.any():
        return
    place = int(np.argmax(wrong))
    number, record = numbers[place], place
    for card, kind, table in tables:
        if record < len(table):
            words = f"{number} is there twice" if number > 0 else f"has the number {number}; expected one >= 1"
            raise _at_record(card, record, kind).error(f"element {words}")
        record -= len(table)


def _refuse_space(points: Array, groups: tuple[ElementGroup, ...], nodes: Numbering, elements: Numbering) -> None:
    """Plane elements lie in a plane of constant z."""
    for group in groups:
        if group.type.kind == "3d" or not len(group.index):
            continue
        used = points[group.nodes]
        plane = float(np.median(used[..., 2]))
        far = np.abs(used[..., 2] - plane) > _PLANE_TOL * max(float(np.ptp(used[..., :2], axis=(0, 1)).max()), 1e-300)
        if far.any():
            place, corner = (int(i) for i in np.argwhere(far)[0])
            raise group.at(place).error(
                f"element {elements.labels[group.index[place]]} has node {nodes.labels[group.nodes[place, corner]]} at "
                f"z = {used[place, corner, 2]:g}, others are at z = {plane:g}; expected a plane mesh in x, y"
            )
