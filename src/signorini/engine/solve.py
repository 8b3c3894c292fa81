# SPDX-License-Identifier: BSD-3-Clause
"""Follow the load history of a model, step after step. Model in, history out."""

from __future__ import annotations

from dataclasses import replace
from math import ceil

import numpy as np

from signorini.arrays import Array
from signorini.clock import Clock
from signorini.engine.automatic import follow_automatically
from signorini.engine.enter import relaxed, switched
from signorini.engine.exact import follow_exactly
from signorini.engine.fields import refuse_fields
from signorini.engine.increments import follow_increments, measured
from signorini.engine.leg import Leg, Snapshot, joined, keep, lightened, reached
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.report import step_result
from signorini.engine.span import Span, spans
from signorini.engine.staged import nominal_gap, staged
from signorini.engine.stretch import Stretch
from signorini.engine.upheld import at_the_end, handed_over
from signorini.engine.wellposed import assess
from signorini.errors import InputError, SolveFailed
from signorini.fem.supports import Constraints, make_constraints
from signorini.friction.law import OPEN
from signorini.interface.interface import pairs_of
from signorini.model.model import Model
from signorini.model.stage import Stage, stages
from signorini.model.step import Step
from signorini.solution.certificate import TOLERANCE
from signorini.solution.checkpoint import Checkpoint, digest
from signorini.solution.history import History
from signorini.solution.results import StepResult
from signorini.solution.state import LoadPoint, State, initial_state

RELAXED = "friction is lower than what pairs carried: they slip at once, before the loads of the step"
"""What a step says whose change of friction lets pairs slip."""

INTERRUPTED = "interrupted"
"""Status of a history that was stopped from outside."""

_BEHIND_A_JUMP = 10  # increments
_ENOUGH = 16  # in space, where no increments were asked for: none needs to be shorter than 1/16 of a straight part


def solve(
    model: Model,
    *,
    start: Checkpoint | None = None,
    backend: str = "auto",
    raise_on_failure: bool = True,
    wellposed: bool = False,
    clock: Clock | None = None,
) -> History:
    """Solve every step of a model and certify every increment; see :func:`signorini.api.solve`, which dresses it."""
    prepared = prepare(model, backend=backend, clock=clock)
    return solve_prepared(prepared, start=start, raise_on_failure=raise_on_failure, wellposed=wellposed)


def solve_prepared(
    prepared: Prepared, *, start: Checkpoint | None = None, raise_on_failure: bool = True, wellposed: bool = False
) -> History:
    """Solve the load history of a prepared model; see :func:`solve`.

    Pairs that were left out as too far apart are looked at after every increment; where one has met the other side, or
    nothing was found without them, everything is solved again with all pairs.
    """
    refuse_fields(prepared.model)
    begin = _begin(prepared, start)
    history = _follow(prepared, begin, wellposed)
    if prepared.limited and not history.solved and history.status != INTERRUPTED:
        history = _follow(prepared.widened(), begin, wellposed)
    if raise_on_failure and history.status == INTERRUPTED:
        raise KeyboardInterrupt
    if raise_on_failure and not history.solved:
        raise SolveFailed(history.message, status=history.status, solution=history)
    return history


def _begin(prepared: Prepared, start: Checkpoint | None) -> Checkpoint:
    """Where the history begins: nothing has moved, or a state that fits and is in equilibrium here too."""
    model, interface = prepared.model, prepared.interface
    zero = dict.fromkeys(model.scaled_names, 0.0)
    if start is None:
        state = initial_state(zero, prepared.space.number_of_dofs, interface)
        return Checkpoint(
            state=state,
            inactive=frozenset(),
            released=prepared.released,
            contacts=tuple(contact.label for contact in model.contacts),
            contact=interface.contact,
            node=interface.node,
            mesh=digest(model.mesh),
        )
    start.check(model, interface)
    point = start.state.point
    factors = zero | {name: factor for name, factor in point.factors.items() if name in zero}
    state = replace(start.state, point=replace(point, factors=factors))
    absent = pairs_of(model, interface, start.inactive)
    found = measured(replace(prepared, absent=absent, constraints=_constraints(prepared, start.released)), state)
    if not found.imbalance <= TOLERANCE:
        raise InputError(
            f"is not in equilibrium in this model (residual {found.equilibrium:.1e} of the loads); expected the same "
            "bodies, materials, supports and loads",
            where=("start",),
        )
    return replace(start, state=state)


def _follow(prepared: Prepared, begin: Checkpoint, wellposed: bool) -> History:
    """Step after step, up to the end or to what stops it; then the last one goes as far as it was followed."""
    state = begin.state
    seen = prepared.bodies.active | prepared.bodies.held | prepared.interface.tied
    if (state.status[~seen] != OPEN).any():
        prepared = prepared.widened()
    released = begin.released
    schedule = list(stages(prepared.model, factors=state.point.factors, inactive=begin.inactive, released=released))
    steps: list[StepResult] = []
    inactive = begin.inactive
    now = replace(prepared, absent=pairs_of(prepared.model, prepared.interface, inactive))
    supports = _constraints(prepared, released)
    prepared.clock.expect(sum(_expected(stage) for stage in schedule))
    try:
        for stage in schedule:
            prepared = prepared.upheld(stage.released)
            absent, now = now.absent, staged(prepared, stage)
            state = handed_over(now, supports, state)
            leg, cycle_ends = _step(now, stage, switched(now, state, absent))
            steps.append(step_result(now, stage, leg, cycle_ends))
            state, inactive, released, supports = leg.after, stage.inactive, stage.released, now.constraints
    except (SolveFailed, KeyboardInterrupt) as stop:
        status = INTERRUPTED
        words = f"interrupted in step {len(steps) + 1} of {len(schedule)}; {len(steps)} steps were finished"
        if isinstance(stop, SolveFailed):
            status, words = stop.status, str(stop)
        end = replace(begin, state=state, inactive=inactive, released=released) if steps else None
        part = reached(stop)
        if part is not None:
            steps.append(step_result(now, schedule[len(steps)], part, (), finished=False))
        return replace(_history(prepared, status, words, steps, end), escape=_motion(stop))
    end = replace(begin, state=state, inactive=inactive, released=released)
    history = _history(prepared, "solved", "", steps, end)
    return replace(history, wellposedness=assess(now, state)) if wellposed else history


