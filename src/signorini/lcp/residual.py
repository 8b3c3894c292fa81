# SPDX-License-Identifier: BSD-3-Clause
"""How wrong a candidate solution of a linear complementarity problem is.

What a residual is stands here and nowhere else, so that solvers, tests and users mean the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.lcp.linear import scaled

Matrix: TypeAlias = Array | sp.csr_array | LinearOperator

BLUR = 1e-5
"""Of the largest size in its part: what a z other than 0 may be wrong by, so that 1e-14 of it is within tolerances."""

SWEEPS = 40
"""Of balancing rows and columns in turn: ten are the rule."""

SETTLED = 0.05
"""Doublings that a sweep still changes a size by, where sizes are settled: residuals follow them within a few of it."""

EXCUSE = 1e-5
"""Of the terms of a row, beyond the data of its part: they excuse rounding, 1e-14 of them within 1e-9, and no more."""

LARGEST_GROWTH = 1e2
"""Of the largest of the data in its part: the size beyond which the terms of a row excuse no error any more."""

LEAST_SIZE = 2.0**-1000
"""Of a row or column that anything is divided by: smaller numbers have lost digits, and quotients overflow."""


@dataclass(frozen=True, kw_only=True)
class Residual:
    """Violations of ``0 <= z``, ``0 <= w`` and ``z_i w_i = 0``, each dimensionless, 0 where satisfied."""

    primal: float
    dual: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The number that a tolerance is compared with; infinite where an entry is not a number."""
        numbers = (self.primal, self.dual, self.complementarity)
        return max(numbers) if all(map(math.isfinite, numbers)) else math.inf


