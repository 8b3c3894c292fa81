# SPDX-License-Identifier: BSD-3-Clause
"""A rigid profile in the plane from a meshed line: the boundary of a tool, or curves that bound nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components, depth_first_order

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.meshing.facets import tool_facets
from signorini.meshing.read import read_facets, read_mesh
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Profile


def mesh_profile(mesh: Mesh, name: str, *, fillet: float = 0.0, flip: bool = False) -> Profile:
    """The profile that a boundary of a mesh has: of a meshed tool, or edges of no cell.

    The bodies are outside the tool; beside edges of no cell they are on the left of the first one's way.

    Parameters
    ----------
    mesh : of the tool, which need not be in the model, or of the model
    name : of a boundary whose facets follow each other, open or closed
    fillet : radius that rounds every corner, length; 0: sharp
    flip : the bodies are on the other side

    Raises
    ------
    InputError
        If there is no such boundary, or it is in several pieces.

    Examples
    --------
    >>> from signorini.meshing.plane import rectangle
    >>> mesh_profile(rectangle(width=2.0, height=1.0, nx=2, ny=1, origin=(0.0, 3.0)), "bottom").points
    ((2.0, 3.0), (1.0, 3.0), (0.0, 3.0))
    """
    (facets,) = tool_facets(mesh, name)
    if not mesh.bounds_nothing(name):  # the tool is on the left of its edges
        facets = np.column_stack([facets[:, 1], facets[:, 0], facets[:, 2:]])
    return _profile(mesh.points, facets, f"'{name}'", fillet, flip)


def read_profile(path: str | Path, *, boundary: str = "", fillet: float = 0.0, flip: bool = False) -> Profile:
    """Read a profile: edges of a mesh in the plane, in any format that :func:`read_mesh` reads.

    Parameters
    ----------
    path : of the file
    boundary : name of the edges (a physical curve of Gmsh); all of a file that holds nothing but edges by default
    fillet, flip : see :func:`mesh_profile`

    Raises
    ------
    InputError
        If there is no such file or boundary, or the edges do not follow each other.
    """
    facets = read_facets(path, 1, boundary)
    if facets is None:
        return mesh_profile(read_mesh(path), boundary, fillet=fillet, flip=flip)
    points, parts = facets
    if len(parts) != 1:
        raise InputError(f"'{path}' holds linear and quadratic edges; expected one order", where=("file",))
    if np.ptp(points[parts[0], 2]) > 0.0:
        raise InputError(f"'{path}' leaves the plane z = const; expected a line in the plane", where=("file",))
    return _profile(points[:, :2], parts[0], f"'{boundary or path}'", fillet, flip)


def _profile(points: Array, facets: IntArray, name: str, fillet: float, flip: bool) -> Profile:
    """Edges in any order, the bodies on the left of the first one."""
    nodes, ends = np.unique(facets[:, :2], return_inverse=True)
    ends = ends.reshape(-1, 2)
    degree = np.bincount(ends.ravel())
    if (degree > 2).any():
        at = tuple(float(x) for x in points[nodes[np.argmax(degree)]].round(9))
        raise InputError(f"{name} branches at {at}; expected edges that follow each other", where=("boundary",))
    graph = sp.csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(nodes), len(nodes)))
    if connected_components(graph, directed=False)[0] > 1:
        raise InputError(f"{name} is in several pieces; expected facets that follow each other", where=("boundary",))
    closed = bool((degree == 2).all())
    order, _ = depth_first_order(graph, int(np.argmin(degree)), directed=False)
    place = np.argsort(order)
    ahead = (place[ends[0, 1]] - place[ends[0, 0]]) % len(order) == 1
    if ahead == flip:
        order = order[::-1]
    way = nodes[order]
    if facets.shape[1] == 3:
        way = _with_middles(way, facets, closed)
    return Profile(tuple((float(x), float(y)) for x, y in points[way]), fillet=fillet, closed=closed)


def _with_middles(way: IntArray, facets: IntArray, closed: bool) -> IntArray:
    """The nodes of a way with those in the middle of its edges (m, 3)."""
    following = np.roll(way, -1) if closed else way[1:]
    before = way[: len(following)]
    count = int(facets.max()) + 1

    def key(a: IntArray, b: IntArray) -> IntArray:
        return np.minimum(a, b) * count + np.maximum(a, b)

    known = key(facets[:, 0], facets[:, 1])
    by_key = np.argsort(known)
    middle = facets[by_key[np.searchsorted(known[by_key], key(before, following))], 2]
    return np.concatenate([np.column_stack([before, middle]).ravel(), way[len(following) :]])
