# SPDX-License-Identifier: BSD-3-Clause
"""The facets of cells, edges in the plane and faces in space, and whether cells fit together along them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, distinct
from signorini.errors import InputError, Where, one_of
from signorini.model.mesh import CORNERS, FACETS, Mesh

FACE_CORNERS = {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}
"""Of faces, by the number of their nodes."""

HEXAHEDRON = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)) + (
    ((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2))
    + ((0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1))
    + ((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1))
)
"""Nodes of the hexahedra in the order of meshio, which scikit-fem numbers otherwise; edges are 2 long here."""

_NEIGHBOURS = {
    "triangle": ((1, 2), (2, 0), (0, 1)),
    "quad": ((1, 3), (2, 0), (3, 1), (0, 2)),
    "tetra": ((1, 2, 3), (2, 0, 3), (0, 1, 3), (0, 2, 1)),
    "wedge": ((1, 2, 3), (2, 0, 4), (0, 1, 5), (5, 4, 0), (3, 5, 1), (4, 3, 2)),
    "hexahedron": ((1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)),
}  # of every corner of a cell, right-handed


@dataclass(frozen=True, kw_only=True, eq=False)
class CellFacets:
    """Facets with one number of nodes, sorted by their keys; one between two cells is there twice.

    Attributes
    ----------
    nodes : (f, k) corners, then middle nodes; of an edge the cell is on the left of the way between its ends, a face
        runs anticlockwise seen from outside the cell
    cell : (f,) number of the cell
    key : (f,) one number for every set of corners, ascending
    """

    nodes: IntArray
    cell: IntArray
    key: IntArray


def facet_corners(dimension: int, count: int) -> int:
    """Corners of a facet with ``count`` nodes; its others are in the middle of an edge, or of the facet."""
    return 2 if dimension == 2 else FACE_CORNERS[count]


def make_facets(mesh: Mesh, at: BoolArray | None = None) -> dict[int, CellFacets]:
    """The facets of cells, by the number of their nodes.

    Parameters
    ----------
    mesh : of the cells
    at : (n,) nodes; of cells that have none of them facets are left out. None: of no cell
    """
    nodes: dict[int, list[IntArray]] = {}
    owner: dict[int, list[IntArray]] = {}
    first, d = 0, mesh.points.shape[1]
    for family, every in mesh.cells.items():
        chosen = np.arange(len(every)) if at is None else np.flatnonzero(at[every].any(axis=1))
        cells = every if at is None else every[chosen]
        inside_out = numbered_inside_out(mesh.points, family, cells)
        for facet in FACETS[family]:
            members = cells[:, list(facet)]
            members[inside_out] = members[inside_out][:, turned_facet(facet_corners(d, len(facet)), len(facet))]
            nodes.setdefault(len(facet), []).append(members)
            owner.setdefault(len(facet), []).append(first + chosen)
        first += len(every)
    result = {}
    for count, parts in nodes.items():
        facets, cell = np.concatenate(parts), np.concatenate(owner[count])
        key = facet_keys(facets[:, : facet_corners(d, count)], len(mesh.points))
        order = np.argsort(key, kind="stable")
        result[count] = CellFacets(nodes=facets[order], cell=cell[order], key=key[order])
    return result


def unshared(keys: IntArray) -> BoolArray:
    """(f,) Whether ascending keys are there once: of facets with one cell.

    >>> unshared(np.array([1, 2, 2, 5])).tolist()
    [True, False, False, True]
    """
    differs = np.concatenate([[True], keys[1:] != keys[:-1], [True]])
    alone: BoolArray = (differs[1:] & differs[:-1])[: len(keys)]
    return alone


def numbered_inside_out(points: Array, family: str, cells: IntArray) -> BoolArray:
    """(m,) Which cells of one family are; simplices have one volume at all their corners.

    Parameters
    ----------
    points : (n, d) of the mesh, length
    family, cells : (m, k) nodes of cells of one family
    """
    every = corner_volumes(points, family, cells, 1 if CORNERS[family] == points.shape[1] + 1 else None)
    return np.asarray(every.sum(axis=1) < 0.0)


def corner_volumes(points: Array, family: str, cells: IntArray, first: int | None = None) -> Array:
    """Determinants of the edges at every corner of cells, (m, corners); negative where they are numbered inside out.

    Parameters
    ----------
    points : (n, d) of the mesh, length
    family, cells : (m, k) nodes of cells of one family
    first : corners that are looked at; all if not given
    """
    corners = _NEIGHBOURS[family.rstrip("0123456789")]
    at = points.T[:, cells[:, : len(corners)].T]  # a row a corner: what follows runs along the cells
    volumes = []
    for corner, others in enumerate(corners[:first]):
        one, two, *three = (at[:, other] - at[:, corner] for other in others)
        if three:
            volumes.append(np.sum(np.cross(one, two, axis=0) * three[0], axis=0))
        else:
            volumes.append(one[0] * two[1] - one[1] * two[0])
    return np.array(volumes).T


def refuse_folded(mesh: Mesh, family: str, first: int, volumes: Array) -> None:
    """Refuse cells of one family without area, or whose volumes change sign; all clockwise is fine.

    Parameters
    ----------
    mesh : of the cells
    family, first : their family, and the number of the first of them
    volumes : (m, q) determinants at points of each

    Raises
    ------
    InputError
        With the cell and where it is.
    """
    size, total = np.abs(volumes).max(axis=1), volumes.sum(axis=1)
    bad = (np.abs(total) < 1e-12 * size) | (size == 0.0)
    bad |= (volumes * np.sign(total)[:, None]).min(axis=1) <= -1e-12 * size
    if bad.any():
        cell, nodes = int(np.argmax(bad)), mesh.cells[family]
        centre = tuple(float(x) for x in mesh.points[nodes[cell]].mean(axis=0).round(6))
        linear = CORNERS[family] == nodes.shape[1]
        expected = "a convex cell" if linear else "the middle nodes near the middles of edges that bend little"
        raise InputError(
            f"{mesh.cell_name(first + cell)} near {centre} has no area or is turned inside out (its Jacobian changes "
            f"sign); expected {expected}",
            where=("mesh",),
            cell=first + cell,
        )


def check_conforming(mesh: Mesh, facets: Mapping[int, CellFacets]) -> None:
    """Refuse plane meshes whose cells do not share whole edges.

    Raises
    ------
    InputError
        If a linear cell meets a quadratic one along an edge, or the middle node of an edge is the corner of a cell.
    """
    if 3 not in facets:
        return
    parts = facets.values()
    ends, cells, keys = (
        np.concatenate(one) for one in zip(*((f.nodes[:, :2], f.cell, f.key) for f in parts), strict=True)
    )
    middles = np.concatenate([f.nodes[:, 2] if f.nodes.shape[1] == 3 else np.full(len(f.nodes), -1) for f in parts])
    order = np.lexsort([cells, keys])
    ends, cells, keys, middles = ends[order], cells[order], keys[order], middles[order]
    same = np.nonzero(keys[1:] == keys[:-1])[0]
    wrong = same[middles[same] != middles[same + 1]]
    if len(wrong):
        one, two = cells[wrong[0]], cells[wrong[0] + 1]
        raise InputError(
            f"{mesh.cell_name(one)} and {mesh.cell_name(two)} meet along the edge between "
            f"{_nodes(mesh, ends[wrong[0]])} without sharing a middle node; expected one order along an edge",
            where=("mesh", "cells"),
            cell=int(one),
        )
    corners = np.concatenate([nodes[:, : CORNERS[family]].ravel() for family, nodes in mesh.cells.items()])
    hanging = np.nonzero(np.isin(middles, corners))[0]
    if len(hanging):
        cell, node = int(cells[hanging[0]]), mesh.labels[middles[hanging[0]]]
        raise InputError(
            f"node {node}, the middle of an edge of {mesh.cell_name(cell)}, is the corner of another; expected whole "
            "edges to be shared",
            where=("mesh", "cells"),
            cell=cell,
        )


def outer_facets(
    facets: Mapping[int, CellFacets], mesh: Mesh, name: str, where: Where
) -> list[tuple[IntArray, IntArray]]:
    """The facets of a named boundary, (m, k), in the order of the cells that have them, and these, (m,).

    Parameters
    ----------
    facets : of all cells, see :func:`make_facets`
    mesh : of the boundary, which may name the corners of its facets alone
    name : of the boundary
    where : what errors call the place

    Returns
    -------
    By the number of their nodes, ascending

    Raises
    ------
    InputError
        If there are none, a facet belongs to no cell or to two, is given twice, or the facets belong to linear and to
        quadratic cells; in the plane, if an edge has no length.
    """
    given, d = mesh.facets(name), mesh.points.shape[1]
    if not len(given[0]):
        raise InputError(f"'{name}' is empty; expected a boundary with edges or faces", where=where)
    if d == 2 and (empty := (mesh.points[given[0][:, 0]] == mesh.points[given[0][:, 1]]).all(axis=1)).any():
        node = mesh.labels[given[0][empty][0, 0]]
        raise InputError(f"'{name}' has an edge without length at node {node}", where=where)
    found: dict[int, list[tuple[IntArray, IntArray, IntArray]]] = {}
    for own in given:
        for kind in _outer(facets, mesh, own, name, where):
            found.setdefault(kind[0].shape[1], []).append(kind)
    merged = [
        (np.concatenate(n), np.concatenate(c), np.concatenate(k))
        for n, c, k in (zip(*p, strict=True) for _, p in sorted(found.items()))
    ]
    if any(len(distinct(key)) != len(key) for _, _, key in merged):
        raise InputError(f"'{name}' has {'an edge' if d == 2 else 'a face'} twice", where=where)
    if len({nodes.shape[1] > facet_corners(d, nodes.shape[1]) for nodes, _, _ in merged}) > 1:
        raise InputError(f"'{name}' belongs to linear and to quadratic cells; expected one order", where=where)
    return [(nodes, cells) for nodes, cells, _ in merged]


def _outer(
    facets: Mapping[int, CellFacets], mesh: Mesh, given: IntArray, name: str, where: Where
) -> list[tuple[IntArray, IntArray, IntArray]]:
    """Of facets that name as many nodes each, by the number of nodes that cells have there: nodes, cells and keys."""
    d = mesh.points.shape[1]
    corners = facet_corners(d, given.shape[1])
    wanted = facet_keys(given[:, :corners], len(mesh.points))
    total = np.zeros(len(wanted), np.int64)
    found = []
    for count, every in facets.items():
        if facet_corners(d, count) == corners:
            left = np.searchsorted(every.key, wanted, side="left")
            times = np.searchsorted(every.key, wanted, side="right") - left
            total += times
            here = np.flatnonzero(times)
            if len(here):
                found.append((here, every.nodes[left[here]], every.cell[left[here]]))
    if (total != 1).any():
        lost = (total == 0).any()
        at = _nodes(mesh, given[np.argmax(total == 0 if lost else total > 1), :corners])
        if lost:
            raise InputError(
                f"'{name}' has {'an edge' if d == 2 else 'a face'} between {at} that no cell has", where=where
            )
        raise InputError(
            f"'{name}' lies inside: the {'edge' if d == 2 else 'face'} between {at} belongs to two cells. Expected an "
            "outer boundary; bodies that touch need nodes of their own on the interface",
            where=where,
        )
    for here, own, _ in found if given.shape[1] > corners else ():
        said = given[here]
        foreign = np.ones(len(own), bool)
        if said.shape == own.shape:
            foreign = (np.sort(said, axis=1) != np.sort(own, axis=1)).any(axis=1)
        if foreign.any():
            one, other = (nodes[np.argmax(foreign)] for nodes in (said, own))
            raise InputError(
                f"'{name}' has {_nodes(mesh, one[corners:])} between {_nodes(mesh, one[:corners])}, where the cell has "
                f"{_nodes(mesh, other[corners:])}",
                where=where,
            )
    return [(own, cells, wanted[here]) for here, own, cells in found]


def tool_facets(mesh: Mesh, name: str) -> tuple[IntArray, ...]:
    """The facets of a boundary of a rigid tool, by the number of their nodes: outer ones of its cells, or of no cell.

    Raises
    ------
    InputError
        If there is no such boundary, cells are folded, or see :func:`outer_facets`.
    """
    if name not in mesh.boundaries:
        raise InputError(one_of(name, mesh.boundaries, "boundary"), where=("boundary",))
    if mesh.bounds_nothing(name):
        return mesh.facets(name)
    first = 0
    for family, cells in mesh.cells.items():
        refuse_folded(mesh, family, first, corner_volumes(mesh.points, family, cells))
        first += len(cells)
    return tuple(facets for facets, _ in outer_facets(make_facets(mesh), mesh, name, ("boundary",)))


def facet_keys(corners: IntArray, points: int) -> IntArray:
    """One number for the corners of facets, in any order: of their three smallest, or both of an edge.

    Parameters
    ----------
    corners : (m, 2, 3 or 4) nodes
    points : how many nodes the mesh has

    Raises
    ------
    InputError
        For more than two million nodes in space, whose triples do not fit into 64 bits.
    """
    if corners.shape[1] > 2 and points > 2_000_000:
        raise InputError(f"has {points} nodes; expected at most 2000000 in space", where=("mesh",))
    if corners.shape[1] == 2:  # several times faster than a sort of every row
        return np.asarray(np.minimum(*corners.T) * points + np.maximum(*corners.T))
    first, second, third = np.sort(corners, axis=1)[:, :3].T
    return np.asarray((first * points + second) * points + third)


def _nodes(mesh: Mesh, nodes: IntArray) -> str:
    """As in "nodes 1, 2 and 3"."""
    if not len(nodes):
        return "no node"
    *others, last = (str(label) for label in mesh.labels[nodes])
    return f"nodes {', '.join(others)} and {last}" if others else f"node {last}"


def turned_facet(corners: int, count: int) -> list[int]:
    """Places of the nodes of a facet run through the other way round, of its corners and all its nodes."""
    if corners == 2:
        return [1, 0, 2][:count]
    order = [0, *range(corners - 1, 0, -1)]
    if count > corners:
        order += [corners + (corners - 1 - k) for k in range(corners)]
    return order + list(range(2 * corners, count))
