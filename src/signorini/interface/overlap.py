# SPDX-License-Identifier: BSD-3-Clause
"""Which facets of two sides lie opposite each other, and over what piece; plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, Where
from signorini.fem.facet_block import FacetBlock
from signorini.fem.line import line_shapes
from signorini.interface.near import near
from signorini.interface.tilt import normals_between, turns

FACING = -0.05  # cosine between outward normals: from here on two facets look at each other
_EMPTY = 1e-12  # of the length of a facet: a shorter piece is none


@dataclass(frozen=True, kw_only=True, eq=False)
class Overlaps:
    """Pieces of facets opposite each other, measured across the normal along which they see each other.

    Attributes
    ----------
    first, second : (p,) facets of the nonmortar and of the mortar side
    outward : (p, 2) that normal, out of the nonmortar body: of the facet's chord, or between both sides
    low, high : (p,) where the piece begins and ends, length from the first node of the nonmortar facet
    own, other : (p, 2 or 3) places of the nodes of both facets, length
    """

    first: IntArray
    second: IntArray
    outward: Array
    low: Array
    high: Array
    own: Array
    other: Array


def parameter(places: Array, at: Array) -> Array:
    """Coordinate s in [-1, 1] of a facet where its place along a line is given: ``x(s) = at``.

    Parameters
    ----------
    places : (p, 2 or 3) places of its nodes; they must go one way
    at : (p, q)

    Returns
    -------
    (p, q)
    """
    first, second = places[:, :1], places[:, 1:2]
    slope, middle = 0.5 * (second - first), 0.5 * (first + second)
    if places.shape[1] == 2:
        return np.asarray((at - middle) / slope)
    bend, centre = middle - places[:, 2:], places[:, 2:]
    root = np.sqrt(np.maximum(slope**2 + 4.0 * bend * (at - centre), 0.0))
    return np.asarray(2.0 * (at - centre) / (slope + np.sign(slope) * root))


def interpolate(points: Array, s: Array) -> Array:
    """Points (p, q, d) at coordinates s (p, q) of facets with nodes (p, 2 or 3, d)."""
    shapes, _ = line_shapes(points.shape[1], s.ravel())
    found: Array = np.einsum("pqa,pad->pqd", shapes.reshape(*s.shape, points.shape[1]), points)
    return found


def find_overlaps(
    points: Array, nonmortar: FacetBlock, mortar: FacetBlock, search: float | None, where: Where, share: float = 0.5
) -> Overlaps:
    """Pieces of facets that look at each other, along the normals between both sides where these are tilted.

    Parameters
    ----------
    points : (n, 2) of all nodes
    search : how far apart they can be, length; None: half the size of the smaller side
    share : of the nonmortar side in the stiffness of both, see :mod:`signorini.interface.tilt`

    Raises
    ------
    InputError
        If there are none: because the sides look the same way, or are too far apart.
    """
    search = search_distance(points, nonmortar, mortar, search)
    first, second = _near(points, nonmortar, mortar, search)
    facing = np.sum(nonmortar.normals[first] * mortar.normals[second], axis=1) < FACING
    found, distance = _pieces(points, nonmortar, mortar, first, second, nonmortar.normals)
    there = _within(found, distance, search, nonmortar.lengths)
    if not (there & facing).any():
        raise _apart(points, nonmortar, mortar, first[there], search, where)
    found, distance = _take(found, there & facing), distance[there & facing]
    seen = _take(found, _nearest_layer(found, np.abs(distance), nonmortar.lengths))
    outward = _between(nonmortar, mortar, seen, share)
    found, distance = _pieces(points, nonmortar, mortar, first[facing], second[facing], outward)
    there = _within(found, distance, search, nonmortar.lengths)
    found, distance = _take(found, there), distance[there]
    return _take(found, _nearest_layer(found, np.abs(distance), nonmortar.lengths))


def _within(found: Overlaps, distance: Array, search: float, lengths: Array) -> BoolArray:
    """Pieces that have a length and are near enough."""
    return (found.high - found.low > _EMPTY * lengths[found.first]) & (np.abs(distance) <= search)


def _between(nonmortar: FacetBlock, mortar: FacetBlock, seen: Overlaps, share: float) -> Array:
    """(m, 2) Outward normals along which the facets of the nonmortar side see what is opposite."""
    own, other = (turns(side.normals, _at_nodes(side)) for side in (nonmortar, mortar))
    np.maximum.at(own, seen.first, other[seen.second])
    opposite = np.zeros_like(nonmortar.normals)
    np.add.at(opposite, seen.first, (seen.high - seen.low)[:, None] * mortar.normals[seen.second])
    return normals_between(nonmortar.normals, opposite, own, share)


def _at_nodes(side: FacetBlock) -> Array:
    """(m, k, 2) Mean normals of a side at the nodes of its facets."""
    return side.nodal_normals[np.searchsorted(side.nodes, side.facets)]


def search_distance(points: Array, nonmortar: FacetBlock, mortar: FacetBlock, search: float | None) -> float:
    """How far apart facets can be and still be opposite each other: as given, or half the size of the smaller side."""
    if search is not None:
        return search
    return min(0.5 * float(np.linalg.norm(np.ptp(points[side.nodes], axis=0))) for side in (nonmortar, mortar))


def _near(points: Array, nonmortar: FacetBlock, mortar: FacetBlock, search: float) -> tuple[IntArray, IntArray]:
    """Pairs of facets that may be opposite each other."""
    ends = [points[side.facets[:, :2]] for side in (nonmortar, mortar)]
    centres = [end.mean(axis=1) for end in ends]
    radii = [side.lengths / 2.0 for side in (nonmortar, mortar)]
    return near(centres[0], centres[1], radii[0] + radii[1].max(), search)


def _pieces(
    points: Array, nonmortar: FacetBlock, mortar: FacetBlock, first: IntArray, second: IntArray, outward: Array
) -> tuple[Overlaps, Array]:
    """Pieces of all pairs, empty ones included, and the distances at their middles along normals (m, 2)."""
    one, two, normal = points[nonmortar.facets[first]], points[mortar.facets[second]], outward[first]
    along = np.column_stack([-normal[:, 1], normal[:, 0]])
    own, other = (np.einsum("pad,pd->pa", x - one[:, :1], along) for x in (one, two))
    low = np.maximum(0.0, other[:, :2].min(axis=1))
    high = np.minimum(own[:, 1], other[:, :2].max(axis=1))
    middle = np.maximum(0.5 * (low + high), 0.0)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # a facet along the normal has no piece
        across = interpolate(two, parameter(other, middle)) - interpolate(one, parameter(own, middle))
        distance = np.nan_to_num(np.einsum("pqd,pd->p", across, normal), nan=np.inf)
    return Overlaps(first=first, second=second, outward=normal, low=low, high=high, own=own, other=other), distance


def _nearest_layer(found: Overlaps, distance: Array, lengths: Array) -> BoolArray:
    """Of pieces that lie behind each other only the nearest."""
    covered = np.bincount(found.first, found.high - found.low, len(lengths))
    layered = np.nonzero(covered[found.first] > lengths[found.first] * (1.0 + 1e-9))[0]
    keep = np.ones(len(found.first), bool)
    order = layered[np.argsort(found.first[layered], kind="stable")]
    _, start, count = np.unique(found.first[order], return_index=True, return_counts=True)
    per_piece = np.repeat(count, count)
    one = np.repeat(order, per_piece)
    offset = np.arange(len(one)) - np.repeat(np.cumsum(per_piece) - per_piece, per_piece)
    two = order[np.repeat(np.repeat(start, count), per_piece) + offset]
    shared = np.minimum(found.high[one], found.high[two]) - np.maximum(found.low[one], found.low[two])
    behind = (shared > 1e-9 * lengths[found.first[one]]) & (distance[one] > distance[two])
    keep[one[behind]] = False
    return keep


def _take(found: Overlaps, chosen: BoolArray) -> Overlaps:
    return Overlaps(**{key: getattr(found, key)[chosen] for key in Overlaps.__dataclass_fields__})


def _apart(
    points: Array, nonmortar: FacetBlock, mortar: FacetBlock, turned: IntArray, search: float, where: Where
) -> InputError:
    """Why no facets are opposite each other."""
    if len(turned):
        node = nonmortar.facets[turned[0], 0]
        at = ", ".join(f"{x:.6g}" for x in points[node])
        return InputError(
            f"the surfaces do not face each other at ({at}): both outward normals point the same way",
            where=where,
        )
    distance, nearest = KDTree(points[mortar.nodes]).query(points[nonmortar.nodes])
    closest = int(np.argmin(distance))
    cosine = float(nonmortar.nodal_normals[closest] @ mortar.nodal_normals[nearest[closest]])
    found = (
        f"the nearest nodes are {distance[closest]:.4g} apart, "
        f"their outward normals {np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))):.0f} degrees"
    )
    return InputError(
        f"no facets of the two sides lie opposite each other: looked for up to {search:.4g} along the normals; {found}"
        ". Expected surfaces that face each other, normals 180 degrees apart, or another 'search'",
        where=where,
    )
