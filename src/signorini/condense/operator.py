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
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, lapack

from signorini.arrays import Array, BoolArray, frozen, read_only
from signorini.condense.basis import make_basis
from signorini.condense.body_blocks import inverse_of
from signorini.errors import InputError

SingleArray = NDArray[np.float32]
Precision = TypeVar("Precision", Array, SingleArray)

UNRESISTED = 1e-14
"""Stiffness, relative to the interface stiffness D, below which a motion counts as rigid."""

_SOFTNESS = 0.1  # of the mean diagonal of A


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
    def of_compliance(cls, A: Array, motions: Array, R: Array) -> InterfaceOperator:
        """The interface of a given compliance A, (m, m), symmetric, with ``A R = 0``; nothing is copied.

        Parameters
        ----------
        motions : (k, m) rigid motions as the pairs see them, scaled

        Raises
        ------
        LinAlgError
            Where I + A is not positive definite.
        """
        result = cls(motions=motions, R=R)._knowing(A=A)
        _ = result.factor
        return result

    def _knowing(self, **known: Array) -> InterfaceOperator:
        """This operator with what is given where cached properties keep their values."""
        self.__dict__.update(known)
        return self

    @cached_property
    def A(self) -> Array:
        """(m, m) Compliance: motion per force, on what forces can move without a rigid motion."""
        G = np.asfortranarray(self.R @ self.R.T - self.W)
        G[np.diag_indices(len(G))] += 1.0
        factor, failed = lapack.dpotrf(G, lower=1, overwrite_a=1, clean=0)
        if failed or np.diag(factor).min(initial=1.0) ** 2 <= UNRESISTED:
            raise InputError(
                "has an eigenvalue 1 (a motion that nothing resists) beyond the rigid motions given; add that motion",
                where=("W",),
            )
        A = inverse_of(factor, overwrite=True).T
        A[np.diag_indices(len(A))] -= 1.0
        A.flags.writeable = False
        return A

    @cached_property
    def factor(self) -> Array:
        """(m, m) Lower Cholesky factor of I + A, by columns."""
        return _cholesky(self.A, 1.0)

    @cached_property
    def W(self) -> Array:
        """(m, m) InterfaceOperator form, symmetric, spectrum in [0, 1]."""
        W = inverse_of(self.factor).T
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
    def single(self) -> tuple[SingleArray, SingleArray, float]:
        """A and the lower Cholesky factor of ``A + softness I``, (m, m), in single precision; softness: some of A."""
        A = self.A.astype(np.float32)
        softness = _SOFTNESS * float(self.A.trace()) / max(1, len(A)) or 1.0
        return A, _cholesky(A, softness), softness

    def free_motion(self, b: Array) -> Array:
        """(m,) Motion c of the pairs under the load alone, without its rigid part."""
        return b + self.A @ b - self.R @ (self.R.T @ b)

    def load(self, free: Array, resultant: Array) -> Array:
        """b, (m,), of a free motion, (m,), whose rigid part does not count, and resultants ``R' b``, (k,).

        >>> held = np.zeros((1, 0))
        >>> InterfaceOperator.of_form(np.array([[0.5]]), held).load(np.array([3.0]), np.zeros(0)).round(12).tolist()
        [1.5]
        """
        return softened(self.factor, free - self.R @ (self.R.T @ free)) + self.R @ resultant


def softened(factor: Array | SingleArray, x: Array) -> Array:
    """``(softness I + A)^-1 x`` by the lower Cholesky factor of that matrix, in its precision.

    >>> softened(np.array([[2.0]]), np.array([8.0])).tolist()
    [2.0]
    """
    if not len(x):
        return x
    trsv = blas.strsv if factor.dtype == np.float32 else blas.dtrsv
    return np.asarray(trsv(factor, trsv(factor, x, lower=1), lower=1, trans=1), dtype=np.float64)


def symmetric_product(matrix: Array | SingleArray, x: Array) -> Array:
    """``matrix @ x`` for a symmetric matrix: half of it is read, which is what the product of a large one costs.

    >>> symmetric_product(np.array([[2.0, 1.0], [1.0, 3.0]]), np.array([1.0, 1.0])).tolist()
    [3.0, 4.0]
    """
    if not len(x):
        return x
    symv = blas.ssymv if matrix.dtype == np.float32 else blas.dsymv
    return np.asarray(symv(1.0, matrix.T if matrix.flags.c_contiguous else matrix, x), dtype=np.float64)


def _cholesky(A: Precision, softness: float) -> Precision:
    """Lower Cholesky factor of ``A + softness I``, by columns, in the precision of A."""
    shifted = np.array(A.T, order="F")
    shifted[np.diag_indices_from(shifted)] += softness
    if not len(shifted):
        return shifted
    potrf = lapack.spotrf if A.dtype == np.float32 else lapack.dpotrf
    factor, failed = potrf(shifted, lower=1, overwrite_a=1, clean=0)
    if failed:
        raise np.linalg.LinAlgError("the compliance of the pairs is not positive semidefinite")
    return np.asarray(factor)
