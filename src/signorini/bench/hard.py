# SPDX-License-Identifier: BSD-3-Clause
"""How often the Coulomb solver answers the hard set, and by which method."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from signorini import lcp
from signorini.arrays import IntArray
from signorini.friction.certificate import certify
from signorini.friction.newton import by_states
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.gallery.hard import PROBLEMS, hard_problem
from signorini.law.result import ContactAnswer


@dataclass(frozen=True, kw_only=True)
class HardReport:
    """Steps counted by what answered them, for held and for floating bodies.

    Attributes
    ----------
    problems : number of problems
    held, floating : counts by method, proof or lack of answer; ``"steps"`` in all; rivals by their names
    unanswered : names of the problems without an answer
    negative : certified steps with index -1
    certified : their names and problems, in order
    """

    problems: int
    held: dict[str, int]
    floating: dict[str, int]
    unanswered: tuple[str, ...]
    negative: int
    certified: tuple[tuple[str, ContactProblem], ...]


def newton_alone(problem: ContactProblem, start: IntArray | None) -> bool:
    """Whether plain Newton, from the states of the step before, certifies a step."""
    return by_states(problem, start).residual <= 1e-10


def lemke_alone(problem: ContactProblem, start: IntArray | None) -> bool:  # noqa: ARG001  # it has no use for a start
    """Whether Lemke's method certifies a step, posed with three rows a pair in the gap-slip form.

    With S = W^-1 - I, F = W^-1 b and h = (gap, s_plus - s_minus)::

        z = (gap, s_plus, s_minus),    w = (p, mu p + r_t, mu p - r_t),    r = S h - F

    covered by (1, 1 + mu, 1 + mu): with all ones, s_plus and s_minus rise together along spurious rays. The states that
    the path ends in get one Newton step, against the rounding of W^-1.
    """
    n, mu = problem.pairs, problem.mu[:, None]
    stiffness = np.linalg.inv(problem.W)
    F = stiffness @ problem.b
    S = stiffness - np.eye(2 * n)
    S_n, S_t, F_n, F_t = S[:n], S[n:], F[:n], F[n:]
    rows = np.vstack([S_n, mu * S_n + S_t, mu * S_n - S_t])
    M = np.hstack([rows, -rows[:, n:]])
    q = -np.concatenate([F_n, mu[:, 0] * F_n + F_t, mu[:, 0] * F_n - F_t])
    covering = np.concatenate([np.ones(n), 1 + mu[:, 0], 1 + mu[:, 0]])
    z = lcp.solve(M, q, method=lcp.Lemke(covering=covering)).z
    if z is None:
        return False
    h = np.concatenate([z[:n], z[n : 2 * n] - z[2 * n :]])
    y = problem.by_pair(S @ h - F - h)
    if certify(problem, y) <= 1e-10:
        return True
    return by_states(problem, problem.law.states(y), near=y, limit=1).residual <= 1e-10


RIVALS: dict[str, Callable[[ContactProblem, IntArray | None], bool]] = {
    "Newton alone": newton_alone,
    "Lemke alone": lemke_alone,
}
"""Other solvers, by name: whether each certifies a step, given the states of the step before."""


def hard(
    numbers: Sequence[int] = range(PROBLEMS), *, begin: Callable[[str, int, int], None] = lambda *_: None
) -> HardReport:
    """Solve every step of the hard set, each with its history; a history ends where a step has no solution.

    Parameters
    ----------
    numbers : of the problems, from 0; by default all
    begin : told before every problem its name, how many are done and how many there are

    Examples
    --------
    >>> report = hard(range(3))
    >>> report.problems, report.held.get("no answer", 0), report.floating.get("no answer", 0)
    (3, 0, 0)
    """
    counts: dict[bool, Counter[str]] = {False: Counter(), True: Counter()}
    unanswered, certified, negative = [], [], 0
    for done, problem in enumerate(map(hard_problem, numbers)):
        begin(problem.name, done, len(numbers))
        slipped, start = np.zeros(problem.first.pairs), None
        for k in range(len(problem.loads)):
            step = problem.step(k, slipped)
            result = solve_contact(step, start)
            tally = counts[step.floating]
            tally["steps"] += 1
            tally[_answer(result)] += 1
            tally.update(name for name, certifies in RIVALS.items() if certifies(step, start))
            negative += result.index == -1
            if _answer(result) == "no answer":
                unanswered.append(f"{problem.name}, step {k}: {result.message}")
            if not result.solved:
                break
            certified.append((f"{problem.name}, step {k}", step))
            slipped, start = slipped + result.slip[0], result.state
    return HardReport(
        problems=len(numbers),
        held=dict(counts[False]),
        floating=dict(counts[True]),
        unanswered=tuple(unanswered),
        negative=negative,
        certified=tuple(certified),
    )


def _answer(result: ContactAnswer) -> str:
    if result.solved:
        return result.method
    if result.outcome == "no_equilibrium":
        return f"proved: {result.method}"
    return "no answer" if result.escape is None else "escape named"


def spread(sample: int | None) -> Sequence[int]:
    """Numbers of so many problems, evenly spread over the set; all of it where none or more are asked for.

    >>> list(spread(4))
    [0, 162, 325, 487]
    """
    if sample is None or sample >= PROBLEMS:
        return range(PROBLEMS)
    return [k * PROBLEMS // sample for k in range(sample)]
