# SPDX-License-Identifier: BSD-3-Clause
"""Mortar coupling with dual multipliers: sides whose meshes need not match; plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.facet_block import FacetBlock
from signorini.fem.line import line_shapes
from signorini.interface.coupling import Coupling, FacetGaps
from signorini.interface.dual import dual_functions
from signorini.interface.overlap import Overlaps, interpolate, parameter
from signorini.interface.smooth import Facets, Smooth, bows, rises, smooth_surfaces
from signorini.interface.tilt import turned

_COVERED = 1e-8  # of the full weight of a node: with less it carries no pair
_POINTS = {2: 3, 3: 8}  # of Gauss on every piece, by nodes of the facets: exact for parabolas over linear facets


def mortar_coupling(
    points: Array,
    nonmortar: FacetBlock,
    mortar: FacetBlock,
    overlaps: Overlaps,
    measure: Callable[[Array, IntArray, IntArray], Array],
    where: Where,
) -> Coupling:
    """Weigh both sides with the functions dual to the hats of the nonmortar corner nodes.

    On the covered part of every nonmortar facet, ``psi = diag(int N) (int N N^T)^-1 N``, N its two corner hats, so that
    ``int psi_a N_b = delta_ab int N_a``; a unit pressure of pair k puts the forces

        int psi_k N_j n dA  on the nonmortar,  - int psi_k N_l^mortar n dA  on the mortar side,

    n the normal of the nonmortar side where it is, turned where the sides are tilted against each other (see
    :mod:`signorini.interface.tilt`). The psi_k sum to 1, so that a uniform pressure passes exactly, also where the
    sides are curved: on the nonmortar side as ``int N_j n dA``, on the mortar side as its own where the two coincide.
    Facets see each other along these normals: of linear facets the forces of every pair are in balance, with their
    moments. On linear facets only the pair's own node bears its forces. Quadratic facets have pairs at their
    corners only (their own dual functions oscillate).

    Parameters
    ----------
    points : (n, 2) of all nodes
    overlaps : of the two sides
    measure : thickness, or circumference, over which cells of both sides (p,) touch at points (p, q, 2), (p, q)

    Raises
    ------
    InputError
        If no node is covered.

    References
    ----------
    Wohlmuth (2000), SIAM J. Numer. Anal. 38:989; Popp, Wohlmuth, Gee, Wall (2012), SIAM J. Sci. Comput. 34:B421.
    """
    at, areas = _quadrature(points, nonmortar, mortar, overlaps, measure)
    _, multiplier = _duals(nonmortar, overlaps, at, areas)
    corners, n = nonmortar.facets[:, :2], len(points)
    vectors = np.zeros((n, 2))
    np.add.at(vectors, corners[overlaps.first], np.einsum("pqad->pad", multiplier))
    nodes = np.nonzero(np.linalg.norm(vectors, axis=1) > _COVERED * _full(points, nonmortar, measure))[0]
    if not len(nodes):
        raise InputError("no node of the nonmortar side has the mortar side opposite it", where=where)
    other = _spread(corners[overlaps.first], mortar.facets[overlaps.second], multiplier, _shapes(overlaps.other, at), n)
    own = _own_forces(nonmortar, overlaps, at, vectors, multiplier)
    forces = tuple(sp.csr_array((keeps - gives)[nodes]) for keeps, gives in zip(own, other, strict=True))
    own, other = (smooth_surfaces([Facets(side.facets, side.points, 2)])[0] for side in (nonmortar, mortar))
    opposite = _Opposite(own, other, points[nonmortar.facets], points[mortar.facets], overlaps)
    smoothing = None
    if own.curved or other.curved:
        over = -np.einsum("pqad,pd->pqa", multiplier, overlaps.outward) * opposite.added(at)[..., None]
        smoothing = np.zeros(n)
        np.add.at(smoothing, corners[overlaps.first], over.sum(axis=1))
        smoothing = smoothing[nodes]
    facets = _facet_gaps(nonmortar, opposite)
    return Coupling(nodes=nodes, normal_areas=vectors[nodes], forces=forces, facets=facets, smoothing=smoothing)


@dataclass(frozen=True, eq=False)
class _Opposite:
    """Facets opposite each other, and the smooth curves that they stand for.

    Attributes
    ----------
    own, other : the curves of both sides
    first, second : (m, 2 or 3, 2) points of the facets of both sides
    overlaps : pieces of both
    """

    own: Smooth
    other: Smooth
    first: Array
    second: Array
    overlaps: Overlaps

    def gap(self, at: Array) -> Array:
        """(p, q) Gaps between the curves at places (p, q) of the pieces, length."""
        one, two, shapes, others = self._points(at)
        pieces, sight = self.overlaps, self.overlaps.outward
        ahead = rises(self.own, pieces.first, one, shapes, sight)
        return self._facets(one, two) - ahead - rises(self.other, pieces.second, two, others, -sight)

    def added(self, at: Array) -> Array:
        """(p, q) What the gap between curves, interpolated as displacements are, is larger than that of the facets."""
        one, two, shapes, others = self._points(at)
        first, second = self.overlaps.first, self.overlaps.second
        ahead = bows(self.own, self.other, first, second, self.first, one, shapes)
        across = bows(self.other, self.own, second, first, self.second, two, others)
        lean = np.einsum("pqa,pa->pq", shapes, self.own.lean[first])
        return np.asarray(lean * (self.gap(at) + ahead + across) - self._facets(one, two))

    def _facets(self, one: Array, two: Array) -> Array:
        """(p, q) Gaps between points of the facets."""
        return np.asarray(np.einsum("pqd,pd->pq", two - one, self.overlaps.outward))

    def _points(self, at: Array) -> tuple[Array, Array, Array, Array]:
        """Points (p, q, 2) of both facets, and their shape functions there."""
        shapes, others = _shapes(self.overlaps.own, at), _shapes(self.overlaps.other, at)
        one = np.einsum("pqa,pad->pqd", shapes, self.first[self.overlaps.first])
        two = np.einsum("pqa,pad->pqd", others, self.second[self.overlaps.second])
        return one, two, shapes, others


def _facet_gaps(nonmortar: FacetBlock, opposite: _Opposite) -> FacetGaps:
    """Gaps on the facets that anything is opposite, at the ends and in the middle of every piece."""
    overlaps = opposite.overlaps
    gap = opposite.gap(np.column_stack([overlaps.low, 0.5 * (overlaps.low + overlaps.high), overlaps.high]))
    order = np.lexsort([overlaps.low, overlaps.first])
    gap, (facet, start) = gap[order], np.unique(overlaps.first[order], return_index=True)
    end = np.append(start[1:], len(order)) - 1
    return FacetGaps(
        corners=nonmortar.facets[facet, :2],
        ends=np.column_stack([gap[start, 0], gap[end, -1]]),
        low=np.minimum.reduceat(gap.min(axis=1), start),
        high=np.maximum.reduceat(gap.max(axis=1), start),
    )


def _whole(points: Array, side: FacetBlock) -> Overlaps:
    """Every facet of a side, from end to end."""
    ends = points[side.facets]
    chord = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(chord, axis=1)
    own = np.einsum("pad,pd->pa", ends - ends[:, :1], chord / length[:, None])
    facet = np.arange(len(ends))
    return Overlaps(
        first=facet, second=facet, outward=side.normals, low=np.zeros(len(ends)), high=length, own=own, other=own
    )


def _quadrature(
    points: Array,
    side: FacetBlock,
    other: FacetBlock,
    overlaps: Overlaps,
    measure: Callable[[Array, IntArray, IntArray], Array],
) -> tuple[Array, Array]:
    """Places in the pieces (p, q), and normals into the body times arc length times the measure, (p, q, 2)."""
    count = side.facets.shape[1]
    where, share = np.polynomial.legendre.leggauss(_POINTS[max(count, other.facets.shape[1])])
    half = 0.5 * (overlaps.high - overlaps.low)[:, None]
    at = overlaps.low[:, None] + half * (1.0 + where)
    s = parameter(overlaps.own, at)
    slopes = line_shapes(count, s.ravel())[1].reshape(*s.shape, count)
    corners = points[side.facets[overlaps.first]]
    along = np.einsum("pqa,pad->pqd", slopes, corners)
    across = measure(interpolate(corners, s), side.cells[overlaps.first], other.cells[overlaps.second])
    weights = half * share / np.abs(np.einsum("pqa,pa->pq", slopes, overlaps.own)) * across
    inward = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    tilted = turned(inward, side.normals[overlaps.first][:, None], overlaps.outward[:, None])
    return at, weights[..., None] * tilted


def _duals(side: FacetBlock, overlaps: Overlaps, at: Array, areas: Array) -> tuple[Array, Array]:
    """``int psi_k`` of both corners of every facet (m, 2), and psi of both times the areas, (p, q, 2, 2)."""
    s = parameter(overlaps.own, at)
    hats = line_shapes(2, s.ravel())[0].reshape(*s.shape, 2)
    mass = np.zeros((len(side.facets), 2, 2))
    np.add.at(mass, overlaps.first, np.einsum("pq,pqa,pqb->pab", np.linalg.norm(areas, axis=-1), hats, hats))
    multiplier = np.einsum("pab,pqb->pqa", dual_functions(mass)[overlaps.first], hats)
    return mass.sum(axis=2), multiplier[..., None] * areas[..., None, :]


def _own_forces(
    side: FacetBlock, overlaps: Overlaps, at: Array, vectors: Array, multiplier: Array
) -> tuple[sp.csr_array, ...]:
    """``int psi_k N_j n`` of the side itself, two of (n, n): diagonal for linear facets, along which n is constant."""
    if not side.quadratic:
        return tuple(sp.csr_array(sp.diags_array(part)) for part in vectors.T)
    facets = side.facets[overlaps.first]
    return _spread(facets[:, :2], facets, multiplier, _shapes(overlaps.own, at), len(vectors))


def _shapes(places: Array, at: Array) -> Array:
    """Shape functions (p, q, 2 or 3) of facets at given places in the pieces."""
    s = parameter(places, at)
    values: Array = line_shapes(places.shape[1], s.ravel())[0].reshape(*s.shape, places.shape[1])
    return values


def _spread(rows: IntArray, columns: IntArray, multiplier: Array, shapes: Array, n: int) -> tuple[sp.csr_array, ...]:
    """``int psi_a N_b n`` of all pieces, summed into an (n, n) matrix for either direction."""
    values = np.einsum("pqad,pqb->dpab", multiplier, shapes)
    i, j = (np.broadcast_to(part, values.shape[1:]).ravel() for part in (rows[:, :, None], columns[:, None, :]))
    return tuple(sp.csr_array((part.ravel(), (i, j)), shape=(n, n)) for part in values)


def _full(points: Array, side: FacetBlock, measure: Callable[[Array, IntArray, IntArray], Array]) -> Array:
    """``int psi_k`` of every node of the mesh if all facets were covered, (n,)."""
    whole = _whole(points, side)
    share, _ = _duals(side, whole, *_quadrature(points, side, side, whole, measure))
    return np.bincount(side.facets[:, :2].ravel(), share.ravel(), len(points)).astype(float)
