# SPDX-License-Identifier: BSD-3-Clause
"""Contacts whose sides slide far: a part of a step in strides, and between two strides pairs are made anew.

Bodies strain little, so that their compliance does not change while they slide: what changes is B, what is opposite
what, and from the nodes of both sides, which are kept, the condensed interface follows with no factorisation. Within a
stride pairs are the mean of those at its ends, where the stride before lets expect the next, and gaps go linearly from
what they are to those of the bodies there; so a side may be curved, and gaps never jump. Between two strides the sides
"hand over": stick and slip go on from the displacement of the bodies, and forces on them grow and fade, see
`engine.handing_over`. A short stride with the pairs of its end is the last of a part, so that what is found there is in
equilibrium with the pairs of where the bodies are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil

import numpy as np

from signorini.arrays import Array
from signorini.engine.energy import interface_energy
from signorini.engine.handing_over import Handover, supported, with_pairs
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.engine.rubbing import rubbed, rubbing_of_states, set_loose
from signorini.engine.step_parts import FollowedPart, StepPart, at_once, ending, joined, keep, reached
from signorini.engine.stride_pairs import Pairing, paired, stride_of, wearing_at, where_bodies_are
from signorini.engine.stride_plan import StridePlan
from signorini.engine.turning import first_share, refuse_turned, with_turned_loads
from signorini.errors import Interrupted, SolveFailed
from signorini.interface.sliding import facing, sliding_pairs
from signorini.law.states import OPEN
from signorini.outcome import Outcome
from signorini.solution.state import State, wear_of

_BENT = 2e-3  # of forces over the stiffness of the bodies: what gaps may differ in the middle of a stride
_SHORTEST_MOVE = 0.125  # of a stride: what bodies move at least, however gaps bend
_TURN = 0.1  # radians: what a body turns by in a stride at most, for loads keep their direction as it sees them
_BLIND = 0.25  # strides: one with the pairs of its beginning that turns out longer is gone again with those of its end
_OVER = 1.5  # strides: one that turns out longer is gone again
_LAST = 1.0 / 64.0  # of what is left of a part: its last stride, which has the pairs of its end
_STAYS = 0.01  # strides: a part in which sides move more is gone again with the pairs of its end, too
_MISSED = 0.05  # strides: one that ends farther from where it was expected to is gone again from what it has shown
_AGAIN = 3  # times in a row at most that is done: where pairs begin to slip what is expected may not settle
_GROWTH = 2.0  # of a stride over the one before it, in load
_SHORTER = 8.0  # times: a stride that is lost is tried again
_SHORTEST_SHARE = 1e-6  # of the rest of a part: below it no stride that is lost is tried again
_WAY_AT_ONCE = 2.0**-10  # of a step: what strides at constant loads are followed along
_SAID_FROM = 1e-12  # of the largest force: what may fade away and no one need know

FOLLOWED = "pairs followed the bodies in"
"""What a part says that was followed in strides, and in how many."""

Follow = Callable[[StepPart], FollowedPart]


@dataclass(frozen=True, kw_only=True, eq=False)
class Stride:
    """A stride as it was followed.

    Attributes
    ----------
    part : from where the last one ended, as far as it goes
    prepared : with its pairs
    gaps : (2, n) at its ends between sides that are not worn, before anything moved as its pairs see the motion since
    followed : from its beginning to its end
    end : pairs where its end was expected
    moved : (dofs,) displacement in it
    slid : the longest way of a pair that touches, in strides
    missed : how far from where its end was expected pairs are, in strides
    changed : forces of the last pairs that fade away in it, of the largest force
    loads : (dofs,) at its end as bodies see them, with what has grown
    growing : (dofs,) forces that grow in it
    owed : energy that the change of pairs has set free since the part began
    """

    part: StepPart
    prepared: Prepared
    gaps: Array
    followed: FollowedPart
    end: Pairing
    moved: Array
    slid: float
    missed: float
    changed: float
    loads: Array
    growing: Array
    owed: float


@dataclass(frozen=True, kw_only=True, eq=False)
class _Walk:
    """A straight part of a step that is followed in strides.

    Attributes
    ----------
    part : with the pairs before anything moved
    follow : the way through a stride
    limit : a stride, length
    lost : (m,) depth that the sides lose in it, see `WornSides`; empty where none does
    """

    part: StepPart
    follow: Follow
    limit: float
    lost: Array

    def beyond(self, prepared: Prepared, t: float) -> Array:
        """(n,) Gaps of pairs beyond those of the geometry: of interferences that the step changes, and of wear.

        Parameters
        ----------
        prepared : with the pairs
        t : the fraction of the part
        """
        part, seen, nominal = self.part, prepared.wearing, self.part.prepared.wearing
        gap = (1.0 - t) * part.before.point.gap + t * part.end.gap - part.prepared.interface.gap
        if seen is None or nominal is None:
            return np.asarray(gap)
        return np.asarray(gap + self.worn_gap(prepared, t) - nominal.gap @ self.depth(t))

    def depth(self, t: float) -> Array:
        """(m,) Worn depth beyond the mesh at a fraction of the part; empty where no side wears."""
        wear = self.part.before.wear
        return np.zeros(0) if wear is None else wear.beyond - (1.0 - t) * self.lost

    def worn_gap(self, prepared: Prepared, t: float) -> Array | float:
        """(n,) What pairs feel of it there."""
        return 0.0 if prepared.wearing is None else np.asarray(prepared.wearing.gap @ self.depth(t))

    @cached_property
    def begin(self) -> Pairing:
        """The pairs of where the bodies are before the first stride."""
        part, u = self.part, self.part.before.displacement
        return Pairing.at(part, u) if u.any() else Pairing(interface=part.prepared.interface, displacement=u)

    def stride(self, plan: StridePlan, last: Stride | None) -> Stride:
        """One stride, after the last one; None at the beginning of the part."""
        now, state, end = plan.now, plan.now.before, plan.end()
        there = wearing_at(now.prepared, end.interface)
        begun = self.part.interval.within(now.interval.low) if now.interval.high > now.interval.low else 0.0
        done = self.part.interval.within(now.interval.high)
        beyond = np.array([self.beyond(there, t) for t in (begun, done)])
        known = facing(plan.begin.interface) | (state.status != OPEN)
        pairs = plan.pairs(end, known, beyond[0])
        prepared = with_turned_loads(paired(there, pairs.interface), end.displacement)
        own = sliding_pairs(prepared.model, prepared.interface)
        first, gap = end.gap_before(pairs.interface) + beyond
        handover = Handover.to(prepared, state, self.loads(last), known, first)
        before = handover.before
        handover = replace(handover, stored=interface_energy(prepared, before) - self.stored(last))
        gap = np.where(own, gap, now.end.gap)
        opened = np.where(own & ~self.lost.any(), gap - before.point.gap - (beyond[1] - beyond[0]), 0.0)
        owed = 0.0 if last is None else last.owed
        handover = plan.grown(handover, pairs, end, opened, owed)
        point = supported(now.end, len(state.displacement))
        point = replace(point, gap=gap, reaction=point.reaction + handover.growing)
        walked = self.followed(replace(now, prepared=prepared, before=before, end=point))
        moved = walked.after.displacement - state.displacement
        if plan.blind and moved.any():
            end = Pairing.at(now, walked.after.displacement)
        followed = handover.booked(walked, opened)
        owed += followed.after.released - walked.after.released
        followed = ending(followed, replace(followed.after, point=replace(now.end, gap=gap)))
        faces = facing(plan.begin.interface) & facing(end.interface)
        parted = np.where(faces, ((plan.begin.interface.B - end.interface.B) @ moved)[: len(own)], 0.0)
        gaps = np.array([before.point.gap, gap])
        touch = own & ((before.status != OPEN) | (walked.after.status != OPEN))
        missed = np.linalg.norm(prepared.interface.motion(moved - plan.expected)[:, touch], axis=0)
        return Stride(
            part=replace(now, prepared=prepared),
            prepared=prepared,
            gaps=gaps - np.array([self.worn_gap(prepared, t) + np.zeros(len(own)) for t in (begun, done)]),
            followed=self.worn(prepared, before, (walked, followed)),
            end=end,
            moved=moved,
            slid=self.slid(prepared, before, followed.after, parted),
            missed=float(missed.max(initial=0.0)) / self.limit,
            changed=handover.share,
            loads=applied(prepared, point)[0],
            growing=handover.growing,
            owed=owed,
        )

    def slid(self, prepared: Prepared, before: State, after: State, parted: Array) -> float:
        """How long a stride turned out to be, in strides.

        Parameters
        ----------
        prepared : with its pairs
        before, after : states at its ends
        parted : (n,) by how much less gaps have grown as its pairs see the motion than as the last ones do, length
        """
        own, faces = sliding_pairs(prepared.model, prepared.interface), facing(prepared.interface)
        touch = own & ((before.status != OPEN) | (after.status != OPEN))
        way = np.linalg.norm(prepared.interface.motion(after.displacement - before.displacement)[1:], axis=0)
        moved = float(way[touch if touch.any() else own].max(initial=0.0)) / self.limit
        # half of what rates differ by at the ends is what the gap in the middle is beside the mean, four times
        bent = 0.125 * float(np.abs(parted[touch & faces]).max(initial=0.0))
        pressed = max(float(state.forces[0].sum()) for state in (before, after)) / prepared.scale.stiffness
        bent = (bent / (_BENT * pressed)) ** 0.5 if pressed > 0.0 else 0.0
        # gaps of sides with corners jump, and no stride is short enough for that
        farthest = prepared.space.farthest(after.displacement - before.displacement)
        bent = min(bent, farthest / (_SHORTEST_MOVE * self.limit))
        return max(moved, bent, prepared.frames.turned(before.displacement, after.displacement) / _TURN)

    def loads(self, last: Stride | None) -> Array:
        """(dofs,) Loads as bodies have seen them so far."""
        part = self.part
        if last is not None:
            return last.loads
        return applied(with_turned_loads(part.prepared, part.before.displacement), part.before.point)[0]

    def stored(self, last: Stride | None) -> float:
        """Energy of what lies between the sides, where the last stride ended."""
        if last is not None:
            return interface_energy(last.prepared, last.followed.after)
        return interface_energy(replace(self.part.prepared, interface=self.begin.interface), self.part.before)

    def arrived(self, last: Stride) -> Stride:
        """The end of the part with the pairs, and the loads, of where bodies are that have turned."""
        part, state = self.part, last.followed.after
        at_end = replace(part, interval=replace(part.interval, low=part.interval.high), before=state)
        place = Pairing.at(at_end, state.displacement)
        return self.stride(StridePlan(now=at_end, begin=place, expected=np.zeros_like(state.displacement)), last)

    def worn(self, prepared: Prepared, before: State, found: tuple[FollowedPart, FollowedPart]) -> FollowedPart:
        """A stride with what it has rubbed off the sides, and what gaps that grow by wear alone have set free.

        Parameters
        ----------
        prepared : with its pairs
        before : its first state
        found : the stride as it was followed, and with the work of the change of its pairs
        """
        followed, booked = found
        if prepared.wearing is None:
            return booked
        if self.lost.any():
            booked = set_loose(before, booked)
        sides, interface = prepared.wearing, prepared.interface
        states = [before, *(shot.state for shot in followed.snapshots)]
        rubbing = rubbing_of_states(sides, interface, states)
        return ending(booked, replace(booked.after, wear=rubbed(wear_of(booked.after), rubbing)))

    def followed(self, part: StepPart) -> FollowedPart:
        """A stride, with its pairs as far as it goes."""
        try:
            return with_pairs(self.follow(part), part.prepared)
        except (SolveFailed, Interrupted) as stop:
            found = reached(stop)
            stop.reached = None if found is None else with_pairs(found, part.prepared)
            raise


def follow_sliding(
    part: StepPart, follow: Follow, lost: Array | None = None, strides: list[Stride] | None = None
) -> FollowedPart:
    """Follow a straight part of a step in strides; what they rub off sides that wear is in the states.

    Parameters
    ----------
    part : with the pairs before anything moved; gaps of its points are those of these pairs
    follow : the way through a stride
    lost : (m,) depth that sides lose in a part at constant loads, the state before it has it already; None: nothing
    strides : are added to it where given

    Raises
    ------
    SolveFailed
        What ended a stride, with all strides before it.
    """
    if part.interval.high > part.interval.low:
        return _in_strides(part, follow, lost, strides)
    # at constant loads, too, strides tell where they are by their interval
    way = replace(part, interval=replace(part.interval, low=part.interval.high - _WAY_AT_ONCE))
    try:
        return at_once(_in_strides(way, follow, lost, strides), part.interval)
    except (SolveFailed, Interrupted) as stop:
        found = reached(stop)
        stop.reached = None if found is None else at_once(found, part.interval)
        raise


def _in_strides(part: StepPart, follow: Follow, lost: Array | None, strides: list[Stride] | None) -> FollowedPart:
    """As `follow_sliding`, of a part whose interval has a length."""
    none = np.zeros(0 if part.before.wear is None else len(part.before.wear.depth))
    limit = stride_of(part.prepared)
    walk = _Walk(part=part, follow=follow, limit=limit, lost=none if lost is None else lost)
    behind: list[Stride] = [] if strides is None else strides
    first = len(behind)
    rest, share = part, first_share(part.prepared, part.before.point, part.end, walk.limit)
    rate, begin = np.zeros(len(part.before.displacement)), walk.begin
    known: Array | None = None
    tries, ends = 0, False
    while True:
        shortened = share >= 1.0 and rate.any() and not ends
        whole = share >= 1.0 and not shortened
        now = rest if whole else rest.cut(1.0 - _LAST if shortened else share, "handover")
        length = now.interval.high - now.interval.low
        ahead = 0.0 if whole else _LAST if shortened else 1.0
        plan = StridePlan(now=now, begin=begin, expected=length * rate, ahead=ahead, last=known, limit=walk.limit)
        try:
            stride = walk.stride(plan, behind[-1] if behind[first:] else None)
        except (SolveFailed, KeyboardInterrupt) as stop:
            again = isinstance(stop, SolveFailed) and stop.status in (Outcome.NOT_FOUND, Outcome.JUMP)
            if not again or share < _SHORTEST_SHARE:
                raise keep(stop, [done.followed for done in behind[first:]]) from None
            share, known, ends = share / _SHORTER, None, False
            continue
        rate = stride.moved / (length or 1.0)
        if stride.slid > (_BLIND if plan.blind else _OVER):
            share, known, ends = share / ceil(stride.slid), None, False
            continue
        if plan.blind and whole and stride.missed > _STAYS:
            ends = True
            continue
        if not plan.blind and stride.missed > _MISSED and tries < _AGAIN:
            tries += 1
            continue
        if shortened and known is None:
            known = stride.followed.after.forces
            continue
        behind.append(stride)
        begin, known, tries, ends = stride.end, None, 0, bool(shortened)
        if not part.prepared.model.axisymmetric:
            _refuse_turned(part, behind[first:])
        if whole:
            end = [walk.arrived(stride)] if part.prepared.turns else []
            return _finished(part, [*behind[first:], *end])
        rest = rest.rest(now, stride.followed.after)
        wanted = length * min(_GROWTH, 1.0 / max(stride.slid, 1.0 / _GROWTH))
        share = 1.0 / max(1, ceil((rest.interval.high - rest.interval.low) / wanted - 1e-9))


def _refuse_turned(part: StepPart, strides: list[Stride]) -> None:
    """A body that may not turn has not turned far in the last of the strides."""
    try:
        refuse_turned(part.prepared, strides[-1].followed.after, part.where)
    except SolveFailed as stop:
        raise keep(stop, [done.followed for done in strides]) from None


def _finished(part: StepPart, strides: list[Stride]) -> FollowedPart:
    """All strides as one; the state at the end refers to the pairs before anything moved, as that before does."""
    followed, changed = joined([stride.followed for stride in strides]), max(stride.changed for stride in strides)
    last = strides[-1]
    state = last.followed.after
    more = interface_energy(where_bodies_are(last.prepared, state), state) - interface_energy(last.prepared, state)
    after = replace(
        followed.after,
        point=replace(followed.after.point, gap=part.end.gap),
        released=followed.after.released - more,
    )
    notes = followed.notes
    if changed > _SAID_FROM:
        words = f"{FOLLOWED} {len(strides)} strides; what fades away at a node as they hand over"
        notes = (*notes, f"{words} is up to {changed:.1e} of the largest force of a pair")
    return replace(
        followed,
        after=after,
        notes=notes,
        turned_at=strides[-1].end.displacement if part.prepared.frames else np.zeros(0),
    )
