# SPDX-License-Identifier: BSD-3-Clause
"""One solution or several: a proof where the states can be tried one by one, otherwise a search from many starts.

Motions and forces of n pairs are one piecewise linear map of y = r - h with 4^n pieces (see `law`; more where the bound
of friction has further branches). Around every face between pieces of codimension two lie four of them, or three at a
kink of the bound, so that the map is one to one exactly if the determinants of all pieces have the same sign (then
every load and history has one solution).

References
----------
Kuhn, Loewen (1987), Piecewise affine bijections of R^n, Linear Algebra Appl. 96; Scholtes (2012), Introduction to
Piecewise Differentiable Equations, section 2.3.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.friction.certificate import certify
from signorini.friction.cone import cone_system
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED
from signorini.friction.newton import newton
from signorini.friction.plane.covering import follow
from signorini.friction.problem import CoulombProblem

FEW = 6
"""Pairs whose 4^n states are tried one by one; fewer where their friction has further branches."""

SAME = 1e-7
"""Two answers closer than this, relative to the data, are one."""

_PATHS, _GUESSES = 4, 24


def always_unique(problem: CoulombProblem) -> bool:
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
    ...     problem = CoulombProblem.of(W=W, b=np.zeros(2), friction=[mu], motions=np.zeros((2, 0)), scale=1.0)
    ...     print(mu, always_unique(problem))
    1.9 True
    2.1 False
    """
    return all(cone_system(problem, state).index == 1 for state in _states(problem))


def all_solutions(problem: CoulombProblem) -> list[Array]:
    """Every solution y of a problem of at most 6 pairs, by trying every state.

    Raises
    ------
    InputError
        See `countable`.
    """
    rest = np.zeros(2 * problem.pairs)
    return _certified(problem, (cone_system(problem, state).solve(rest) for state in _states(problem)))


def search_solutions(problem: CoulombProblem, *, seed: int = 0) -> list[Array]:
    """Solutions y that Newton's method and paths find from different starts; there may be more.

    Parameters
    ----------
    seed : of random states and of the weights of paths
    """
    return _certified(problem, _candidates(problem, seed))


def _candidates(problem: CoulombProblem, seed: int) -> Iterator[Array | None]:
    n, rng = problem.pairs, np.random.default_rng(seed)
    for code in (STICK, OPEN, SLIP_PLUS, SLIP_MINUS):
        yield newton(problem, np.full(n, code)).y
    for _ in range(_GUESSES):
        yield newton(problem, rng.integers(OPEN, SLIP_MINUS + 1, n)).y
    for turn in range(_PATHS):
        for covering in ("press",) if problem.floating else ("open", "press"):
            path = follow(problem, "open" if covering == "open" else "press", budget=20 * max(n, 5), seed=seed + turn)
            if path.end == "solution":
                yield newton(problem, path.state, near=path.y).y


def countable(problem: CoulombProblem) -> bool:
    """Whether the states are few enough to be tried one by one: 4^6."""
    return math.prod(map(len, _choices(problem))) <= 4**FEW


def _choices(problem: CoulombProblem) -> list[list[int]]:
    """The states of every pair."""
    found = []
    for closed, branches in zip(problem.closed, np.isfinite(problem.bound.kinks).sum(axis=0), strict=True):
        slips = (SLIP_PLUS, SLIP_MINUS) if closed == UNDECIDED else (int(closed),)
        held = [OPEN, STICK] if closed == UNDECIDED else [OPEN]
        found.append(held + [code + 2 * j for j in range(branches) for code in slips])
    return found


def _states(problem: CoulombProblem) -> Iterator[IntArray]:
    if not countable(problem):
        raise InputError(
            f"has {problem.pairs} pairs; expected at most {FEW}, whose states can be tried one by one (fewer where "
            "their friction has further branches)"
        )
    for combination in itertools.product(*_choices(problem)):
        yield np.array(combination, dtype=np.int64)


def distinct(candidates: Iterable[Array], scale: float) -> list[Array]:
    """The answers that differ, in their order.

    Parameters
    ----------
    scale : size of the data
    """
    found: list[Array] = []
    for y in candidates:
        if all(np.abs(y - other).max(initial=0.0) > SAME * (scale or 1.0) for other in found):
            found.append(y)
    return found


def _certified(problem: CoulombProblem, candidates: Iterator[Array | None]) -> list[Array]:
    return distinct((y for y in candidates if y is not None and certify(problem, y) <= 1e-10), problem.scale)
