# SPDX-License-Identifier: BSD-3-Clause
"""Rounds of the method of multipliers (see `iterative.solve`): iterates of an increment, and what a round does."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.attempt import MethodRun
from signorini.errors import told
from signorini.iterative.pressed import IncrementLoad, PressedBodies
from signorini.iterative.springs import PairSprings
from signorini.law.bound import FrictionBound
from signorini.law.pair import PairLaw
from signorini.law.result import ContactAnswer
from signorini.law.section import FrictionSection
from signorini.law.states import OPEN, STICK
from signorini.outcome import Outcome

_MAX_NEWTON = 20  # steps a round
_EQUILIBRIUM_SHARE = 0.1  # of what the multipliers change by: what equilibrium may lack in a round
_NEWTON_RESIDUAL = 0.1  # of the residual before: what conjugate gradients leave of it
_STIFFNESS_FLOOR = 1e-4  # of their stiffness: what pairs that resist nothing keep where contact alone holds bodies
_SPRING_CHANGE = 0.1  # of the stiffest spring: change of springs up to which a cycle serves
_DRAGGED_STIFFNESS = 1e12  # force per slip: far beyond every bound, so that what is dragged slips

NOT_SETTLED = told(
    "no certified equilibrium, and no proof that there is none: multipliers did not settle",
    remedy="smaller increments, less friction, or a model small enough to be condensed",
    evidence="{rounds} rounds, residual {worst:.1e}",
)


class MultiplierRounds:
    """The iterates of an increment: displacements z, forces of the pairs (``multiplier``), trial forces y and bounds.

    D, C and E are those of the module; ``internal`` is K z, ``relative`` B z + h_0. All arrays are of the part of the
    bodies and pairs that is here: sums and largest values are those of all parts.
    """

    def __init__(self, bodies: PressedBodies, load: IncrementLoad, z: Array, forces: Array) -> None:
        d, a = load.offset.shape
        self.bodies, self.load = bodies, load
        self.z, self.multiplier = z.copy(), forces.copy()
        self.D, self.C = bodies.stiffness, bodies.compliance
        self.E = 1.0 / (1.0 + self.D * self.C)
        self.softened = self.E * self.D
        self.section = FrictionSection.round(d - 1, a)
        self.stiffest = bodies.most(float(self.softened.max(initial=0.0)))
        self.internal = bodies.internal(self.z)
        self.relative = bodies.seen(self.z) + load.offset
        self.y = self._trial()
        touching = self.y[0] >= 0
        sticks = np.where(touching & (load.bound.steepest > 0), np.inf, 0.0)
        self.bound = self._bound(forces[0]) if self._any(forces) else sticks
        self.law = self._law()
        self.known: tuple[PairSprings, Any] | None = None
        self.iterations: list[int] = []
        self.changes: list[int] = []

    def newton(self) -> None:
        """Approach equilibrium under the multipliers and bounds of this round."""
        bodies, load = self.bodies, self.load
        for _ in range(_MAX_NEWTON):
            forces = self._project(self.y)
            g = load.f + bodies.pushed(forces) - self.internal
            lag = self._norm(bodies.pushed(forces - self.multiplier))
            left = self._norm(g)
            if left <= _EQUILIBRIUM_SHARE * lag or left <= 0.1 * load.tolerance * load.force:
                return
            step, count = self._step(g)
            whole = self._go(step, forces)
            self.iterations.append(count)
            if not whole:
                return

    def update(self) -> float:
        """Take over forces and bounds; the largest residual of what is left."""
        bodies, load = self.bodies, self.load
        # steps that went far and back again have left their rounding in the sums
        self.internal, self.relative = bodies.internal(self.z), bodies.seen(self.z) + load.offset
        self.y = self._trial()
        forces = self._project(self.y)
        g = load.f + bodies.pushed(forces) - self.internal
        balance = np.abs(np.concatenate([g, bodies.resultants(g)])).max(initial=0.0)
        change = np.abs(forces - self.multiplier)
        motion = np.where(bodies.moves, change / np.maximum(self.D, 1e-300), 0.0).max(initial=0.0)
        before = self.state
        self.multiplier, self.bound = forces, self._bound(forces[0])
        self.law = self._law()
        self.y = self._trial()
        self.changes.append(int(bodies.total(np.count_nonzero(self.state != before))))
        return bodies.most(float(max(balance / load.force, change.max(initial=0.0) / load.force, motion / load.length)))

    @property
    def state(self) -> IntArray:
        """(a,) What each pair does."""
        return np.where(self.bodies.tied, STICK, self.law.states(self.y))

    def answer(self, worst: float) -> tuple[ContactAnswer, Array]:
        """The last iterate as an answer, and its displacements."""
        state, r = self.state, self.multiplier.copy()
        # bounds lag by what the last round changed: what slips carries exactly what friction bears
        slips = (state != OPEN) & (state != STICK)
        size = np.linalg.norm(r[1:], axis=0)
        r[1:, slips] *= np.divide(self.bound, size, out=np.ones_like(size), where=size > 0)[slips]
        moved = self.relative + self.C * r
        closed = state != OPEN
        moved[0] = np.where(closed, 0.0, np.maximum(moved[0], 0.0))
        moved[1:] = np.where(state == STICK, 0.0, moved[1:])
        solved, rounds = worst <= self.load.tolerance, len(self.changes)
        message = (
            f"solved by multipliers, {rounds} rounds" if solved else NOT_SETTLED.format(rounds=rounds, worst=worst)
        )
        end = f"{sum(self.iterations)} conjugate gradients, residual {worst:.0e}"
        attempt = MethodRun(method="multipliers", iterations=rounds, changes=tuple(self.changes), end=end)
        answer = ContactAnswer(
            outcome=Outcome.SOLVED if solved else Outcome.NOT_FOUND,
            h=frozen(moved),
            r=frozen(r),
            state=state,
            trace=(attempt,),
            residual=worst,
            message=message,
        )
        return answer, self.z

    def held(self, pairs: PairSprings) -> PairSprings:
        """Springs that let no body run away."""
        return pairs.floored(_STIFFNESS_FLOOR * self.softened) if self.load.floating else pairs

    def cycle(self, pairs: PairSprings) -> Any:
        """What makes iterations fast under springs; the last one serves as long as they hardly change."""
        bodies, known = self.bodies, self.known
        if known is None or bodies.most(pairs.change(known[0])) > _SPRING_CHANGE * self.stiffest:
            self.known = known = pairs, bodies.preconditioner_under(pairs)
        return known[1]

    def take(self, z: Array, forces: Array) -> None:
        """Go on from displacements (b,) and forces of the pairs (d, a)."""
        self.z, self.multiplier = z, forces
        self.internal, self.relative = self.bodies.internal(z), self.bodies.seen(z) + self.load.offset
        self.bound = self._bound(forces[0])
        self.law = self._law()
        self.y = self._trial()

    def _law(self) -> PairLaw:
        """The law under the friction bounds of this round, but for ties, which carry any force."""
        return PairLaw(bound=FrictionBound.constant(self.bound), section=self.section)

    def _norm(self, values: Array) -> float:
        return float(np.sqrt(self.bodies.total(values @ values)))

    def _any(self, values: Array) -> bool:
        return self.bodies.most(float(values.any())) > 0.0

    def _bound(self, normal: Array) -> Array:
        return self.load.bound.at(np.maximum(normal, 0.0))

    def _trial(self) -> Array:
        y = self.E * (self.multiplier - self.D * self.relative)
        # what supports drag along slips as they say, whatever acts on it
        return self.with_dragged(y)

    @property
    def dragged(self) -> BoolArray:
        """(a,) Pairs whose slip is given by supports alone."""
        return ~self.bodies.moves[1:].any(axis=0) & ~self.bodies.tied

    def with_dragged(self, y: Array) -> Array:
        """Trial forces y (d, a) in which what is dragged slips against any friction."""
        y[1:, self.dragged] = -_DRAGGED_STIFFNESS * self.load.offset[1:, self.dragged]
        return y

    def _project(self, y: Array) -> Array:
        return np.where(self.bodies.tied, y, self.law.split(y)[1])

    def _step(self, g: Array) -> tuple[Array, int]:
        pairs = self.held(PairSprings.of(self.section, self.y, self.bound, self.softened, self.bodies.tied))
        return self.bodies.solved(pairs, self.cycle(pairs), g, _NEWTON_RESIDUAL)

    def _go(self, step: Array, forces: Array) -> bool:
        """Along a step to where the energy is least: a convex function whose slope is found from the pairs alone.

        Where friction of the bounds of this round does not hold floating bodies it has no minimum: one step is enough.

        Returns
        -------
        Whether this round goes on.
        """
        bodies, load = self.bodies, self.load
        internal, across = bodies.internal(step), bodies.seen(step)
        given = np.array([step @ internal, step @ (load.f - self.internal), (across * forces).sum()])
        stiff, rest, first = bodies.total(given).tolist()

        def downhill(t: float) -> float:
            y = self.y - t * self.softened * across
            return rest - t * stiff + float(bodies.total((across * self._project(y)).sum()))

        t = _root(downhill, rest + first)
        slides = t > 1.0 and load.floating and self._any(forces)
        t = 1.0 if slides else t
        self.z += t * step
        self.internal = self.internal + t * internal
        self.relative = self.relative + t * across
        self.y = self._trial()
        return not slides


def _root(downhill: Callable[[float], float], start: float) -> float:
    """Where a decreasing function that is positive at 0 vanishes, near enough."""
    if start <= 0:
        return 1.0
    low, high, value = 0.0, 1.0, downhill(1.0)
    if abs(value) <= 0.3 * start:
        return 1.0
    while value > 0 and high < 1e6:
        low, high = high, 2.0 * high
        value = downhill(high)
    for _ in range(40):
        middle = 0.5 * (low + high)
        value = downhill(middle)
        if abs(value) <= 0.1 * start:
            return middle
        low, high = (middle, high) if value > 0 else (low, middle)
    return 0.5 * (low + high)
