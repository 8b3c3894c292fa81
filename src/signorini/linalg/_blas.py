# SPDX-License-Identifier: BSD-3-Clause
"""Routines of BLAS and LAPACK for factorisations, callable from compiled loops.

SciPy exports its BLAS to Cython; the same addresses are given to Numba as external symbols, which, unlike function
pointers, its cache on disk can hold. Every argument is an address: of numbers that the caller keeps alive in arrays
of its own. Matrices are stored by columns.
"""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import llvmlite.binding  # type: ignore[import-untyped]
import numpy as np
from numba import types
from numba.extending import get_cython_function_address, models, register_model
from numpy.typing import NDArray

from signorini.arrays import Array, Int32Array
from signorini.compilation import part


class _Routine(types.ExternalFunction):
    """A routine of BLAS or LAPACK; loops that are interpreted call it through ctypes."""

    def __init__(self, module: str, name: str, arguments: int) -> None:
        symbol, address = f"signorini_{name}", get_cython_function_address(f"scipy.linalg.{module}", name)
        llvmlite.binding.add_symbol(symbol, address)
        super().__init__(symbol, types.void(*[types.intp] * arguments))
        self._call = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * arguments)(address)

    def __call__(self, *addresses: int) -> None:  # type: ignore[override]
        self._call(*map(int, addresses))


register_model(_Routine)(models.OpaqueModel)  # as Numba's own external functions


_dpotrf = _Routine("cython_lapack", "dpotrf", 5)
_dtrsm = _Routine("cython_blas", "dtrsm", 11)
_dsyrk = _Routine("cython_blas", "dsyrk", 10)
_dgemm = _Routine("cython_blas", "dgemm", 13)
_dger = _Routine("cython_blas", "dger", 9)
_dpotri = _Routine("cython_lapack", "dpotri", 5)
_dgetrf = _Routine("cython_lapack", "dgetrf", 6)
_dlaswp = _Routine("cython_lapack", "dlaswp", 7)


class Scratch(NamedTuple):
    """What BLAS reads by address, kept alive by whoever calls a compiled loop.

    Words are addresses too, so that a loop is compiled once for all of them.

    Attributes
    ----------
    size : (6,) sizes and strides of a call
    sizes : address of them
    left, right, transposed, plain : addresses of the letters for the side of a triangle, and for op
    upper : and for a triangle above the diagonal, which is that for one with ones on its diagonal too
    one, minus_one, zero : addresses of factors
    kept : the factors
    letters : those letters
    """

    size: Int32Array
    sizes: int
    left: int
    right: int
    transposed: int
    plain: int
    upper: int
    one: int
    minus_one: int
    zero: int
    kept: Array
    letters: NDArray[np.uint8]


_FACTORS, _LETTERS = np.array([1.0, -1.0, 0.0]), b"LRTNU"
_FRESH = np.frombuffer(_FACTORS.tobytes() + bytes(24) + _LETTERS + bytes(3))  # factors, sizes, letters


def scratch() -> Scratch:
    """Give fresh memory for the arguments of BLAS; one per thread."""
    memory = _FRESH.copy()
    number = memory.ctypes.data  # which takes longer to ask for than all else
    kept, size, letters = memory[:3], memory[3:6].view(np.int32), memory[6:].view(np.uint8)[:5]
    left, right, transposed, plain, upper = number + 48, number + 49, number + 50, number + 51, number + 52
    one, minus_one, zero = number, number + 8, number + 16
    return Scratch(size, number + 24, left, right, transposed, plain, upper, one, minus_one, zero, kept, letters)


class StoredMatrix(NamedTuple):
    """A matrix by columns, where it lies.

    Attributes
    ----------
    begin : address of its first number
    stride : numbers from one column to the next
    """

    begin: int
    stride: int


@part()
def block_at(A: StoredMatrix, row: int, column: int) -> StoredMatrix:
    """What of a matrix is from a row and a column on.

    Parameters
    ----------
    A, row, column : the matrix, and where the block begins
    """
    return StoredMatrix(A.begin + 8 * (row + column * A.stride), A.stride)


@part()
def potrf(k: int, A: StoredMatrix, s: Scratch) -> int:
    """Overwrite the lower triangle of A, (k, k), by its Cholesky factor; 0, or the 1-based column of a pivot <= 0.

    Parameters
    ----------
    k, A : the matrix and its size
    s : of the caller
    """
    s.size[0], s.size[1] = k, A.stride
    z = s.sizes
    _dpotrf(s.left, z, A.begin, z + 4, z + 8)
    return int(s.size[2])


@part()
def potri(k: int, L: StoredMatrix, s: Scratch) -> None:
    """Overwrite L, (k, k), by the lower triangle of ``(L L^T)^-1``.

    Parameters
    ----------
    k, L : the matrix and its size
    s : of the caller
    """
    s.size[0], s.size[1] = k, L.stride
    z = s.sizes
    _dpotri(s.left, z, L.begin, z + 4, z + 8)


