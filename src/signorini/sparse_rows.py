# SPDX-License-Identifier: BSD-3-Clause
"""Matrices of rows, made and taken apart without looking at what is given.

SciPy's constructors, selections and transposes look at every index and ask for types; of matrices with a few hundred
entries, of which a small model has dozens, that takes ten times as long as what is done with them. What is given here
is known to fit, and what comes out has the entries of SciPy's results, in their order.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, distinct

_FEW_COLUMNS = 100
"""Columns of a matrix up to which it is multiplied as a table with all its zeros."""

_FEW_ENTRIES = 6_000
"""Entries up to which sorting them takes less than SciPy's constructor, which is four times as fast for 100,000."""

_ROWS, _COLUMNS = (vars(kind((1, 1))) for kind in (sp.csr_array, sp.csc_array))


def rows_of(data: Array, indices: IntArray, indptr: IntArray, shape: tuple[int, int]) -> sp.csr_array:
    """A matrix of its entries, (m, n).

    Parameters
    ----------
    data, indices : (nnz,) entries, row by row, and their columns
    indptr : (m + 1,) where rows begin
    shape : (m, n)

    Examples
    --------
    >>> rows_of(np.array([3.0, 4.0]), np.array([1, 0]), np.array([0, 1, 2]), (2, 2)).toarray().tolist()
    [[0.0, 3.0], [4.0, 0.0]]
    """
    places = indices.astype(np.int32, copy=False), indptr.astype(np.int32, copy=False)
    return _made(sp.csr_array, _ROWS, data, *places, shape)


def transposed(matrix: sp.csr_array) -> sp.csc_array:
    """The transpose, on the same entries.

    >>> transposed(sp.csr_array(np.array([[1.0, 2.0]]))).toarray().tolist()
    [[1.0], [2.0]]
    """
    return _made(sp.csc_array, _COLUMNS, matrix.data, matrix.indices, matrix.indptr, matrix.shape[::-1])


def _made(kind: Any, like: dict[str, Any], data: Array, indices: IntArray, indptr: IntArray, shape: Any) -> Any:
    made = object.__new__(kind)
    vars(made).update(like, data=data, indices=indices, indptr=indptr, _shape=shape)
    return made


def scaled_rows(rows: sp.csr_array, by: Array) -> sp.csr_array:
    """Every row of a matrix times a number of its own.

    >>> scaled_rows(sp.csr_array(np.ones((2, 2))), np.array([1.0, 3.0])).toarray().tolist()
    [[1.0, 1.0], [3.0, 3.0]]
    """
    begin = rows.indptr
    data = rows.data * np.repeat(by, begin[1:] - begin[:-1])
    return _made(sp.csr_array, vars(rows), data, rows.indices.copy(), begin.copy(), rows.shape)


