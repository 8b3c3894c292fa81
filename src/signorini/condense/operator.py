# SPDX-License-Identifier: BSD-3-Clause
"""The interface in its image form, without its load: one factorisation that every load, friction and state shares.

Equilibrium reads ``G h - W r = b`` with ``G = I - W``. With R an orthonormal basis of the rigid motions (W R = R) and
``T = (G + R R')^-1``, regular whether bodies float or not, the same in forces is::

    h = A r + c + R a,    R'(r + b) = 0,    A = T - I,    c = T b - R R'b

so that open pairs (r = 0) take no part in the systems to solve. Of A and W one is given, and the other made when it is
asked for: ``W = I + R R' - (I + A)^-1`` is applied by the Cholesky factor of I + A without being formed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import blas

from signorini.arrays import Array, BoolArray, SingleArray, frozen, read_only
from signorini.condense.basis import make_basis
from signorini.errors import InputError
from signorini.linalg.shared_dense import cholesky, inverse_of_cholesky, product

UNRESISTED = 1e-14
"""Stiffness, relative to the interface stiffness D, below which a motion counts as rigid."""

_SOFTNESS = 0.1  # of the mean diagonal of A
_FLOOR = 1e-15
"""Of the largest entry of A: added to all entries in single precision, where nobody sees it.

