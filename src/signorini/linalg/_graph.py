# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over graphs."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Int32Array = NDArray[np.int32]


@njit(cache=True)
def quotient(
    indptr: Int32Array, indices: Int32Array, start: Int32Array, member: Int32Array, group: Int32Array
) -> tuple[Int32Array, Int32Array]:
    """Merge the vertices of every group: the graph of the groups, sorted, without loops."""
    count = len(start) - 1
    mark = np.full(count, -1, np.int32)
    rows = np.zeros(count + 1, np.int32)
    columns = np.empty(max(16, len(indices) // 4), np.int32)
    top = 0
    for g in range(count):
        mark[g] = g
        for v in range(start[g], start[g + 1]):
            for p in range(indptr[member[v]], indptr[member[v] + 1]):
                h = group[indices[p]]
                if mark[h] != g:
                    mark[h] = g
                    if top == len(columns):
                        longer = np.empty(2 * top, np.int32)
                        longer[:top] = columns
                        columns = longer
                    columns[top] = h
                    top += 1
        columns[rows[g] : top].sort()
        rows[g + 1] = top
    return rows, columns[:top].copy()


@njit(cache=True)
def subgraph(indptr: Int32Array, indices: Int32Array, count: int) -> tuple[Int32Array, Int32Array]:
    """Keep the first `count` vertices and the edges between them."""
    rows = np.zeros(count + 1, np.int32)
    columns = np.empty(indptr[count], np.int32)
    top = 0
    for v in range(count):
        for p in range(indptr[v], indptr[v + 1]):
            if indices[p] < count:
                columns[top] = indices[p]
                top += 1
        rows[v + 1] = top
    return rows, columns[:top].copy()
