# SPDX-License-Identifier: BSD-3-Clause
"""Nearest triangles by a tree of boxes: many points at once, whatever the sizes of the triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, IntArray

_AT_ONCE = 4096  # points: bounds the memory where many triangles are equally near


def closest(p: Array, corners: Array) -> tuple[Array, Array]:
    """Barycentric weights of the points of triangles (k, 3, 3) nearest to points (k, 3), and their squared distances.

    References
    ----------
    Ericson (2005), Real-Time Collision Detection, 5.1.5.

    Examples
    --------
    >>> closest(np.array([[0.5, -1.0, 2.0]]), np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]))
    (array([[0.5, 0.5, 0. ]]), array([5.]))
    """
    a, b, c = corners.transpose(1, 0, 2)
    u, v = b - a, c - a
    d_1, d_3, d_5 = (np.einsum("ke,ke->k", u, p - corner) for corner in (a, b, c))
    d_2, d_4, d_6 = (np.einsum("ke,ke->k", v, p - corner) for corner in (a, b, c))
    v_a, v_b, v_c = d_3 * d_6 - d_5 * d_4, d_5 * d_2 - d_1 * d_6, d_1 * d_4 - d_3 * d_2
    along_b, along_c, along_a = _part(d_1, d_1 - d_3), _part(d_2, d_2 - d_6), _part(d_4 - d_3, d_4 - d_3 + d_5 - d_6)
    whole = v_a + v_b + v_c
    regions = [
        (d_1 <= 0.0) & (d_2 <= 0.0),  # corner a
        (d_3 >= 0.0) & (d_4 <= d_3),  # corner b
        (d_6 >= 0.0) & (d_5 <= d_6),  # corner c
        (v_c <= 0.0) & (d_1 >= 0.0) & (d_3 <= 0.0),  # edge ab
        (v_b <= 0.0) & (d_2 >= 0.0) & (d_6 <= 0.0),  # edge ac
        (v_a <= 0.0) & (d_4 - d_3 >= 0.0) & (d_5 - d_6 >= 0.0),  # edge bc
    ]
    zero, one = np.zeros(len(p)), np.ones(len(p))
    s = np.select(regions, [zero, one, zero, along_b, zero, 1.0 - along_a], _part(v_b, whole))
    t = np.select(regions, [zero, zero, one, zero, along_c, along_a], _part(v_c, whole))
    weights = np.stack([1.0 - s - t, s, t], axis=1)
    across = p - np.einsum("ka,kae->ke", weights, corners)
    return weights, np.einsum("ke,ke->k", across, across)


def _part(share: Array, whole: Array) -> Array:
    """``share / whole``, 0 where there is no whole (the region is another one then)."""
    return np.divide(share, whole, out=np.zeros_like(share), where=whole != 0.0)


@dataclass(frozen=True, eq=False)
class BoxTree:
    """Triangles halved again and again along the longest side of their middles, with the boxes around every half.

    Parameters
    ----------
    corners : (m, 3, 3) of the triangles, length
    """

    corners: Array

    def nearest(self, points: Array) -> tuple[IntArray, Array]:
        """Nearest triangle of every point (n, 3), and the barycentric weights of the place there, (n,) and (n, 3)."""
        parts = [self._nearest(points[i : i + _AT_ONCE]) for i in range(0, len(points), _AT_ONCE)]
        if not parts:
            return np.zeros(0, np.int64), np.zeros((0, 3))
        return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])

    def _nearest(self, x: Array) -> tuple[IntArray, Array]:
        order, low, high = self._tree
        bound = self._descended(x)
        who: IntArray = np.arange(len(x))
        node: IntArray = np.zeros(len(x), np.int64)
        for level in range(1, len(low)):
            who, node = np.repeat(who, 2), (2 * node[:, None] + np.arange(2)).ravel()
            near = _to_box(x[who], low[level][node], high[level][node]) <= bound[who]
            who, node = who[near], node[near]
        triangle = order[node]
        weights, far = closest(x[who], self.corners[triangle])
        best = np.lexsort((triangle, far, who))
        first = best[np.searchsorted(who[best], np.arange(len(x)))]
        return triangle[first], weights[first]

    def _descended(self, x: Array) -> Array:
        """Squared distance of one triangle that is near, (n,): the way down always into the nearer box."""
        order, low, high = self._tree
        node = np.zeros(len(x), np.int64)
        for level in range(1, len(low)):
            left, right = (_to_box(x, low[level][child], high[level][child]) for child in (2 * node, 2 * node + 1))
            node = 2 * node + (right < left)
        far: Array = closest(x, self.corners[order[node]])[1]
        return far * (1.0 + 1e-9) + 1e-300

    @cached_property
    def _tree(self) -> tuple[IntArray, list[Array], list[Array]]:
        """Triangles in the order of the leaves, the last one filling up to a power of 2; the boxes of every level."""
        count = len(self.corners)
        depth = int(np.ceil(np.log2(count)))
        order: IntArray = np.minimum(np.arange(2**depth), count - 1)
        middles = self.corners.mean(axis=1)
        for level in range(depth):
            rows = order.reshape(2**level, -1)
            there = middles[rows]
            axis = np.argmax(np.ptp(there, axis=1), axis=1)
            along = np.take_along_axis(there, axis[:, None, None], axis=2)[..., 0]
            order = np.take_along_axis(rows, np.argsort(along, axis=1, kind="stable"), axis=1).ravel()
        low, high = [self.corners[order].min(axis=1)], [self.corners[order].max(axis=1)]
        while len(low[0]) > 1:
            low.insert(0, low[0].reshape(-1, 2, 3).min(axis=1))
            high.insert(0, high[0].reshape(-1, 2, 3).max(axis=1))
        return order, low, high


def _to_box(x: Array, low: Array, high: Array) -> Array:
    """Squared distances of points from boxes, (k,)."""
    beyond = np.maximum(np.maximum(low - x, x - high), 0.0)
    squared: Array = np.einsum("ke,ke->k", beyond, beyond)
    return squared
