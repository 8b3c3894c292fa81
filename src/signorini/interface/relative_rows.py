# SPDX-License-Identifier: BSD-3-Clause
"""Relative displacements of pairs in terms of all unknowns: the rows of B, and the moments of their forces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.obstacles import carried, placed
from signorini.fem.space import Space
from signorini.interface.coupling import along
from signorini.interface.hoop import hoop_rows
from signorini.interface.pairing import Pairs
from signorini.model.model import Model
from signorini.sparse_rows import added, of_entries, scaled_rows, stacked


def relative_rows(
    space: Space, model: Model, parts: Sequence[Pairs], normals: Array, axes: Array, still: BoolArray
) -> sp.csr_array:
    """(d n, dofs) The normal rows of all pairs, then those along every tangent.

    Parameters
    ----------
    space, model : of the pairs
    parts : the pairs of every contact
    normals, axes : (n, d) and (n, d - 1, d) unit vectors
    still : (n, d - 1) tangents along which nothing moves
    """
    count, area = len(space.mesh.points), np.concatenate([np.empty(0), *(part.coupling.area for part in parts)])
    closing, sliding = (
        tuple(scaled_rows(_stacked([part[i] for part in of], count), 1.0 / area) for i in range(space.dimension))
        for of in ([part.coupling.forces for part in parts], [part.sliding for part in parts])
    )
    carrier = np.repeat([part.obstacle for part in parts], [len(part.gap) for part in parts]).astype(int)
    rows = [_with_obstacles(space, model, carrier, closing)]
    for k in range(space.dimension - 1):
        slid = _with_obstacles(space, model, carrier, _sliding_rows(sliding, normals, axes[:, k]))
        rows.append(scaled_rows(slid, np.where(still[:, k], 0.0, 1.0)))
    if model.twists:
        nothing, radii = sp.csr_array(closing[0].shape), space.mesh.points[:, 0]
        twisted = _stacked([hoop_rows(part.coupling, part.own, radii) for part in parts], count)
        around = scaled_rows(twisted, 1.0 / area)
        rows.append(_with_obstacles(space, model, carrier, (nothing, nothing, around)))
    B = stacked(rows)
    B.sum_duplicates()  # entries in order from the start: sums do not depend on who has looked at them before
    return B


def _stacked(rows: Sequence[sp.csr_array], count: int) -> sp.csr_array:
    """Rows (k, count) one below the other; of one matrix, which most models have, itself."""
    return rows[0] if len(rows) == 1 else stacked([sp.csr_array((0, count)), *rows])


def _about(space: Space, model: Model, j: int) -> Array:
    """(d,) Where the point is about which obstacle j turns."""
    where = placed(space, model, j)
    return where.about + where.shift


def _sliding_rows(closing: tuple[sp.csr_array, ...], normals: Array, axes: Array) -> tuple[sp.csr_array, ...]:
    """Rows of the sliding along one axis t of every pair: what turns n into t, ``t n^T - n t^T``, turns them too.

    In the plane that is the exact turn by a right angle: where the weights of the gap follow the normals along a curved
    side, those of the sliding follow its tangents, and a uniform friction passes as exactly as a uniform pressure.
    """
    onto, aside = along(closing, normals), along(closing, axes)
    return tuple(
        added(scaled_rows(onto, axes[:, i]), scaled_rows(aside, normals[:, i]), -1.0) for i in range(axes.shape[1])
    )


def _with_obstacles(space: Space, model: Model, carrier: IntArray, weights: tuple[sp.csr_array, ...]) -> sp.csr_array:
    """Rows ``sum_ji weights_kji u_ji`` in terms of all unknowns: moving obstacles take the nonmortar side with them."""
    rows = np.concatenate([np.repeat(np.arange(len(carrier)), np.diff(part.indptr)) for part in weights])
    columns = np.concatenate([space.dofs(part.indices.astype(np.int64))[:, i] for i, part in enumerate(weights)])
    values = np.concatenate([part.data for part in weights])
    bodies = of_entries(values, rows, columns, (len(carrier), space.dofs_of_nodes))
    bodies.eliminate_zeros()
    if not model.obstacles and not model.rigid_bodies:
        return bodies
    width = 2 * space.components
    moved = np.zeros((len(carrier), width * (len(model.obstacles) + len(model.rigid_bodies))))
    for j in range(len(model.obstacles)):
        own = np.flatnonzero(carrier == j)
        seen = np.unique(np.concatenate([part[own].indices for part in weights]))
        motions = carried(model, space.mesh.points[seen], _about(space, model, j))
        of_pairs = sum(part[own][:, seen] @ motions[:, i] for i, part in enumerate(weights))
        moved[own, width * j : width * (j + 1)] = -of_pairs
    return sp.csr_array(sp.hstack([bodies, sp.csr_array(moved)]))


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
