# SPDX-License-Identifier: BSD-3-Clause
"""Tied pairs: relative displacements that are zero whatever acts on them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.linalg.lapack
import scipy.sparse as sp

from signorini.arrays import Array, IntArray, distinct
from signorini.sparse_rows import chosen_columns, seen_by, transposed

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

    def pushes(self, forces: Array) -> tuple[IntArray, Array]:
        """Free displacements (k,) that ties see, and ``B_t^T r`` of forces (t,) there."""
        numbers, B = self._seen
        return numbers, transposed(B) @ forces

    @cached_property
    def _seen(self) -> tuple[IntArray, sp.csr_array]:
        """The free displacements that ties see, and B in terms of them alone."""
        numbers = distinct(self.B.indices)
        return numbers, chosen_columns(self.B, numbers)

    def give(self, forces: Array, values: Array | float) -> None:
        """Write the forces of the ties, (t,) or one for all, among those of all pairs, (d, n)."""
        forces.reshape(-1)[self.rows] = values

    def closing(self, moved: Array) -> tuple[IntArray, Array]:
        """The smallest free displacements with ``B_t z = -moved``: numbers and values (k,) of those that are not zero.

        Parameters
        ----------
        moved : (t,) what supports impose
        """
        return self.pushes(-self.shares(moved))


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
