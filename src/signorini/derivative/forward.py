# SPDX-License-Identifier: BSD-3-Clause
"""What a parameter changes of the points of a history, forwards from one to the next; see `recursion`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.adjoint_terms import BoundTerm
from signorini.derivative.conditions import PieceEvent
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint, with_trials
from signorini.derivative.quiet_ends import QuietMove
from signorini.derivative.recursion import AtOnce


@dataclass(frozen=True, kw_only=True, eq=False)
class PointChange:
    """What a parameter changes at a point, per unit of it.

    Attributes
    ----------
    h, r : (d, n) of motions and forces of all pairs, length and force, where the point is
    part : of the part of the leg that is behind
    bound : of the friction of the active pairs; None where that stays
    turned : (n,) of the angles by which friction of the active pairs turns in each trial that tells where it is
    """

    h: Array
    r: Array
    part: float
    bound: BoundTerm | None
    turned: tuple[Array, ...] = ()


def forward(points: Sequence[TapePoint], change: AtOnce, remembered: Array) -> list[PointChange]:
    """What a parameter changes at every point.

    Parameters
    ----------
    points : of the history
    change : what the parameter changes at once
    remembered : (d - 1, n) what it changes of tangential motions before the first point, length
    """
    walk = ForwardWalk(points, change, remembered)
    for _ in points:
        walk.go_on()
    return walk.found


class ForwardWalk:
    """The way forwards, point by point; parameters as of `forward`.

    Attributes
    ----------
    points : of the history
    found : what is changed at those behind
    """

    def __init__(self, points: Sequence[TapePoint], change: AtOnce, remembered: Array) -> None:
        self.points, self.found = list(points), list[PointChange]()
        self._change, self._remembered = change, remembered
        self._bounds: dict[InterfaceSystem, BoundTerm | None] = {}
        every = with_trials(points)
        self._at_once = dict(zip(every, _seen(every, change.moved(every)), strict=False))

    @property
    def ahead(self) -> bool:
        """Whether there is a point ahead."""
        return len(self.found) < len(self.points)

    @property
    def next(self) -> TapePoint:
        """The next point."""
        return self.points[len(self.found)]

    def put(self, points: Sequence[TapePoint], like: TapePoint) -> None:
        """Put other points in place of the next one, of which new ones are at the place and the load of one like it."""
        i = len(self.found)
        self.points[i : i + 1] = points
        if like in self._at_once:
            self._at_once |= {point: self._at_once[like] for point in points if point not in self._at_once}

    def go_on(self) -> None:
        """To the next point."""
        i, points = len(self.found), self.points
        point = points[i]
        with point.determined():
            point.system.ahead((points[j].system, points[j].states) for j in range(i, len(points)))
            (h, r), bound, part, turned = self._at_load(point), self._bound(point.system), 0.0, tuple[Array, ...]()
            if point.at_event:
                event = point.event
                part = -(event.change(h, r) + (0.0 if bound is None else _of_bound(event, bound))) / event.rate
            elif point.quiet is not None and i:
                move = self.quiet_move()
                part, turned = move.part, move.turned
            if part:
                assert point.rates is not None
                h, r = (at_load + part * rate for at_load, rate in zip((h, r), point.rates, strict=True))
        self.found.append(_of_all(point.system, h, r, part, bound, turned))

    def at_load(self, point: TapePoint) -> PointChange:
        """What is changed at the load of the next point, in the states of one at the same place."""
        with point.determined():
            return _of_all(point.system, *self._at_load(point), 0.0, self._bound(point.system))

    def quiet_move(self, way: float | None = None) -> QuietMove:
        """How the next point moves, an end in space at which nothing happens; ``way`` as of `QuietEnd.move`."""
        i, point = len(self.found), self.next
        assert point.quiet is not None
        one, two = (self.found[k].part if k >= 0 and self.points[k].leg == point.leg else 0.0 for k in (i - 1, i - 2))
        tried = [self._at_load(trial)[1] for trial in point.trials]
        return point.quiet.move(one, two, self.found[-1].r[1:, point.system.active] / point.system.root, tried, way)

    def _bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What is changed of the friction, kept."""
        if system not in self._bounds:
            self._bounds[system] = self._change.bound(system)
        return self._bounds[system]

    def _at_load(self, point: TapePoint) -> tuple[Array, Array]:
        """What is changed of motions and forces, (d, n), scaled, at the load of a point, or of a trial for it."""
        system, states, bound = point.system, point.states, self._bound(point.system)
        memory = self.found[-1].h[1:] if self.found else self._remembered
        load = self._at_once.get(point, self._at_once.get(self.next))
        held, given = np.zeros((2, system.directions, system.pairs))
        remembered = states.held if states.codes is not None else True
        held[1:] = np.where(remembered, system.root * memory[:, system.active], 0.0)
        if bound is not None:
            given[1:] = states.unit * _on_branches(bound, states.branch, np.maximum(point.r[0], 0.0))
        imposed = system.imposed(held, given)
        h, r = system.respond(states, imposed if load is None else imposed + load)
        return h + held, r + given


def _of_all(
    system: InterfaceSystem,
    h: Array,
    r: Array,
    part: float,
    bound: BoundTerm | None,
    turned: tuple[Array, ...] = (),
) -> PointChange:
    """Of motions and forces of all pairs, from those (d, n) of the active ones, scaled."""
    whole = np.zeros((2, system.directions, len(system.condensed.active)))
    whole[0][:, system.active], whole[1][:, system.active] = h / system.root, r * system.root
    return PointChange(h=whole[0], r=whole[1], part=part, bound=bound, turned=turned)


def _seen(points: Sequence[TapePoint], moved: Sequence[tuple[Array, Array]]) -> list[Array]:
    """(d n + k,) Of every point, what its equations see of motions of the pairs and resultants; empty for none."""
    found: dict[int, Array] = {}
    for system in dict.fromkeys(point.system for point in points) if moved else ():
        own = [i for i, point in enumerate(points) if point.system is system]
        free = system.condensed.free(*(np.stack([moved[i][k] for i in own]) for k in range(2)))
        found.update(zip(own, free, strict=True))
    return [found[i] for i in range(len(found))]


def _on_branches(bound: BoundTerm, branch: IntArray, p: Array) -> Array:
    """(n,) What a change of the bound changes of it on its branches under normal forces p."""
    pairs = np.arange(len(p))
    return np.asarray(bound.starts[branch, pairs] + bound.slopes[branch, pairs] * p)


def change_of_conditions(point: TapePoint, change: PointChange) -> Array:
    """(m,) What a parameter changes of the conditions of a piece at its end, scaled."""
    known, system = point.conditions, point.system
    found = known.change(system.root * change.h[:, system.active], change.r[:, system.active] / system.root)
    if change.bound is not None:
        at = known.branch, known.pair
        found += known.start * change.bound.starts[at] + known.slope * change.bound.slopes[at]
        found += known.kink * change.bound.kinks[at]
    return found


def _of_bound(event: PieceEvent, bound: BoundTerm) -> float:
    """What a change of the friction changes of the condition of an event."""
    at = event.branch, event.pair
    return float(event.start * bound.starts[at] + event.slope * bound.slopes[at] + event.kink * bound.kinks[at])
