# SPDX-License-Identifier: BSD-3-Clause
"""Follow the load history of a model, step after step. Model in, history out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from signorini.arrays import stored
from signorini.blas_threads import one_thread
from signorini.clock import Clock
from signorini.distributed.ranks import MUMPS, PETSC
from signorini.engine.contact_changes import pressed_gap, relaxed, staged, switched
from signorini.engine.examine import on_ranks
from signorini.engine.fatigue import with_fatigue
from signorini.engine.fatigue_on_ranks import PlacesOnRanks, places_to_see
from signorini.engine.increments import measured
from signorini.engine.memory_check import refuse_fields
from signorini.engine.moved_mesh import on_worn_mesh, with_geometry
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.report import instant_of, step_result
from signorini.engine.sliding import follow_sliding
from signorini.engine.step_parts import (
    FollowedPart,
    Snapshot,
    StepPart,
    joined,
    keep,
    kept_by_ranks,
    lightened,
    reached,
    straight_parts,
)
from signorini.engine.support_changes import at_the_end, handed_over, locks_bolts, refuse_moved
from signorini.engine.tape import Leg, Tape
from signorini.engine.ways import follow_part
from signorini.engine.wear_steps import follow_wearing
from signorini.engine.wellposed import assess
from signorini.errors import InputError, Interrupted, SolveFailed
from signorini.fem.supports import Constraints, make_constraints
from signorini.interface.interface import pairs_of
from signorini.memory import give_memory_back, out_of_memory
from signorini.model.model import Model
from signorini.model.stage import Stage, Standing, stages
from signorini.outcome import Outcome
from signorini.settings import SolverSettings
from signorini.solution.certificate import TOLERANCE
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.history import History
from signorini.solution.results import Instant, StepResult
from signorini.solution.scale import Loading, data_scale
from signorini.solution.state import LoadPoint, State, initial_state
from signorini.solution.wear_state import unworn

_GIVEN_BACK_FROM = 250_000
"""Unknowns from which the milliseconds that it takes to give memory back are worth it."""

RELAXED = "friction is lower than what pairs carried: they slip at once, before the loads of the step"
"""What a step says whose change of friction lets pairs slip."""


def solve(
    model: Model,
    *,
    start: Checkpoint | None = None,
    backend: str = "auto",
    settings: SolverSettings | None = None,
    raise_on_failure: bool = True,
    wellposed: bool = False,
    clock: Clock | None = None,
    after_step: Callable[[History], None] | None = None,
    tape: Tape | None = None,
) -> History:
    """Solve every step of a model and certify every increment.

    Parameters
    ----------
    model, start, backend, settings, raise_on_failure, wellposed, clock : as of :func:`signorini.api.solve`, which
        dresses it
    after_step : is given what is finished after every step but the last, to keep it
    tape : takes what is followed, for derivatives
    """
    # a tape and well-posedness ask for the condensed interface, and in the plane it is always cheaper
    saves = model.dimension == 3 and tape is None and not wellposed
    if backend == PETSC and (wellposed or tape is not None):
        backend = MUMPS
    try:
        prepared = prepare(model, start=start, backend=backend, settings=settings, clock=clock, saves=saves)
    except MemoryError as error:
        raise SolveFailed(out_of_memory(error), status=Outcome.NOT_FOUND) from None
    return solve_prepared(
        prepared, start=start, raise_on_failure=raise_on_failure, wellposed=wellposed, after_step=after_step, tape=tape
    )


@one_thread()
def solve_prepared(
    prepared: Prepared,
    *,
    start: Checkpoint | None = None,
    raise_on_failure: bool = True,
    wellposed: bool = False,
    after_step: Callable[[History], None] | None = None,
    tape: Tape | None = None,
) -> History:
    """Solve the load history of a prepared model; see :func:`solve`.

    Parameters
    ----------
    start : for which the model was prepared
    raise_on_failure, wellposed : as of :func:`signorini.api.solve`
    after_step : is given what is finished after every step but the last
    tape : takes what is followed, for derivatives
    """
    refuse_fields(prepared.model)
    if wellposed and prepared.model.slides:
        raise InputError("does not know contacts that slide far; expected it without them", where=("wellposed",))
    if start is not None and start.state.wear is not None and start.state.wear.taken.any():
        prepared = on_worn_mesh(prepared, start.state.wear.taken)
    begin = _first(prepared) if start is None else _fitting(prepared, start)
    seen = places_to_see(prepared) if prepared.model.fatigue else []
    history = _follow(prepared, begin, wellposed, after_step, tape, seen)
    if prepared.model.fatigue and history.solved:
        history = with_fatigue(history, seen)
    if raise_on_failure:
        raise_failure(history)
    return history


def raise_failure(history: History) -> None:
    """Raise what ended a history before its end, with the history.

    Raises
    ------
    SolveFailed, Interrupted
    """
    if history.status == Outcome.INTERRUPTED:
        raise Interrupted(history.message, solution=history)
    if not history.solved:
        raise SolveFailed(history.message, status=history.status, solution=history)


def _first(prepared: Prepared) -> Checkpoint:
    """Where a history begins: nothing has moved, and nothing is changed of contacts; supports may come later."""
    model, interface = prepared.model, prepared.interface
    zero = dict.fromkeys(model.scaled_names, 0.0)
    state = initial_state(zero, prepared.constraints.zeros, interface)
    if prepared.yielding is not None:
        state = replace(state, plastic=prepared.yielding.untouched())
    if prepared.wearing is not None:
        state = replace(state, wear=unworn(prepared.wearing))
    standing = Standing(released=prepared.released)
    return Checkpoint.of(model, interface, state, standing, Loading(), prepared.candidates)


def _fitting(prepared: Prepared, start: Checkpoint) -> Checkpoint:
    """A state from which this model can go on: in equilibrium here too, under supports that prescribe what they did."""
    model, point = prepared.model, start.state.point
    zero = dict.fromkeys(model.scaled_names, 0.0)
    factors = zero | {name: factor for name, factor in point.factors.items() if name in zero}
    state = _worn_alike(prepared, replace(start.state, point=replace(point, factors=factors)))
    constraints = _constraints(prepared, start.standing.released)
    now = replace(
        prepared,
        absent=pairs_of(model, prepared.interface, start.standing.inactive),
        constraints=constraints,
        scale=data_scale(prepared.space, model, start.loading, prepared.interface).bent(prepared.softness),
    )
    refuse_moved(now, state)
    found = measured(now, state)
    # pairs that follow the bodies hand over first, which no state before is in balance with
    if not found.imbalance <= TOLERANCE and not model.slides:
        raise InputError(
            f"is not in equilibrium in this model (residual {found.equilibrium:.1e} of the loads); expected the same "
            "bodies, materials, supports and loads",
            where=("start",),
        )
    return replace(start, state=state)


def _worn_alike(prepared: Prepared, state: State) -> State:
    """A state whose sides are worn where those of the model wear; nowhere, where nothing was worn before it."""
    sides = 0 if prepared.wearing is None else len(prepared.wearing)
    if prepared.wearing is not None and state.wear is None:
        return replace(state, wear=unworn(prepared.wearing))
    if state.wear is not None and len(state.wear.depth) != sides:
        raise InputError(
            f"has sides that are worn at {len(state.wear.depth)} nodes; sides of the model wear at {sides}, expected "
            "the same",
            where=("start",),
        )
    return state


def _follow(
    prepared: Prepared,
    begin: Checkpoint,
    wellposed: bool,
    after_step: Callable[[History], None] | None,
    tape: Tape | None,
    seen: Sequence[PlacesOnRanks],
) -> History:
    """Step after step, up to the end or to what stops it; then the last one goes as far as it was followed.

    Pairs that were left out as too far apart are looked at after every increment; where one has met the other side, or
    nothing was found without them, the step is solved again with all pairs, and so are those after it.
    """
    given, begin = prepared.meshed or prepared, replace(begin, state=begin.state.at_hand())
    model, interface, state, standing = given.model, given.interface, begin.state, begin.standing
    schedule = list(stages(model, factors=state.point.factors, before=standing))
    prepared.clock.expect(sum(_expected(stage) for stage in schedule))
    steps: list[StepResult] = []
    constraints = _constraints(prepared, standing.released)
    end, first = begin, instant_of(prepared, state) if state.nodal[0].any() else None
    if tape is not None:
        tape.end = begin.state
    try:
        for stage in schedule:
            prepared, loading = prepared.ready(stage, end.loading)
            why = ""
            while True:
                try:
                    with prepared.clock.again(why):
                        if stage.friction or stage.inactive:
                            now = staged(prepared, stage, loading)
                        else:
                            now = prepared.under(prepared.interface, loading, prepared.absent)
                        followed, cycle_ends = _from(end, constraints, now, stage, tape, seen)
                    break
                except SolveFailed:
                    if not (prepared.limited or prepared.spared):
                        raise
                    far = "once more, with the pairs that seemed too far apart"
                    why = far if prepared.limited else "once more, on the condensed interface"
                    with prepared.clock.again(why):
                        prepared = prepared.widened()
            if prepared.space.number_of_dofs > _GIVEN_BACK_FROM:
                give_memory_back()  # of recovery, before results at all events are made beside the factor
            result = step_result(now, stage, followed, cycle_ends)
            so_far = followed.after, stage.standing, loading, prepared.candidates, prepared.increments
            after = Checkpoint.of(model, interface, *so_far)
            if tape is not None:
                tape.take(followed.legs, followed.after, stage.name)
            # at once, whenever an interruption comes
            steps, end, constraints = [*steps, result], after, now.constraints
            if followed.prepared is not None:
                nominal = with_geometry(prepared.interface, followed.prepared.interface)
                prepared = followed.prepared.under(nominal, loading, prepared.absent)
            if after_step is not None and len(steps) < len(schedule):
                words = f"{len(steps)} of {len(schedule)} steps are finished"
                after_step(_history(prepared, Outcome.RUNNING, words, steps, end, first))
    except (SolveFailed, KeyboardInterrupt, MemoryError) as stop:
        status = Outcome.INTERRUPTED
        number = min(len(steps) + 1, len(schedule))
        words = f"interrupted in step {number} of {len(schedule)}; {len(steps)} steps were finished"
        if isinstance(stop, SolveFailed):
            status, words = stop.status, str(stop)
        if isinstance(stop, MemoryError):
            status, words = Outcome.NOT_FOUND, f"step {number} of {len(schedule)}: {out_of_memory(stop)}"
        last = _kept(prepared, end) if steps else None
        part = None if isinstance(stop, MemoryError) else reached(stop)
        if part is not None:
            steps.append(step_result(now, schedule[len(steps)], part, (), finished=False))
        return replace(_history(prepared, status, words, steps, last, first), escape=_motion(stop))
    history = _history(prepared, Outcome.SOLVED, "", steps, _kept(prepared, end), first)
    return replace(history, wellposedness=assess(now, end.state)) if wellposed else history


def _kept(prepared: Prepared, end: Checkpoint) -> Checkpoint:
    """The end of a history that nothing goes on from now; bodies on ranks have its state there."""
    return replace(end, state=kept_by_ranks(end.state)) if on_ranks(prepared.K) else end


def _from(
    end: Checkpoint,
    before: Constraints,
    now: Prepared,
    stage: Stage,
    tape: Tape | None,
    seen: Sequence[PlacesOnRanks],
) -> tuple[FollowedPart, list[float]]:
    """A step from the end of the one before it and its supports, with the supports and contacts that it changes."""
    state = end.state if stage.released == end.standing.released else handed_over(now, before, end.state)
    if stage.inactive != end.standing.inactive:
        state = switched(now, state, pairs_of(now.model, now.interface, end.standing.inactive))
    if tape is not None and state is not end.state:
        alone = stage.inactive == end.standing.inactive and locks_bolts(now.model, end.standing, stage)
        tape.change(end.state, state, stage.name, locks=alone)
    return _step(now, stage, state, tape is not None, seen)


def _motion(stop: BaseException) -> Any:
    return stored(stop, "motion") if isinstance(stop, SolveFailed) else None


def _expected(stage: Stage) -> int:
    number = stage.step.increments
    return (number if isinstance(number, int) else 1) * len(stage.ends)


def _constraints(prepared: Prepared, released: frozenset[str]) -> Constraints:
    """Under some of the supports; the prepared ones where those are they."""
    if released == prepared.released:
        return prepared.constraints
    return make_constraints(prepared.space, prepared.model, without=released, spread=prepared.constraints.spread)


def _step(
    prepared: Prepared, stage: Stage, state: State, taped: bool, seen: Sequence[PlacesOnRanks]
) -> tuple[FollowedPart, list[float]]:
    """A step from what it changes at once through all its straight parts; and the load factors at its cycles' ends."""
    behind: list[FollowedPart] = []
    cycle_ends: list[float] = []
    at_events = stage.step.at == "events"
    # the work of temperatures needs the displacements, see signorini.engine.energy
    heated = prepared.model.heats
    # sides that slide far hand over first, and then what friction no longer holds slips too
    carried = not prepared.model.slides and state.bonds is None and bool(state.forces.any())
    change = relaxed(prepared, state, stage.name) if carried else None
    if change is not None:
        after, certificate, trace = change
        slipped = FollowedPart(
            path="single",
            before=state,
            after=after,
            certificates=(certificate,),
            trace=(trace,),
            snapshots=(Snapshot(number=stage.number, fraction=0.0, what="change", state=after),),
            notes=(RELAXED,),
            legs=(Leg.at_once(prepared, stage.name, state, after, stage.number - 1.0),),
        )
        for places in seen:
            places.take(prepared, stage, 0, slipped)
        behind.append(lightened(slipped, every=at_events, end=False, heated=heated, taped=taped))
        state = after
    reaction, offset = state.point.left
    if len(offset):
        reaction, offset = at_the_end(prepared, stage, state.point)
    end = LoadPoint(
        factors=stage.ends[-1],
        gap=(pressed_gap(prepared, stage) if stage.interference else prepared.interface.gap) + prepared.worn_gap(state),
        given=np.zeros_like(state.point.given),
        reaction=reaction,
        offset=offset,
    )
    if prepared.wearing is not None:
        try:
            parts, cycle_ends = follow_wearing(prepared, stage, state, end, heated=heated)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, behind) from None
        return joined([*behind, *parts]), cycle_ends
    for interval, point in straight_parts(stage, state.point, end):
        part = StepPart(
            prepared=prepared, where=stage.name, interval=interval, before=state, end=point, whole=at_events
        )
        try:
            way = partial(follow_part, stage)
            followed = follow_sliding(part, way) if prepared.model.slides else way(part)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, behind) from None
        for places in seen:
            places.take(prepared, stage, sum(len(part.snapshots) for part in behind), followed)
        followed = lightened(followed, every=at_events, end=interval.asked, heated=heated, taped=taped)
        behind = [joined([*behind, followed])]
        state = followed.after
        if interval.cycle:
            cycle_ends.append(interval.factor(1.0))
    return behind[0], cycle_ends


def _history(
    prepared: Prepared,
    status: Outcome,
    message: str,
    steps: list[StepResult],
    end: Checkpoint | None,
    begin: Instant | None,
) -> History:
    return History(
        model=(prepared.meshed or prepared).model,
        status=status,
        message=message,
        steps=tuple(steps),
        backend=prepared.solver.name,
        timings=dict(prepared.clock.seconds),
        pairs=len(prepared.interface),
        end=end,
        begin=begin,
    )
