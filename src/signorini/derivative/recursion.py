# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives along a history, forwards for one parameter or backwards for one output.

At a point a change of what is given changes motions and forces at a fixed load by x', from the equations of the piece;
where an event of the condition g ends it, its load by ``l' = -g' / (dg/dl)``, and so x by ``x' + (dx/dl) l'`` in all.
What pairs remember of it is their tangential motion h_t, which those hold that stick in the next piece. Everything else
that an event does comes by itself. Backwards the same in transposed steps: points that nothing asks of cost nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Protocol

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.conditions import PieceEvent
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint
from signorini.law.bound import FrictionBound


@dataclass(kw_only=True, eq=False)
class BoundTerm:
    """Numbers for the friction bound of the active pairs of one system, scaled, (branches, a) each.

    What a parameter changes of them, or how an output changes with them.

    Attributes
    ----------
    slopes, starts, kinks : of the branches, and of where they begin
    """

    slopes: Array
    starts: Array
    kinks: Array

    @classmethod
    def of(cls, bound: FrictionBound) -> BoundTerm:
        """Zero, for a bound."""
        return cls(**{name: np.zeros_like(bound.slopes) for name in ("slopes", "starts", "kinks")})

    def along(self, change: BoundTerm) -> float:
        """What a change of the bound changes of the output whose term this is."""
        return sum(float(np.vdot(getattr(self, name), getattr(change, name))) for name in ("slopes", "starts", "kinks"))


class Change(Protocol):
    """What a parameter changes at once, per unit of it, where no pair moves."""

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:
        """What it changes of an output, but by the friction."""

    def moved(self, points: Sequence[TapePoint]) -> Sequence[tuple[Array, Array]]:
        """Motions of the pairs (d, a), length, and resultants of loads (k,), force, at points; empty for none."""

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What it changes of the friction of the active pairs, scaled; None where that stays."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PointChange:
    """What a parameter changes at a point, per unit of it.

    Attributes
    ----------
    h, r : (d, n) of motions and forces of all pairs, length and force, where the point is
    part : of the part of the leg that is behind
    bound : of the friction of the active pairs; None where that stays
    """

    h: Array
    r: Array
    part: float
    bound: BoundTerm | None


@dataclass(kw_only=True, eq=False)
class Weights:
    """How a number changes with motions and forces of all pairs, (d, n), at a point."""

    h: Array
    r: Array

    def any(self) -> bool:
        """Whether it does."""
        return bool(self.h.any() or self.r.any())


@dataclass(frozen=True, kw_only=True, eq=False)
class PointTerm:
    """How an output changes with what drives a point where no pair moves.

    Attributes
    ----------
    motion : (d, a) per length, with motions of the active pairs
    resultant : (k,) per force, with resultants of loads
    """

    motion: Array
    resultant: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class TermStack:
    """The terms of some points of one system.

    Attributes
    ----------
    system : the interface
    numbers : of the points
    motion, resultant : (p, d, a) and (p, k), as of `PointTerm`
    """

    system: InterfaceSystem
    numbers: list[int]
    motion: Array
    resultant: Array

    def of(self, motion: Array, resultant: Array, factors: Array) -> float:
        """What the same motions and resultants at every point, times a factor each, change of the output.

        Parameters
        ----------
        motion, resultant : (d, a) length and (k,) force
        factors : (p,)
        """
        of_motion, of_resultant = np.tensordot(factors, self.motion, axes=1), factors @ self.resultant
        return float(np.vdot(of_motion, motion) + of_resultant @ resultant)


@dataclass(frozen=True, kw_only=True, eq=False)
class Adjoint:
    """An output by everything that drives the points.

    Attributes
    ----------
    stacks : of the points that matter, one a system
    bounds : by system
    pulled : (z,) by number of the point, of outputs of bodies: free displacements where what the output changes with
        pulls on them
    """

    stacks: tuple[TermStack, ...]
    bounds: dict[InterfaceSystem, BoundTerm]
    pulled: dict[int, Array] = field(default_factory=dict)

    @cached_property
    def terms(self) -> dict[int, PointTerm]:
        """By number of the point, those that matter alone."""
        return {
            i: PointTerm(motion=motion, resultant=resultant)
            for stack in self.stacks
            for i, motion, resultant in zip(stack.numbers, stack.motion, stack.resultant, strict=True)
        }


