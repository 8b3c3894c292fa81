# SPDX-License-Identifier: BSD-3-Clause
"""A few arrays side by side whose rows are on the ranks: rigid motions, and displacements of several states."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from signorini.arrays import Array, IntArray
from signorini.distributed.rank_arrays import ArrayOnRanks, Cut


class ColumnsOnRanks(NDArrayOperatorsMixin):
    """A table (n, k) of k arrays on the ranks; what is not done there is given all of it.

    Arithmetic that goes entry by entry, with numbers and such tables, is done there, column by column.

    Attributes
    ----------
    shape, ndim : as of an array

    Parameters
    ----------
    cut : which rows every rank has
    columns : k arrays (n,)
    """

    ndim = 2
    __hash__ = object.__hash__  # by what it is; as with arrays, equality is of the entries

    def __init__(self, cut: Cut, columns: Sequence[ArrayOnRanks]) -> None:
        self._cut, self._columns = cut, list(columns)

    @staticmethod
    def spread(cut: Cut, numbers: IntArray, values: Array) -> Any:
        """Values (k,) in some rows (k,), zero elsewhere: an array on the ranks; of values (k, m) such a table.

        Parameters
        ----------
        cut, numbers, values : which rows every rank has, some of them, and what stands there
        """
        if values.ndim == 1:
            return cut.spread(numbers, values)
        return ColumnsOnRanks(cut, [cut.spread(numbers, each) for each in values.T])

    @property
    def shape(self) -> tuple[int, int]:
        """(n, k)."""
        return self._cut.size, len(self._columns)

    @property
    def T(self) -> _Transposed:
        """The transpose, to be multiplied with."""
        return _Transposed(self)

    def mapped(self, cut: Cut, work: Callable[[ArrayOnRanks], Any]) -> ColumnsOnRanks:
        """What a function makes of every column.

        Parameters
        ----------
        cut : which rows every rank has then
        work : an array on ranks of an array on ranks
        """
        return ColumnsOnRanks(cut, [work(column) for column in self._columns])

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
        if isinstance(values, ColumnsOnRanks):
            found = [self.along(column) for column in values.T]
            return np.array(found).reshape(len(found), len(self._columns)).T
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

    def __getitem__(self, index: Any) -> Any:
        """(m, k) Some rows, by their numbers (m,); some columns of all rows, by a slice or a number."""
        if isinstance(index, tuple):
            chosen = self._columns[index[1]]
            return ColumnsOnRanks(self._cut, chosen) if isinstance(chosen, list) else chosen
        return np.array([column[index] for column in self._columns]).reshape(len(self._columns), len(index)).T

    def __setitem__(self, index: tuple[slice, slice], values: ColumnsOnRanks) -> None:
        """Put other columns in place of some."""
        self._columns[index[1]] = values._columns

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **keywords: Any) -> Any:
        """A function of NumPy that goes entry by entry."""
        alike = all(isinstance(each, ColumnsOnRanks) or np.ndim(each) == 0 for each in inputs)
        if method != "__call__" or keywords or not alike:
            return getattr(ufunc, method)(*map(_whole, inputs), **keywords)
        given = [each._columns if isinstance(each, ColumnsOnRanks) else [each] * self.shape[1] for each in inputs]
        return ColumnsOnRanks(self._cut, [ufunc(*each) for each in zip(*given, strict=True)])

    def __iadd__(self, other: Any) -> Any:
        """Another table: what others have of this one stays."""
        return self + other

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """All of it, for what is not done on ranks."""
        del copy  # it is one
        whole = np.empty(self.shape, dtype)
        for k, column in enumerate(self._columns):
            whole[:, k] = column.whole()
        return whole


def _whole(value: Any) -> Any:
    return np.asarray(value) if isinstance(value, ColumnsOnRanks | ArrayOnRanks) else value


class _Transposed:
    def __init__(self, columns: ColumnsOnRanks) -> None:
        self._columns = columns

    def __matmul__(self, values: Any) -> Array:
        return self._columns.along(values)

    def __iter__(self) -> Iterator[ArrayOnRanks]:
        return iter(self._columns._columns)
