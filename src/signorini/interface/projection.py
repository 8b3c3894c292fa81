# SPDX-License-Identifier: BSD-3-Clause
"""Where lines meet faces, plane or curved; compiled."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem.facets import shapes, slopes

_STEPS = 20  # of Newton, at most; what has no place by then has none
_STILL = 1e-10  # of a reference face: the step after that is rounding


@part()
def _step(first: Array, second: Array, third: Array, rhs: Array, out: Array) -> bool:
    """Solve ``[first second third] out = rhs`` by Cramer's rule; False where the columns are dependent."""
    a = second[1] * third[2] - second[2] * third[1]
    b = second[2] * third[0] - second[0] * third[2]
    c = second[0] * third[1] - second[1] * third[0]
    whole = first[0] * a + first[1] * b + first[2] * c
    if abs(whole) < 1e-300:
        return False
    out[0] = (rhs[0] * a + rhs[1] * b + rhs[2] * c) / whole
    a = rhs[1] * third[2] - rhs[2] * third[1]
    b = rhs[2] * third[0] - rhs[0] * third[2]
    c = rhs[0] * third[1] - rhs[1] * third[0]
    out[1] = (first[0] * a + first[1] * b + first[2] * c) / whole
    a = second[1] * rhs[2] - second[2] * rhs[1]
    b = second[2] * rhs[0] - second[0] * rhs[2]
    c = second[0] * rhs[1] - second[1] * rhs[0]
    out[2] = (first[0] * a + first[1] * b + first[2] * c) / whole
    return True


@part()
def land(point: Array, direction: Array, face: Array, place: Array) -> float:
    """Signed distance from a point along a unit direction (3,) to a face, NaN where the line does not meet it.

    Parameters
    ----------
    face : (c, 3) nodes
    place : (2,) where Newton's method starts on the reference face; where the line meets it afterwards, if it does
    """
    c = face.shape[0]
    N, D, off, step = np.empty(9), np.empty((2, 9)), np.empty(3), np.empty(3)
    along, across, back = np.empty(3), np.empty(3), np.empty(3)
    x, y, t = place[0], place[1], 0.0
    for _ in range(_STEPS):
        shapes(c, x, y, N)
        slopes(c, x, y, D)
        for e in range(3):
            back[e] = -direction[e]
            off[e] = point[e] - t * back[e]
            along[e], across[e] = 0.0, 0.0
            for a in range(c):
                off[e] -= N[a] * face[a, e]
                along[e] += D[0, a] * face[a, e]
                across[e] += D[1, a] * face[a, e]
        if not _step(along, across, back, off, step):
            break
        x, y, t = x + step[0], y + step[1], t + step[2]
        if abs(x) + abs(y) > 1e3:
            break
        if abs(step[0]) + abs(step[1]) < _STILL:
            place[0], place[1] = x, y
            return t
    return np.nan


@kernel()
def meet(points: Array, directions: Array, faces: Array, i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Reference place (k, 2) and signed distance (k,) where the line through a point meets a face; NaN where none.

    Parameters
    ----------
    points, directions : (p, 3) and unit vectors; distances count along them
    faces : (m, c, 3) nodes of faces
    i, j : (k,) pairs of a point and a face
    """
    c = faces.shape[1]
    places, distance = np.empty((len(i), 2)), np.empty(len(i))
    for k in range(len(i)):
        places[k] = 1.0 / 3.0 if c == 3 or c == 6 else 0.0
        distance[k] = land(points[i[k]], directions[i[k]], faces[j[k]], places[k])
        if np.isnan(distance[k]):
            places[k] = np.nan
    return places, distance
