# SPDX-License-Identifier: BSD-3-Clause
"""Solve the condensed spatial Coulomb problem: the methods in their order.

1. Newton from the previous solution where there is one, then from every pair sticking. Nearly always enough.
2. Floating bodies: proof that the loads pull them away (see `rigid`).
3. Sweeps and proximal Newton in rounds, then proximal Newton alone (see `proximal`).
4. Floating bodies: the motion along which they run away (see `escape`).

Whatever a method finds is certified (see `certify`) before it is believed. `limit_load` says how far the load can be
raised where all of them end without an answer.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, frozen
from signorini.attempt import MethodRun
from signorini.errors import InputError
from signorini.friction.answer import PULLED_AWAY, VERGE, nothing_found
from signorini.friction.result import Outcome
from signorini.friction.space.proximal import proximal_rounds, swept_rounds
from signorini.friction.spatial.equilibrium import Equilibrium
from signorini.friction.spatial.escape import escape_motion
from signorini.friction.spatial.law import OPEN, SLIP, STICK, split, states, sticking, tangent
from signorini.friction.spatial.newton import NewtonEnd, newton
from signorini.friction.spatial.problem import SpatialProblem
from signorini.friction.spatial.result import LimitLoad, SpatialResult
from signorini.friction.spatial.rigid import pulled_away
from signorini.law.states import UNDECIDED


@dataclass(frozen=True, kw_only=True)
class SpatialSettings:
    """How long each method may try.

    Attributes
    ----------
    tolerance : of `certify`, relative to the data
    newton_steps : most linear systems of one Newton run
    swept_rounds, sweeps : most rounds of sweeps and proximal Newton, and sweeps of each
    proximal_rounds : most rounds of proximal Newton alone
    springs : stiffness of the springs that show where a body runs, falling, in units of the interface stiffness
    bisections : of the load factor, in `limit_load`
    """

    tolerance: float = 1e-10
    newton_steps: int = 25
    swept_rounds: int = 15
    sweeps: int = 20
    proximal_rounds: int = 50
    springs: tuple[float, ...] = (1e-3, 1e-6, 1e-9)
    bisections: int = 10


def solve_spatial(
    problem: SpatialProblem, start: Array | None = None, *, settings: SpatialSettings | None = None
) -> SpatialResult:
    """Solve ``G h - W r = b`` in Coulomb's law: a certified solution, a proof that there is none, or neither.

    Parameters
    ----------
    problem : the problem
    start : (3n,) ``y`` of the previous solution, or None to start with every pair sticking
    settings : how long each method may try

    Raises
    ------
    InputError
        Where ``start`` does not fit, or W has a rigid motion that the problem does not name.

    Examples
    --------
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.3, 0.4]), friction=[0.1], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> result = solve_spatial(problem)
    >>> result.outcome, result.normal_force.round(12).tolist(), result.tangential_force.round(12).tolist()
    ('solved', [2.0], [[-0.12, -0.16]])
    """
    settings = settings or SpatialSettings()
    if start is not None and np.shape(start) != (3 * problem.pairs,):
        raise InputError(f"has shape {np.shape(start)}; expected {(3 * problem.pairs,)}", where=("start",))
    if problem.pairs == 0:
        return _solved(problem, np.zeros(0), 0.0, ())
    trace: list[MethodRun] = []
    best = _tried(None, _newton_runs(problem, start, settings), settings.tolerance, trace)
    if best.residual > settings.tolerance and problem.floating:
        pull = pulled_away(problem)
        end = "nothing proved" if pull is None else "pulled away"
        trace.append(MethodRun(method="rigid motions", iterations=1, end=end))
        if pull is not None:
            words = PULLED_AWAY.format(margin=pull.share)
            return _unsolved(problem, "no_equilibrium", tuple(trace), best.residual, words, pull.motion)
    if best.residual > settings.tolerance:
        best = _tried(best, _rounds(problem, settings), settings.tolerance, trace)
    if best.residual <= settings.tolerance:
        return _solved(problem, best.y, best.residual, tuple(trace))
    escape = escape_motion(problem, springs=settings.springs, steps=settings.newton_steps) if problem.floating else None
    ends = "; ".join(f"{attempt.method}: {attempt.end}" for attempt in trace[:3])
    message = nothing_found(f"{ends}; least residual {best.residual:.1e}", escapes=escape is not None)
    return _unsolved(problem, "not_found", tuple(trace), best.residual, message, escape)


def limit_load(
    problem: SpatialProblem, base: Array, start: Array | None = None, *, settings: SpatialSettings | None = None
) -> LimitLoad | None:
    """How far the load can be raised from ``base`` to the problem's b: bisection, each load from the last solution.

    Parameters
    ----------
    problem : the problem at its full load
    base : (3n,) a b that has a solution, of the step before for instance; a multiple of b will not do, since the
        solutions grow with it
    start : (3n,) ``y`` of a solution at the base

    Returns
    -------
    LimitLoad, or None where the base load itself has no certified solution
    """
    settings = settings or SpatialSettings()
    result = solve_spatial(replace(problem, b=base), start, settings=settings)
    if not result.solved:
        return None
    factor, beyond, trial = 0.0, np.inf, 1.0
    for _ in range(settings.bisections + 1):
        b = (1.0 - trial) * base + trial * problem.b
        tried = solve_spatial(replace(problem, b=b), result.y, settings=settings)
        if tried.solved:
            factor, result = trial, tried
        else:
            beyond = trial
        if factor == 1.0:
            break
        trial = (factor + min(beyond, 1.0)) / 2.0
    closed, stick = np.count_nonzero(result.state != OPEN), np.count_nonzero(result.state == STICK)
    return LimitLoad(factor=factor, beyond=beyond, result=result, closed=int(closed), sticking=int(stick))


def _tried(best: NewtonEnd | None, ends: Iterator[NewtonEnd], tolerance: float, trace: list[MethodRun]) -> NewtonEnd:
    """The first end that is certified, or the best of all; what was tried goes into the trace."""
    for end in ends:
        trace.append(end.attempt)
        if best is None or end.residual < best.residual:
            best = end
        if end.residual <= tolerance:
            break
    assert best is not None  # the run from sticking is always there
    return best


def _newton_runs(problem: SpatialProblem, start: Array | None, settings: SpatialSettings) -> Iterator[NewtonEnd]:
    """Newton from the start given, then from sticking."""
    laws = ([] if start is None else [tangent(problem, np.asarray(start))]) + [sticking(problem)]
    for law in laws:
        yield newton(Equilibrium.of(problem), law, limit=settings.newton_steps, tolerance=settings.tolerance)


def _rounds(problem: SpatialProblem, settings: SpatialSettings) -> Iterator[NewtonEnd]:
    """Sweeps and proximal Newton, then that alone."""
    steps, tolerance = settings.newton_steps, settings.tolerance
    yield from swept_rounds(
        problem, rounds=settings.swept_rounds, sweeps=settings.sweeps, steps=steps, tolerance=tolerance
    )
    yield from proximal_rounds(problem, rounds=settings.proximal_rounds, steps=steps, tolerance=tolerance)


def _solved(problem: SpatialProblem, y: Array, residual: float, trace: tuple[MethodRun, ...]) -> SpatialResult:
    n = problem.pairs
    h, r = split(problem, y)
    state = states(problem, y)
    message = f"solved by {trace[-1].method}, {trace[-1].iterations} steps" if trace else "no pairs, nothing to solve"
    verge = np.flatnonzero(
        np.isinf(problem.friction.reshape(n, -1 if n else 1).max(axis=1, initial=0.0)) & (state == SLIP)
    )
    if len(verge):
        message += VERGE.format(pairs=", ".join(map(str, verge)))
    return SpatialResult(
        outcome="solved",
        gap=frozen(h[:n]),
        slip=frozen(h[n:].reshape(2, n).T),
        normal_force=frozen(r[:n]),
        tangential_force=frozen(r[n:].reshape(2, n).T),
        state=frozen(state, dtype=np.int64),
        y=frozen(y),
        trace=trace,
        residual=residual,
        message=message,
    )


def _unsolved(
    problem: SpatialProblem,
    outcome: Outcome,
    trace: tuple[MethodRun, ...],
    least: float,
    message: str,
    escape: Array | None = None,
) -> SpatialResult:
    nothing = frozen(np.full(problem.pairs, np.nan))
    pairs = frozen(np.full((problem.pairs, 2), np.nan))
    return SpatialResult(
        outcome=outcome,
        gap=nothing,
        slip=pairs,
        normal_force=nothing,
        tangential_force=pairs,
        state=frozen(np.full(problem.pairs, UNDECIDED), dtype=np.int64),
        y=frozen(np.full(3 * problem.pairs, np.nan)),
        trace=trace,
        residual=least,
        escape=None if escape is None else frozen(escape),
        message=message,
    )
