# SPDX-License-Identifier: BSD-3-Clause
"""The inverse of a dense matrix that is bordered, loses rows and columns, and is changed by low ranks.

It is a base and low ranks beside it, ``X = P' X_0 P + U V``, P the places that are left of the base. Factors serve as
``X_0`` as long as little has changed: to invert them takes twice as long as they did. Low ranks are collected, since to
put a few dozen into the base at once takes hardly longer than one of them, which has to read and write all of it.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray
from signorini.linalg.shared_dense import (
    add_product,
    cholesky,
    factorise_with_pivots,
    inverse_of_cholesky,
    inverse_of_factors,
    product,
)

COLLECTED = 32
"""Ranks that are collected beside a base: a product with them reads as much as one with a base of 64 rows."""

_ROOM = 64
"""Rows that a base may grow by before it is moved to larger memory."""


class ChangedInverse:
    """The inverse X of a matrix M, (m, m), and of what becomes of it.

    Parameters
    ----------
    matrix : (m, m) M by columns; overwritten
    symmetric : whether it is symmetric and positive definite: half the operations

    Attributes
    ----------
    condition : reciprocal condition number of M in the norm of column sums, estimated, 0 where it has no factors

    Examples
    --------
    >>> inverse = ChangedInverse(np.asfortranarray(np.diag([2.0, 4.0])))
    >>> inverse.border(1)
    >>> inverse.add(np.array([[0.5, 0.0], [0.0, 0.0], [0.0, -0.5]]), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
    >>> inverse.keep(np.array([2, 0]))
    >>> inverse.times(np.array([2.0, 3.0])).tolist(), inverse.whole.tolist()
    ([-1.0, 3.0], [[-0.5, 0.0], [0.0, 1.0]])
    """

    def __init__(self, matrix: Array, *, symmetric: bool = False) -> None:
        m = len(matrix)
        norm = float(lapack.dlange("1", matrix)) if m else 0.0
        self.condition = 1.0
        self._base, self._place = matrix, np.arange(m)  # where in the base what is left stands, -1: nowhere
        self._swapped: IntArray | None = None  # rows of factors with pivots
        self._known = not m  # whether the base is an inverse, not factors
        self._size = m  # rows and columns of the base that hold it; others are room to grow
        self._left, self._right = np.empty((m, 0)), np.empty((0, m))
        if symmetric and m:
            failed = cholesky(matrix)
            self.condition = 0.0 if failed else float(lapack.dpocon(matrix, norm, uplo="L")[0])
        elif m:
            self._swapped, failed = factorise_with_pivots(matrix)
            self.condition = 0.0 if failed else float(lapack.dgecon(matrix, norm)[0])

    def __len__(self) -> int:
        return len(self._place)

    @property
    def whole(self) -> Array:
        """(m, m) X, a view: the base with all changes in it from now on."""
        m, left, right = len(self), self._left, self._right
        if not self._known:
            self._invert()
        if m > len(self._base):
            larger = np.zeros((m + _ROOM, m + _ROOM), order="F")
            larger[: self._size, : self._size] = self._base[: self._size, : self._size]
            self._base = larger
        self._move()
        if left.shape[1] and m:
            padded = np.zeros((len(self._base), left.shape[1]), order="F")
            padded[:m] = left
            add_product(self._base[:, :m], padded, right)
        self._left, self._right = left[:, :0], right[:0]
        return self._base[:m, :m]

    def _invert(self) -> None:
        """Make the base an inverse."""
        base = np.zeros((self._size + _ROOM,) * 2, order="F")
        if self._swapped is None:
            base[: self._size, : self._size] = inverse_of_cholesky(self._base, overwrite=True)
        else:
            inverse_of_factors(self._base, self._swapped, base[: self._size, : self._size])
        self._base, self._known = base, True

    def _move(self) -> None:
        """Put rows and columns of a base that is an inverse where they are wanted."""
        base, m = self._base, len(self)
        moved = np.flatnonzero(self._place != np.arange(m))
        to, own = moved[self._place[moved] >= 0], self._place[moved][self._place[moved] >= 0]
        new = moved[self._place[moved] < 0]
        base[:, to] = base[:, own]
        base[to] = base[own]
        base[:, new], base[new] = 0.0, 0.0
        self._place, self._size = np.arange(m), m

    def times(self, b: Array) -> Array:
        """``X b``; b (m,) or (m, k)."""
        found = self._of_base(b, transposed=False)
        return found + self._left @ (self._right @ b) if self._left.shape[1] else found

    def transposed_times(self, b: Array) -> Array:
        """``X' b``; b (m,) or (m, k)."""
        found = self._of_base(b, transposed=True)
        return found + self._right.T @ (self._left.T @ b) if self._left.shape[1] else found

    def columns(self, places: IntArray) -> Array:
        """(m, k) Some of X."""
        if not self._known:
            return self.times(self._units(places))
        return self._some(self._base, places) + self._left @ self._right[:, places]

    def rows(self, places: IntArray) -> Array:
        """(k, m) Some of X."""
        if not self._known:
            return self.transposed_times(self._units(places)).T
        return self._some(self._base.T, places).T + self._left[places] @ self._right

    def add(self, left: Array, right: Array) -> None:
        """Change X by ``left right``, (m, k) and (k, m)."""
        self._left, self._right = np.hstack([self._left, left]), np.vstack([self._right, right])
        if self._left.shape[1] > COLLECTED:
            _ = self.whole

    def border(self, k: int) -> None:
        """Border X by k rows and columns of zeros."""
        self._place = np.concatenate([self._place, np.full(k, -1)])
        self._left, self._right = np.pad(self._left, ((0, k), (0, 0))), np.pad(self._right, ((0, 0), (0, k)))

    def keep(self, places: IntArray) -> None:
        """Keep some rows and columns of X, in another order."""
        self._place = self._place[places]
        self._left, self._right = self._left[places], self._right[:, places]

    def _of_base(self, b: Array, *, transposed: bool) -> Array:
        """``P' X_0 P b`` or its transpose."""
        base, kept = self._base[: self._size, : self._size], self._place >= 0
        given = np.zeros((self._size, *b.shape[1:]))
        given[self._place[kept]] = b[kept]
        if self._known:
            matrix = base.T if transposed else base
            found = product(matrix, given) if given.ndim == 1 else matrix @ given
        elif self._swapped is None:
            found = lapack.dpotrs(base, given, lower=1)[0]
        else:
            found = lapack.dgetrs(base, self._swapped, given, trans=int(transposed))[0]
        left = np.zeros(b.shape)
        left[kept] = found[self._place[kept]]
        return left

    def _some(self, base: Array, places: IntArray) -> Array:
        """(m, k) Some columns of ``P' X_0 P``, of a base that is an inverse, or its transpose."""
        own = self._place[places]
        rows, columns = np.flatnonzero(self._place >= 0), np.flatnonzero(own >= 0)
        found = np.zeros((len(self), len(places)))
        found[np.ix_(rows, columns)] = base[:, own[columns]][self._place[rows]]
        return found

    def _units(self, places: IntArray) -> Array:
        units = np.zeros((len(self), len(places)))
        units[places, np.arange(len(places))] = 1.0
        return units
