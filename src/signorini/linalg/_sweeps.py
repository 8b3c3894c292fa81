# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over symmetric matrices in blocks, each of which reads the lower half once; and over prolongations.

Row i has the blocks ``lower[indptr[i]:indptr[i + 1]]``, (d, d) each, in the columns ``indices[...]`` before i, and
``diagonal[i]``. What a row has beyond its diagonal is what later rows have before theirs, transposed. A tuple of d
items tells the compiler how long the inner loops are; the blocks of nodes in space, d = 3, are written out, so that
sums stay in registers. Sums have the precision of what is summed: they begin with their first term and not with a
zero, which would be of double precision.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Int32Array, RealArray
from signorini.compilation import kernel, part

_FREE_SUMS = {"contract", "reassoc", "nsz"}  # of the compiler: for sums that may be formed in any order


@part(fastmath=_FREE_SUMS)
def _taken(
    block: tuple[int, ...],
    indptr: Int32Array,
    indices: Int32Array,
    lower: RealArray,
    i: int,
    x: RealArray,
    left: RealArray,
) -> None:
    """Take from left, (d,), what row i has before its diagonal, times x."""
    d = len(block)
    if d == 3:
        one, two, three = left[0], left[1], left[2]
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            u, v, w = x[j, 0], x[j, 1], x[j, 2]
            one -= lower[k, 0, 0] * u + lower[k, 0, 1] * v + lower[k, 0, 2] * w
            two -= lower[k, 1, 0] * u + lower[k, 1, 1] * v + lower[k, 1, 2] * w
            three -= lower[k, 2, 0] * u + lower[k, 2, 1] * v + lower[k, 2, 2] * w
        left[0], left[1], left[2] = one, two, three
    else:
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            for p in range(d):
                total = lower[k, p, 0] * x[j, 0]
                for q in range(1, d):
                    total += lower[k, p, q] * x[j, q]
                left[p] -= total


@part(fastmath=_FREE_SUMS)
def _given(
    block: tuple[int, ...],
    indptr: Int32Array,
    indices: Int32Array,
    lower: RealArray,
    i: int,
    x: RealArray,
    rest: RealArray,
) -> None:
    """Take from rest, (m, d), what the rows before i have in the column of i, times x[i]."""
    d = len(block)
    if d == 3:
        u, v, w = x[i, 0], x[i, 1], x[i, 2]
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            rest[j, 0] -= lower[k, 0, 0] * u + lower[k, 1, 0] * v + lower[k, 2, 0] * w
            rest[j, 1] -= lower[k, 0, 1] * u + lower[k, 1, 1] * v + lower[k, 2, 1] * w
            rest[j, 2] -= lower[k, 0, 2] * u + lower[k, 1, 2] * v + lower[k, 2, 2] * w
    else:
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            for q in range(d):
                total = lower[k, 0, q] * x[i, 0]
                for p in range(1, d):
                    total += lower[k, p, q] * x[i, p]
                rest[j, q] -= total


@part(fastmath=_FREE_SUMS)
def _times(block: tuple[int, ...], matrix: RealArray, given: RealArray, result: RealArray) -> None:
    """Put a block times (d,) into result, (d,)."""
    for p in range(len(block)):
        total = matrix[p, 0] * given[0]
        for q in range(1, len(block)):
            total += matrix[p, q] * given[q]
        result[p] = total


@kernel(fastmath=_FREE_SUMS)
def product(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, lower: RealArray, diagonal: RealArray, x: RealArray
) -> RealArray:
    """``A x``, (m, d).

    Parameters
    ----------
    block : d items
    indptr, indices, lower, diagonal : A
    x : (m, d)
    """
    rest = np.zeros_like(x)
    left = np.empty(len(block), x.dtype)
    for i in range(len(x)):
        for p in range(len(block)):
            left[p] = 0.0
        _taken(block, indptr, indices, lower, i, x, left)
        _given(block, indptr, indices, lower, i, x, rest)
        for p in range(len(block)):
            total = 0.0
            for q in range(len(block)):
                total += diagonal[i, p, q] * x[i, q]
            rest[i, p] += left[p] - total
    return -rest


@kernel(fastmath=_FREE_SUMS)
def sweep_from_zero(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, lower: RealArray, inverses: RealArray, b: RealArray
) -> tuple[RealArray, RealArray]:
    """A forward sweep of Gauss-Seidel from zero over ``A x = b``: x and the residual ``b - A x``, both (m, d).

    What is left before the diagonal is what is not solved for yet, so that the residual is made of the other half.

    Parameters
    ----------
    block : d items
    indptr, indices, lower : A
    inverses : (m, d, d) of the blocks on its diagonal
    b : (m, d)
    """
    x, residual = np.empty_like(b), np.zeros_like(b)
    left = np.empty(len(block), b.dtype)
    for i in range(len(b)):
        for p in range(len(block)):
            left[p] = b[i, p]
        _taken(block, indptr, indices, lower, i, x, left)
        _times(block, inverses[i], left, x[i])
        _given(block, indptr, indices, lower, i, x, residual)
    return x, residual


@kernel(fastmath=_FREE_SUMS)
def sweep_back(
    block: tuple[int, ...],
    indptr: Int32Array,
    indices: Int32Array,
    lower: RealArray,
    inverses: RealArray,
    b: RealArray,
    x: RealArray,
) -> None:
    """A backward sweep over ``A x = b`` in place.

    Parameters
    ----------
    block, indptr, indices, lower, inverses, b : see `sweep_from_zero`
    x : (m, d)
    """
    rest = b.copy()
    left = np.empty(len(block), b.dtype)
    for i in range(len(b) - 1, -1, -1):
        for p in range(len(block)):
            left[p] = rest[i, p]
        _taken(block, indptr, indices, lower, i, x, left)
        _times(block, inverses[i], left, x[i])
        _given(block, indptr, indices, lower, i, x, rest)


@kernel(fastmath=_FREE_SUMS)
def prolong(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, data: RealArray, coarse: RealArray, x: RealArray
) -> None:
    """Add ``P coarse`` to x, (m, d).

    Parameters
    ----------
    block : d items
    indptr, indices, data : P, in blocks (d, e)
    coarse : (k, e)
    """
    for i in range(len(x)):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            for p in range(len(block)):
                total = data[k, p, 0] * coarse[j, 0]
                for q in range(1, coarse.shape[1]):
                    total += data[k, p, q] * coarse[j, q]
                x[i, p] += total


@kernel(fastmath=_FREE_SUMS)
def restrict(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, data: RealArray, fine: RealArray, coarse: RealArray
) -> None:
    """Add ``P' fine`` to coarse, (k, e).

    Parameters
    ----------
    block, indptr, indices, data : see `prolong`
    fine : (m, d)
    """
    for i in range(len(fine)):
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            for q in range(coarse.shape[1]):
                total = data[k, 0, q] * fine[i, 0]
                for p in range(1, len(block)):
                    total += data[k, p, q] * fine[i, p]
                coarse[j, q] += total
