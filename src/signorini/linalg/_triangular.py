# SPDX-License-Identifier: BSD-3-Clause
"""Compiled solves with the columns of a unit lower triangular matrix; its diagonal is not stored."""

from __future__ import annotations

from numba import njit

from signorini.arrays import Array
from signorini.linalg.system import Int32Array


@njit(cache=True)
def solve_lower(indptr: Int32Array, indices: Int32Array, data: Array, y: Array) -> None:
    """Overwrite y, (n, k), by ``L^-1 y``; rows without a column of their own only gather.

    Parameters
    ----------
    indptr, indices, data : columns of L below the diagonal
    y : overwritten
    """
    for j in range(len(indptr) - 1):
        for p in range(indptr[j], indptr[j + 1]):
            for c in range(y.shape[1]):
                y[indices[p], c] -= data[p] * y[j, c]


@njit(cache=True)
def solve_lower_transposed(indptr: Int32Array, indices: Int32Array, data: Array, y: Array) -> None:
    """Overwrite the rows of y that have a column in L by ``L^-T y``.

    Parameters
    ----------
    indptr, indices, data, y : see `solve_lower`
    """
    for j in range(len(indptr) - 2, -1, -1):
        for p in range(indptr[j], indptr[j + 1]):
            for c in range(y.shape[1]):
                y[j, c] -= data[p] * y[indices[p], c]
