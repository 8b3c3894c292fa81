# SPDX-License-Identifier: BSD-3-Clause
"""The smooth curves and surfaces that facets stand for: how far a facet is off the one that its nodes were put on.

Facets of a curve lie beside it between their nodes, straight ones by up to ``h^2 kappa / 8``, parabolas by up to
``h^4 kappa^3 / 512``: more than many a fit or clearance. Where nodes of neighbouring facets bend away from a facet in
one way, a surface of constant curvature is laid through them all,

    z + k z^2 / 2 + (level + slope . x + x . bend x / 2) = 0,

z along the facet's outward normal, k the mean of the principal curvatures, weighted by their squares: exactly a
circle, a sphere, a cylinder where the nodes lie on one. Corners of the body end it, and so do facets that lie in a
plane with others.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.compilation import kernel, part

_LEAST_ROOT = 0.5  # least 1 - 2 k b: beyond it a surface has turned too far from its facet to be one over it


class Smooth(NamedTuple):
    """The surfaces that facets of one kind stand for, each in terms of r from a point of its own.

    Attributes
    ----------
    origin, normal : (m, d) that point, and the facet's outward unit normal
    level, slope, bend : (m,), (m, d), (m, d, d) of the module's formula; positive where the surface bulges
    arch : (m,) k of that formula
    curvature : (m, d, d) of the surface over the origin
    nodal : (m, k) height of the surface over the nodes of the facet
    lean : (m, k) what the pressure of the facet sees there of a gap along its normal, through the surface's own: the
        squared cosine of both where a facet is straight, 1 where it bends with its surface
    bent : (m,) whether the facet itself bends
    curved : whether any of the surfaces does
    """

    origin: Array
    normal: Array
    level: Array
    slope: Array
    bend: Array
    arch: Array
    curvature: Array
    nodal: Array
    lean: Array
    bent: BoolArray
    curved: bool


@part()
def _height(surface: Smooth, i: int, point: Array, gradient: Array) -> float:
    """Height of surface i over a point, along the facet's normal; its slopes into ``gradient``."""
    d, b = len(point), surface.level[i]
    for e in range(d):
        gradient[e] = surface.slope[i, e]
        for f in range(d):
            gradient[e] += surface.bend[i, e, f] * (point[f] - surface.origin[i, f])
        b += 0.5 * (gradient[e] + surface.slope[i, e]) * (point[e] - surface.origin[i, e])
    z = -2.0 * b / (1.0 + math.sqrt(max(1.0 - 2.0 * surface.arch[i] * b, _LEAST_ROOT)))
    for e in range(d):
        gradient[e] /= -(1.0 + surface.arch[i] * z)
    return z


@part()
def rise(surface: Smooth, i: int, point: Array, shapes: Array, sight: Array, gradient: Array) -> float:
    """How far the smooth surface is in front of facet i, from a point of it along a unit vector.

    Parameters
    ----------
    point : (d,) on the facet
    shapes : (k,) values of its shape functions there; more are ignored
    sight : (d,) unit vector that leaves the body there
    gradient : (d,) is written over
    """
    up = _height(surface, i, point, gradient)
    for a in range(surface.nodal.shape[1]):
        up -= shapes[a] * surface.nodal[i, a]
    cosine = 0.0
    for e in range(len(point)):
        cosine += (surface.normal[i, e] - gradient[e]) * sight[e]
    return up / max(cosine, _LEAST_ROOT)


@part()
def bow(one: Smooth, i: int, two: Smooth, j: int, nodes: Array, point: Array, shapes: Array, way: Array) -> float:
    """What interpolation on facet i adds to a gap, so far as its surface bends more than that of facet j opposite.

    As far as both bend alike, one hollow where the other bulges, they close on one surface and facets of both fall
    short of it; beyond that a facet meets the other side where its nodes do. Nothing where facet i bends itself.

    Parameters
    ----------
    one, i, two, j : the surfaces of both sides, and the facets
    nodes : (k, d) of facet i
    point, shapes : (d,) on it, and the values of its shape functions there
    way : (2, d) is written over
    """
    total, d, same = 0.0, len(point), 1.0
    if not one.bent[i]:
        for e in range(d):
            same -= one.normal[i, e] * two.normal[j, e]
        for a in range(len(nodes)):
            both, own = 0.0, 0.0
            for e in range(d):
                way[0, e] = nodes[a, e] - point[e]
                both += (one.normal[i, e] - two.normal[j, e]) * way[0, e] / same
                own += 2.0 * one.normal[i, e] * way[0, e]
            # turned as the other facet would have to be to lie against this one, see `tilt.rotate_between`
            for e in range(d):
                way[1, e] = way[0, e] - both * (one.normal[i, e] - two.normal[j, e]) - own * two.normal[j, e]
            bend, other = 0.0, 0.0
            for e in range(d):
                for f in range(d):
                    bend += one.curvature[i, e, f] * way[0, e] * way[0, f]
                    other += two.curvature[j, e, f] * way[1, e] * way[1, f]
            if bend * other < 0.0:
                bend = bend + other if abs(bend) > abs(other) else 0.0
            total += 0.5 * shapes[a] * bend
    return total


@kernel()
def rises(surface: Smooth, facets: IntArray, points: Array, shapes: Array, sights: Array) -> Array:
    """:func:`rise` of facets (p,) at points (p, q, d) with shape functions (p, q, k), along (p, d); (p, q).

    Parameters
    ----------
    surface, facets : the surfaces, and numbers (p,) of facets
    points, shapes : (p, q, d) on them, and (p, q, k) values of their shape functions
    sights : (p, d) unit vectors
    """
    result, gradient = np.zeros(points.shape[:2]), np.empty(points.shape[2])
    for p in range(len(facets)):
        for q in range(points.shape[1]):
            result[p, q] = rise(surface, facets[p], points[p, q], shapes[p, q], sights[p], gradient)
    return result


@kernel()
def bows(one: Smooth, two: Smooth, i: IntArray, j: IntArray, nodes: Array, points: Array, shapes: Array) -> Array:
    """:func:`bow` on facets i (p,) with nodes (m, k, d) at points (p, q, d) with shape functions (p, q, k); (p, q).

    Parameters
    ----------
    one, two, i, j : the surfaces of both sides, and numbers (p,) of their facets
    nodes : (m, k, d) of the first facets
    points, shapes : (p, q, d) on them, and (p, q, k) values of their shape functions
    """
    result, way = np.zeros(points.shape[:2]), np.empty((2, points.shape[2]))
    for p in range(len(i)):
        for q in range(points.shape[1]):
            result[p, q] = bow(one, i[p], two, j[p], nodes[i[p]], points[p, q], shapes[p, q], way)
    return result


@kernel()
def heights(surface: Smooth, facets: IntArray, points: Array) -> Array:
    """Heights over points (p, d), and squared cosines between the normals of facet and surface there, (p, 2).

    Parameters
    ----------
    surface, facets : the surfaces, and numbers (p,) of facets
    points : (p, d) beside them, length
    """
    result, gradient = np.empty((len(points), 2)), np.empty(points.shape[1])
    for p in range(len(points)):
        result[p, 0] = _height(surface, facets[p], points[p], gradient)
        result[p, 1] = 1.0 / (1.0 + np.sum(gradient**2))
    return result
