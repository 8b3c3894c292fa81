# SPDX-License-Identifier: BSD-3-Clause
"""The data of a linear complementarity problem, checked once at the door."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.lcp.residual import Matrix, Residual, Yardstick
from signorini.short import Short

LARGEST_DENSE = 30_000  # rows: 7 GB


@dataclass(frozen=True, kw_only=True, repr=False)
class LCP(Short):
    """Find z with ``0 <= z  _|_  w = M z + q >= 0``.

    Attributes
    ----------
    M : (n, n) array, CSR array or linear operator
    q : (n,) array
    """

    M: Matrix
    q: Array

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return len(self.q)

    @cached_property
    def yardstick(self) -> Yardstick:
        """What candidates are measured with."""
        return Yardstick.of(self.M, self.q)

    @property
    def sizes(self) -> tuple[Array, Array]:
        """Balanced sizes of rows and columns of M (``balance``)."""
        return self.yardstick.rows, self.yardstick.columns

    def residual(self, z: Array) -> Residual:
        """The natural residual of a candidate."""
        return self.yardstick.residual(z)

    def dense(self) -> Array | None:
        """M as a dense array, None where it is a linear operator or too large (more than 30000 rows)."""
        if isinstance(self.M, np.ndarray):
            return self.M
        if isinstance(self.M, LinearOperator) or self.n > LARGEST_DENSE:
            return None
        return np.asarray(self.M.toarray())


def read_problem(M: Any, q: ArrayLike) -> LCP:
    """Check and convert what a user gives.

    Parameters
    ----------
    M : (n, n) array-like, sparse matrix or sparse array, or LinearOperator
    q : (n,) array-like

    Raises
    ------
    InputError
        For a non-square or empty M, a q that does not fit, complex, NaN or infinite entries.

    Examples
    --------
    >>> read_problem([[1.0, 2.0]], [1.0])
    Traceback (most recent call last):
    ...
    signorini.errors.InputError: M: has shape (1, 2); expected a square matrix
    """
    vector = _real(q, "q")
    if not isinstance(M, LinearOperator):
        M = _csr(M) if sp.issparse(M) else _real(M, "M")
    if len(M.shape) != 2 or M.shape[0] != M.shape[1]:
        raise InputError(f"has shape {M.shape}; expected a square matrix", where=("M",))
    if vector.shape != (M.shape[0],):
        raise InputError(f"has shape {vector.shape}; expected ({M.shape[0]},) to fit M {M.shape}", where=("q",))
    if not len(vector):
        raise InputError("is empty; a problem without unknowns has nothing to solve", where=("q",))
    _finite(vector, "q")
    if not isinstance(M, LinearOperator):
        _finite(M if isinstance(M, np.ndarray) else M.data, "M")
    return LCP(M=M, q=vector)


def read_vector(values: ArrayLike, name: str, n: int) -> Array:
    """A finite (n,) array of values, or an InputError that has the name."""
    vector = _real(values, name)
    if vector.shape != (n,):
        raise InputError(f"has shape {vector.shape}; expected ({n},)", where=(name,))
    _finite(vector, name)
    return vector


def _csr(M: Any) -> Any:
    rows = sp.csr_array(M, dtype=float)
    rows.sum_duplicates()
    return rows


def _real(values: ArrayLike, name: str) -> Array:
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise InputError(f"has entries of type {array.dtype}; expected real numbers", where=(name,))
    return np.asarray(array, dtype=float)


def _finite(values: Array, name: str) -> None:
    bad = np.size(values) - np.count_nonzero(np.isfinite(values))
    if bad:
        raise InputError(f"has {bad} entries that are NaN or infinite; expected finite numbers", where=(name,))
