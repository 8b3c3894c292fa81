# SPDX-License-Identifier: BSD-3-Clause
"""A history with what its derivatives go through: what changes make of its points, and where they have two sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from signorini.arrays import Array
from signorini.derivative.adjoint import adjoint_of
from signorini.derivative.body_changes import BodyChange
from signorini.derivative.changes import ChangeWithLocks, GapChange, LoadChange, LockChange
from signorini.derivative.direct_changes import pulled_by, read_otherwise
from signorini.derivative.edge_probe import EdgeProbe
from signorini.derivative.event_order import EventOrder
from signorini.derivative.forward import ForwardWalk, PointChange, forward
from signorini.derivative.functionals import value, weights_at_start
from signorini.derivative.moduli import ModulusChange
from signorini.derivative.modulus_pairs import ModulusPairs
from signorini.derivative.parameters import change_of
from signorini.derivative.points import TapePoint
from signorini.derivative.recursion import AtOnce, Change, changed
from signorini.derivative.refusals import has_sides_by_nodes, refuse_tape
from signorini.derivative.shared_events import SharedEvents
from signorini.derivative.tape_points import tape_points
from signorini.derivative.tied_peaks import TiedPeak, at_peaks, tied_peaks
from signorini.derivative.touching_start import GapRate, TouchingStart
from signorini.derivative.validity import PathEdge, edges, least_apart, validity
from signorini.derivative.view import HistoryView
from signorini.engine.prepare import Prepared
from signorini.engine.tape import Tape
from signorini.errors import InputError
from signorini.model.model import Model
from signorini.model.outputs import Displacement, Output
from signorini.solution.sensitivities import Validity

_TWO_SIDES = 1e-6  # of a derivative: what those to both sides may differ by and still be the same up to differences
_NO_CHANGE = 1e-10  # of an output over what is given: a derivative that is as good as none
_MOST_TIED = 20  # nodes whose pressures are followed one by one


class TapedHistory:
    """A history with all that its derivatives go through.

    Parameters
    ----------
    tape : of the history
    model : that was solved

    Raises
    ------
    InputError
        Where the history goes through what derivatives do not know, by name.
    """

    def __init__(self, tape: Tape, model: Model) -> None:
        refuse_tape(tape, model)
        points, self.legs = tape_points(tape), tape.legs
        self.start = TouchingStart(legs=self.legs, points=points)
        self.view = HistoryView.of(self.start.history)
        self.probe = EdgeProbe(self.view.points)
        self._changes: dict[tuple[str, str], Change] = {}
        self._forward: dict[tuple[Change, float], list[PointChange]] = {}
        self._edges: dict[Change, list[PathEdge]] = {}
        self._ordered: dict[tuple[Change, float, int], Sequence[TapePoint]] = {}
        self._locked: dict[str, DirectionalDerivative] = {}
        self._seen = ModulusPairs(self.prepared)

    @property
    def prepared(self) -> Prepared:
        """The model, as it is at the end."""
        return self.legs[-1].prepared

    def locks(self) -> Iterator[tuple[LockChange, DirectionalDerivative]]:
        """The shortening of every bolt that locks, and its derivative at the end of the history before, kept."""
        points = self.view.points
        for name, dof in points[-1].system.locked.items():
            if name not in self._locked:
                before = [point for point in points if name not in point.system.locked]
                node, axis = divmod(dof, self.view.model.components)
                along = tuple(float(k == axis) for k in range(self.view.model.components))
                shortening = Displacement(node=node, along=along)
                self._locked[name] = DirectionalDerivative(self.on(before), shortening)
            yield LockChange(name=name), self._locked[name]

    def on(self, points: Sequence[TapePoint]) -> TapedHistory:
        """The history with other states at some points."""
        other = copy(self)
        other.view, other.probe = replace(self.view, points=points), EdgeProbe(points)
        other._forward, other._edges, other._ordered = {}, {}, {}
        return other

    def change(self, kind: str, name: str) -> Change:
        """What a parameter changes at once, kept."""
        if (kind, name) not in self._changes:
            self._changes[kind, name] = change_of(self.prepared, kind, name, self._seen)
        return self._changes[kind, name]

    def forward(self, change: Change, way: float) -> list[PointChange]:
        """What a change makes of every point, to one side, kept.

        Parameters
        ----------
        change : what is varied
        way : 1 upwards, -1 downwards

        Raises
        ------
        InputError
            Where it moves gaps of pairs that touch as the history begins, and what that does is not known.
        """
        key = change, way if self.start.moved(GapRate.of(change)).any() else 1.0
        if key not in self._forward:
            self._forward[key] = self._along(change, self.start.changes(GapRate.of(change), way)[0])
        return self._forward[key]

    def _upwards(self, change: Change) -> list[PointChange]:
        """What a change makes upwards; without what pairs do that touch as the history begins where it is not known."""
        try:
            return self.forward(change, 1.0)
        except InputError:
            return self._along(change, np.zeros((self.view.interface.directions - 1, len(self.view.interface))))

    def _along(self, change: Change, remembered: Array) -> list[PointChange]:
        """What a change makes of every point, which is ``remembered`` before them, (d - 1, n) length per unit."""
        return forward(self.view.points, self._at_once(change), remembered)

    def _at_once(self, change: Change) -> AtOnce:
        """What a change changes at once, with the shortenings at which bolts lock."""
        shortenings = {lock.name: shortening.along(change) for lock, shortening in self.locks()}
        return ChangeWithLocks(change=change, shortenings=shortenings) if shortenings else change

    def edges(self, change: Change) -> list[PathEdge]:
        """Where a change may have another derivative to each of its sides, kept."""
        if change not in self._edges:
            parted = self.probe and (self.view.points[-1].system.locked or self.probe.takes_apart(change))
            self._edges[change] = edges(self.view, self._upwards(change), _rounding(change)) if parted else []
        return self._edges[change]

    def beside(
        self, change: Change, found: Sequence[PathEdge], last: int, what: str
    ) -> tuple[TapedHistory, TapedHistory]:
        """The history below and above what is varied, up to a point; the same where a change has no edges.

        Parameters
        ----------
        change : what is varied
        found : its edges up to there
        last : number of the point
        what : is varied, in words

        Raises
        ------
        InputError
            Where one of both is not known.
        """
        if not found:
            return self, self
        points = self.view.points[: last + 1]
        unknown = [edge for edge in found if len(points[edge.point].stays)]
        words = f"{[*unknown, *found][0].words}: what {what} does on the other side is not known"
        if unknown or any(points[edge.point].system.locked != points[-1].system.locked for edge in found):  # bolts lock
            raise InputError(words)
        try:
            below, above = (self.on(self._in_order(change, way, points)) for way in (-1.0, 1.0))
        except InputError as error:
            raise InputError(f"{words}; {error}") from error
        return below, above

    def _in_order(self, change: Change, way: float, points: Sequence[TapePoint]) -> Sequence[TapePoint]:
        """Points of the history with those between events that a change takes apart to one side, kept."""
        key = change, way, len(points)
        if key not in self._ordered:
            walk = ForwardWalk(points, self._at_once(change), self.start.changes(GapRate.of(change), way)[0])
            found = self._upwards(change)
            moves, least = max(abs(one.part) for one in found), least_apart(self.view, found, _rounding(change))
            order = EventOrder(walk=walk, legs=self.legs, way=way, moves=moves, rounding=least)
            self._ordered[key] = order.points()
        return self._ordered[key]

    def holds(self, kind: str, name: str) -> Validity:
        """In which changes of a parameter the sequence of events stays."""
        change = self.change(kind, name)
        return validity(self.view, self._upwards(change), self.start.edges(self.view, GapRate.of(change)))


def _rounding(change: Change) -> float:
    """Of the data of the law, per unit of a change: what rounding makes of conditions."""
    return change.rounding if isinstance(change, BodyChange) else 0.0


class DirectionalDerivative:
    """The derivative of an output of a history along changes of what is given, from one way back through its events.

    Parameters
    ----------
    history : the history
    output : what is differentiated

    Attributes
    ----------
    value : of the output
    """

    def __init__(self, history: TapedHistory, output: Output) -> None:
        self._history, self.output, view = history, output, history.view
        self.value, self._read = value(output, view), at_peaks(output, view)
        self._adjoint, self._pulls = adjoint_of(view, self._read)
        self._shared = SharedEvents(view=view, probe=history.probe, output=output, weights=self._adjoint.weights)

    def along(self, change: Change) -> float:
        """What a change changes of the output, also by the shortenings at which bolts lock."""
        return self._along(change) + sum(share * shortening.along(change) for share, shortening in self._locks)

    def one(self, change: Change, size: float, what: str, ask: str) -> float:
        """The derivative along a change.

        Parameters
        ----------
        change : what is varied
        size : of a change that is as large as what is given, in its unit
        what, ask : the derivative in words, and what gives both sides of it

        Raises
        ------
        InputError
            Where it has two sides.
        """
        low, high = self.to_sides(change, size, what)
        if apart(low, high):
            words = f"{what} has two sides there, {low:.6g} and {high:.6g}; {ask} gives both"
            raise InputError(f"{self.why_apart(change)}: {words}")
        return high

    def why_apart(self, change: Change) -> str:
        """Why a change may have another derivative to each of its sides."""
        at_start = self._history.start.edges(self._history.view, GapRate.of(change))
        for edge in [*self.felt(change), *at_start]:
            return edge.words
        return self._ties[0][0].words

    def upwards(self, change: Change) -> float:
        """The derivative along a change to its upper side."""
        return self.along(change) + self.through_start(GapRate.of(change), 1.0)

    def to_sides(self, change: Change, size: float, what: str) -> tuple[float, float]:
        """The derivatives along a change, downwards and upwards; the same but at an event.

        Parameters
        ----------
        change : what is varied
        size : of a change that is as large as what is given, in its unit
        what : is varied, in words

        Raises
        ------
        InputError
            Where one of both is not known.
        """
        gap, own, ends = GapRate.of(change), self.along(change), self.beside(change, what)
        low, high = (
            (own if end is self else end.along(change)) + end.through_start(gap, way)
            for end, way in zip(ends, (-1.0, 1.0), strict=True)
        )
        below, above = self.between_peaks(change, size)
        return low + below, high + above

    def between_peaks(self, change: Change, size: float) -> tuple[float, float]:
        """What other nodes add downwards and upwards that have the largest pressure, too; parameters of `to_sides`.

        Raises
        ------
        InputError
            Where too many nodes do, and not alike.
        """
        low = high = 0.0
        for tied, together in self._ties:
            least = _NO_CHANGE * abs(self.value) / size
            if max(abs(side) for side in together.to_sides(change, size, "that")) <= least:
                continue
            if len(tied.others) > _MOST_TIED:
                raise InputError(f"{tied.words}, and {len(tied.others) - 1} more: the derivative is not known")
            sides = np.array(
                [DirectionalDerivative(self._history, one).to_sides(change, size, "that") for one in tied.others]
            )
            low += tied.factor * min(0.0, float(sides[:, 0].min()))
            high += tied.factor * max(0.0, float(sides[:, 1].max()))
        return low, high

    @cached_property
    def _ties(self) -> list[tuple[TiedPeak, DirectionalDerivative]]:
        """Largest pressures that several nodes have alike, and the derivative of what they differ by, together."""
        found = tied_peaks(self.output, self._history.view)
        return [(tied, DirectionalDerivative(self._history, tied.together)) for tied in found]

    def beside(self, change: Change, what: str) -> tuple[DirectionalDerivative, DirectionalDerivative]:
        """The derivatives of the history below and above a change, in words; errors as of `to_sides`."""
        low, high = self._history.beside(change, self.felt(change), self._shared.last, what)
        at_end = replace(self.output, load_factor=None)
        below, above = (self if one is self._history else DirectionalDerivative(one, at_end) for one in (low, high))
        return below, above

    def through_start(self, gap: GapRate, way: float) -> float:
        """What changes of gaps do besides where pairs touch without a force as the history begins, to one side.

        Parameters
        ----------
        gap : the change, per unit
        way : 1 upwards, -1 downwards

        Raises
        ------
        InputError
            Where that is not known.
        """
        found = sum(share * shortening.through_start(gap, way) for share, shortening in self._locks)
        history, weights = self._history, np.zeros((2, *self._adjoint.remembered.shape))
        if history.start.moved(gap).any():
            weights = weights_at_start(self.output, history.view, history.start.ahead)
            weights[0] += self._adjoint.remembered
        return found + (float(np.vdot(weights, history.start.changes(gap, way))) if weights.any() else 0.0)

    def by_gaps(self) -> Array:
        """(n,) The derivative by the gap of every pair, per length.

        Raises
        ------
        InputError
            Where that has two sides.
        """
        self.refuse_by_nodes("gap")
        return self._by_gaps()

    def _by_gaps(self) -> Array:
        """The derivative by the gap of every pair, that to one side where it has two."""
        return sum((share * shortening._by_gaps() for share, shortening in self._locks), self._adjoint.by_gaps)

    def refuse_by_nodes(self, what: str) -> None:
        """Refuse derivatives node by node where gaps of single nodes take apart what pairs do together.

        Parameters
        ----------
        what : is asked for

        Raises
        ------
        InputError
            Where the output feels that.
        """
        history = self._history
        history.start.refuse_by_nodes(history.view, self._adjoint.remembered, what)
        for _, shortening in self._locks:
            shortening.refuse_by_nodes(what)
        if why := self._shared.why_parted() or self._why_turned_apart():
            raise has_sides_by_nodes(f"{why}: derivatives node by node may have two sides there", what)
        for tied, together in self._ties:
            if np.abs(together._by_gaps()).max() > _TWO_SIDES * np.abs(self._by_gaps()).max():
                raise has_sides_by_nodes(f"{tied.words}: derivatives node by node have two sides", what)

    def _why_turned_apart(self) -> str:
        """Which pairs turn alike that random gaps take apart, so that the output feels it; empty where none do."""
        unsure, points = self._history.probe.unsure, self._history.view.points
        if not any(i <= self._shared.last for i in unsure):
            return ""
        change = GapChange(gap=np.random.default_rng(0).uniform(-1.0, 1.0, len(points[-1].system.condensed.active)))
        found = [edge for edge in self.felt(change) if edge.point in unsure]
        if not found:
            return ""
        low, high = self.beside(change, "the gap of single nodes")
        return found[0].words if apart(low.along(change), high.along(change)) else ""

    def felt(self, change: Change) -> list[PathEdge]:
        """The edges of a change that the output feels, also by the shortenings at which bolts lock."""
        own = [edge for edge in self._history.edges(change) if self._shared.felt(edge.point)]
        return own + [edge for _, shortening in self._locks for edge in shortening.felt(change)]

    @cached_property
    def _locks(self) -> list[tuple[float, DirectionalDerivative]]:
        """How the output changes with the shortening at which a bolt locks, and the derivative of that."""
        found = ((self._along(lock), shortening) for lock, shortening in self._history.locks())
        return [(share, shortening) for share, shortening in found if share]

    def _along(self, change: Change) -> float:
        """What a change changes of the output while bolts that have locked are as long as they are."""
        view = self._history.view
        found = changed(view.every, self._adjoint, change)
        if isinstance(change, BodyChange | ModulusChange):
            found += read_otherwise(self._read, view, change)
        if isinstance(change, LoadChange):
            found += pulled_by(view, change, self._adjoint.pulled, self._pulls)
        return found


def apart(low: float, high: float) -> bool:
    """Whether derivatives to both sides are not the same up to differences."""
    return abs(high - low) > _TWO_SIDES * (abs(high) + abs(low))
