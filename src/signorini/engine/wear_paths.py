# SPDX-License-Identifier: BSD-3-Clause
"""Cycles that nobody looks at, on the condensed interface alone: certified there, bodies are not recovered.

A cycle is a few segments of the load whose right-hand sides are known once for the step, but for what is worn: gaps
enter them linearly. So a cycle costs its events and nothing of the size of the bodies.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from signorini.arrays import Array
from signorini.engine.path_states import balanced, path_state, recovered, right_hand_side
from signorini.engine.prepare import Prepared
from signorini.engine.rubbing import Rubbing, rubbed, rubbing_of_segment
from signorini.friction.history import PathSettings, PathState, Segment
from signorini.interface.worn_sides import WornSides
from signorini.model.stage import Stage
from signorini.solution.state import LoadPoint, State, wear_of
from signorini.solution.wear_state import WearState


@dataclass(frozen=True, kw_only=True, eq=False)
class PathCycle:
    """Where a step stands between cycles, in the scaled units of the law, and what has happened since a whole state.

    Attributes
    ----------
    now, wear : contacts and sides
    spent : what contact has taken
    energy : set free with what is worn
    pivots : states tried
    residual : the largest of the certificates, relative to the data
    """

    now: PathState
    wear: WearState
    spent: float = 0.0
    energy: float = 0.0
    pivots: int = 0
    residual: float = 0.0

    def repeated(self, before: PathCycle, others: int) -> Self:
        """The end of a cycle that others are like.

        Parameters
        ----------
        before : where it began
        others : how many more
        """
        dissipation = self.now.dissipation + others * (self.now.dissipation - before.now.dissipation)
        return replace(
            self,
            now=replace(self.now, dissipation=dissipation),
            spent=self.spent + others * (self.spent - before.spent),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class FollowedCycle:
    """A cycle on the condensed interface.

    Attributes
    ----------
    before, after : where the step stood at its ends, sides worn as before it
    rubbing : what it has done to the sides
    turns : states of the path before it and at the end of each of its segments
    """

    before: PathCycle
    after: PathCycle
    rubbing: Rubbing
    turns: tuple[PathState, ...]


class WornPaths:
    """The segments of the cycles of a step.

    Parameters
    ----------
    prepared : condensed, with sides that wear
    stage : a step that repeats
    start : the state before it
    end : the point at its end, between sides that are worn as they are before it
    stops : how increments are chosen in space; None: event by event
    followed : number of cycles that were followed so far
    """

    def __init__(
        self, prepared: Prepared, stage: Stage, start: State, end: LoadPoint, stops: PathSettings | None, followed: int
    ) -> None:
        assert prepared.wearing is not None
        self.prepared, self.stage, self.stops = prepared, stage, stops
        self.sides: WornSides = prepared.wearing
        self.followed = followed
        self._depth = wear_of(start).depth
        m = stage.step.segments

        def ends(factors: Sequence[Mapping[str, float]]) -> list[tuple[Array, ...]]:
            ways = start.point, end
            return [tuple(right_hand_side(prepared, replace(way, factors=at)) for way in ways) for at in factors]

        self._first = ends(stage.ends[:m])
        alike = stage.ends[:m] == stage.ends[m : 2 * m]
        self._others = self._first if alike else ends(stage.ends[m : 2 * m])

    @property
    def rate(self) -> Array:
        """(n,) What the gap of a pair grows by over what it rubs."""
        return self.sides.rate

    def rubs(self, cycle: FollowedCycle) -> Array:
        """(n,) What a cycle rubs, of every pair."""
        return cycle.rubbing.wearing

    def volume(self, rubs: Array) -> Array:
        """(m,) What that takes from the corners of the sides."""
        return np.asarray(self.sides.volume @ rubs)

    def expired(self, behind: int) -> bool:  # noqa: ARG002
        """Pairs that stay are never out of place."""
        return False

    def begin(self, state: State) -> PathCycle:
        """A whole state on the path."""
        return PathCycle(now=path_state(self.prepared, state), wear=wear_of(state))

    def cycle(self, before: PathCycle, number: int) -> FollowedCycle | None:
        """A cycle, by its number; None where no path leads through it."""
        at, turns = before, [before.now]
        self.followed += 1
        m, count = self.stage.step.segments, len(self.stage.ends)
        worn, total = self._of_depths(at.wear.depth - self._depth), None
        for j, (first, last) in enumerate(self._first if number == 1 else self._others):
            way = ((number - 1) * m + j + 1) / count
            found = self._segment(at, (1.0 - way) * first + way * last + worn)
            if found is None:
                return None
            at, segment = found
            rubbing = rubbing_of_segment(self.sides, self.prepared.interface, self.prepared.paths, segment)
            total = rubbing if total is None else total.and_then(rubbing)
            turns.append(at.now)
        assert total is not None
        after = replace(at, wear=rubbed(at.wear, total))
        return FollowedCycle(before=before, after=after, rubbing=total, turns=tuple(turns))

    def worn(self, at: PathCycle, wear: WearState) -> PathCycle | None:
        """Sides that lose material at the loads of the moment, to a state of wear; None where no path leads there."""
        change = self.sides.gap @ (wear.depth - at.wear.depth)
        found = self._segment(at, at.now.b + self._of_depths(wear.depth - at.wear.depth))
        if found is None:
            return None
        at, segment = found
        rubbing = rubbing_of_segment(self.sides, self.prepared.interface, self.prepared.paths, segment)
        return replace(at, wear=rubbed(wear, rubbing), energy=at.energy + self._freed(segment, change))

    def state(self, last: State, at: PathCycle, point: LoadPoint) -> State:
        """The whole state, bodies recovered.

        Parameters
        ----------
        last : the last one that was whole
        at : where the step stands
        point : of the loads there
        """
        here = recovered(self.prepared, last, point, at.now)
        here = replace(here, released=last.released + at.energy)
        energy = wear_of(last).energy + at.energy
        return replace(balanced(self.prepared, last, here, at.spent), wear=replace(at.wear, energy=energy))

    def _segment(self, at: PathCycle, b: Array) -> tuple[PathCycle, Segment] | None:
        segment = self.prepared.paths.follow(at.now, b, self.stops, lambda _: None)
        if not segment.followed:
            return None
        h, r = (np.array([getattr(piece, name) for piece in segment.pieces]) for name in ("h", "r"))
        spent = float(-0.5 * ((r[1:] + r[:-1]) * np.diff(h, axis=0)).sum())
        reached = replace(
            at,
            now=segment.end,
            spent=at.spent + spent,
            pivots=at.pivots + segment.pivots,
            residual=max(at.residual, segment.residual),
        )
        return reached, segment

    def _of_depths(self, depth: Array) -> Array:
        """What worn depths (m,) add to b."""
        condensed = self.prepared.paths.condensed
        return condensed.of_gaps((self.sides.gap @ depth)[condensed.active])

    def _freed(self, segment: Segment, change: Array) -> float:
        """``int r_n dg`` along a segment in which gaps grow by a change (n,)."""
        condensed = self.prepared.paths.condensed
        forces = np.array([piece.r[0] for piece in segment.pieces]) * condensed.root
        steps = np.diff([piece.factor for piece in segment.pieces])
        return float(steps @ (0.5 * (forces[1:] + forces[:-1]) @ change[condensed.active]))
