# SPDX-License-Identifier: BSD-3-Clause
"""Local axes of the pairs, and what planes of symmetry do to them."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.boundary import Boundary
from signorini.fem.space import Space
from signorini.fem.supports import Constraints

_SAME = 1e-9  # of the size of the mesh: two nodes on one plane across an axis


def side_normals(space: Space, constraints: Constraints, side: Boundary, nodes: IntArray) -> Array:
    """Minus the averaged outward normals at nodes of a side, (k, d); in the plane of symmetry where one holds a node.

    The average at the last node of a half model misses the other half: its component along the supported direction is
    what the mirror image takes away.
    """
    normals = -side.nodal_normals[np.searchsorted(side.nodes, nodes)]
    inside = np.where(_held(space, constraints, nodes), 0.0, normals)
    size = np.linalg.norm(inside, axis=1)
    mirrored = size > 0.5
    normals[mirrored] = inside[mirrored] / size[mirrored, None]
    return normals


def symmetric_partners(
    space: Space, constraints: Constraints, nodes: IntArray, normals: Array, mortar: IntArray
) -> IntArray:
    """For nodes on a plane of symmetry the mortar node on the same plane, (k,); -1 for all others.

    A half model's pair on the plane sees mortar nodes on one side of it only, of which the mirror image would take the
    sliding away: the two nodes on the plane stand for both halves.

    Parameters
    ----------
    mortar : nodes of the mortar side
    """
    partner = np.full(len(nodes), -1)
    points = space.mesh.points
    close = _SAME * float(np.ptp(points, axis=0).max())
    own, other = _held(space, constraints, nodes), _held(space, constraints, mortar)
    for axis in range(space.dimension):
        there = mortar[other[:, axis]]
        mine = np.nonzero(own[:, axis] & (np.abs(normals[:, axis]) < 1e-9))[0]
        if not len(there) or not len(mine):
            continue
        order = there[np.argsort(points[there, axis], kind="stable")]
        x, y = points[nodes[mine], axis], points[order, axis]
        low = np.searchsorted(y, x - close)
        found = (low < len(y)) & (y[np.minimum(low, len(y) - 1)] <= x + close)
        partner[mine[found]] = order[low[found]]
    return partner


def _held(space: Space, constraints: Constraints, nodes: IntArray) -> BoolArray:
    """(k, d) whether a support, or the axis of revolution, holds a node in a direction."""
    return np.asarray(constraints.free[space.dofs(nodes)] < 0)
