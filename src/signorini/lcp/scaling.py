# SPDX-License-Identifier: BSD-3-Clause
"""Equilibration of rows and columns by powers of two: exact in floating point, undone without loss."""

from __future__ import annotations

import math
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


def equilibrate(M: Array, q: Array, row_sizes: Array, column_sizes: Array) -> Equilibrated:
    """Divide every row by its size and multiply every column by its, then all by one factor: largest entry about 1.

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
    return 2.0 ** round(math.log2(1.0 / size)) if size > 0 else 1.0
