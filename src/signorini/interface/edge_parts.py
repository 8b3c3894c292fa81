# SPDX-License-Identifier: BSD-3-Clause
"""Integrals over the common parts of edges; plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import Where
from signorini.fem.boundary import Boundary
from signorini.fem.facet_block import FacetBlock
from signorini.fem.facets import gauss_rule, line_shapes
from signorini.interface.common_parts import CommonParts, Opposite
from signorini.interface.coupling import FacetGaps
from signorini.interface.fitting import smooth_surfaces
from signorini.interface.overlap import Overlaps, find_overlaps, interpolate, parameter
from signorini.interface.smooth import Smooth, bows, rises
from signorini.interface.tilt import rotate_between

_POINTS = {2: 3, 3: 8}  # of Gauss on every piece, by nodes of the facets: exact for parabolas over linear facets

Measure = Callable[[Array, IntArray, IntArray], Array]
"""Thickness, or circumference, over which cells of both sides (p,) touch at points (p, q, 2): (p, q)."""


def unit(points: Array, *_: IntArray) -> Array:
    """A thickness of 1 at points (p, q, d)."""
    return np.ones(points.shape[:-1])


def edge_parts(
    nonmortar: Boundary, mortar: Boundary, *, share: float, search: float, measure: Measure, where: Where
) -> list[CommonParts]:
    """Integrals over what the edges of both sides have in common.

    Parameters
    ----------
    nonmortar, mortar, share, search, measure, where : see :func:`signorini.interface.mortar.mortar_coupling`
    """
    (own,), (other,) = nonmortar.blocks, mortar.blocks
    overlaps = find_overlaps(nonmortar, mortar, share=share, search=search, where=where)
    (one,), (two,) = smooth_surfaces(nonmortar.blocks), smooth_surfaces(mortar.blocks)
    facing = _Facing(own, other, one, two, overlaps)
    at, areas = _quadrature(own, other, overlaps, measure)
    shapes, others = _shapes(overlaps.own, at), _shapes(overlaps.other, at)
    hats = line_shapes(2, parameter(overlaps.own, at))[0]
    m, first = len(own.facets), overlaps.first
    mass, forces, over = np.zeros((m, 2, 2)), np.zeros((m, 2, own.count, 2)), np.zeros((m, 2))
    np.add.at(mass, first, np.einsum("pq,pqa,pqb->pab", np.linalg.norm(areas, axis=-1), hats, hats))
    np.add.at(forces, first, np.einsum("pqa,pqj,pqd->pajd", hats, shapes, areas))
    seen = np.einsum("pqa,pql,pqd->pald", hats, others, areas)
    curved = one.curved or two.curved
    if curved:
        across = np.einsum("pqd,pd->pq", areas, overlaps.outward)
        np.add.at(over, first, np.einsum("pqa,pq,pq->pa", hats, across, facing.added(at)))
    return [
        CommonParts(
            block=own,
            mass=mass,
            own=forces,
            over=over,
            opposite=(Opposite(first=first, nodes=other.facets[overlaps.second], other=seen),),
            gaps=_facet_gaps(facing),
            curved=curved,
        )
    ]


@dataclass(frozen=True, eq=False)
class _Facing:
    """Edges opposite each other, and the smooth curves that they stand for.

    Attributes
    ----------
    own, other : the edges of both sides
    one, two : their curves
    overlaps : pieces of both
    """

    own: FacetBlock
    other: FacetBlock
    one: Smooth
    two: Smooth
    overlaps: Overlaps

    def gap(self, at: Array) -> Array:
        """(p, q) Gaps between the curves at places (p, q) of the pieces, length."""
        one, two, shapes, others = self._points(at)
        pieces, sight = self.overlaps, self.overlaps.outward
        ahead = rises(self.one, pieces.first, one, shapes, sight)
        return self._facets(one, two) - ahead - rises(self.two, pieces.second, two, others, -sight)

    def added(self, at: Array) -> Array:
        """(p, q) What the gap between curves, interpolated as displacements are, is larger than that of the facets."""
        one, two, shapes, others = self._points(at)
        first, second = self.overlaps.first, self.overlaps.second
        ahead = bows(self.one, self.two, first, second, self.own.points, one, shapes)
        across = bows(self.two, self.one, second, first, self.other.points, two, others)
        lean = np.einsum("pqa,pa->pq", shapes, self.one.lean[first])
        return np.asarray(lean * (self.gap(at) + ahead + across) - self._facets(one, two))

    def _facets(self, one: Array, two: Array) -> Array:
        """(p, q) Gaps between points of the facets."""
        return np.asarray(np.einsum("pqd,pd->pq", two - one, self.overlaps.outward))

    def _points(self, at: Array) -> tuple[Array, Array, Array, Array]:
        """Points (p, q, 2) of both facets, and their shape functions there."""
        shapes, others = _shapes(self.overlaps.own, at), _shapes(self.overlaps.other, at)
        one = np.einsum("pqa,pad->pqd", shapes, self.own.points[self.overlaps.first])
        two = np.einsum("pqa,pad->pqd", others, self.other.points[self.overlaps.second])
        return one, two, shapes, others


def _facet_gaps(facing: _Facing) -> FacetGaps:
    """Gaps on the facets that anything is opposite, at the ends and in the middle of every piece."""
    overlaps = facing.overlaps
    gap = facing.gap(np.column_stack([overlaps.low, 0.5 * (overlaps.low + overlaps.high), overlaps.high]))
    order = np.lexsort([overlaps.low, overlaps.first])
    gap, (facet, start) = gap[order], np.unique(overlaps.first[order], return_index=True)
    end = np.append(start[1:], len(order))[: len(start)] - 1
    return FacetGaps(
        corners=facing.own.corner_nodes[facet],
        ends=np.column_stack([gap[start, 0], gap[end, -1]]),
        low=np.minimum.reduceat(gap.min(axis=1), start),
        high=np.maximum.reduceat(gap.max(axis=1), start),
    )


def _quadrature(side: FacetBlock, other: FacetBlock, overlaps: Overlaps, measure: Measure) -> tuple[Array, Array]:
    """Places in the pieces (p, q), and outward normals times arc length times the measure, (p, q, 2)."""
    where, share = gauss_rule(2, _POINTS[max(side.count, other.count)])
    half = 0.5 * (overlaps.high - overlaps.low)[:, None]
    at = overlaps.low[:, None] + half * (1.0 + where[:, 0])
    s = parameter(overlaps.own, at)
    slopes = line_shapes(side.count, s)[1]
    corners = side.points[overlaps.first]
    along = np.einsum("pqa,pad->pqd", slopes, corners)
    across = measure(interpolate(corners, s), side.cells[overlaps.first], other.cells[overlaps.second])
    weights = half * share / np.abs(np.einsum("pqa,pa->pq", slopes, overlaps.own)) * across
    outward = np.stack([along[..., 1], -along[..., 0]], axis=-1)
    tilted = rotate_between(outward, side.normals[overlaps.first][:, None], overlaps.outward[:, None])
    return at, weights[..., None] * tilted


def _shapes(places: Array, at: Array) -> Array:
    """Shape functions (p, q, 2 or 3) of facets at given places in the pieces."""
    return line_shapes(places.shape[1], parameter(places, at))[0]
