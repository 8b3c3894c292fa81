# SPDX-License-Identifier: BSD-3-Clause
"""Node pairs of two boundaries whose meshes match."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, IntArray
from signorini.fem.facet_block import FacetBlock

# of the tributary length: how far a partner may lie beside the normal
_BESIDE = 0.05


class Side(Protocol):
    """What is asked of a side: a plane boundary, or a surface in space."""

    @property
    def nodes(self) -> IntArray:
        """(k,) Sorted nodes."""

    @property
    def nodal_lengths(self) -> Array:
        """(k,) Tributary length of every node."""

    @property
    def nodal_normals(self) -> Array:
        """(k, d) Outward unit normals."""


def match_nodes(points: Array, nonmortar: Side, mortar: Side, labels: IntArray) -> tuple[IntArray, str]:
    """For every nonmortar node its partner on the mortar side, one to one, or why there is none.

    The nearest node is the partner, looked for from either side: where a curved surface leaves a flat one only the
    view from the curved side is unique. A pair must lie along the normal of one of its sides.

    Parameters
    ----------
    points : (n, d) coordinates of all nodes, length
    labels : (n,) their numbers, for messages

    Returns
    -------
    partner : (k,) nodes, in the order of ``nonmortar.nodes``
    reason : empty where the sides match; otherwise what is in the way, in words
    """
    first, second = nonmortar.nodes, mortar.nodes
    if len(first) != len(second):
        return first, (
            f"the nonmortar side has {len(first)} nodes and the mortar side {len(second)}; expected matching meshes, "
            "node opposite node"
        )
    partner = _nearest(points, first, second)
    if len(np.unique(partner)) < len(partner):
        back = _nearest(points, second, first)
        if len(np.unique(back)) == len(back):
            partner = second[np.argsort(back)]
    place = np.searchsorted(second, partner)
    spacing = np.minimum(nonmortar.nodal_lengths, mortar.nodal_lengths[place])
    across = points[first] - points[partner]
    own, other = nonmortar.nodal_normals, mortar.nodal_normals[place]
    beside = np.minimum(_tangential(across, own), _tangential(across, other)) / spacing
    twice = np.bincount(place, minlength=len(second))[place] > 1
    wrong = (beside > _BESIDE) | twice
    if wrong.any():
        worst = int(np.argmax(np.where(wrong, beside, -1.0)))
        return partner, (
            f"node {labels[first[worst]]} at {_spell(points[first[worst]])} has no partner across the gap: the "
            f"nearest, node {labels[partner[worst]]} at {_spell(points[partner[worst]])}, lies {beside[worst]:.2g} of "
            "a node distance beside it. Expected matching meshes, node opposite node"
        )
    facing = np.sum(own * other, axis=1)
    if (facing > 0).any():
        worst = int(np.argmax(facing))
        return partner, (
            f"the surfaces do not face each other at node {labels[first[worst]]}, {_spell(points[first[worst]])}: both "
            "outward normals point the same way"
        )
    return partner, ""


def facing_cells(side: FacetBlock, other: FacetBlock) -> IntArray:
    """For every facet of a side the cell of the nearest facet of the other, (m,)."""
    _, nearest = KDTree(other.points.mean(axis=1)).query(side.points.mean(axis=1))
    cells: IntArray = other.cells[nearest]
    return cells


def _nearest(points: Array, of: IntArray, among: IntArray) -> IntArray:
    _, index = KDTree(points[among]).query(points[of])
    nearest: IntArray = among[index]
    return nearest


def _tangential(vectors: Array, normals: Array) -> Array:
    across = np.sum(vectors * normals, axis=1)[:, None] * normals
    size: Array = np.linalg.norm(vectors - across, axis=1)
    return size


def _spell(point: Array) -> str:
    return "(" + ", ".join(f"{part:.6g}" for part in point) + ")"
