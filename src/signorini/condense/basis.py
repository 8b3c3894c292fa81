# SPDX-License-Identifier: BSD-3-Clause
"""An orthonormal basis of the rigid motions that the pairs see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from signorini.arrays import Array
from signorini.condense.body_blocks import DEPENDENT
from signorini.dense import solve_triangular
from signorini.linalg._dense_tiles import mirror
from signorini.linalg.shared_dense import add_product


@dataclass(frozen=True, kw_only=True, eq=False)
class Basis:
    """``N = R T`` of rigid motions N.

    Attributes
    ----------
    R : (n, k) orthonormal
    triangle : (k, k) T, upper
    """

    R: Array
    triangle: Array

    def coefficients(self, resultant: Array) -> Array:
        """``R^T b`` of any b with the resultants ``N^T b``, both (k,)."""
        return solve_triangular(self.triangle, resultant, transposed=True)

    def project(self, A: Array) -> Array:
        """Overwrite a symmetric A, by rows, by ``P A P``, P = I - R R^T, and give back ``P A R`` as it was, (n, k).

        >>> A = np.array([[2.0, 1.0], [1.0, 3.0]])
        >>> np.abs(make_basis(np.array([[0.0], [1.0]])).project(A)).round(12).tolist(), A.round(12).tolist()
        ([[1.0], [0.0]], [[2.0, 0.0], [0.0, 0.0]])
        """
        leaning: Array = A @ self.R
        if not self.R.size:
            return leaning
        leaning -= self.R @ (self.R.T @ leaning)
        for _ in range(2):  # bodies may travel far along R
            add_product(A.T, -(A.T @ self.R), self.R.T)
            add_product(A.T, -self.R, (A @ self.R).T)
        mirror(A, 0, len(A))
        return leaning


def make_basis(motions: Array) -> Basis:
    """Factorise; rows of motions that are exactly zero stay so.

    Parameters
    ----------
    motions : (n, k) N

    Raises
    ------
    LinAlgError
        If they are dependent: the pairs do not see a motion.

    Examples
    --------
    >>> basis = make_basis(np.array([[3.0], [4.0]]))
    >>> np.abs(basis.R).round(12).tolist(), np.abs(basis.coefficients(np.array([10.0]))).round(12).tolist()
    ([[0.6], [0.8]], [2.0])
    """
    R, triangle = scipy.linalg.qr(motions, mode="economic") if motions.size else (motions.copy(), np.zeros((0, 0)))
    size = np.abs(np.diag(triangle))
    if len(size) < motions.shape[1] or size.min(initial=1.0) <= DEPENDENT * size.max(initial=0.0):
        raise np.linalg.LinAlgError("the pairs do not see a rigid motion")
    R[~motions.any(axis=1)] = 0.0
    return Basis(R=R, triangle=triangle)
