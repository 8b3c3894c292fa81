# SPDX-License-Identifier: BSD-3-Clause
"""Principal pivotal transform: the same problem with the roles of some z_i and w_i exchanged."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.lcp.linear import factorised


def principal_transform(M: Array, q: Array, swapped: BoolArray) -> tuple[Array, Array] | None:
    """(M', q') of the LCP in which z_i and w_i are exchanged where ``swapped``; None where that block is singular.

    Examples
    --------
    >>> M, q = principal_transform(np.array([[2.0]]), np.array([-4.0]), np.array([True]))
    >>> float(M[0, 0]), float(q[0])
    (0.5, 2.0)
    """
    A, B = np.flatnonzero(swapped), np.flatnonzero(~swapped)
    if not len(A):
        return M, q
    solved = factorised(M[np.ix_(A, A)])
    if solved is None:
        return None
    inverse = solved(np.eye(len(A)))
    turned, vector = np.empty_like(M), np.empty_like(q)
    coupling = M[np.ix_(B, A)] @ inverse
    turned[np.ix_(A, A)] = inverse
    turned[np.ix_(A, B)] = -inverse @ M[np.ix_(A, B)]
    turned[np.ix_(B, A)] = coupling
    turned[np.ix_(B, B)] = M[np.ix_(B, B)] - coupling @ M[np.ix_(A, B)]
    vector[A], vector[B] = -inverse @ q[A], q[B] - coupling @ q[A]
    return turned, vector
