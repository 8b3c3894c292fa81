# SPDX-License-Identifier: BSD-3-Clause
"""The words and values of an answer, whichever method gave it."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.attempt import MethodRun
from signorini.errors import told
from signorini.friction.candidate import Candidate
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, UNDECIDED, split, states
from signorini.friction.problem import CoulombProblem
from signorini.friction.result import CoulombResult, Outcome
from signorini.law.bound import STEEP, plain

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


def nothing_found(ends: str, *, escapes: bool) -> str:
    """Words where there is neither solution nor proof.

    Parameters
    ----------
    ends : how the methods ended
    escapes : whether bodies run away where ever weaker springs hold them
    """
    if escapes:
        return told(_RUNS, remedy="hold the bodies against it, or change loads, gaps or friction", evidence=ends)
    remedy = "smaller increments, less friction, or moduli, sizes and compliances less far apart"
    return told(f"{_LOST}: every method ended without a solution", remedy=remedy, evidence=ends)


def solved(problem: CoulombProblem, found: Candidate, trace: tuple[MethodRun, ...]) -> CoulombResult:
    """A certified candidate as a result."""
    n, y = problem.pairs, found.y
    h, r = split(y, problem.bound)
    coded = states(y, problem.bound, problem.closed)
    state = plain(coded)
    frictionless = (state != OPEN) & (problem.mu == 0)
    state = np.where(frictionless & (h[n:] > 0), SLIP_MINUS, np.where(frictionless, SLIP_PLUS, state))
    return CoulombResult(
        outcome="solved",
        gap=frozen(h[:n]),
        slip=frozen(h[n:]),
        normal_force=frozen(r[:n]),
        tangential_force=frozen(r[n:]),
        state=frozen(state, dtype=np.int64),
        trace=trace,
        residual=found.residual,
        index=found.index,
        message=_how(problem, found, coded, trace),
    )


def _how(problem: CoulombProblem, found: Candidate, state: IntArray, trace: tuple[MethodRun, ...]) -> str:
    if not trace:
        return "no pairs, nothing to solve"
    words = f"solved by {trace[-1].method}, {trace[-1].iterations} steps"
    if not found.index:
        words += UNDETERMINED
    if found.index < 0 and not problem.floating:
        words += SEVERAL
    steep = problem.bound.slopes[0] >= STEEP
    verge = np.flatnonzero(steep & np.isin(state, (SLIP_PLUS, SLIP_MINUS)))
    if len(verge):
        words += VERGE.format(pairs=", ".join(map(str, verge)))
    return words


def impossible(problem: CoulombProblem, found: Candidate, trace: tuple[MethodRun, ...]) -> CoulombResult:
    """A proof that there is no equilibrium as a result."""
    message = (PULLED_AWAY if found.proof == "rigid motion" else TREE).format(margin=found.margin)
    return _unsolved(problem, "no_equilibrium", trace, found.escape, message)


def not_found(problem: CoulombProblem, escape: Array | None, trace: tuple[MethodRun, ...]) -> CoulombResult:
    """Neither solution nor proof."""
    ends = "; ".join(f"{a.method}: {a.end}" for a in trace)
    return _unsolved(problem, "not_found", trace, escape, nothing_found(ends, escapes=escape is not None))


def _unsolved(
    problem: CoulombProblem, outcome: Outcome, trace: tuple[MethodRun, ...], escape: Array | None, message: str
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
        escape=None if escape is None else frozen(escape),
        message=message,
    )
