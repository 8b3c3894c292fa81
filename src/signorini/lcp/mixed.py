# SPDX-License-Identifier: BSD-3-Clause
"""Free variables: eliminated from a mixed problem, and put back into its solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.lcp.linear import Inverse, factorised


@dataclass(frozen=True, kw_only=True)
class WithoutFree:
    """The Schur complement of the free variables, an LCP in the others.

    Attributes
    ----------
    M, q : the reduced problem, ``M_cc - M_cf M_ff^-1 M_fc`` and ``q_c - M_cf M_ff^-1 q_f``
    free : (n,) mask of the free variables of the mixed problem
    """

    M: Any
    q: Array
    free: BoolArray
    rows: Any
    right: Array
    inverse: Inverse | None

    def back(self, z: Array) -> Array:
        """All variables, from a solution of the reduced problem."""
        whole = np.zeros(len(self.free))
        whole[~self.free] = z
        if self.inverse is not None:
            whole[self.free] = -self.inverse(self.right + self.rows @ z)
        return whole


def eliminate_free(M: Any, q: Array, free: BoolArray) -> WithoutFree | None:
    """Reduce ``w_f = 0`` (z_f free), ``0 <= z_c  _|_  w_c >= 0`` to an LCP; None where ``M_ff`` is singular.

    Parameters
    ----------
    M : (n, n) dense or CSR array; with free variables the reduced one is dense
    q : (n,) array
    free : (n,) mask

    Examples
    --------
    >>> M, q = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-3.0, -3.0])
    >>> reduced = eliminate_free(M, q, np.array([True, False]))
    >>> float(reduced.M[0, 0]), float(reduced.q[0])
    (1.5, -1.5)
    >>> print(reduced.back(np.array([1.0])))
    [1. 1.]
    """
    f, c = np.flatnonzero(free), np.flatnonzero(~free)
    if not len(f):
        return WithoutFree(M=M, q=q, free=free, rows=None, right=q[f], inverse=None)
    inverse = factorised(M[f][:, f])
    if inverse is None:
        return None
    rows = M[f][:, c].toarray() if sp.issparse(M) else M[np.ix_(f, c)]
    columns = inverse(rows) if len(c) else rows
    M_cf, M_cc = M[c][:, f], M[c][:, c]
    reduced = (M_cc.toarray() if sp.issparse(M) else M_cc) - M_cf @ columns
    return WithoutFree(M=reduced, q=q[c] - M_cf @ inverse(q[f]), free=free, rows=rows, right=q[f], inverse=inverse)
