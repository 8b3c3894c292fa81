# SPDX-License-Identifier: BSD-3-Clause
"""The condensed tableau of the pivoting methods, edited in place, and the balanced problem that it is made of.

The basic variables are ``x_B = rhs - T x_N`` with n + 1 nonbasic ones in N. Variables are numbered: w_i is i, z_i is
n + i, the artificial theta is 2 n. At the start B = (w_1 .. w_n), ``T = (-M, -d)`` and ``rhs = q``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from scipy.linalg.blas import dgemm

from signorini.arrays import Array, IntArray
from signorini.lcp.delayed import DelayedTableau, Tolerances
from signorini.lcp.residual import LEAST_SIZE


@dataclass(frozen=True, kw_only=True)
class Equilibrated:
    """The LCP in the unknowns ``z / columns`` and ``rows * w``, which has the same solutions.

    Attributes
    ----------
    M : (n, n) array ``rows_i M_ij columns_j``
    q : (n,) array ``rows_i q_i * unit``
    rows, columns : (n,) positive powers of two
    unit : power of two that makes max|q| about 1; z of the scaled problem is multiplied by it
    """

    M: Array
    q: Array
    rows: Array
    columns: Array
    unit: float

    def back(self, z: Array) -> Array:
        """z in the units of the problem as posed."""
        return self.columns * z / self.unit


def equilibrate(M: Array, q: Array, row_sizes: Array, column_sizes: Array) -> Equilibrated:
    """Divide every row by its size and multiply every column by its, then all by one factor: largest entry about 1.

    By powers of two, exactly in floating point, and undone without loss.

    Parameters
    ----------
    M : (n, n) array
    q : (n,) array
    row_sizes, column_sizes : (n,) balanced sizes (``balance``), rounded here to powers of two

    Examples
    --------
    >>> scaled = equilibrate(np.diag([4e9, 2e-9]), np.array([1.0, 1.0]), np.array([4e9, 2e-9]), np.ones(2))
    >>> print(np.round(np.diag(scaled.M), 1))
    [0.9 1.1]
    """
    rows, columns = _power_of_two(1.0 / row_sizes), _power_of_two(column_sizes)
    scaled = M * rows[:, None]
    scaled *= columns
    factor = _to_one(max(float(scaled.max()), -float(scaled.min())))
    scaled *= factor
    rows = rows * factor
    q = rows * q
    unit = _to_one(float(np.abs(q).max()))
    return Equilibrated(M=scaled, q=q * unit, rows=rows, columns=columns, unit=unit)


def _power_of_two(values: Array) -> Array:
    return np.exp2(np.round(np.log2(values)))


def _to_one(size: float) -> float:
    """The power of two that brings a size near 1."""
    return 2.0 ** round(math.log2(1.0 / max(size, LEAST_SIZE))) if size > 0 else 1.0


MAX_DELAYED = 32
"""Pivots whose updates are applied together."""


class Tableau:
    """State of the pivoting; it belongs to one run of one method and is edited in place.

    Attributes
    ----------
    T : (n, n + 2) Fortran-ordered array, the last column is rhs
    basic : (n,) variable of every row
    nonbasic : (n + 1,) variable of every column
    """

    def __init__(self, M: Array, q: Array, d: Array) -> None:
        n = len(q)
        self.n, self.M, self.q, self.d = n, M, q, d
        self.T = np.empty((n, n + 2), order="F")
        np.negative(M, out=self.T[:, :n])
        self.T[:, n], self.T[:, n + 1] = -d, q
        self.basic: IntArray = np.arange(n)
        self.nonbasic: IntArray = np.arange(n, 2 * n + 1)
        self.column_of = np.arange(-n, n + 1)
        self.column_of[:n] = -1
        self.row_of = np.arange(2 * n + 1)
        self.row_of[n:] = -1
        self._U, self._V = np.empty((n, MAX_DELAYED), order="F"), np.empty((MAX_DELAYED, n + 2))
        self._rows: IntArray = np.empty(n, dtype=np.int64)

    @property
    def rhs(self) -> Array:
        """Values of the basic variables, a view."""
        return self.T[:, -1]

    def column(self, variable: int) -> Array:
        """Column of a nonbasic variable, a view: the basic ones fall at these rates as it grows."""
        return self.T[:, self.column_of[variable]]

    def walk(
        self, entering: int, limit: int, tolerances: Tolerances, *, theta_stays: bool
    ) -> tuple[int, int, int, int]:
        """Pivot along the complementary path.

        Parameters
        ----------
        entering : the variable that enters first
        limit, tolerances, theta_stays : see ``lcp.walk.walk``
        """
        # Numba takes longer to import than most problems to solve
        from signorini.compilation import interpreted
        from signorini.lcp.walk import least_lexicographic, walk

        arrays = DelayedTableau(
            self.T, self._U, self._V, self.basic, self.nonbasic, self.column_of, self.row_of, self._rows
        )
        # a single row is in the order of Fortran and of C, another type of array for which Numba would compile anew
        with interpreted((walk, least_lexicographic) if self.n == 1 else ()):
            reason, entering, row, pivots = walk(arrays, entering, limit, theta_stays, tolerances)
        if pivots:
            dgemm(-1.0, self._U[:, :pivots], self._V[:pivots].T, 1.0, self.T, trans_b=True, overwrite_c=True)
        return reason, entering, row, pivots

    def pivot(self, row: int, variable: int) -> int:
        """Exchange the basic variable of the row with a nonbasic one; returns the variable that left."""
        from signorini.lcp.kernels import exchange

        at = int(self.column_of[variable])
        exchange(self.T, row, at)
        left = int(self.basic[row])
        self.basic[row], self.nonbasic[at] = variable, left
        self.row_of[variable], self.row_of[left] = row, -1
        self.column_of[variable], self.column_of[left] = -1, at
        return left

    def values(self) -> tuple[Array, Array, float]:
        """(w, z, theta) with the nonbasic ones 0."""
        x = np.zeros(2 * self.n + 1)
        x[self.basic] = self.rhs
        return x[: self.n], x[self.n : -1], float(x[-1])

    def drift(self) -> float:
        """Largest ``|w - M z - d theta - q|`` over the largest variable or q: what rounding has done so far."""
        w, z, theta = self.values()
        error = np.abs(w - self.M @ z - self.d * theta - self.q).max()
        return float(error / max(np.abs(self.rhs).max(), np.abs(self.q).max()))

    def refresh(self) -> bool:
        """Recompute T from the data and the basis by a new factorisation; False where the basis is singular."""
        full = np.hstack([np.eye(self.n), -self.M, -self.d[:, None], self.q[:, None]])
        factors = la.lu_factor(full[:, self.basic], check_finite=False)
        if not np.abs(np.diag(factors[0])).min() > 0:
            return False
        self.T = np.asfortranarray(la.lu_solve(factors, full[:, np.append(self.nonbasic, 2 * self.n + 1)]))
        return True
