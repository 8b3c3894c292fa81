# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over symmetric matrices in blocks, each of which reads the lower half once; and over prolongations.

Row i has the blocks ``lower[indptr[i]:indptr[i + 1]]``, (d, d) each, in the columns ``indices[...]`` before i, and
``diagonal[i]``. What a row has beyond its diagonal is what later rows have before theirs, transposed. A tuple of d
items tells the compiler how large blocks are. Vectors are (m, d), those that a loop goes along in an order of its own
(m, lanes(d)), of which the first d columns count (`_block_rows`). Sums have the precision of what is summed.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Int32Array, RealArray
from signorini.compilation import kernel, part
from signorini.linalg._block_rows import gather_row, lanes, scatter_row

_FREE_SUMS = {"contract", "reassoc", "nsz"}  # of the compiler: for sums that may be formed in any order


def with_lanes(values: RealArray) -> RealArray:
    """(m, lanes(d)) Values (m, d) in rows that are as long as vector registers.

    Examples
    --------
    >>> with_lanes(np.array([[1.0, 2.0, 3.0]])).tolist()
    [[1.0, 2.0, 3.0, 0.0]]
    """
    m, d = values.shape
    made = np.zeros((m, lanes(d)), values.dtype)
    made[:, :d] = values
    return made


@part(fastmath=_FREE_SUMS)
def _solved(block: tuple[int, ...], inverse: RealArray, b: RealArray, sums: RealArray, x: RealArray) -> None:
    """Put ``inverse (b - sums)`` into x and its negative into sums, all (d,)."""
    for p in range(len(block)):
        sums[p] = b[p] - sums[p]
    for p in range(len(block)):
        total = inverse[p, 0] * sums[0]
        for q in range(1, len(block)):
            total += inverse[p, q] * sums[q]
        x[p] = total
    for p in range(len(block)):
        sums[p] = -x[p]


@kernel(fastmath=_FREE_SUMS)
def product(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, lower: RealArray, diagonal: RealArray, x: RealArray
) -> RealArray:
    """``A x``, (m, lanes(d)).

    Parameters
    ----------
    block : d items
    indptr, indices, lower, diagonal : A
    x : (m, lanes(d))
    """
    result = np.zeros_like(x)
    sums, own = np.empty(len(block), x.dtype), np.empty(len(block), x.dtype)
    for i in range(len(x)):
        gather_row(block, block, lower, x, indices, indptr[i], indptr[i + 1], sums)
        for p in range(len(block)):
            own[p] = x[i, p]
        scatter_row(block, block, lower, own, indices, indptr[i], indptr[i + 1], result)
        for p in range(len(block)):
            total = 0.0
            for q in range(len(block)):
                total += diagonal[i, p, q] * own[q]
            result[i, p] += sums[p] + total
    return result


@kernel(fastmath=_FREE_SUMS)
def sweep_from_zero(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, lower: RealArray, inverses: RealArray, b: RealArray
) -> tuple[RealArray, RealArray]:
    """A forward sweep of Gauss-Seidel from zero over ``A x = b``: x and the residual ``b - A x``, both (m, lanes(d)).

    What is left before the diagonal is what is not solved for yet, so that the residual is made of the other half.

    Parameters
    ----------
    block : d items
    indptr, indices, lower : A
    inverses : (m, d, d) of the blocks on its diagonal
    b : (m, lanes(d))
    """
    x, residual = np.zeros_like(b), np.zeros_like(b)
    sums = np.empty(len(block), b.dtype)
    for i in range(len(b)):
        gather_row(block, block, lower, x, indices, indptr[i], indptr[i + 1], sums)
        _solved(block, inverses[i], b[i], sums, x[i])
        scatter_row(block, block, lower, sums, indices, indptr[i], indptr[i + 1], residual)
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
    x : (m, lanes(d))
    """
    rest = b.copy()
    sums = np.empty(len(block), b.dtype)
    for i in range(len(b) - 1, -1, -1):
        gather_row(block, block, lower, x, indices, indptr[i], indptr[i + 1], sums)
        _solved(block, inverses[i], rest[i], sums, x[i])
        scatter_row(block, block, lower, sums, indices, indptr[i], indptr[i + 1], rest)


@kernel(fastmath=_FREE_SUMS)
def prolong(
    block: tuple[int, ...],
    coarse_block: tuple[int, ...],
    indptr: Int32Array,
    indices: Int32Array,
    data: RealArray,
    coarse: RealArray,
    x: RealArray,
) -> None:
    """Add ``P coarse`` to x, (m, lanes(d)).

    Parameters
    ----------
    block, coarse_block : d and e items
    indptr, indices, data : P, in blocks (d, e)
    coarse : (k, lanes(e))
    """
    sums = np.empty(len(block), x.dtype)
    for i in range(len(x)):
        gather_row(block, coarse_block, data, coarse, indices, indptr[i], indptr[i + 1], sums)
        for p in range(len(block)):
            x[i, p] += sums[p]


@kernel(fastmath=_FREE_SUMS)
def restrict(
    block: tuple[int, ...],
    coarse_block: tuple[int, ...],
    indptr: Int32Array,
    indices: Int32Array,
    data: RealArray,
    fine: RealArray,
    coarse: RealArray,
) -> None:
    """Add ``P' fine`` to coarse, (k, lanes(e)).

    Parameters
    ----------
    block, coarse_block, indptr, indices, data : see `prolong`
    fine : (m, lanes(d))
    """
    own = np.empty(len(block), fine.dtype)
    for i in range(len(fine)):
        for p in range(len(block)):
            own[p] = fine[i, p]
        scatter_row(block, coarse_block, data, own, indices, indptr[i], indptr[i + 1], coarse)
