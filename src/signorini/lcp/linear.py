# SPDX-License-Identifier: BSD-3-Clause
"""Linear systems of the methods: dense or sparse, scaled by rows and columns, a singular one answered by None."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from signorini.arrays import Array, IntArray

Inverse = Callable[[Array], Array]

SMALLEST_PIVOT = 1e-15  # of a matrix with largest entries near 1: below it rounding decides
LIGHT_ROWS_SIZE = 200  # unknowns from which looking for rows and columns of few entries pays


def scaled(M: Any, rows: Array, columns: Array) -> Any:
    """``diag(rows) M diag(columns)``, dense or CSR as M is."""
    if sp.issparse(M):
        return (sp.diags_array(rows) @ M @ sp.diags_array(columns)).tocsr()
    return M * rows[:, None] * columns


def with_diagonal(M: Any, diagonal: Array) -> Any:
    """``M + diag(diagonal)``, dense or sparse as M is."""
    return M + (sp.diags_array(diagonal) if sp.issparse(M) else np.diag(diagonal))


def factorised(A: Any) -> Inverse | None:
    """The map ``b -> x`` with ``A x = b``, b (n,) or (n, k); None where A is singular to working precision.

    Parameters
    ----------
    A : (n, n) dense or sparse array

    Examples
    --------
    >>> inverse = factorised(np.array([[2.0, 0.0], [0.0, 4e-9]]))
    >>> print(inverse(np.array([2.0, 4e-9])))
    [1. 1.]
    >>> factorised(np.ones((2, 2))) is None
    True
    """
    if isinstance(A, np.ndarray) and len(A) > LIGHT_ROWS_SIZE:
        i, j = _lone_entries(A)
        if len(i) > len(A) // 10:
            return _without(A, i, j)
        i, j, k = _light_rows(A)
        if len(i) > len(A) // 10:
            return _without_light(A, i, j, k)
    rows = _largest(A, 1)
    if not (rows > 0).all() or not np.isfinite(rows).all():
        return None
    if sp.issparse(A):
        balanced = sp.diags_array(1 / rows) @ A
    else:
        balanced = np.empty(A.shape, order="F")  # as LAPACK wants it
        np.divide(A, rows[:, None], out=balanced)
    columns = _largest(balanced, 0)
    if not (columns > 0).all():
        return None
    inner = _sparse(balanced @ sp.diags_array(1 / columns)) if sp.issparse(A) else _dense(balanced, columns)
    if inner is None:
        return None
    return lambda b: (inner((b.T / rows).T).T / columns).T


def _lone_entries(A: Array) -> tuple[IntArray, IntArray]:
    """(i, j) of columns with one nonzero, at most one of them a row: slip variables of contact problems are such."""
    present = A != 0
    j = np.flatnonzero(present.sum(axis=0) == 1)
    i, first = np.unique(present[:, j].argmax(axis=0), return_index=True)
    return i, j[first]


def _without(A: Array, i: IntArray, j: IntArray) -> Inverse | None:
    """Rows i determine the unknowns j, which no other row contains: they are put back after the rest is solved."""
    rest, others = np.delete(np.arange(len(A)), i), np.delete(np.arange(len(A)), j)
    inner = factorised(A[np.ix_(rest, others)])
    if inner is None:
        return None
    coupling, pivots = A[np.ix_(i, others)], A[i, j]

    def solve(b: Array) -> Array:
        x = np.zeros_like(b)
        x[others] = inner(b[rest])
        x[j] = ((b[i] - coupling @ x[others]).T / pivots).T
        return x

    return solve


def _light_rows(A: Array) -> tuple[IntArray, IntArray, IntArray]:
    """(i, j, k) of rows ``A_ij x_j + A_ik x_k = b_i`` with |A_ij| >= |A_ik|, no j in two of them or another's k."""
    i = np.flatnonzero(np.count_nonzero(A, axis=1) == 2)
    at = np.nonzero(A[i])[1].reshape(len(i), 2)
    first_larger = np.abs(A[i, at[:, 0]]) > np.abs(A[i, at[:, 1]])
    j, k = np.where(first_larger, at[:, 0], at[:, 1]), np.where(first_larger, at[:, 1], at[:, 0])
    uses = np.bincount(np.concatenate([j, k]), minlength=len(A))
    alone = (uses[j] == 1) & (uses[k] == 1)
    return i[alone], j[alone], k[alone]


def _without_light(A: Array, i: IntArray, j: IntArray, k: IntArray) -> Inverse | None:
    """The unknowns j are replaced by their k in all other rows."""
    rest, others = np.delete(np.arange(len(A)), i), np.delete(np.arange(len(A)), j)
    ratio, pivots, moved = A[i, k] / A[i, j], A[i, j], A[np.ix_(rest, j)]
    reduced = A[np.ix_(rest, others)]
    reduced[:, np.searchsorted(others, k)] -= moved * ratio
    inner = factorised(reduced)
    if inner is None:
        return None

    def solve(b: Array) -> Array:
        x = np.zeros_like(b)
        own = (b[i].T / pivots).T
        x[others] = inner(b[rest] - moved @ own)
        x[j] = own - (x[k].T * ratio).T
        return x

    return solve


def _dense(A: Array, columns: Array) -> Inverse | None:
    A /= columns
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", la.LinAlgWarning)  # a zero pivot is looked for below
        factors = la.lu_factor(A, overwrite_a=True, check_finite=False)
    if not np.abs(np.diag(factors[0])).min() > SMALLEST_PIVOT:
        return None
    return lambda b: np.asarray(la.lu_solve(factors, b, check_finite=False))


def _sparse(A: Any) -> Inverse | None:
    try:
        factors = spla.splu(A.tocsc())
    except RuntimeError:  # "Factor is exactly singular" has no class of its own
        return None
    if not np.abs(factors.U.diagonal()).min() > SMALLEST_PIVOT:
        return None
    return lambda b: np.asarray(factors.solve(b))


def _largest(A: Any, axis: int) -> Array:
    if isinstance(A, np.ndarray):
        return np.maximum(A.max(axis=axis), -A.min(axis=axis))
    return np.asarray(abs(A).max(axis=axis).toarray(), dtype=float).ravel()
