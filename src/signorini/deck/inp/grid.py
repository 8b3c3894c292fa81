# SPDX-License-Identifier: BSD-3-Clause
"""Nodes and elements of a deck as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.card import NUMBER_LIMIT, Card, Scope
from signorini.deck.inp.elements import ElementType, element_type, unknown_type
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.numbering import Numbering
from signorini.deck.inp.numbers import number_table, record_table
from signorini.model.mesh import NODES_PER_CELL
from signorini.model.model import Kind

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
    """

    points: Array
    nodes: Numbering
    elements: Numbering
    groups: tuple[ElementGroup, ...]
    skins: tuple[ElementGroup, ...] = ()

    @property
    def all_groups(self) -> tuple[ElementGroup, ...]:
        """Groups of cells and of skins."""
        return self.groups + self.skins

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
    """Read all ``*NODE`` and ``*ELEMENT`` keywords.

    Raises
    ------
    DeckError
        For a number that is used twice or for nothing, a type that is not supported, or a mesh that is not plane.
    """
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
    top = max((group.type.dimension for group in groups), default=0)
    cells = tuple(group for group in groups if group.type.dimension == top)
    for group in cells:
        if group.type.kind is None:
            raise unknown_type(group.card)
    _refuse_space(points, cells, nodes, elements)
    for group in cells:
        _refuse_other_kind(group, cells[0])
    skins = tuple(group for group in groups if group.type.dimension < top)
    return DeckGrid(points=points, nodes=nodes, elements=elements, groups=cells, skins=skins)


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
