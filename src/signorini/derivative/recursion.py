# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives along a history, forwards for one parameter or backwards for one output.

At a point a change of what is given changes motions and forces at a fixed load by x', from the equations of the piece;
where an event of the condition g ends it, its load by ``l' = -g' / (dg/dl)``, and so x by ``x' + (dx/dl) l'`` in all.
What pairs remember of it is their tangential motion h_t, which those hold that stick in the next piece. Everything else
that an event does comes by itself. Backwards the same in transposed steps: points that nothing asks of cost nothing.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import takewhile
from types import MappingProxyType
from typing import Protocol

import numpy as np

from signorini.arrays import Array
from signorini.derivative.adjoint_terms import Adjoint, BoundTerm, PassedPoints, Weights
from signorini.derivative.block_steps import LONGEST_BLOCK, BlockSteps
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint, with_trials


class AtOnce(Protocol):
    """What a parameter changes of the points of a history, per unit of it, where no pair moves."""

    def moved(self, points: Sequence[TapePoint]) -> Sequence[tuple[Array, Array]]:
        """Motions of the pairs (d, a), length, and resultants of loads (k,), force, at points; empty for none."""

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What it changes of the friction of the active pairs, scaled; None where that stays."""


class Change(AtOnce, Protocol):
    """A parameter by what it changes of the points of a history, and of an output."""

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:
        """What it changes of an output, but by the friction."""


def backward(
    points: Sequence[TapePoint],
    weights: Mapping[int, Weights],
    direct: Mapping[int, Array] = MappingProxyType({}),
    stops: Collection[int] = (),
) -> Adjoint:
    """An output by everything that drives the points.

    Parameters
    ----------
    points : of the history
    weights : how the output changes with motions and forces, by number of the point
    direct : (d, a) per length, with motions of the active pairs directly, by number of the point
    stops : numbers of points behind which it is asked what is remembered
    """
    back = _Back(points, weights, direct, stops)
    i = max(weights, default=-1)
    while i >= 0:
        with points[i].determined():
            i -= back.to(i)
    stacks = tuple(one.stack(direct) for one in back.passed.values() if one.numbers)
    bounds = {system: one.bound for system, one in back.passed.items()}
    return Adjoint(stacks=stacks, bounds=bounds, remembered=back.remembered, behind=back.behind)


def changed(points: Sequence[TapePoint], adjoint: Adjoint, change: Change) -> float:
    """What a parameter changes of an output of motions and forces.

    Parameters
    ----------
    points : of the history, and trials behind them
    adjoint : of the output
    change : what the parameter changes at once
    """
    found = change.total(points, adjoint)
    for system, friction in adjoint.bounds.items():
        bound = change.bound(system)
        found += 0.0 if bound is None else friction.along(bound)
    return found


class _Back:
    """The way back through the points of a history; parameters as of `backward`.

    Attributes
    ----------
    passed : what of every system was passed
    behind : as of `Adjoint`
    """

    def __init__(
        self,
        points: Sequence[TapePoint],
        weights: Mapping[int, Weights],
        direct: Mapping[int, Array],
        stops: Collection[int],
    ) -> None:
        self._points, self._weights, self._direct, self._stops = points, weights, direct, stops
        self._steps: dict[InterfaceSystem, BlockSteps] = {}
        self._memory: Array | None = None  # (d - 1, n) of the active pairs of the system, scaled
        self._system: InterfaceSystem | None = None
        # by number of the point, how the output changes with the part of the leg that is behind there; and how, (2, all
        # pairs) per force, with the friction with which an increment begins that tells its length
        self._moves: dict[int, float] = {}
        self._turned: Array | None = None
        self._place = {point: k for k, point in enumerate(with_trials(points))}
        self.passed: dict[InterfaceSystem, PassedPoints] = {}
        self.behind: dict[int, Array] = {}

    @property
    def remembered(self) -> Array:
        """(d - 1, all pairs) How the output changes, per length, with what is remembered before the points passed."""
        return _of_all(self._memory, self._system, self._points[0].system)

    def to(self, i: int) -> int:
        """Pass point i, and some before it; how many that were."""
        point = self._points[i]
        system, states = point.system, point.states
        if system is not self._system:
            self._memory, self._system = _handed(self._memory, self._system, system), system
            self.passed.setdefault(system, PassedPoints(system))
        assert self._memory is not None
        if i in self._stops:
            self.behind[i] = self.remembered
        asked = i in self._weights or i in self._direct or i in self._moves or self._turned is not None
        if not asked and not self._memory[~states.held].any():
            return 1
        return (states.codes is not None and self._block(i)) or self._one(i)

    def _block(self, i: int) -> int:
        """Pass point i in the plane and as many before it as go with it; how many that were, 0 where none do."""
        system, points, memory = self._points[i].system, self._points, self._memory
        assert memory is not None
        numbers = list(
            takewhile(
                lambda j: points[j].system is system and (j == i or j not in self._stops),
                range(i, max(-1, i - LONGEST_BLOCK), -1),
            )
        )
        if system not in self._steps:
            self._steps[system] = BlockSteps(system.law)
        own = [points[j] for j in numbers]
        block = self._steps[system].back(own, lambda k: self._asked(numbers[k]), memory[0])
        if block is None:
            return 0
        passed, count = self.passed[system], len(block.used)
        used = block.used | np.array([j in self._direct for j in numbers[:count]])
        for k in np.flatnonzero(block.share):
            passed.take_event(points[numbers[k]].event, block.share[k])
        which = np.flatnonzero(used)
        if len(which):
            passed.take([numbers[k] for k in which], [own[k] for k in which], block.free[which], block.pushed[which])
        return count

    def _one(self, i: int) -> int:
        """Pass point i alone: 1."""
        point, points = self._points[i], self._points
        system, states, memory = point.system, point.states, self._memory
        assert memory is not None
        asked = self._asked(i)
        h, r = (asked.h, asked.r) if asked is not None else np.zeros((2, system.directions, system.pairs))
        if self._turned is not None:
            r[1:] += self._turned[:, system.active] * system.root
            self._turned = None
        h[1:] += memory
        memory = np.where(states.held, h[1:], 0.0)
        h[1:] -= memory
        if h.any() or r.any() or i in self._moves or i in self._direct:
            system.ahead((points[j].system, points[j].states) for j in range(i, -1, -1))
            if point.at_event or point.quiet is not None:
                h_rate, r_rate = _rates(point)
                moves = self._moves.pop(i, 0.0) + float(np.vdot(h, h_rate) + np.vdot(r, r_rate))
                if point.at_event:
                    event = point.event
                    share = -moves / event.rate
                    h[0, event.pair] += share * event.gap
                    r[0, event.pair] += share * event.pressure
                    r[1:, event.pair] += share * event.friction
                    self.passed[system].take_event(event, share)
                elif i:
                    memory += self._through_quiet_end(i, moves)
            free = system.respond_transposed(states, h, r)
            self.passed[system].take([i], [point], free[None], r[None, 1:])
            memory += (h - free[: h.size].reshape(h.shape))[1:]
        self._memory = memory
        return 1

    def _through_quiet_end(self, i: int, moves: float) -> Array:
        """(2, n) How the output changes with what is remembered by what ends an increment where nothing happens.

        ``moves`` is how it does with the part of the leg at that end.
        """
        points, point = self._points, self._points[i]
        system, end = point.system, point.quiet
        assert end is not None

        def ask(number: int, r: Array) -> Array:
            trial = point.trials[number]
            free = system.respond_transposed(trial.states, np.zeros_like(r), r)
            self.passed[system].take([self._place[trial]], [trial], free[None], r[None, 1:])
            return free

        memory, friction, *ends = end.back(moves, system.pairs, ask)
        self._turned = np.zeros((2, len(system.condensed.active)))
        self._turned[:, system.active] = friction / system.root
        for k, part in zip((i - 1, i - 2), ends, strict=True):
            if part and k >= 0 and points[k].leg == point.leg:
                self._moves[k] = self._moves.get(k, 0.0) + part
        return memory

    def _asked(self, i: int) -> Weights | None:
        """How the output changes with motions and forces, (d, n) scaled, of the active pairs of a point."""
        if i not in self._weights:
            return None
        weight, system = self._weights[i], self._points[i].system
        return Weights(h=weight.h[:, system.active] / system.root, r=weight.r[:, system.active] * system.root)


def _handed(memory: Array | None, before: InterfaceSystem | None, system: InterfaceSystem) -> Array:
    """(d - 1, n) How an output changes with what is remembered of the active pairs of a system, scaled.

    Parameters
    ----------
    memory, before : the same of another system, which follows; None where nothing does
    system : the system
    """
    return np.asarray(_of_all(memory, before, system)[:, system.active] / system.root)


def _of_all(memory: Array | None, before: InterfaceSystem | None, system: InterfaceSystem) -> Array:
    """(d - 1, all pairs) The same of all pairs, per length; parameters as of `_handed`."""
    whole = np.zeros((system.directions - 1, len(system.condensed.active)))
    if memory is not None and before is not None:
        whole[:, before.active] = before.root * memory
    return whole


def _rates(point: TapePoint) -> tuple[Array, Array]:
    """(d, n) Rates of motions and forces at an event."""
    assert point.rates is not None
    return point.rates
