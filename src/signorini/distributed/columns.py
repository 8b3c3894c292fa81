# SPDX-License-Identifier: BSD-3-Clause
"""A few arrays side by side whose rows are on the ranks: rigid motions of the free displacements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.distributed.rank_arrays import ArrayOnRanks, Cut


class ColumnsOnRanks:
    """A table (n, k) of k arrays on the ranks; what is not done there is given all of it.

    Attributes
    ----------
    shape, ndim : as of an array

    Parameters
    ----------
    cut : which rows every rank has
    columns : k arrays (n,)
    """

    ndim = 2

    def __init__(self, cut: Cut, columns: Sequence[ArrayOnRanks]) -> None:
        self._cut, self._columns, self.shape = cut, tuple(columns), (cut.size, len(columns))

    @property
    def T(self) -> _Transposed:
        """The transpose, to be multiplied with."""
        return _Transposed(self)

    def __matmul__(self, weights: Array) -> Any:
        """Sums of the columns by weights (k,), an array on the ranks, or (k, m), such a table."""
        if np.ndim(weights) == 2:
            return ColumnsOnRanks(self._cut, [self @ each for each in weights.T])
        found: Any = self._cut.zeros
        for weight, column in zip(weights, self._columns, strict=True):
            found = found + float(weight) * column
        return found

    def along(self, values: Any) -> Array:
        """(k, ...) Products of every column with values (n, ...), here or on the ranks."""
        if isinstance(values, ArrayOnRanks):
            return np.array([column @ values for column in self._columns], dtype=np.float64)
        return np.asarray(np.asarray(self).T @ values)

    def far_apart(self) -> IntArray:
        """(k,) Rows that tell the columns, which are independent, apart: pivots of an orthonormal basis of theirs."""
        products = np.array([self.along(column) for column in self._columns])
        rest: ColumnsOnRanks = self @ np.linalg.inv(np.linalg.cholesky(products)).T
        found = []
        for _ in self._columns:
            size: Any = sum(column * column for column in rest._columns)
            row = int(np.flatnonzero(size == size.max())[0])
            way = rest[np.array([row])][0]
            found.append(row)
            rest = rest @ (np.eye(len(way)) - np.outer(way, way) / (way @ way))
        return np.array(found)

    def __getitem__(self, rows: IntArray) -> Array:
        """(m, k) Some rows, by their numbers (m,)."""
        return np.array([column[rows] for column in self._columns]).reshape(len(self._columns), len(rows)).T

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """All of it, for what is not done on ranks."""
        del copy  # it is one
        whole = np.empty(self.shape, dtype)
        for k, column in enumerate(self._columns):
            whole[:, k] = column.whole()
        return whole


class _Transposed:
    def __init__(self, columns: ColumnsOnRanks) -> None:
        self._columns = columns

    def __matmul__(self, values: Any) -> Array:
        return self._columns.along(values)
