# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that touch without a force where a history begins: the smallest change of their gaps has two sides there.

Where they overlap a little they press at once; where they are a little apart they close one after another, under loads
that grow with the change. Either way they stick at other tangential motions, in proportion to the change, and from then
on that is all that is left of it, next to what the same pieces make of the gaps. The law is linear in its pieces, so
that a path with gaps that are changed by a small part tells those motions to rounding, on the bodies as they are.

On smooth cones pairs that are a little apart close in the first increment, which is as short as may be then, and only
those that press at once have moved before it. The history as it is goes on straight there, and may end a piece, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain, dropwhile, islice
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, extent
from signorini.derivative.body_changes import BodyChange
from signorini.derivative.changes import GapChange
from signorini.derivative.moduli import ModulusChange
from signorini.derivative.points import ZERO, TapePoint
from signorini.derivative.quiet_ends import QuietEnd
from signorini.derivative.recursion import Change
from signorini.derivative.space_conditions import states_between
from signorini.derivative.validity import PathEdge
from signorini.derivative.view import HistoryView
from signorini.engine.automatic import MORE_IN_SPACE
from signorini.engine.floating_bodies import approached, resting
from signorini.engine.path_states import path_state
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import Interval, StepPart
from signorini.engine.tape import Leg
from signorini.errors import InputError, SolveFailed
from signorini.friction.history import PathState, Segment
from signorini.friction.history.space.lengths import early

_PARTS = (1e-2, 1e-3, 1e-4)  # of how far half a piece goes: larger than what a path takes two events together in
_UNTIL = 0.5  # of the first piece: where motions are compared
_SAME_MOTION = 1e-6  # of the largest, or of the change: motions that are in proportion to it
_SAME_SIDES = 1e-6  # of motions as long as changes of gaps: what may be left of both ways together
_STRAIGHT = 1e-9  # of what moves or presses most in the first piece: what lies on a straight way
_SAME_PLACE = 1e-14  # of the size of the model: what gaps differ by between places that are the same


@dataclass(frozen=True, kw_only=True, eq=False)
class GapRate:
    """What a parameter changes of the gaps that pairs have before anything moves.

    Attributes
    ----------
    gap : (n,) length per unit; None where nothing changes
    rounding : length per unit that is as good as nothing
    B : what it changes of that of `Interface`, per unit; None where that is nothing
    """

    gap: Array | None = None
    rounding: float = 0.0
    B: sp.csr_array | None = None

    @classmethod
    def of(cls, change: Change) -> GapRate:
        """Of a change."""
        if isinstance(change, GapChange):
            return cls(gap=change.gap)
        if isinstance(change, BodyChange | ModulusChange) and change.tilts and change.pairs is not None:
            size = float(extent(change.prepared.model.mesh.points).max())
            return cls(gap=change.pairs.gap, rounding=_SAME_PLACE * size / change.step, B=change.pairs.B)
        return cls()

    @classmethod
    def sum(cls, parts: Sequence[tuple[float, GapRate]]) -> GapRate:
        """Of several, each with its weight."""
        known = [(weight, part, part.gap) for weight, part in parts if part.gap is not None]
        if not known:
            return cls()
        tilts = [weight * part.B for weight, part, _ in known if part.B is not None]
        return cls(
            gap=np.sum([weight * gap for weight, _, gap in known], axis=0),
            rounding=sum(abs(weight) * part.rounding for weight, part, _ in known),
            B=sp.csr_array(sum(tilts[1:], tilts[0])) if tilts else None,
        )

    def times(self, factor: float) -> GapRate:
        """Of a parameter that is counted in other units."""
        return GapRate.sum([(factor, self)])


