# SPDX-License-Identifier: BSD-3-Clause
"""A reduced matrix on a pattern that holds what another one is reduced to, whose entries are scattered into it."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel

_LACKING = -1  # place of an entry that the pattern lacks


def on_one_pattern(K: sp.csr_array, rows: sp.csr_array, T: sp.csr_array) -> tuple[sp.csr_array, sp.csc_array]:
    """K on a pattern that holds ``T^T S T`` for every S on the pattern of rows, and the map of their entries.

    Entry (i, j) of S goes to (a, b) times ``T_ia T_jb``, for every a in row i of T and b in row j.

    Parameters
    ----------
    K : (z, z) reduced matrix
    rows : (n, n) pattern of S; its entries do not count
    T : (n, z) of the reduction

    Examples
    --------
    >>> S = sp.csr_array(np.array([[2.0, 1.0], [1.0, 3.0]]))
    >>> T = sp.csr_array(np.array([[1.0, 0.0], [0.5, 0.5]]))
    >>> wide, gather = on_one_pattern(sp.csr_array(np.eye(2)), S, T)
    >>> wide.data[:] = gather @ S.data
    >>> wide.toarray().tolist(), (T.T @ S @ T).toarray().tolist()
    ([[3.75, 1.25], [1.25, 0.75]], [[3.75, 1.25], [1.25, 0.75]])
    """
    if not K.has_sorted_indices:
        K = K.sorted_indices()
    place, value, first = _images(rows.indptr, rows.indices, T.indptr, T.indices, T.data, K.indptr, K.indices)
    lacking = np.flatnonzero(place < 0)
    if len(lacking):  # SciPy leaves out entries that cancel
        K = _with(K, *_absent(rows.indptr, rows.indices, T.indptr, T.indices, place))
        place, value, first = _images(rows.indptr, rows.indices, T.indptr, T.indices, T.data, K.indptr, K.indices)
    gather = sp.csc_array((value, place, first), shape=(K.nnz, rows.nnz))
    return K, gather


def _with(K: sp.csr_array, row: IntArray, column: IntArray) -> sp.csr_array:
    """K with zeros at more places."""
    size = np.int64(K.shape[0])
    have = np.repeat(np.arange(size), np.diff(K.indptr)) * size + K.indices
    more = np.sort(row * size + column)
    more = more[np.diff(more, prepend=-1) > 0]
    at = np.searchsorted(have, more)
    indptr = K.indptr + np.searchsorted(more, np.arange(size + 1) * size).astype(K.indptr.dtype)
    beside = (more % size).astype(K.indices.dtype)
    return sp.csr_array((np.insert(K.data, at, 0.0), np.insert(K.indices, at, beside), indptr), shape=K.shape)


@kernel()
def _images(
    begin: Int32Array,
    column: Int32Array,
    T_begin: Int32Array,
    T_column: Int32Array,
    T_value: Array,
    K_begin: Int32Array,
    K_column: Int32Array,
) -> tuple[Int32Array, Array, IntArray]:
    """Places in K that every entry goes to, _LACKING where it has none, their factors, and where each entry's begin."""
    first = np.zeros(len(column) + 1, np.int64)
    for i in range(len(begin) - 1):
        many = T_begin[i + 1] - T_begin[i]
        for e in range(begin[i], begin[i + 1]):
            j = column[e]
            first[e + 1] = first[e] + many * (T_begin[j + 1] - T_begin[j])
    place, value = np.empty(first[-1], np.int32), np.empty(first[-1])
    for i in range(len(begin) - 1):
        for e in range(begin[i], begin[i + 1]):
            j, at = column[e], first[e]
            for k in range(T_begin[i], T_begin[i + 1]):
                low, high = K_begin[T_column[k]], K_begin[T_column[k] + 1]
                for m in range(T_begin[j], T_begin[j + 1]):
                    b = T_column[m]
                    found = low + np.searchsorted(K_column[low:high], b)
                    place[at] = found if found < high and K_column[found] == b else _LACKING
                    value[at] = T_value[k] * T_value[m]
                    at += 1
    return place, value, first


@kernel()
def _absent(
    begin: Int32Array, column: Int32Array, T_begin: Int32Array, T_column: Int32Array, place: Int32Array
) -> tuple[IntArray, IntArray]:
    """Rows and columns of the images whose place is _LACKING."""
    many = np.count_nonzero(place == _LACKING)
    row, beside = np.empty(many, np.int64), np.empty(many, np.int64)
    at = found = 0
    for i in range(len(begin) - 1):
        for e in range(begin[i], begin[i + 1]):
            j = column[e]
            for k in range(T_begin[i], T_begin[i + 1]):
                for m in range(T_begin[j], T_begin[j + 1]):
                    if place[at] == _LACKING:
                        row[found], beside[found] = T_column[k], T_column[m]
                        found += 1
                    at += 1
    return row, beside
