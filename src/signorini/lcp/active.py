# SPDX-License-Identifier: BSD-3-Clause
"""The linear algebra of one complementary basis: ``z`` from the set of its positive components."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.lcp.linear import factorised, with_diagonal
from signorini.lcp.problem import LCP
from signorini.lcp.residual import Matrix

POLISHED_RESIDUAL = 1e-12  # natural residual below which nothing is to be gained
POLISHING_STEPS = 3  # of Newton's method: a basis nearly found is right after the first


def solve_on(
    M: Matrix, q: Array, active: BoolArray, *, refinements: int = 2, shift: Array | None = None
) -> Array | None:
    """z with ``(M z + q)_i = 0`` where active and ``z_i = 0`` elsewhere; None where that system is singular.

    Rows and columns are scaled by their largest entries before the factorisation; the refinement takes the residual of
    the problem as posed.

    Parameters
    ----------
    M, q : (n, n) array or CSR array, (n,)
    active : (n,) mask
    refinements : steps of iterative refinement
    shift : (n,) what is added to the diagonal of M

    Examples
    --------
    >>> print(solve_on(np.array([[2.0, 1.0], [0.0, 2.0]]), np.array([-1.0, -2.0]), np.array([False, True])))
    [0. 1.]
    """
    z = np.zeros(len(q))
    A = np.flatnonzero(active)
    if not len(A):
        return z
    block = M[np.ix_(A, A)] if isinstance(M, np.ndarray) else M[A][:, A]
    if shift is not None:
        block = with_diagonal(block, shift[A])
    inverse = factorised(block)
    if inverse is None:
        return None
    x = np.zeros(len(A))
    for _ in range(1 + refinements):
        x = x - inverse(block @ x + q[A])
    z[A] = x
    return z if np.isfinite(x).all() else None


def polish(problem: LCP, M: Matrix, z: Array, *, active: BoolArray | None = None) -> tuple[Array, float]:
    """The best of z and a few steps of the active-set Newton method started there, never below 0, with its residual.

    A step solves for the given basis first, then for ``z_i > w_i`` (both as shares, see ``natural_residual``); it is
    exact as soon as that is the right one. Of candidates within rounding the one is best whose rows are balanced each
    by its own terms, too.

    Parameters
    ----------
    problem : that z is a candidate of
    M : the matrix of the problem with its entries, as a dense or CSR array
    z : (n,)
    active : (n,) the basis to try first, None for that of z
    """
    best = np.maximum(z, 0.0)
    least, own = problem.yardstick.unforgiving(best)
    for step in range(POLISHING_STEPS):
        if own <= POLISHED_RESIDUAL:
            break
        if active is None:
            share, w = problem.yardstick.shares(best)
            active = share > w
        found = solve_on(M, problem.q, active)
        z = np.full(problem.n, np.nan) if found is None else np.maximum(found, 0.0)
        worst, its_own = problem.yardstick.unforgiving(z)
        if worst < max(least, POLISHED_RESIDUAL) and (least > POLISHED_RESIDUAL or its_own < own):
            best, least, own = z, worst, its_own
        elif step > 0:
            break
        active = None
    return best, least
