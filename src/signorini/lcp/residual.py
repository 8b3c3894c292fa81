# SPDX-License-Identifier: BSD-3-Clause
"""How wrong a candidate solution of a linear complementarity problem is.

What a residual is stands here and nowhere else, so that solvers, tests and users mean the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array
from signorini.errors import InputError

Matrix: TypeAlias = Array | sp.csr_array | LinearOperator

NOISE_FLOOR = 1e-5
LARGEST_GROWTH = 1e4


@dataclass(frozen=True, kw_only=True)
class Residual:
    """Violations of ``0 <= z``, ``0 <= w`` and ``z_i w_i = 0``, each dimensionless, 0 where satisfied."""

    primal: float
    dual: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The number that a tolerance is compared with; infinite where an entry is not a number."""
        numbers = np.array([self.primal, self.dual, self.complementarity])
        return float(numbers.max()) if np.isfinite(numbers).all() else np.inf


def natural_residual(M: Matrix, q: Array, z: Array, *, rows: Array | None = None) -> Residual:
    """Evaluate ``min(z, M z + q)`` on the problem as posed, never on a scaled copy.

    With ``w = M z + q``, every w_i is divided by ``s_i = |q_i| + sum_j |M_ij z_j|``, the size of the terms that cancel
    in it, and every z_j by ``1 / max_i(|M_ij| / s_i)``, the value at which it alone would make up such a sum: the
    result does not change when rows, columns or units do. Where all terms of a row are rounding noise (an open contact:
    ``0 = 2 mu 0 - 0``), s_i would be noise too; it is never less than ``1e-5 rows_i max_k(s_k / rows_k)``. Where z is
    enormous, rounding in M z would balance any q, also in a problem without solution; s_i is never more than
    ``1e4 rows_i max_k(|q_k| / rows_k)``.

    Parameters
    ----------
    M : (n, n) array, sparse array or linear operator
    q : (n,) array, in the units of w
    z : (n,) array, the candidate
    rows : (n,) the sizes of the rows, ``balance(M)[0]`` where None

    Raises
    ------
    InputError
        If the shapes do not fit, with the shapes found.

    Notes
    -----
    An operator does not show its entries; there s_i is ``|q_i| + max|M z|`` and z_j is divided by ``max|z|``.

    References
    ----------
    Cottle, Pang, Stone (1992), The Linear Complementarity Problem, section 1.4 (the min map).

    Examples
    --------
    >>> M, q = np.array([[2.0, 1.0], [0.0, 2.0]]), np.array([-1.0, -2.0])
    >>> natural_residual(M, q, np.array([0.0, 1.0])).worst
    0.0
    >>> natural_residual(M, q, np.zeros(2)).dual
    1.0
    """
    if M.shape != (len(q), len(q)) or z.shape != q.shape:
        raise InputError(f"M {M.shape}, q {q.shape} and z {z.shape} do not fit: expected (n, n), (n,), (n,)")

    unit, w = relative_sizes(M, q, z, balance(M)[0] if rows is None else rows)
    share = unit * z
    return Residual(
        primal=_largest(-share),
        dual=_largest(-w),
        complementarity=_largest(np.minimum(share, w)),
    )


def relative_sizes(M: Matrix, q: Array, z: Array, rows: Array) -> tuple[Array, Array]:
    """(unit, w): what z is multiplied by in ``natural_residual``, and w divided by its sizes."""
    with np.errstate(over="ignore", invalid="ignore"):
        product = M @ z
        size = np.abs(q) + (np.abs(product).max() if isinstance(M, LinearOperator) else abs(M) @ np.abs(z))
        data = float((np.abs(q) / rows).max(initial=0.0))
        size = np.minimum(size / rows, LARGEST_GROWTH * data if data > 0 else np.inf)
        size = _or_one(rows * np.maximum(size, NOISE_FLOOR * size.max(initial=0.0)))
        w = (product + q) / size
        unit = 1.0 / _or_one(np.abs(z).max(initial=0.0, keepdims=True)) * np.ones(len(z))
        if not isinstance(M, LinearOperator):
            column = _largest_in_columns(M, 1.0 / size)
            unit = np.where(column > 0, column, unit)
    return unit, w


def balance(M: Matrix, *, sweeps: int = 6) -> tuple[Array, Array]:
    """Sizes (rows, columns) such that ``M_ij columns_j / rows_i`` has rows and columns of comparable sums (Sinkhorn).

    The rows follow a rescaling of the rows and, for all but nearly empty matrices, ignore one of the columns; the
    columns likewise. An operator and an empty row or column have size 1.

    Examples
    --------
    >>> M = np.array([[2.0, 1.0], [0.0, 2.0]])
    >>> sizes = balance(M * np.array([[1.0], [1e6]]))[0] / balance(M)[0]
    >>> print(sizes / sizes[0])
    [1.e+00 1.e+06]
    """
    rows, columns = np.ones(M.shape[0]), np.ones(M.shape[0])
    if isinstance(M, LinearOperator):
        return rows, columns
    size: Any = abs(M)
    for _ in range(sweeps):
        rows = _or_one(size @ columns)
        columns = 1.0 / _or_one(size.T @ (1.0 / rows))
    return rows, columns


def _largest_in_columns(M: Array | sp.csr_array, weights: Array) -> Array:
    """``max_i |M_ij| weights_i`` for every column j."""
    if not isinstance(M, np.ndarray):
        largest = np.zeros(M.shape[1])
        np.maximum.at(largest, M.indices, np.abs(M.data) * np.repeat(weights, np.diff(M.indptr)))
        return largest
    return np.asarray((np.abs(M) * weights[:, None]).max(axis=0), dtype=float)


def _largest(violation: Array) -> float:
    return 0.0 + float(violation.max(initial=0.0))


def _or_one(size: Array) -> Array:
    """Sizes to divide by: where nothing is there, nothing can be violated."""
    return np.where(size > 0, size, 1.0)
