# SPDX-License-Identifier: BSD-3-Clause
"""Straight parts of a step, from one kink of its loads or time asked for to the next; and what following one gives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Any, Literal

import numpy as np

from signorini.arrays import Array, ArrayElsewhere, BoolArray, frozen, stored
from signorini.attempt import MethodRun
from signorini.distributed.kept_rows import put_away
from signorini.engine.examine import on_ranks
from signorini.engine.prepare import Prepared
from signorini.engine.tape import Leg
from signorini.errors import Interrupted, SolveFailed
from signorini.interface.interface import Interface
from signorini.model.stage import Stage
from signorini.solution.certificate import Certificate
from signorini.solution.results import Cycle, PairEvent
from signorini.solution.state import LoadPoint, State

_KINK_TOL = 1e-9  # of a step: kinks and times asked for that are closer are one


@dataclass(frozen=True, kw_only=True)
class Interval:
    """A straight part of step ``number``, between two parts of it.

    Attributes
    ----------
    number : of the step, from 1
    low, high : parts of the step, 0 .. 1
    ends : what is at its end: "segment" of the loads, a time "asked" for, an "event" or a "jump"; "wear" of sides,
        at one load; or a "handover" to other pairs
    cycle : number of the cycle that ends here, 0 where none does
    asked : whether its end, not that of the step, was asked for
    """

    number: int
    low: float
    high: float
    ends: Literal["segment", "asked", "event", "jump", "wear", "handover"]
    cycle: int = 0
    asked: bool = False

    def fraction(self, t: float) -> float:
        """Of the step, at the fraction t of this interval."""
        return self.high if t == 1.0 else self.low + t * (self.high - self.low)

    def factor(self, t: float) -> float:
        """Load factor at the fraction t of this interval."""
        return self.number - 1 + self.fraction(t)

    def within(self, fraction: float) -> float:
        """The fraction of this interval at a fraction of the step; no number of the step is in its digits."""
        return (fraction - self.low) / (self.high - self.low) if self.high > self.low else 1.0


def straight_parts(
    stage: Stage, start: LoadPoint, end: LoadPoint, cycle: int | None = None
) -> Iterator[tuple[Interval, LoadPoint]]:
    """The straight parts of a step, each with the point at its end.

    Parameters
    ----------
    stage : the step
    start, end : points at the ends of the step; everything but factors changes linearly from one to the other
    cycle : the only one that is asked for, from 1; None: all
    """
    count, step = len(stage.ends), stage.step
    first, last = (0, count) if cycle is None else ((cycle - 1) * step.segments, cycle * step.segments)
    kinks = [(j / count, "segment") for j in range(first + 1, last + 1)]
    low = first / count
    begin, close = low + (_KINK_TOL if first else 0.0), last / count + _KINK_TOL
    asked = tuple(part for part in step.at if begin < part <= close) if isinstance(step.at, tuple) else ()
    between = tuple(part for part in asked if min(abs(part - kink) for kink, _ in kinks) > _KINK_TOL)
    for high, what in sorted([*kinks, *((part, "asked") for part in between)]):
        j = min(int(np.ceil(high * count - _KINK_TOL)), count) - 1
        before = stage.ends[j - 1] if j else start.factors
        t = high * count - j if what == "asked" else 1.0
        way = start.towards(end, high)
        factors = {name: (1.0 - t) * before.get(name, 0.0) + t * value for name, value in stage.ends[j].items()}
        point = way.changed(factors=stage.ends[j] if t == 1.0 else factors)
        finished = what == "segment" and (j + 1) % step.segments == 0
        yield (
            Interval(
                number=stage.number,
                low=low,
                high=high,
                ends="asked" if what == "asked" else "segment",
                cycle=(j + 1) // step.segments if finished else 0,
                asked=high < 1.0 and any(abs(part - high) <= _KINK_TOL for part in asked),
            ),
            point,
        )
        low = high


@dataclass(frozen=True, kw_only=True, eq=False)
class StepPart:
    """A straight part of a step, to be followed from a state to a point of the load history.

    Attributes
    ----------
    prepared : the model, as it is in this step
    where : name of the step, for messages
    interval : the part of the history that this is
    before : the state that it begins in
    end : the point at its end
    whole : whether the displacement of the bodies is recovered at every event, not at the end alone
    awake : the model in which bodies may move that rest in this part; None where none does
    waiting : (n,) pairs of those bodies; empty where there is none
    """

    prepared: Prepared
    where: str
    interval: Interval
    before: State
    end: LoadPoint
    whole: bool = False
    awake: Prepared | None = None
    waiting: BoolArray = field(default_factory=lambda: np.zeros(0, np.bool_))

    def cut(self, factor: float, ends: Literal["event", "jump", "handover"]) -> StepPart:
        """Up to an event, a jump or a handover at a part of it, 0 .. 1, from where on it is followed anew."""
        end = self.before.point.towards(self.end, factor)
        return replace(self, end=end, interval=replace(self.interval, high=self.interval.fraction(factor), ends=ends))

    @property
    def woken(self) -> StepPart:
        """The part with all bodies free to move."""
        if self.awake is None:
            return self
        return replace(self, prepared=self.awake, awake=None, waiting=np.zeros(0, np.bool_))

    def rest(self, cut: StepPart, state: State) -> StepPart:
        """What is left behind a part that was cut off, from a state at its end."""
        return replace(self, before=state, interval=replace(self.interval, low=cut.interval.high))


What = Literal[
    "start",
    "event",
    "increment",
    "asked",
    "segment",
    "jump",
    "landing",
    "change",
    "approach",
    "wear",
    "handover",
    "mesh",
]


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """A state on the way.

    Attributes
    ----------
    number, fraction : of the step, from 1, and the part of it, 0 .. 1
    what : happens there
    state : its displacement and external forces hold only where it is ``whole``, its work where it is ``worked``; gaps
        of pairs that the law is not asked of are NaN where it is neither
    whole : whether the displacement of the bodies is there
    kept : whether it is one of the results
    worked : whether it was recovered
    interface : the pairs, where they are not those of the model
    prepared : the model, where its mesh has moved since the step began
    recover : gives the state with its displacement, where that was not looked for
    """

    number: int
    fraction: float
    what: What
    state: State
    whole: bool = True
    kept: bool = False
    worked: bool = True
    interface: Interface | None = None
    prepared: Prepared | None = None
    recover: Callable[[], State] | None = None

    @property
    def bodies(self) -> State | None:
        """The state with its displacement, which is recovered if need be; None where it is not known."""
        return self.state if self.whole else self.recover and self.recover()

    @property
    def load_factor(self) -> float:
        """Step k goes from k - 1 to k."""
        return self.number - 1 + self.fraction

    def asked_for(self, last: bool) -> Snapshot:
        """As one of the results, of which ranks keep all but the last, which the history goes on from."""
        there = last or isinstance(stored(self.state, "displacement"), ArrayElsewhere)
        return replace(self, kept=True, state=self.state if there else kept_by_ranks(self.state))

    def light(self, flow: bool) -> Snapshot:
        """Without the displacement of the bodies, for a history may have thousands; ``flow``: with plastic strains."""
        none = np.zeros(0)
        point = replace(self.state.point, reaction=none, offset=none)
        plastic = self.state.plastic if flow or self.state.plastic is None else self.state.plastic.light()
        state = replace(self.state, point=point, displacement=none, external=none, plastic=plastic)
        return replace(self, state=state, whole=False, recover=None)


@dataclass(frozen=True, kw_only=True, eq=False)
class FollowedPart:
    """From one state to another.

    Attributes
    ----------
    path : "single" (one increment), "increments" or "exact"
    before, after : states at the ends
    certificates : of every state that was certified on the way
    trace : for every increment the methods tried; on an exact path one entry for all of it; empty where nothing had to
        be solved
    snapshots : on the way, in order, the end last
    events : of an exact path
    notes : what a reader should know of the way
    cycles : of sides that wear, as they were gone through; otherwise they are found in the snapshots
    turned_at : (dofs,) displacement at which loads were last seen from bodies that turn; empty where none does
    until : the same up to a fraction of it, where it is known without following it again
    prepared : the model at its end, where its mesh has moved with what is worn; None where it has not
    legs : straight parts that derivatives know how to go through
    """

    path: str
    before: State
    after: State
    certificates: tuple[Certificate, ...]
    trace: tuple[tuple[MethodRun, ...], ...]
    snapshots: tuple[Snapshot, ...]
    events: tuple[PairEvent, ...] = ()
    notes: tuple[str, ...] = ()
    cycles: tuple[Cycle, ...] = ()
    turned_at: Array = field(default_factory=lambda: np.zeros(0))
    until: Callable[[float], FollowedPart] | None = None
    prepared: Prepared | None = None
    legs: tuple[Leg, ...] = ()


def kept_by_ranks(state: State) -> State:
    """A state that nothing goes on from now, with what it knows of all nodes on the ranks, where there are several.

    Parameters
    ----------
    state : with its displacement
    """
    return replace(state, **{name: put_away(stored(state, name)) for name in ("displacement", "external")})


def at_nodes(prepared: Prepared, values: Any) -> Array:
    """(nodes, d) Results at the nodes of all dofs (dofs,), read-only; bodies on ranks have them there.

    Parameters
    ----------
    prepared, values : the model, and the results here or on the ranks
    """
    if not isinstance(values, np.ndarray):
        space = prepared.space
        found: Array = put_away(values, (space.dofs_of_nodes // space.components, space.components))
        return found
    values = frozen(prepared.space.at_nodes(values))
    return put_away(values) if on_ranks(prepared.K) else values


def leg_of(part: StepPart, after: State, **way: Any) -> Leg:
    """What derivatives need of a part that was followed.

    Parameters
    ----------
    part : the part, up to where it was followed
    after : the state there
    way : how it was followed, see `Leg`
    """
    low, high = part.interval.factor(0.0), part.interval.factor(1.0)
    return Leg(
        prepared=part.prepared,
        where=part.where,
        before=part.before,
        after=after,
        end=part.end,
        low=low,
        high=high,
        **way,
    )


def lightened(followed: FollowedPart, *, every: bool, end: bool, heated: bool, taped: bool = False) -> FollowedPart:
    """What was followed, with the displacement of the bodies only where it was asked for, and at its end.

    Parameters
    ----------
    every : asked for wherever it is known
    end : asked for at the end
    heated : displacements that were not asked for are needed for the work of temperatures
    taped : its legs are wanted
    """
    shots = []
    for i, shot in enumerate(followed.snapshots, start=1):
        last = i == len(followed.snapshots)  # a cycle may end here, which is judged by its plastic strains
        kept = shot.whole and (every or shot.what == "asked" or (end and last))
        shots.append(shot.asked_for(last) if kept else shot if heated else shot.light(last))
    return replace(followed, snapshots=tuple(shots), until=None, legs=followed.legs if taped else ())


def joined(behind: Sequence[FollowedPart]) -> FollowedPart:
    """Several parts, one after the other, as one; the way is that of those on which loads change or the law does."""
    paths = [followed.path for followed in behind if followed.trace] or [followed.path for followed in behind]
    exact = "exact" in paths and {*paths} <= {"exact", "single"}
    return FollowedPart(
        path="exact" if exact else "increments" if len(paths) > 1 else paths[0],
        before=behind[0].before,
        after=behind[-1].after,
        certificates=tuple(chain.from_iterable(followed.certificates for followed in behind)),
        trace=tuple(chain.from_iterable(followed.trace for followed in behind)),
        snapshots=tuple(chain.from_iterable(followed.snapshots for followed in behind)),
        events=tuple(chain.from_iterable(followed.events for followed in behind)),
        notes=tuple(dict.fromkeys(chain.from_iterable(followed.notes for followed in behind))),
        cycles=tuple(chain.from_iterable(followed.cycles for followed in behind)),
        turned_at=behind[-1].turned_at,
        until=behind[0].until if len(behind) == 1 else None,
        prepared=next((part.prepared for part in reversed(behind) if part.prepared is not None), None),
        legs=tuple(chain.from_iterable(followed.legs for followed in behind)),
    )


def ending(followed: FollowedPart, after: State) -> FollowedPart:
    """A part whose last state knows more than it was followed with."""
    *shots, last = followed.snapshots
    return replace(followed, after=after, snapshots=(*shots, replace(last, state=after)))


def at_once(followed: FollowedPart, interval: Interval) -> FollowedPart:
    """What was followed at constant loads, all of it at the end of an interval."""
    shots = tuple(replace(shot, fraction=interval.high) for shot in followed.snapshots)
    events = tuple(replace(event, load_factor=interval.factor(1.0)) for event in followed.events)
    return replace(followed, snapshots=shots, events=events)


def keep(stop: SolveFailed | KeyboardInterrupt, behind: Sequence[FollowedPart]) -> SolveFailed | KeyboardInterrupt:
    """What stopped a step, with what was followed before: ``behind``, and what it already carries."""
    last = reached(stop)
    every = [*behind, *([] if last is None else [last])]
    if not every:
        return stop
    if isinstance(stop, KeyboardInterrupt):
        return Interrupted(reached=joined(every))
    stop.reached = joined(every)
    return stop


def reached(stop: SolveFailed | KeyboardInterrupt) -> FollowedPart | None:
    """The part of a step that was followed before it was stopped; None where that is nothing."""
    found = stop.reached if isinstance(stop, (SolveFailed, Interrupted)) else None
    return found if isinstance(found, FollowedPart) else None
