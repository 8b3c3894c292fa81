# SPDX-License-Identifier: BSD-3-Clause
"""Nodes on the facets opposite: the simple coupling of sides that do not match; plane."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.facet_block import FacetBlock
from signorini.fem.line import line_shapes
from signorini.interface.coupling import Coupling, point_coupling
from signorini.interface.near import near
from signorini.interface.overlap import FACING, interpolate, parameter, search_distance
from signorini.interface.smooth import Facets, rises, smooth_surfaces

_BESIDE = 1e-9  # of half a facet: how far beyond its end a node still lies on it


def node_to_segment(
    points: Array, nonmortar: FacetBlock, mortar: FacetBlock, areas: Array, search: float | None, where: Where
) -> Coupling:
    """Every nonmortar node against the point that its normal meets on the mortar side; nodes that meet none are left.

    It fails the patch test where the meshes do not match.

    Parameters
    ----------
    points : (n, 2) of all nodes
    areas : (k, 2) of the nonmortar nodes, normal into the body times area
    search : how far apart node and facet can be, length; None: half the size of the smaller side

    Raises
    ------
    InputError
        If no node meets a facet.
    """
    reach = search_distance(points, nonmortar, mortar, search)
    node, facet = _near(points, nonmortar, mortar, reach)
    normals = nonmortar.nodal_normals[node]
    tangents = np.column_stack([-normals[:, 1], normals[:, 0]])
    ends = points[mortar.facets[facet]]
    start = points[nonmortar.nodes[node]]
    places = np.einsum("pad,pd->pa", ends - start[:, None], tangents)
    with np.errstate(divide="ignore", invalid="ignore"):  # a facet along the normal meets it nowhere
        s = parameter(places, np.zeros((len(node), 1)))
        across = interpolate(ends, s)[:, 0] - start
    distance = np.abs(np.einsum("pd,pd->p", across, normals))
    facing = np.sum(normals * mortar.normals[facet], axis=1) < FACING
    meets = facing & (np.abs(s[:, 0]) <= 1.0 + _BESIDE) & (distance <= reach)
    order = np.nonzero(meets)[0]
    if not len(order):
        raise InputError(
            f"no node of the nonmortar side meets the mortar side within {reach:.4g} along its normal; expected "
            "surfaces that face each other, or another 'search'",
            where=where,
        )
    order = order[np.lexsort([distance[order], node[order]])]
    own, best = np.unique(node[order], return_index=True)
    best = order[best]
    values = line_shapes(mortar.facets.shape[1], np.clip(s[best, 0], -1.0, 1.0))[0]
    nodes, met = nonmortar.nodes[own], facet[best]
    (smooth,) = smooth_surfaces([Facets(mortar.facets, mortar.points, 2)])
    at = np.einsum("ka,kad->kd", values, mortar.points[met])
    fallen = rises(smooth, met, at[:, None], values[:, None], -normals[best])[:, 0]
    return point_coupling(nodes, areas[own], _rows(nodes, mortar.facets[met], values, len(points)), fallen=fallen)


def _near(points: Array, nonmortar: FacetBlock, mortar: FacetBlock, search: float) -> tuple[IntArray, IntArray]:
    """Nodes (indices into ``nonmortar.nodes``) and facets that may be opposite each other."""
    centres = points[mortar.facets[:, :2]].mean(axis=1)
    return near(points[nonmortar.nodes], centres, mortar.lengths.max(), search)


def _rows(nodes: IntArray, others: IntArray, values: Array, n: int) -> sp.csr_array:
    """Node k minus the weighted nodes opposite, (k, n)."""
    k = len(nodes)
    rows = np.concatenate([np.arange(k), np.repeat(np.arange(k), others.shape[1])])
    entries = (np.concatenate([np.ones(k), -values.ravel()]), (rows, np.concatenate([nodes, others.ravel()])))
    return sp.csr_array(entries, shape=(k, n))
