# SPDX-License-Identifier: BSD-3-Clause
"""Semismooth Newton: guess the state of every pair, solve, read the states off the answer, repeat.

Each step is the Newton step of the piecewise linear equation ``G h(y) - W r(y) = b`` (the primal-dual active set
method). Three steps are usual; in 2-3 % of hard problems the states repeat in a cycle, and the path method takes over.

Many closed pairs are iterated as long as that leads to states not tried before: of an edge that moves by a pair a step,
as that of a long sticking zone does, the next state is all that a step has to tell. The last system is factorised.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun
from signorini.friction.candidate import Candidate
from signorini.friction.certificate import certify
from signorini.friction.cone import balanced, cone_system
from signorini.friction.krylov import LARGE
from signorini.friction.law import OPEN, STICK, UNDECIDED, states
from signorini.friction.problem import CoulombProblem
from signorini.law.bound import plain


def newton(
    problem: CoulombProblem,
    start: IntArray | None = None,
    *,
    near: Array | None = None,
    limit: int = 200,
    tolerance: float = 1e-10,
) -> Candidate:
    """Newton from given states; ends at a solution, a repeated state, a singular state or the limit.

    Parameters
    ----------
    problem : the problem
    start : (n,) states to begin with; every pair sticking where not given
    near : (2n,) a y from which an undetermined motion departs least; 0 where not given
    limit : most systems solved
    tolerance : of `certify`

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> end = newton(problem)
    >>> end.y.round(12).tolist(), end.attempt.end, end.attempt.changes
    ([2.0, -1.0], 'certified', (1,))
    """
    state = admissible(problem, start)
    y = np.zeros(2 * problem.pairs) if near is None else near
    seen: dict[bytes, IntArray] = {}
    changes: list[int] = []
    end, index, residual = "limit reached", 0, np.inf
    for _ in range(limit):
        seen[state.tobytes()] = state
        y, index, following = _answered(problem, state, y, seen)
        if following is None:
            end = "singular state"
            break
        residual = certify(problem, y)
        changes.append(int(np.count_nonzero(following != state)))
        if residual <= tolerance:
            index = index or cone_system(problem, state).index  # an iterated answer knows none
            end = "certified"
            break
        state = following
        if state.tobytes() in seen:
            end = "states repeat"
            break
    attempt = MethodRun(method="newton", iterations=len(changes), changes=tuple(changes), end=end)
    late = list(seen.values())[len(seen) // 2 :] + [state]
    touched = np.any([tried != OPEN for tried in late], axis=0)
    return Candidate(y=y, state=state, residual=residual, index=index, attempt=attempt, touched=touched)


def _answered(
    problem: CoulombProblem, state: IntArray, y: Array, seen: Mapping[bytes, IntArray]
) -> tuple[Array, int, IntArray | None]:
    """The y in equilibrium in given states, the index of their system and the states that follow; else None.

    Parameters
    ----------
    y : (2n,) the last one
    seen : states tried before
    """
    many = np.count_nonzero(state != OPEN) + np.count_nonzero(state == STICK) >= LARGE
    nearly = balanced(problem, state, y) if many else None
    if nearly is not None:
        following = states(nearly, problem.bound, problem.closed)
        if following.tobytes() not in seen:
            return nearly, 0, following
    system = cone_system(problem, state)
    answer = system.solve(y)
    if answer is None:
        return y, 0, None
    return answer, system.index, states(answer, problem.bound, problem.closed)


def admissible(problem: CoulombProblem, start: IntArray | None) -> IntArray:
    """States to start from that each pair can take; all closed (sticking where they can) where none are given."""
    state = np.full(problem.pairs, STICK, dtype=np.int64) if start is None else np.array(start, dtype=np.int64)
    state[state == UNDECIDED] = STICK
    forced = (state != OPEN) & (problem.closed != UNDECIDED) & (plain(state) != problem.closed)
    return np.where(forced, problem.closed, state).astype(np.int64)
