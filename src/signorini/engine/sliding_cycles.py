# SPDX-License-Identifier: BSD-3-Clause
"""Cycles of sides that slide far and wear, on the condensed interface alone, through strides that recur.

The strides are those of the last cycle that was followed with its bodies; what hands over, slides and wears is the same
as there. Where every pair that touches slips on, as in the middle of a stroke, a stride is a linear complementarity
problem in the normal forces alone, followed from event to event; where the motion turns, the exact path of the law.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from signorini.arrays import Array
from signorini.engine.events import stops_at
from signorini.engine.gross_sliding import Gone, slide
from signorini.engine.path_states import balanced, path_state, recovered
from signorini.engine.prepare import Prepared
from signorini.engine.recurring_strides import Link, StridePairs, Track
from signorini.engine.rubbing import Rubbing, rubbed, rubbing_of_segment
from signorini.engine.sliding import Stride
from signorini.engine.stride_pairs import stride_of
from signorini.engine.wear_paths import FollowedCycle, PathCycle
from signorini.friction.history import PathSettings, Segment
from signorini.interface.worn_sides import WornSides
from signorini.law.states import OPEN
from signorini.solution.state import LoadPoint, State, wear_of
from signorini.solution.wear_state import WearState

_SHORTEST_INCREMENT = 2.0**-8  # of a stride in space: it misses less than 1e-4 of its work then
_DRIFT = 0.1  # of a stride: how far bodies may be from where its pairs were found


@dataclass(frozen=True, kw_only=True, eq=False)
class StrideCycle(PathCycle):
    """Where a step stands between cycles; its pairs are those of the last stride, home.

    Attributes
    ----------
    gap : (a,) between which these pairs are, before anything moved, length
    handed : energy set free by the change of pairs
    """

    gap: Array
    handed: float = 0.0

    def repeated(self, before: PathCycle, others: int) -> Self:
        """As of `PathCycle`, with what handing over sets free in all of them."""
        assert isinstance(before, StrideCycle)
        return replace(super().repeated(before, others), handed=self.handed + others * (self.handed - before.handed))


@dataclass(frozen=True, kw_only=True, eq=False)
class StridesCycle(FollowedCycle):
    """A cycle with the strides that it went through, and what each has left behind."""

    strides: tuple[tuple[Track, Gone], ...]


class SlidingCycles:
    """The strides of the cycles of a step.

    Parameters
    ----------
    prepared : with the pairs before anything moved
    strides : of the last cycle that was followed, at last home, in which its sides lost what it had rubbed off
    recorded : number of cycles that were behind then
    followed : number of cycles that were followed so far on the condensed interface

    Attributes
    ----------
    recur : whether cycles can go through these strides again
    stops : how increments are chosen in space; None: event by event
    """

    def __init__(self, prepared: Prepared, strides: list[Stride], recorded: int, followed: int) -> None:
        self.stops: PathSettings | None = None
        if prepared.interface.directions == 3:
            self.stops = replace(stops_at(1, prepared.settings), shortest=_SHORTEST_INCREMENT)
        self.recorded, self.followed = recorded, followed
        self._lost = False  # whether the last cycle drifted too far
        self._nominal = prepared
        tracks = [Track.of(stride) for stride in strides]
        self._home = tracks[-1]
        pairs = zip([self._home, *tracks[:-1]], tracks, strict=True)
        links = [Link.between(last, track) for last, track in pairs]
        self._links = [link for link in links if link is not None]
        self.recur = len(self._links) == len(links) and all(_plain(track) for track in tracks)
        self._limit = stride_of(prepared)
        self.prepared = self._home.prepared
        self.sides: WornSides = self._home.sides

    @property
    def rate(self) -> Array:
        """(m,) Depth over volume."""
        return self.sides.depth(np.ones(len(self.sides)))

    def rubs(self, cycle: FollowedCycle) -> Array:
        """(m,) Volume that a cycle rubs off at the corners of the sides."""
        return cycle.rubbing.volume

    def volume(self, rubs: Array) -> Array:
        """(m,) The same."""
        return rubs

    def expired(self, behind: int) -> bool:
        """Whether bodies have drifted too far from strides that were recorded before so many cycles were behind."""
        return self._lost and self.recorded < behind

    def begin(self, state: State) -> StrideCycle:
        """A whole state on the path: behind what its sides have lost."""
        home, wear = self._home, wear_of(state)
        gap = home.gaps[1] + home.seen @ wear.beyond
        now = path_state(self.prepared, replace(state, point=_between_worn(home, wear.beyond)))
        return StrideCycle(now=now, wear=wear, gap=gap)

    def cycle(self, at: PathCycle, number: int) -> FollowedCycle | None:  # noqa: ARG002
        """A cycle; None where no path leads through it, or bodies have drifted too far."""
        assert isinstance(at, StrideCycle)
        n, active = len(self.prepared.interface), self.prepared.paths.active
        pairs, total, volume = self._home.pairs(at.now, at.gap, 1), None, np.zeros(len(self.sides))
        self.followed, self._lost, strides = self.followed + 1, False, list[tuple[Track, Gone]]()
        for link in self._links:
            gone = self._stride(link, pairs, at.wear.beyond)
            home = link.next is self._home
            self._lost = gone is not None and not home and self._drifted(link.next, gone.pairs)
            if gone is None or self._lost:
                return None
            pairs = gone.pairs
            strides.append((link.next, gone))
            volume += link.next.wears @ gone.rubs
            total = gone if total is None else total.and_then(gone)
        assert total is not None
        whole = [np.zeros(n) for _ in range(3)]
        for of_all, own in zip(whole, (total.distance, total.rubs, total.travel), strict=True):
            of_all[active] = own
        area = self.prepared.interface.area
        rubbing = Rubbing(distance=whole[0], wearing=whole[1] / area, travel=whole[2], volume=volume)
        now = self._home.state(pairs, total.gap, 1)
        reached = replace(
            at,
            now=now,
            gap=total.gap,
            wear=rubbed(at.wear, rubbing),
            spent=at.spent + total.spent,
            handed=at.handed + total.freed,
            pivots=at.pivots + total.pivots,
            residual=max(at.residual, total.residual),
        )
        return StridesCycle(before=at, after=reached, rubbing=rubbing, turns=(at.now, now), strides=tuple(strides))

    def worn(self, at: PathCycle, wear: WearState) -> StrideCycle | None:
        """Sides that lose material at the loads of the moment, to a state of wear; None where no path leads there."""
        assert isinstance(at, StrideCycle)
        home = self._home
        gap = home.gaps[1] + home.seen @ wear.beyond
        segment = self.prepared.paths.follow(
            at.now, home.loads[1] + self._of_gaps(home, gap), self.stops, lambda _: None
        )
        if not segment.followed:
            return None
        rubbing = rubbing_of_segment(self.sides, self.prepared.interface, self.prepared.paths, segment)
        forces = np.array([piece.r[0] for piece in segment.pieces]) * self.prepared.paths.condensed.root
        parts = np.diff([piece.factor for piece in segment.pieces])
        freed = float(parts @ (0.5 * (forces[1:] + forces[:-1]) @ (gap - at.gap)))
        return replace(
            at,
            now=segment.end,
            gap=gap,
            wear=rubbed(wear, rubbing),
            energy=at.energy + freed,
            spent=at.spent + _spent(segment),
            pivots=at.pivots + segment.pivots,
            residual=max(at.residual, segment.residual),
        )

    def state(self, last: State, at: PathCycle, point: LoadPoint) -> State:
        """The whole state, bodies recovered.

        Parameters
        ----------
        last : the last one that was whole
        at : where the step stands, behind what its sides have lost
        point : of the loads there, as pairs see gaps before anything moved
        """
        assert isinstance(at, StrideCycle)
        here = recovered(self.prepared, last, _between_worn(self._home, at.wear.beyond), at.now)
        here = replace(here, released=last.released + at.energy + at.handed)
        here = balanced(self.prepared, last, here, at.spent)
        energy = wear_of(last).energy + at.energy
        return replace(here, point=point, wear=replace(at.wear, energy=energy))

    def _of_gaps(self, track: Track, gap: Array) -> Array:
        return track.prepared.paths.condensed.of_gaps(gap)

    def _drifted(self, track: Track, pairs: StridePairs) -> bool:
        touch = pairs.status != OPEN
        off = np.linalg.norm(pairs.tangential - track.tangential, axis=0)
        return bool(off[touch].max(initial=0.0) > _DRIFT * self._limit)

    def _stride(self, link: Link, pairs: StridePairs, depth: Array) -> Gone | None:
        """To the end of a stride; None where no path leads there."""
        return slide(link, pairs, depth, self._limit) or self._followed(link, pairs, depth)

    def _followed(self, link: Link, pairs: StridePairs, depth: Array) -> Gone | None:
        """The exact path of the law through a stride."""
        track = link.next
        paths, own = track.prepared.paths, track.prepared.paths.active
        begin, first, fading = link.begun(pairs)
        end: Array = track.gaps[1] + track.seen @ depth
        segment = paths.follow(
            track.state(begin, first, 0, fading), track.loads[1] + self._of_gaps(track, end), self.stops, lambda _: None
        )
        if not segment.followed:
            return None
        rubbing = rubbing_of_segment(track.sides, track.prepared.interface, paths, segment)
        forces = np.array([piece.r[0] for piece in segment.pieces]) * paths.condensed.root
        parts = np.diff([piece.factor for piece in segment.pieces])
        behind = track.pairs(segment.end, end, 1)
        return Gone(
            pairs=behind,
            gap=end,
            rubs=(rubbing.wearing * track.prepared.interface.area)[own],
            distance=rubbing.distance[own],
            travel=rubbing.travel[own],
            spent=_spent(segment),
            freed=link.freed(pairs, behind, end - first, parts @ (0.5 * (forces[1:] + forces[:-1]))),
            pivots=segment.pivots,
            residual=segment.residual,
        )


def _between_worn(track: Track, depth: Array) -> LoadPoint:
    """Of the loads at the end of a stride, as its pairs see gaps of sides that are worn."""
    point = track.points[1]
    return replace(point, gap=point.gap + track.sides.gap @ depth)


def _spent(segment: Segment) -> float:
    h, r = (np.array([getattr(piece, name) for piece in segment.pieces]) for name in ("h", "r"))
    return float(-0.5 * ((r[1:] + r[:-1]) * np.diff(h, axis=0)).sum())


def _plain(track: Track) -> bool:
    """Whether its pairs obey Coulomb's law alone; in space, where symmetry guides some, increments know these."""
    law = track.prepared.paths.law
    free = law.directions == 3 or not law.guided
    return law.straight and law.pieces.branches == 1 and not law.pieces.starts.any() and free
