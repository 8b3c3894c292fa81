# SPDX-License-Identifier: BSD-3-Clause
"""The condensed tableau of Lemke's method: one rank-one update a pivot, in place.

The basic variables are ``x_B = rhs - T x_N`` with n + 1 nonbasic ones in N. Variables are numbered: w_i is i, z_i is
n + i, the artificial theta is 2 n. At the start B = (w_1 .. w_n), ``T = (-M, -d)`` and ``rhs = q``.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from signorini.arrays import Array, IntArray
from signorini.lcp.kernels import blocking_rows, compiled, exchange


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
        self.T[:, :n], self.T[:, n], self.T[:, n + 1] = -M, -d, q
        self.basic: IntArray = np.arange(n)
        self.nonbasic: IntArray = np.arange(n, 2 * n + 1)
        self.column_of = np.full(2 * n + 1, -1)
        self.column_of[self.nonbasic] = np.arange(n + 1)
        self.row_of = np.full(2 * n + 1, -1)
        self.row_of[self.basic] = np.arange(n)
        self._exchange, self._blocking_rows = compiled(exchange), compiled(blocking_rows)
        self._rows: IntArray = np.empty(n, dtype=np.int64)

    @property
    def rhs(self) -> Array:
        """Values of the basic variables, a view."""
        return self.T[:, -1]

    def column(self, variable: int) -> Array:
        """Column of a nonbasic variable, a view: the basic ones fall at these rates as it grows."""
        return self.T[:, self.column_of[variable]]

    def blocking(
        self, variable: int, pivot_tolerance: float, tie_tolerance: float, size: float
    ) -> tuple[IntArray, float]:
        """Rows that stop an entering variable first, and how far it comes (``blocking_rows``)."""
        at = self.column_of[variable]
        count, step = self._blocking_rows(self.T, at, pivot_tolerance, tie_tolerance, size, self._rows)
        return self._rows[:count], float(step)

    def pivot(self, row: int, variable: int) -> int:
        """Exchange the basic variable of the row with a nonbasic one; returns the variable that left."""
        at = int(self.column_of[variable])
        self._exchange(self.T, row, at)
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

    def least_lexicographic(self, rows: IntArray, divisors: Array, tolerance: float) -> int:
        """Row, among the given ones, whose row of the basis inverse over its divisor is lexicographically least.

        Column j of the basis inverse is the column of w_j, a unit vector where w_j is basic. Entries closer than the
        tolerance count as equal.
        """
        if len(rows) == 1:
            return int(rows[0])
        w_columns = self.column_of[: self.n]
        inverse = np.zeros((len(rows), self.n))
        nonbasic = np.flatnonzero(w_columns >= 0)
        inverse[:, nonbasic] = self.T[np.ix_(rows, w_columns[nonbasic])]
        is_w = self.basic[rows] < self.n
        inverse[np.flatnonzero(is_w), self.basic[rows[is_w]]] = 1.0
        inverse /= divisors[:, None]
        start = 0
        while len(rows) > 1:
            spread = inverse[:, start:].max(axis=0) - inverse[:, start:].min(axis=0)
            differing = np.flatnonzero(spread > tolerance)
            if not len(differing):
                break
            start += int(differing[0])
            keep = inverse[:, start] <= inverse[:, start].min() + tolerance
            rows, inverse = rows[keep], inverse[keep]
            start += 1
        return int(rows[0])