class _Passed:
    """Points of one system that were passed backwards: what of their responses is looked at all at once.

    Parameters
    ----------
    system : the interface

    Attributes
    ----------
    numbers : of the points
    bound : how the output changes with the friction of the pairs
    """

    def __init__(self, system: InterfaceSystem) -> None:
        self.system, self.bound = system, BoundTerm.of(system.law.pieces)
        self.numbers: list[int] = []
        self._points: list[TapePoint] = []
        self._free: list[Array] = []
        self._pushed: list[Array] = []

    def take(self, number: int, point: TapePoint, free: Array, pushed: Array) -> None:
        """Take a point.

        Parameters
        ----------
        number, point : of the point, and the point
        free, pushed : (d n + k,) and (d - 1, n) how the output changes with its load, and with friction directly
        """
        self.numbers.append(number)
        self._points.append(point)
        self._free.append(free)
        self._pushed.append(pushed)

    def stack(self, direct: Mapping[int, Array]) -> TermStack:
        """The terms of the points, with what is known directly of some; what they ask of friction goes to the bound."""
        free = np.stack(self._free)
        motion, resultant = self.system.condensed.free_transposed(free)
        for k, i in enumerate(self.numbers):
            if i in direct:
                motion[k] += direct[i]
        self._add_friction(free)
        return TermStack(system=self.system, numbers=self.numbers, motion=motion, resultant=resultant)

    def _add_friction(self, free: Array) -> None:
        """How the output changes with the bound of pairs that slip: forces of that size beside all that is imposed."""
        states = [point.states for point in self._points]
        units = np.stack([known.unit for known in states])
        if not units.any():
            return
        image, (_, tangents, n) = self.system.law.image, units.shape
        rows, last = n, (1 + tangents) * n
        pushed = free[:, :last] @ image.A[:, rows:] + free[:, last:] @ image.R[rows:].T
        size = (units * (np.stack(self._pushed) + pushed.reshape(units.shape))).sum(axis=1)
        pressing = size * np.maximum(np.stack([point.r[0] for point in self._points]), 0.0)
        branch = np.stack([known.branch for known in states])
        for j in range(len(self.bound.starts)):
            on = branch == j
            self.bound.starts[j] += np.where(on, size, 0.0).sum(axis=0)
            self.bound.slopes[j] += np.where(on, pressing, 0.0).sum(axis=0)


def forward(points: Sequence[TapePoint], change: Change) -> list[PointChange]:
    """What a parameter changes at every point.

    Parameters
    ----------
    points : of the history
    change : what the parameter changes at once
    """
    found: list[PointChange] = []
    bounds: dict[InterfaceSystem, BoundTerm | None] = {}
    memory: Array | None = None
    at_once = _seen(points, change.moved(points))
    for i, point in enumerate(points):
        system, states = point.system, point.states
        if system not in bounds:
            bounds[system] = change.bound(system)
        system.ahead((points[j].system, points[j].states) for j in range(i, len(points)))
        every = (system.directions, len(system.condensed.active))
        memory = np.zeros((every[0] - 1, every[1])) if memory is None else memory
        bound, (held, given) = bounds[system], np.zeros((2, system.directions, system.pairs))
        remembered = states.held if states.codes is not None else True
        held[1:] = np.where(remembered, system.root * memory[:, system.active], 0.0)
        if bound is not None:
            given[1:] = states.unit * _on_branches(bound, states.branch, np.maximum(point.r[0], 0.0))
        load = system.imposed(held, given)
        if at_once:
            load += at_once[i]
        h, r = system.respond(states, load)
        h, r = h + held, r + given
        part = found[-1].part if point.follows and i and points[i - 1].leg == point.leg else 0.0
        if point.at_event:
            event = point.event
            part = -(event.change(h, r) + (0.0 if bound is None else _of_bound(event, bound))) / event.rate
        if part:
            h_rate, r_rate = _rates(point)
            h, r = h + part * h_rate, r + part * r_rate
        whole = np.zeros((2, *every))
        whole[0][:, system.active], whole[1][:, system.active] = h / system.root, r * system.root
        memory = whole[0, 1:]
        found.append(PointChange(h=whole[0], r=whole[1], part=part, bound=bound))
    return found