def selection(numbers: IntArray, count: int) -> sp.csr_array:
    """(k, count) What picks some of ``count`` rows, one each; transposed it puts k rows at those places.

    >>> selection(np.array([2, 0]), 3).toarray().tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    k = len(numbers)
    return rows_of(np.ones(k), numbers, np.arange(k + 1, dtype=np.int32), (k, count))


def chosen_rows(matrix: sp.csr_array, rows: IntArray | BoolArray) -> sp.csr_array:
    """Some rows of a matrix: their numbers, in any order and again and again, or which of all.

    >>> chosen_rows(sp.csr_array(np.array([[1.0, 2.0], [0.0, 3.0]])), np.array([1, 0])).toarray().tolist()
    [[0.0, 3.0], [1.0, 2.0]]
    """
    numbers = np.flatnonzero(rows) if rows.dtype == np.bool_ else rows
    begin = matrix.indptr[numbers]
    indptr = _starts(matrix.indptr[numbers + 1] - begin)
    own = np.arange(indptr[-1]) + np.repeat(begin - indptr[:-1], indptr[1:] - indptr[:-1])
    return rows_of(matrix.data[own], matrix.indices[own], indptr, (len(numbers), matrix.shape[1]))


def renumbered(matrix: sp.csr_array, number: IntArray, count: int) -> sp.csr_array:
    """The entries of a matrix in other columns, in the order in which they were.

    Parameters
    ----------
    matrix : (m, n)
    number : (n,) the column that each becomes; those < 0 are left out
    count : how many columns there are then

    Examples
    --------
    >>> renumbered(sp.csr_array(np.array([[1.0, 2.0, 3.0]])), np.array([-1, 1, 0]), 2).toarray().tolist()
    [[3.0, 2.0]]
    """
    columns = number[matrix.indices]
    there = columns >= 0
    if there.all():
        return rows_of(matrix.data.copy(), columns, matrix.indptr.copy(), (matrix.shape[0], count))
    indptr = np.concatenate([np.zeros(1, np.int32), np.cumsum(there, dtype=np.int32)])[matrix.indptr]
    return rows_of(matrix.data[there], columns[there], indptr, (matrix.shape[0], count))


def turned_rows(matrix: sp.csr_array) -> sp.csr_array:
    """A matrix with the entries of every row in the opposite order, in which SciPy's products leave them.

    >>> turned_rows(sp.csr_array(np.array([[1.0, 2.0]]))).indices.tolist()
    [1, 0]
    """
    begin, end = matrix.indptr[:-1], matrix.indptr[1:]
    own = np.repeat(begin + end - 1, end - begin) - np.arange(len(matrix.data))
    return rows_of(matrix.data[own], matrix.indices[own], matrix.indptr.copy(), matrix.shape)


def chosen_columns(matrix: sp.csr_array, columns: IntArray) -> sp.csr_array:
    """Some columns of a matrix, each once.

    >>> chosen_columns(sp.csr_array(np.array([[1.0, 2.0, 3.0]])), np.array([2, 1])).toarray().tolist()
    [[3.0, 2.0]]
    """
    number = np.full(matrix.shape[1], -1, np.int32)
    number[columns] = np.arange(len(columns), dtype=np.int32)
    return renumbered(matrix, number, len(columns))


def seen_by(matrix: sp.csr_array, values: Any) -> Array:
    """The product with values (n,), of which only those that entries meet are asked for where they are elsewhere.

    >>> seen_by(sp.csr_array(np.array([[0.0, 2.0]])), np.array([7.0, 3.0])).tolist()
    [6.0]
    """
    if not isinstance(values, np.ndarray):
        met = distinct(matrix.indices)
        matrix, values = chosen_columns(matrix, met), values[met]
    found: Array = matrix @ values
    return found


def of_entries(values: Array, rows: IntArray, columns: IntArray, shape: tuple[int, int]) -> sp.csr_array:
    """A matrix of entries in any order, of which those at one place are added.

    Parameters
    ----------
    values, rows, columns : (k,) entries and where they are
    shape : (m, n)

    Examples
    --------
    >>> of_entries(np.array([1.0, 2.0]), np.array([1, 0]), np.array([0, 1]), (2, 2)).toarray().tolist()
    [[0.0, 2.0], [1.0, 0.0]]
    """
    if len(values) > _FEW_ENTRIES:
        return sp.csr_array((values, (rows, columns)), shape=shape)
    keys = rows.astype(np.int64) * shape[1] + columns
    order = np.argsort(keys, kind="stable")  # of what comes in runs as fast as any
    keys = keys[order]
    if (keys[1:] == keys[:-1]).any():
        return sp.csr_array((values, (rows, columns)), shape=shape)
    return rows_of(values[order], columns[order], _starts(np.bincount(rows, minlength=shape[0])), shape)


def stacked(parts: list[sp.csr_array]) -> sp.csr_array:
    """Matrices of as many columns one below the other.

    >>> stacked([sp.csr_array(np.eye(2)), sp.csr_array(np.array([[0.0, 5.0]]))]).toarray().tolist()
    [[1.0, 0.0], [0.0, 1.0], [0.0, 5.0]]
    """
    counts = np.concatenate([part.indptr[1:] - part.indptr[:-1] for part in parts])
    data, indices = (np.concatenate([getattr(part, name) for part in parts]) for name in ("data", "indices"))
    return rows_of(data, indices, _starts(counts), (len(counts), parts[0].shape[1]))


def added(one: sp.csr_array, other: sp.csr_array, share: float = 1.0) -> sp.csr_array:
    """``one + share other``, without entries that come to 0.

    Parameters
    ----------
    one, other : (m, n)
    share : of the second, 1 or -1

    Examples
    --------
    >>> added(sp.csr_array(np.array([[1.0, 2.0]])), sp.csr_array(np.array([[1.0, 5.0]])), -1.0).toarray().tolist()
    [[0.0, -3.0]]
    """
    if not len(other.data):
        total = rows_of(one.data.copy(), one.indices.copy(), one.indptr.copy(), one.shape)
    elif not len(one.data):
        total = rows_of(share * other.data, other.indices.copy(), other.indptr.copy(), one.shape)
    elif _alike(one, other):
        total = rows_of(one.data + share * other.data, one.indices.copy(), one.indptr.copy(), one.shape)
    else:
        return sp.csr_array(one + share * other)
    total.eliminate_zeros()
    return total


def _alike(one: sp.csr_array, other: sp.csr_array) -> bool:
    """Whether two matrices have entries at the same places, each once."""
    pairs = (one.indptr, other.indptr), (one.indices, other.indices)
    return all(np.array_equal(*pair) for pair in pairs) and one.has_canonical_format


def gram(matrix: sp.csr_array) -> Array:
    """(n, n) ``A^T A`` of a matrix A, (m, n), of few columns.

    >>> gram(sp.csr_array(np.array([[1.0, 2.0], [0.0, 3.0]]))).tolist()
    [[1.0, 2.0], [2.0, 13.0]]
    """
    if matrix.shape[1] > _FEW_COLUMNS:
        return np.asarray((transposed(matrix) @ matrix).toarray())
    return np.asarray(transposed(matrix) @ matrix.toarray())


def _starts(counts: IntArray) -> IntArray:
    """Where rows begin that have so many entries."""
    starts = np.zeros(len(counts) + 1, np.int32)
    np.cumsum(counts, out=starts[1:])
    return starts
