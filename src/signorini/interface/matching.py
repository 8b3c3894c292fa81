# SPDX-License-Identifier: BSD-3-Clause
"""Node pairs of two boundaries whose meshes match."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, IntArray
from signorini.errors import spell_point
from signorini.fem.boundary import Boundary

# of the tributary length: how far a partner may lie beside the normal
_PARTNER_TOL = 0.05


def match_nodes(
    nonmortar: Boundary, mortar: Boundary, labels: IntArray, *, faces: bool = False
) -> tuple[IntArray, str]:
    """For every nonmortar node its partner on the mortar side, one to one, or why there is none.

    The nearest node is the partner, looked for from either side: where a curved surface leaves a flat one only the
    view from the curved side is unique. A pair must lie along the normal of one of its sides.

    Parameters
    ----------
    nonmortar, mortar : both sides
    labels : (n,) numbers of all nodes, for messages
    faces : whether faces have to be opposite faces too: where a quadrilateral is opposite two triangles, or triangles
        are cut along the other diagonal, uniform pressure does not pass from node to node

    Returns
    -------
    partner : (k,) nodes, in the order of ``nonmortar.nodes``
    reason : empty where the sides match; otherwise what is in the way, in words
    """
    points, first, second = nonmortar.points, nonmortar.nodes, mortar.nodes
    if nonmortar.dimension == 3 and (nonmortar.quadratic or mortar.quadratic):
        return first, "quadratic faces have no pairs at their middle nodes; expected linear faces"
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
    wrong = (beside > _PARTNER_TOL) | twice
    if wrong.any():
        worst = int(np.argmax(np.where(wrong, beside, -1.0)))
        return partner, (
            f"node {labels[first[worst]]} at {spell_point(points[first[worst]], 6)} has no partner across the gap: the "
            f"nearest, node {labels[partner[worst]]} at {spell_point(points[partner[worst]], 6)}, lies "
            f"{beside[worst]:.2g} of a node distance beside it. Expected matching meshes, node opposite node"
        )
    facing = np.sum(own * other, axis=1)
    if (facing > 0).any():
        worst = int(np.argmax(facing))
        return partner, (
            f"the surfaces do not face each other at node {labels[first[worst]]}, "
            f"{spell_point(points[first[worst]], 6)}: both outward normals point the same way"
        )
    if faces and not _same_faces(nonmortar, mortar, partner):
        return partner, "nodes are opposite nodes, but not faces opposite faces; expected meshes that match"
    return partner, ""


def _same_faces(nonmortar: Boundary, mortar: Boundary, partner: IntArray) -> bool:
    """Whether the faces of one side are those of the other with every node replaced by its partner."""
    place = np.zeros(len(nonmortar.points), np.int64)
    place[nonmortar.nodes] = partner
    for count in (3, 4):
        one = [place[block.facets] for block in nonmortar.blocks if block.count == count]
        other = [block.facets for block in mortar.blocks if block.count == count]
        if bool(one) != bool(other) or (one and not np.array_equal(_ordered(one), _ordered(other))):
            return False
    return True


def _ordered(faces: Sequence[IntArray]) -> IntArray:
    """Faces in an order, and with their nodes in one, that depends on which they are alone."""
    rows = np.sort(np.concatenate(faces), axis=1)
    return rows[np.lexsort(rows.T)]


def facing_cells(side: Boundary, other: Boundary) -> IntArray:
    """For every facet of a side the cell of the nearest facet of the other, (m,)."""
    own, there = (np.concatenate([block.points.mean(axis=1) for block in one.blocks]) for one in (side, other))
    _, nearest = KDTree(there).query(own)
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
