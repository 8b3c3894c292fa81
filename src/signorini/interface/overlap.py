# SPDX-License-Identifier: BSD-3-Clause
"""Which facets of two sides lie opposite each other, and over what piece; plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, BoolArray, IntArray, sharing
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary
from signorini.fem.facet_block import FacetBlock
from signorini.fem.facets import line_shapes
from signorini.interface.facing import FACING, near, search_distance
from signorini.interface.tilt import normals_between, turning_angles

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
    found: Array = np.einsum("pqa,pad->pqd", line_shapes(points.shape[1], s)[0], points)
    return found


def find_overlaps(
    nonmortar: Boundary, mortar: Boundary, *, share: float = 0.5, search: float | None = None, where: Where = ()
) -> Overlaps:
    """Pieces of facets that look at each other, along the normals between both sides where these are tilted.

    Parameters
    ----------
    nonmortar, mortar : both sides
    share : of the nonmortar side in the stiffness of both, see :mod:`signorini.interface.tilt`
    search : how far apart they can be, length; None: half the size of the smaller side
    where : what errors call the contact

    Raises
    ------
    InputError
        If there are none: because the sides look the same way, or are too far apart.
    """
    (own,), (other,) = nonmortar.blocks, mortar.blocks
    search = search_distance(nonmortar, mortar, search)
    first, second = _near(own, other, search)
    facing = np.sum(own.normals[first] * other.normals[second], axis=1) < FACING
    found, distance = _pieces(own, other, first, second, own.normals)
    there = _within(found, distance, search, own.lengths)
    if not (there & facing).any():
        raise _apart(nonmortar, mortar, first[there], search, where)
    found, distance = _take(found, there & facing), distance[there & facing]
    seen = _take(found, _nearest_layer(found, np.abs(distance), own.lengths))
    outward = _between(nonmortar, mortar, seen, share)
    found, distance = _pieces(own, other, first[facing], second[facing], outward)
    there = _within(found, distance, search, own.lengths)
    found, distance = _take(found, there), distance[there]
    return _take(found, _nearest_layer(found, np.abs(distance), own.lengths))


def _within(found: Overlaps, distance: Array, search: float, lengths: Array) -> BoolArray:
    """Pieces that have a length and are near enough."""
    return (found.high - found.low > _EMPTY * lengths[found.first]) & (np.abs(distance) <= search)


def _between(nonmortar: Boundary, mortar: Boundary, seen: Overlaps, share: float) -> Array:
    """(m, 2) Outward normals along which the facets of the nonmortar side see what is opposite."""
    (one,), (two,) = nonmortar.blocks, mortar.blocks
    turn = turning_angles(one.normals, nonmortar.at_facets(one))
    np.maximum.at(turn, seen.first, turning_angles(two.normals, mortar.at_facets(two))[seen.second])
    opposite = np.zeros_like(one.normals)
    np.add.at(opposite, seen.first, (seen.high - seen.low)[:, None] * two.normals[seen.second])
    return normals_between(one.normals, opposite, turn, share)


def _near(nonmortar: FacetBlock, mortar: FacetBlock, search: float) -> tuple[IntArray, IntArray]:
    """Pairs of facets that may be opposite each other."""
    centres = [side.points[:, :2].mean(axis=1) for side in (nonmortar, mortar)]
    radii = [side.lengths / 2.0 for side in (nonmortar, mortar)]
    return near(centres[0], centres[1], radii[0], radii[1], search)


def _pieces(
    nonmortar: FacetBlock, mortar: FacetBlock, first: IntArray, second: IntArray, outward: Array
) -> tuple[Overlaps, Array]:
    """Pieces of all pairs, empty ones included, and the distances at their middles along normals (m, 2)."""
    one, two, normal = nonmortar.points[first], mortar.points[second], outward[first]
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
    one, two = (layered[part] for part in sharing(found.first[layered]))
    shared = np.minimum(found.high[one], found.high[two]) - np.maximum(found.low[one], found.low[two])
    behind = (shared > 1e-9 * lengths[found.first[one]]) & (distance[one] > distance[two])
    keep[one[behind]] = False
    return keep


def _take(found: Overlaps, chosen: BoolArray) -> Overlaps:
    return Overlaps(**{key: getattr(found, key)[chosen] for key in Overlaps.__dataclass_fields__})


def _apart(nonmortar: Boundary, mortar: Boundary, turned: IntArray, search: float, where: Where) -> InputError:
    """Why no facets are opposite each other; those of the nonmortar side that turn their back are named."""
    if len(turned):
        at = ", ".join(f"{x:.6g}" for x in nonmortar.blocks[0].points[turned[0], 0])
        return InputError(
            f"the surfaces do not face each other at ({at}): both outward normals point the same way",
            where=where,
        )
    distance, nearest = KDTree(mortar.points[mortar.nodes]).query(nonmortar.points[nonmortar.nodes])
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
