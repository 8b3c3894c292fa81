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
    gemm,
    potrf,
    trsm,
    trsm_of,
)

_STRIP = 32  # rows or columns: half as many cost products more than triangles gain, twice as many do not gain as much
_ROWS, _BLOCK = 64, 256  # of a strip along the columns of what is solved for, and of strips for one large product


@part()
def eliminate(k: int, m: int, A: StoredMatrix, s: Scratch) -> int:
    """Overwrite k columns, of m rows, by those of the Cholesky factor; 0, or the 1-based column of a pivot <= 0.

    A few columns at a time: their triangles are slow, what is taken from them before is a product, which is fast.

    Parameters
    ----------
    k, m, A : the columns, symmetric as far as the diagonal goes, the lower triangle
    s : of the caller
    """
    for first in range(0, k, _STRIP):
        width, behind = min(_STRIP, k - first), first + min(_STRIP, k - first)
        own = StoredMatrix(A.begin + 8 * first * (A.stride + 1), A.stride)
        if first > 0:
            done = StoredMatrix(A.begin + 8 * first, A.stride)
            gemm(SECOND_TRANSPOSED, m - first, width, first, done, done, s.one, own, s)
        failed = potrf(width, own, s)
        if failed != 0:
            return first + failed
        if m > behind:
            below = StoredMatrix(own.begin + 8 * width, A.stride)
            trsm(s.right, s.transposed, m - behind, width, own, below, s)
    return 0


@part()
def eliminate_beside(m: int, k: int, L: StoredMatrix, A: StoredMatrix, s: Scratch) -> None:
    """Overwrite A, (m, k), by ``A L^-T``, L lower triangular, a few columns at a time.

    Parameters
    ----------
    m, k, L, A : sizes and matrices
    s : of the caller
    """
    for first in range(0, k, _STRIP):
        width = min(_STRIP, k - first)
        own = StoredMatrix(A.begin + 8 * first * A.stride, A.stride)
        if first > 0:
            gemm(SECOND_TRANSPOSED, m, width, first, A, StoredMatrix(L.begin + 8 * first, L.stride), s.one, own, s)
        trsm(s.right, s.transposed, m, width, StoredMatrix(L.begin + 8 * first * (L.stride + 1), L.stride), own, s)


@part()
def solve_lower(m: int, n: int, L: StoredMatrix, diagonal: int, B: StoredMatrix, s: Scratch) -> None:
    """Overwrite B, (m, n), by ``L^-1 B``, L lower triangular: blocks of rows, and a few rows at a time in each.

    Parameters
    ----------
    m, n, L, B : sizes and matrices
    diagonal : of L, as of `trsm_of`
    s : of the caller
    """
    for block in range(0, m, _BLOCK):
        end = min(block + _BLOCK, m)
        if block > 0:
            left, own = StoredMatrix(L.begin + 8 * block, L.stride), StoredMatrix(B.begin + 8 * block, B.stride)
            gemm(AS_STORED, end - block, n, block, left, B, s.one, own, s)
        for first in range(block, end, _ROWS):
            width, corner = min(_ROWS, end - first), L.begin + 8 * first * (L.stride + 1)
            own = StoredMatrix(B.begin + 8 * first, B.stride)
            if first > block:
                left = StoredMatrix(L.begin + 8 * (first + block * L.stride), L.stride)
                known = StoredMatrix(B.begin + 8 * block, B.stride)
                gemm(AS_STORED, width, n, first - block, left, known, s.one, own, s)
            trsm_of(s.left, s.plain, diagonal, width, n, StoredMatrix(corner, L.stride), own, s)


@part()
def divide_by_lower(m: int, k: int, L: StoredMatrix, A: StoredMatrix, s: Scratch) -> None:
    """Overwrite A, (m, k), by ``A L^-1``, L lower triangular: blocks of columns, and a few columns at a time in each.

    Parameters
    ----------
    m, k, L, A : sizes and matrices
    s : of the caller
    """
    for block in range((k - 1) // _BLOCK * _BLOCK, -1, -_BLOCK):
        end = min(block + _BLOCK, k)
        if end < k:
            below = StoredMatrix(L.begin + 8 * (end + block * L.stride), L.stride)
            known = StoredMatrix(A.begin + 8 * end * A.stride, A.stride)
            own = StoredMatrix(A.begin + 8 * block * A.stride, A.stride)
            gemm(AS_STORED, m, end - block, k - end, known, below, s.one, own, s)
        for first in range(block + (end - block - 1) // _STRIP * _STRIP, block - 1, -_STRIP):
            behind, corner = min(first + _STRIP, end), L.begin + 8 * first * (L.stride + 1)
            width, own = behind - first, StoredMatrix(A.begin + 8 * first * A.stride, A.stride)
            if behind < end:
                below = StoredMatrix(corner + 8 * width, L.stride)
                known = StoredMatrix(A.begin + 8 * behind * A.stride, A.stride)
                gemm(AS_STORED, m, width, end - behind, known, below, s.one, own, s)
            trsm(s.right, s.plain, m, width, StoredMatrix(corner, L.stride), own, s)


@part()
def solve_upper(m: int, n: int, U: StoredMatrix, B: StoredMatrix, s: Scratch) -> None:
    """Overwrite B, (m, n), by ``U^-1 B``, U upper triangular: blocks of rows, and a few rows at a time in each.

    Parameters
    ----------
    m, n, U, B : sizes and matrices
    s : of the caller
    """
    for block in range((m - 1) // _BLOCK * _BLOCK, -1, -_BLOCK):
        end = min(block + _BLOCK, m)
        if end < m:
            right = StoredMatrix(U.begin + 8 * (block + end * U.stride), U.stride)
            known, own = StoredMatrix(B.begin + 8 * end, B.stride), StoredMatrix(B.begin + 8 * block, B.stride)
            gemm(AS_STORED, end - block, n, m - end, right, known, s.one, own, s)
        for first in range(block + (end - block - 1) // _ROWS * _ROWS, block - 1, -_ROWS):
            behind, corner = min(first + _ROWS, end), U.begin + 8 * first * (U.stride + 1)
            width, own = behind - first, StoredMatrix(B.begin + 8 * first, B.stride)
            if behind < end:
                right = StoredMatrix(corner + 8 * width * U.stride, U.stride)
                known = StoredMatrix(B.begin + 8 * behind, B.stride)
                gemm(AS_STORED, width, n, end - behind, right, known, s.one, own, s)
            trsm_of(s.upper, s.plain, s.plain, width, n, StoredMatrix(corner, U.stride), own, s)
