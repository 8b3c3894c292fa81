# SPDX-License-Identifier: BSD-3-Clause
"""Steps of a plastic increment that go too far are cut where the energy of the increment stops to fall."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.plasticity.bodies import PlasticResponse, YieldingBodies
from signorini.plasticity.bracket import Bracket, narrowed, secant
from signorini.plasticity.laws import Heat
from signorini.plasticity.state import PlasticState

_UPHILL = 0.8  # of the slope at the beginning: a step that ends steeper is cut
_LEVEL = 0.5  # of the slope at the beginning: where a search ends
_ROUNDS = 10  # of regula falsi in one step
_SLOPE_NOISE = 1e-12  # of the terms that a slope is summed from: less is rounding
_INSIDE = 0.05  # of the bracket: how near its ends the next try may be
_RESTS = 1e-14  # of the largest slip increment: a pair that slips less has no direction


@dataclass(frozen=True, kw_only=True, eq=False)
class LineSearch:
    """Between two answers of contact, both of which obey its gaps, so that all between do.

    The slope is that of the energy of the increment with the friction bound of the second answer frozen.

    Attributes
    ----------
    bodies : the points that yield
    increment : what is asked
    old, heat : state that the points come from, and what the temperature does to them
    one, two : the answers
    """

    bodies: YieldingBodies
    increment: Increment
    old: PlasticState
    heat: Heat
    one: IncrementAnswer
    two: IncrementAnswer

    @property
    def length(self) -> float:
        """Of the step: the largest displacement."""
        return float(np.abs(self.two.free - self.one.free).max(initial=0.0))

    def cut(self, part: float) -> tuple[float, IncrementAnswer, PlasticResponse]:
        """The step cut to a part of it: the part, the answer there and what points answer."""
        return part, between(self.one, self.two, part), self._response(part)

    def shortened(
        self, before: PlasticResponse, after: PlasticResponse
    ) -> tuple[float, IncrementAnswer, PlasticResponse]:
        """The part of the step that is taken, the answer there and what points answer.

        Parameters
        ----------
        before, after : what they answer at both ends
        """
        step = self.two.free - self.one.free
        start, end = self._slope(0.0, step, before), self._slope(1.0, step, after)
        system, T = self.increment.system, self.increment.system.constraints.transform
        inner = system.constraints.on_free(system.K @ (T @ self.two.free))
        noise = _SLOPE_NOISE * float(np.abs(step) @ (np.abs(self.increment.f) + np.abs(inner)))
        if start >= 0.0 or end <= max(_UPHILL * -start, noise):
            return 1.0, self.two, after
        bracket = Bracket(0.0, 1.0, start, end, 0)
        for _ in range(_ROUNDS):
            s = secant(bracket, 0.0, _INSIDE)
            here = self._response(s)
            slope = self._slope(s, step, here)
            if abs(slope) <= _LEVEL * abs(start):
                break
            bracket = narrowed(bracket, s, slope, slope > 0.0)
        return s, between(self.one, self.two, s), here

    def _response(self, s: float) -> PlasticResponse:
        """What points answer at a part of the way."""
        u = self.increment.system.constraints.transform @ between(self.one, self.two, s).free + self.increment.imposed
        return self.bodies.respond(u, self.old, self.heat)

    def _slope(self, s: float, step: Array, at: PlasticResponse) -> float:
        """Of the energy along the step, at a part of the way."""
        system, T = self.increment.system, self.increment.system.constraints.transform
        here = between(self.one, self.two, s)
        inner = system.constraints.on_free(system.K @ (T @ here.free) - at.state.forces) - self.increment.f
        bound = system.interface.most(self.two.forces[0])
        bound = np.where(np.isfinite(bound), bound, 0.0)
        slip, change = here.moved[1:], (self.two.moved - self.one.moved)[1:]
        length = np.linalg.norm(slip, axis=0)
        along = np.divide(
            (slip * change).sum(axis=0),
            length,
            out=np.zeros_like(length),
            where=length > _RESTS * np.abs(change).max(initial=0.0),
        )
        return float(step @ inner + bound @ along)


def between(one: IncrementAnswer, two: IncrementAnswer, s: float) -> IncrementAnswer:
    """What is at the part s of the way from answer one to answer two; its forces are those at the end."""
    free, moved = ((1.0 - s) * getattr(one, name) + s * getattr(two, name) for name in ("free", "moved"))
    return replace(two, free=free, moved=moved)
