# SPDX-License-Identifier: BSD-3-Clause
"""A rigid surface from the boundary of a mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import breadth_first_order

from signorini.errors import InputError, one_of
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Profile


def mesh_profile(mesh: Mesh, name: str, *, fillet: float = 0.0) -> Profile:
    """The profile that a boundary of a meshed tool has; the tool itself need not be in the model.

    Parameters
    ----------
    mesh : of the tool
    name : of a boundary whose facets follow each other, open or closed
    fillet : radius that rounds every corner, length; 0: sharp

    Raises
    ------
    InputError
        If there is no such boundary, or it is in several pieces.

    Examples
    --------
    >>> from signorini.fem.generators import rectangle
    >>> mesh_profile(rectangle(width=2.0, height=1.0, nx=2, ny=1, origin=(0.0, 3.0)), "bottom").points
    ((2.0, 3.0), (1.0, 3.0), (0.0, 3.0))
    """
    if name not in mesh.boundaries:
        raise InputError(one_of(name, mesh.boundaries, "boundary"), where=("boundary",))
    side = boundary(make_space(mesh), name, ("boundary",))
    start, end = (np.searchsorted(side.nodes, side.facets[:, i]) for i in (0, 1))
    count = len(side.nodes)
    # the tool is on the left of its facets: from their ends to their starts the bodies are
    way = sp.csr_array((np.ones(len(start)), (end, start)), shape=(count, count))
    corners = np.unique(np.concatenate([start, end]))
    first = np.setdiff1d(end, start)
    closed = not len(first)
    order, _ = breadth_first_order(way, int(corners[0] if closed else first[0]), directed=True)
    if len(order) != len(corners):
        raise InputError(f"'{name}' is in several pieces; expected facets that follow each other", where=("boundary",))
    points = [tuple(float(x) for x in mesh.points[node]) for node in side.nodes[order]]
    if side.quadratic:
        facet = np.argsort(end)[np.searchsorted(np.sort(end), order if closed else order[:-1])]
        middles = [tuple(float(x) for x in mesh.points[node]) for node in side.facets[facet, 2]]
        pairs = zip(points, [*middles, *([] if closed else [()])], strict=True)
        points = [point for pair in pairs for point in pair if point]
    return Profile(tuple((x, y) for x, y in points), fillet=fillet, closed=closed)
