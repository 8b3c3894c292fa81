# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over tiles of a front that threads share; what is left of it and its children has own arrays."""

from __future__ import annotations

from signorini.arrays import Array, Int32Array
from signorini.compilation import kernel, part
from signorini.linalg._blas import SECOND_TRANSPOSED, Scratch, StoredMatrix, gemm, syrk
from signorini.linalg._fronts import Tree, add_condensed, sizes
from signorini.linalg._strips import eliminate, eliminate_beside


@kernel(nogil=True)
def gather_matrix(tree: Tree, t: int, columns: tuple[int, int], below: Int32Array) -> None:
    """Overwrite columns of front t by those of K, on and below the diagonal.

    Parameters
    ----------
    tree, t : the front
    columns : the first, and how many
    below : the unknowns below the front, ascending
    """
    (factor, _, diagonal), (order, place) = tree.made, tree.elimination
    indptr, indices, data = tree.K
    a, k, r = sizes(tree.fronts, t)
    begin, ld = tree.fronts.panel[t], k + r
    for j in range(columns[0], columns[0] + columns[1]):
        column = factor[begin + j * ld : begin + (j + 1) * ld]
        column[:] = 0.0
        for p in range(indptr[order[a + j]], indptr[order[a + j] + 1]):
            i = place[indices[p]]
            if i >= a + k:
                column[k + _first_from(below, i)] += data[p]
            elif i >= a + j:
                column[i - a] += data[p]
        diagonal[a + j] = column[j]


@part()
def _first_from(ascending: Int32Array, value: int) -> int:
    """Place of the first number that is not below a value."""
    low, high = 0, len(ascending)
    while low < high:
        middle = (low + high) >> 1
        if ascending[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@kernel(nogil=True)
def add_child(
    left: Array,
    target: Int32Array,
    runs: Int32Array,
    columns: tuple[int, int],
    rows: tuple[int, int],
    into: Array,
    stride: int,
    shift: int,
) -> None:
    """Add what is left of a child, the lower triangle of a matrix by columns, to a tile of its parent, run by run.

    Parameters
    ----------
    left, target : of the child, and the rows of the parent that its own are, ascending
    runs : where rows that follow each other in the parent begin, and their number
    columns, rows : first ones of the tile in the parent, and how many
    into, stride, shift : added to; the number of row i in column j lies at ``(j - shift) stride + i - shift``
    """
    size = len(target)
    low, high = _first_from(target, rows[0]), _first_from(target, rows[0] + rows[1])
    for c in range(_first_from(target, columns[0]), _first_from(target, columns[0] + columns[1])):
        begin = max(c, low)
        column = (target[c] - shift) * stride - shift
        run = _first_from(runs, begin + 1) - 1
        while begin < high:
            end = min(high, runs[run + 1])
            at = column + target[begin]
            found, sums = left[c * size + begin : c * size + end], into[at : at + end - begin]
            for i in range(len(found)):
                sums[i] += found[i]
            begin = end
            run += 1


@kernel(nogil=True)
def eliminate_tile(columns: tuple[int, int], rows: tuple[int, int], front: StoredMatrix, s: Scratch) -> int:
    """Eliminate columns of a front from a tile of its rows, left to right; give 0, or the 1-based column that failed.

    The tile on the diagonal is factorised; it has to be before the others.

    Parameters
    ----------
    columns, rows : first ones of the tile, and how many
    front : its columns
    s : of the thread
    """
    (first, width), (begin, height) = columns, rows
    own = StoredMatrix(front.begin + 8 * (begin + first * front.stride), front.stride)
    pivot = StoredMatrix(front.begin + 8 * first * (front.stride + 1), front.stride)
    if first > 0:
        done = StoredMatrix(front.begin + 8 * begin, front.stride)
        beside = StoredMatrix(front.begin + 8 * first, front.stride)
        gemm(SECOND_TRANSPOSED, height, width, first, done, beside, s.one, own, s)
    if begin == first:
        return eliminate(width, pivot, s)
    eliminate_beside(height, width, pivot, own, s)
    return 0


@kernel(nogil=True)
def leave_tile(
    columns: tuple[int, int], rows: tuple[int, int], k: int, front: StoredMatrix, left: StoredMatrix, s: Scratch
) -> None:
    """Take from a tile of what is left of a front what its own k columns take.

    Parameters
    ----------
    columns, rows : first ones of the tile in the front, and how many
    k, front : the columns of the front, eliminated
    left : (r, r)
    s : of the thread
    """
    (first, width), (begin, height) = columns, rows
    beside = StoredMatrix(front.begin + 8 * first, front.stride)
    tile = StoredMatrix(left.begin + 8 * ((first - k) * left.stride + begin - k), left.stride)
    if begin == first:
        syrk(width, k, beside, s.one, tile, s)
    else:
        own = StoredMatrix(front.begin + 8 * begin, front.stride)
        gemm(SECOND_TRANSPOSED, height, width, k, own, beside, s.one, tile, s)


@kernel(nogil=True)
def add_root(left: Array, target: Int32Array, condensed: Array) -> None:
    """Add what is left of a front without a parent to the condensed matrix.

    Parameters
    ----------
    left : the lower triangle of a matrix by columns
    target : row of every row of it in the condensed matrix, whose upper triangle is added to
    """
    add_condensed(left, target, len(target), condensed)
