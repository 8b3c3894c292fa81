# SPDX-License-Identifier: BSD-3-Clause
"""Common part of two plane pieces of faces; compiled.

Both pieces are projected along the normal that they see each other along: that of the nonmortar piece, or one between
both. They are convex polygons there and are clipped (Sutherland, Hodgman 1974).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem.facets import slopes

EMPTY = 1e-14  # of the area of a piece: a common part that is none
_STEPS = 30


class Sight(NamedTuple):
    """What of two pieces is seen along a normal: arrays that one pair after the other is written into.

    Attributes
    ----------
    axes, centre : (3, 3) two directions across the normal and the normal itself, and (3,) the origin
    flat, projected : (4, 2) corners of both pieces in that plane
    polygon : (16, 2) corners of their common part
    spare : (16, 2)
    """

    axes: Array
    centre: Array
    flat: Array
    projected: Array
    polygon: Array
    spare: Array


@part()
def make_sight() -> Sight:
    """Room for what one pair after the other is written into."""
    return Sight(
        np.empty((3, 3)), np.empty(3), np.empty((4, 2)), np.empty((4, 2)), np.empty((16, 2)), np.empty((16, 2))
    )


@part()
def _cross(a: Array, b: Array, out: Array) -> float:
    """a x b into out; its length."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return math.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)


@part()
def upright_of(piece: Array, normal: Array) -> None:
    """Unit normal of a piece, from its diagonals."""
    along, across = np.empty(3), np.empty(3)
    for e in range(3):
        along[e], across[e] = piece[2, e] - piece[0, e], piece[len(piece) - 1, e] - piece[1, e]
    size = _cross(along, across, normal)
    for e in range(3):
        normal[e] /= size


@part()
def _plane(piece: Array, normal: Array, axes: Array, centre: Array, flat: Array) -> float:
    """Axes (3, 3: two across a unit normal, the normal), centre, and coordinates (c, 2) of a piece across it; its area
    as seen along the normal.
    """
    c, size = len(piece), 0.0
    for e in range(3):
        centre[e], axes[2, e] = 0.0, normal[e]
        for a in range(c):
            centre[e] += piece[a, e] / c
        size += (piece[2, e] - piece[0, e]) * normal[e]
    length = 0.0
    for e in range(3):
        axes[0, e] = piece[2, e] - piece[0, e] - size * normal[e]
        length += axes[0, e] ** 2
    for e in range(3):
        axes[0, e] /= math.sqrt(length)
    _cross(axes[2], axes[0], axes[1])
    _flatten(piece, axes, centre, flat)
    return _area(flat, c)


@part()
def _flatten(piece: Array, axes: Array, centre: Array, flat: Array) -> None:
    """Plane coordinates of the corners of a piece."""
    for a in range(len(piece)):
        for e in range(2):
            flat[a, e] = 0.0
            for f in range(3):
                flat[a, e] += (piece[a, f] - centre[f]) * axes[e, f]


@part()
def _area(polygon: Array, count: int) -> float:
    area = 0.0
    for a in range(count):
        b = (a + 1) % count
        area += 0.5 * (polygon[a, 0] * polygon[b, 1] - polygon[a, 1] * polygon[b, 0])
    return area


@part()
def middle_of(polygon: Array, count: int) -> tuple[float, float]:
    """Mean of the corners of a polygon."""
    x, y = 0.0, 0.0
    for a in range(count):
        x += polygon[a, 0] / count
        y += polygon[a, 1] / count
    return x, y


@part()
def _clipped(polygon: Array, count: int, window: Array, sides: int, spare: Array) -> int:
    """Cut a convex polygon, in place, to a convex window run through counter-clockwise; how many corners are left."""
    for j in range(sides):
        a_x, a_y = window[j, 0], window[j, 1]
        e_x, e_y = window[(j + 1) % sides, 0] - a_x, window[(j + 1) % sides, 1] - a_y
        left = 0
        for i in range(count):
            s_x, s_y = polygon[i, 0], polygon[i, 1]
            t_x, t_y = polygon[(i + 1) % count, 0], polygon[(i + 1) % count, 1]
            here, there = e_x * (s_y - a_y) - e_y * (s_x - a_x), e_x * (t_y - a_y) - e_y * (t_x - a_x)
            if here >= 0.0:
                spare[left, 0], spare[left, 1] = s_x, s_y
                left += 1
            if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
                cut = here / (here - there)
                spare[left, 0], spare[left, 1] = s_x + cut * (t_x - s_x), s_y + cut * (t_y - s_y)
                left += 1
        count = left
        for i in range(count):
            polygon[i, 0], polygon[i, 1] = spare[i, 0], spare[i, 1]
        if count < 3:
            return 0
    return count


