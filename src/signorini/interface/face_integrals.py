# SPDX-License-Identifier: BSD-3-Clause
"""Integrals over the common parts of pieces of faces, and the gaps between the surfaces there; compiled.

The common polygon of two pieces is cut into triangles from its centroid. Where faces are curved, a line along the
normal that they see each other along tells which of their points are opposite.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem.facets import shapes
from signorini.interface.clip import (
    EMPTY,
    Sight,
    look,
    make_sight,
    middle_of,
    place_in,
    point_at,
    rotate,
    true_area,
    upright_of,
)
from signorini.interface.projection import land
from signorini.interface.smooth import Smooth, bow, rise

_CORNER_TOL = 1e-9  # below 1 a hat is at the corner that it belongs to


class FacePieces(NamedTuple):
    """Faces of one kind of a side and the plane pieces that stand for them.

    Attributes
    ----------
    corners : (p, 3 or 4, 3) of the pieces, piece after piece of every face
    nodes : (m, c, 3) of the faces
    places : (s, 3 or 4, 2) reference coordinates of the pieces of a face
    """

    corners: Array
    nodes: Array
    places: Array


class PiecePairs(NamedTuple):
    """Pairs of pieces that are opposite each other.

    Attributes
    ----------
    first, second : the nonmortar and the mortar faces
    normals : (p, 3) unit normals along which the first pieces see the second
    i, j : (k,) the pairs
    """

    first: FacePieces
    second: FacePieces
    normals: Array
    i: IntArray
    j: IntArray


class Rule(NamedTuple):
    """A quadrature of the triangle: barycentric coordinates (q, 3) and weights (q,), which sum to 1."""

    places: Array
    weights: Array


class Sums(NamedTuple):
    """Integrals that are added up, N the hats of the nonmortar corners.

    Attributes
    ----------
    mass, own : ``int N N``, (m, corners, corners), and ``int N N_j n``, (m, corners, c, 3)
    other : ``int N N_l n`` of every pair, (k, corners, c of the mortar faces, 3)
    """

    mass: Array
    own: Array
    other: Array


class _Points(NamedTuple):
    """Quadrature points of the common part of one pair, each (q, ...): one pair after the other is written into them.

    Attributes
    ----------
    hats, N, M : hats of the corners of the first face, and shape functions of both
    points, normals : (q, 3) of the first face, its outward unit normals turned to the line of sight, times area
    shares : (q,) area of the first face
    """

    hats: Array
    N: Array
    M: Array
    points: Array
    normals: Array
    shares: Array


@part()
def _make_points(count: int) -> _Points:
    """Room for polygons of 16 corners with so many points a triangle."""
    q = 16 * count
    return _Points(
        np.empty((q, 4)), np.empty((q, 9)), np.empty((q, 9)), np.empty((q, 3)), np.empty((q, 3)), np.empty(q)
    )


@part()
def _gather(pairs: PiecePairs, k: int, rule: Rule, sight: Sight, points: _Points) -> int:
    """The quadrature points of pair k, into ``points``; their number."""
    i, j = pairs.i[k], pairs.j[k]
    piece, first, second = pairs.first.corners[i], pairs.first.places, pairs.second.places
    places, others = first[i % len(first)], second[j % len(second)]
    nodes, opposite = pairs.first.nodes[i // len(first)], pairs.second.nodes[j // len(second)]
    c, o, own, other = len(places), len(others), len(nodes), len(opposite)
    barycentric, weights, at, polygon = rule.places, rule.weights, points.points, sight.polygon
    flat, projected, axis = sight.flat, sight.projected, sight.axes[2]
    here, there, upright, D = np.empty(2), np.empty(2), np.empty(3), np.empty((2, 9))
    upright_of(piece, upright)
    whole, count = look(piece, pairs.second.corners[j], pairs.normals[i], sight)
    m_x, m_y = middle_of(polygon, count)
    q = 0
    for a in range(count):
        b = (a + 1) % count
        p_x, p_y, q_x, q_y = polygon[a, 0], polygon[a, 1], polygon[b, 0], polygon[b, 1]
        triangle = 0.5 * ((p_x - m_x) * (q_y - m_y) - (p_y - m_y) * (q_x - m_x))
        if triangle <= EMPTY * whole:
            continue
        for g in range(len(weights)):
            x = barycentric[g, 0] * m_x + barycentric[g, 1] * p_x + barycentric[g, 2] * q_x
            y = barycentric[g, 0] * m_y + barycentric[g, 1] * p_y + barycentric[g, 2] * q_y
            share = weights[g] * triangle / place_in(flat, c, x, y, places, here)
            place_in(projected, o, x, y, others, there)
            normal = points.normals[q]
            points.shares[q] = share * true_area(nodes, here, D, normal)
            rotate(normal, upright, axis)
            for e in range(3):
                normal[e] *= share
            shapes(c, here[0], here[1], points.hats[q])
            shapes(own, here[0], here[1], points.N[q])
            point_at(nodes, points.N[q], at[q])
            if own > c or other > o:
                land(at[q], axis, opposite, there)
            shapes(other, there[0], there[1], points.M[q])
            q += 1
    return q


@kernel(nogil=True)
def integrate(pairs: PiecePairs, rule: Rule, sums: Sums) -> None:
    """Add up integrals over the common parts of pairs of pieces.

    The functions of both faces are taken at the same Gauss points. The area and its outward normal n are those of the
    nonmortar face itself, curved as it is, n turned as its piece is to the given normal.

    Parameters
    ----------
    pairs : of pieces
    rule : of the quadrature
    sums : added to
    """
    first, second = pairs.first, pairs.second
    c, own, other = first.corners.shape[1], first.nodes.shape[1], second.nodes.shape[1]
    sight, points = make_sight(), _make_points(len(rule.weights))
    hats, N, M, normals = points.hats, points.N, points.M, points.normals
    for k in range(len(pairs.i)):
        face = pairs.i[k] // len(first.places)
        mass, keeps, gives = sums.mass[face], sums.own[face], sums.other[k]
        for q in range(_gather(pairs, k, rule, sight, points)):
            for e in range(c):
                for f in range(c):
                    mass[e, f] += points.shares[q] * hats[q, e] * hats[q, f]
                for d in range(3):
                    force = hats[q, e] * normals[q, d]
                    for f in range(own):
                        keeps[e, f, d] += force * N[q, f]
                    for f in range(other):
                        gives[e, f, d] += force * M[q, f]


@kernel(nogil=True)
def widen(pairs: PiecePairs, own: Smooth, other: Smooth, rule: Rule, over: Array) -> None:
    """Add up ``int N (g - g_faces)``: by how much gaps between surfaces, interpolated as displacements are, are larger
    than those of the faces that stand for them.

    Parameters
    ----------
    pairs : of pieces
    own, other : the surfaces that the nonmortar and the mortar faces stand for
    rule : of the quadrature
    over : (m, corners), added to
    """
    first, second = pairs.first, pairs.second
    c, corners = first.nodes.shape[1], over.shape[1]
    sight, points, spare = make_sight(), _make_points(len(rule.weights)), np.empty((2, 3))
    there, way, axis = np.empty(3), np.empty((2, 3)), sight.axes[2]
    at, hats, shapes_1, shapes_2, normals = points.points, points.hats, points.N, points.M, points.normals
    for k in range(len(pairs.i)):
        i, j = pairs.i[k] // len(first.places), pairs.j[k] // len(second.places)
        nodes, opposite = first.nodes[i], second.nodes[j]
        for q in range(_gather(pairs, k, rule, sight, points)):
            point, N, M = at[q], shapes_1[q], shapes_2[q]
            distance, lean, across = 0.0, 0.0, 0.0
            point_at(opposite, M, there)
            for e in range(3):
                distance += (there[e] - point[e]) * axis[e]
                across += normals[q, e] * axis[e]
            for a in range(c):
                lean += N[a] * own.lean[i, a]
            for e in range(3):
                there[e], spare[0, e] = point[e] + distance * axis[e], -axis[e]
            gap = distance - rise(own, i, point, N, axis, spare[1]) - rise(other, j, there, M, spare[0], spare[1])
            gap += bow(own, i, other, j, nodes, point, N, way) + bow(other, j, own, i, opposite, there, M, way)
            for e in range(corners):
                over[i, e] += hats[q, e] * across * (lean * gap - distance)


@kernel(nogil=True)
def spread_gaps(pairs: PiecePairs, own: Smooth, other: Smooth, ends: Array, low: Array, high: Array) -> None:
    """Distances to the other side at the corners of faces, and the smallest and largest on each of them.

    Between the surfaces that the faces stand for, along the normal of the pair; measured at the corners and in the
    middle of the common part of every pair of pieces.

    Parameters
    ----------
    pairs : of pieces
    own, other : the surfaces that the nonmortar and the mortar faces stand for
    ends : (m, corners), lowered where a corner of the face is opposite the other side, length
    low, high : (m,), lowered and raised
    """
    first, second = pairs.first, pairs.second
    c, o, nodes, s_1, s_2 = (
        ends.shape[1],
        second.corners.shape[1],
        first.nodes.shape[1],
        len(first.places),
        len(second.places),
    )
    sight = make_sight()
    polygon, axis = sight.polygon, sight.axes[2]
    hats, N, M, here, there, point = np.empty(4), np.empty(9), np.empty(9), np.empty(2), np.empty(2), np.empty(3)
    back, met, slope = np.empty(3), np.empty(3), np.empty(3)
    for k in range(len(pairs.i)):
        i, j = pairs.i[k], pairs.j[k]
        face, opposite = i // s_1, j // s_2
        _, count = look(first.corners[i], second.corners[j], pairs.normals[i], sight)
        polygon[count, 0], polygon[count, 1] = middle_of(polygon, count)
        for a in range(count + 1):
            x, y = polygon[a, 0], polygon[a, 1]
            place_in(sight.flat, c, x, y, first.places[i % s_1], here)
            place_in(sight.projected, o, x, y, second.places[j % s_2], there)
            shapes(nodes, here[0], here[1], N)
            point_at(first.nodes[face], N, point)
            distance = land(point, axis, second.nodes[opposite], there)
            if math.isnan(distance):
                continue
            if own.curved or other.curved:
                shapes(second.nodes.shape[1], there[0], there[1], M)
                for e in range(3):
                    met[e], back[e] = point[e] + distance * axis[e], -axis[e]
                distance -= rise(own, face, point, N, axis, slope) + rise(other, opposite, met, M, back, slope)
            low[face], high[face] = min(low[face], distance), max(high[face], distance)
            shapes(c, here[0], here[1], hats)
            for e in range(c):
                if hats[e] > 1.0 - _CORNER_TOL:
                    ends[face, e] = min(ends[face, e], distance)
