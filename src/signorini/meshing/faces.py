# SPDX-License-Identifier: BSD-3-Clause
"""The faces of solid cells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.errors import InputError, Where
from signorini.model.mesh import FACES, Mesh

CORNERS = {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}
"""Of faces, by the number of their nodes."""

HEXAHEDRON = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)) + (
    ((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2))
    + ((0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1))
    + ((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2), (1, 1, 1))
)
"""Nodes of the hexahedra in the order of meshio, which scikit-fem numbers otherwise; edges are 2 long here."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Faces:
    """Faces with one number of nodes, sorted by their keys; a face between two cells is there twice.

    Attributes
    ----------
    nodes : (f, k) anticlockwise seen from outside the cell
    cell : (f,) number of the cell
    key : (f,) one number for every set of corners, ascending
    """

    nodes: IntArray
    cell: IntArray
    key: IntArray


def make_faces(mesh: Mesh) -> dict[int, Faces]:
    """The faces of all cells, by the number of their nodes."""
    nodes: dict[int, list[IntArray]] = {}
    owner: dict[int, list[IntArray]] = {}
    first = 0
    for family, cells in mesh.cells.items():
        inside_out = _mirrored(mesh.points, cells)
        for face in FACES[family]:
            members = cells[:, list(face)]
            members[inside_out] = members[inside_out][:, _reversed(len(face))]
            nodes.setdefault(len(face), []).append(members)
            owner.setdefault(len(face), []).append(first + np.arange(len(cells)))
        first += len(cells)
    result = {}
    for count, parts in nodes.items():
        every, cell = np.concatenate(parts), np.concatenate(owner[count])
        key = face_key(every, len(mesh.points))
        order = np.argsort(key, kind="stable")
        result[count] = Faces(nodes=every[order], cell=cell[order], key=key[order])
    return result


def face_key(faces: IntArray, points: int) -> IntArray:
    """One number for the corners of faces (m, k), in any order: of their three smallest, which no other face has.

    Raises
    ------
    InputError
        For more than two million nodes, whose triples do not fit into 64 bits.
    """
    if points > 2_000_000:
        raise InputError(f"has {points} nodes; expected at most 2000000 in space", where=("mesh",))
    corners = np.sort(faces[:, : CORNERS[faces.shape[1]]], axis=1)
    key: IntArray = (corners[:, 0] * points + corners[:, 1]) * points + corners[:, 2]
    return key


def outer_faces(faces: Mapping[int, Faces], mesh: Mesh, name: str, where: Where) -> list[tuple[IntArray, IntArray]]:
    """The faces of a named boundary, (m, k), anticlockwise seen from outside, and the cells that have them, (m,).

    Parameters
    ----------
    faces : of all cells, see :func:`make_faces`
    mesh : in space; corners of the faces suffice there
    name : of the boundary
    where : what errors call the place

    Returns
    -------
    By the number of their nodes, ascending

    Raises
    ------
    InputError
        If there are none, a face belongs to no cell or to two, is given twice, or the faces belong to linear and to
        quadratic cells.
    """
    given, points = mesh.facets(name), len(mesh.points)
    if not len(given[0]):
        raise InputError(f"'{name}' is empty; expected a boundary with edges or faces", where=where)
    found: dict[int, list[tuple[IntArray, IntArray, IntArray]]] = {}
    for own in given:
        for kind in _outer(faces, own, points, name, where):
            found.setdefault(kind[0].shape[1], []).append(kind)
    merged = [
        (np.concatenate(n), np.concatenate(c), np.concatenate(k))
        for n, c, k in (zip(*p, strict=True) for _, p in sorted(found.items()))
    ]
    if any(len(distinct(key)) != len(key) for _, _, key in merged):
        raise InputError(f"'{name}' has a face twice", where=where)
    if len({nodes.shape[1] > CORNERS[nodes.shape[1]] for nodes, _, _ in merged}) > 1:
        raise InputError(f"'{name}' belongs to linear and to quadratic cells; expected one order", where=where)
    return [(nodes, cells) for nodes, cells, _ in merged]


def _outer(
    faces: Mapping[int, Faces], given: IntArray, points: int, name: str, where: Where
) -> list[tuple[IntArray, IntArray, IntArray]]:
    """Of faces that name as many nodes each, by the number of nodes that cells have there: nodes, cells and keys."""
    corners = CORNERS[given.shape[1]]
    wanted = face_key(given, points)
    total = np.zeros(len(wanted), np.int64)
    found = []
    for count, every in faces.items():
        if CORNERS[count] == corners:
            left = np.searchsorted(every.key, wanted, side="left")
            times = np.searchsorted(every.key, wanted, side="right") - left
            total += times
            here = np.flatnonzero(times)
            if len(here):
                found.append((here, every.nodes[left[here]], every.cell[left[here]]))
    for bad, why in ((total == 0, "that no cell has"), (total > 1, "between two cells")):
        if bad.any():
            first = ", ".join(str(node + 1) for node in given[np.argmax(bad), :corners])
            also = "" if why.startswith("that") else ": it lies inside. Bodies that touch need nodes of their own there"
            raise InputError(f"'{name}' has a face with corners {first} {why}{also}", where=where)
    for here, own, _ in found if given.shape[1] > corners else ():
        said = given[here]
        foreign = np.ones(len(own), bool)
        if said.shape == own.shape:
            foreign = (np.sort(said, axis=1) != np.sort(own, axis=1)).any(axis=1)
        if foreign.any():
            one, other = (", ".join(map(str, nodes[np.argmax(foreign)] + 1)) for nodes in (said, own))
            raise InputError(f"'{name}' has a face of nodes {one}, but the cell has {other}", where=where)
    return [(own, cells, wanted[here]) for here, own, cells in found]


def _mirrored(points: Array, cells: IntArray) -> Array:
    """(m,) whether the first corners of a cell are left-handed."""
    family = {4: (1, 2, 3), 10: (1, 2, 3), 6: (1, 2, 3), 15: (1, 2, 3)}.get(cells.shape[1], (1, 3, 4))
    origin = points[cells[:, 0]]
    along = np.stack([points[cells[:, k]] - origin for k in family], axis=1)
    left: Array = np.linalg.det(along) < 0.0
    return left


def _reversed(count: int) -> list[int]:
    """The nodes of a face seen from the other side."""
    corners = CORNERS[count]
    order = [0, *range(corners - 1, 0, -1)]
    if count > corners:
        order += [corners + (corners - 1 - k) for k in range(corners)]
    return order + list(range(2 * corners, count))
