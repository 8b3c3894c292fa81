# SPDX-License-Identifier: BSD-3-Clause
"""Nodes and elements of a deck as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.block import MOST, Block
from signorini.deck.inp.elements import ElementType, element_type
from signorini.deck.inp.flatten import Placed, Scope
from signorini.deck.inp.numbering import Numbering
from signorini.deck.inp.numbers import number_table, record_table

_FLAT = 1e-9  # of the size: how far a plane mesh may leave its plane


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """Everything that has a number.

    Attributes
    ----------
    points : (n, 3) coordinates
    nodes, elements : numberings
    groups : one for every ``*ELEMENT`` keyword: its type, its elements' indices and their nodes
    """

    points: Array
    nodes: Numbering
    elements: Numbering
    groups: tuple[Group, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Group:
    """Elements of one keyword: ``index`` (m,) counts elements, ``nodes`` (m, k) points."""

    block: Block
    scope: Scope
    type: ElementType
    index: IntArray
    nodes: IntArray


def make_grid(placed: list[Placed]) -> Grid:
    """Read all ``*NODE`` and ``*ELEMENT`` keywords.

    Raises
    ------
    DeckError
        For a number that is used twice or for nothing, a type that is not supported, or a mesh that is not plane.
    """
    nodes, points = _nodes([item for item in placed if item.block.keyword == "NODE"])
    elements, groups = Numbering("element"), []
    for scope, blocks in _by_scope([item for item in placed if item.block.keyword == "ELEMENT"]):
        tables = []
        for block in blocks:
            block.refuse_unknown(("TYPE", "ELSET", "INPUT"))
            kind = element_type(block)
            table = record_table(block, kind.nodes + 1, f"a number and {kind.nodes} nodes")
            tables.append((block, kind, table))
        numbers = np.concatenate([table[:, 0] for *_, table in tables])
        _refuse_twice(numbers, tables[-1][0], "element")
        elements.add(scope.name, numbers)
        for block, kind, table in tables:
            index = elements.index(scope, table[:, 0], block)
            members = nodes.index(scope, table[:, 1:].ravel(), block).reshape(-1, kind.nodes)
            groups.append(Group(block=block, scope=scope, type=kind, index=index, nodes=members))
    _refuse_space(points, groups)
    return Grid(points=points, nodes=nodes, elements=elements, groups=tuple(groups))


def nodes_of(grid: Grid, elements: IntArray) -> IntArray:
    """The sorted nodes of elements."""
    pieces = [group.nodes[np.isin(group.index, elements)].ravel() for group in grid.groups]
    return distinct(np.concatenate([np.empty(0, np.int64), *pieces]))


def _nodes(placed: list[Placed]) -> tuple[Numbering, Array]:
    nodes, points = Numbering("node"), [np.empty((0, 3))]
    for scope, blocks in _by_scope(placed):
        tables = []
        for block in blocks:
            block.refuse_unknown(("NSET", "INPUT"))
            tables.append(number_table(block, "a number and up to 3 coordinates", least=1, most=7)[:, :4])
        table = np.vstack(tables)
        wrong = (table[:, 0] != np.rint(table[:, 0])) | (table[:, 0] < 1) | (table[:, 0] >= MOST)
        if wrong.any():
            raise blocks[0].error(
                f"a node has the number {table[wrong, 0][0]:g}; expected a whole number >= 1 of at most ten digits"
            )
        _, where, again = np.unique(table[:, 0].astype(np.int64), return_index=True, return_inverse=True)
        moved = np.nonzero((table[:, 1:] != table[where[again], 1:]).any(axis=1))[0]
        if len(moved):
            raise blocks[-1].error(f"node {table[moved[0], 0]:.0f} is there twice, at different places")
        first = np.sort(where)
        nodes.add(scope.name, table[first, 0].astype(np.int64))
        points.append(table[first, 1:] @ scope.turn.T + scope.shift)
    return nodes, np.vstack(points)


def _by_scope(placed: list[Placed]) -> list[tuple[Scope, list[Block]]]:
    scopes: dict[str, tuple[Scope, list[Block]]] = {}
    for item in placed:
        scopes.setdefault(item.scope.name, (item.scope, []))[1].append(item.block)
    return list(scopes.values())


def _refuse_twice(numbers: IntArray, block: Block, what: str) -> None:
    known = np.sort(numbers)
    twice = known[1:][known[1:] == known[:-1]]
    if len(twice):
        raise block.error(f"{what} {twice[0]} is there twice")
    if len(known) and known[0] < 1:
        raise block.error(f"{what} has the number {known[0]}; expected a whole number >= 1")


def _refuse_space(points: Array, groups: list[Group]) -> None:
    """Plane elements lie in a plane of constant z."""
    for group in groups:
        if group.type.kind == "3d":
            continue
        used = points[group.nodes.ravel()]
        size = float(np.ptp(used[:, :2], axis=0).max()) if len(used) else 0.0
        if len(used) and np.abs(used[:, 2] - used[0, 2]).max() > _FLAT * max(size, 1e-300):
            raise group.block.error(
                f"its nodes have z from {used[:, 2].min():g} to {used[:, 2].max():g}; expected a plane mesh in x, y"
            )
