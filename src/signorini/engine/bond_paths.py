# SPDX-License-Identifier: BSD-3-Clause
"""Exact paths of pairs that are bonded: while bonds stay on their lines, and past the loads at which they let go.

A way is cut, exactly, where a bond reaches its strength, is gone, or closes again farther than it opened. Where bonds
cannot go on gradually their forces go to zero at that load, or down to where they are in equilibrium again, with all
others on their lines: a jump, whose energy beyond what bonds and friction take is set free.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import MethodRun
from signorini.engine.bond_rates import BondCourse, Posed, bonds_of, course, full_along, left_shear, pose, stiffness
from signorini.engine.bond_trial import sheared_off
from signorini.engine.energy import set_free
from signorini.engine.increments import certified, leaving
from signorini.engine.path_states import path_state, recovered, right_hand_side
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart
from signorini.errors import SolveFailed, told
from signorini.friction.history import Breakpoint, Event, PathSettings, PathState, Segment, follow
from signorini.friction.history.segment import What
from signorini.outcome import Outcome
from signorini.solution.results import PairEvent
from signorini.solution.state import State

_GRADUALLY = "no equilibrium continues the history gradually"
_HOLD = "a prescribed motion in place of the load, or supports that hold what is torn off"

_RATES_TRIED = 20
"""Rates of bonds at one load, with the states of other pairs that they lead to, at most: one or two are usual."""

_RELEASES = 1000
"""Parts of one jump in which other bonds begin to open or let go with the first, at most."""

_JUMPS = 100
"""Of bonds at one load, one after the other, at most."""

_AT_ONCE = 1e-12  # part of the way: what ends within it should not have begun so
_STEEPNESS_WIDTH = (
    1e-4  # of the strength over the opening: a line steeper than its inverse magnifies the rounding of openings
)
_MOST_ROUNDED = 100.0  # times the width: what steep lines may be off
_WIDTH = 1e-8  # of the strength, or of the opening: how far off its line a bond may be

BREAKS = (
    "bonds that let go at once are followed, at that load, to the next equilibrium, a candidate: inertia may lead "
    "elsewhere"
)
"""What a step says in which bonds break."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BondsPath:
    """A part of a step as it was followed with bonds on their lines.

    Attributes
    ----------
    part : as the law sees it, awake where it goes on otherwise
    start : its state before, in the scaled units of the law
    segment : DISTURBED where a bond leaves its line
    """

    part: StepPart
    start: PathState
    segment: Segment


def follow_bonds(part: StepPart, stops: PathSettings | None, tell: Callable[[float], None]) -> BondsPath:
    """Follow a part of a step up to its end, or to where a bond leaves its line.

    Parameters
    ----------
    part : with pairs that are bonded
    stops : as of `CondensedSolver.follow`
    tell : is called with the part that is behind
    """
    none = np.zeros(len(part.prepared.interface), np.bool_)
    codes: IntArray | None = None
    for _ in range(_RATES_TRIED):
        found = course(part.prepared, part.before, part.end, none, none, codes)
        path, watch = _along(part, found, stops, tell)
        if path.segment.outcome != Outcome.DISTURBED:
            return path
        factor, ends = watch.first(path.segment)
        if factor > _AT_ONCE:
            return replace(path, segment=watch.cut(path.segment, factor, ends))
        state = path.segment.pieces[1].state
        codes = None if state is None else state.state
    words = f"pairs that are bonded tried {_RATES_TRIED} rates at one load"
    segment = path.segment
    lost = replace(
        segment, end=path.start, events=(), pieces=segment.pieces[:1], outcome=Outcome.NOT_FOUND, message=words
    )
    return replace(path, segment=lost)


def _along(
    part: StepPart, found: BondCourse, stops: PathSettings | None, tell: Callable[[float], None]
) -> tuple[BondsPath, _Watch]:
    """A part as far as bonds stay on their lines; the arguments as of `follow_bonds`."""
    posed = found.posed
    end = part.end.changed(pull=posed.moved_on(found.pull))
    start, b = path_state(posed.prepared, posed.state), right_hand_side(posed.prepared, end)
    watch = _Watch.of(found)
    settings = stops or PathSettings(solver=part.prepared.settings)
    segment = follow(posed.prepared.paths.law, start, b, settings=settings, tell=tell, leaves=watch.left)
    on_lines = replace(
        part,
        prepared=posed.prepared,
        before=posed.state,
        end=end,
        awake=part.prepared,
        waiting=np.zeros(len(posed.held), np.bool_),
    )
    return BondsPath(part=on_lines, start=start, segment=segment), watch


