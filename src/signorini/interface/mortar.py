# SPDX-License-Identifier: BSD-3-Clause
"""Mortar coupling with dual multipliers: sides whose meshes need not match; plane."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary
from signorini.fem.line import line_shapes
from signorini.interface.coupling import Coupling
from signorini.interface.dual import dual_functions
from signorini.interface.overlap import Overlaps, interpolate, parameter

_COVERED = 1e-8  # of the full weight of a node: with less it carries no pair
_POINTS = {2: 2, 3: 8}  # of Gauss on every piece, by nodes of the facets; two suffice for straight linear facets


def mortar_coupling(
    points: Array,
    nonmortar: Boundary,
    mortar: Boundary,
    overlaps: Overlaps,
    measure: Callable[[Array], Array],
    where: Where,
) -> Coupling:
    """Weigh both sides with the functions dual to the hats of the nonmortar corner nodes.

    On the covered part of every nonmortar facet, ``psi = diag(int N) (int N N^T)^-1 N``, N its two corner hats, so that
    ``int psi_a N_b = delta_ab int N_a``; with ``w_k = int psi_k`` pair k sees

        sum_j (int psi_k N_j / w_k) x_j  -  sum_l (int psi_k N_l^mortar / w_k) x_l .

    The weights reproduce linear fields where the surfaces coincide, and ``sum_k w_k P_kl = int N_l^mortar``: uniform
    pressure passes exactly. Of linear facets the first sum is the node itself. Quadratic facets have pairs at their
    corners only (their own dual functions oscillate).

    Parameters
    ----------
    points : (n, 2) of all nodes
    overlaps : of the two sides
    measure : thickness, or circumference, at points (..., 2)

    Raises
    ------
    InputError
        If no node is covered.

    References
    ----------
    Wohlmuth (2000), SIAM J. Numer. Anal. 38:989; Popp, Wohlmuth, Gee, Wall (2012), SIAM J. Sci. Comput. 34:B421.
    """
    at, weights = _quadrature(points, nonmortar, overlaps, measure, mortar.facets.shape[1])
    weight, multiplier = _duals(nonmortar, overlaps, at, weights, len(points))
    full = _full(points, nonmortar, measure)
    nodes = np.nonzero(weight > _COVERED * full)[0]
    if not len(nodes):
        raise InputError("no node of the nonmortar side has the mortar side opposite it", where=where)
    corners, n = nonmortar.facets[overlaps.first, :2], len(points)
    gives = _spread(corners, mortar.facets[overlaps.second], multiplier, _shapes(overlaps.other, at), n)
    keeps = _own_weights(nonmortar, overlaps, at, weight, multiplier)
    relative = sp.csr_array(sp.diags_array(1.0 / weight[nodes]) @ (keeps - gives)[nodes])
    return Coupling(nodes=nodes, area=weight[nodes], relative=relative)


def _whole(points: Array, side: Boundary) -> Overlaps:
    """Every facet of a side, from end to end."""
    ends = points[side.facets]
    chord = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(chord, axis=1)
    own = np.einsum("pad,pd->pa", ends - ends[:, :1], chord / length[:, None])
    facet = np.arange(len(ends))
    return Overlaps(first=facet, second=facet, low=np.zeros(len(ends)), high=length, own=own, other=own)


def _quadrature(
    points: Array, side: Boundary, overlaps: Overlaps, measure: Callable[[Array], Array], opposite: int
) -> tuple[Array, Array]:
    """Places along the chords and weights, (p, q) each: arc length of the side times the measure."""
    count = side.facets.shape[1]
    where, share = np.polynomial.legendre.leggauss(_POINTS[max(count, opposite)])
    half = 0.5 * (overlaps.high - overlaps.low)[:, None]
    at = overlaps.low[:, None] + half * (1.0 + where)
    s = parameter(overlaps.own, at)
    slopes = line_shapes(count, s.ravel())[1].reshape(*s.shape, count)
    corners = points[side.facets[overlaps.first]]
    speed = np.linalg.norm(np.einsum("pqa,pad->pqd", slopes, corners), axis=-1)
    stretch = speed / np.abs(np.einsum("pqa,pa->pq", slopes, overlaps.own))
    weights: Array = half * share * stretch * measure(interpolate(corners, s))
    return at, weights


def _duals(side: Boundary, overlaps: Overlaps, at: Array, weights: Array, n: int) -> tuple[Array, Array]:
    """``int psi_k`` of every node of the mesh (n,), and psi of both corners times the weights (p, q, 2)."""
    s = parameter(overlaps.own, at)
    hats = line_shapes(2, s.ravel())[0].reshape(*s.shape, 2)
    mass = np.zeros((len(side.facets), 2, 2))
    np.add.at(mass, overlaps.first, np.einsum("pq,pqa,pqb->pab", weights, hats, hats))
    share = mass.sum(axis=2)
    multiplier = np.einsum("pab,pqb->pqa", dual_functions(mass)[overlaps.first], hats) * weights[..., None]
    weight: Array = np.bincount(side.facets[:, :2].ravel(), share.ravel(), n).astype(float)
    return weight, multiplier


def _own_weights(side: Boundary, overlaps: Overlaps, at: Array, weight: Array, multiplier: Array) -> sp.csr_array:
    """``int psi_k N_j`` of the side itself, (n, n): diagonal for linear facets."""
    if side.facets.shape[1] == 2:
        return sp.csr_array(sp.diags_array(weight))
    facets = side.facets[overlaps.first]
    return _spread(facets[:, :2], facets, multiplier, _shapes(overlaps.own, at), len(weight))


def _shapes(places: Array, at: Array) -> Array:
    """Shape functions (p, q, 2 or 3) of facets where they have given places along the chords."""
    s = parameter(places, at)
    values: Array = line_shapes(places.shape[1], s.ravel())[0].reshape(*s.shape, places.shape[1])
    return values


def _spread(rows: IntArray, columns: IntArray, multiplier: Array, shapes: Array, n: int) -> sp.csr_array:
    """``int psi_a N_b`` of all pieces, summed into an (n, n) matrix."""
    values = np.einsum("pqa,pqb->pab", multiplier, shapes)
    i, j = (np.broadcast_to(part, values.shape).ravel() for part in (rows[:, :, None], columns[:, None, :]))
    return sp.csr_array((values.ravel(), (i, j)), shape=(n, n))


def _full(points: Array, side: Boundary, measure: Callable[[Array], Array]) -> Array:
    """Weight of every node of the mesh if all facets were covered, (n,)."""
    whole = _whole(points, side)
    at, weights = _quadrature(points, side, whole, measure, 2)
    return _duals(side, whole, at, weights, len(points))[0]
