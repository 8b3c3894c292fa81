# SPDX-License-Identifier: BSD-3-Clause
"""As many increments as it takes: more of them, until the answer changes less than a tolerance.

Where the law of contact holds all along them they are enough as they are.

In the plane 1, 2, 4, ... equal ones. In space they end at events (a pair opens, closes or starts to slip), on the exact
cone too, unless that would make them shorter than 1, 1/4, 1/16, ... of the way; where friction turns little and nothing
happens they are longer. Where that way is lost they are equal as in the plane. Jumps on it are followed, or end it.
Where sides slide far, and errors of strides add up, they are shorter where pairs act, until the energy balances.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.arrays import stored
from signorini.engine.energy import missing_energy
from signorini.engine.events import follow_to_events
from signorini.engine.increments import follow_increments, is_straight
from signorini.engine.jump_watch import follow_watchfully, sudden_change
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, StepPart
from signorini.errors import SolveFailed, told
from signorini.outcome import Outcome

MORE_IN_SPACE = 4
"""Times as many increments are tried next in space, unless the law holds all along those that were tried."""

_CERTAIN = 16  # increments on a way in space of which it is believed that it jumps, or that it does not
_VAIN = 16  # times as many increments, that change the answer no less: it does not settle
_LOST = 4  # times the number that is enough: the most that are tried where a way in space is lost
_BALANCE = 1e-4  # of the work of a stride in space: energy that is missing where increments pass over events
_ACTING = 16  # times shorter increments of strides where pairs act: energy balances to a tenth of that, or better
_FINER_HINT = 'expected less? Give the step increments = "auto" or their number'


def follow_automatically(
    part: StepPart,
    tolerance: float,
    *,
    enough: int | None = None,
    jump: Literal["stop", "follow"] | None = None,
) -> FollowedPart:
    """Follow a straight part of a step in more and more increments, each time from its beginning.

    Parameters
    ----------
    tolerance : largest change from one number to the next: of a contact force, of the largest one; and of what friction
        dissipates, of the work done on the way
    enough : number at which to stop whatever it still changes, and to say so; None: go on to the
        most that settings allow, 4096 by default
    jump : what to do at a jump, in space: stop, follow it to its landing, or None to go on without

    Raises
    ------
    SolveFailed
        If an increment has no certified solution however short, those are not enough, or 16 times as many change the
        answer no less and no jump shows why (`sudden_change`); in space 4 times ``enough`` are tried where fewer are
        lost.
    """
    coarse: FollowedPart | None = None
    prepared = part.prepared
    changes, number, tried, why = "the answer, where one is found", 1, 1, ""
    seen: dict[int, float] = {}
    plane = prepared.interface.directions == 2
    more, fewer = (2, "half as many") if plane else (MORE_IN_SPACE, "a quarter as many")
    limit = prepared.settings.automatic_increments
    most = limit if enough is None or plane else _LOST * enough
    while number <= limit:
        tried = number
        try:
            with prepared.clock.again(why):
                fine, words = _followed(part, number, jump)
        except SolveFailed as failure:
            certain = failure.hopeless or (jump == "stop" and failure.status == Outcome.JUMP and number >= _CERTAIN)
            if certain or more * number > most:
                raise
            coarse, number = None, more * number
            why = f"once more, in up to {number} increments: fewer were lost"
            continue
        if is_straight(prepared, fine):
            note = f"{words}: the law of contact holds all along, more of them would change nothing"
            return replace(fine, path="increments", notes=(*fine.notes, note))
        if coarse is not None:
            change, changes = _change(coarse, fine)
            note = f"{words}: {fewer} change {changes}"
            missing, allowed = _missing(prepared, fine), _BALANCE if prepared.model.slides else tolerance
            settled = change <= tolerance and (number >= _CERTAIN or missing <= allowed)
            if settled or (enough is not None and number >= enough):
                if prepared.model.slides and missing > _BALANCE:
                    note = f"{note}; energy is missing by {missing:.1e} of the work"
                note = note if settled else f"{note}; {_FINER_HINT}"
                return replace(fine, path="increments", notes=(*fine.notes, note))
            seen[number] = change
            if number >= _VAIN * _CERTAIN and change >= seen.get(number // _VAIN, np.inf):
                break
        coarse, number = fine, more * number
        why = f"once more, in up to {number} increments: whether the answer stays"
    sudden = sudden_change(part, fine)
    if sudden is not None and jump == "stop":
        raise sudden
    if sudden is not None:
        words = f"followed in {_counted(len(fine.trace))} to what is a candidate"
        note = f"{sudden.sentence}; {words}: {fewer} change {changes}"
        return replace(fine, path="increments", notes=(*fine.notes, note))
    unsettled = SolveFailed(
        told(
            f"{part.where}: {_counted(tried)} still change{'s' if tried == 1 else ''} {changes}",
            remedy='a larger tolerance, or path = "exact" where sections are polygons or the model is plane',
            evidence=""
            if number > limit
            else f"{number // _VAIN} changed it by no more, they lead to different answers",
        ),
        status=Outcome.NOT_FOUND,
    )
    unsettled.unsettled = True
    raise unsettled


def _change(coarse: FollowedPart, fine: FollowedPart) -> tuple[float, str]:
    """By how much two ways between the same loads differ at most, and in words."""
    forces, size = fine.after.forces - coarse.after.forces, np.abs(fine.after.forces).max(initial=0.0)
    spent, work = (fine.after.dissipation - coarse.after.dissipation).sum(), fine.after.work - fine.before.work
    change, lost = float(np.abs(forces).max(initial=0.0) / (size or 1.0)), float(abs(spent) / (abs(work) or 1.0))
    words = f"contact forces by {change:.1e} of the largest"
    return max(change, lost), f"{words} and dissipation by {lost:.1e} of the work" if lost > change else words


def _missing(prepared: Prepared, followed: FollowedPart) -> float:
    """Energy that is missing on a way in space, of its work: much where something was passed over."""
    if prepared.interface.directions == 2:
        return 0.0
    return missing_energy(prepared, followed.before, followed.after)


def _followed(part: StepPart, number: int, jump: Literal["stop", "follow"] | None) -> tuple[FollowedPart, str]:
    """A way in at most so many increments, and their number in words; equal ones where those to events are lost."""
    if part.prepared.interface.cohesion is not None:  # bonds may hold what friction does not
        return follow_increments(part, number), _counted(number)
    if not part.prepared.watched:
        return follow_watchfully(part, number, stops=jump == "stop"), _counted(number)
    try:
        acting = _ACTING if part.prepared.model.slides and number >= _CERTAIN else 1
        followed = follow_to_events(part, number, jumps=jump == "follow", acting=acting)
        words = f"{_counted(len(followed.trace))} to events, none needs to be shorter than 1/{number * acting}"
        return followed, words
    except SolveFailed as failure:
        if failure.status == Outcome.JUMP and jump == "stop":
            raise
        if failure.hopeless:
            raise _told(failure, str(failure), Outcome.NO_EQUILIBRIUM) from failure
        try:
            followed = follow_increments(part, number)
        except SolveFailed as nothing:
            words = f"{failure.sentence}; nor do {_counted(number)} go on: {nothing.sentence}"
            words = f"{words}{failure.details}{nothing.details}"
            status = (
                failure.status if nothing.status == Outcome.NOT_FOUND else nothing.status
            )  # a jump is one all the same
            raise _told(failure, words, status, nothing) from failure
        note = f"{failure.sentence}; followed in {number} increments to what is a candidate"
        return replace(followed, notes=(note,) if failure.status == Outcome.JUMP else ()), _counted(number)


def _told(failure: SolveFailed, words: str, status: Outcome, last: SolveFailed | None = None) -> SolveFailed:
    """A failure in other words, with the part of the way that increments to events have reached, or the last ones."""
    said = SolveFailed(words, status=status, motion=stored(failure if last is None else last, "motion"))
    said.reached = failure.reached or (last and last.reached)
    return said


def _counted(number: int) -> str:
    return f"{number} increment{'' if number == 1 else 's'}"
