# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops that gather the lower half of a symmetric matrix in blocks from its rows, whose order is free."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel


@kernel()
def count_before(
    indptr: IntArray, indices: IntArray, node: Int32Array, order: IntArray, begin: IntArray, ends: Int32Array
) -> None:
    """Put the number of blocks before the diagonal in row i of blocks into ``ends[i + 1]``.

    Parameters
    ----------
    indptr, indices : of the matrix, (z, z)
    node : (z,) row of blocks of every unknown
    order : (z,) unknowns by their place
    begin : (m + 1,) where those of a row of blocks begin in that
    ends : (m + 1,) overwritten
    """
    seen = np.full(len(begin) - 1, -1, np.int32)
    for i in range(len(begin) - 1):
        number = 0
        for s in range(begin[i], begin[i + 1]):
            for k in range(indptr[order[s]], indptr[order[s] + 1]):
                j = node[indices[k]]
                if j < i and seen[j] != i:
                    seen[j] = i
                    number += 1
        ends[i + 1] = number


@kernel()
def gather(
    matrix: tuple[IntArray, IntArray, Array],
    places: tuple[Int32Array, Int32Array, IntArray, IntArray],
    ends: Int32Array,
    columns: Int32Array,
    lower: Array,
    diagonal: Array,
) -> None:
    """Put the entries into blocks.

    Parameters
    ----------
    matrix : indptr, indices and data
    places : node and place in it of every unknown; order, begin as of `count_before`
    ends : (m + 1,) where rows of blocks begin and end
    columns, lower, diagonal : overwritten; the columns ascend in every row
    """
    indptr, indices, data = matrix
    node, axis, order, begin = places
    slot = np.full(len(begin) - 1, -1, np.int32)
    for i in range(len(begin) - 1):
        end = ends[i]
        for s in range(begin[i], begin[i + 1]):
            for k in range(indptr[order[s]], indptr[order[s] + 1]):
                j = node[indices[k]]
                if j < i and slot[j] < ends[i]:
                    place = end
                    while place > ends[i] and columns[place - 1] > j:
                        columns[place] = columns[place - 1]
                        place -= 1
                    columns[place] = j
                    slot[j] = end
                    end += 1
        for place in range(ends[i], end):
            slot[columns[place]] = place
        for s in range(begin[i], begin[i + 1]):
            p = axis[order[s]]
            for k in range(indptr[order[s]], indptr[order[s] + 1]):
                j = node[indices[k]]
                if j < i:
                    lower[slot[j], p, axis[indices[k]]] += data[k]
                elif j == i:
                    diagonal[i, p, axis[indices[k]]] += data[k]
