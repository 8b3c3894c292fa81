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

from signorini.arrays import Array

Inverse = Callable[[Array], Array]

SMALLEST_PIVOT = 1e-15


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
    rows = _largest(A, 1)
    if not (rows > 0).all():
        return None
    columns = _largest(_scaled(A, 1 / rows, np.ones(len(rows))), 0)
    if not (columns > 0).all() or not np.isfinite(rows).all():
        return None
    scaled = _scaled(A, 1 / rows, 1 / columns)
    inner = _sparse(scaled) if sp.issparse(scaled) else _dense(scaled)
    if inner is None:
        return None
    return lambda b: (inner((b.T / rows).T).T / columns).T


def _dense(A: Array) -> Inverse | None:
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
    largest = abs(A).max(axis=axis)
    return np.asarray(largest.toarray() if sp.issparse(largest) else largest, dtype=float).ravel()


def _scaled(A: Any, rows: Array, columns: Array) -> Any:
    if sp.issparse(A):
        return sp.diags_array(rows) @ A @ sp.diags_array(columns)
    return A * rows[:, None] * columns
