# SPDX-License-Identifier: BSD-3-Clause
"""Equilibration of rows and columns by powers of two: exact in floating point, undone without loss."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array


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


def equilibrate(M: Array, q: Array, *, sweeps: int = 8) -> Equilibrated:
    """Scale every row and column of M to a largest entry of about 1.

    Parameters
    ----------
    M : (n, n) array
    q : (n,) array
    sweeps : rounds of dividing rows and columns by the root of their largest entry

    References
    ----------
    Ruiz (2001), A scaling algorithm to equilibrate both rows and columns norms in matrices, RAL-TR-2001-034.

    Examples
    --------
    >>> scaled = equilibrate(np.array([[4e9, 0.0], [0.0, 2e-9]]), np.array([1.0, 1.0]))
    >>> bool((abs(np.diag(scaled.M)) <= 2).all() and (abs(np.diag(scaled.M)) >= 0.25).all())
    True
    """
    rows, columns = equilibrating_factors(np.abs(M), sweeps=sweeps)
    q = rows * q
    unit = float(_power_of_two(1.0 / _or_one(np.abs(q).max(keepdims=True)))[0])
    return Equilibrated(M=M * rows[:, None] * columns, q=q * unit, rows=rows, columns=columns, unit=unit)


def equilibrating_factors(sizes: Array, *, sweeps: int) -> tuple[Array, Array]:
    """Powers of two (rows, columns) that bring the largest entries of rows and columns near 1."""
    exponents = _log2(sizes)
    rows, columns = np.zeros(len(exponents)), np.zeros(len(exponents))
    for _ in range(sweeps):
        row = _finite_or_zero((exponents + columns).max(axis=1) + rows)
        column = _finite_or_zero((exponents + rows[:, None]).max(axis=0) + columns)
        if max(np.abs(row).max(), np.abs(column).max()) <= 0.5:
            break
        rows, columns = rows - row / 2, columns - column / 2
    return np.exp2(np.round(rows)), np.exp2(np.round(columns))


def _log2(sizes: Array) -> Array:
    """The binary exponents, minus infinity for 0."""
    return np.where(sizes > 0, np.frexp(sizes)[1].astype(float), -np.inf)


def _finite_or_zero(values: Array) -> Array:
    return np.where(np.isfinite(values), values, 0.0)


def _power_of_two(values: Array) -> Array:
    return np.exp2(np.round(np.log2(values)))


def _or_one(size: Array) -> Array:
    return np.where(size > 0, size, 1.0)