@part()
def trsm(side: int, op: int, m: int, n: int, L: StoredMatrix, B: StoredMatrix, s: Scratch) -> None:
    """Overwrite B, (m, n), by ``op(L)^-1 B``, or ``B op(L)^-1`` from the right; L is lower triangular.

    Parameters
    ----------
    side, op : of L, words of `s`
    m, n, L, B : sizes and matrices
    s : of the caller
    """
    trsm_of(side, s.left, op, s.plain, m, n, L, B, s)


@part()
def trsm_of(
    side: int, triangle: int, op: int, diagonal: int, m: int, n: int, T: StoredMatrix, B: StoredMatrix, s: Scratch
) -> None:
    """Overwrite B, (m, n), by ``op(T)^-1 B``, or ``B op(T)^-1`` from the right, of any triangle.

    Parameters
    ----------
    side, op : of T, words of `s`
    triangle, diagonal : ``left`` of `s` for a lower one, or ``upper``; ``upper`` for ones on the diagonal, or ``plain``
    m, n, T, B : sizes and matrices
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2], s.size[3] = m, n, T.stride, B.stride
    z = s.sizes
    _dtrsm(side, triangle, op, diagonal, z, z + 4, s.one, T.begin, z + 8, B.begin, z + 12)


@part()
def getrf(m: int, n: int, A: StoredMatrix, pivots: int, s: Scratch) -> int:
    """Overwrite A, (m, n), by its factors L U with rows swapped; 0, or the 1-based column of a pivot that is 0.

    Parameters
    ----------
    m, n, A : sizes and the matrix
    pivots : address of (n,) whole numbers: the 1-based row that was swapped with each
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2] = m, n, A.stride
    z = s.sizes
    _dgetrf(z, z + 4, A.begin, z + 8, pivots, z + 12)
    return int(s.size[3])


@part()
def laswp(n: int, A: StoredMatrix, count: int, pivots: int, s: Scratch) -> None:
    """Swap rows of n columns as `getrf` did, one after the other.

    Parameters
    ----------
    n, A : columns, and the matrix
    count, pivots : how many rows, and the address of what they are swapped with
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2], s.size[3], s.size[4] = n, A.stride, 1, count, 1
    z = s.sizes
    _dlaswp(z, A.begin, z + 4, z + 8, z + 12, pivots, z + 16)


@part()
def syrk(n: int, k: int, A: StoredMatrix, share: int, C: StoredMatrix, s: Scratch) -> None:
    """Overwrite the lower triangle of C, (n, n), by ``share C - A A^T``.

    Parameters
    ----------
    n, k, A, C : sizes and matrices, A (n, k)
    share : of C that counts, a factor of `s`
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2], s.size[3] = n, k, A.stride, C.stride
    z = s.sizes
    _dsyrk(s.left, s.plain, z, z + 4, s.minus_one, A.begin, z + 8, share, C.begin, z + 12)


AS_STORED, FIRST_TRANSPOSED, SECOND_TRANSPOSED = range(3)
"""Forms of products: A B, A^T B, A B^T."""


@part()
def gemm(
    form: int, m: int, n: int, k: int, A: StoredMatrix, B: StoredMatrix, share: int, C: StoredMatrix, s: Scratch
) -> None:
    """Overwrite C, (m, n), by ``share C - A B``, one of both transposed.

    Parameters
    ----------
    form : which one: `AS_STORED`, `FIRST_TRANSPOSED`, `SECOND_TRANSPOSED`
    m, n, k, A, B, C : sizes and matrices, A (m, k), B (k, n) once transposed
    share : of C that counts, a factor of `s`
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2] = m, n, k
    s.size[3], s.size[4], s.size[5] = A.stride, B.stride, C.stride
    first = s.transposed if form == FIRST_TRANSPOSED else s.plain
    second = s.transposed if form == SECOND_TRANSPOSED else s.plain
    z = s.sizes
    _dgemm(first, second, z, z + 4, z + 8, s.minus_one, A.begin, z + 12, B.begin, z + 16, share, C.begin, z + 20)


@part()
def ger(m: int, n: int, x: int, y: int, A: StoredMatrix, s: Scratch) -> None:
    """Overwrite A, (m, n), by ``A - x y^T``: half the time of a product of matrices.

    Parameters
    ----------
    m, n, A : sizes and the matrix
    x, y : addresses of (m,) and (n,) numbers
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2], s.size[3] = m, n, 1, A.stride
    z = s.sizes
    _dger(z, z + 4, s.minus_one, x, z + 8, y, z + 8, A.begin, z + 12)
