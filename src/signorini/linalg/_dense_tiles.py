# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over tiles of large dense matrices, by columns, that threads share."""

from __future__ import annotations

from signorini.arrays import Array
from signorini.compilation import kernel
from signorini.linalg._blas import AS_STORED, FIRST_TRANSPOSED, Scratch, StoredMatrix, gemm, getrf, laswp, potri
from signorini.linalg._strips import divide_by_lower, solve_lower, solve_upper

_TILE = 64  # rows and columns that are mirrored at a time, so that they stay in the cache


@kernel(nogil=True)
def invert_alone(first: int, end: int, matrix: StoredMatrix, s: Scratch) -> None:
    """Overwrite a triangle of a factor by the lower triangle of ``(L L')^-1``.

    Parameters
    ----------
    first, end : rows and columns, the first and the one behind the last
    matrix : L
    s : of the thread
    """
    potri(end - first, StoredMatrix(matrix.begin + 8 * first * (matrix.stride + 1), matrix.stride), s)


@kernel(nogil=True)
def divide_rows(first: int, middle: int, rows: tuple[int, int], matrix: StoredMatrix, s: Scratch) -> None:
    """Overwrite rows below a triangle of a factor by themselves times its inverse.

    Parameters
    ----------
    first, middle : columns of the triangle, the first and the one behind the last
    rows : the first, and how many
    matrix : L
    s : of the thread
    """
    corner = StoredMatrix(matrix.begin + 8 * first * (matrix.stride + 1), matrix.stride)
    own = StoredMatrix(matrix.begin + 8 * (rows[0] + first * matrix.stride), matrix.stride)
    divide_by_lower(rows[1], middle - first, corner, own, s)


@kernel(nogil=True)
def mirror(matrix: Array, first: int, end: int) -> None:
    """Overwrite what lies above the diagonal by rows below it, in tiles that fit the cache.

    Parameters
    ----------
    matrix : (n, n)
    first, end : rows, the first and the one behind the last
    """
    for low in range(0, end, _TILE):
        for begin in range(max(first, low), end, _TILE):
            for i in range(begin, min(begin + _TILE, end)):
                for j in range(low, min(low + _TILE, i)):
                    matrix[j, i] = matrix[i, j]


@kernel(nogil=True)
def multiply_columns(
    middle: int, end: int, columns: tuple[int, int], matrix: StoredMatrix, across: StoredMatrix, s: Scratch
) -> None:
    """Columns of ``- S Y``, S the square behind a middle, on both sides of its diagonal, Y what is left of it.

    Parameters
    ----------
    middle, end : of the square
    columns : of Y, the first, and how many
    matrix : that has both
    across : (end - middle, columns) overwritten
    s : of the thread
    """
    square = StoredMatrix(matrix.begin + 8 * middle * (matrix.stride + 1), matrix.stride)
    own = StoredMatrix(matrix.begin + 8 * (middle + columns[0] * matrix.stride), matrix.stride)
    gemm(AS_STORED, end - middle, columns[1], end - middle, square, own, s.zero, across, s)


@kernel(nogil=True)
def add_across(
    middle: int, end: int, columns: tuple[int, int], matrix: StoredMatrix, across: StoredMatrix, s: Scratch
) -> None:
    """Take ``Y' X`` from columns before a middle, from the diagonal down.

    Parameters
    ----------
    middle, end, columns, matrix : as of `multiply_columns`
    across : (end - middle, columns) X
    s : of the thread
    """
    own = StoredMatrix(matrix.begin + 8 * (middle + columns[0] * matrix.stride), matrix.stride)
    corner = StoredMatrix(matrix.begin + 8 * columns[0] * (matrix.stride + 1), matrix.stride)
    gemm(FIRST_TRANSPOSED, middle - columns[0], columns[1], end - middle, own, across, s.one, corner, s)


@kernel(nogil=True)
def factorise_panel(first: int, width: int, n: int, matrix: StoredMatrix, pivots: int, s: Scratch) -> int:
    """Factorise some columns from the diagonal down; 0, or the 1-based one of them whose pivot is 0.

    Parameters
    ----------
    first, width, n : the columns, and how many there are in all
    matrix : (n, n)
    pivots : address of those of these columns, see `getrf`
    s : of the thread
    """
    panel = StoredMatrix(matrix.begin + 8 * first * (matrix.stride + 1), matrix.stride)
    return getrf(n - first, width, panel, pivots, s)


@kernel(nogil=True)
def swap_rows(first: int, width: int, columns: tuple[int, int], matrix: StoredMatrix, pivots: int, s: Scratch) -> None:
    """Swap rows of other columns as those of a panel were.

    Parameters
    ----------
    first, width : of the panel
    columns : the first of the others, and how many
    matrix, pivots, s : as of `factorise_panel`
    """
    laswp(
        columns[1],
        StoredMatrix(matrix.begin + 8 * (columns[0] * matrix.stride + first), matrix.stride),
        width,
        pivots,
        s,
    )


@kernel(nogil=True)
def eliminate_panel(
    first: int, width: int, columns: tuple[int, int], n: int, matrix: StoredMatrix, pivots: int, s: Scratch
) -> None:
    """Take from columns behind a panel what it takes.

    Parameters
    ----------
    first, width, columns, n, matrix, pivots, s : as of `swap_rows` and `factorise_panel`
    """
    swap_rows(first, width, columns, matrix, pivots, s)
    panel = StoredMatrix(matrix.begin + 8 * first * (matrix.stride + 1), matrix.stride)
    across = StoredMatrix(matrix.begin + 8 * (columns[0] * matrix.stride + first), matrix.stride)
    solve_lower(width, columns[1], panel, s.upper, across, s)
    left = n - first - width
    if left > 0:
        below = StoredMatrix(panel.begin + 8 * width, matrix.stride)
        rest = StoredMatrix(across.begin + 8 * width, matrix.stride)
        gemm(AS_STORED, left, columns[1], width, below, across, s.one, rest, s)


@kernel(nogil=True)
def invert_factored_columns(first: int, width: int, n: int, lu: StoredMatrix, x: StoredMatrix, s: Scratch) -> None:
    """Overwrite columns of the unit matrix by those of ``(L U)^-1``.

    Parameters
    ----------
    first, width, n : the columns, and how many there are in all
    lu : both factors
    x : (n, width)
    s : of the thread
    """
    own = StoredMatrix(lu.begin + 8 * first * (lu.stride + 1), lu.stride)
    solve_lower(n - first, width, own, s.upper, StoredMatrix(x.begin + 8 * first, x.stride), s)
    solve_upper(n, width, lu, x, s)
