# SPDX-License-Identifier: BSD-3-Clause
"""What can be said about other solutions: the index of a state, and a friction below which there is one solution."""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray
from signorini.friction.cone import cone_system
from signorini.friction.newton import admissible
from signorini.friction.problem import CoulombProblem


def index(problem: CoulombProblem, state: IntArray) -> int:
    """Sign of the determinant of a state's system, relative to that of all pairs sticking: +1, -1, or 0 if singular.

    For held bodies the indices of all solutions sum to +1 (none of them on a wall between states). So a solution of
    index -1 proves at least two more; +1 proves nothing. The path method always ends at +1.

    Parameters
    ----------
    problem : the problem
    state : (n,) states, usually those of a solution

    Examples
    --------
    One node with stiffness k_n = k_t = 2, coupling 1 and much friction: sliding with friction opposed is unstable.

    >>> W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    >>> problem = CoulombProblem(W=W, b=W @ [-1.0, 2.5], friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> [index(problem, np.array([state])) for state in (0, 1, 3)]
    [1, 1, -1]
    """
    return cone_system(problem, admissible(problem, state)).index


def mu_low(problem: CoulombProblem) -> float | None:
    """A friction coefficient below which the solution is unique for every load and history; None for floating bodies.

    With the condensed stiffness ``S = W^-1 - I`` and compliance ``A = S^-1``, and rho the spectral radius::

        mu_low = 2 / sqrt(rho(|S_nn| |A_tt|))      entrywise absolute values

    A singular state needs a motion h with ``h'S h = sum mu s r_n h_t`` over slipping pairs; the rows n of S^.5 and t of
    S^-.5, whose products with one vector those r_n and h_t are, are orthogonal. The bound is 0.1 to 1 times the sharp
    one on problems small enough to enumerate. Above it: not guaranteed to be unique, no more.

    Returns
    -------
    mu_low : compare with the largest slope of the bound of friction, which is the largest friction in Coulomb's law;
        ``inf`` where no pair can slip against friction

    Examples
    --------
    >>> W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    >>> problem = CoulombProblem(W=W, b=W @ [-1.0, 2.5], friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> round(mu_low(problem), 6)
    1.732051
    """
    if problem.floating:
        return None
    n = problem.pairs
    rubs = np.flatnonzero((problem.mu > 0) & ~problem.locked)
    if not len(rubs):
        return np.inf
    moves = np.concatenate([np.full(n, True), ~problem.locked])
    S = _inverse(problem.W[np.ix_(moves, moves)])
    if S is None:
        return 0.0
    S[np.diag_indices(len(S))] -= 1.0
    stiffness = np.abs(S[np.ix_(rubs, rubs)])
    compliance = np.abs(problem.interface.A[np.ix_(n + rubs, n + rubs)])
    radius = np.abs(np.linalg.eigvals(stiffness @ compliance)).max()
    return float(2.0 / np.sqrt(radius))


def _inverse(W: Array) -> Array | None:
    """Inverse of a symmetric positive definite matrix, None where it is singular: some pair repeats another."""
    factor, failed = lapack.dpotrf(W, lower=1, clean=1)
    if failed or np.diag(factor).min() ** 2 < 1e-13:
        return None
    factor, _ = lapack.dpotri(factor, lower=1)
    return np.asarray(np.tril(factor) + np.tril(factor, -1).T, dtype=np.float64)
