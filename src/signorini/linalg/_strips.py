# SPDX-License-Identifier: BSD-3-Clause
"""Triangles of large dense matrices a few rows or columns at a time, callable from compiled loops.

What is taken from a strip before is a product. BLAS takes two to four times as long for a triangle as for a product of
as many operations, so that it is given small ones alone.
"""

from __future__ import annotations

from signorini.compilation import part
from signorini.linalg._blas import (
    AS_STORED,
    SECOND_TRANSPOSED,
    Scratch,
    StoredMatrix,
    block_at,
    gemm,
    potrf,
    trsm,
    trsm_of,
)

_STRIP = 32  # rows or columns: half as many cost products more than triangles gain, twice as many do not gain as much
_ROWS, _BLOCK = 64, 256  # of a strip along the columns of what is solved for, and of strips for one large product


@part()
def eliminate(k: int, A: StoredMatrix, s: Scratch) -> int:
    """Overwrite the lower triangle of A, (k, k), by its Cholesky factor; 0, or the 1-based column of a pivot <= 0.

    Parameters
    ----------
    k, A : the matrix and its size
    s : of the caller
    """
    for first in range(0, k, _STRIP):
        width = min(_STRIP, k - first)
        own, behind = block_at(A, first, first), first + width
        if first > 0:
            done = block_at(A, first, 0)
            gemm(SECOND_TRANSPOSED, k - first, width, first, done, done, s.one, own, s)
        failed = potrf(width, own, s)
        if failed != 0:
            return first + failed
        if k > behind:
            trsm(s.right, s.transposed, k - behind, width, own, block_at(A, behind, first), s)
    return 0


@part()
def eliminate_beside(m: int, k: int, L: StoredMatrix, A: StoredMatrix, s: Scratch) -> None:
    """Overwrite A, (m, k), by ``A L^-T``, L lower triangular.

    Parameters
    ----------
    m, k, L, A : sizes and matrices
    s : of the caller
    """
    for first in range(0, k, _STRIP):
        width, own = min(_STRIP, k - first), block_at(A, 0, first)
        if first > 0:
            gemm(SECOND_TRANSPOSED, m, width, first, A, block_at(L, first, 0), s.one, own, s)
        trsm(s.right, s.transposed, m, width, block_at(L, first, first), own, s)


@part()
def solve_unit_lower(m: int, n: int, L: StoredMatrix, B: StoredMatrix, s: Scratch) -> None:
    """Overwrite B, (m, n), by ``L^-1 B``, L lower triangular with ones on its diagonal, which it does not hold.

    Parameters
    ----------
    m, n, L, B : sizes and matrices
    s : of the caller
    """
    for block in range(0, m, _BLOCK):
        end = min(block + _BLOCK, m)
        if block > 0:
            gemm(AS_STORED, end - block, n, block, block_at(L, block, 0), B, s.one, block_at(B, block, 0), s)
        for first in range(block, end, _ROWS):
            width, own = min(_ROWS, end - first), block_at(B, first, 0)
            if first > block:
                left, known = block_at(L, first, block), block_at(B, block, 0)
                gemm(AS_STORED, width, n, first - block, left, known, s.one, own, s)
            trsm_of(s.left, s.left, s.plain, s.upper, width, n, block_at(L, first, first), own, s)


@part()
def divide_by_lower(m: int, k: int, L: StoredMatrix, A: StoredMatrix, s: Scratch) -> None:
    """Overwrite A, (m, k), by ``A L^-1``, L lower triangular.

    Parameters
    ----------
    m, k, L, A : sizes and matrices
    s : of the caller
    """
    for block in range((k - 1) // _BLOCK * _BLOCK, -1, -_BLOCK):
        end = min(block + _BLOCK, k)
        if end < k:
            known, below = block_at(A, 0, end), block_at(L, end, block)
            gemm(AS_STORED, m, end - block, k - end, known, below, s.one, block_at(A, 0, block), s)
        for first in range(block + (end - block - 1) // _STRIP * _STRIP, block - 1, -_STRIP):
            behind, own = min(first + _STRIP, end), block_at(A, 0, first)
            width = behind - first
            if behind < end:
                known, below = block_at(A, 0, behind), block_at(L, behind, first)
                gemm(AS_STORED, m, width, end - behind, known, below, s.one, own, s)
            trsm(s.right, s.plain, m, width, block_at(L, first, first), own, s)


@part()
def solve_upper(m: int, n: int, U: StoredMatrix, B: StoredMatrix, s: Scratch) -> None:
    """Overwrite B, (m, n), by ``U^-1 B``, U upper triangular.

    Parameters
    ----------
    m, n, U, B : sizes and matrices
    s : of the caller
    """
    for block in range((m - 1) // _BLOCK * _BLOCK, -1, -_BLOCK):
        end = min(block + _BLOCK, m)
        if end < m:
            right, known = block_at(U, block, end), block_at(B, end, 0)
            gemm(AS_STORED, end - block, n, m - end, right, known, s.one, block_at(B, block, 0), s)
        for first in range(block + (end - block - 1) // _ROWS * _ROWS, block - 1, -_ROWS):
            behind, own = min(first + _ROWS, end), block_at(B, first, 0)
            width = behind - first
            if behind < end:
                right, known = block_at(U, first, behind), block_at(B, behind, 0)
                gemm(AS_STORED, width, n, end - behind, right, known, s.one, own, s)
            trsm_of(s.left, s.upper, s.plain, s.plain, width, n, block_at(U, first, first), own, s)
