# SPDX-License-Identifier: BSD-3-Clause
"""A step whose sliding wears the sides of contacts: cycle after cycle, what a cycle has rubbed widens the gaps.

Wear moves only what the gaps are, a right-hand side: nothing is factorised again. After every cycle (a step that does
not repeat is one) the gaps grow at the loads of its end, followed as any other part of a step, so that forces pass
from what is worn to what is not gradually, and events there are found. Cycles that nobody looks at are followed on
the condensed interface alone, see `engine.wear_paths`; kept are the first and the last, those with a time asked for,
and 2, 5, 10, 20, 50, ...
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, partial

import numpy as np

from signorini.arrays import Array
from signorini.attempt import MethodRun
from signorini.engine import stride_correction, wear_correction
from signorini.engine.cycles import cycle_between, is_round
from signorini.engine.events import stops_at
from signorini.engine.moved_mesh import between_moved, deepest_wear, given_way, giving_way
from signorini.engine.prepare import Prepared
from signorini.engine.rubbing import rubbed, rubbing_of_states, set_loose, worn
from signorini.engine.sliding import FOLLOWED, Stride, follow_sliding
from signorini.engine.sliding_cycles import SlidingCycles
from signorini.engine.step_parts import (
    FollowedPart,
    Interval,
    Snapshot,
    StepPart,
    ending,
    joined,
    keep,
    lightened,
    straight_parts,
)
from signorini.engine.ways import SPACE_INCREMENTS, follow_part
from signorini.engine.wear_blocks import Correct, CycleBlock, CycleBlocks
from signorini.engine.wear_paths import FollowedCycle, PathCycle, WornPaths
from signorini.engine.wear_refusals import NEEDS_OF_PAIRS, NEEDS_OF_STRIDES, refuse_unbalanced, unfit_for_blocks
from signorini.errors import SolveFailed
from signorini.interface.worn_sides import WornSides
from signorini.model.stage import Stage
from signorini.solution.certificate import worst_of
from signorini.solution.state import LoadPoint, State, wear_of

_SAME_TIME = 1e-9  # of a step: times asked for that are closer to the end of a cycle are there


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
        if stage.step.block is None:
            for number in range(1, stage.step.repeat + 1):
                walk.cycle(number)
                walk.move_mesh(number)
        else:
            walk.blocks()
        refuse_unbalanced(stage, (prepared, state), (walk.prepared, walk.state))
    except (SolveFailed, KeyboardInterrupt) as stop:
        raise keep(stop, walk.behind) from None
    return walk.behind, walk.ends


class _Walk:
    """A step on the way, from one cycle to the next.

    Attributes
    ----------
    state : the last whole one
    at : where the step stands on the condensed interface, ahead of that; None where it does not
    behind : parts that are kept
    ends : load factors at the ends of cycles kept
    """

    def __init__(self, prepared: Prepared, stage: Stage, state: State, end: LoadPoint, heated: bool) -> None:
        assert prepared.wearing is not None
        self.prepared, self.stage, self.start, self.end, self.heated = prepared, stage, state, end, heated
        self.sides: WornSides = prepared.wearing
        self.state = state
        self.at: PathCycle | None = None
        self.behind: list[FollowedPart] = []
        self.ends: list[float] = []
        self._deepest = deepest_wear(prepared)
        self._followed = 0
        self._recurring: SlidingCycles | None = None
        self._strides: list[Stride] = []
        self._since = 0

    @property
    def paths(self) -> WornPaths | SlidingCycles | None:
        """Cycles on the condensed interface; None where increments or bodies at every event are asked for."""
        return self._recurring if self.prepared.model.slides else self._of_pairs_that_stay

    @cached_property
    def _of_pairs_that_stay(self) -> WornPaths | None:
        step, point = self.stage.step, self.start.point
        if step.increments is not None or step.path == "increments" or step.at == "events" or self.heated:
            return None
        if point.given.any() or self.prepared.solver.paths is None:
            return None
        stops = None
        if self.prepared.interface.directions == 3 and step.path != "exact":
            stops = stops_at(SPACE_INCREMENTS, self.prepared.settings)
        return WornPaths(self.prepared, self.stage, self.start, self.end, stops, self._followed)

    def cycle(self, number: int, *, anew: bool = False) -> FollowedCycle | None:
        """A cycle, and its wear at its end; given where it went on the condensed interface alone.

        Parameters
        ----------
        number : of the cycle
        anew : with its bodies, whatever strides are known
        """
        paths = self.paths
        if paths is not None and not anew and not self._kept(number):
            found = paths.cycle(self._on_path(number - 1), number)
            moved = None if found is None else paths.worn(found.after, worn(self.sides, found.after.wear, cycles=1))
            if moved is not None:
                self.at = moved
                return found
        self._whole(number - 1)
        self._strides = []
        begin, (parts, interval) = self.state, self._cycle_parts(number)
        parts.append(self._worn(interval))
        self._keep(joined(parts), begin, number)
        self._record(number)
        return None

    def _record(self, behind: int) -> None:
        """Cycles like the one that was followed go through its strides again; so many are behind."""
        if self._recurring is not None:
            self._followed = self._recurring.followed
        self._recurring = None
        if self._may_recur and self._strides:
            found = SlidingCycles(self.prepared, self._strides, behind, self._followed)
            self._recurring = found if found.recur else None

    @cached_property
    def _may_recur(self) -> bool:
        """Whether strides of a cycle may be those of the next."""
        step, start, stage = self.stage.step, self.start.point, self.stage
        m = step.segments
        steady = np.array_equal(start.gap, self.end.gap) and not start.given.any() and not start.reaction.any()
        alike = stage.ends[:m] == stage.ends[m : 2 * m]
        exact = step.increments is None and step.path != "increments"
        looked_at = step.at == "events" or self.heated or self.prepared.turns or self.prepared.solver.paths is None
        return steady and alike and exact and not looked_at

    def blocks(self) -> None:
        """The step in implicit blocks, which end at the latest where a cycle is kept."""
        step, behind, blocks = self.stage.step, 0, None
        assert step.block is not None
        if self.prepared.model.slides and not self._may_recur:
            raise unfit_for_blocks(self.stage, NEEDS_OF_STRIDES)
        if not self.prepared.model.slides and self._of_pairs_that_stay is None:
            raise unfit_for_blocks(self.stage, NEEDS_OF_PAIRS)
        while behind < step.repeat:
            paths, block, anew = self.paths, None, False
            if paths is not None:
                if blocks is None:
                    blocks = CycleBlocks(paths, _correct(paths), step.block, step.tolerance)
                blocks.go_on(paths, _correct(paths))
                room = next(number for number in range(behind + 1, step.repeat + 1) if self._kept(number)) - behind
                block = blocks.next(self._on_path(behind), behind, room)
                anew = paths.expired(behind)
            if block is not None:
                behind += block.count
                self._take(block, behind)
                self.move_mesh(behind)
                continue
            behind += 1
            cycle = self.cycle(behind, anew=anew)
            if blocks is not None:
                blocks.single(cycle)
            self.move_mesh(behind)
        note = "no cycle goes through the strides of another: all were followed" if blocks is None else blocks.note
        self.behind[-1] = replace(self.behind[-1], notes=(*self.behind[-1].notes, note))

    def _take(self, block: CycleBlock, behind: int) -> None:
        """Go to the end of a block; where its last cycle is kept, with all that is known of bodies and pairs."""
        self.at = block.done
        if not self._kept(behind):
            return
        self.at = block.cycle.before
        self._whole(behind - 1)
        self._strides = []
        begin, (parts, interval) = self.state, self._cycle_parts(behind)
        once, others = self.state, block.count - 1
        wear, before = wear_of(once), wear_of(begin)
        taken, freed = once.dissipation - begin.dissipation, once.released - begin.released
        lost = block.cycle.after.wear.loose + others * block.cycle.rubbing.volume - block.done.wear.loose
        self.state = replace(
            once,
            dissipation=once.dissipation + others * taken,
            work=once.work + others * (float(taken.sum()) + freed),
            released=once.released + others * freed,
            wear=replace(
                wear,
                distance=wear.distance + others * (wear.distance - before.distance),
                loose=wear.loose + others * (wear.loose - before.loose) - lost,
            ),
        )
        whole = ending(joined(parts), self.state)
        if self.prepared.model.slides:  # the strides of the next cycles begin where sides have lost all
            whole = joined([whole, self._worn(interval, cycles=0)])
            self._record(behind)
        self._keep(whole, begin, behind, cycle_end=once)

    def _on_path(self, behind: int) -> PathCycle:
        """Where the step stands on the condensed interface, so many cycles behind."""
        assert self.paths is not None
        if self.at is None:
            self.at, self._since = self.paths.begin(self.state), behind
        return self.at

    def _whole(self, behind: int) -> None:
        """Recover the bodies, so many cycles behind, where the step is ahead of them."""
        if self.at is None:
            return
        assert self.paths is not None
        at, last = self.at, self.state
        interval, point = list(straight_parts(self.stage, self.start.point, self.end, max(behind, 1)))[-1]
        if behind == 0:
            point, fraction = self.start.point, 0.0
        else:
            fraction = interval.high
        depth = at.wear.depth - wear_of(self.start).depth
        point = replace(point, gap=point.gap + self.sides.gap @ depth)
        self.state = self.paths.state(last, at, point)
        words = f"{behind - self._since} cycles on the condensed interface, certified to {at.residual:.1e}"
        shot = Snapshot(number=self.stage.number, fraction=fraction, what="segment", state=self.state)
        stretch = FollowedPart(
            path="exact" if self.paths.stops is None else "increments",
            before=last,
            after=self.state,
            certificates=(),
            trace=((MethodRun(method="exact path", iterations=at.pivots, end=words),),),
            snapshots=(shot,),
        )
        self._add(lightened(stretch, every=False, end=False, heated=self.heated))
        self.ends.append(shot.load_factor)
        self.at = None

    def _kept(self, number: int) -> bool:
        """Whether the snapshots of a cycle are results."""
        step = self.stage.step
        low, high = (number - 1) / step.repeat, number / step.repeat
        asked = isinstance(step.at, tuple) and any(low + _SAME_TIME < at <= high + _SAME_TIME for at in step.at)
        return asked or number in (1, step.repeat) or step.at == "events" or is_round(number)

    def _keep(self, whole: FollowedPart, begin: State, number: int, *, cycle_end: State | None = None) -> None:
        """Take a cycle to what is behind; of one that nobody asked for its numbers and its certificate.

        Parameters
        ----------
        whole : all of it
        begin : where it began
        number : of the cycle
        cycle_end : where it ended before it stood for others too
        """
        end, step = self.state if cycle_end is None else cycle_end, self.stage.step
        one, two = wear_of(begin), wear_of(end)
        lost = two.volume - one.volume if cycle_end is None else two.loose - one.loose
        cycle = replace(
            cycle_between(begin, end, two.distance - one.distance),
            number=number,
            load_factor=self.stage.number - 1 + number / step.repeat,
            worn=float(lost.sum()),
        )
        # strides of other cycles are those of the first
        notes = tuple(note for note in whole.notes if number == 1 or not note.startswith(FOLLOWED))
        whole = replace(whole, notes=notes, cycles=(cycle,) if step.repeat > 1 else ())
        if self._kept(number):
            self.ends.append(cycle.load_factor)
        else:
            worst = () if not whole.certificates else (worst_of(whole.certificates),)
            whole = replace(whole, certificates=worst, trace=whole.trace[:1], snapshots=(), events=())
        self._add(whole)

    def _add(self, part: FollowedPart) -> None:
        """Take a part to what is behind, on the mesh of the moment."""
        if self.prepared.meshed is not None:
            part = replace(part, snapshots=tuple(replace(shot, prepared=self.prepared) for shot in part.snapshots))
        self.behind.append(part)

    def move_mesh(self, behind: int) -> None:
        """The mesh takes what sides have lost, so many cycles behind, where that is deep beside its cells."""
        wear = wear_of(self.state) if self.at is None else self.at.wear
        if self._deepest is None or (wear.beyond <= self._deepest).all():
            return
        self._whole(behind)
        interval = list(straight_parts(self.stage, self.start.point, self.end, behind))[-1][0]
        still = replace(interval, low=interval.high, ends="wear", cycle=0, asked=False)
        old, before = self.prepared, self.state
        self.prepared, self.state, point = giving_way(old, before, f"{self.stage.name} at {interval.high:.6%}")
        assert self.prepared.wearing is not None
        self.start, self.end = between_moved(old, self.prepared, self.start, self.end, wear_of(self.state).taken)
        self.sides, self._deepest, self._recurring = self.prepared.wearing, deepest_wear(self.prepared), None
        followed = given_way((old, before), self.prepared, before.point, self._part(still, point))
        self.state = followed.after
        if (known := self.__dict__.pop("_of_pairs_that_stay", None)) is not None:
            self._followed = known.followed
        self._add(lightened(followed, every=self.stage.step.at == "events", end=False, heated=self.heated))

    def _cycle_parts(self, number: int) -> tuple[list[FollowedPart], Interval]:
        """Follow a cycle with all that is known of bodies and pairs; its parts, and the last interval."""
        parts: list[FollowedPart] = []
        every = self.stage.step.at == "events"
        for interval, point in straight_parts(self.stage, self.start.point, self.end, number):
            followed = self._part(interval, self._between_worn(point))
            parts.append(lightened(followed, every=every, end=interval.asked, heated=self.heated))
        return parts, interval

    def _part(self, interval: Interval, point: LoadPoint, lost: Array | None = None) -> FollowedPart:
        """Follow a straight part from the present state on, and note what it has rubbed.

        Parameters
        ----------
        interval, point : the part, and the point at its end
        lost : (m,) depth that sides lose in a part at constant loads, which the state has already
        """
        part = StepPart(
            prepared=self.prepared,
            where=self.stage.name,
            interval=interval,
            before=self.state,
            end=point,
            whole=self.stage.step.at == "events",
        )
        if self.prepared.model.slides:
            followed = follow_sliding(part, partial(follow_part, self.stage), lost, self._strides)
        else:
            followed = follow_part(self.stage, part)
            if lost is not None:
                followed = set_loose(self.state, followed)
            states = [self.state, *(shot.state for shot in followed.snapshots)]
            rubbing = rubbing_of_states(self.sides, self.prepared.interface, states)
            followed = ending(followed, replace(followed.after, wear=rubbed(wear_of(followed.after), rubbing)))
        self.state = followed.after
        return followed

    def _worn(self, interval: Interval, *, cycles: int = 1) -> FollowedPart:
        """The sides lose what so many cycles have rubbed off, at the loads of the end of an interval."""
        old = self.state
        wear = worn(self.sides, wear_of(old), cycles=cycles)
        self.state = replace(old, wear=wear)
        lost = wear.depth - wear_of(old).depth
        still = replace(interval, low=interval.high, ends="wear", cycle=0, asked=False)
        followed = self._part(still, replace(old.point, gap=old.point.gap + self.sides.gap @ lost), lost)
        last = replace(followed.snapshots[-1], what="wear")
        return lightened(
            replace(followed, snapshots=(last,)), every=self.stage.step.at == "events", end=False, heated=self.heated
        )

    def _between_worn(self, point: LoadPoint) -> LoadPoint:
        """The point of the loads between sides that are worn as they are now."""
        depth = wear_of(self.state).depth - wear_of(self.start).depth
        return replace(point, gap=point.gap + self.sides.gap @ depth)


def _correct(paths: WornPaths | SlidingCycles) -> Correct:
    """Newton's step of blocks of cycles."""
    return partial(wear_correction.corrected, paths) if isinstance(paths, WornPaths) else stride_correction.corrected
