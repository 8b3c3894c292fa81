# SPDX-License-Identifier: BSD-3-Clause
"""Hexahedra cut into tetrahedra, on the same nodes."""

from __future__ import annotations

import numpy as np

from signorini.arrays import IntArray
from signorini.errors import InputError
from signorini.meshing.facets import HEXAHEDRON
from signorini.model.mesh import EDGES, FACETS, Mesh

_CUT = {"hexahedron": "tetra", "hexahedron27": "tetra10"}


def tetrahedra(mesh: Mesh) -> Mesh:
    """Every hexahedron as six tetrahedra; 27 nodes become those of tetrahedra of 10, curved as they were.

    The corner with the smallest number is the tip of all six, and in every face its diagonal goes through the smallest
    number: neighbours agree.

    Parameters
    ----------
    mesh : of "hexahedron" or "hexahedron27"; of its boundaries the corners are kept

    Raises
    ------
    InputError
        If the mesh is of other cells.

    References
    ----------
    Dompierre, Labbe, Vallet, Camarero (1999), Proceedings of the 8th International Meshing Roundtable, 195-204.

    Examples
    --------
    >>> from signorini.meshing.solid import box
    >>> tetrahedra(box(x=[0, 1], y=[0, 1], z=[0, 1], cells="hexahedron27"))
    Mesh(27 nodes, 6 tetra10s; bodies: block; boundaries: left, right, front, back, bottom, top)
    """
    if mesh.points.shape[1] != 3 or len(mesh.cells) != 1 or not set(mesh.cells) <= set(_CUT):
        raise InputError(f"is {mesh!r}; expected hexahedra of 8 or of 27 nodes", where=("mesh",))
    ((family, cells),) = mesh.cells.items()
    owner, nodes = cone_simplices(family, cells[:, :8])
    corners = np.argmax(cells[owner][:, None, :8] == nodes[:, :, None], axis=2)
    if family == "hexahedron27":
        places = np.array(HEXAHEDRON)
        middles = np.stack([(places[corners[:, a]] + places[corners[:, b]]) // 2 for a, b in EDGES["tetra10"]], axis=1)
        number = np.empty((3, 3, 3), np.int64)
        number[tuple(places.T)] = np.arange(len(places))
        nodes = np.hstack([nodes, np.take_along_axis(cells[owner], number[tuple(np.moveaxis(middles, 2, 0))], axis=1)])
    return Mesh(
        points=mesh.points,
        cells={_CUT[family]: nodes},
        bodies={name: (6 * own[:, None] + np.arange(6)).ravel() for name, own in mesh.bodies.items()},
        boundaries={name: tuple(triangles_of(faces[:, :4]) for faces in mesh.facets(name)) for name in mesh.boundaries},
        nodes=mesh.nodes,
    )


def cone_simplices(family: str, corners: IntArray) -> tuple[IntArray, IntArray]:
    """Triangles or tetrahedra of cells: their smallest corner joined with the facets away from it.

    Diagonals of faces go through the smallest number, so that neighbours agree.

    Parameters
    ----------
    family : of the cells
    corners : (m, k) their nodes

    Returns
    -------
    The cell of each, ascending, and its corners (n, 3 or 4)
    """
    tip = np.argmin(corners, axis=1)
    found: list[IntArray] = []
    for face in FACETS[family.rstrip("0123456789")]:
        away = (np.array(face) != tip[:, None]).all(axis=1)
        ends = corners[away][:, face]
        parts = np.moveaxis(_halves(ends), 1, 0) if len(face) == 4 else np.tile(np.arange(len(face)), (1, len(ends), 1))
        for part in parts:
            simplex = np.column_stack([np.take_along_axis(ends, part, axis=1), corners[away, tip[away]]])
            found.append(np.column_stack([np.flatnonzero(away), simplex]))
    order = np.concatenate(found)
    order = order[np.argsort(order[:, 0], kind="stable")]
    return order[:, 0], order[:, 1:]


def _halves(faces: IntArray) -> IntArray:
    """(m, 2, 3) Corners, counted in their face, of both triangles of quadrilaterals (m, 4)."""
    first = np.argmin(faces, axis=1)[:, None]
    return np.stack([(first + np.array(way)) % 4 for way in ((0, 1, 2), (0, 2, 3))], axis=1)


def triangles_of(faces: IntArray) -> IntArray:
    """(2 m, 3) Nodes of the triangles of quadrilaterals (m, 4)."""
    halves = _halves(faces)
    return np.concatenate([np.take_along_axis(faces, half, axis=1) for half in (halves[:, 0], halves[:, 1])])
