# SPDX-License-Identifier: BSD-3-Clause
"""Reference facets: shape functions, quadratures and pieces of edges, triangles and quadrilaterals.

Edges live on [-1, 1], quadrilaterals on its square, triangles on (0, 0), (1, 0), (0, 1). Nodes: corners, in space
counter-clockwise seen from outside; middles of edges in the same order, beginning between the first two; the centre.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import skfem

from signorini.arrays import Array
from signorini.compilation import kernel, part
from signorini.meshing.facets import facet_corners

_EDGE = np.array([[-1.0], [1.0], [0.0]])
_TRIANGLE = np.array([[0.0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
_SQUARE = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]])
_THIRDS = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]
_QUARTERS = [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]
_EDGE_POINTS = {2: 2, 3: 4}  # of Gauss, by nodes of an edge: exact for pressure on both, with a radius too
_SQUARE_POINTS = {4: 2, 8: 3, 9: 3}  # of Gauss a direction, by nodes: exact for pressure on all shape functions
_TRIANGLE_DEGREE = {3: 2, 6: 4}  # of the polynomials that are integrated exactly, by nodes: pressure likewise


def facet_shapes(count: int, places: Array) -> tuple[Array, Array]:
    """Values (q, count) and derivatives (q, count, d - 1) of the shape functions of a facet.

    Parameters
    ----------
    count : nodes of the facet
    places : (q, d - 1) reference coordinates

    Examples
    --------
    >>> facet_shapes(4, np.array([[0.0, 0.0]]))[0]
    array([[0.25, 0.25, 0.25, 0.25]])
    """
    if places.shape[1] == 1:
        values, slopes = line_shapes(count, places[:, 0])
        return values, slopes[..., None]
    return _face_shapes(count, np.ascontiguousarray(places))


def line_shapes(count: int, at: Array) -> tuple[Array, Array]:
    """Values and derivatives of the shape functions of an edge: its two ends, then its middle.

    ``N = (1 - s)/2, (1 + s)/2``; with a middle ``N = s (s - 1)/2, s (s + 1)/2, 1 - s^2``.

    Parameters
    ----------
    count : nodes of the edge, 2 or 3
    at : (...) coordinates s on the edge, -1 at the first node and 1 at the second

    Returns
    -------
    values, derivatives : (..., count) each, the derivatives with respect to s

    Examples
    --------
    >>> line_shapes(3, np.array([-1.0, 0.0]))[0]
    array([[ 1., -0.,  0.],
           [-0.,  0.,  1.]])
    """
    s = np.asarray(at, float)
    if count == 2:
        values, slopes = [0.5 * (1.0 - s), 0.5 * (1.0 + s)], [np.full_like(s, -0.5), np.full_like(s, 0.5)]
    else:
        values, slopes = [0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s**2], [s - 0.5, s + 0.5, -2.0 * s]
    return np.stack(values, axis=-1), np.stack(slopes, axis=-1)


@cache
def facet_nodes(dimension: int, count: int) -> Array:
    """Reference coordinates of the nodes of a facet, (count, dimension - 1)."""
    if dimension == 2:
        return _EDGE[:count]
    return (_TRIANGLE if facet_corners(dimension, count) == 3 else _SQUARE)[:count]


@cache
def facet_pieces(count: int) -> Array:
    """(s, 3 or 4, 2) Reference corners of the plane pieces that stand for a face: one, or four of a quadratic face."""
    if count in (3, 4):
        return facet_nodes(3, count)[None]
    return _TRIANGLE[_THIRDS] if count == 6 else _SQUARE[_QUARTERS]


@cache
def facet_rule(dimension: int, count: int) -> tuple[Array, Array]:
    """Quadrature points (q, dimension - 1) and weights (q,) of a facet with ``count`` nodes."""
    if dimension == 2:
        return gauss_rule(2, _EDGE_POINTS[count])
    if count in _SQUARE_POINTS:
        return gauss_rule(4, _SQUARE_POINTS[count])
    at, weights = skfem.quadrature.get_quadrature(skfem.refdom.RefTri, _TRIANGLE_DEGREE[count])
    return np.ascontiguousarray(at.T), weights


@cache
def gauss_rule(corners: int, points: int) -> tuple[Array, Array]:
    """Gauss points (q, 1 or 2) and weights (q,) of a reference edge, triangle (collapsed) or square.

    Parameters
    ----------
    corners : 2, 3 or 4
    points : a direction: exact to degree 2 points - 1, of the triangle 2 points - 2
    """
    x, w = np.polynomial.legendre.leggauss(points)
    if corners == 2:
        return x[:, None], w
    a, b = (grid.ravel() for grid in np.meshgrid(x, x, indexing="ij"))
    both = np.outer(w, w).ravel()
    if corners == 4:
        return np.column_stack([a, b]), both
    a, b = 0.5 * (1.0 + a), 0.5 * (1.0 + b)
    return np.column_stack([a, (1.0 - a) * b]), 0.25 * both * (1.0 - a)


@part()
def shapes(count: int, x: float, y: float, N: Array) -> None:
    """Values of the shape functions at (x, y), into N (count,).

    Examples
    --------
    >>> facet_shapes(8, np.array([[0.0, -1.0]]))[0].tolist()
    [[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]
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


@kernel()
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


@kernel()
def _face_shapes(count: int, places: Array) -> tuple[Array, Array]:
    """Values (q, count) and derivatives (q, count, 2) of the shape functions of a face at places (q, 2)."""
    N, D, slope = np.empty((len(places), count)), np.empty((len(places), count, 2)), np.empty((2, count))
    for q in range(len(places)):
        shapes(count, places[q, 0], places[q, 1], N[q])
        slopes(count, places[q, 0], places[q, 1], slope)
        for a in range(count):  # one by one: the assignment of an array takes seconds to compile
            D[q, a, 0], D[q, a, 1] = slope[0, a], slope[1, a]
    return N, D