@dataclass(frozen=True, kw_only=True, eq=False)
class TouchingStart:
    """Where a history begins.

    Attributes
    ----------
    legs, points : straight parts of the history, and its points
    """

    legs: Sequence[Leg]
    points: Sequence[TapePoint]
    _known: dict[bytes, Array] = field(default_factory=dict, init=False)

    @property
    def ahead(self) -> TapePoint | None:
        """Where the history begins and nothing moves or presses yet; None where that is one of its points."""
        return None if self.points[0].on_linear_path else self._at_rest

    @property
    def _at_rest(self) -> TapePoint:
        return self._on_first_piece(0.0, at_rest=True)

    @property
    def history(self) -> list[TapePoint]:
        """The points of the history, with those in its first piece that gaps make that are other ones."""
        return [*self._beginning, *self.points[1:]] if self._beginning else list(self.points)

    @cached_property
    def _beginning(self) -> list[TapePoint]:
        """The first piece, cut in two; empty where it is none that is cut."""
        first, leg = self.points[0], self.legs[0]
        if not self.pairs.any() or leg.start is None or leg.segment is None or leg.start.r.any():
            return []
        if first.on_linear_path:
            return [self._at_rest, first]
        # with other gaps the law does not hold all along one increment any more
        shortest = min(leg.segment.shortest, 1.0 / MORE_IN_SPACE)
        part = early(shortest, 0.0) / leg.segment.pieces[-1].factor
        if not (first.ends_at_events and self._straight and 0.0 < part < first.part):
            return []
        cut = self._on_first_piece(part, quiet=QuietEnd(leads=(0.0, 0.0), trials=()), passes=True, increment=False)
        state = leg.segment.pieces[1].state
        assert state is not None
        rest = states_between(first.system, state.state, (cut.h, cut.r), (first.h, first.r))
        return [cut, replace(first, states=rest)]

    def _on_first_piece(self, part: float, **parts: Any) -> TapePoint:
        """A point in the middle of the first piece, a part of the leg behind its beginning.

        On a path that is linear, that is the beginning itself, with pairs in the states of the piece while nothing
        moves or presses yet: what those that slip from there on have moved by then changes with gaps, and friction
        takes no work from that.
        """
        first, leg = self.points[0], self.legs[0]
        assert leg.start is not None
        share = part / first.part if part else 0.0
        point = replace(
            first,
            load=first.system.posed(leg.before.point.towards(leg.end, part) if part else leg.before.point),
            load_factor=leg.low + part * (leg.high - leg.low),
            part=part,
            h=leg.start.h + share * (first.h - leg.start.h),
            r=share * first.r,
            acting=np.zeros(0, dtype=np.int64),
            acts=None,
            quiet=None,
            trials=(),
        )
        return replace(point, **parts) if part else replace(point, h_rate=None, r_rate=None, load_rate=None, **parts)

    @property
    def _straight(self) -> bool:
        """Whether motions and forces of the first piece are in proportion to the part of the leg."""
        first, leg = self.points[0], self.legs[0]
        assert leg.start is not None
        assert first.rates is not None
        moved = first.h - leg.start.h, first.r
        return all(
            np.abs(all_of_it - first.part * rate).max() <= _STRAIGHT * max(np.abs(part).max() for part in moved)
            for all_of_it, rate in zip(moved, first.rates, strict=True)
        )

    @cached_property
    def pairs(self) -> BoolArray:
        """(n,) Those that touch without a force before anything is loaded, in a history that is followed to events."""
        leg, system = self.legs[0], self.points[0].system
        found = np.zeros(len(system.condensed.active), dtype=np.bool_)
        if leg.start is not None and not leg.before.nodal[0].any() and not leg.before.forces.any():
            none = ZERO * (system.law.scale or 1.0)
            found[system.active] = (np.abs(leg.start.h[0]) <= none) & (np.abs(leg.start.r).max(axis=0) <= none)
        return found & system.prepared.interface.friction.rubs

    def moved(self, rate: GapRate) -> BoolArray:
        """(n,) Which of the pairs a change of gaps moves."""
        if rate.gap is None:
            return np.zeros(0, dtype=np.bool_)
        return np.asarray(self.pairs & (np.abs(rate.gap) > rate.rounding), dtype=np.bool_)

    def edges(self, view: HistoryView, rate: GapRate) -> list[PathEdge]:
        """The pairs that a change of gaps opens on one side, that which it moves most first."""
        found = np.flatnonzero(self.moved(rate))
        if rate.gap is None or not len(found):
            return []
        order = np.argsort(-np.abs(rate.gap[found]), kind="stable")
        edges = []
        for pair in found[order]:
            node, contact = view.model.mesh.labels[view.interface.node[pair]], view.interface.contact[pair]
            words = f"node {node} of '{view.model.contacts[contact].label}' touches without a force where the history"
            edges.append(
                PathEdge(point=-1, condition=int(pair), change=-float(rate.gap[pair]), words=f"{words} begins")
            )
        return edges

    def refuse_by_nodes(self, view: HistoryView, remembered: Array, what: str) -> None:
        """Refuse derivatives node by node of which pairs that touch make two sides.

        Parameters
        ----------
        view : the history
        remembered : (d - 1, n) how the output changes with tangential motions before it
        what : is asked for

        Raises
        ------
        InputError
            Where random changes of gaps do something else than their opposites do.
        """
        if not (remembered.any() and self.pairs.any()):
            return
        if abs(float(np.vdot(remembered, self._apart))) > _SAME_SIDES * float(np.abs(remembered).sum()):
            words = self.edges(view, GapRate(gap=np.where(self.pairs, 1.0, 0.0)))[0].words
            words += ": derivatives node by node have two sides; shape_sides(motion) and sides(parameter)"
            raise InputError(f"{words} give both, of what is varied together", where=(what,))

    @cached_property
    def _apart(self) -> Array:
        """(d - 1, n) What random changes of gaps, as long as 1, and their opposites leave of motions together."""
        gap = np.where(self.pairs, np.random.default_rng(0).uniform(-1.0, 1.0, len(self.pairs)), 0.0)
        return np.subtract(*(self.changes(GapRate(gap=gap), way)[0] for way in (1.0, -1.0)))

    def changes(self, gap: GapRate, way: float) -> Array:
        """(2, d - 1, n) What a change of gaps makes of motions and friction before the first point, to one side.

        Of tangential motions where pairs stick, length per unit; on smooth cones of friction of pairs that press at
        once, force per unit.

        Parameters
        ----------
        gap : the change
        way : 1 upwards, -1 downwards

        Raises
        ------
        InputError
            Where the path with other gaps is not known.
        """
        if not self.moved(gap).any():
            return np.zeros((2, self.points[0].system.directions - 1, len(self.pairs)))
        return way * self._changes(gap.times(way))

    def _changes(self, rate: GapRate) -> Array:
        """See `changes`, upwards."""
        assert rate.gap is not None
        gap = np.where(self.moved(rate), rate.gap, 0.0)  # what pairs that are apart do has events of its own
        size = float(np.abs(gap).max())
        alike = GapRate(gap=gap / size, B=None if rate.B is None else rate.B / size)
        if alike.B is not None:
            return size * self._of_largest(alike)
        key = (gap / size).tobytes()
        if key not in self._known:
            self._known[key] = self._of_largest(alike)
        return size * self._known[key]

    def _of_largest(self, rate: GapRate) -> Array:
        """See `_changes`, of a change of gaps whose largest is 1."""
        assert rate.gap is not None
        first, leg = self.points[0], self.legs[0]
        system = first.system
        assert leg.start is not None
        assert leg.segment is not None
        known = first.on_linear_path and not first.quiet
        if (known or self._beginning or first.passes) and not leg.start.r.any():
            way = _UNTIL * first.part * (leg.segment.end.b - leg.start.b)
            size = float(np.abs(way).max()) / float(np.abs(system.root * rate.gap[system.active]).max())
            found = (self._per_share(part * size, rate, way) for part in _PARTS)
            large, small = islice(chain(dropwhile(lambda moved: moved is None, found), (None, None)), 2)
            # where a body is carried by a length, however small the change, motions are in no proportion to it
            if large is not None and small is not None and _in_proportion(large[0], small[0]):
                return large
        raise InputError(
            "pairs touch without a force where the history begins: what the history does is not known where their gaps "
            "are other ones"
        )

    def _per_share(self, share: float, rate: GapRate, way: Array) -> Array | None:
        """(2, d - 1, n) The same from a share of a change; None where it is not known.

        On paths that are linear, where pairs have come to the states of the first piece; on smooth cones at once.

        Parameters
        ----------
        share, rate : of the change, and the change
        way : (d a,) what the load grows by until motions are compared, scaled
        """
        first, system, begun = self.points[0], self.points[0].system, self._begun(share, rate)
        start, found = self.legs[0].start, np.zeros((2, system.directions - 1, len(system.condensed.active)))
        if begun is None or start is None:
            return None
        if not first.on_linear_path:
            found[0][:, system.active] = (begun[1].h - start.h)[1:] / (share * system.root)
            found[1][:, system.active] = begun[1].r[1:] * system.root / share
            return found
        segment = self._followed(*begun, way)
        if segment is None or not self._same(segment, first):
            return None
        h = start.h + _UNTIL * (first.h - start.h)
        found[0][:, system.active] = (segment.end.h - h)[1:] / (share * system.root)
        return found

    def _followed(self, prepared: Prepared, start: PathState, way: Array) -> Segment | None:
        """The path from a start, (d a,) a way on; None where there is none."""
        try:
            found = prepared.paths.follow(start, start.b + way, None, lambda _: None)
        except (SolveFailed, InputError):
            return None
        return found if found.followed else None

    def _begun(self, share: float, rate: GapRate) -> tuple[Prepared, PathState] | None:
        """The model with a share of a change, and its state before anything is loaded; None where that is not known.

        Bodies that nothing holds are carried first.
        """
        leg, prepared, gap = self.legs[0], self.legs[0].prepared, share * np.asarray(rate.gap)
        before = replace(
            leg.before, gap=leg.before.gap + gap, point=replace(leg.before.point, gap=leg.before.point.gap + gap)
        )
        interface = prepared.interface
        if rate.B is not None and prepared.floating.shape[1]:
            interface = replace(interface, B=sp.csr_array(interface.B + share * rate.B))
        part = StepPart(
            prepared=replace(prepared, interface=interface),
            where=leg.where,
            interval=Interval(number=1, low=0.0, high=1.0, ends="segment"),
            before=before,
            end=replace(leg.end, gap=leg.end.gap + gap),
        )
        try:
            if resting(part) is not part:
                return None
            carried = approached(part, relieving=True)
            return prepared, path_state(prepared, before if carried is None else carried.after)
        except (SolveFailed, InputError):
            return None

    def _same(self, segment: Segment, first: TapePoint) -> bool:
        """Whether pairs end in the states of the first piece."""
        system, (before, last) = first.system, segment.pieces[-2:]
        assert last.state is not None
        return states_between(system, last.state.state, (before.h, before.r), (last.h, last.r)).same(first.states)


def _in_proportion(one: Array, two: Array) -> bool:
    """Whether motions per share of a change of gaps, whose largest is 1, are the same."""
    return float(np.abs(one - two).max()) <= _SAME_MOTION * max(1.0, float(np.abs(one).max()))
