# SPDX-License-Identifier: BSD-3-Clause
"""Node pairs of two boundaries whose meshes match."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary

# of the tributary length: how far a partner may lie beside the normal
_BESIDE = 0.05


def match_nodes(points: Array, nonmortar: Boundary, mortar: Boundary, where: Where) -> IntArray:
    """For every nonmortar node its partner on the mortar side, one to one.

    The nearest node is the partner, looked for from either side: where a curved surface leaves a flat one only the
    view from the curved side is unique. A pair must lie along the normal of one of its sides.

    Parameters
    ----------
    points : (n, 2) coordinates of all nodes, length

    Returns
    -------
    (k,) nodes, in the order of ``nonmortar.nodes``

    Raises
    ------
    InputError
        If the sides have different numbers of nodes, or a node has no partner of its own across the gap.
    """
    shared = np.intersect1d(nonmortar.nodes, mortar.nodes)
    if len(shared):
        raise InputError(
            f"both sides hold node {shared[0] + 1}; bodies that touch need nodes of their own", where=where
        )
    first, second = nonmortar.nodes, mortar.nodes
    if len(first) != len(second):
        raise InputError(
            f"the nonmortar side has {len(first)} nodes and the mortar side {len(second)}; expected matching meshes, "
            "node opposite node",
            where=where,
        )
    partner = _nearest(points, first, second)
    if len(np.unique(partner)) < len(partner):
        back = _nearest(points, second, first)
        if len(np.unique(back)) == len(back):
            partner = second[np.argsort(back)]
    spacing = np.minimum(nonmortar.nodal_lengths, mortar.nodal_lengths[np.searchsorted(second, partner)])
    across = points[first] - points[partner]
    own, other = nonmortar.nodal_normals, mortar.nodal_normals[np.searchsorted(second, partner)]
    beside = np.minimum(_tangential(across, own), _tangential(across, other)) / spacing
    twice = np.bincount(np.searchsorted(second, partner), minlength=len(second))[np.searchsorted(second, partner)] > 1
    wrong = (beside > _BESIDE) | twice
    if wrong.any():
        worst = int(np.argmax(np.where(wrong, beside, -1.0)))
        raise InputError(
            f"node {first[worst] + 1} at {_spell(points[first[worst]])} has no partner across the gap: the nearest, "
            f"node {partner[worst] + 1} at {_spell(points[partner[worst]])}, lies {beside[worst]:.2g} of a node "
            "distance beside it. Expected matching meshes, node opposite node",
            where=where,
        )
    facing = np.sum(own * other, axis=1)
    if (facing > 0).any():
        worst = int(np.argmax(facing))
        raise InputError(
            f"the surfaces do not face each other at node {first[worst] + 1}, {_spell(points[first[worst]])}: both "
            "outward normals point the same way",
            where=where,
        )
    return partner


def _nearest(points: Array, of: IntArray, among: IntArray) -> IntArray:
    _, index = KDTree(points[among]).query(points[of])
    nearest: IntArray = among[index]
    return nearest


def _tangential(vectors: Array, normals: Array) -> Array:
    across = np.sum(vectors * normals, axis=1)[:, None] * normals
    size: Array = np.linalg.norm(vectors - across, axis=1)
    return size


def _spell(point: Array) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"
