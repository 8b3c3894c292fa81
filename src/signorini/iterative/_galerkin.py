# SPDX-License-Identifier: BSD-3-Clause
"""A compiled loop that makes the coarse matrix of a symmetric one of which half is kept."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray, RealArray
from signorini.compilation import kernel
from signorini.linalg._block_rows import scatter_row


@kernel(fastmath={"contract"})
def restrict_half(
    block: tuple[int, ...],
    coarse_block: tuple[int, ...],
    wide: tuple[int, ...],
    A: tuple[Int32Array, Int32Array, RealArray, Array],
    P: tuple[Int32Array, Int32Array, Array],
    pattern: tuple[Int32Array, Int32Array],
    made: Array,
) -> None:
    """Add ``P' Y``, ``Y = (L + D / 2) P``, to a matrix whose pattern has room for it; with its transpose: ``P' A P``.

    Parameters
    ----------
    block, coarse_block, wide : d, e and lanes(e) items
    A : indptr, indices, L before and D on the diagonal, in blocks (d, d)
    P : indptr, indices and data, in blocks (d, e)
    pattern : indptr and indices, ascending in every row, of k blocks
    made : (k e, lanes(e)) rows of the blocks; added to
    """
    d, e = len(block), len(coarse_block)
    indptr, indices, lower, diagonal = A
    begin, place, data = P
    ends, columns = pattern
    size = len(ends) - 1
    slot, seen = np.full(size, -1, np.int64), np.empty(size, np.int64)
    shares = np.zeros((size, d, len(wide)))  # of row i of Y, in the order in which its blocks are met
    rows = shares.reshape(size * d, len(wide))
    into, at = np.empty(len(place), np.int64), np.empty(size, np.int64)
    half, own = np.empty((d, d)), np.empty(d)
    for i in range(len(indptr) - 1):
        count = 0
        for k in range(indptr[i], indptr[i + 1] + 1):
            inner = k < indptr[i + 1]
            node = indices[k] if inner else i
            factor = lower[k] if inner else half
            if not inner:
                half[:] = 0.5 * diagonal[i]
            first, last = begin[node], begin[node + 1]
            for t in range(first, last):
                j = place[t]
                if slot[j] < 0:
                    slot[j], seen[count] = count, j
                    count += 1
                into[t] = slot[j] * d
            for p in range(d):
                scatter_row(block, coarse_block, data, factor[p], into, first, last, rows)
                for t in range(first, last):
                    into[t] += 1
        for t in range(begin[i], begin[i + 1]):
            low = ends[place[t]]
            known = columns[low : ends[place[t] + 1]]
            for s in range(count):
                at[s] = e * (low + np.searchsorted(known, seen[s]))
            for q in range(e):
                for p in range(d):
                    own[p] = data[t, p, q]
                scatter_row(block, wide, shares, own, at, 0, count, made)
                for s in range(count):
                    at[s] += 1
        for s in range(count):
            slot[seen[s]] = -1
            shares[s] = 0.0


@kernel()
def mirrored(pattern: tuple[Int32Array, Int32Array]) -> IntArray:
    """(k,) Where the block of row j and column i is, for that of row i and column j, of a symmetric pattern.

    Parameters
    ----------
    pattern : indptr and indices, ascending in every row
    """
    ends, columns = pattern
    found, next_one = np.empty(len(columns), np.int64), ends.copy()
    for i in range(len(ends) - 1):
        for k in range(ends[i], ends[i + 1]):
            found[k] = next_one[columns[k]]
            next_one[columns[k]] += 1
    return found
