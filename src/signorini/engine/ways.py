# SPDX-License-Identifier: BSD-3-Clause
"""The way through a straight part of a step: exact, in increments, with bodies at rest, on the bodies as they are."""

from __future__ import annotations

from dataclasses import replace
from math import ceil

from signorini.arrays import stored
from signorini.engine.automatic import follow_automatically
from signorini.engine.bond_increments import BOND_INCREMENTS, told_of_breaks, with_increments
from signorini.engine.events import follow_exactly
from signorini.engine.floating_bodies import approached, resting
from signorini.engine.increments import follow_increments
from signorini.engine.jump_watch import follow_watchfully
from signorini.engine.limit_load import known
from signorini.engine.plastic_steps import follow_plastically
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Interval, StepPart, joined, keep, reached
from signorini.errors import SolveFailed
from signorini.linalg import NotPositiveDefinite
from signorini.model.stage import Stage
from signorini.model.step import Step
from signorini.outcome import Outcome

GIVEN_WAY = "the condensed interface gave no certified answer; contact was solved on the bodies as they are"
"""What a step says that was solved so."""

TOLERANCE_OF_FORCES = 1e-3
"""Of ``increments = "auto"``, where the step gives none and nothing yields."""

_BEHIND_A_JUMP = 10  # increments
SPACE_INCREMENTS = 16
"""In space, where no number is asked for: none need be shorter than 1/16 of a straight part."""


