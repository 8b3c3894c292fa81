# SPDX-License-Identifier: BSD-3-Clause
"""One solution or several: a bound below which there is one, a proof by all states, a search from many starts.

In the plane motions and forces of n pairs are one piecewise linear map of y = r - h with 4^n pieces (see `law.pair`;
more where the bound of friction has further branches). Around every face between pieces of codimension two lie four of
them, or three at a kink of the bound, so that the map is one to one exactly if the determinants of all pieces have the
same sign (then every load and history has one solution).

References
----------
Kuhn, Loewen (1987), Piecewise affine bijections of R^n, Linear Algebra Appl. 96; Scholtes (2012), Introduction to
Piecewise Differentiable Equations, section 2.3.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.friction.certificate import certify
from signorini.friction.linear import Equilibrium
from signorini.friction.newton import by_states, in_states, searched, y_in_states
from signorini.friction.plane.covering import Covering, follow_covering
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK
from signorini.linalg.shared_dense import cholesky, inverse_of_cholesky

COUNTED_PAIRS = 6
"""Pairs whose 4^n states are tried one by one; fewer where their friction has further branches."""

SAME_ANSWER_TOL = 1e-7
"""Of the data: two answers closer than this are one."""

PATHS = 4
"""In the plane: paths of each covering."""

GUESSES = 24
"""States at random from which other solutions are looked for."""

FEW_PAIRS_GUESSES = 100
"""States at random in space of few pairs."""

TURNS = 8
"""Directions of slip in which all pairs start in space."""

_FEW_PAIRS = 10  # pairs
_SLIDE_TOL = 1e-12  # of the largest motion of a pair: what is no rounding
_CERTIFIED = 1e-10  # of the data: `certify` of an answer
_SLIPPING = 1e3  # of the size of data: y of a pair that slips
_ALIKE = (STICK, OPEN, SLIP_PLUS, SLIP_MINUS)  # states in which all pairs start in the plane


def mu_low(problem: ContactProblem) -> float | None:
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
    >>> problem = ContactProblem.of(W=W, b=W @ [-1.0, 2.5], friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> round(mu_low(problem), 6)
    1.732051
    """
    n, d = problem.pairs, problem.directions - 1
    rubs = np.flatnonzero((problem.mu > 0) & ~problem.locked.all(axis=0))
    if not len(rubs):
        return np.inf
    tangents = (rubs + n * np.arange(1, d + 1)[:, None]).T.ravel()
    R = problem.image.R
    if np.abs(R[tangents]).max(initial=0.0) > _SLIDE_TOL * np.abs(R).max(initial=0.0):
        return None
    kept = np.concatenate([np.full(n, True), ~problem.locked.ravel()])
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


def always_unique(problem: ContactProblem) -> bool:
    """Whether every load and every history has exactly one solution: all states have the same orientation.

    Raises
    ------
    InputError
        For more than 6 pairs, or too many states of fewer; see `countable`.

    Examples
    --------
    One node with stiffness k_n = k_t = 2, coupling 1: unique up to friction 2.

    >>> W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    >>> for mu in (1.9, 2.1):
    ...     problem = ContactProblem.of(W=W, b=np.zeros(2), friction=[mu], motions=np.zeros((2, 0)), scale=1.0)
    ...     print(mu, always_unique(problem))
    1.9 True
    2.1 False
    """
    return all(in_states(problem, state).index == 1 for state in _states(problem))


def all_solutions(problem: ContactProblem) -> list[Array]:
    """Every solution y of a problem of at most 6 pairs, by trying every state.

    Raises
    ------
    InputError
        See `countable`.
    """
    rest = np.zeros((2, problem.pairs))
    return _certified(problem, (y_in_states(in_states(problem, state), rest) for state in _states(problem)))


def search_solutions(problem: ContactProblem) -> list[Array]:
    """Solutions y, (d, n), that Newton's method finds from different starts, and paths in the plane; there may be more.

    It starts with all pairs sticking, open, or slipping in one direction, then with states and directions at random.

    Examples
    --------
    One pair of much friction in space: it sticks, slips, or is open, and all three are in equilibrium.

    >>> W = np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 2.0]]))
    >>> b = W @ [-1.0, 2.5, 0.0]
    >>> problem = ContactProblem.of(W=W, b=b, friction=[3.0], motions=np.zeros((3, 0)), scale=1.0)
    >>> sorted(round(float(y[0, 0]), 6) for y in search_solutions(problem))
    [-0.166667, 0.5, 1.0]
    """
    if problem.piecewise_linear:
        return _certified(problem, _from_states(problem))
    form = Equilibrium(problem=problem)
    return _certified(problem, (searched(form, problem.law.tangent(start)).y for start in _starts(problem)))


