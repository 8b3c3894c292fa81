# SPDX-License-Identifier: BSD-3-Clause
"""Initial gaps: from the geometry, between the surfaces that facets stand for, or as asked for."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.interface.coupling import Coupling
from signorini.model.contact import Contact
from signorini.model.varying import Varying, spell

_COORDINATE_TOL = 16.0 * float(np.finfo(np.float64).eps)  # of a coordinate: what two that are the same differ by
_CURVE_TOL = 0.01  # of a gap: what it may be more along the normal of a facet than along that of a curve


def initial_gaps(
    geometry: Array, contact: Contact, seen: Callable[[Varying, str], Array], *, farthest: float
) -> tuple[Array, Array]:
    """What a contact makes of the gaps that the geometry has, and what of it the geometry has not, (n,) length each.

    Gaps are negative where sides overlap. An interference counts as one of the geometry.

    Gaps that are rounding of coordinates are none: beside small loads they would be, and where supports hold both sides
    an overlap of a last digit would prove that nothing is in equilibrium.

    Parameters
    ----------
    geometry : (n,) length
    contact : as asked for
    seen : (n,) what pairs see of a gap that a key of the contact gives along the normals of the nonmortar side
    farthest : largest coordinate of the mesh
    """
    geometry = np.where(np.abs(geometry) > _COORDINATE_TOL * farthest, geometry, 0.0)
    if contact.gap == "zero" or contact.tied:
        gap = np.zeros(len(geometry))
    elif contact.gap == "geometry":
        gap = geometry if contact.adjust is None else np.where(geometry <= contact.adjust, 0.0, geometry)
    else:
        assert not isinstance(contact.gap, str)
        gap = seen(contact.gap, "gap")
    return gap - seen(contact.interference, "interference"), gap - geometry


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
    vectors = np.zeros((normals.shape[1], coupling.forces[0].shape[1]))
    vectors[:, nodes] = normals.T
    vectors[:, coupling.nodes] = coupling.normals.T
    vectors[:, nodes] *= distance
    seen = sum(force @ part for force, part in zip(coupling.forces, vectors, strict=True))
    return np.asarray(seen / coupling.area)


def resolved(gap: Array, coupling: Coupling, one: Array) -> Array:
    """Mean gaps (k,) that begin no sooner than the gaps between the surfaces.

    Dual functions are negative in part: along a parabola the mean gap is smaller than that at the node by a sixth of
    what it grows to on a facet from the vertex. Where a short facet meets one so long that the mean is smaller by more
    than the gap varies on the short one, it can be negative though everything is far apart: there it is raised to the
    smallest one that any point has. What is left, the bodies would touch while they are apart, nowhere more than where
    they are nearest: all gaps are larger by that, as if one had been moved.

    Parameters
    ----------
    gap : (k,) mean gaps, length
    coupling : of the pairs, with gaps at points of facets
    one : (k,) what pairs see of a gap of length 1 along the normals of the nonmortar side, see :func:`normal_gap`
    """
    if coupling.facets is None:
        return gap
    facets, nodes = coupling.facets, coupling.nodes
    size = int(max(facets.corners.max(), nodes.max())) + 1
    own, least, varies = (np.full(size, np.inf) for _ in range(3))
    np.minimum.at(own, facets.corners, facets.ends)
    np.minimum.at(least, facets.corners, facets.low[:, None])
    np.minimum.at(varies, facets.corners, (facets.high - facets.low)[:, None])
    own = np.where(np.isfinite(own), own, -np.inf)[nodes] * one  # corners that nothing is opposite are no measure
    least = least[nodes] * one
    lost = own - gap > varies[nodes] * one + _CURVE_TOL * np.abs(own)
    gap = np.where(lost, np.maximum(gap, least), gap)
    return gap + max(float(least.min() - gap.min()), 0.0)


def refuse_deep_overlap(gap: Array, numbers: IntArray, contact: Contact, element: float, where: Where) -> None:
    """An overlap of more than an element is no small displacement.

    Parameters
    ----------
    gap : (k,) length
    numbers : (k,) of the nodes, for messages
    contact : as asked for
    element : longest facet, length
    where : what errors call the contact

    Raises
    ------
    InputError
        With the node where it is deepest.
    """
    if len(gap) and -gap.min() > element:
        worst = int(np.argmin(gap))
        by = f" with the interference of {spell(contact.interference)}" if contact.interference != 0.0 else ""
        raise InputError(
            f"the two sides overlap{by} by {-gap[worst]:.4g} at node {numbers[worst]}, more than the longest facet "
            f"there, {element:.4g}; displacements are small here. Expected bodies that hardly overlap: move one, or "
            "say gap = 'zero' or adjust",
            where=where,
        )
