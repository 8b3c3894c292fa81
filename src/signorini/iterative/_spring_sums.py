# SPDX-License-Identifier: BSD-3-Clause
"""A compiled loop that adds the springs of pairs to a matrix in blocks."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array, RealArray
from signorini.compilation import kernel, part

_FREE_SUMS = {"contract", "reassoc", "nsz"}  # of the compiler: for sums that may be formed in any order


@part(fastmath=_FREE_SUMS)
def _add(pair: tuple[int, ...], block: tuple[int, ...], motion: Array, force: Array, made: RealArray) -> None:
    """Add ``motion' force`` to a block, (e, e); motion and force (d, e)."""
    for p in range(len(block)):
        for q in range(len(block)):
            total = motion[0, p] * force[0, q]
            for r in range(1, len(pair)):
                total += motion[r, p] * force[r, q]
            made[p, q] += total


@kernel(fastmath=_FREE_SUMS)
def add_springs(
    pair: tuple[int, ...],
    block: tuple[int, ...],
    motions: tuple[Int32Array, Int32Array, Array],
    springs: Array,
    matrix: tuple[Int32Array, Int32Array],
    lower: RealArray,
    diagonal: Array,
) -> None:
    """Add ``M' S M`` to a symmetric matrix whose pattern has room for it.

    Parameters
    ----------
    pair, block : d and e items
    motions : M of a pairs, indptr (a + 1,), indices and data (k, d, e) of its blocks
    springs : S, (a, d, d)
    matrix, lower, diagonal : indptr and indices, ascending in every row; blocks (e, e), which are added to
    """
    begin, nodes, data = motions
    indptr, indices = matrix
    force = np.empty((len(pair), len(block)))
    for i in range(len(begin) - 1):
        for t in range(begin[i], begin[i + 1]):
            for p in range(len(pair)):
                for q in range(len(block)):
                    total = 0.0
                    for r in range(len(pair)):
                        total += springs[i, p, r] * data[t, r, q]
                    force[p, q] = total
            column = nodes[t]
            for s in range(begin[i], begin[i + 1]):
                row = nodes[s]
                if column < row:
                    place = indptr[row] + np.searchsorted(indices[indptr[row] : indptr[row + 1]], column)
                    _add(pair, block, data[s], force, lower[place])
                elif column == row:
                    _add(pair, block, data[s], force, diagonal[row])
