# SPDX-License-Identifier: BSD-3-Clause
"""Small dense systems by the routines of LAPACK themselves: what SciPy looks at before takes longer than they do.

Each gives the digits of SciPy's function of like name.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array


def solve_triangular(
    triangle: Array, load: Array, *, lower: bool = False, transposed: bool = False, unit: bool = False
) -> Array:
    """``T^-1 b``, or ``T^-T b``, (n, ...).

    Parameters
    ----------
    triangle : (n, n) T; what is on the other side of its diagonal is not looked at
    load : (n,) or (n, k) b
    lower : whether T is below the diagonal
    transposed : whether its transpose is asked
    unit : whether T has ones on its diagonal, which are not looked at either

    Raises
    ------
    LinAlgError
        If T is singular.

    Examples
    --------
    >>> solve_triangular(np.array([[2.0, 1.0], [0.0, 4.0]]), np.array([4.0, 8.0])).tolist()
    [1.0, 2.0]
    """
    if not load.size:
        return np.zeros(load.shape)
    if triangle.flags.f_contiguous:
        x, failed = lapack.dtrtrs(triangle, load, lower=lower, trans=transposed, unitdiag=unit)
    else:  # LAPACK reads columns
        x, failed = lapack.dtrtrs(triangle.T, load, lower=not lower, trans=not transposed, unitdiag=unit)
    if failed:
        raise np.linalg.LinAlgError(f"singular matrix: resolution failed at diagonal {failed - 1}")
    return np.asarray(x, dtype=np.float64)


def solve_cholesky(factor: Array, load: Array) -> Array:
    """``(L L^T)^-1 b``, (n, ...).

    Parameters
    ----------
    factor : (n, n) L, lower; what is above its diagonal is not looked at
    load : (n,) or (n, k) b

    Examples
    --------
    >>> solve_cholesky(np.array([[2.0]]), np.array([8.0])).tolist()
    [2.0]
    """
    if not load.size:
        return np.zeros(load.shape)
    x, _ = lapack.dpotrs(factor, load, lower=1)
    return np.asarray(x, dtype=np.float64)


def symmetric_eigen(matrix: Array) -> tuple[Array, Array]:
    """(n,) Eigenvalues, ascending, and (n, n) orthonormal eigenvectors of a symmetric matrix, (n, n).

    Raises
    ------
    LinAlgError
        If they are not found.

    Examples
    --------
    >>> symmetric_eigen(np.diag([3.0, 2.0]))[0].tolist()
    [2.0, 3.0]
    """
    if not len(matrix):
        return np.zeros(0), np.zeros((0, 0))
    work, whole, _ = lapack.dsyevr_lwork(len(matrix), lower=1)
    values, vectors, *_, failed = lapack.dsyevr(matrix, lower=1, lwork=int(work), liwork=whole)
    if failed:
        raise np.linalg.LinAlgError("eigenvalues were not found")
    return np.asarray(values, dtype=np.float64), np.asarray(vectors, dtype=np.float64)
