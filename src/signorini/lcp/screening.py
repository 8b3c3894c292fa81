# SPDX-License-Identifier: BSD-3-Clause
"""The compiled loop of enumeration: which of all 2^n supports cannot hold a solution, with room for rounding."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part

TRUSTED_PIVOT, ZERO_PIVOT = 1e-9, 1e-13  # over the first pivot: relied on above, 0 below
INCONSISTENCY = 1e-6  # of the largest unknown: what may remain of q where the block is singular


@kernel(brief=True)
def eliminate_pivoting(block: Array, size: int, order: IntArray) -> int:
    """Gauss elimination of ``block[:size, :size + 1]`` with complete pivoting; returns the rank.

    The rank counts the pivots above ``ZERO_PIVOT`` times the first. The last column is the right-hand side; ``order``
    receives the unknown of every column.
    """
    for j in range(size):
        order[j] = j
    first = 0.0
    for step in range(size):
        row, column, largest = step, step, 0.0
        for i in range(step, size):
            for j in range(step, size):
                if abs(block[i, j]) > largest:
                    row, column, largest = i, j, abs(block[i, j])
        if step == 0:
            first = largest
        if largest <= ZERO_PIVOT * first:
            return step
        if row != step:
            for j in range(step, size + 1):
                block[step, j], block[row, j] = block[row, j], block[step, j]
        if column != step:
            for i in range(size):
                block[i, step], block[i, column] = block[i, column], block[i, step]
            order[step], order[column] = order[column], order[step]
        for i in range(step + 1, size):
            factor = block[i, step] / block[step, step]
            if factor != 0.0:
                for j in range(step + 1, size + 1):
                    block[i, j] -= factor * block[step, j]
    return size


@kernel(brief=True)
def substitute_back(block: Array, size: int, rank: int) -> float:
    """Solve for the first ``rank`` unknowns after elimination; returns the largest of them with the others 0, or 1.

    Row k then reads ``x_k = block[k, size] - sum_j block[k, j] x_j`` over the free unknowns ``rank <= j < size``.
    """
    scale = 1.0
    for column in range(rank, size + 1):
        for k in range(rank - 1, -1, -1):
            x = block[k, column]
            for j in range(k + 1, rank):
                x -= block[k, j] * block[j, column]
            block[k, column] = x / block[k, k]
            if column == size:
                scale = max(scale, abs(block[k, size]))
    return scale


@part()
def lack_of(A: Array, q: Array, support: IntArray, size: int, tolerance: float, block: Array, order: IntArray) -> float:
    """What a solution with its positive components exactly on ``support[:size]`` lacks; 0 where there may be one.

    In parts of its largest entry, or of 1 where that is more. A block is refused where q is far from its range, or
    where a z or w that its null space leaves alone is negative, each by more than the rounding of so conditioned a
    block; a block that is barely regular is never refused.

    Parameters
    ----------
    A, q, tolerance : see `screen`
    support, size : indices of the positive components, the first ``size`` of an array
    block, order : (n, n + 1) and (n,) to work in
    """
    for i in range(size):
        for j in range(size):
            block[i, j] = A[support[i], support[j]]
        block[i, size] = -q[support[i]]
    rank = eliminate_pivoting(block, size, order)
    condition = abs(block[0, 0] / block[rank - 1, rank - 1]) if rank > 0 else 1.0
    if condition * TRUSTED_PIVOT >= 1.0:
        return 0.0
    scale = substitute_back(block, size, rank)
    left = 0.0
    for i in range(rank, size):
        left = max(left, abs(block[i, size]))
    if left > INCONSISTENCY * scale:
        return left / scale
    room, lack = (tolerance + 1e-14 * size * condition) * scale, 0.0
    for k in range(rank):
        moved = 0.0
        for free in range(rank, size):
            moved = max(moved, abs(block[k, free]))
        if moved <= TRUSTED_PIVOT and block[k, size] < -room:
            lack = max(lack, -block[k, size])
    if lack > 0.0:
        return lack / scale
    for i in range(len(q)):
        w, sum_of_row, moved = q[i], 1.0, 0.0
        for k in range(rank):
            entry = A[i, support[order[k]]]
            w += entry * block[k, size]
            sum_of_row += abs(entry)
        for free in range(rank, size):
            slope = A[i, support[order[free]]]
            for k in range(rank):
                slope -= A[i, support[order[k]]] * block[k, free]
            moved = max(moved, abs(slope))
        if moved <= TRUSTED_PIVOT and w < -room * sum_of_row:
            lack = max(lack, -w)
    return lack / scale


@part()
def _list_bits(mask: int, n: int, support: IntArray) -> int:
    """List which of the first n bits of a mask are set; gives how many are."""
    size = 0
    for i in range(n):
        if (mask >> i) & 1:
            support[size] = i
            size += 1
    return size


@kernel(brief=True, nogil=True)
def screen(A: Array, q: Array, tolerance: float, lack: Array) -> None:
    """Write into ``lack[mask]`` what a solution with its positive components exactly on the bits of the mask lacks.

    Parameters
    ----------
    A, q : balanced data of n rows, entries near 1
    tolerance : values below it, relative to the largest, may be 0
    lack : (2^n,) dimensionless, 0 where there may be one
    """
    n = len(q)
    block, support, order = np.empty((n, n + 1)), np.empty(n, np.int64), np.empty(n, np.int64)
    for mask in range(1 << n):
        size = _list_bits(mask, n, support)
        lack[mask] = lack_of(A, q, support, size, tolerance, block, order)
