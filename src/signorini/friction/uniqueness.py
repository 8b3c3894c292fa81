# SPDX-License-Identifier: BSD-3-Clause
"""What can be said about other solutions: the index of a state, and a friction below which there is one solution."""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray
from signorini.friction.cone import cone_system
from signorini.friction.newton import admissible
from signorini.friction.posed import PosedContact
from signorini.friction.problem import CoulombProblem

_SLIDES = 1e-12  # of the largest motion of a pair: what is no rounding


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
    >>> problem = CoulombProblem.of(W=W, b=W @ [-1.0, 2.5], friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> [index(problem, np.array([state])) for state in (0, 1, 3)]
    [1, 1, -1]
    """
    return cone_system(problem, admissible(problem, state)).index


def mu_low(problem: PosedContact) -> float | None:
    """Friction below which contact forces are unique for every load and history; None where no bound is known.

    With the condensed stiffness ``S = W^-1 - I`` and compliance ``A`` (the inverse of S on what is no rigid motion),
    and rho the spectral radius::

        mu_low = 2 / sqrt(min(rho(|S_nn| |A_tt|), rho(E S_nn) rho(A_tt E^-1))),    E = diag(S_nn)^-1

    where ``|.|`` takes the absolute value of every entry, in space the spectral norm of every 2 x 2 block of A_tt. Two
    solutions differ by motions h and forces r = S h with ``h'S h <= mu sum |r_n| |h_t|`` over the pairs that rub
    (friction dissipates the most that it can); r_n and h_t are products of rows n of S^.5 and t of A^.5 with one vector
    S^.5 h, and those rows are orthogonal. The sum is at most half of rho times the square of that vector by either
    term, the second from ``2 |r_n h_t| <= c e r_n^2 + h_t^2 / (c e)``. Bodies that contact alone holds obey the same
    where their free motions slide no pair that rubs; where one does, they slide as a whole under some load, and no
    friction is small enough.

    The bound is 0.1 to 1 times the sharp one on plane problems small enough to enumerate. Above it: not guaranteed to
    be unique, no more.

    Returns
    -------
    mu_low : compare with the largest slope of the bound of friction, which is the largest friction in Coulomb's law;
        ``inf`` where no pair can slip against friction

    Examples
    --------
    >>> W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    >>> problem = CoulombProblem.of(W=W, b=W @ [-1.0, 2.5], friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> round(mu_low(problem), 6)
    1.732051
    """
    n = problem.pairs
    moves = ~problem.image.still[n:]
    d = len(moves) // n if n else 1
    rubs = np.flatnonzero((problem.bound.slopes[0] > 0) & moves.reshape(d, n).any(axis=0))
    if not len(rubs):
        return np.inf
    tangents = (rubs + n * np.arange(1, d + 1)[:, None]).T.ravel()
    R = problem.image.R
    if np.abs(R[tangents]).max(initial=0.0) > _SLIDES * np.abs(R).max(initial=0.0):
        return None
    kept = np.concatenate([np.full(n, True), moves])
    S = _inverse(problem.W[np.ix_(kept, kept)])
    if S is None:
        return 0.0
    S[np.diag_indices(len(S))] -= 1.0
    stiffness = S[np.ix_(rubs, rubs)]
    compliance = problem.image.A[np.ix_(tangents, tangents)]
    sizes = np.linalg.norm(compliance.reshape(len(rubs), d, len(rubs), d), ord=2, axis=(1, 3))
    root = np.sqrt(np.diag(stiffness))
    stiffest = np.linalg.eigvalsh(stiffness / root / root[:, None])[-1]
    root = np.repeat(root, d)
    softest = np.linalg.eigvalsh(compliance * root * root[:, None])[-1]
    radius = np.abs(np.linalg.eigvals(np.abs(stiffness) @ sizes)).max()
    return float(2.0 / np.sqrt(min(radius, stiffest * softest)))


def _inverse(W: Array) -> Array | None:
    """Inverse of a symmetric positive definite matrix, None where it is singular: some pair repeats another."""
    factor, failed = lapack.dpotrf(W, lower=1, clean=1)
    if failed or np.diag(factor).min() ** 2 < 1e-13:
        return None
    factor, _ = lapack.dpotri(factor, lower=1)
    return np.asarray(np.tril(factor) + np.tril(factor, -1).T, dtype=np.float64)
