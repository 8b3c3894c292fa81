# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over tiles of large dense matrices, by columns, that threads share."""

from __future__ import annotations

from signorini.arrays import Array
from signorini.compilation import kernel
from signorini.linalg._blas import (
    AS_STORED,
    FIRST_TRANSPOSED,
    Scratch,
    StoredMatrix,
    block_at,
    gemm,
    ger,
    getrf,
    laswp,
    potri,
)
from signorini.linalg._strips import divide_by_lower, solve_unit_lower, solve_upper

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
    potri(end - first, block_at(matrix, first, first), s)


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
    divide_by_lower(rows[1], middle - first, block_at(matrix, first, first), block_at(matrix, rows[0], first), s)


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
def invert_columns(
    middle: int, end: int, columns: tuple[int, int], matrix: StoredMatrix, across: StoredMatrix, s: Scratch
) -> None:
    """Columns ``X = - S Y`` of an inverse, below a middle, and before it ``- Y' X``, added from the diagonal down.

    Parameters
    ----------
    middle, end : of the inverse S behind the middle, on both sides of its diagonal
    columns : before the middle, the first, and how many
    matrix : has S, below the middle Y, and before it what is added to
    across : (end - middle, columns) takes X: other columns still need Y
    s : of the thread
    """
    (first, width), size = columns, end - middle
    own = block_at(matrix, middle, first)
    gemm(AS_STORED, size, width, size, block_at(matrix, middle, middle), own, s.zero, across, s)
    gemm(FIRST_TRANSPOSED, middle - first, width, size, own, across, s.one, block_at(matrix, first, first), s)


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
    return getrf(n - first, width, block_at(matrix, first, first), pivots, s)


@kernel(nogil=True)
def swap_rows(first: int, width: int, columns: tuple[int, int], matrix: StoredMatrix, pivots: int, s: Scratch) -> None:
    """Swap rows of other columns as those of a panel were.

    Parameters
    ----------
    first, width : of the panel
    columns : the first of the others, and how many
    matrix, pivots, s : as of `factorise_panel`
    """
    laswp(columns[1], block_at(matrix, first, columns[0]), width, pivots, s)


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
    across, behind = block_at(matrix, first, columns[0]), first + width
    solve_unit_lower(width, columns[1], block_at(matrix, first, first), across, s)
    if behind < n:
        below, rest = block_at(matrix, behind, first), block_at(matrix, behind, columns[0])
        gemm(AS_STORED, n - behind, columns[1], width, below, across, s.one, rest, s)


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
    solve_unit_lower(n - first, width, block_at(lu, first, first), block_at(x, first, 0), s)
    solve_upper(n, width, lu, x, s)


@kernel(nogil=True)
def take_product(
    n: int, k: int, columns: tuple[int, int], left: StoredMatrix, right: StoredMatrix, matrix: StoredMatrix, s: Scratch
) -> None:
    """Overwrite columns of a matrix by themselves minus those of a product.

    Parameters
    ----------
    n, k : rows, and how many columns the left factor has
    columns : the first, and how many
    left, right : (n, k) and (k, ...)
    matrix : (n, ...)
    s : of the thread
    """
    some, own = block_at(right, 0, columns[0]), block_at(matrix, 0, columns[0])
    if k == 1:
        ger(n, columns[1], left.begin, some.begin, own, s)
    else:
        gemm(AS_STORED, n, columns[1], k, left, some, s.one, own, s)