@dataclass(frozen=True, kw_only=True, eq=False)
class _Watch:
    """Where bonds on a path leave their lines.

    Attributes
    ----------
    posed : where it begins
    pull : (d, n) change of what bonds pull up to its end
    lines : (n,) growth of the tension of springs with their opening
    """

    posed: Posed
    pull: Array
    lines: Array

    @staticmethod
    def of(found: BondCourse) -> _Watch:
        """On a way that bonds go."""
        return _Watch(posed=found.posed, pull=found.pull, lines=stiffness(found.posed))

    def _seen(self, piece: Breakpoint) -> tuple[Array, Array, Array]:
        """(n,) Openings, normal forces and given tensions at a piece's end."""
        condensed, n = self.posed.prepared.paths.condensed, len(self.lines)
        gap, force = np.zeros(n), np.zeros(n)
        pull = self.posed.moved_on(piece.factor * self.pull)[0]
        gap[condensed.active], force[condensed.active] = piece.h[0] / condensed.root, condensed.root * piece.r[0]
        return gap, force + pull, -pull

    def _beyond(self, piece: Breakpoint) -> Array:
        """(5, n) How far bonds are beyond what ends their lines: strength, opening, landing, no opening, the line."""
        posed, (gap, force, tension) = self.posed, self._seen(piece)
        cohesion, bonds = bonds_of(posed.prepared, posed.state)
        most, opening = cohesion.most, np.where(cohesion.opening > 0.0, cohesion.opening, 1.0)
        edge = np.where(posed.soft, 1.0, bonds.damage)
        soft, falls = posed.springs, cohesion.opening > 0.0
        begun = (bonds.damage > 0.0) & (bonds.damage < 1.0) & ~soft & ~posed.driven
        rounding = np.clip(
            _STEEPNESS_WIDTH * np.abs(self.lines) * opening / np.where(most > 0.0, most, 1.0), 1.0, _MOST_ROUNDED
        )
        line = np.where(posed.soft, most, 0.0) + self.lines * gap
        return np.array(
            [
                np.where(posed.held, -force / np.where(most > 0.0, most, 1.0) - 1.0, -1.0),
                np.where(soft, gap / opening - edge, -1.0),
                np.where(
                    posed.driven & falls,
                    np.maximum(1.0 - gap / opening, 0.0) - tension / np.where(falls, most, 1.0),
                    -1.0,
                ),
                np.where(begun, gap / opening, -1.0),
                np.where(soft, np.abs(tension - line) / np.where(most > 0.0, most, 1.0) / rounding, -1.0),
            ]
        )

    def left(self, piece: Breakpoint) -> bool:
        """Whether any bond is beyond its line at the end of a piece."""
        beyond = self._beyond(piece)
        cohesion = bonds_of(self.posed.prepared, self.posed.state)[0]
        slides = self._sticks & (np.linalg.norm(self._along(piece), axis=0) > (1.0 + _WIDTH) * cohesion.along)
        return bool((beyond > _WIDTH).any() or slides.any()) or bool(self._closes(piece).any())

    @property
    def _sticks(self) -> BoolArray:
        """(n,) Bonds that hold the sides from sliding."""
        cohesion, bonds = bonds_of(self.posed.prepared, self.posed.state)
        return self.posed.held & cohesion.sticking(bonds)

    def _along(self, piece: Breakpoint) -> Array:
        """(d - 1, n) Forces along the sides at a piece's end."""
        condensed = self.posed.prepared.paths.condensed
        force = self.posed.moved_on(piece.factor * self.pull)[1:].copy()
        force[:, condensed.active] += condensed.root * piece.r[1:]
        return force

    def _until_along(self, one: Breakpoint, two: Breakpoint) -> Array:
        """(n,) Part of a piece at which bonds bear as much along the sides as they can: ``|f + t g| = limit``."""
        limit = bonds_of(self.posed.prepared, self.posed.state)[0].along
        f, g = self._along(one), self._along(two) - self._along(one)
        beyond = self._sticks & (np.linalg.norm(self._along(two), axis=0) > (1.0 + _WIDTH) * limit)
        square, middle = (g * g).sum(axis=0), (f * g).sum(axis=0)
        rest = np.where(beyond, (f * f).sum(axis=0) - np.where(beyond, limit, 0.0) ** 2, 0.0)
        root = np.sqrt(np.maximum(middle**2 - square * rest, 0.0))
        return np.where(beyond, np.divide(root - middle, square, out=np.zeros_like(root), where=square > 0.0), np.inf)

    def _closes(self, piece: Breakpoint) -> BoolArray:
        """(n,) Bonds that soften no longer."""
        posed, start = self.posed, self.posed.state.gap
        opening = bonds_of(posed.prepared, posed.state)[0].opening
        return np.asarray(posed.soft & (self._seen(piece)[0] < start - _WIDTH * opening))

    def first(self, segment: Segment) -> tuple[float, BoolArray]:
        """Where bonds leave first in the last piece of a segment, and (5, n) what ends their lines: see `_beyond`."""
        one, two = segment.pieces[-2:]
        before, after = self._beyond(one), self._beyond(two)
        change = after - before
        times = np.divide(-before, change, out=np.full_like(change, np.inf), where=(after > _WIDTH) & (change > 0.0))
        times[4] = np.where(after[4] > _WIDTH, 0.0, np.inf)
        along = self._until_along(one, two)
        times = np.concatenate([times[:4], np.minimum(times[4:], along)])
        time = 0.0 if self._closes(two).any() else float(np.clip(times, 0.0, 1.0).min(initial=1.0))
        return one.factor + time * (two.factor - one.factor), times <= time + _AT_ONCE

    def cut(self, segment: Segment, factor: float, ends: BoolArray) -> Segment:
        """A segment up to where bonds leave their lines, with what happens to them there.

        Parameters
        ----------
        factor, ends : as of `first`
        """
        until = segment.until(factor)
        events = list(until.events)
        kinds: tuple[tuple[What, BoolArray], ...] = ("softens", ends[0]), ("breaks", ends[1] & self.posed.soft)
        for what, which in kinds:
            pairs = tuple(np.flatnonzero(which[self.posed.prepared.paths.active]).tolist())
            if pairs:
                events.append(Event(factor=factor, pairs=pairs, what=what, state=until.end))
        words = f"bonds leave their lines at factor {factor:.12g}"
        return replace(until, events=tuple(events), outcome=Outcome.DISTURBED, message=words)