def _motion(stop: SolveFailed | KeyboardInterrupt) -> Array | None:
    motion = stop.motion if isinstance(stop, SolveFailed) else None
    return None if motion is None else np.asarray(motion, dtype=np.float64)


def _expected(stage: Stage) -> int:
    number = stage.step.increments
    return (number if isinstance(number, int) else 1) * len(stage.ends)


def _constraints(prepared: Prepared, released: frozenset[str]) -> Constraints:
    """Under some of the supports; the prepared ones where those are they."""
    if released == prepared.released:
        return prepared.constraints
    return make_constraints(prepared.space, prepared.model, without=released)


def _step(prepared: Prepared, stage: Stage, state: State) -> tuple[Leg, list[float]]:
    """A step from what it changes at once through all its straight parts; and the load factors at its cycles' ends."""
    legs: list[Leg] = []
    cycle_ends: list[float] = []
    begin = float(stage.number - 1)
    change = relaxed(prepared, state, stage.name)
    if change is not None:
        after, certificate, trace = change
        legs.append(
            Leg(
                path="single",
                before=state,
                after=after,
                certificates=(certificate,),
                trace=(trace,),
                snapshots=(Snapshot(load_factor=begin, what="change", state=after),),
                notes=(RELAXED,),
            )
        )
        state = after
    reaction, offset = at_the_end(prepared, stage, state.point)
    end = LoadPoint(
        factors=stage.ends[-1],
        gap=nominal_gap(prepared, stage),
        given=np.zeros_like(state.point.given),
        reaction=reaction,
        offset=offset,
    )
    at_events = stage.step.at == "events"
    # the work of temperatures needs the displacements, see signorini.engine.heat
    heated = any(load.temperature is not None for load in prepared.model.loads)
    for span, point in spans(stage, state.point, end):
        stretch = Stretch(prepared=prepared, where=stage.name, span=span, before=state, end=point, whole=at_events)
        try:
            leg = _leg(stage, stretch)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, legs) from None
        leg = lightened(leg, every=at_events, end=span.asked, heated=heated)
        legs = [joined([*legs, leg])]
        state = leg.after
        if span.cycle:
            cycle_ends.append(span.factor(1.0))
    return legs[0], cycle_ends


def _leg(stage: Stage, stretch: Stretch) -> Leg:
    """Follow a straight part of a step as asked; where nothing was asked, exactly if there is Coulomb friction.

    In space, where the exact cone has no exact path, in increments to events, more of them until the answer stays.
    Where the exact path that nobody asked for ends in a jump or is lost, it is followed in increments, and the notes
    say so: what they reach behind a jump is a candidate.
    """
    step, interface = stage.step, stretch.prepared.interface
    jump = "follow" if step.follows_jumps else step.jump
    rubbing = bool((interface.rubs & ~interface.sticks & ~stretch.prepared.absent).any())
    if step.path != "exact" and (step.path is not None or step.increments is not None or not rubbing):
        if step.increments == "auto":
            return follow_automatically(stretch, step.tolerance, jump=jump)
        return follow_increments(stretch, _increments(step, stretch.span, stage))
    if step.path is None and interface.directions == 3:
        return follow_automatically(stretch, step.tolerance, enough=_ENOUGH, jump=jump)
    try:
        return follow_exactly(stretch, jumps=step.follows_jumps)
    except SolveFailed as failure:
        if step.path == "exact" or step.jump == "stop":
            raise
        try:
            leg = follow_increments(stretch, _BEHIND_A_JUMP)
        except SolveFailed as nothing:
            words = f"{failure}; nor do increments go on: {nothing}"
            worse = SolveFailed(words, status=nothing.status, motion=nothing.motion)
            worse.reached = failure.reached  # the exact path goes farther
            raise worse from failure
        return replace(leg, notes=(f"{failure}; followed in {_BEHIND_A_JUMP} increments to what is a candidate",))


def _increments(step: Step, span: Span, stage: Stage) -> int:
    """Of a straight part: those of its whole segment, as far as they go."""
    number = step.increments if isinstance(step.increments, int) else 1
    return max(1, ceil(number * (span.high - span.low) * len(stage.ends) - 1e-9))


def _history(prepared: Prepared, status: str, message: str, steps: list[StepResult], end: Checkpoint | None) -> History:
    return History(
        model=prepared.model,
        status=status,
        message=message,
        steps=tuple(steps),
        backend=prepared.bodies.name,
        timings=dict(prepared.clock.seconds),
        pairs=len(prepared.interface),
        end=end,
    )