What pairs far apart feel of each other in flat bodies falls exponentially, and processors take a hundred times as long
for products below 1e-38."""

_TILE = 256  # rows and columns of a triangle that are copied at once


@dataclass(frozen=True, kw_only=True, eq=False)
class InterfaceOperator:
    """Compliance and rigid motions of a contact interface, scaled; make it by `of_form` or `of_compliance`.

    Attributes
    ----------
    motions : (m, k) rigid motions seen by the pairs, W R = R
    R : (m, k) orthonormal basis of them
    by_form : whether W was given, not A; what is made of either later changes no digit of what is applied

    Examples
    --------
    >>> held = np.zeros((1, 0))
    >>> InterfaceOperator.of_form(np.array([[0.5]]), held).A.round(12).tolist()
    [[1.0]]
    >>> InterfaceOperator.of_compliance(np.eye(1), held, held).W.round(12).tolist()
    [[0.5]]
    """

    motions: Array
    R: Array
    by_form: bool = False

    @classmethod
    def of_form(cls, W: Array, motions: Array) -> InterfaceOperator:
        """The interface of W, with ``W R = R`` to rounding whatever its accuracy: ``P W P + R R'``, P = I - R R'.

        A body that floats may travel far beyond its elastic motion, which multiplies the error of W R by as much.

        Parameters
        ----------
        W : (m, m) symmetric, spectrum in [0, 1]

        Raises
        ------
        InputError
            Where shapes do not fit, entries are not finite, W is not symmetric to 1e-12, or W R differs from R by more
            than 1e-8 of the largest motion.
        """
        W, motions = read_only(W), read_only(motions)
        if W.ndim != 2 or len(W) != W.shape[1]:
            raise InputError(f"has shape {W.shape}; expected as many rows as columns", where=("W",))
        if motions.ndim != 2 or len(motions) != len(W):
            raise InputError(f"has shape {motions.shape}; expected ({len(W)}, k)", where=("motions",))
        for name, given in (("W", W), ("motions", motions)):
            if not np.isfinite(given).all():
                raise InputError("has entries that are not finite", where=(name,))
        if np.abs(W - W.T).max(initial=0.0) > 1e-12:
            raise InputError("is not symmetric", where=("W",))
        try:
            R = make_basis(motions).R
        except np.linalg.LinAlgError as dependent:
            raise InputError(
                "rigid motions are linearly dependent; expected independent columns", where=("motions",)
            ) from dependent
        if R.size:
            wrong = np.abs(W @ R - R).max()
            if wrong > 1e-8 * np.abs(R).max():
                raise InputError(f"are no rigid motions: W R differs from R by {wrong:.1e}", where=("motions",))
            elastic = W - R @ (R.T @ W)
            elastic -= (elastic @ R) @ R.T
            W = frozen((elastic + elastic.T) / 2 + R @ R.T)
        return cls(motions=motions, R=R, by_form=True)._knowing(W=W)

    @classmethod
    def of_compliance(cls, A: Array, motions: Array, R: Array, room: Array | None = None) -> InterfaceOperator:
        """The interface of a given compliance A, (m, m), symmetric, with ``A R = 0``; nothing is copied.

        Parameters
        ----------
        motions : (k, m) rigid motions as the pairs see them, scaled
        room : (m, m) whose upper triangle and diagonal the factor takes; None: it has room of its own

        Raises
        ------
        LinAlgError
            Where I + A is not positive definite.
        """
        return cls(motions=motions, R=R)._knowing(A=A, factor=_cholesky(A, room))

    def _knowing(self, **known: Array) -> InterfaceOperator:
        """This operator with what is given where cached properties keep their values."""
        self.__dict__.update(known)
        return self

    @cached_property
    def A(self) -> Array:
        """(m, m) Compliance: motion per force, on what forces can move without a rigid motion."""
        G = np.asfortranarray(self.R @ self.R.T - self.W)
        G[np.diag_indices(len(G))] += 1.0
        if cholesky(G) or np.diag(G).min(initial=1.0) ** 2 <= UNRESISTED:
            raise InputError(
                "has an eigenvalue 1 (a motion that nothing resists) beyond the rigid motions given; add that motion",
                where=("W",),
            )
        A = inverse_of_cholesky(G, overwrite=True).T
        A[np.diag_indices(len(A))] -= 1.0
        A.flags.writeable = False
        return A

    @cached_property
    def factor(self) -> Array:
        """(m, m) Lower Cholesky factor of I + A, by columns; above the diagonal anything."""
        return _cholesky(self.A)

    @cached_property
    def W(self) -> Array:
        """(m, m) InterfaceOperator form, symmetric, spectrum in [0, 1]."""
        W = inverse_of_cholesky(self.factor).T
        np.negative(W, out=W)
        W += self.R @ self.R.T
        W[np.diag_indices_from(W)] += 1.0
        W.flags.writeable = False
        return W

    def applied(self, x: Array) -> Array:
        """``W x``, (m,)."""
        if self.by_form:
            return np.asarray(self.W @ x)
        return x + self.R @ (self.R.T @ x) - softened(self.factor, x)

    @cached_property
    def still(self) -> BoolArray:
        """(m,) Motions that supports lock: exactly zero rows of W."""
        if self.by_form:
            return np.asarray(~self.W.any(axis=1), dtype=np.bool_)
        return np.asarray(~(self.A.any(axis=1) | self.R.any(axis=1)), dtype=np.bool_)

    @cached_property
    def single(self) -> Single:
        """A and a factor of ``A + softness I`` in single precision; softness: some of A."""
        return Single.of(self.A, _SOFTNESS * float(self.A.trace()) / max(1, len(self.A)) or 1.0)

    def free_motion(self, b: Array) -> Array:
        """(m,) Motion c of the pairs under the load alone, without its rigid part."""
        return b + product(self.A, b) - self.R @ (self.R.T @ b)

    def load(self, free: Array, resultant: Array) -> Array:
        """b, (m,), of a free motion, (m,), whose rigid part does not count, and resultants ``R' b``, (k,).

        >>> held = np.zeros((1, 0))
        >>> InterfaceOperator.of_form(np.array([[0.5]]), held).load(np.array([3.0]), np.zeros(0)).round(12).tolist()
        [1.5]
        """
        return softened(self.factor, free - self.R @ (self.R.T @ free)) + self.R @ resultant


class Single(NamedTuple):
    """A compliance A and a factor of ``A + softness I`` in single precision, in one matrix.

    Attributes
    ----------
    matrix : (m, m) by columns: A on the diagonal and above it; below it L of ``L D L^T = A + softness I``
    pivots : (m,) D; L has ones on its diagonal
    softness : what is added
    """

    matrix: SingleArray
    pivots: SingleArray
    softness: float

    @staticmethod
    def of(A: Array, softness: float) -> Single:
        """Factorise.

        Parameters
        ----------
        A : (m, m) symmetric
        softness : > 0

        Raises
        ------
        LinAlgError
            Where that is not positive definite.

        Examples
        --------
        >>> soft = Single.of(np.array([[3.0, 4.0], [4.0, 7.0]]), 1.0)
        >>> soft.product(np.array([2.0, 4.0])).tolist(), soft.solve(np.array([8.0, 12.0])).tolist()
        ([22.0, 36.0], [1.0, 1.0])
        """
        matrix = np.array(A.T, dtype=np.float32, order="F")
        matrix += np.float32(_FLOOR * A.diagonal().max(initial=0.0))
        diagonal = matrix.diagonal().copy()
        matrix[np.diag_indices_from(matrix)] += softness
        _factorise(matrix)
        root = matrix.diagonal().copy()
        for first in range(0, len(matrix), _TILE):
            some = slice(first, first + _TILE)
            matrix[first + _TILE :, some] /= root[some]
            block = matrix[some, some]
            block[:] = np.triu(block, 1) + np.tril(block, -1) / root[some]
        matrix[np.diag_indices_from(matrix)] = diagonal
        return Single(matrix, root**2, softness)

    def product(self, x: Array) -> Array:
        """``A x``, (m,)."""
        return symmetric_product(self.matrix, x)

    def solve(self, x: Array) -> Array:
        """``(A + softness I)^-1 x``, (m,)."""
        if not len(x):
            return x
        half = blas.strsv(self.matrix, x, lower=1, diag=1) / self.pivots
        return np.asarray(blas.strsv(self.matrix, half, lower=1, trans=1, diag=1), dtype=np.float64)


def softened(factor: Array, x: Array) -> Array:
    """``(I + A)^-1 x`` by the lower Cholesky factor of that matrix.

    >>> softened(np.array([[2.0]]), np.array([8.0])).tolist()
    [2.0]
    """
    if not len(x):
        return x
    return np.asarray(blas.dtrsv(factor, blas.dtrsv(factor, x, lower=1), lower=1, trans=1))


def symmetric_product(matrix: Array | SingleArray, x: Array) -> Array:
    """``matrix @ x`` for a symmetric matrix: half of it is read, which is what the product of a large one costs.

    >>> symmetric_product(np.array([[2.0, 1.0], [1.0, 3.0]]), np.array([1.0, 1.0])).tolist()
    [3.0, 4.0]
    """
    if not len(x):
        return x
    symv = blas.ssymv if matrix.dtype == np.float32 else blas.dsymv
    return np.asarray(symv(1.0, matrix.T if matrix.flags.c_contiguous else matrix, x), dtype=np.float64)


def _cholesky(A: Array, room: Array | None = None) -> Array:
    """Lower Cholesky factor of ``A + I``, by columns: the upper triangle of the room, by rows."""
    if room is None:
        shifted = np.array(A.T, order="F")
    else:
        for first in range(0, len(A), _TILE):
            behind = first + _TILE
            room[first:behind, behind:] = A[first:behind, behind:]
            block = room[first:behind, first:behind]
            block[:] = np.triu(A[first:behind, first:behind]) + np.tril(block, -1)
        shifted = room.T
    shifted[np.diag_indices_from(shifted)] += 1.0
    _factorise(shifted)
    return shifted


def _factorise(matrix: Array | SingleArray) -> None:
    """Overwrite the lower triangle of a matrix by columns by its Cholesky factor; what is above it stays."""
    if cholesky(matrix):
        raise np.linalg.LinAlgError("the compliance of the pairs is not positive semidefinite")