def _seen(points: Sequence[TapePoint], moved: Sequence[tuple[Array, Array]]) -> dict[int, Array]:
    """(d n + k,) By number of the point, what its equations see of motions of the pairs and resultants of loads."""
    found: dict[int, Array] = {}
    for system in dict.fromkeys(point.system for point in points) if moved else ():
        own = [i for i, point in enumerate(points) if point.system is system]
        free = system.condensed.free(*(np.stack([moved[i][k] for i in own]) for k in range(2)))
        found.update(zip(own, free, strict=True))
    return found


def backward(
    points: Sequence[TapePoint], weights: Mapping[int, Weights], direct: Mapping[int, Array] = MappingProxyType({})
) -> Adjoint:
    """An output by everything that drives the points.

    Parameters
    ----------
    points : of the history
    weights : how the output changes with motions and forces, by number of the point
    direct : (d, a) per length, with motions of the active pairs directly, by number of the point
    """
    passed: dict[InterfaceSystem, _Passed] = {}
    memory: Array | None = None  # (d - 1, n) of the active pairs of the system, scaled
    system: InterfaceSystem | None = None
    moves = 0.0  # how the output changes with the part of the leg that is behind where the next piece begins
    for i in range(max(weights, default=-1), -1, -1):
        point, states = points[i], points[i].states
        if point.system is not system:
            memory, system = _handed(memory, system, point.system), point.system
            known = passed.setdefault(system, _Passed(system))
        assert memory is not None
        moves = moves if i + 1 < len(points) and points[i + 1].leg == point.leg else 0.0
        h, r = np.zeros((2, system.directions, system.pairs))
        if i in weights:
            h, r = weights[i].h[:, system.active] / system.root, weights[i].r[:, system.active] * system.root
        h[1:] += memory
        memory = np.where(states.held, h[1:], 0.0)
        h[1:] -= memory
        if h.any() or r.any() or moves or i in direct:
            system.ahead((points[j].system, points[j].states) for j in range(i, -1, -1))
            if point.at_event or point.follows:
                h_rate, r_rate = _rates(point)
                moves += float(np.vdot(h, h_rate) + np.vdot(r, r_rate))
            if point.at_event:
                _through_event(point, h, r, known.bound, moves)
            free = system.respond_transposed(states, h, r)
            known.take(i, point, free, r[1:])
            memory += (h - free[: h.size].reshape(h.shape))[1:]
        moves = moves if point.follows else 0.0
    stacks = tuple(one.stack(direct) for one in passed.values() if one.numbers)
    return Adjoint(stacks=stacks, bounds={system: one.bound for system, one in passed.items()})


def _handed(memory: Array | None, before: InterfaceSystem | None, system: InterfaceSystem) -> Array:
    """(d - 1, n) How an output changes with what is remembered of the active pairs of a system, scaled.

    Parameters
    ----------
    memory, before : the same of another system, which follows; None where nothing does
    system : the system
    """
    whole = np.zeros((system.directions - 1, len(system.condensed.active)))
    if memory is not None and before is not None:
        whole[:, before.active] = before.root * memory
    return np.asarray(whole[:, system.active] / system.root)


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


def _through_event(point: TapePoint, h: Array, r: Array, term: BoundTerm, moves: float) -> None:
    """Turn how an output changes with what is at an event into how it changes with what is at its load, in place.

    ``moves`` is how it changes with the part of the leg that is behind.
    """
    event = point.event
    at = event.branch, event.pair
    share = -moves / event.rate
    h[0, event.pair] += share * event.gap
    r[0, event.pair] += share * event.pressure
    r[1:, event.pair] += share * event.friction
    term.starts[at] += share * event.start
    term.slopes[at] += share * event.slope
    term.kinks[at] += share * event.kink


def _rates(point: TapePoint) -> tuple[Array, Array]:
    """(d, n) Rates of motions and forces at an event."""
    assert point.rates is not None
    return point.rates
