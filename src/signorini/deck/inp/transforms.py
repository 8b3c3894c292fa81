# SPDX-License-Identifier: BSD-3-Clause
"""``*TRANSFORM``: nodes whose supports, forces, equations and tables are along axes of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.deck.inp.card import Card
from signorini.deck.inp.grid import DeckGrid
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.sets import Sets
from signorini.model.kind import revolves

_AXIS_TOL = 1e-9  # of a unit vector: smaller components are rounding of coordinates with ten digits


@dataclass(frozen=True, kw_only=True, eq=False)
class NodeAxes:
    """Directions 1, 2, 3 of the nodes of a deck.

    Attributes
    ----------
    index : (n,) row of ``vectors`` that a node has, -1 where its directions are x, y and z
    vectors : (m, d, d) ``vectors[k, i]`` is the unit vector of direction i + 1
    """

    index: IntArray
    vectors: Array

    def own(self, nodes: int | IntArray) -> BoolArray:
        """(k,) whether nodes have axes of their own."""
        return np.asarray(self.index[nodes] >= 0)

    def of(self, nodes: IntArray) -> Array:
        """(k, d, d) directions of nodes."""
        found = np.broadcast_to(np.eye(self.vectors.shape[1]), (len(nodes), *self.vectors.shape[1:])).copy()
        own = self.own(nodes)
        found[own] = self.vectors[self.index[nodes[own]]]
        return found

    def along(self, node: int, axis: int) -> Array:
        """(d,) the unit vector of a direction of a node, counted from 0."""
        unit = np.eye(self.vectors.shape[1])
        return np.asarray((self.vectors[self.index[node]] if self.own(node) else unit)[axis])


def make_node_axes(cards: Sequence[Card], grid: DeckGrid, nodes: Sets) -> NodeAxes:
    """Read all ``*TRANSFORM`` keywords; of several for one node the last counts.

    Parameters
    ----------
    cards : of the deck, outside its steps
    grid, nodes : the nodes, and their sets

    Raises
    ------
    DeckError
        For axes without a direction, or that leave the plane of a plane model.
    """
    index = np.full(len(grid.points), -1)
    vectors = [np.empty((0, grid.dimension, grid.dimension))]
    count = 0
    for card in of_keyword(cards, "TRANSFORM"):
        card.refuse_unknown(("NSET", "TYPE"))
        members = nodes.find(card.value("NSET", "a node set"), card)[1]
        kind = card.choice("TYPE", ("R", "C"), "R")
        row = card.row("two points, six coordinates")
        a, b = (np.array([row.number(3 * k + i, "a coordinate", 0.0) for i in range(3)]) for k in range(2))
        found = _cylindrical(grid.points[members], a, b) if kind == "C" else _rectangular(a, b)
        if found is None:
            raise card.at(row).error("its points leave no direction; expected points apart from each other")
        found[np.abs(found) < _AXIS_TOL] = 0.0
        if grid.dimension == 2 and (found[:, 2, :2].any() or revolves(grid.kind)):
            raise card.at(row).error("turns directions out of the plane of the model; expected axes in it")
        index[members] = count + np.arange(len(members)) % len(found)
        vectors.append(found[:, : grid.dimension, : grid.dimension])
        count += len(found)
    return NodeAxes(index=index, vectors=np.concatenate(vectors))


def _rectangular(a: Array, b: Array) -> Array | None:
    """(1, 3, 3) axes of which a is on the first and b in the plane of the first two; None where they are on a line."""
    first, third = a, np.cross(a, b)
    if not np.linalg.norm(third) > _AXIS_TOL * np.linalg.norm(a) * np.linalg.norm(b):
        return None
    axes = np.stack([first, np.cross(third, first), third])
    return np.asarray(axes / np.linalg.norm(axes, axis=1)[:, None])[None]


def _cylindrical(points: Array, a: Array, b: Array) -> Array | None:
    """(k, 3, 3) radial, tangential and axial directions at points, the axis from a to b; None where these are one.

    On the axis every direction across it is radial: the one that CalculiX takes.
    """
    size = np.linalg.norm(b - a)
    if not size > 0.0:
        return None
    axis = (b - a) / size
    radius = points - a
    radius = radius - np.outer(radius @ axis, axis)
    on_axis = np.linalg.norm(radius, axis=1) <= _AXIS_TOL * size
    along = int(np.flatnonzero(np.abs(axis) > _AXIS_TOL)[0])
    across = np.eye(3)[(along + 1) % 3]  # what axis[along] balances
    across = across - axis @ across / axis[along] * np.eye(3)[along]
    radius[on_axis] = across
    radial = radius / np.linalg.norm(radius, axis=1)[:, None]
    axial = np.broadcast_to(axis, radial.shape)
    return np.stack([radial, np.cross(axial, radial), axial], axis=1)
