# SPDX-License-Identifier: BSD-3-Clause
"""Local axes of the pairs, and what planes of symmetry do to them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.fem.facet_block import unit_tangents
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.coupling import Coupling

_ONE_PLANE_TOL = 1e-9  # of the size of the mesh: two nodes on one plane across an axis
LEAST_SINE = 0.1
"""Between an axis and a normal: below it the axis gives no tangent."""


def in_symmetry_planes(space: Space, constraints: Constraints, coupling: Coupling) -> Array:
    """Normal areas of the pairs (k, d), in the plane of symmetry where one holds a node.

    The integral at the last node of a half model misses the other half: its component along the supported direction is
    what the mirror image takes away.

    Parameters
    ----------
    space, constraints : tell where supports hold nodes
    coupling : of the pairs
    """
    whole = coupling.normal_areas
    inside = np.where(_held(space, constraints, coupling.nodes), 0.0, whole)
    mirrored = np.linalg.norm(inside, axis=1) > 0.5 * coupling.area
    return np.where(mirrored[:, None], inside, whole)


def symmetric_partners(
    space: Space, constraints: Constraints, nodes: IntArray, normals: Array, mortar: IntArray
) -> IntArray:
    """For nodes on a plane of symmetry across an axis a mortar node on the same plane, (k, d); -1 for all others.

    A half model's pair on the plane sees mortar nodes on one side of it only, of which the mirror image would take the
    sliding away: in 2D the two nodes on the plane stand for both halves, in space nothing slides across the plane.

    Parameters
    ----------
    space, constraints : tell where supports hold nodes
    nodes : (k,) of the pairs
    normals : (k, d) of the pairs
    mortar : nodes of the mortar side
    """
    partner = np.full((len(nodes), space.dimension), -1)
    points = space.mesh.points
    close = _ONE_PLANE_TOL * float(np.ptp(points, axis=0).max())
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
        partner[mine[found], axis] = order[low[found]]
    return partner


def _held(space: Space, constraints: Constraints, nodes: IntArray) -> BoolArray:
    """(k, d) whether a support, or the axis of revolution, holds a node where it is in a direction."""
    dofs = space.dofs(nodes)[:, : space.dimension]
    held = constraints.held[dofs]
    for moved in constraints.prescribed.values():
        held &= moved[dofs] == 0.0
    return held


def tangents(normals: Array, mirrored: BoolArray, fibres: Array) -> tuple[Array, BoolArray]:
    """Unit vectors across the normals, (k, d - 1, d), and which of them (k, d - 1) nothing slides along.

    In the plane ``t = (n_y, -n_x)``. In space ``t1 x t2 = n``; t1 goes across the plane of symmetry of a pair on one.

    Parameters
    ----------
    normals : (k, d)
    mirrored : (k, d) whether a pair lies on a plane of symmetry across a coordinate axis, in space
    fibres : (k, 3) in space, direction of the first tangent; 0 leaves it to a coordinate axis
    """
    if normals.shape[1] == 2:
        return unit_tangents(normals), np.zeros((len(normals), 1), bool)
    axes = frames(normals)[:, 1:]
    for axis in np.unique(fibres[fibres.any(axis=1)], axis=0):
        own = (fibres == axis).all(axis=1)
        axes[own] = frames(normals[own], axis)[:, 1:]
    on = mirrored.any(axis=1)
    across = np.eye(3)[np.argmax(mirrored[on], axis=1)]
    axes[on] = np.stack([across, np.cross(normals[on], across)], axis=1)
    still = np.zeros((len(normals), 2), bool)
    still[on] = np.einsum("kji,ki->kj", np.abs(axes[on]), mirrored[on]) > 1.0 - 1e-9
    return axes + 0.0, still


def along_tangents(ratio: tuple[float, float], axis: tuple[float, float, float] | None, axes: Array) -> Array:
    """What belongs to the direction of an axis and across it as it belongs to the tangents, (k, d - 1).

    On a plane of symmetry the first tangent goes across the plane, which the axis may lie in.

    Parameters
    ----------
    ratio : along the axis and across it
    axis : (3,); None where both are the same
    axes : (k, d - 1, d) tangents

    Examples
    --------
    >>> along_tangents((0.5, 1.0), (1, 0, 0), np.array([np.eye(3)[:2], np.eye(3)[[1, 0]]])).tolist()
    [[0.5, 1.0], [1.0, 0.5]]
    """
    if axis is None:
        return np.full(axes.shape[:2], ratio[0])
    along = np.abs(axes @ np.array(axis, float))
    first: Array = (along[:, 0] >= along[:, 1])[:, None]
    return np.where(first, ratio, ratio[::-1])


def frames(normals: Array, axis: ArrayLike | None = None) -> Array:
    """(k, 3, 3) Rows n, t1, t2 of every pair, right-handed: t1 is the part of an axis across the normal.

    Parameters
    ----------
    normals : (k, 3) unit normals, into the nonmortar body
    axis : (3,) direction of the first tangents, of the fibres of a surface for instance; the coordinate axis that the
        normals follow least where not given. Where a normal runs along it another coordinate axis takes its place

    Raises
    ------
    InputError
        For an axis without length.

    Examples
    --------
    >>> frames(np.array([[0.0, 0.0, 1.0]]), axis=(2.0, 0.0, 5.0))[0].tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    """
    followed = (normals**2).sum(axis=0)
    direction = np.eye(3)[np.argmin(followed)] if axis is None else np.asarray(axis, dtype=np.float64)
    length = float(np.linalg.norm(direction))
    if not length > 0.0:
        raise InputError("is zero; expected a direction", where=("axis",))
    along = np.tile(direction / length, (len(normals), 1))
    across = along - np.sum(along * normals, axis=1)[:, None] * normals
    size = np.linalg.norm(across, axis=1)
    lost = size < LEAST_SINE
    least = np.eye(3)[np.argmin(np.abs(normals[lost]), axis=1)]
    across[lost] = least - np.sum(least * normals[lost], axis=1)[:, None] * normals[lost]
    first = across / np.linalg.norm(across, axis=1, keepdims=True)
    return np.stack([normals, first, np.cross(normals, first)], axis=1) + 0.0
