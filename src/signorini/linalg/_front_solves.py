# SPDX-License-Identifier: BSD-3-Clause
"""Compiled solves with a factorisation by fronts: one loop over the fronts each."""

from __future__ import annotations

import numpy as np
from numba import njit

from signorini.arrays import Array
from signorini.linalg._blas import AS_STORED, FIRST_TRANSPOSED, Scratch, StoredMatrix, gemm, trsm
from signorini.linalg._fronts import list_below
from signorini.linalg.plan import Fronts


@njit(cache=True)
def _any(y: Array, start: int, end: int) -> bool:
    """Whether any row of y has an entry other than zero there."""
    for c in range(len(y)):
        for u in range(start, end):
            if y[c, u] != 0.0:
                return True
    return False


@njit(cache=True)
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
    rows = np.empty(fronts.below.max() if len(fronts.below) else 0, np.int32)
    for t in range(len(fronts.parent)):
        a = fronts.unknown[fronts.first[t]]
        k = fronts.unknown[fronts.first[t + 1]] - a
        r = fronts.below[t]
        if not _any(y, a, a + k):
            continue
        top = factor.ctypes.data + 8 * fronts.panel[t]
        own, below = StoredMatrix(top, k + r), StoredMatrix(top + 8 * k, k + r)
        x, gathered = StoredMatrix(y.ctypes.data + 8 * a, n), StoredMatrix(work.ctypes.data, r)
        trsm(False, False, k, columns, own, x, s)
        if r == 0:
            continue
        gemm(AS_STORED, r, columns, k, below, x, False, gathered, s)
        list_below(fronts, t, rows)
        for c in range(columns):
            for i in range(r):
                y[c, rows[i]] += work[c * r + i]


@njit(cache=True)
def backward(fronts: Fronts, factor: Array, y: Array, work: Array, s: Scratch) -> None:
    """Overwrite the inside of y, (k, n) with one load per row, by ``L_ii^-T (y_i - L_ci^T y_c)``.

    Parameters
    ----------
    fronts, factor, y, work, s : see `forward`
    """
    columns, n = y.shape
    rows = np.empty(fronts.below.max() if len(fronts.below) else 0, np.int32)
    for t in range(len(fronts.parent) - 1, -1, -1):
        a = fronts.unknown[fronts.first[t]]
        k = fronts.unknown[fronts.first[t + 1]] - a
        r = fronts.below[t]
        top = factor.ctypes.data + 8 * fronts.panel[t]
        own, below = StoredMatrix(top, k + r), StoredMatrix(top + 8 * k, k + r)
        x, gathered = StoredMatrix(y.ctypes.data + 8 * a, n), StoredMatrix(work.ctypes.data, r)
        if r > 0:
            list_below(fronts, t, rows)
            for c in range(columns):
                for i in range(r):
                    work[c * r + i] = y[c, rows[i]]
            gemm(FIRST_TRANSPOSED, k, columns, r, below, gathered, True, x, s)
        trsm(False, True, k, columns, own, x, s)


@njit(cache=True)
def pivots(fronts: Fronts, factor: Array) -> Array:
    """Give the squared diagonal of the factor: the pivots in their order of elimination."""
    pivot = np.empty(fronts.unknown[fronts.first[-1]])
    for t in range(len(fronts.parent)):
        a = fronts.unknown[fronts.first[t]]
        k = fronts.unknown[fronts.first[t + 1]] - a
        for j in range(k):
            pivot[a + j] = factor[fronts.panel[t] + j * (k + fronts.below[t] + 1)] ** 2
    return pivot
