# SPDX-License-Identifier: BSD-3-Clause
"""A rigid surface of triangles: how far points are from it, on which side, and which way is out."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from signorini.arrays import Array, IntArray, frozen
from signorini.errors import InputError

_ON = 1e-12  # of the size of the surface: a point so near lies on it


@njit(cache=True)
def _closest(p: Array, a: Array, b: Array, c: Array, weights: Array) -> float:
    """Barycentric weights of the point of the triangle abc nearest to p; its squared distance (Ericson 2005, 5.1.5)."""
    d_1, d_2, d_3, d_4, d_5, d_6 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for e in range(3):
        u, v = b[e] - a[e], c[e] - a[e]
        d_1, d_2 = d_1 + u * (p[e] - a[e]), d_2 + v * (p[e] - a[e])
        d_3, d_4 = d_3 + u * (p[e] - b[e]), d_4 + v * (p[e] - b[e])
        d_5, d_6 = d_5 + u * (p[e] - c[e]), d_6 + v * (p[e] - c[e])
    v_a, v_b, v_c = d_3 * d_6 - d_5 * d_4, d_5 * d_2 - d_1 * d_6, d_1 * d_4 - d_3 * d_2
    s, t = 0.0, 0.0
    if d_1 <= 0.0 and d_2 <= 0.0:
        s, t = 0.0, 0.0
    elif d_3 >= 0.0 and d_4 <= d_3:
        s, t = 1.0, 0.0
    elif d_6 >= 0.0 and d_5 <= d_6:
        s, t = 0.0, 1.0
    elif v_c <= 0.0 and d_1 >= 0.0 and d_3 <= 0.0:
        s, t = d_1 / (d_1 - d_3), 0.0
    elif v_b <= 0.0 and d_2 >= 0.0 and d_6 <= 0.0:
        s, t = 0.0, d_2 / (d_2 - d_6)
    elif v_a <= 0.0 and d_4 - d_3 >= 0.0 and d_5 - d_6 >= 0.0:
        t = (d_4 - d_3) / ((d_4 - d_3) + (d_5 - d_6))
        s = 1.0 - t
    else:
        s, t = v_b / (v_a + v_b + v_c), v_c / (v_a + v_b + v_c)
    weights[0], weights[1], weights[2] = 1.0 - s - t, s, t
    far = 0.0
    for e in range(3):
        far += (p[e] - weights[0] * a[e] - s * b[e] - t * c[e]) ** 2
    return far


@njit(cache=True)
def _nearest(points: Array, corners: Array, start: IntArray, candidate: IntArray) -> tuple[IntArray, Array]:
    """Nearest triangle of every point among its candidates, and the barycentric weights there."""
    triangle, best = np.full(len(points), -1), np.empty((len(points), 3))
    weights = np.empty(3)
    for i in range(len(points)):
        least = math.inf
        for k in range(start[i], start[i + 1]):
            j = candidate[k]
            far = _closest(points[i], corners[j, 0], corners[j, 1], corners[j, 2], weights)
            if far < least:
                least, triangle[i] = far, j
                for e in range(3):
                    best[i, e] = weights[e]
    return triangle, best


@dataclass(frozen=True, eq=False)
class TriangulatedSurface:
    """A rigid surface of triangles, closed or not, the obstacle behind it.

    Parameters
    ----------
    points : (n, 3), length
    triangles : (m, 3) corners, counter-clockwise seen from the bodies

    Raises
    ------
    InputError
        For wrong shapes, corners that are not there, or triangles without area.

    References
    ----------
    Baerentzen, Aanaes (2005), IEEE Transactions on Visualization and Computer Graphics 11:243-253 (normals at edges and
    corners, weighted by angles, tell the sides apart).

    Examples
    --------
    >>> floor = TriangulatedSurface([[0, 0, 0], [2, 0, 0], [0, 2, 0]], [[0, 1, 2]])
    >>> floor.nearest([[0.5, 0.5, 3.0], [0.5, 0.5, -0.25]])[0].tolist()
    [3.0, -0.25]
    """

    points: ArrayLike
    triangles: ArrayLike

    def __post_init__(self) -> None:
        points, triangles = frozen(self.points), frozen(self.triangles, dtype=np.int64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InputError(f"has shape {points.shape}; expected (n, 3)", where=("points",))
        if triangles.ndim != 2 or triangles.shape[1] != 3 or not len(triangles):
            raise InputError(f"has shape {triangles.shape}; expected (m, 3), m > 0", where=("triangles",))
        if triangles.min() < 0 or triangles.max() >= len(points):
            raise InputError(f"names point {triangles.max()} of {len(points)}", where=("triangles",))
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)
        area = np.linalg.norm(self._spans, axis=1)
        if (area <= 0).any():
            raise InputError(f"triangle {int(np.argmin(area))} has no area", where=("triangles",))

    def __str__(self) -> str:
        return f"a surface of {len(self._corners)} triangles"

    @property
    def dimension(self) -> int:
        """Of the space that it lies in: 3."""
        return 3

    def nearest(self, points: ArrayLike) -> tuple[Array, Array]:
        """Signed distance of points (n, 3), positive in front of the surface, and its outward normals there (n, 3).

        The normal of a point off the surface is the direction in which its distance grows; of one on it the mean of
        the triangles there.
        """
        x = np.ascontiguousarray(points, dtype=np.float64)
        centres, radius = self._bounds
        closest, _ = self._tree.query(x)
        lists = self._tree.query_ball_point(x, (closest + radius) * (1.0 + 1e-9))
        start = np.concatenate([[0], np.cumsum([len(found) for found in lists])])
        triangle, weights = _nearest(x, self._corners, start, np.concatenate([np.asarray(f, int) for f in lists]))
        across = x - np.einsum("na,nae->ne", weights, self._corners[triangle])
        mean = self._mean_normals(triangle, weights)
        size = np.linalg.norm(across, axis=1)
        sign = np.where(np.sum(across * mean, axis=1) < 0, -1.0, 1.0)
        on = size <= _ON * float(np.ptp(centres, axis=0).max() + radius)
        normals = np.where(on[:, None], mean, across * (sign / np.where(on, 1.0, size))[:, None])
        return sign * size, normals

    @cached_property
    def _corners(self) -> Array:
        corners: Array = np.asarray(self.points)[np.asarray(self.triangles)]
        return corners

    @cached_property
    def _spans(self) -> Array:
        a, b, c = self._corners.transpose(1, 0, 2)
        return np.cross(b - a, c - a)

    @cached_property
    def _bounds(self) -> tuple[Array, float]:
        centres = self._corners.mean(axis=1)
        return centres, float(np.linalg.norm(self._corners - centres[:, None], axis=2).max())

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self._bounds[0])

    @cached_property
    def _edge_normals(self) -> Array:
        """(m, 3, 3) Sums of the unit normals on both sides of the edge opposite each corner."""
        triangles = np.asarray(self.triangles)
        unit = self._spans / np.linalg.norm(self._spans, axis=1, keepdims=True)
        ends = np.sort(triangles[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
        _, edge = np.unique(ends, axis=0, return_inverse=True)
        total = np.zeros((int(edge.max()) + 1, 3))
        np.add.at(total, edge.ravel(), np.repeat(unit, 3, axis=0))
        return np.asarray(total[edge.ravel()].reshape(-1, 3, 3))

    @cached_property
    def _corner_normals(self) -> Array:
        """(n, 3) Unit normals of the triangles at every point, weighted with their angles there."""
        triangles = np.asarray(self.triangles)
        unit = self._spans / np.linalg.norm(self._spans, axis=1, keepdims=True)
        total = np.zeros((len(np.asarray(self.points)), 3))
        for a in range(3):
            u = self._corners[:, (a + 1) % 3] - self._corners[:, a]
            v = self._corners[:, (a + 2) % 3] - self._corners[:, a]
            angle = np.arctan2(np.linalg.norm(self._spans, axis=1), np.sum(u * v, axis=1))
            np.add.at(total, triangles[:, a], angle[:, None] * unit)
        return total

    def _mean_normals(self, triangle: IntArray, weights: Array) -> Array:
        """Unit normals at the nearest points: of the triangle, of both beside an edge, or of all at a corner."""
        zero = weights <= 1e-12
        count = zero.sum(axis=1)
        normals = self._spans[triangle].copy()
        edge = count == 1
        normals[edge] = self._edge_normals[triangle[edge], np.argmax(zero[edge], axis=1)]
        corner = count == 2
        nodes = np.asarray(self.triangles)[triangle[corner], np.argmin(zero[corner], axis=1)]
        normals[corner] = self._corner_normals[nodes]
        return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))
