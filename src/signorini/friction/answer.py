# SPDX-License-Identifier: BSD-3-Clause
"""The words and values of an answer, whichever method gave it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import frozen
from signorini.attempt import MethodRun
from signorini.errors import told
from signorini.friction.candidate import Candidate
from signorini.friction.problem import ContactProblem
from signorini.law.bound import ADHESION_SLOPE, plain
from signorini.law.result import ContactAnswer
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED
from signorini.outcome import Outcome

_NAMED_RUNS = 3  # that a message lists of many

UNDETERMINED = (
    "; the state leaves a motion or a force undetermined (nothing resists a motion along the contact, or one pair"
    " repeats another): the solution of least change was taken"
)
SEVERAL = "; its index is -1: at least two more solutions exist, and the load history decides which one is taken"
VERGE = "; pairs that hold friction without pressure slip on the verge of opening: {pairs}"
PULLED_AWAY = told(
    "no equilibrium: the loads pull a body away along a rigid motion that contact cannot resist, whatever its state",
    remedy="hold the body, or change the loads",
    evidence="nothing takes {margin:.2g} of the load on the body",
)
TREE = told(
    "no equilibrium: the forces can balance the resultants, but no state of the pairs (open, stick, slip) is in"
    " equilibrium",
    remedy="change loads, gaps or friction",
    evidence="a linear program refuses every state, and at the least {margin:.2g} of the load is not balanced",
)
_LOST = "no certified equilibrium, and no proof that there is none"
_RUNS = f"{_LOST}: with ever weaker springs the bodies run away along the motion given"
_HOLD = "hold the bodies against it, or change loads, gaps or friction"
_SMALLER = "smaller increments, less friction, or moduli, sizes and compliances less far apart"


def solved(problem: ContactProblem, tried: Sequence[Candidate]) -> ContactAnswer:
    """The last candidate tried, a certified one, as an answer."""
    found = tried[-1]
    h, r = problem.law.split(found.y)
    state = plain(problem.law.states(found.y))
    if problem.directions == 2:
        frictionless = (state != OPEN) & (problem.mu == 0)
        state = np.where(frictionless & (h[1] > 0), SLIP_MINUS, np.where(frictionless, SLIP_PLUS, state))
    words = f"solved by {found.attempt.method}, {found.attempt.iterations} steps"
    if found.index == 0:
        words += UNDETERMINED
    if found.index == -1 and not problem.floating:
        words += SEVERAL
    verge = np.flatnonzero((state > STICK) & (problem.bound.tangent(r[0])[0] >= ADHESION_SLOPE))
    if len(verge):
        words += VERGE.format(pairs=", ".join(map(str, verge)))
    return ContactAnswer(
        outcome=Outcome.SOLVED,
        h=frozen(h),
        r=frozen(r),
        state=frozen(state, dtype=np.int64),
        trace=_trace(tried),
        residual=found.residual,
        index=found.index,
        message=words,
    )


def nothing_to_solve(problem: ContactProblem) -> ContactAnswer:
    """The solution of a problem without pairs."""
    return replace(_unsolved(problem, Outcome.SOLVED, (), "no pairs, nothing to solve"), index=1)


def impossible(problem: ContactProblem, tried: Sequence[Candidate]) -> ContactAnswer:
    """A proof that there is no equilibrium, of the last candidate tried, as an answer."""
    found = tried[-1]
    message = (PULLED_AWAY if found.proof == "rigid motion" else TREE).format(margin=found.margin)
    return _unsolved(problem, Outcome.NO_EQUILIBRIUM, tried, message)


def not_found(problem: ContactProblem, tried: Sequence[Candidate]) -> ContactAnswer:
    """Neither solution nor proof."""
    ends = [f"{run.method}: {run.end}" for run in _trace(tried)]
    if not problem.piecewise_linear:  # rounds come in dozens
        ends = [*ends[:_NAMED_RUNS], f"least residual {_least(tried):.1e}"]
    escapes = any(found.escape is not None for found in tried)
    sentence, remedy = (_RUNS, _HOLD) if escapes else (f"{_LOST}: every method ended without a solution", _SMALLER)
    message = told(sentence, remedy=remedy, evidence="; ".join(ends))
    return _unsolved(problem, Outcome.NOT_FOUND, tried, message)


def _unsolved(problem: ContactProblem, outcome: Outcome, tried: Sequence[Candidate], message: str) -> ContactAnswer:
    nothing = frozen(np.full((problem.directions, problem.pairs), np.nan))
    escapes = [found.escape for found in tried if found.escape is not None]
    return ContactAnswer(
        outcome=outcome,
        h=nothing,
        r=nothing,
        state=frozen(np.full(problem.pairs, UNDECIDED), dtype=np.int64),
        trace=_trace(tried),
        residual=_least(tried),
        escape=frozen(escapes[-1]) if escapes else None,
        message=message,
    )


def _trace(tried: Sequence[Candidate]) -> tuple[MethodRun, ...]:
    return tuple(found.attempt for found in tried)


def _least(tried: Sequence[Candidate]) -> float:
    return min((found.residual for found in tried), default=0.0)