def broken(part: StepPart, behind: Sequence[FollowedPart], *, stops: bool) -> FollowedPart | None:
    """What bonds do at the load where a part begins that cannot go on gradually; None where all can.

    Parameters
    ----------
    part : of a step
    behind : what was followed of it
    stops : whether a history ends at a jump

    Raises
    ------
    SolveFailed
        Where they let go and the history ends there, or where no equilibrium follows.
    """
    prepared, state = part.prepared, part.before
    none = np.zeros(len(prepared.interface), np.bool_)
    if not state.forces.any():
        return None
    cohesion = bonds_of(prepared, state)[0]
    sliding = full_along(prepared, state) & (cohesion.opening > 0.0)
    if sliding.any():
        number = prepared.model.mesh.labels[prepared.interface.node[np.flatnonzero(sliding)[0]]]
        words = f"{part.where} at {part.interval.low:.6%}: {sheared_off(number)}"
        raise SolveFailed(words, status=Outcome.NOT_FOUND)
    if len(behind) >= _JUMPS and all(found.snapshots[0].what == "landing" for found in behind[-_JUMPS:]):
        words = told(
            f"{part.where} at {part.interval.low:.6%}: bonds let go, hold again, and let go",
            remedy='bonds that hold no shear, shear = "free", or a finer mesh',
            evidence=f"{_JUMPS} jumps at one load",
        )
        raise SolveFailed(words, status=Outcome.NOT_FOUND)
    found = course(prepared, state, part.end, none, none)
    sheared = left_shear(prepared, state)
    if not (found.breaking | sheared).any():
        return None
    if stops:
        raise SolveFailed(_words(part, found.breaking | sheared), status=Outcome.JUMP)
    gone, landed = _released(part, found.breaking, sheared)
    after = set_free(prepared, state, landed, taken=landed.dissipation - state.dissipation)
    certificate = certified(prepared, after, after.tangential, part.where)
    snapshot = Snapshot(number=part.interval.number, fraction=part.interval.low, what="landing", state=after)
    return FollowedPart(
        path="exact",
        before=state,
        after=after,
        certificates=(certificate,),
        trace=((MethodRun(method="bonds that break", iterations=int(gone.sum()), end="landed"),),),
        snapshots=(snapshot,),
        events=_events(part, gone & (bonds_of(prepared, after)[1].damage == 1.0)),
        notes=(f"{part.where}: {BREAKS}",),
    )


