# SPDX-License-Identifier: BSD-3-Clause
"""Follow a straight part of a step from event to event on the condensed interface, exactly where that is possible."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np

from signorini.attempt import MethodRun, Spent
from signorini.engine.bond_paths import broken, follow_bonds
from signorini.engine.closure_paths import LinesPath, follow_on_lines, on_their_lines
from signorini.engine.energy import set_free
from signorini.engine.floating_bodies import approached, resting, undisturbed
from signorini.engine.increments import certified, leaving, refuse_overlap
from signorini.engine.limit_load import HOLD
from signorini.engine.path_states import (
    balanced,
    offsets,
    on_the_way,
    path_state,
    recovered,
    right_hand_side,
    tangential,
)
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart, joined, keep, leg_of
from signorini.errors import SolveFailed, told
from signorini.friction.history import Landing, PathSettings, PathState, Segment
from signorini.friction.history.state import PRESSED
from signorini.friction.overload import Overload
from signorini.outcome import Outcome
from signorini.settings import SolverSettings
from signorini.solution.results import PairEvent
from signorini.solution.state import State

JUMPS = 100
"""Most that one straight part of a step may hold, with what else cuts it."""

_NAMED = 12  # nodes that a message lists
_TURN = 0.04  # radians over the root of the number: what friction may turn in an increment that could be shorter
_LESS = "less friction, or a prescribed motion in place of the load"
_FOLLOW = f'{_LESS}; jump = "follow" looks for the equilibrium behind the jump'
_NO_LANDING = "no equilibrium that it could land on was found"


@dataclass(frozen=True, kw_only=True, eq=False)
class _Path:
    """A part of a step as it was followed on the condensed interface.

    Attributes
    ----------
    start : its state before, in the scaled units of the law
    stops : how increments were chosen, None on an exact path
    lines : those of pairs that close by a law, where any does
    """

    part: StepPart
    start: PathState
    segment: Segment
    stops: PathSettings | None
    lines: LinesPath | None = None

    @property
    def reached(self) -> float:
        """How much of the part is behind, 0 .. 1."""
        return self.segment.pieces[-1].factor

    @property
    def cut(self) -> _Path:
        """This path, of a part that ends where it was followed to."""
        ends: Literal["event", "jump"] = "event" if self.segment.outcome == Outcome.DISTURBED else "jump"
        return replace(self, part=self.part.cut(self.reached, ends))


def follow_exactly(part: StepPart, *, jumps: bool = False) -> FollowedPart:
    """Follow a straight part of a step from event to event.

    Parameters
    ----------
    jumps : whether the history goes on behind jumps, from the next equilibrium that is found at their load

    Raises
    ------
    SolveFailed
        With status "jump" where the history cannot go on gradually, or not at all; "not_found" where the path was lost.
    """
    return _beyond_jumps(part, "event by event", jumps=jumps)


def follow_to_events(
    part: StepPart,
    number: int,
    *,
    jumps: bool = False,
    behind: float = 0.0,
    known: Overload | None = None,
    acting: int = 1,
) -> FollowedPart:
    """Follow a straight part of a step in space in increments that end at events.

    Parameters
    ----------
    number : an increment need not be shorter than 1 / number of the part, whatever happens in it
    jumps : see `follow_exactly`
    behind, known : of a longer straight way that the part ends, see `PathSettings`
    acting : times shorter it may be where pairs act

    Raises
    ------
    SolveFailed
        As `follow_exactly` does.
    """
    stops = stops_at(number, part.prepared.settings)
    stops = replace(stops, shortest=stops.shortest / acting, behind=behind, known=known)
    return _beyond_jumps(part, "increments to events", jumps=jumps, stops=stops)


def stops_at(number: int, settings: SolverSettings) -> PathSettings:
    """How increments in space are chosen that need not be shorter than 1 / number of a part; limits of the methods."""
    return PathSettings(shortest=1.0 / number, turn=_TURN / number**0.5, solver=settings)


def _beyond_jumps(part: StepPart, how: str, *, jumps: bool, stops: PathSettings | None = None) -> FollowedPart:
    """Part after part, from one jump to the next; ``how`` for the clock, the others as of `_Path`."""
    prepared = part.prepared
    prepared.clock.increment(f"{part.where}, {how}")
    refuse_overlap(prepared, offsets(prepared, part.end)[: len(prepared.interface)], part.where)
    behind: list[FollowedPart] = []
    while True:
        if prepared.interface.cohesion is not None and (gone := _broken(part, behind, jumps)) is not None:
            behind.append(gone)
            part = replace(part, before=gone.after)
            continue
        path = _follow(part, stops)
        jump = path.segment.jump
        if path.segment.followed:
            return joined([*behind, _part_along(path)])
        if path.segment.outcome == Outcome.DISTURBED:
            found = [_part_along(path.cut)] if path.reached > 0.0 else []
            behind += found
            woken = part.woken.rest(path.cut.part, found[0].after if found else part.before)
            part = resting(woken) if found else woken  # what is disturbed at once rests no more: that would never end
            continue
        lost = _lost(path, follows=jumps)
        begun = _anew(path, behind) if len(behind) < JUMPS else []
        if begun and not begun[-1].snapshots:
            lost = lost.saying("; ".join(begun[-1].notes))
        elif begun:
            behind += begun
            part = part.rest(path.cut.part, behind[-1].after)
            continue
        landing: Landing | Spent | None = None
        if jumps and len(behind) < JUMPS:
            landing = _landing(path)
        if not isinstance(landing, Landing):
            if jumps and len(behind) >= JUMPS:
                lost = lost.saying(f"{JUMPS} parts between jumps, as many as are followed, are behind")
            elif jumps and jump is not None and not lost.hopeless:
                lost = lost.saying(_NO_LANDING if landing is None else f"{_NO_LANDING}: {landing}")
            raise keep(lost, [*behind, *_so_far(path)])
        cut = path.cut
        followed = _part_along(cut)
        behind += [followed, _landed(cut.part, followed.after, landing)]
        part = part.rest(cut.part, behind[-1].after)


def _broken(part: StepPart, behind: list[FollowedPart], jumps: bool) -> FollowedPart | None:
    """What bonds do at the load where a part begins that cannot go on gradually; None where all can."""
    try:
        return broken(part, behind, stops=not jumps)
    except SolveFailed as lost:
        raise keep(lost, behind) from None


def _anew(path: _Path, behind: list[FollowedPart]) -> list[FollowedPart]:
    """Up to where bodies lose at no load what held them, and where loads carry them from there; nothing where not so.

    Raises
    ------
    SolveFailed
        Where loads pull a body away from there on; it carries what is behind.
    """
    part = path.part
    if path.reached == 0.0 or not part.prepared.floating.shape[1]:
        return []
    path = replace(path, segment=replace(path.segment, outcome=Outcome.DISTURBED))
    found = _so_far(path)
    try:
        approach = approached(part.rest(path.cut.part, found[0].after)) if found else None
    except SolveFailed as gone:
        raise keep(gone, [*behind, *found]) from None
    return [] if approach is None else [*found, approach]


def _so_far(path: _Path) -> list[FollowedPart]:
    """What was followed of a segment that does not go on; nothing where that does not pass the certificate."""
    if path.reached == 0.0:
        return []
    try:
        return [_part_along(path.cut)]
    except SolveFailed:
        return []


def _follow(part: StepPart, stops: PathSettings | None) -> _Path:
    """The history up to the load at the end of a part."""
    prepared = part.prepared

    def tell(done: float) -> None:
        prepared.clock.says(f"{part.where} at {part.interval.fraction(done):.1%}")

    with prepared.clock.phase("complementarity"):
        if prepared.interface.closure is not None:
            found = follow_on_lines(part, stops, tell)
            return _Path(part=found.part, start=found.start, segment=found.segment, stops=stops, lines=found)
        if prepared.interface.cohesion is not None:
            way = follow_bonds(part, stops, tell)
            return _Path(part=way.part, start=way.start, segment=way.segment, stops=stops)
        start, b = path_state(prepared, part.before), right_hand_side(prepared, part.end)
        segment = prepared.paths.follow(start, b, stops, tell)
    return _Path(part=part, start=start, segment=undisturbed(part, segment), stops=stops)


def _trace(path: _Path) -> tuple[tuple[MethodRun, ...], ...]:
    """What was tried: for an exact path in one entry, in increments for each of them."""
    segment = path.segment
    if path.stops is None:
        return ((MethodRun(method="exact path", iterations=segment.pivots, end=segment.message),),)
    return tuple(
        (MethodRun(method="increments to events", iterations=piece.tried, end="certified"),)
        for piece in segment.pieces[1:]
    )


def _part_along(path: _Path) -> FollowedPart:
    """A segment that was followed as far as the end of its part, certified."""
    part, segment = path.part, path.segment
    prepared = part.prepared
    with prepared.clock.phase("recovery"):
        visited = _visited(path)
        after = visited[-1].state
    last = max(0, len(segment.pieces) - 2)
    before = tangential(prepared, part.before, segment.pieces[last].h)
    # the law of the rate, on the last piece, is the law of the increment from where the piece began
    certificate = certified(prepared, after, before, part.where)
    return FollowedPart(
        path="exact" if path.stops is None else "increments",
        before=part.before,
        after=after,
        certificates=(certificate,),
        trace=_trace(path),
        snapshots=visited,
        events=_events(path),
        notes=tuple(f"{part.where}: {spent}" for spent in segment.spent),
        until=partial(_until, path) if path.stops is None else None,
        legs=() if path.lines else (leg_of(part, after, start=path.start, segment=segment),),
    )


def _until(path: _Path, t: float) -> FollowedPart:
    """The path up to the fraction t of its part, certified."""
    shorter = path.segment.until(t * path.reached)
    return _part_along(replace(path, segment=shorter, part=path.part.cut(t, "event")))


def _landing(path: _Path) -> Landing | Spent | None:
    """Where a path goes on behind its jump; nowhere if pairs leave the lines of their closures on the way."""
    landing = path.part.prepared.paths.land(path.start, path.segment, path.stops)
    if path.lines is None or not isinstance(landing, Landing):
        return landing
    return landing if on_their_lines(path.lines, landing.state) else None


def _landed(part: StepPart, state: State, landing: Landing) -> FollowedPart:
    """From a jump at the end of a part to where it lands, at the same load."""
    prepared, interval = part.prepared, part.interval
    with prepared.clock.phase("recovery"):
        landed = recovered(prepared, state, state.point, landing.state)
        after = set_free(prepared, state, landed, taken=landed.dissipation - state.dissipation)
    # its slip is that of a whole curve: the law is asked of its last state alone
    certificate = certified(prepared, after, after.tangential, part.where)
    freed = after.released - state.released
    note = (
        f"{part.where} at {interval.high:.6%}: a jump, followed through {landing.events} events to the next "
        f"equilibrium at that load; it sets energy {freed:.6g} free and is a candidate: inertia may lead elsewhere"
    )
    attempt = MethodRun(method="beyond a jump", iterations=landing.events, end="landed")
    return FollowedPart(
        path="exact",
        before=state,
        after=after,
        certificates=(certificate,),
        trace=((attempt,),),
        snapshots=(Snapshot(number=interval.number, fraction=interval.high, what="landing", state=after),),
        notes=(note,),
    )


def _visited(path: _Path) -> tuple[Snapshot, ...]:
    """The states at the start, at every event and at the end, with work and displacement where they are whole.

    Where pieces are increments their ends are shown too.
    """
    part, start, segment = path.part, path.start, path.segment
    prepared, interval, state = part.prepared, part.interval, part.before
    tied = prepared.paths.condensed.ties is not None  # what ties bear is known with the displacements alone
    whole = part.whole or tied or bool(state.point.given.any())
    last, since, losses, found = state, 0.0, _losses(segment), []
    if start.note == PRESSED:
        pressed = recovered(prepared, state, state.point, start)
        last = balanced(prepared, state, pressed, float(pressed.dissipation.sum() - state.dissipation.sum()))
        found.append(Snapshot(number=interval.number, fraction=interval.low, what="start", state=last))
    reached = path.reached
    visited = {event.factor: event.state for event in segment.events if 0.0 < event.factor < reached}
    happens = set(visited)
    if path.stops is not None:
        ends = {piece.factor: piece.state for piece in segment.pieces[1:-1] if piece.state is not None}
        visited = dict(sorted((ends | visited).items()))
    for factor, now in {**visited, reached: segment.end}.items():
        s = 1.0 if factor == reached else factor / reached
        point, known = state.point.towards(part.end, s), whole or s == 1.0
        recover = partial(recovered, prepared, last, point, now)
        if known:
            here = balanced(prepared, last, recover(), sum(loss for t, loss in losses if since < t <= factor))
            last, since = here, factor
        else:
            here = on_the_way(prepared, last, point, now)
        what = interval.ends if s == 1.0 else "event" if factor in happens else "increment"
        found.append(
            Snapshot(
                number=interval.number,
                fraction=interval.fraction(s),
                what=what,
                state=here,
                whole=known,
                worked=known,
                recover=None if known else recover,
            )
        )
    return tuple(found)


def _losses(segment: Segment) -> list[tuple[float, float]]:
    """What contact takes on every linear piece, ``-int r . dh``, by the factor at its end."""
    return [
        (two.factor, float((-0.5 * (one.r + two.r) * (two.h - one.h)).sum())) for one, two in pairwise(segment.pieces)
    ]


def _events(path: _Path) -> tuple[PairEvent, ...]:
    """The events by contact and node."""
    prepared, reached = path.part.prepared, path.reached
    interface, labels = prepared.interface, [contact.label for contact in prepared.model.contacts]
    pairs = np.nonzero(prepared.paths.active)[0]
    found = []
    for event in path.segment.events:
        own = pairs[list(event.pairs)]
        for contact in np.unique(interface.contact[own]):
            nodes = interface.node[own[interface.contact[own] == contact]]
            found.append(
                PairEvent(
                    load_factor=path.part.interval.factor(event.factor / reached if reached else 0.0),
                    contact=labels[contact],
                    nodes=tuple(int(node) for node in nodes),
                    what=event.what,
                )
            )
    return tuple(found)


def _lost(path: _Path, *, follows: bool) -> SolveFailed:
    """Why the path does not go on, with the load and the acting nodes; ``follows``: jumps are followed anyway."""
    part, segment = path.part, path.segment
    prepared, where = part.prepared, part.where
    if segment.jump is None:
        lost = told(
            f"{where}: the exact path was lost",
            remedy="follow the step in increments",
            evidence="; ".join([segment.message, *map(str, segment.spent)]),
        )
        return SolveFailed(lost, status=Outcome.NOT_FOUND)
    pairs = np.nonzero(prepared.paths.active)[0][list(segment.jump.pairs)]
    nodes = ", ".join(str(node) for node in prepared.model.mesh.labels[prepared.interface.node[pairs[:_NAMED]]])
    if len(pairs) > _NAMED:
        nodes += f" and {len(pairs) - _NAMED} more"
    what, remedy = ("gross sliding", HOLD) if segment.jump.gross_sliding else ("a jump", _LESS if follows else _FOLLOW)
    where, motion = f"{where} at {part.interval.fraction(segment.jump.factor):.6%}", None
    if segment.jump.escape is not None:
        words, motion = leaving(prepared, segment.jump.escape)
        what = f"{what}: {words}"
    words = f"{where}: {what}: no equilibrium continues the history gradually"
    if segment.jump.hopeless is not None:
        words += f", and beyond {part.interval.fraction(segment.jump.hopeless):.6%} there is none at all"
    evidence = "; ".join([f"acting nodes {nodes}", segment.jump.proof, *map(str, segment.spent)])
    failure = SolveFailed(told(words, remedy=remedy, evidence=evidence), status=Outcome.JUMP, motion=motion)
    failure.hopeless = segment.jump.hopeless is not None
    return failure
