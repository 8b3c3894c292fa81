# SPDX-License-Identifier: BSD-3-Clause
"""The four BLAS and LAPACK routines of a Cholesky factorisation, callable from compiled loops.

SciPy exports its BLAS to Cython; the same addresses are given to Numba as external symbols, which, unlike function
pointers, its cache on disk can hold. Every argument is an address: of numbers that the caller keeps alive in arrays
of its own. Matrices are stored by columns.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import llvmlite.binding  # type: ignore[import-untyped]
import numpy as np
from numba import njit, types
from numba.extending import get_cython_function_address
from numpy.typing import NDArray

from signorini.arrays import Array, Int32Array


def _external(module: str, name: str, arguments: int) -> Any:
    symbol = f"signorini_{name}"
    llvmlite.binding.add_symbol(symbol, get_cython_function_address(f"scipy.linalg.{module}", name))
    return types.ExternalFunction(symbol, types.void(*[types.intp] * arguments))


_dpotrf = _external("cython_lapack", "dpotrf", 5)
_dtrsm = _external("cython_blas", "dtrsm", 11)
_dsyrk = _external("cython_blas", "dsyrk", 10)
_dgemm = _external("cython_blas", "dgemm", 13)


class Scratch(NamedTuple):
    """Numbers that BLAS reads by address, kept alive by whoever calls a compiled loop."""

    size: Int32Array
    factor: Array
    letter: NDArray[np.uint8]


def scratch() -> Scratch:
    """Give fresh memory for the arguments of BLAS; one per thread."""
    return Scratch(np.zeros(6, np.int32), np.array([1.0, -1.0, 0.0]), np.frombuffer(b"LRTN", np.uint8).copy())


class StoredMatrix(NamedTuple):
    """A matrix by columns, where it lies.

    Attributes
    ----------
    begin : address of its first number
    stride : numbers from one column to the next
    """

    begin: int
    stride: int


@njit(cache=True)
def potrf(k: int, A: StoredMatrix, s: Scratch) -> int:
    """Overwrite the lower triangle of A, (k, k), by its Cholesky factor; 0, or the 1-based column of a pivot <= 0.

    Parameters
    ----------
    k, A : the matrix and its size
    s : of the caller
    """
    s.size[0], s.size[1] = k, A.stride
    z, c = s.size.ctypes.data, s.letter.ctypes.data
    _dpotrf(c, z, A.begin, z + 4, z + 8)
    return int(s.size[2])


@njit(cache=True)
def trsm(right: bool, transposed: bool, m: int, n: int, L: StoredMatrix, B: StoredMatrix, s: Scratch) -> None:
    """Overwrite B, (m, n), by ``op(L)^-1 B``, or ``B op(L)^-1`` from the right; L is lower triangular.

    Parameters
    ----------
    right, transposed : the side of L, and whether op transposes
    m, n, L, B : sizes and matrices
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2], s.size[3] = m, n, L.stride, B.stride
    z, c, f = s.size.ctypes.data, s.letter.ctypes.data, s.factor.ctypes.data
    op = c + (2 if transposed else 3)
    _dtrsm(c + (1 if right else 0), c, op, c + 3, z, z + 4, f, L.begin, z + 8, B.begin, z + 12)


@njit(cache=True)
def syrk(n: int, k: int, A: StoredMatrix, keep: bool, C: StoredMatrix, s: Scratch) -> None:
    """Overwrite the lower triangle of C, (n, n), by ``[C] - A A^T``.

    Parameters
    ----------
    n, k, A, C : sizes and matrices, A (n, k)
    keep : whether C counts
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2], s.size[3] = n, k, A.stride, C.stride
    z, c, f = s.size.ctypes.data, s.letter.ctypes.data, s.factor.ctypes.data
    _dsyrk(c, c + 3, z, z + 4, f + 8, A.begin, z + 8, f + (0 if keep else 16), C.begin, z + 12)


AS_STORED, FIRST_TRANSPOSED, SECOND_TRANSPOSED = range(3)
"""Forms of products: A B, A^T B, A B^T."""


@njit(cache=True)
def gemm(
    form: int, m: int, n: int, k: int, A: StoredMatrix, B: StoredMatrix, keep: bool, C: StoredMatrix, s: Scratch
) -> None:
    """Overwrite C, (m, n), by ``[C] - A B``, one of both transposed.

    Parameters
    ----------
    form : which one: `AS_STORED`, `FIRST_TRANSPOSED`, `SECOND_TRANSPOSED`
    m, n, k, A, B, C : sizes and matrices, A (m, k), B (k, n) once transposed
    keep : whether C counts
    s : of the caller
    """
    s.size[0], s.size[1], s.size[2] = m, n, k
    s.size[3], s.size[4], s.size[5] = A.stride, B.stride, C.stride
    z, c, f = s.size.ctypes.data, s.letter.ctypes.data, s.factor.ctypes.data
    _dgemm(
        c + (2 if form == FIRST_TRANSPOSED else 3), c + (2 if form == SECOND_TRANSPOSED else 3), z, z + 4, z + 8,
        f + 8, A.begin, z + 12, B.begin, z + 16,
        f + (0 if keep else 16), C.begin, z + 20,
    )  # fmt: skip