@part()
def _common(flat: Array, c: int, other: Array, o: int, polygon: Array, spare: Array) -> int:
    """Corners of the common part of two pieces in one plane; the second runs the other way round."""
    window = np.empty((o, 2))
    for a in range(o):
        window[a, 0], window[a, 1] = other[o - 1 - a, 0], other[o - 1 - a, 1]
    if _area(window, o) <= 0.0:
        return 0
    for a in range(c):
        polygon[a, 0], polygon[a, 1] = flat[a, 0], flat[a, 1]
    return _clipped(polygon, c, window, o, spare)


@part()
def look(piece: Array, opposite: Array, normal: Array, sight: Sight) -> tuple[float, int]:
    """Look from a piece along a normal at one of the other side: its area, and the corners of the common part.

    Parameters
    ----------
    piece, opposite : (3 or 4, 3) corners of both pieces, length
    normal : (3,) unit vector, out of the first
    sight : written over
    """
    whole = _plane(piece, normal, sight.axes, sight.centre, sight.flat)
    _flatten(opposite, sight.axes, sight.centre, sight.projected)
    return whole, _common(sight.flat, len(piece), sight.projected, len(opposite), sight.polygon, sight.spare)


@part()
def _height(piece: Array, at: Array, direction: Array, normal: Array) -> float:
    """How far along a direction from a point the plane of a piece is."""
    upright_of(piece, normal)
    c, cosine, height = len(piece), 0.0, 0.0
    for e in range(3):
        middle = 0.0
        for a in range(c):
            middle += piece[a, e] / c
        cosine += normal[e] * direction[e]
        height += normal[e] * (middle - at[e])
    return height / cosine


