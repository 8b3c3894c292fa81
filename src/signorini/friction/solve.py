# SPDX-License-Identifier: BSD-3-Clause
"""Solve the condensed Coulomb problem: the methods in their order, and the words for what came out."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.errors import InputError
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, UNDECIDED, split, states
from signorini.friction.newton import Candidate, newton
from signorini.friction.problem import CoulombProblem
from signorini.friction.result import Attempt, CoulombResult, Outcome


def solve_coulomb(problem: CoulombProblem, start: IntArray | None = None) -> CoulombResult:
    """Solve ``G h - W r = b`` in Coulomb's law.

    Parameters
    ----------
    problem : the problem
    start : (n,) states of the previous solution, or None to start with every pair sticking

    Raises
    ------
    InputError
        Where ``start`` does not fit.

    Examples
    --------
    >>> problem = CoulombProblem(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> result = solve_coulomb(problem)
    >>> result.outcome, result.normal_force.tolist(), result.tangential_force.tolist(), result.slip.round(12).tolist()
    ('solved', [2.0], [-0.6], [0.4])
    """
    _check_start(problem, start)
    if problem.pairs == 0:
        return _solved(problem, Candidate.nothing(), ())
    end = newton(problem, start)
    if end.residual <= 1e-10:
        return _solved(problem, end, (end.attempt,))
    return _unsolved(problem, "not_found", (end.attempt,), None, f"Newton ended without a solution: {end.attempt.end}.")


def _check_start(problem: CoulombProblem, start: IntArray | None) -> None:
    if start is None:
        return
    found = np.asarray(start)
    if found.shape != (problem.pairs,) or not np.isin(found, range(UNDECIDED, SLIP_MINUS + 1)).all():
        raise InputError(f"expected {problem.pairs} states between {UNDECIDED} and {SLIP_MINUS}", where=("start",))


def _solved(problem: CoulombProblem, end: Candidate, trace: tuple[Attempt, ...]) -> CoulombResult:
    assert end.y is not None
    n = problem.pairs
    h, r = split(end.y, problem.mu)
    state = states(end.y, problem.mu, problem.closed)
    sliding = (state != OPEN) & (problem.mu == 0)
    state = np.where(sliding & (h[n:] > 0), SLIP_MINUS, np.where(sliding, SLIP_PLUS, state))
    message = (
        f"solved by {trace[-1].method} ({trace[-1].iterations} iterations)" if trace else "no pairs, nothing to solve"
    )
    return CoulombResult(
        outcome="solved",
        gap=frozen(h[:n]),
        slip=frozen(h[n:]),
        normal_force=frozen(r[:n]),
        tangential_force=frozen(r[n:]),
        state=frozen(state, dtype=np.int64),
        trace=trace,
        residual=end.residual,
        index=end.index,
        message=message,
    )


def _unsolved(
    problem: CoulombProblem, outcome: Outcome, trace: tuple[Attempt, ...], escape: Array | None, message: str
) -> CoulombResult:
    nothing = frozen(np.full(problem.pairs, np.nan))
    return CoulombResult(
        outcome=outcome,
        gap=nothing,
        slip=nothing,
        normal_force=nothing,
        tangential_force=nothing,
        state=frozen(np.full(problem.pairs, UNDECIDED), dtype=np.int64),
        trace=trace,
        residual=np.inf,
        escape=escape,
        message=message,
    )
