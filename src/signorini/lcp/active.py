# SPDX-License-Identifier: BSD-3-Clause
"""The linear algebra of one complementary basis: ``z`` from the set of its positive components."""

from __future__ import annotations

import warnings

import numpy as np
import scipy.linalg as la

from signorini.arrays import Array, BoolArray
from signorini.lcp.residual import natural_residual, relative_sizes


def solve_on(M: Array, q: Array, active: BoolArray, *, refinements: int = 2) -> Array | None:
    """z with ``(M z + q)_i = 0`` where active and ``z_i = 0`` elsewhere; None where that system is singular.

    Rows and columns are scaled by their largest entries before the factorisation; the refinement takes the residual of
    the problem as posed.

    Examples
    --------
    >>> print(solve_on(np.array([[2.0, 1.0], [0.0, 2.0]]), np.array([-1.0, -2.0]), np.array([False, True])))
    [0. 1.]
    """
    z = np.zeros(len(q))
    A = np.flatnonzero(active)
    if not len(A):
        return z
    block = M[np.ix_(A, A)]
    rows = np.abs(block).max(axis=1)
    columns = np.abs(block / np.where(rows > 0, rows, 1.0)[:, None]).max(axis=0)
    if not (rows > 0).all() or not (columns > 0).all():
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", la.LinAlgWarning)  # a zero pivot is looked for below
        factors = la.lu_factor(block / rows[:, None] / columns, check_finite=False)
    if not np.abs(np.diag(factors[0])).min() > 0:
        return None
    x = np.zeros(len(A))
    for _ in range(1 + refinements):
        x = x - la.lu_solve(factors, (block @ x + q[A]) / rows, check_finite=False) / columns
    z[A] = x
    return z if np.isfinite(x).all() else None


def polish(M: Array, q: Array, z: Array, *, attempts: int = 3) -> Array:
    """The best of z and a few steps of the active-set Newton method started there, never below 0.

    A step solves for the basis ``z_i > w_i`` (both in the units of the residual's denominators); it is exact as soon as
    the basis is the right one. The result is judged by the natural residual and never worse than z.
    """
    best = np.maximum(z, 0.0)
    least = natural_residual(M, q, best).worst
    current = best
    for _ in range(attempts):
        share, w = relative_sizes(M, q, current)
        following = solve_on(M, q, share > w)
        if following is None:
            break
        current = np.maximum(following, 0.0)
        worst = natural_residual(M, q, current).worst
        if worst < least:
            best, least = current, worst
        if worst == 0.0:
            break
        current = following
    return best