@kernel(nogil=True)
def overlap_areas(first: Array, second: Array, normals: Array, i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Area of the common part of pairs of pieces, and the distance from the first to the second over its centroid.

    Parameters
    ----------
    first, second : (p, 3 or 4, 3) corners of the pieces of both sides
    normals : (p, 3) unit normals along which the first pieces see the second
    i, j : (k,) the pairs
    """
    sight, at, normal = make_sight(), np.empty(3), np.empty(3)
    axes, centre, polygon = sight.axes, sight.centre, sight.polygon
    area, distance = np.zeros(len(i)), np.zeros(len(i))
    for k in range(len(i)):
        whole, count = look(first[i[k]], second[j[k]], normals[i[k]], sight)
        if count < 3:
            continue
        common = _area(polygon, count)
        if common <= EMPTY * whole:
            continue
        area[k] = common
        x, y = middle_of(polygon, count)
        for e in range(3):
            at[e] = centre[e] + x * axes[0, e] + y * axes[1, e]
        distance[k] = _height(second[j[k]], at, axes[2], normal) - _height(first[i[k]], at, axes[2], normal)
    return area, distance


@part()
def place_in(flat: Array, c: int, x: float, y: float, places: Array, found: Array) -> float:
    """Reference place of the point (x, y) of a piece whose corners are at ``flat``, and the area per reference area.

    Parameters
    ----------
    flat, c : (4, 2) corners of the piece in its plane, and their number, 3 or 4
    x, y : the point there
    places : (c, 2) reference coordinates of its corners: the piece is part of a larger face
    found : (2,) is written over
    """
    if c == 3:
        a_x, a_y = flat[1, 0] - flat[0, 0], flat[1, 1] - flat[0, 1]
        b_x, b_y = flat[2, 0] - flat[0, 0], flat[2, 1] - flat[0, 1]
        size = a_x * b_y - a_y * b_x
        if size == 0.0:  # it is seen as a line
            found[0], found[1] = places[0, 0], places[0, 1]
            return 0.0
        r = ((x - flat[0, 0]) * b_y - (y - flat[0, 1]) * b_x) / size
        s = (a_x * (y - flat[0, 1]) - a_y * (x - flat[0, 0])) / size
        for e in range(2):
            found[e] = (1 - r - s) * places[0, e] + r * places[1, e] + s * places[2, e]
        p_x, p_y = places[1, 0] - places[0, 0], places[1, 1] - places[0, 1]
        q_x, q_y = places[2, 0] - places[0, 0], places[2, 1] - places[0, 1]
        return size / (p_x * q_y - p_y * q_x)
    r, s, size = 0.5, 0.5, 1.0
    for _ in range(_STEPS):
        off_x = (1 - s) * ((1 - r) * flat[0, 0] + r * flat[1, 0]) + s * (r * flat[2, 0] + (1 - r) * flat[3, 0]) - x
        off_y = (1 - s) * ((1 - r) * flat[0, 1] + r * flat[1, 1]) + s * (r * flat[2, 1] + (1 - r) * flat[3, 1]) - y
        a_x = (1 - s) * (flat[1, 0] - flat[0, 0]) + s * (flat[2, 0] - flat[3, 0])
        a_y = (1 - s) * (flat[1, 1] - flat[0, 1]) + s * (flat[2, 1] - flat[3, 1])
        b_x = (1 - r) * (flat[3, 0] - flat[0, 0]) + r * (flat[2, 0] - flat[1, 0])
        b_y = (1 - r) * (flat[3, 1] - flat[0, 1]) + r * (flat[2, 1] - flat[1, 1])
        size = a_x * b_y - a_y * b_x
        if size == 0.0:  # where an edge has collapsed every place along it is the same
            break
        step_r, step_s = (b_y * off_x - b_x * off_y) / size, (a_x * off_y - a_y * off_x) / size
        r, s = r - step_r, s - step_s
        if abs(step_r) + abs(step_s) < 1e-15:
            break
    for e in range(2):
        low = (1 - r) * places[0, e] + r * places[1, e]
        high = (1 - r) * places[3, e] + r * places[2, e]
        found[e] = (1 - s) * low + s * high
    width, depth = places[2, 0] - places[0, 0], places[2, 1] - places[0, 1]
    return size / (width * depth)


@part()
def true_area(nodes: Array, place: Array, D: Array, normal: Array) -> float:
    """Area of a face per reference area at a reference place; times its outward normal there, into ``normal``.

    Parameters
    ----------
    nodes : (c, 3) of the face
    place : (2,) reference coordinates
    D, normal : (2, 9) and (3,) are written over
    """
    c = len(nodes)
    slopes(c, place[0], place[1], D)
    x, y = np.zeros(3), np.zeros(3)
    for a in range(c):
        for e in range(3):
            x[e] += D[0, a] * nodes[a, e]
            y[e] += D[1, a] * nodes[a, e]
    return _cross(x, y, normal)


@part()
def point_at(nodes: Array, N: Array, point: Array) -> None:
    """Where a face is that has shape functions N, into ``point``.

    Parameters
    ----------
    nodes : (c, 3) of the face
    N : (c,) values of its shape functions; more are ignored
    point : (3,) is written over
    """
    for e in range(3):
        point[e] = 0.0
        for a in range(len(nodes)):
            point[e] += N[a] * nodes[a, e]


@part()
def rotate(vector: Array, before: Array, after: Array) -> None:
    """Turn a vector, in place, by what turns one unit vector into another; see `interface.tilt.rotate_between`.

    Parameters
    ----------
    vector : (3,) is written over
    before, after : (3,) unit vectors
    """
    both, same, own = 0.0, 1.0, 0.0
    for e in range(3):
        both += (before[e] + after[e]) * vector[e]
        same += before[e] * after[e]
        own += before[e] * vector[e]
    for e in range(3):
        vector[e] += 2.0 * own * after[e] - both / same * (before[e] + after[e])
