# SPDX-License-Identifier: BSD-3-Clause
"""A rigid surface in space from a mesh: the boundary of a tool, or faces that bound nothing, as in STL files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.meshing.facets import tool_facets
from signorini.meshing.read import read_facets, read_mesh
from signorini.model.mesh import Mesh
from signorini.model.triangulated import Surface

# triangles of a face by the number of its nodes: corners, then middles of edges, then the middle
_TRIANGLES = {
    3: [[0, 1, 2]],
    4: [[0, 1, 2], [0, 2, 3]],
    6: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    8: [[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]],
    9: [[0, 4, 8], [4, 1, 8], [1, 5, 8], [5, 2, 8], [2, 6, 8], [6, 3, 8], [3, 7, 8], [7, 0, 8]],
}


def mesh_surface(mesh: Mesh, name: str, *, flip: bool = False) -> Surface:
    """The rigid surface that a boundary of a mesh in space has: of a meshed tool, or faces of no cell.

    The bodies are outside the tool; beside faces of no cell they are where the corners go counter-clockwise.

    Parameters
    ----------
    mesh : of the tool, which need not be in the model, or of the model
    name : of a boundary; quadrilaterals and quadratic faces are cut into triangles
    flip : the bodies are on the other side

    Raises
    ------
    InputError
        If there is no such boundary, the mesh is plane, or its faces make no surface, see :class:`Surface`.

    Examples
    --------
    >>> from signorini.meshing.solid import box
    >>> top = mesh_surface(box(x=[0, 1, 2], y=[0, 1], z=[0, 1]), "top")
    >>> print(top, top.nearest([[0.5, 0.5, 3.0]])[0])
    an open surface of 4 triangles [2.]
    """
    parts = tool_facets(mesh, name)
    if mesh.points.shape[1] != 3:
        raise InputError(f"'{name}' lies in the plane; expected a mesh in space", where=("boundary",))
    return _surface(mesh.points, parts, flip)


def read_surface(path: str | Path, *, boundary: str = "", flip: bool = False) -> Surface:
    """Read a rigid surface in space: STL, or faces of a mesh in any format that :func:`read_mesh` reads.

    Parameters
    ----------
    path : of the file
    boundary : name of the faces (a physical surface of Gmsh); all of a file without solid cells by default
    flip : the bodies are on the other side than where the corners go counter-clockwise; of a meshed solid, inside it

    Raises
    ------
    InputError
        If there is no such file or boundary, or its faces make no surface, see :class:`Surface`.
    """
    facets = read_facets(path, 2, boundary)
    if facets is None:
        return mesh_surface(read_mesh(path), boundary, flip=flip)
    points, parts = facets
    return _surface(points, parts, flip)


def _surface(points: Array, parts: Sequence[IntArray], flip: bool) -> Surface:
    cut = [part[:, corners] for part in parts for corners in _TRIANGLES[part.shape[1]]]
    triangles = np.concatenate(cut)
    a, b, c = points[triangles].transpose(1, 0, 2)
    # writers of STL round points of small triangles into one; those triangles are lines and leave no hole
    lines = (a == b).all(axis=1) | (b == c).all(axis=1) | (c == a).all(axis=1)
    surface = Surface(points, triangles[~lines])
    return surface.reverse() if flip else surface
