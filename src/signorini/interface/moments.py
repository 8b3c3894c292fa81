# SPDX-License-Identifier: BSD-3-Clause
"""Moments of the forces of pairs on the nonmortar side, where they act."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.space import Space


def moments_of_rows(B: sp.csr_array, space: Space, own: Sequence[IntArray], contact: IntArray) -> Array:
    """Moments about the origin of unit forces of all rows of B on the nonmortar side, ``sum_j x_j x B_j``.

    A pair of a quadratic facet bears at all its nodes; taken as a force at its corner it would turn too much or too
    little.

    Parameters
    ----------
    B : (rows, dofs) see :class:`signorini.interface.interface.Interface`
    space : of all nodes
    own : nodes of the nonmortar side of every contact
    contact : (rows,) the contact that a row belongs to

    Returns
    -------
    (rows, 1) in the plane, counterclockwise, with twist about the axis of revolution; (rows, 3) in space; length
    """
    points, c = space.mesh.points, space.components
    rows = np.repeat(np.arange(B.shape[0]), np.diff(B.indptr))
    node, axis = np.divmod(B.indices.astype(np.int64), c)
    inside: BoolArray = np.zeros((len(own), len(points)), np.bool_)
    for i, nodes in enumerate(own):
        inside[i, nodes] = True
    there = node < len(points)
    there[there] = inside[contact[rows[there]], node[there]]
    row, node, axis, value = rows[there], node[there], axis[there], B.data[there]
    x = points[node]
    if c > space.dimension:
        arm = np.where(axis == 2, x[:, 0], 0.0)[:, None]
    else:
        arm = np.where(axis == 1, x[:, 0], -x[:, 1])[:, None] if c == 2 else np.cross(x, np.eye(3)[axis])
    result = np.zeros((B.shape[0], arm.shape[1]))
    np.add.at(result, row, value[:, None] * arm)
    return result
