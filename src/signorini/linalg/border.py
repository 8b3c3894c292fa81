# SPDX-License-Identifier: BSD-3-Clause
"""A matrix with a border: forces beside the stiffness that they act on."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy import sparse

from signorini.linalg._graph import Rows


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
    both = Rows(indptr, np.empty(indptr[-1], np.int32), np.empty(indptr[-1]))
    _fill(Rows(K.indptr, K.indices, K.data), Rows(beside.indptr, beside.indices, beside.data), both)
    last = int(indptr[K.shape[0]])
    both.indices[last:], both.data[last:] = B.indices, B.data
    return sparse.csr_array((both.data, both.indices, both.indptr), shape=(len(count),) * 2)


@njit(cache=True)
def _fill(K: Rows, beside: Rows, both: Rows) -> None:
    """Copy the rows of two matrices one behind the other."""
    n = len(K.indptr) - 1
    for i in range(n):
        top = both.indptr[i]
        for p in range(K.indptr[i], K.indptr[i + 1]):
            both.indices[top], both.data[top] = K.indices[p], K.data[p]
            top += 1
        for p in range(beside.indptr[i], beside.indptr[i + 1]):
            both.indices[top], both.data[top] = n + beside.indices[p], beside.data[p]
            top += 1
