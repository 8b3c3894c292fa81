# SPDX-License-Identifier: BSD-3-Clause
"""Reference faces: shape functions of 3-, 6-node triangles and 4-, 8-, 9-node quadrilaterals, compiled; their pieces.

Triangles live on (0, 0), (1, 0), (0, 1), quadrilaterals on [-1, 1] squared. Nodes: corners counter-clockwise seen from
outside, middles in the same order beginning between the first two corners, the centre.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from signorini.arrays import Array
from signorini.meshing.faces import CORNERS

_TRIANGLE = np.array([[0.0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
_SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]])
_THIRDS = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]
_QUARTERS = [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]


def node_places(count: int) -> Array:
    """(count, 2) Reference coordinates of the nodes of a face."""
    return (_TRIANGLE if CORNERS[count] == 3 else _SQUARE)[:count]


def pieces(count: int) -> Array:
    """(s, 3 or 4, 2) Reference coordinates of the corners of the plane pieces that stand for a face, 4 if quadratic."""
    if count in (3, 4):
        return node_places(count)[None]
    return _TRIANGLE[_THIRDS] if count == 6 else _SQUARE[_QUARTERS]


@njit(cache=True)
def shapes(count: int, x: float, y: float, N: Array) -> None:
    """Values of the shape functions at (x, y), into N (count,).

    Examples
    --------
    >>> N = np.empty(8)
    >>> shapes(8, 0.0, -1.0, N)
    >>> N.tolist()
    [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    """
    if count == 3 or count == 6:
        z = 1.0 - x - y
        N[0], N[1], N[2] = z, x, y
        if count == 6:
            N[3], N[4], N[5] = 4 * z * x, 4 * x * y, 4 * y * z
            N[0], N[1], N[2] = z * (2 * z - 1), x * (2 * x - 1), y * (2 * y - 1)
        return
    if count == 9:
        a = (0.5 * x * (x - 1), 0.5 * x * (x + 1), 1 - x * x)
        b = (0.5 * y * (y - 1), 0.5 * y * (y + 1), 1 - y * y)
        N[0], N[1], N[2], N[3] = a[0] * b[0], a[1] * b[0], a[1] * b[1], a[0] * b[1]
        N[4], N[5], N[6], N[7], N[8] = a[2] * b[0], a[1] * b[2], a[2] * b[1], a[0] * b[2], a[2] * b[2]
        return
    u, v, p, q = 1 - x, 1 - y, 1 + x, 1 + y
    N[0], N[1], N[2], N[3] = 0.25 * u * v, 0.25 * p * v, 0.25 * p * q, 0.25 * u * q
    if count == 8:
        N[4], N[5] = 0.5 * u * p * v, 0.5 * p * v * q
        N[6], N[7] = 0.5 * u * p * q, 0.5 * u * v * q
        N[0] -= 0.5 * (N[7] + N[4])
        N[1] -= 0.5 * (N[4] + N[5])
        N[2] -= 0.5 * (N[5] + N[6])
        N[3] -= 0.5 * (N[6] + N[7])


@njit(cache=True)
def slopes(count: int, x: float, y: float, D: Array) -> None:
    """Derivatives of the shape functions at (x, y), into D (2, count)."""
    if count == 3 or count == 6:
        z = 1.0 - x - y
        D[0, 0], D[0, 1], D[0, 2] = -1.0, 1.0, 0.0
        D[1, 0], D[1, 1], D[1, 2] = -1.0, 0.0, 1.0
        if count == 6:
            D[0, 0], D[0, 1], D[0, 2] = 1 - 4 * z, 4 * x - 1, 0.0
            D[1, 0], D[1, 1], D[1, 2] = 1 - 4 * z, 0.0, 4 * y - 1
            D[0, 3], D[0, 4], D[0, 5] = 4 * (z - x), 4 * y, -4 * y
            D[1, 3], D[1, 4], D[1, 5] = -4 * x, 4 * x, 4 * (z - y)
        return
    if count == 9:
        a, da = (0.5 * x * (x - 1), 0.5 * x * (x + 1), 1 - x * x), (x - 0.5, x + 0.5, -2 * x)
        b, db = (0.5 * y * (y - 1), 0.5 * y * (y + 1), 1 - y * y), (y - 0.5, y + 0.5, -2 * y)
        for k, (i, j) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (1, 2), (2, 1), (0, 2), (2, 2))):
            D[0, k], D[1, k] = da[i] * b[j], a[i] * db[j]
        return
    u, v, p, q = 1 - x, 1 - y, 1 + x, 1 + y
    D[0, 0], D[0, 1], D[0, 2], D[0, 3] = -0.25 * v, 0.25 * v, 0.25 * q, -0.25 * q
    D[1, 0], D[1, 1], D[1, 2], D[1, 3] = -0.25 * u, -0.25 * p, 0.25 * p, 0.25 * u
    if count == 8:
        D[0, 4], D[0, 5], D[0, 6], D[0, 7] = -x * v, 0.5 * v * q, -x * q, -0.5 * v * q
        D[1, 4], D[1, 5], D[1, 6], D[1, 7] = -0.5 * u * p, -p * y, 0.5 * u * p, -u * y
        for e in range(2):
            D[e, 0] -= 0.5 * (D[e, 7] + D[e, 4])
            D[e, 1] -= 0.5 * (D[e, 4] + D[e, 5])
            D[e, 2] -= 0.5 * (D[e, 5] + D[e, 6])
            D[e, 3] -= 0.5 * (D[e, 6] + D[e, 7])


@njit(cache=True)
def shapes_at(count: int, places: Array) -> Array:
    """(q, count) Shape functions at reference coordinates (q, 2)."""
    N = np.empty((len(places), count))
    for q in range(len(places)):
        shapes(count, places[q, 0], places[q, 1], N[q])
    return N


@njit(cache=True)
def slopes_at(count: int, places: Array) -> Array:
    """(q, 2, count) Their derivatives."""
    D = np.empty((len(places), 2, count))
    for q in range(len(places)):
        slopes(count, places[q, 0], places[q, 1], D[q])
    return D
