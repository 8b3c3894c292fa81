# SPDX-License-Identifier: BSD-3-Clause
"""A compiled loop that adds the springs of pairs to a matrix in blocks."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array, RealArray
from signorini.compilation import kernel, part


@part()
def _add(motion: Array, force: Array, block: RealArray) -> None:
    """Add ``motion' force`` to a block, (e, e); motion and force (d, e)."""
    for p in range(block.shape[0]):
        for q in range(block.shape[1]):
            for r in range(len(force)):
                block[p, q] += motion[r, p] * force[r, q]


@kernel()
def add_springs(
    motions: tuple[Int32Array, Int32Array, Array],
    springs: Array,
    matrix: tuple[Int32Array, Int32Array],
    lower: RealArray,
    diagonal: Array,
) -> None:
    """Add ``M' S M`` to a symmetric matrix whose pattern has room for it.

    Parameters
    ----------
    motions : M of a pairs, indptr (a + 1,), indices and data (k, d, e) of its blocks
    springs : S, (a, d, d)
    matrix, lower, diagonal : indptr and indices, ascending in every row; blocks (e, e), which are added to
    """
    begin, nodes, data = motions
    indptr, indices = matrix
    d, e = data.shape[1], data.shape[2]
    force = np.empty((d, e))
    for i in range(len(begin) - 1):
        for t in range(begin[i], begin[i + 1]):
            for p in range(d):
                for q in range(e):
                    total = 0.0
                    for r in range(d):
                        total += springs[i, p, r] * data[t, r, q]
                    force[p, q] = total
            for s in range(begin[i], begin[i + 1]):
                row, column = nodes[s], nodes[t]
                if column > row:
                    continue
                if column < row:
                    place = indptr[row] + np.searchsorted(indices[indptr[row] : indptr[row + 1]], column)
                    _add(data[s], force, lower[place])
                else:
                    _add(data[s], force, diagonal[row])
