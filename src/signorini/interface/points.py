# SPDX-License-Identifier: BSD-3-Clause
"""Nodes on what is opposite them: a node, where the meshes match, or the point of a facet that their normal meets."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary
from signorini.fem.facet_block import FacetBlock
from signorini.fem.facets import facet_shapes
from signorini.interface.coupling import Coupling, point_coupling
from signorini.interface.facing import FACING, near, search_distance
from signorini.interface.fitting import smooth_surfaces
from signorini.interface.overlap import interpolate, parameter
from signorini.interface.projection import meet
from signorini.interface.smooth import Smooth, rises
from signorini.interface.tilt import areas_between
from signorini.sparse_rows import selection

_ON_FACET_TOL = 1e-9  # of the reference facet: a node this far beyond its edge still lies on it


def node_pairs(nonmortar: Boundary, mortar: Boundary, partner: IntArray, areas: Array, share: float = 0.5) -> Coupling:
    """Node opposite node.

    Parameters
    ----------
    nonmortar, mortar : both sides, on the same array of points
    partner : (k,) mortar nodes, see :func:`signorini.interface.matching.match_nodes`
    areas : (k, d) normals into the nonmortar body at its nodes, times area
    share : of the nonmortar side in the stiffness of both, see :mod:`signorini.interface.tilt`
    """
    nodes, n = nonmortar.nodes, len(nonmortar.points)
    opposite = mortar.nodal_normals[np.searchsorted(mortar.nodes, partner)]
    areas = areas_between(areas, nonmortar.nodal_normals, opposite, share)
    return point_coupling(nodes, areas, sp.csr_array(selection(nodes, n) - selection(partner, n)))


def node_to_facet(
    nonmortar: Boundary,
    mortar: Boundary,
    nodes: IntArray,
    areas: Array,
    *,
    search: float | None = None,
    where: Where = (),
) -> Coupling:
    """Nonmortar nodes against the points that their normals meet on the mortar side; nodes that meet none are left.

    It fails the patch test where the meshes do not match.

    Parameters
    ----------
    nonmortar, mortar : both sides, on the same array of points
    nodes : (k,) of the nonmortar side, sorted
    areas : (k, d) normals into the nonmortar body there, times area
    search : how far apart node and facet can be, length; None: half the size of the smaller side
    where : what errors call the contact

    Raises
    ------
    InputError
        If no node meets a facet.
    """
    reach = search_distance(nonmortar, mortar, search)
    n, points = len(nonmortar.points), nonmortar.points[nodes]
    normals = nonmortar.nodal_normals[np.searchsorted(nonmortar.nodes, nodes)]
    best, fallen, gives = np.full(len(nodes), np.inf), np.zeros(len(nodes)), sp.csr_array((len(nodes), n))
    for block, smooth in zip(mortar.blocks, smooth_surfaces(mortar.blocks), strict=True):
        distance, weights, behind = _nearest(points, normals, block, smooth, reach, n)
        nearer = distance < best
        best, fallen = np.minimum(best, distance), np.where(nearer, behind, fallen)
        keep, take = sp.diags_array(np.where(nearer, 0.0, 1.0)), sp.diags_array(np.where(nearer, 1.0, 0.0))
        gives = sp.csr_array(keep @ gives + take @ weights)
    met = np.nonzero(np.isfinite(best))[0]
    if not len(met):
        raise InputError(
            f"no node of the nonmortar side meets the mortar side within {reach:.4g} along its normal; expected "
            "surfaces that face each other, or another 'search'",
            where=where,
        )
    return point_coupling(nodes[met], areas[met], sp.csr_array((selection(nodes, n) - gives)[met]), fallen=fallen[met])


def _nearest(
    points: Array, normals: Array, block: FacetBlock, smooth: Smooth, search: float, n: int
) -> tuple[Array, sp.csr_array, Array]:
    """Distance (p,) of points to the nearest facet of a block along their normals, infinite where there is none, the
    weights (p, n) of its nodes, and how far it lies behind the surface that it stands for, (p,).
    """
    centres = block.points.mean(axis=1)
    radius = np.linalg.norm(block.points - centres[:, None], axis=2).max(axis=1)
    i, j = near(points, centres, 0.0, radius, search)
    places, distance = (_meet if block.dimension == 2 else meet)(points, normals, block.points, i, j)
    facing = np.sum(normals[i] * block.normals[j], axis=1) < FACING
    there = np.nonzero(_within(block.corners, places) & (np.abs(distance) <= search) & facing)[0]
    there = there[np.lexsort([np.abs(distance[there]), i[there]])]
    found, first = np.unique(i[there], return_index=True)
    chosen = there[first]
    result, fallen = np.full(len(points), np.inf), np.zeros(len(points))
    result[found] = np.abs(distance[chosen])
    values = facet_shapes(block.count, places[chosen])[0]
    entries = (values.ravel(), (np.repeat(found, block.count), block.facets[j[chosen]].ravel()))
    at = np.einsum("pa,pad->pd", values, block.points[j[chosen]])
    fallen[found] = rises(smooth, j[chosen], at[:, None], values[:, None], -normals[found])[:, 0]
    return result, sp.csr_array(entries, shape=(len(points), n)), fallen


def _meet(points: Array, directions: Array, edges: Array, i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Reference place (k, 1) and signed distance (k,) where the line through a point meets an edge, as :func:`meet`."""
    tangents = np.column_stack([-directions[i, 1], directions[i, 0]])
    ends, start = edges[j], points[i]
    places = np.einsum("pad,pd->pa", ends - start[:, None], tangents)
    with np.errstate(divide="ignore", invalid="ignore"):  # an edge along the normal meets it nowhere
        s = parameter(places, np.zeros((len(i), 1)))
        across = interpolate(ends, s)[:, 0] - start
    return s, np.sum(across * directions[i], axis=1)


def _within(corners: int, places: Array) -> BoolArray:
    """Reference coordinates that lie on an edge, triangle or square; NaN do not."""
    if corners == 3:
        x, y = places.T
        return np.asarray((x >= -_ON_FACET_TOL) & (y >= -_ON_FACET_TOL) & (x + y <= 1.0 + _ON_FACET_TOL))
    return np.asarray((np.abs(places) <= 1.0 + _ON_FACET_TOL).all(axis=1))