def starts(problem: ContactProblem) -> int:
    """How many starts `search_solutions` tries."""
    if problem.piecewise_linear:
        return len(_ALIKE) + GUESSES + PATHS * len(_coverings(problem))
    return 2 + TURNS + _guesses(problem)


def _guesses(problem: ContactProblem) -> int:
    return FEW_PAIRS_GUESSES if not problem.piecewise_linear and problem.pairs <= _FEW_PAIRS else GUESSES


def _coverings(problem: ContactProblem) -> tuple[Covering, ...]:
    return ("press",) if problem.floating else ("open", "press")


def _from_states(problem: ContactProblem) -> Iterator[Array]:
    n, rng = problem.pairs, np.random.default_rng(0)
    for code in _ALIKE:
        yield by_states(problem, np.full(n, code)).y
    for _ in range(GUESSES):
        yield by_states(problem, rng.integers(OPEN, SLIP_MINUS + 1, n)).y
    for seed in range(PATHS):
        for covering in _coverings(problem):
            path = follow_covering(problem, covering, budget=20 * max(n, 5), seed=seed)
            if path.end == "solution":
                yield by_states(problem, path.state, near=path.y).y


def _starts(problem: ContactProblem) -> Iterator[Array]:
    """(d, n) y of states: normal part 1 where a pair presses, tangential part far along the friction where it slips."""
    n, d, rng = problem.pairs, problem.directions, np.random.default_rng(0)
    axis, none = np.ones((1, n)), np.zeros((d - 1, n))
    yield np.concatenate([axis, none])
    yield np.concatenate([-axis, none])
    for angle in 2.0 * np.pi / TURNS * np.arange(TURNS):
        yield np.concatenate([axis, _SLIPPING * np.array([[np.cos(angle)], [np.sin(angle)]])[: d - 1] * axis])
    for _ in range(_guesses(problem)):
        state, angle = rng.integers(0, 3, n), rng.uniform(0.0, 2.0 * np.pi, n)
        slip = np.where(state == 2, _SLIPPING, 0.0) * np.stack([np.cos(angle), np.sin(angle)])[: d - 1]
        yield np.concatenate([np.where(state == 0, -1.0, 1.0)[None], slip])


def countable(problem: ContactProblem) -> bool:
    """Whether the states of the pairs are few enough to be tried one by one: 4^6; never in space."""
    return problem.piecewise_linear and math.prod(map(len, _choices(problem))) <= 4**COUNTED_PAIRS


def _choices(problem: ContactProblem) -> list[list[int]]:
    """The states of every pair."""
    return [[OPEN, *problem.closed_states(pair)] for pair in range(problem.pairs)]


def _states(problem: ContactProblem) -> Iterator[IntArray]:
    if not countable(problem):
        raise InputError(
            f"has {problem.pairs} pairs; expected at most {COUNTED_PAIRS}, whose states can be tried one by one (fewer "
            "where their friction has further branches)"
        )
    for combination in itertools.product(*_choices(problem)):
        yield np.array(combination, dtype=np.int64)


def _certified(problem: ContactProblem, candidates: Iterator[Array | None]) -> list[Array]:
    """The certified answers that differ, in their order."""
    found: list[Array] = []
    for y in candidates:
        if y is None or certify(problem, y) > _CERTIFIED:
            continue
        if all(np.abs(y - other).max(initial=0.0) > SAME_ANSWER_TOL * (problem.scale or 1.0) for other in found):
            found.append(y)
    return found


def _inverse(W: Array) -> Array | None:
    """Inverse of a symmetric positive definite matrix, None where it is singular: some pair repeats another."""
    factor = np.array(W, order="F")
    if cholesky(factor) or np.diag(factor).min(initial=1.0) ** 2 < 1e-13:
        return None
    return inverse_of_cholesky(factor, overwrite=True)
