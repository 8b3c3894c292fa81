# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops of the condensation: of matrices between what is kept."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel


@kernel()
def block_on(
    begin: Int32Array, column: Int32Array, value: Array, dofs: IntArray, place: IntArray
) -> tuple[Array, Int32Array, Int32Array]:
    """Entries, columns and row ends of the block of a matrix on some unknowns.

    Parameters
    ----------
    begin, column, value : of the matrix by rows
    dofs : (m,) the unknowns
    place : where every unknown of the matrix is among them; -1: it is not
    """
    indptr = np.zeros(len(dofs) + 1, np.int32)
    for i in range(len(dofs)):
        indptr[i + 1] = indptr[i]
        for e in range(begin[dofs[i]], begin[dofs[i] + 1]):
            indptr[i + 1] += place[column[e]] >= 0
    data, indices, at = np.empty(indptr[-1]), np.empty(indptr[-1], np.int32), 0
    for i in range(len(dofs)):
        for e in range(begin[dofs[i]], begin[dofs[i] + 1]):
            if place[column[e]] >= 0:
                data[at], indices[at] = value[e], place[column[e]]
                at += 1
    return data, indices, indptr


@kernel()
def felt_stiffness(
    B_begin: Int32Array,
    B_column: Int32Array,
    B_value: Array,
    K_begin: Int32Array,
    K_column: Int32Array,
    K_value: Array,
    count: int,
) -> tuple[Array, Array]:
    """Diagonal of ``B K B^T``, (count,), and of ``B diag(K)^-1 B^T``, where the diagonal is not 0.

    Parameters
    ----------
    B_begin, B_column, B_value, K_begin, K_column, K_value : both matrices by rows
    count : rows of B that are asked for, the first ones
    """
    felt, gives, weight = np.zeros(count), np.zeros(count), np.zeros(len(K_begin) - 1)
    for i in range(count):
        own = range(B_begin[i], B_begin[i + 1])
        for e in own:
            weight[B_column[e]] += B_value[e]
        for e in own:
            p = B_column[e]
            for k in range(K_begin[p], K_begin[p + 1]):
                felt[i] += B_value[e] * K_value[k] * weight[K_column[k]]
                if K_column[k] == p and K_value[k] > 0.0:
                    gives[i] += B_value[e] * B_value[e] / K_value[k]
        for e in own:
            weight[B_column[e]] = 0.0
    return felt, gives
