# SPDX-License-Identifier: BSD-3-Clause
"""Gaps between the surfaces that faces stand for, at points and in the mean; compiled."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.smooth import Smooth, bow, rise
from signorini.interface.spatial.clip import (
    EMPTY,
    Side,
    look,
    make_sight,
    middle_of,
    place_in,
    point_at,
    true_area,
    turn,
    upright_of,
)
from signorini.interface.spatial.faces import shapes
from signorini.interface.spatial.projection import land

_AT = 1e-9  # below 1 a hat is at the corner that it belongs to


@njit(cache=True, inline="always")
def _fallen(
    own: Smooth,
    i: int,
    point: Array,
    N: Array,
    sight: Array,
    other: Smooth,
    j: int,
    distance: float,
    M: Array,
    spare: Array,
) -> float:
    """How far faces i and j lie behind their surfaces, together, where one sees the other; ``spare`` is (3, 3)."""
    for e in range(3):
        spare[0, e], spare[1, e] = point[e] + distance * sight[e], -sight[e]
    ahead = rise(own, i, point, N, sight, spare[2])
    return ahead + rise(other, j, spare[0], M, spare[1], spare[2])


@njit(cache=True)
def spread_gaps(
    first: Side,
    second: Side,
    normals: Array,
    i: IntArray,
    j: IntArray,
    chosen: BoolArray,
    ends: Array,
    low: Array,
    high: Array,
) -> None:
    """Distances to the other side at the corners of faces, and the smallest and largest on each of them.

    Between the surfaces that the faces stand for, along the normal of the pair; measured at the corners and in the
    middle of the common part of every pair of pieces.

    Parameters
    ----------
    first, second, normals, i, j, chosen : see :func:`integrate`
    ends : (m, corners), lowered where a corner of the face is opposite the other side, length
    low, high : (m,), lowered and raised
    """
    c, o, nodes, corners = first.corners.shape[1], second.corners.shape[1], first.nodes.shape[1], ends.shape[1]
    s_1, s_2 = len(first.places), len(second.places)
    sight = make_sight()
    axes, flat, projected, polygon = sight.axes, sight.flat, sight.projected, sight.polygon
    hats, N, M, here, there, point = np.empty(4), np.empty(9), np.empty(9), np.empty(2), np.empty(2), np.empty(3)
    spare = np.empty((3, 3))
    for k in range(len(i)):
        if not chosen[k]:
            continue
        face = i[k] // s_1
        _, count = look(first.corners[i[k]], second.corners[j[k]], normals[i[k]], sight)
        polygon[count, 0], polygon[count, 1] = middle_of(polygon, count)
        for a in range(count + 1):
            x, y = polygon[a, 0], polygon[a, 1]
            place_in(flat, c, x, y, first.places[i[k] % s_1], here)
            place_in(projected, o, x, y, second.places[j[k] % s_2], there)
            shapes(nodes, here[0], here[1], N)
            point_at(first.nodes[face], N, point)
            distance = land(point, axes[2], second.nodes[j[k] // s_2], there)
            if math.isnan(distance):
                continue
            if first.smooth.curved or second.smooth.curved:
                j_face = j[k] // s_2
                shapes(second.nodes.shape[1], there[0], there[1], M)
                distance -= _fallen(first.smooth, face, point, N, axes[2], second.smooth, j_face, distance, M, spare)
            low[face], high[face] = min(low[face], distance), max(high[face], distance)
            shapes(corners, here[0], here[1], hats)
            for e in range(corners):
                if hats[e] > 1.0 - _AT:
                    ends[face, e] = min(ends[face, e], distance)


@njit(cache=True, inline="always")
def _added(
    first: Side,
    i: int,
    point: Array,
    N: Array,
    sight: Array,
    second: Side,
    j: int,
    M: Array,
    spare: Array,
) -> float:
    """What the gap between the surfaces of two faces, interpolated as displacements are, is larger than their own."""
    distance, lean = 0.0, 0.0
    for e in range(3):
        at = 0.0
        for a in range(len(second.nodes[j])):
            at += M[a] * second.nodes[j, a, e]
        distance += (at - point[e]) * sight[e]
    for a in range(len(first.nodes[i])):
        lean += N[a] * first.smooth.lean[i, a]
    gap = distance - _fallen(first.smooth, i, point, N, sight, second.smooth, j, distance, M, spare)
    gap += bow(first.smooth, i, second.smooth, j, first.nodes[i], point, N, spare[1:])
    for e in range(3):
        spare[0, e] = point[e] + distance * sight[e]
    gap += bow(second.smooth, j, first.smooth, i, second.nodes[j], spare[0], M, spare[1:])
    return lean * gap - distance


@njit(cache=True)
def widen(
    first: Side,
    second: Side,
    normals: Array,
    i: IntArray,
    j: IntArray,
    chosen: BoolArray,
    rule: Array,
    weights: Array,
    over: Array,
) -> None:
    """Add up what gaps between the surfaces that faces stand for, interpolated as displacements are, are larger than
    those of the faces: ``int N (g - g_faces) dA``.

    Parameters
    ----------
    first, second, normals, i, j, chosen, rule, weights : see :func:`integrate`
    over : (m, corners), added to
    """
    c, o, nodes, count_2 = first.corners.shape[1], second.corners.shape[1], first.nodes.shape[1], second.nodes.shape[1]
    s_1, s_2 = len(first.places), len(second.places)
    curved = nodes > c or count_2 > o
    sight = make_sight()
    axes, flat, projected, polygon = sight.axes, sight.flat, sight.projected, sight.polygon
    hats, N, M, D, spare = np.empty(4), np.empty(9), np.empty(9), np.empty((2, 9)), np.empty((3, 3))
    here, there, normal, upright, point = np.empty(2), np.empty(2), np.empty(3), np.empty(3), np.empty(3)
    for k in range(len(i)):
        if not chosen[k]:
            continue
        face, opposite = i[k] // s_1, j[k] // s_2
        upright_of(first.corners[i[k]], upright)
        whole, count = look(first.corners[i[k]], second.corners[j[k]], normals[i[k]], sight)
        m_x, m_y = middle_of(polygon, count)
        for a in range(count):
            b = (a + 1) % count
            p_x, p_y, q_x, q_y = polygon[a, 0], polygon[a, 1], polygon[b, 0], polygon[b, 1]
            triangle = 0.5 * ((p_x - m_x) * (q_y - m_y) - (p_y - m_y) * (q_x - m_x))
            if triangle <= EMPTY * whole:
                continue
            for g in range(len(weights)):
                x = rule[g, 0] * m_x + rule[g, 1] * p_x + rule[g, 2] * q_x
                y = rule[g, 0] * m_y + rule[g, 1] * p_y + rule[g, 2] * q_y
                stretch = place_in(flat, c, x, y, first.places[i[k] % s_1], here)
                place_in(projected, o, x, y, second.places[j[k] % s_2], there)
                share = weights[g] * triangle / stretch
                true_area(first.nodes[face], here, D, normal)
                turn(normal, upright, axes[2])
                shapes(c, here[0], here[1], hats)
                shapes(nodes, here[0], here[1], N)
                point_at(first.nodes[face], N, point)
                if curved:
                    land(point, axes[2], second.nodes[opposite], there)
                shapes(count_2, there[0], there[1], M)
                share *= normal[0] * axes[2, 0] + normal[1] * axes[2, 1] + normal[2] * axes[2, 2]
                share *= _added(first, face, point, N, axes[2], second, opposite, M, spare)
                for e in range(c):
                    over[face, e] += hats[e] * share
