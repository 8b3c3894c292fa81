# SPDX-License-Identifier: BSD-3-Clause
"""Straight parts of a step in which bodies may yield: as elastic bodies until a point does, then in increments.

Increments are backward Euler, of first order: as many as it takes for their halves to change the answer less than a
tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import ceil

import numpy as np

from signorini.arrays import Array
from signorini.engine.collapse import Collapse, collapse
from signorini.engine.first_yield import AT_ONCE, elastic_part, flows_at_once, points_of
from signorini.engine.increments import advance, follow_increments
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, StepPart, joined, keep, reached
from signorini.errors import SolveFailed, told
from signorini.model.step import Step
from signorini.outcome import Outcome

TOLERANCE = 1e-2
"""Of ``increments = "auto"`` where bodies yield, if the step gives none: backward Euler is of first order."""

_INCREMENTS_BELOW = 8  # of what is followed below collapse: the load named is a bound, they may end before it
_TIGHTER_BOUNDS = 4  # of a limit load, each from the load that the one before names
_BOUND_TOL = 3e-4  # of a limit load: bounds that would move by less are not sought again
_BELOW_COLLAPSE = 0.98  # of the load at which bodies flow: up to there they are followed
_LITTLE_WORK = 1e-6  # of the plastic work so far: where a part takes less, its share decides nothing
_MAX_INCREMENTS = 256  # of a straight part: more of them are not tried by themselves


def follow_plastically(part: StepPart, step: Step, elastically: Callable[[StepPart], FollowedPart]) -> FollowedPart:
    """Follow a straight part of a step.

    Parameters
    ----------
    part : of a model with bodies that yield
    step : what was asked for
    elastically : follows a part in which nothing yields as the step asks for

    Raises
    ------
    SolveFailed
        Where bodies flow without end, with the load at most; or as increments and elastic paths do.
    """
    behind: list[FollowedPart] = []
    if not flows_at_once(part):
        begun, rest = elastic_part(part, elastically)
        behind = [] if begun is None else [begun]
        if rest is None:
            return joined(behind)
        part = rest
    if step.path == "exact":
        words = told(
            f"{part.where} at {part.interval.low:.6%}: a point yields, and plastic flow has no exact path",
            remedy="follow the step in increments, or leave path out",
        )
        raise keep(SolveFailed(words, status=Outcome.NOT_FOUND), behind)
    try:
        return joined([*behind, replace(_in_increments(part, step), path="increments")])
    except SolveFailed as failure:
        if (flowed := reached(failure)) is not None:
            failure.reached = replace(flowed, path="increments")
        raise keep(failure, behind) from None


def _in_increments(part: StepPart, step: Step) -> FollowedPart:
    """A part in which points yield: in the increments asked for, or more and more of them."""
    length = part.interval.high - part.interval.low
    if isinstance(step.increments, int):
        return _increments(part, max(1, ceil(step.increments * length - 1e-9)))
    tolerance = TOLERANCE if step.tolerance is None else step.tolerance
    number, coarse = 1, None
    # increments may be so long that nothing yields any more at their end
    varies = points_of(part.prepared, part.before)[0].laws.varies
    while True:
        try:
            fine = _increments(part, number)
        except SolveFailed as failure:
            if failure.hopeless or 4 * number > _MAX_INCREMENTS:
                raise
            number, coarse = 4 * number, None
            continue
        if coarse is not None:
            change, words = _change(part.prepared, coarse, fine)
            note = f"{number} increments of plastic flow: half as many change {words}"
            if change <= tolerance and (fine.after.plastic_work > part.before.plastic_work or not varies):
                return replace(fine, notes=(*fine.notes, note))
            if 2 * number > _MAX_INCREMENTS:
                return replace(fine, notes=(*fine.notes, f"{note}, more than {tolerance:g}"))
        number, coarse = 2 * number, fine


def _increments(part: StepPart, number: int) -> FollowedPart:
    """A part in equal increments; where bodies flow without end the load at most is named.

    Raises
    ------
    SolveFailed
        If an increment has no certified solution.
    """
    try:
        return follow_increments(part, number)
    except SolveFailed as failure:
        if not failure.mechanisms:
            raise
        if part.prepared.limited:  # pairs that were left out may hold the bodies
            failure.hopeless = True
            raise
        behind = reached(failure)
        done, state = (0, part.before) if behind is None else (len(behind.snapshots), behind.after)
        end = part.before.point.towards(part.end, (done + 1) / number)
        found = collapse(part.prepared, state.point, end, failure.mechanisms)
        if found is None:
            raise
        raise _collapsed(part, *_tightened(part, found, (done + found.part) / number), number) from failure


def _tightened(part: StepPart, found: Collapse, fraction: float) -> tuple[Collapse, float]:
    """A mechanism and the fraction of a part that it bounds, from loads no farther beyond the limit than the bound.

    Far beyond it bodies flow in a motion that costs up to some hundredths more than the cheapest.

    Parameters
    ----------
    part : with that limit
    found, fraction : the first mechanism and its bound
    """
    before = 0.0  # the first move tells nothing of the next one
    for _ in range(_TIGHTER_BOUNDS):
        try:
            advance(part.prepared, part.before, part.before.point.towards(part.end, fraction), part.where)
        except SolveFailed as failure:
            again = collapse(part.prepared, part.before.point, part.end, failure.mechanisms)
        else:
            break
        if again is None or again.part >= fraction:
            break
        moved = fraction - again.part
        found, fraction = again, again.part
        if moved * min(moved, before) < _BOUND_TOL * fraction * before:  # moves fall faster and faster
            break
        before = moved
    return found, fraction


def _collapsed(part: StepPart, found: Collapse, fraction: float, number: int) -> SolveFailed:
    """The failure that names the load, with what can be followed below it."""
    limit = part.interval.fraction(fraction)
    proof = (
        "friction that slips is not associated: evidence, no proof"
        if found.rubs
        else "loads do more work on the mechanism than plastic flow can take: proved for this mesh"
    )
    beyond = "" if found.rubs else ": beyond there is no equilibrium"
    words = told(
        f"{part.where}: bodies flow plastically at {limit:.4%} of the step at most{beyond}",
        remedy="less load, a harder material, or a prescribed motion in place of the load",
        evidence=proof,
    )
    status = Outcome.NOT_FOUND if found.rubs else Outcome.NO_EQUILIBRIUM
    failure = SolveFailed(words, status=status, motion=found.motion)
    failure.hopeless = True
    if fraction > AT_ONCE:
        try:
            count = max(_INCREMENTS_BELOW, ceil(number * fraction))
            behind = follow_increments(part.cut(_BELOW_COLLAPSE * fraction, "event"), count)
        except SolveFailed as stop:
            return keep(failure, [found for found in [reached(stop)] if found is not None])  # type: ignore[return-value]
        return keep(failure, [behind])  # type: ignore[return-value]
    return failure


def _change(prepared: Prepared, coarse: FollowedPart, fine: FollowedPart) -> tuple[float, str]:
    """By how much two ways between the same loads differ, tractions in the norm of areas, and in words."""
    interface, one, two = prepared.interface, coarse.after, fine.after
    area = np.sqrt(interface.area)
    tractions = _ratio((two.forces - one.forces) / area, two.forces / area) if len(area) else 0.0
    spent = [points_of(prepared, state)[1].dissipation for state in (fine.before, one, two)]
    taken = abs(spent[2] - spent[1]) / (max(abs(spent[2] - spent[0]), _LITTLE_WORK * spent[2]) or 1.0)
    return max(tractions, taken), f"tractions by {tractions:.1e} of their size and plastic work by {taken:.1e} of it"


def _ratio(change: Array, whole: Array) -> float:
    """Norm of a change over that of the whole."""
    largest = float(np.linalg.norm(whole))
    return float(np.linalg.norm(change)) / largest if largest else 0.0