def _released(part: StepPart, breaking: BoolArray, sheared: BoolArray) -> tuple[BoolArray, State]:
    """Bonds that have let go at the load where a part begins, (n,), and the equilibrium behind that."""
    prepared, state, point = part.prepared, part.before, part.before.point
    here = replace(part, end=point)
    driven, gone, codes = breaking.copy(), breaking.copy(), None
    for _ in range(_RELEASES):
        sheared = sheared | left_shear(prepared, state)
        found = course(prepared, state, point, driven, sheared, codes)
        if found.breaking.any():
            driven, gone = driven | found.breaking, gone | found.breaking
            continue
        path, watch = _along(here, found, None, _silent)
        segment = path.segment
        if segment.outcome not in (Outcome.DISTURBED, Outcome.FOLLOWED):
            raise _nowhere(found.posed, part, gone, segment)
        if segment.followed:
            brittle = bonds_of(prepared, state)[0].opening == 0.0
            state = _recovered(found.posed, path, state, driven & brittle, sheared)
            return gone, replace(state, point=state.point.changed(pull=_pull(prepared, state)))
        factor, ends = watch.first(segment)
        landed = ends[2]
        if factor <= _AT_ONCE and not landed.any():
            code = segment.pieces[1].state
            codes = None if code is None else code.state
            continue
        codes = None
        if factor > _AT_ONCE:
            cut = replace(path, segment=segment.until(factor))
            state = _recovered(found.posed, cut, state, np.zeros_like(driven), np.zeros_like(driven))
        driven = driven & ~landed
    words = f"{_RELEASES} parts of a jump, as many as are followed, are behind"
    raise SolveFailed(_words(part, gone, words), status=Outcome.NOT_FOUND)


def _nowhere(posed: Posed, part: StepPart, gone: BoolArray, segment: Segment) -> SolveFailed:
    """No equilibrium follows where bonds have let go; bodies that leave are named with their motion."""
    words, escape = _words(part, gone, segment.message), None if segment.jump is None else segment.jump.escape
    if escape is None:
        return SolveFailed(words, status=segment.outcome)
    leaves, motion = leaving(posed.prepared, escape)
    return SolveFailed(_words(part, gone, segment.message, leaves), status=segment.outcome, motion=motion)


def _pull(prepared: Prepared, state: State) -> Array | None:
    none = np.zeros(len(prepared.interface), np.bool_)
    return pose(prepared, state, none, none, none).state.point.pull


def _recovered(posed: Posed, path: BondsPath, state: State, gone: BoolArray, sheared: BoolArray) -> State:
    """The state at the end of a part of a jump, with bonds that are gone for good, all of them or along the sides."""
    factor = path.segment.pieces[-1].factor
    point = state.point.changed(pull=None)
    assert path.part.end.pull is not None
    assert posed.state.point.pull is not None
    pull = (1.0 - factor) * posed.state.point.pull + factor * path.part.end.pull
    now = recovered(posed.prepared, posed.state, point.changed(pull=pull), path.segment.end)
    cohesion, bonds = bonds_of(posed.prepared, state)
    return replace(now, bonds=cohesion.after(bonds, now.gap, gone, sheared), work=state.work, released=state.released)


def _words(part: StepPart, breaking: BoolArray, evidence: str = "", leaves: str = "") -> str:
    """Where bonds let go, in words, with the bodies that leave then."""
    prepared = part.prepared
    pairs = np.flatnonzero(breaking)
    nodes = ", ".join(str(node) for node in prepared.model.mesh.labels[prepared.interface.node[pairs[:12]]])
    return told(
        f"{part.where} at {part.interval.low:.6%}: a jump: bonds let go at once, {leaves or _GRADUALLY}",
        remedy=_HOLD if leaves else 'jump = "follow" looks for the equilibrium behind it',
        evidence="; ".join(filter(None, [f"acting nodes {nodes}", evidence])),
    )


def _events(part: StepPart, gone: BoolArray) -> tuple[PairEvent, ...]:
    """Bonds that break, by contact."""
    interface, found = part.prepared.interface, []
    for contact in np.unique(interface.contact[gone]):
        nodes = tuple(int(node) for node in interface.node[gone & (interface.contact == contact)])
        label = part.prepared.model.contacts[contact].label
        found.append(PairEvent(load_factor=part.interval.factor(0.0), contact=label, nodes=nodes, what="breaks"))
    return tuple(found)


def _silent(_done: float) -> None:
    """Nobody is told of parts of a jump."""
