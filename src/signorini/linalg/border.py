# SPDX-License-Identifier: BSD-3-Clause
"""A matrix with a border: forces beside the stiffness that they act on."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy import sparse

from signorini.arrays import Array, IntArray
from signorini.linalg.system import Int32Array


def bordered(K: sparse.csr_array, B: sparse.csr_array) -> sparse.csr_array:
    """``[[K, B^T], [B, 0]]``, (n + m, n + m); with the border as its interface it condenses to ``-B K^-1 B^T``.

    Parameters
    ----------
    K : (n, n)
    B : (m, n)

    Examples
    --------
    >>> K, B = sparse.csr_array(np.diag([2.0, 4.0])), sparse.csr_array(np.array([[1.0, -1.0]]))
    >>> bordered(K, B).toarray().tolist()
    [[2.0, 0.0, 1.0], [0.0, 4.0, -1.0], [1.0, -1.0, 0.0]]
    """
    beside = sparse.csr_array(B.T)
    count = np.concatenate([np.diff(K.indptr) + np.diff(beside.indptr), np.diff(B.indptr)])
    indptr = np.concatenate([[0], np.cumsum(count)]).astype(np.int32)
    indices, data = np.empty(indptr[-1], np.int32), np.empty(indptr[-1])
    _fill(K.indptr, K.indices, K.data, beside.indptr, beside.indices, beside.data, indptr, indices, data)
    last = int(indptr[K.shape[0]])
    indices[last:], data[last:] = B.indices, B.data
    return sparse.csr_array((data, indices, indptr), shape=(len(count),) * 2)


@njit(cache=True)
def _fill(
    indptr: IntArray,
    indices: IntArray,
    data: Array,
    beside_indptr: IntArray,
    beside_indices: IntArray,
    beside_data: Array,
    rows: Int32Array,
    columns: Int32Array,
    values: Array,
) -> None:
    """Copy the rows of two matrices one behind the other."""
    n = len(indptr) - 1
    for i in range(n):
        top = rows[i]
        for p in range(indptr[i], indptr[i + 1]):
            columns[top], values[top] = indices[p], data[p]
            top += 1
        for p in range(beside_indptr[i], beside_indptr[i + 1]):
            columns[top], values[top] = n + beside_indices[p], beside_data[p]
            top += 1
