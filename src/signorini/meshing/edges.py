# SPDX-License-Identifier: BSD-3-Clause
"""The edges of all cells, and whether the cells fit together along them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.model.mesh import CORNERS, Mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class Edges:
    """Edges of all cells, sorted by their keys; an edge between two cells is there twice.

    Attributes
    ----------
    ends : (e, 2) nodes, the cell on the left of the way from the first to the second
    middle : (e,) node in the middle, -1 of a linear cell
    cell : (e,) number of the cell
    key : (e,) one number for every pair of ends, ascending, see :meth:`key_of`
    """

    ends: IntArray
    middle: IntArray
    cell: IntArray
    key: IntArray
    nodes: int

    def key_of(self, ends: IntArray) -> IntArray:
        """Of pairs of nodes (..., 2), in either order."""
        return _key(ends, self.nodes)


def _key(ends: IntArray, nodes: int) -> IntArray:
    key: IntArray = ends.min(axis=-1) * nodes + ends.max(axis=-1)
    return key


def make_edges(mesh: Mesh) -> Edges:
    """The edges of all cells."""
    ends, middle, cell, first = [], [], [], 0
    for family, nodes in mesh.cells.items():
        n = CORNERS[family]
        corners = nodes[:, :n]
        pairs = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1)
        clockwise = _doubled_area(mesh.points[corners]) < 0.0
        pairs[clockwise] = pairs[clockwise][..., ::-1]
        ends.append(pairs.reshape(-1, 2))
        quadratic = nodes.shape[1] > n
        middle.append(nodes[:, n : 2 * n].ravel() if quadratic else np.full(pairs[..., 0].size, -1))
        cell.append(np.repeat(first + np.arange(len(nodes)), n))
        first += len(nodes)
    every = np.concatenate(ends)
    key = _key(every, len(mesh.points))
    order = np.argsort(key, kind="stable")
    return Edges(
        ends=every[order],
        middle=np.concatenate(middle)[order],
        cell=np.concatenate(cell)[order],
        key=key[order],
        nodes=len(mesh.points),
    )


def check_conforming(mesh: Mesh, edges: Edges) -> None:
    """Refuse meshes whose cells do not share whole edges.

    Raises
    ------
    InputError
        If a linear cell meets a quadratic one along an edge, or the middle node of an edge is the corner of a cell.
    """
    if (edges.middle < 0).all():
        return
    same = np.nonzero(edges.key[1:] == edges.key[:-1])[0]
    wrong = same[edges.middle[same] != edges.middle[same + 1]]
    if len(wrong):
        one, two = edges.cell[wrong[0]], edges.cell[wrong[0] + 1]
        a, b = mesh.labels[edges.ends[wrong[0]]]
        raise InputError(
            f"{mesh.cell_name(one)} and {mesh.cell_name(two)} meet along the edge between nodes {a} and {b} without "
            "sharing a middle node; expected one order along an edge",
            where=("mesh", "cells"),
            cell=int(one),
        )
    corners = np.concatenate([nodes[:, : CORNERS[family]].ravel() for family, nodes in mesh.cells.items()])
    hanging = np.nonzero(np.isin(edges.middle, corners))[0]
    if len(hanging):
        cell, node = int(edges.cell[hanging[0]]), mesh.labels[edges.middle[hanging[0]]]
        raise InputError(
            f"node {node}, the middle of an edge of {mesh.cell_name(cell)}, is the corner of another; expected whole "
            "edges to be shared",
            where=("mesh", "cells"),
            cell=cell,
        )


def _doubled_area(corners: Array) -> Array:
    x, y = corners[..., 0], corners[..., 1]
    area: Array = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    return area


def outer_edges(edges: Edges, mesh: Mesh, name: str, where: Where) -> tuple[IntArray, IntArray]:
    """Edges of a named boundary with the body on their left, (m, 2 or 3), and their cells, (m,).

    Parameters
    ----------
    edges : of all cells of the mesh
    mesh : in the plane
    name : of the boundary
    where : what errors call the place

    Raises
    ------
    InputError
        If there are none, an edge belongs to no cell or to two, is given twice or has no length, or the edges belong to
        linear and to quadratic cells.
    """
    points, given = mesh.points, mesh.facets(name)[0]
    if not len(given):
        raise InputError(f"'{name}' is empty; expected a boundary with edges or faces", where=where)
    empty = (points[given[:, 0]] == points[given[:, 1]]).all(axis=1)
    if empty.any():
        raise InputError(f"'{name}' has an edge without length at node {mesh.labels[given[empty][0, 0]]}", where=where)
    edge = _places(edges, mesh, given[:, :2], name, where)
    ends, middle = edges.ends[edge], edges.middle[edge]
    if given.shape[1] == 3 and (given[:, 2] != middle).any():
        wrong = int(np.nonzero(given[:, 2] != middle)[0][0])
        a, b, c = mesh.labels[given[wrong]]
        found = f"node {mesh.labels[middle[wrong]]}" if middle[wrong] >= 0 else "no node"
        raise InputError(
            f"'{name}' has node {c} between nodes {a} and {b}, where the cell has {found}",
            where=where,
        )
    quadratic = middle >= 0
    if quadratic.any() and not quadratic.all():
        raise InputError(f"'{name}' belongs to linear and to quadratic cells; expected one order", where=where)
    facets = np.column_stack([ends, middle]) if quadratic.any() else ends
    return facets, edges.cell[edge]


def _places(edges: Edges, mesh: Mesh, facets: IntArray, name: str, where: Where) -> IntArray:
    """Indices of the edges that the facets are, (m,)."""
    wanted = edges.key_of(facets)
    left = np.searchsorted(edges.key, wanted, side="left")
    found = np.searchsorted(edges.key, wanted, side="right") - left
    if (found == 0).any():
        a, b = mesh.labels[facets[np.nonzero(found == 0)[0][0]]]
        raise InputError(f"'{name}' has an edge between nodes {a} and {b} that no cell has", where=where)
    if (found > 1).any():
        a, b = mesh.labels[facets[np.nonzero(found > 1)[0][0]]]
        raise InputError(
            f"'{name}' lies inside: the edge between nodes {a} and {b} belongs to two cells. Expected an outer "
            "boundary; bodies that touch need nodes of their own on the interface",
            where=where,
        )
    if len(np.unique(wanted)) != len(wanted):
        raise InputError(f"'{name}' has an edge twice", where=where)
    return left
