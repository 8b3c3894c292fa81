# SPDX-License-Identifier: BSD-3-Clause
"""Initial gaps: from the geometry or as asked for, without what chords of curved surfaces feign."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.facet_block import FacetBlock
from signorini.interface.coupling import Coupling
from signorini.model.contact import Contact

_KINK = np.pi / 6.0  # a turn between two facets beyond this is a corner, not a curve
_STRAIGHT = 1e-9  # a turn, or a bulge of a length of one, below this is rounding
_DIGITS = 16.0 * float(np.finfo(np.float64).eps)  # of a coordinate: what two of them that are the same may differ by
_ROOM = 1.25  # times the bound: curvatures are estimates


def initial_gaps(geometry: Array, contact: Contact, one: Array, *, farthest: float) -> Array:
    """What a contact makes of the gaps that the geometry has, (n,) length, negative: overlap.

    Gaps that are rounding of coordinates are none: beside small loads they would be, and where supports hold both sides
    an overlap of a last digit would prove that nothing is in equilibrium.

    Parameters
    ----------
    farthest : largest coordinate of the mesh
    one : (n,) what pairs see of a gap of length 1 along the normals of the nonmortar side, see :func:`normal_gap`
    """
    geometry = np.where(np.abs(geometry) > _DIGITS * farthest, geometry, 0.0)
    if contact.gap == "zero" or contact.tied:
        gap = np.zeros(len(geometry))
    elif contact.gap == "geometry":
        gap = geometry if contact.adjust is None else np.where(geometry <= contact.adjust, 0.0, geometry)
    else:
        gap = contact.gap * one
    return gap - contact.interference * one


def normal_gap(coupling: Coupling, nodes: IntArray, normals: Array, distance: Array) -> Array:
    """What pairs see of a gap that is known at the nodes of the nonmortar side, along the normals there, (n,).

    On curved quadratic sides the normals turn between the nodes of a pair: a gap of 1 is a little more than 1 along
    the pair's own normal.

    Parameters
    ----------
    nodes : (m,) of the nonmortar side
    normals : (m, d) into the nonmortar body; a pair's own is that of the coupling
    distance : (m,) length
    """
    vectors = np.zeros((coupling.forces[0].shape[1], normals.shape[1]))
    vectors[nodes] = normals
    vectors[coupling.nodes] = coupling.normals
    vectors[nodes] *= distance[:, None]
    seen = sum(force @ part for force, part in zip(coupling.forces, vectors.T, strict=True))
    return np.asarray(seen / coupling.area)


def resolved(gap: Array, coupling: Coupling) -> Array:
    """Mean gaps (k,), raised to the smallest one that any point has where facets are too long for a mean.

    Dual functions are negative in part: along a parabola the mean gap is smaller than that at the node by a sixth of
    what it grows to on a facet from the vertex. Where a short facet meets one so long that the mean is smaller by more
    than the gap varies on the short one, it can be negative though everything is far apart.
    """
    if coupling.facets is None:
        return gap
    facets, nodes = coupling.facets, coupling.nodes
    size = int(max(facets.corners.max(), nodes.max())) + 1
    own, least, varies = (np.full(size, np.inf) for _ in range(3))
    np.minimum.at(own, facets.corners, facets.ends)
    np.minimum.at(least, facets.corners, facets.low[:, None])
    np.minimum.at(varies, facets.corners, (facets.high - facets.low)[:, None])
    own = np.where(np.isfinite(own), own, -np.inf)  # corners that nothing is opposite are no measure
    lost = own[nodes] - gap > varies[nodes] + _STRAIGHT * np.abs(own[nodes])
    return np.where(lost, np.maximum(gap, least[nodes]), gap)


def without_chords(gap: Array, coupling: Coupling, nonmortar: FacetBlock, mortar: FacetBlock) -> Array:
    """Gaps (n,), 0 where they are no more than what facets leave between two surfaces that are meant to match.

    Two different polygons on one curve of curvature kappa are up to ``h^2 kappa / 8`` of both apart, parabolas
    ``h^4 kappa^3 / 512``: it would ruin the pressure. All gaps must be as small as that, and one side hollow where the
    other bulges: otherwise they are meant, and stay.

    Parameters
    ----------
    gap : (n,) from the geometry, length
    coupling : of the two sides
    """
    own, other = (_parabola_sags(side) if side.quadratic else _chord_sags(side) for side in (nonmortar, mortar))
    mine, opposite = np.zeros(coupling.relative.shape[1]), np.zeros(coupling.relative.shape[1])
    mine[nonmortar.nodes], opposite[mortar.nodes] = own, other
    mine = mine[coupling.nodes]
    pattern = coupling.relative.tocoo()
    fits = np.zeros(len(gap))  # the largest sag of the other side that is hollow where this one bulges
    np.maximum.at(fits, pattern.row, -np.sign(mine)[pattern.row] * opposite[pattern.col])
    meant = (mine == 0.0) | (fits == 0.0) | (np.abs(gap) > _ROOM * (np.abs(mine) + fits))
    return gap if meant.any() else np.zeros_like(gap)


def _chord_sags(side: FacetBlock) -> Array:
    """Largest ``h^2 kappa / 8`` of the straight facets at each node, positive where the side bulges, (k,)."""
    start, end = (np.searchsorted(side.nodes, side.facets[:, i]) for i in (0, 1))
    leaving = np.full(len(side.nodes), -1)
    leaving[start] = np.arange(len(start))
    following = leaving[end]
    one, two = side.normals, side.normals[following]
    turn = np.arctan2(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], np.sum(one * two, axis=1))
    smooth = (following >= 0) & (np.abs(turn) < _KINK) & (np.abs(turn) > _STRAIGHT)
    at, turn = end[smooth], turn[smooth]
    here, after = side.lengths[smooth], side.lengths[following[smooth]]
    result = np.zeros(len(side.nodes))
    result[at] = turn * np.maximum(here, after) ** 2 / (4.0 * (here + after))  # kappa = 2 turn / (h_1 + h_2)
    # at the ends of a side the curve goes on as beside them
    for near, far in ((start[smooth], at), (end[following[smooth]], at)):
        lone = result[near] == 0.0
        result[near[lone]] = result[far[lone]]
    return result


def _parabola_sags(side: FacetBlock) -> Array:
    """Largest ``h^4 kappa^3 / 512`` of the quadratic facets at each node, positive where the side bulges, (k,)."""
    first, second, middle = (side.points[:, i] for i in range(3))
    length = np.linalg.norm(second - first, axis=1)
    bulge = np.sum((middle - 0.5 * (first + second)) * side.normals, axis=1)
    bulge[np.abs(bulge) < _STRAIGHT * length] = 0.0
    sag = bulge**3 / length**2  # kappa = 8 bulge / h^2
    result = np.zeros(len(side.nodes))
    place = np.searchsorted(side.nodes, side.facets)
    np.maximum.at(result, place, np.maximum(sag, 0.0)[:, None])
    hollow = np.zeros(len(side.nodes))
    np.minimum.at(hollow, place, np.minimum(sag, 0.0)[:, None])
    return np.where(result > 0.0, result, hollow)


def refuse_deep_overlap(gap: Array, numbers: IntArray, contact: Contact, element: float, where: Where) -> None:
    """An overlap of more than an element is no small displacement.

    Raises
    ------
    InputError
        With the node where it is deepest.
    """
    if len(gap) and -gap.min() > element:
        worst = int(np.argmin(gap))
        by = f" with the interference of {contact.interference:g}" if contact.interference else ""
        raise InputError(
            f"the two sides overlap{by} by {-gap[worst]:.4g} at node {numbers[worst]}, more than the longest facet "
            f"there, {element:.4g}; displacements are small here. Expected bodies that hardly overlap: move one, or "
            "say gap = 'zero' or adjust",
            where=where,
        )
