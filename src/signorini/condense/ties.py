# SPDX-License-Identifier: BSD-3-Clause
"""Tied pairs: relative displacements that are zero whatever acts on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.linalg.lapack
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.sparse_rows import seen_by

_DEPENDENT = 1e-10  # of the largest: what is left of a row that follows from the others, squared


@dataclass(frozen=True, kw_only=True, eq=False)
class Ties:
    """``B_t z = 0`` for independent rows, one or more; where several meet at a node one may follow from the others.

    Attributes
    ----------
    rows : (t,) rows of the interface's B, normals and tangents of tied pairs
    B : (t, z) in terms of the free displacements
    """

    rows: IntArray
    B: sp.csr_array
    _gram: Array

    def shares(self, values: Array) -> Array:
        """``(B_t B_t^T)^-1 values``, (t, ...)."""
        solved: Array = scipy.linalg.cho_solve((self._gram, True), values)
        return solved

    def forces(self, residual: Array) -> Array:
        """Forces r_t of the ties with ``residual + B_t^T r_t`` as small as can be, (t,).

        Parameters
        ----------
        residual : (z,) what the other forces leave of equilibrium, ``f + B^T r - K z``
        """
        return -self.shares(seen_by(self.B, residual))

    def bear(self, forces: Array, residual: Array) -> Array:
        """What forces of the ties leave of equilibrium, (z,).

        Parameters
        ----------
        forces : (d, n) of all pairs, among which they are written
        residual : (z,) what the other forces leave, as of `forces`
        """
        tied = self.forces(residual)
        self.give(forces, tied)
        left: Array = residual + self.B.T @ tied
        return left

    def give(self, forces: Array, values: Array | float) -> None:
        """Write the forces of the ties, (t,) or one for all, among those of all pairs, (d, n)."""
        forces.reshape(-1)[self.rows] = values

    def closing(self, moved: Array) -> Array:
        """The smallest free displacements z with ``B_t z = -moved``, (z,); moved (t,) is what supports impose."""
        z: Array = -(self.B.T @ self.shares(moved))
        return z


def make_ties(B: sp.csr_array, rows: IntArray) -> Ties:
    """The ties of rows, of which those that are independent are chosen.

    Parameters
    ----------
    B : (d n, z) relative displacements of all pairs in terms of the free displacements
    rows : those of tied pairs that are not held by supports, one or more
    """
    own = sp.csr_array(B[rows])
    gram = (own @ own.T).toarray()
    size = np.sqrt(np.diag(gram))
    _, pivots, rank, _ = scipy.linalg.lapack.dpstrf(gram / np.outer(size, size), lower=1, tol=_DEPENDENT)
    chosen = np.sort(pivots[:rank] - 1)
    own = sp.csr_array(own[chosen])
    return Ties(rows=rows[chosen], B=own, _gram=np.linalg.cholesky((own @ own.T).toarray()))
