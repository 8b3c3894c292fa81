# SPDX-License-Identifier: BSD-3-Clause
"""Compiled solves with a factorisation by fronts: one loop over the fronts each."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.compilation import kernel, part
from signorini.linalg._blas import AS_STORED, FIRST_TRANSPOSED, Scratch, StoredMatrix, gemm, trsm
from signorini.linalg._fronts import list_below, sizes
from signorini.linalg.plan import Fronts


@part()
def _any(y: Array, start: int, end: int) -> bool:
    """Whether any row of y has an entry other than zero there."""
    for c in range(len(y)):
        for u in range(start, end):
            if y[c, u] != 0.0:
                return True
    return False


@kernel(nogil=True)
def forward(fronts: Fronts, factor: Array, y: Array, work: Array, s: Scratch) -> None:
    """Overwrite the inside of y, (k, n) with one load per row, by ``L_ii^-1 y``; the interface gathers what is left.

    Fronts that neither a load nor anything eliminated before reaches are passed over: most loads act on a surface.

    Parameters
    ----------
    fronts, factor : as factorised
    y : overwritten
    work : k numbers for every unknown below the largest front
    s : of BLAS
    """
    columns, n = y.shape
    rows = np.empty(len(work) // max(1, columns), np.int32)
    room = int(np.int64(work.ctypes.data))  # signed as other addresses are: a loop is compiled once for all
    for t in range(len(fronts.parent)):
        a, k, r = sizes(fronts, t)
        if not _any(y, a, a + k):
            continue
        top = factor.ctypes.data + 8 * fronts.panel[t]
        own, below = StoredMatrix(top, k + r), StoredMatrix(top + 8 * k, k + r)
        x, gathered = StoredMatrix(y.ctypes.data + 8 * a, n), StoredMatrix(room, r)
        trsm(s.left, s.plain, k, columns, own, x, s)
        if r == 0:
            continue
        gemm(AS_STORED, r, columns, k, below, x, s.zero, gathered, s)
        list_below(fronts, t, rows)
        for c in range(columns):
            for i in range(r):
                y[c, rows[i]] += work[c * r + i]


@kernel(nogil=True)
def backward(fronts: Fronts, begin: int, end: int, factor: Array, y: Array, work: Array, s: Scratch) -> None:
    """Overwrite the inside of y, (k, n) with one load per row, by ``L_ii^-T (y_i - L_ci^T y_c)``.

    Parameters
    ----------
    begin, end : of some fronts alone, after all that receive what is left of one of them
    fronts, factor, y, work, s : see `forward`
    """
    columns, n = y.shape
    if columns == 0:  # nor is there room to list rows in
        return
    rows = np.empty(len(work) // max(1, columns), np.int32)
    room = int(np.int64(work.ctypes.data))  # signed as other addresses are: a loop is compiled once for all
    for t in range(end - 1, begin - 1, -1):
        a, k, r = sizes(fronts, t)
        top = factor.ctypes.data + 8 * fronts.panel[t]
        own, below = StoredMatrix(top, k + r), StoredMatrix(top + 8 * k, k + r)
        x, gathered = StoredMatrix(y.ctypes.data + 8 * a, n), StoredMatrix(room, r)
        if r > 0:
            list_below(fronts, t, rows)
            for c in range(columns):
                for i in range(r):
                    work[c * r + i] = y[c, rows[i]]
            gemm(FIRST_TRANSPOSED, k, columns, r, below, gathered, s.one, x, s)
        trsm(s.left, s.transposed, k, columns, own, x, s)


@kernel()
def pivots(fronts: Fronts, factor: Array) -> Array:
    """Give the squared diagonal of the factor: the pivots in their order of elimination."""
    pivot = np.empty(fronts.unknown[fronts.first[-1]])
    for t in range(len(fronts.parent)):
        a, k, r = sizes(fronts, t)
        for j in range(k):
            root = factor[fronts.panel[t] + j * (k + r + 1)]
            pivot[a + j] = root * root
    return pivot