def follow_part(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step, bodies that float first to where they touch.

    Parameters
    ----------
    stage : the step
    part : of it

    Raises
    ------
    SolveFailed
        As far as nothing leads on; it carries what was followed.
    """
    if part.prepared.interface.cohesion is not None:
        return _bonded(stage, part)
    in_increments = stage.step.increments is not None or stage.step.path == "increments"
    first = approached(part, relieving=not in_increments)
    if first is None:
        return joined([_on_interface_or_bodies(stage, part)])
    try:
        return joined([first, _on_interface_or_bodies(stage, replace(part, before=first.after))])
    except (SolveFailed, KeyboardInterrupt) as stop:
        raise (keep(stop, [first]) if reached(stop) is not None else stop) from None


def _bonded(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step with bonds: exactly where that is possible and no increments are asked for."""
    step = stage.step
    uncondensed = part.prepared.solver.paths is None and step.path != "exact"
    if uncondensed or step.path == "increments" or step.increments == "auto":
        return told_of_breaks(part, _bonded_in_increments(stage, with_increments(part)))
    return _bonded_exactly(stage, part)


def _bonded_in_increments(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step with bonds in as many increments as are asked for, or as it takes."""
    step = stage.step
    if part.prepared.flows:
        return follow_plastically(part, step, lambda elastic: _bonded_in_increments(stage, elastic))
    if step.increments == "auto" or (step.increments is None and step.path is None):
        tolerance = step.tolerance or TOLERANCE_OF_FORCES
        return follow_automatically(part, tolerance, enough=BOND_INCREMENTS)
    return follow_increments(part, _increments(step, part.interval, stage))


def _bonded_exactly(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step with bonds, exactly; increments that are asked for are ends on the way."""
    step, behind = stage.step, []
    number = _increments(step, part.interval, stage)
    rest = part
    try:
        for k in range(1, number + 1):
            end = part.before.point.towards(part.end, k / number)
            interval = replace(rest.interval, high=part.interval.fraction(k / number))
            ends = interval if k == number else replace(interval, ends="asked")
            followed = follow_exactly(replace(rest, end=end, interval=ends), jumps=step.jump != "stop")
            behind.append(followed)
            rest = replace(rest, before=followed.after, interval=replace(part.interval, low=interval.high))
    except (SolveFailed, KeyboardInterrupt) as stop:
        raise keep(stop, behind) from None
    return joined(behind)


def _on_interface_or_bodies(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step on the condensed interface; where that is lost, on the bodies as they are."""
    try:
        return _with_bodies_at_rest(stage, part)
    except SolveFailed as failure:
        lost = known(failure, part)
        if lost.status != Outcome.NOT_FOUND or lost.hopeless or lost.unsettled:
            raise lost from None
        if not _gives_way(part.prepared, stage.step):
            raise lost from None
    clock = part.prepared.clock
    try:
        with clock.again("once more, on the bodies as they are"):
            followed = _iterated(stage, replace(part, prepared=part.prepared.with_multipliers()))
    except (SolveFailed, NotPositiveDefinite):
        raise lost from None
    return replace(followed, notes=(*followed.notes, GIVEN_WAY))


def _gives_way(prepared: Prepared, step: Step) -> bool:
    """Whether a step that is lost may go the other way: pairs that were left out come first, exact paths have none."""
    return step.path != "exact" and not prepared.limited and prepared.has_multipliers


def _with_bodies_at_rest(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step while bodies that nothing touches rest; if something does, wherever they go."""
    calm = resting(part)
    try:
        return _as_asked(stage, calm)
    except SolveFailed:
        if calm is part:
            raise
    return _as_asked(stage, part)


def _without_flow(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step in which nothing yields: in the plane exactly, so that first yield is exact."""
    if part.prepared.interface.directions == 2 and part.prepared.solver.paths is not None:
        try:
            return follow_exactly(part, jumps=stage.step.follows_jumps)
        except SolveFailed:
            if stage.step.path == "exact":
                raise
    return _as_asked(stage, part)


def _as_asked(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step as asked; where nothing was asked, exactly if there is Coulomb friction.

    In space, where the exact cone has no exact path, in increments to events, more of them until the answer stays.
    Where the exact path that nobody asked for ends in a jump or is lost, it is followed in increments, and the notes
    say so: what they reach behind a jump is a candidate.
    """
    step, interface = stage.step, part.prepared.interface
    if part.prepared.flows:
        return follow_plastically(part, step, lambda elastic: _without_flow(stage, elastic))
    jump = "follow" if step.follows_jumps else step.jump
    rubbing = bool((interface.friction.bounded & ~part.prepared.absent).any()) or interface.remembers
    if step.path != "exact" and (step.path is not None or step.increments is not None or not rubbing):
        if step.increments == "auto":
            return follow_automatically(part, step.tolerance or TOLERANCE_OF_FORCES, jump=jump)
        number = _increments(step, part.interval, stage)
        return follow_watchfully(part, number, stops=step.jump == "stop")
    if step.path is None and (interface.directions == 3 or not interface.friction.straight):
        return follow_automatically(part, step.tolerance or TOLERANCE_OF_FORCES, enough=SPACE_INCREMENTS, jump=jump)
    try:
        return follow_exactly(part, jumps=step.follows_jumps)
    except SolveFailed as failure:
        if step.path == "exact" or step.jump == "stop":
            raise
        try:
            followed = follow_increments(part, _BEHIND_A_JUMP)
        except SolveFailed as nothing:
            words = f"{failure.sentence}; nor do increments go on: {nothing.sentence}{nothing.details}"
            status = failure.status if nothing.status == Outcome.NOT_FOUND else nothing.status  # a jump is proved
            worse = SolveFailed(words, status=status, motion=stored(nothing, "motion"))
            worse.reached = failure.reached  # the exact path goes farther
            raise worse from failure
        return replace(
            followed, notes=(f"{failure.sentence}; followed in {_BEHIND_A_JUMP} increments to what is a candidate",)
        )


def _iterated(stage: Stage, part: StepPart) -> FollowedPart:
    """Follow a straight part of a step in increments: as many as asked for; as behind a jump where a path was lost."""
    interface = part.prepared.interface
    rubbing = bool(interface.friction.bounded.any())
    if interface.directions == 2 and stage.step.path is None and stage.step.increments is None and rubbing:
        return follow_increments(part, _BEHIND_A_JUMP)
    return _as_asked(stage, part)


def _increments(step: Step, interval: Interval, stage: Stage) -> int:
    """Of a straight part: those of its whole segment, as far as they go."""
    number = step.increments if isinstance(step.increments, int) else 1
    return max(1, ceil(number * (interval.high - interval.low) * len(stage.ends) - 1e-9))
