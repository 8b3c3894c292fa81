# SPDX-License-Identifier: BSD-3-Clause
"""Increments in space that say where they step over gross sliding or another jump.

An equilibrium behind one is right by itself, but no history leads there gradually. An increment in which contact alone
holds bodies, and which moves a pair farther than all loads compress them, is looked at in increments to events.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from signorini.engine.events import follow_to_events
from signorini.engine.increments import follow_increments
from signorini.engine.limit_load import LimitLoad, known, limit_load, slide
from signorini.engine.path_states import path_state, recovered, right_hand_side
from signorini.engine.prepare import Prepared
from signorini.engine.solver import compression
from signorini.engine.step_parts import FollowedPart, StepPart, keep, reached
from signorini.errors import SolveFailed, told
from signorini.friction.history.space.bearing import Bearing, bears
from signorini.friction.overload import Overload
from signorini.outcome import Outcome
from signorini.solution.state import State

CURVED = "contact alone holds bodies and its friction has no straight branches: slides of them are not looked for"

ZOOMS = 4
"""Times that the largest change is looked at in increments, each time in that one of them that holds it."""

WATCH_INCREMENTS = 16
"""In as many each time."""

_SHORT_OF_LIMIT = 0.999  # of the load that contact can hold: how far one increment goes
_SUDDEN = 0.5  # of that change, in one of them each time: no increments resolve it
_STRAIGHT = 0.5  # of the way looked at: an increment as long is no 16th of it, no pair acts in it
_SAME_LOAD = 1e-9  # part of a step: how far behind the end of an increment a jump at its very end may be seen


def follow_watchfully(part: StepPart, number: int, *, stops: bool = False) -> FollowedPart:
    """Follow a straight part of a step in equal increments, and say where bodies lose their hold on the way.

    Parameters
    ----------
    number : of increments
    stops : whether the way ends at a jump; otherwise it goes on, and a note says from where on it is a candidate

    Raises
    ------
    SolveFailed
        If an increment has no certified solution; with status "jump" where the history does not lead there gradually.
    """
    try:
        followed = _up_to_the_limit(part, number)
    except SolveFailed as failure:
        lost, found = known(failure, part), reached(failure)
        if lost.status != Outcome.NOT_FOUND:
            raise lost from None
        passed = None if found is None else next(_jumps(part, found, number), None)
        if found is not None and passed is not None:
            raise keep(passed[1], [_up_to(found, passed[0])] if passed[0] else []) from lost
        held = found.after if found else part.before
        jump = None if _bears(part, held) else _jump(part, held, _done(part, found), 1.0)
        if jump is None:
            raise
        raise keep(jump, [] if found is None else [found]) from lost
    notes = []
    for k, jump in _jumps(part, followed, number):
        if stops:
            raise keep(jump, [_up_to(followed, k)] if k else [])
        words = f"{number} increment{'s' if number > 1 else ''}"
        notes.append(f"{jump.sentence}; followed in {words} to what is a candidate")
    return unwatched(part, replace(followed, notes=(*followed.notes, *notes)))


def _jumps(part: StepPart, followed: FollowedPart, number: int) -> Iterator[tuple[int, SolveFailed]]:
    """Jumps that equal increments have stepped over, each with how many increments were before it.

    Parameters
    ----------
    followed : as much of the part as was followed
    number : of increments in all of it
    """
    before, told_at = part.before, -2
    for k, shot in enumerate(followed.snapshots):
        if _far(part, before, shot.state):
            jump = _jump(part, before, k / number, min(1.0, (k + 2) / number))
            here = None if jump is None else reached(jump)
            if jump is not None and (here is None or here.snapshots[-1].load_factor <= shot.load_factor + _SAME_LOAD):
                seen = here is None and told_at == k - 1  # just before the end of the last one
                if not seen:
                    yield k, jump
                told_at = told_at if seen and part.prepared.watched else k
        before = shot.state


def _up_to_the_limit(part: StepPart, number: int) -> FollowedPart:
    """A part in equal increments; where contact is iterated, and can hold bodies no longer than that, up to there.

    Multipliers take many rounds to find nothing, so what the loads and the friction alone tell is asked first.

    Raises
    ------
    SolveFailed
        As `follow_increments` does, and at the limit.
    """
    prepared = part.prepared
    found = None if prepared.solver.paths is not None else limit_load(prepared, part.before, part.end, near=False)
    if not isinstance(found, LimitLoad):
        return follow_increments(part, number)
    whole = int((1.0 - _SAME_LOAD) * found.factor * number)
    reach = whole / number if whole else _SHORT_OF_LIMIT * found.factor
    begun: list[FollowedPart] = []
    if reach > 0.0:
        begun = [follow_increments(part.cut(reach, "jump"), whole or 1)]
    raise keep(SolveFailed(f"{part.where}: contact cannot hold the bodies any longer", status=Outcome.NOT_FOUND), begun)


def unwatched(part: StepPart, followed: FollowedPart) -> FollowedPart:
    """A part of a step, with a note where bodies may slide on their friction and nobody looks for it.

    Parameters
    ----------
    followed : the part, as it was followed in increments
    """
    prepared, interface = part.prepared, part.prepared.interface
    rubbing = bool((interface.friction.bounded & ~prepared.absent).any())
    curved = interface.directions == 3 and not interface.friction.straight
    if not curved or not prepared.floating.shape[1] or not rubbing or not followed.after.forces.any():
        return followed
    return replace(followed, notes=(*followed.notes, CURVED))


def sudden_change(part: StepPart, followed: FollowedPart) -> SolveFailed | None:
    """The largest change of contact forces from one state of a part to the next as a jump; None where it is gradual.

    Where finer increments end elsewhere, the history has parted there. Otherwise strong evidence, no proof: it stays
    as large in one of 16 increments, in one of 16 of that, and so on, four times.

    Parameters
    ----------
    followed : the part in space, as it was followed in increments
    """
    if not part.prepared.watched:
        return None
    within = part.interval.within
    states, shots = [followed.before, *(shot.state for shot in followed.snapshots)], followed.snapshots
    ends = [0.0, *(within(shot.fraction) for shot in shots)]
    size, first = max(float(np.abs(state.forces).max(initial=0.0)) for state in states), 0.0
    for zoom in range(ZOOMS):
        changes = [float(np.abs(two.forces - one.forces).max(initial=0.0)) for one, two in pairwise(states)]
        k = int(np.argmax(changes))
        first = first or changes[k]
        if changes[k] < _SUDDEN * first or changes[k] == 0.0:
            return None
        low, high = ends[k], ends[k + 1]
        if zoom and high - low > _STRAIGHT * (ends[-1] - ends[0]):
            return None  # in proportion to the load, which changes much
        before = _whole(part, states[k]) if k and not shots[k - 1].whole else states[k]
        try:
            finer = follow_to_events(_between(part, before, low, high), WATCH_INCREMENTS)
        except SolveFailed as failure:
            return failure if failure.status == Outcome.JUMP else None
        apart = float(np.abs(finer.after.forces - states[k + 1].forces).max(initial=0.0))
        if apart >= _SUDDEN * first:
            return _parted(part, low, high, apart / size)
        states, shots = [before, *(shot.state for shot in finer.snapshots)], finer.snapshots
        ends = [low, *(within(shot.fraction) for shot in shots)]
    here, length = part.interval.fraction(low), part.interval.fraction(high) - part.interval.fraction(low)
    return SolveFailed(
        told(
            f"{part.where} at {here:.6%}: a jump: contact forces change by {first / size:.2g} of the largest within "
            f"{length:.0e} of the step",
            remedy="less friction, or a prescribed motion in place of the load",
            evidence=f"no increments resolve the change, however short: strong evidence, no proof; it was looked at in "
            f"{WATCH_INCREMENTS} of them, and in {WATCH_INCREMENTS} of that which holds it, {ZOOMS} times in all",
        ),
        status=Outcome.JUMP,
    )


def _parted(part: StepPart, low: float, high: float, share: float) -> SolveFailed:
    """Two ways between the same loads, fractions low and high of a part, whose forces differ by a share, as a jump."""
    here, there = part.interval.fraction(low), part.interval.fraction(high)
    return SolveFailed(
        told(
            f"{part.where} between {here:.6%} and {there:.6%}: the history parts: from one equilibrium two ways "
            f"lead to others whose contact forces differ by {share:.2g} of the largest",
            remedy="less friction, or a tangential compliance where forces are shared in many ways",
            evidence=f"both are certified at the same load, one in a single increment, one in up to {WATCH_INCREMENTS}",
        ),
        status=Outcome.JUMP,
    )


def _whole(part: StepPart, state: State) -> State:
    """A state on the way with all that it takes to go on from it: bodies, and pairs that the law is not asked of."""
    return recovered(part.prepared, part.before, state.point, path_state(part.prepared, state))


def _far(part: StepPart, before: State, after: State) -> bool:
    """Whether an increment moves a pair farther than all loads compress bodies that contact alone holds."""
    prepared = part.prepared
    if not _looked_at(prepared) or not prepared.floating.shape[1] or not before.forces.any():
        return False
    moved = (after.motion - before.motion)[:, prepared.solver.active & ~prepared.absent]
    far = compression(prepared.interface, prepared.scale, prepared.solver.active)
    return bool(np.abs(moved).max(initial=0.0) > far)


def _looked_at(prepared: Prepared) -> bool:
    """Whether slides are looked for: in space, and where contact is iterated."""
    return prepared.interface.directions == 3 or prepared.solver.paths is None


def _bears(part: StepPart, state: State) -> bool:
    """Whether contact can hold all bodies from a state to the end of a part, so that no slide is to be looked for."""
    prepared, paths = part.prepared, part.prepared.solver.paths
    if prepared.interface.directions == 2 or paths is None:
        return False
    return bears(paths.law, path_state(prepared, state), right_hand_side(prepared, part.end))


def _done(part: StepPart, followed: FollowedPart | None) -> float:
    """How much of a part was followed, 0 .. 1."""
    if followed is None:
        return 0.0
    return part.interval.within(followed.snapshots[-1].fraction)


def _jump(part: StepPart, state: State, low: float, high: float) -> SolveFailed | None:
    """The first jump between the fractions low and high of a part, from the state at low; None where none is seen."""
    if not part.prepared.watched:
        return slide(part, state, low, high) if _looked_at(part.prepared) else None
    try:
        behind, known = low / (high - low), _known(part)
        ahead = (
            None if known is None or known.factor <= low else replace(known, factor=(known.factor - low) / (high - low))
        )
        follow_to_events(_between(part, state, low, high), 1, behind=behind, known=ahead)
    except SolveFailed as failure:
        return failure if failure.status == Outcome.JUMP else None
    return None


def _known(part: StepPart) -> Overload | None:
    """Where the pairs that are near at the beginning of a part hold bodies no more, part of it; None where they do."""
    paths, start = part.prepared.paths, path_state(part.prepared, part.before)
    bearing = Bearing(paths.law, right_hand_side(part.prepared, part.end))
    bearing.reach(start, 0.0)
    return bearing.least


def _between(part: StepPart, state: State, low: float, high: float) -> StepPart:
    """What lies between the fractions low and high of a part, from the state at low."""
    interval = replace(part.interval, low=part.interval.fraction(low), high=part.interval.fraction(high), ends="jump")
    return replace(part, before=state, end=part.before.point.towards(part.end, high), interval=interval)


def _up_to(followed: FollowedPart, count: int) -> FollowedPart:
    """The first increments of a part."""
    return replace(
        followed,
        after=followed.snapshots[count - 1].state,
        certificates=followed.certificates[:count],
        trace=followed.trace[:count],
        snapshots=followed.snapshots[:count],
    )
