# SPDX-License-Identifier: BSD-3-Clause
"""The interface without its load: one factorisation that every load, friction and state shares.

Equilibrium reads ``G h - W r = b`` with ``G = I - W``. With R an orthonormal basis of the rigid motions (W R = R) and
``T = (G + R R')^-1``, regular whether bodies float or not, the same in forces is::

    h = A r + c + R a,    R'(r + b) = 0,    A = T - I,    c = T b - R R'b

so that open pairs (r = 0) take no part in the systems to solve.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, lapack, qr

from signorini.arrays import Array, frozen
from signorini.errors import InputError

SingleArray = NDArray[np.float32]

UNRESISTED = 1e-14
"""Stiffness, relative to the interface stiffness D, below which a motion counts as rigid."""


@dataclass(frozen=True, kw_only=True)
class Interface:
    """Compliance and rigid motions of a contact interface, scaled; factorised once, when first asked.

    Parameters
    ----------
    W : (2n, 2n) scaled image-form compliance, spectrum in [0, 1]
    motions : (2n, k) rigid motions seen by the pairs, W R = R

    Examples
    --------
    >>> Interface(W=np.diag([0.5, 0.5]), motions=np.zeros((2, 0))).A.round(12).tolist()
    [[1.0, 0.0], [0.0, 1.0]]
    """

    W: Array
    motions: Array

    @classmethod
    def none(cls) -> Interface:
        """An interface without pairs."""
        return cls(W=np.zeros((0, 0)), motions=np.zeros((0, 0)))

    @classmethod
    def exact(cls, W: Array, motions: Array) -> Interface:
        """The interface with ``W R = R`` to rounding, whatever the accuracy of W: ``P W P + R R'``, P = I - R R'.

        A body that floats may travel far beyond its elastic motion, which multiplies the error of W R by as much.

        Raises
        ------
        InputError
            Where W is not symmetric to 1e-12, or W R differs from R by more than 1e-8 of the largest motion.
        """
        if np.abs(W - W.T).max(initial=0.0) > 1e-12:
            raise InputError("is not symmetric", where=("W",))
        R = cls(W=W, motions=motions).R
        if not R.size:
            return cls(W=W, motions=motions)
        wrong = np.abs(W @ R - R).max()
        if wrong > 1e-8 * np.abs(R).max():
            raise InputError(f"are no rigid motions: W R differs from R by {wrong:.1e}", where=("motions",))
        elastic = W - R @ (R.T @ W)
        elastic -= (elastic @ R) @ R.T
        return cls(W=frozen((elastic + elastic.T) / 2 + R @ R.T), motions=motions)

    @classmethod
    def known(cls, W: Array, motions: Array, A: Array) -> Interface:
        """The interface where A is known and ``W R = R`` to rounding; all read-only."""
        result = cls(W=W, motions=motions)
        result.__dict__["A"] = A  # where the cached property keeps its value
        return result

    @cached_property
    def R(self) -> Array:
        """(2n, k) Orthonormal rigid motions."""
        if not self.motions.size:
            return self.motions
        Q, triangle = qr(self.motions, mode="economic")
        diagonal = np.abs(np.diag(triangle))
        if len(diagonal) < self.motions.shape[1] or diagonal.min() <= 1e-10 * diagonal.max():
            raise InputError("rigid motions are linearly dependent; expected independent columns", where=("motions",))
        return np.asarray(Q, dtype=np.float64)

    @cached_property
    def A(self) -> Array:
        """(2n, 2n) Compliance: motion per force, on what forces can move without a rigid motion."""
        G = np.asfortranarray(self.R @ self.R.T - self.W)
        G[np.diag_indices(len(G))] += 1.0
        factor, failed = lapack.dpotrf(G, lower=1, overwrite_a=1, clean=0)
        if failed or np.diag(factor).min(initial=1.0) ** 2 <= UNRESISTED:
            raise InputError(
                "has an eigenvalue 1 (a motion that nothing resists) beyond the rigid motions given; add that motion",
                where=("W",),
            )
        factor, _ = lapack.dpotri(factor, lower=1, overwrite_c=1)
        A = np.tril(factor)
        A += np.tril(factor, -1).T
        A[np.diag_indices(len(A))] -= 1.0
        return np.ascontiguousarray(A, dtype=np.float64)

    @cached_property
    def single(self) -> tuple[SingleArray, SingleArray]:
        """A and W in single precision, (2n, 2n) each: half as long to read, where a few digits do."""
        return self.A.astype(np.float32), self.W.astype(np.float32)

    def free_motion(self, b: Array) -> Array:
        """(2n,) Motion c of the pairs under the load alone, without its rigid part."""
        return b + self.A @ b - self.R @ (self.R.T @ b)


def symmetric_product(matrix: Array | SingleArray, x: Array) -> Array:
    """``matrix @ x`` for a symmetric matrix: half of it is read, which is what the product of a large one costs.

    >>> symmetric_product(np.array([[2.0, 1.0], [1.0, 3.0]]), np.array([1.0, 1.0])).tolist()
    [3.0, 4.0]
    """
    if not len(x):
        return x
    symv = blas.ssymv if matrix.dtype == np.float32 else blas.dsymv
    return np.asarray(symv(1.0, matrix.T if matrix.flags.c_contiguous else matrix, x), dtype=np.float64)