def natural_residual(M: Matrix, q: Array, z: Array) -> Residual:
    """Evaluate ``min(z, M z + q)`` on the problem as posed, never on a scaled copy.

    With ``w = M z + q``, every w_i is divided by ``s_i = |q_i| + sum_j |M_ij z_j|``, the size of the terms that cancel
    in it, and every z_j by ``1 / max_i(|M_ij| / s_i)``, the value at which it alone would make up such a sum: the
    result does not change when rows, columns or units do. Two rules compare rows, those of one part of M only
    (``ConnectedRows``), in balanced units: parts have no units in common.

    Where all terms of a row are what rounding left of 0 (an open contact: ``0 = 2 mu 0 - 0``), s_i would be noise too:
    every z_j other than 0 counts with ``1e-5 columns_j max_k(s_k / rows_k)`` more. Where z is large, terms that cancel
    would hide that a singular M does not reach q: with ``D_i = rows_i max_k(d_k / rows_k)`` of the data ``d_k = |q_k|``
    and what other parts bring into row k, s_i is never more than ``D_i + 1e-5 s_i``, which leaves room for rounding
    alone, nor more than ``100 D_i``, beyond which rounding would balance any q.

    Parameters
    ----------
    M : (n, n) array, sparse array or linear operator
    q : (n,) array, in the units of w
    z : (n,) array, the candidate

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

    return Yardstick.of(M, q).residual(z)


@dataclass(frozen=True, kw_only=True)
class Yardstick:
    """What the sizes of ``natural_residual`` are made of, computed once for many candidates.

    Attributes
    ----------
    M, q : the problem as posed
    magnitude : ``|M|``, None for an operator
    rows, columns : (n,) balanced sizes (``balance``)
    """

    M: Matrix
    q: Array
    magnitude: Any
    rows: Array
    columns: Array

    @cached_property
    def parts(self) -> ConnectedRows:
        """The rows that can be compared."""
        return ConnectedRows.of(self.magnitude, self.rows, self.columns)

    @staticmethod
    def of(M: Matrix, q: Array) -> Yardstick:
        """The yardstick of a problem."""
        magnitude = None if isinstance(M, LinearOperator) else abs(M)
        rows, columns = balance(magnitude, len(q))
        return Yardstick(M=M, q=q, magnitude=magnitude, rows=rows, columns=columns)

    def residual(self, z: Array) -> Residual:
        """The natural residual of a candidate."""
        share, w = self.shares(z)
        return Residual(
            primal=_largest(-share),
            dual=_largest(-w),
            complementarity=_largest(np.minimum(share, w)),
        )

    def shares(self, z: Array) -> tuple[Array, Array]:
        """z and w over their sizes: what is compared with 0, and with each other."""
        unit, w, _ = self.sizes(z)
        with np.errstate(over="ignore", invalid="ignore"):
            return unit * z, w

    def unforgiving(self, z: Array) -> tuple[float, float]:
        """The worst of the residual of a z >= 0, and what it would be if no row were forgiven another's rounding."""
        unit, w, blurred = self.sizes(z)
        with np.errstate(over="ignore", invalid="ignore"):
            violation = np.maximum(np.minimum(unit * z, w), -w)
            return _largest(violation), _largest(blurred * violation)

    def sizes(self, z: Array) -> tuple[Array, Array, Array]:
        """(unit, w, blurred): what z is multiplied by in ``natural_residual``, w divided by its sizes, and those over
        what they are without blur.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            product = self.M @ z
            sharp, blur = self._sizes_of_rows(np.abs(product), np.abs(z))
            size = _or_one(sharp + blur)
            w = (product + self.q) / size
            unit = np.full(len(z), 1.0 / (np.abs(z).max(initial=0.0) or 1.0))
            if self.magnitude is not None:
                column = _largest_in_columns(self.magnitude, 1.0 / size)
                unit = np.where(column > 0, column, unit)
            return unit, w, size / _or_one(sharp)

    def _sizes_of_rows(self, product: Array, z: Array) -> tuple[Array, Array]:
        """s of ``natural_residual`` from ``|M z|`` and ``|z|``: the terms of the rows themselves, and the blur."""
        q = np.abs(self.q)
        if self.magnitude is None:
            return q + product.max(), np.zeros(len(q))
        parts = self.parts
        data = parts.largest((q if parts.across is None else q + parts.across @ z) / self.rows)
        size = (q + self.magnitude @ z) / self.rows
        most = np.minimum(data + EXCUSE * size, LARGEST_GROWTH * data)
        size = np.where(data > 0, np.minimum(size, most), size)
        blur = np.where(z > 0, BLUR * self.columns * parts.largest(size), 0.0)
        return self.rows * size, self.magnitude @ blur


def balance(magnitude: Any, n: int) -> tuple[Array, Array]:
    """Sizes (rows, columns) such that ``|M_ij| columns_j / rows_i`` has rows and columns of comparable sums (Sinkhorn).

    The rows follow a rescaling of the rows and, for all but nearly empty matrices, ignore one of the columns; the
    columns likewise. Where the pattern of M admits no such sizes (one row that alone meets two columns), its rows and
    columns get largest entries of 1 instead (Ruiz). An operator (None for ``|M|``) and an empty row or column have
    size 1.

    References
    ----------
    Ruiz (2001), A scaling algorithm to equilibrate both rows and columns norms in matrices, RAL-TR-2001-034.

    Examples
    --------
    >>> M = np.array([[2.0, 1.0], [0.0, 2.0]])
    >>> sizes = balance(M * np.array([[1.0], [1e6]]), 2)[0] / balance(M, 2)[0]
    >>> print(sizes / sizes[0])
    [1.e+00 1.e+06]
    """
    rows, columns = np.ones(n), np.ones(n)
    if magnitude is None:
        return rows, columns
    for sweep in range(SWEEPS):
        before, rows = rows, _or_one(magnitude @ columns)
        if sweep > 0 and np.abs(np.log2(rows / before)).max() < SETTLED:
            return rows, columns
        columns = 1.0 / _or_one(magnitude.T @ (1.0 / rows))
    return _by_largest(magnitude, n)


def _by_largest(magnitude: Any, n: int) -> tuple[Array, Array]:
    """Sizes that make the largest entry of every row and column 1: they exist for every pattern."""
    turned = magnitude.T if isinstance(magnitude, np.ndarray) else magnitude.T.tocsr()
    rows, columns = np.ones(n), np.ones(n)
    for _ in range(SWEEPS):
        largest = _or_one(_largest_in_columns(turned, columns) / rows)
        columns = columns / np.sqrt(_or_one(_largest_in_columns(magnitude, 1.0 / rows) * columns))
        rows = rows * np.sqrt(largest)
    return rows, columns


def _largest_in_columns(magnitude: Any, weights: Array) -> Array:
    """``max_i |M_ij| weights_i`` for every column j."""
    largest = np.zeros(magnitude.shape[1])
    if isinstance(magnitude, np.ndarray):
        step = max(1, 20_000 // len(magnitude))  # a few rows at a time stay in the cache
        for i in range(0, len(magnitude), step):
            np.maximum(largest, (magnitude[i : i + step] * weights[i : i + step, None]).max(axis=0), out=largest)
        return largest
    np.maximum.at(largest, magnitude.indices, magnitude.data * np.repeat(weights, np.diff(magnitude.indptr)))
    return largest


def _largest(violation: Array) -> float:
    return 0.0 + float(violation.max(initial=0.0))


def _or_one(size: Array) -> Array:
    """Sizes to divide by: where nothing is there, nothing can be violated."""
    return np.where(size > 0, np.maximum(size, LEAST_SIZE), 1.0)


COUPLING = 1e-10  # balanced entries below it tie no rows together: the rounding they carry is below all tolerances


@dataclass(frozen=True, kw_only=True)
class ConnectedRows:
    """The parts of a matrix; between them the factor of units that balancing leaves open is any number.

    Attributes
    ----------
    label : (n,) part of every row and its column
    count : number of parts
    across : ``|M|`` with the entries inside the parts left out, None where there is one part
    """

    label: IntArray
    count: int
    across: Any | None

    @staticmethod
    def of(magnitude: Any, rows: Array, columns: Array) -> ConnectedRows:
        """The parts of a matrix of a magnitude ``|M|`` balanced by sizes of rows and columns (``residual.balance``).

        Examples
        --------
        >>> M = np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [5.0, 0.0, 1.0]])
        >>> parts = ConnectedRows.of(M, np.array([3.0, 3.0, 6.0]), np.ones(3))
        >>> parts.label[0] == parts.label[1], parts.label[0] == parts.label[2]
        (np.True_, np.False_)
        """
        n = len(rows)
        if isinstance(magnitude, np.ndarray):
            if _reaches_all(magnitude, rows, columns) and _reaches_all(magnitude.T, 1.0 / columns, 1.0 / rows):
                return ConnectedRows(label=np.zeros(n, dtype=np.int64), count=1, across=None)
            strong: Any = sp.csr_array(magnitude * columns > COUPLING * rows[:, None])
        else:
            strong = sp.csr_array(scaled(magnitude, 1.0 / rows, columns) > COUPLING)
        count, label = connected_components(strong, directed=True, connection="strong")
        if count == 1:
            return ConnectedRows(label=label, count=1, across=None)
        if isinstance(magnitude, np.ndarray):
            return ConnectedRows(label=label, count=count, across=np.where(label[:, None] != label, magnitude, 0.0))
        entries = magnitude.tocoo()
        foreign = label[entries.row] != label[entries.col]
        taken = (entries.data[foreign], (entries.row[foreign], entries.col[foreign]))
        return ConnectedRows(label=label, count=count, across=sp.csr_array(taken, shape=magnitude.shape))

    def largest(self, sizes: Array) -> Array:
        """(n,) the largest size in the part of every row."""
        if self.count == 1:
            return np.full(len(sizes), sizes.max(initial=0.0))
        most = np.zeros(self.count)
        np.maximum.at(most, self.label, sizes)
        return np.asarray(most[self.label])


def _reaches_all(magnitude: Array, rows: Array, columns: Array) -> bool:
    """Whether every row can be reached from the first one along entries that together are not weak."""
    reached = np.zeros(len(rows), dtype=bool)
    fresh = np.arange(len(rows)) == 0
    while fresh.any():
        reached |= fresh
        fresh = ((fresh / rows) @ magnitude * columns > COUPLING) & ~reached
    return bool(reached.all())
