# SPDX-License-Identifier: BSD-3-Clause
"""A step whose sliding wears the sides of contacts: cycle after cycle, what a cycle has rubbed widens the gaps.

Wear moves only what the gaps are, a right-hand side: nothing is factorised again. After every cycle (a step that does
not repeat is one) the gaps grow at the loads of its end, followed as any other part of a step, so that forces pass
from what is worn to what is not gradually, and events there are found. Cycles that nobody looks at are followed on
the condensed interface alone, see `engine.wear_paths`; kept are the first and the last, those with a time asked for,
and 2, 5, 10, 20, 50, ...
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from signorini.engine.cycles import cycle_between
from signorini.engine.prepare import Prepared
from signorini.engine.rubbing import rubbed, rubbing_of_states, worn
from signorini.engine.step_parts import (
    FollowedPart,
    Interval,
    Snapshot,
    StepPart,
    joined,
    keep,
    lightened,
    straight_parts,
)
from signorini.engine.ways import follow_part
from signorini.errors import SolveFailed
from signorini.interface.worn_sides import WornSides
from signorini.model.stage import Stage
from signorini.solution.certificate import worst_of
from signorini.solution.results import Cycle
from signorini.solution.state import LoadPoint, State
from signorini.solution.wear_state import WearState


def follow_wearing(
    prepared: Prepared, stage: Stage, state: State, end: LoadPoint, *, heated: bool
) -> tuple[list[FollowedPart], list[float]]:
    """Follow a step of a model that wears; the parts of it, and the load factors at the ends of the cycles kept.

    Parameters
    ----------
    prepared : under the law of the step, with sides that wear
    stage : the step
    state : before it
    end : the point at its end, between sides that are worn as they are in that state
    heated : displacements that nobody asks for are needed for the work of temperatures

    Raises
    ------
    SolveFailed
        As `follow_part` does; it carries what was followed.
    """
    walk = _Walk(prepared, stage, state, end, heated)
    try:
        for number in range(1, stage.step.repeat + 1):
            walk.cycle(number)
    except (SolveFailed, KeyboardInterrupt) as stop:
        raise keep(stop, walk.behind) from None
    return walk.behind, walk.ends


class _Walk:
    """A step on the way, from one cycle to the next.

    Attributes
    ----------
    state : reached
    behind : parts that are kept
    ends : load factors at the ends of cycles kept
    """

    def __init__(self, prepared: Prepared, stage: Stage, state: State, end: LoadPoint, heated: bool) -> None:
        assert prepared.wearing is not None
        self.prepared, self.stage, self.start, self.end, self.heated = prepared, stage, state, end, heated
        self.sides: WornSides = prepared.wearing
        self.state = state
        self.behind: list[FollowedPart] = []
        self.ends: list[float] = []

    def cycle(self, number: int) -> None:
        """Follow a cycle with all that is known of bodies and pairs, and wear the sides."""
        step, begin = self.stage.step, self.state
        parts: list[FollowedPart] = []
        for interval, point in straight_parts(self.stage, self.start.point, self.end, number):
            followed = self._part(interval, self._between_worn(point))
            parts.append(lightened(followed, every=step.at == "events", end=interval.asked, heated=self.heated))
        parts.append(self._worn(interval, cycles=1))
        whole = joined(parts)
        sliding = _wear(self.state).distance - _wear(begin).distance
        cycle = replace(
            cycle_between(begin, self.state, sliding),
            number=number,
            load_factor=interval.factor(1.0),
            worn=float((_wear(self.state).volume - _wear(begin).volume).sum()),
        )
        self._keep(whole, cycle, kept=self._asks(number, parts))

    def _asks(self, number: int, parts: Sequence[FollowedPart]) -> bool:
        """Whether the snapshots of a cycle are results."""
        step = self.stage.step
        asked = any(shot.kept for part in parts for shot in part.snapshots)
        return asked or number in (1, step.repeat) or step.at == "events" or is_round(number)

    def _keep(self, whole: FollowedPart, cycle: Cycle, *, kept: bool) -> None:
        """Take a cycle to what is behind; of one that is not kept its numbers and its certificate."""
        cycles = (cycle,) if self.stage.step.repeat > 1 else ()
        if kept:
            self.behind.append(replace(whole, cycles=cycles))
            self.ends.append(cycle.load_factor)
            return
        worst = () if not whole.certificates else (worst_of(whole.certificates),)
        self.behind.append(
            replace(whole, cycles=cycles, certificates=worst, trace=whole.trace[:1], snapshots=(), events=())
        )

    def _part(self, interval: Interval, point: LoadPoint) -> FollowedPart:
        """Follow a straight part from the present state on, and note what it has rubbed."""
        part = StepPart(
            prepared=self.prepared,
            where=self.stage.name,
            interval=interval,
            before=self.state,
            end=point,
            whole=self.stage.step.at == "events",
        )
        followed = follow_part(self.stage, part)
        states = [self.state, *(shot.state for shot in followed.snapshots)]
        rubbing = rubbing_of_states(self.sides, self.prepared.interface, states)
        followed = _ending(followed, replace(followed.after, wear=rubbed(_wear(self.state), rubbing)))
        self.state = followed.after
        return followed

    def _worn(self, interval: Interval, *, cycles: int) -> FollowedPart:
        """The sides lose what has rubbed, at the loads of the end of an interval."""
        old = self.state
        wear = worn(self.sides, _wear(old), cycles=cycles)
        self.state = replace(old, wear=wear)
        gap = old.point.gap + self.sides.gap @ (wear.depth - _wear(old).depth)
        still = replace(interval, low=interval.high, ends="wear", cycle=0, asked=False)
        before = self.state
        followed = self._part(still, replace(old.point, gap=gap))
        followed = set_loose(before, followed)
        self.state = followed.after
        last = replace(followed.snapshots[-1], what="wear")
        return lightened(
            replace(followed, snapshots=(last,)), every=self.stage.step.at == "events", end=False, heated=self.heated
        )

    def _between_worn(self, point: LoadPoint) -> LoadPoint:
        """The point of the loads between sides that are worn as they are now."""
        depth = _wear(self.state).depth - _wear(self.start).depth
        return replace(point, gap=point.gap + self.sides.gap @ depth)


def is_round(number: int) -> bool:
    """Whether a number is 1, 2 or 5 times a power of ten.

    >>> [number for number in range(1, 101) if is_round(number)]
    [1, 2, 5, 10, 20, 50, 100]
    """
    return str(number).rstrip("0") in ("1", "2", "5")


def set_loose(before: State, followed: FollowedPart) -> FollowedPart:
    """A part at constant loads in which gaps have grown: forces that gave way there did work, which is set free.

    Its states hold ``- int r_n dg`` as work of an interference, and it is none of the loads.

    Parameters
    ----------
    before : where the part began
    followed : as it was followed
    """
    n = len(before.gap)
    last, energy, shots = before, 0.0, list[Snapshot]()
    for shot in followed.snapshots:
        now = shot.state
        energy += float(0.5 * (last.forces + now.forces)[:n] @ (now.point.gap - last.point.gap))
        shots.append(replace(shot, state=_freed(now, energy)))
        last = now
    return replace(followed, snapshots=tuple(shots), after=_freed(followed.after, energy))


def _freed(state: State, energy: float) -> State:
    wear = _wear(state)
    return replace(
        state,
        work=state.work + energy,
        released=state.released + energy,
        wear=replace(wear, energy=wear.energy + energy),
    )


def _ending(followed: FollowedPart, after: State) -> FollowedPart:
    """A part whose last state knows more than it was followed with."""
    *shots, last = followed.snapshots
    return replace(followed, after=after, snapshots=(*shots, replace(last, state=after)))


def _wear(state: State) -> WearState:
    assert state.wear is not None
    return state.wear
