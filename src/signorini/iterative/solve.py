# SPDX-License-Identifier: BSD-3-Clause
"""The method of multipliers with a semismooth Newton inside: contact on the bodies as they are.

Trial forces ``y = E (r - D (B z + h_0))`` are projected on the law, Pi, with the friction bounds of the round before.
With ``E = (1 + D C)^-1`` a compliance C in series is exact. Rounds repeat

    K z = f + B' Pi(y(z)),    r <- Pi(y),    bound <- F(r_n), in Coulomb's law mu r_n

where the first, the minimum of a convex energy, is approached by Newton steps, symmetric positive definite systems
that conjugate gradients solve no further than the rest of the round deserves. A fixed point is a solution of the
contact problem as posed, whatever D. Only the bound's lag is not a minimisation: for friction far above the usual it
need not converge.

References
----------
Alart, Curnier (1991), A mixed formulation for frictional contact problems, CMAME 92:353-375.
Rockafellar (1976), Augmented Lagrangians and applications of the proximal point algorithm, Math. Oper. Res. 1:97-116.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.attempt import MethodRun
from signorini.errors import told
from signorini.iterative.bodies import Bodies
from signorini.iterative.springs import PairSprings
from signorini.law.bound import Bound, FrictionBound
from signorini.law.pair import PairLaw
from signorini.law.result import ContactAnswer
from signorini.law.section import FrictionSection
from signorini.law.states import OPEN, STICK
from signorini.linalg.krylov import conjugate_gradients
from signorini.outcome import Outcome

_MAX_NEWTON = 20  # steps a round
_EQUILIBRIUM_SHARE = 0.1  # of what the multipliers change by: what equilibrium may lack in a round
_NEWTON_RESIDUAL = 0.1  # of the residual before: what conjugate gradients leave of it
_STILL_FALLS = 0.9  # of the least residual: what a round leaves of it where another one is worth it
_STIFFNESS_FLOOR = 1e-4  # of their stiffness: what pairs that resist nothing keep where contact alone holds bodies
_SPRING_CHANGE = 0.1  # of the stiffest spring: change of springs up to which a cycle serves
_DRAGGED_STIFFNESS = 1e12  # force per slip: far beyond every bound, so that what is dragged slips

NOT_SETTLED = told(
    "no certified equilibrium, and no proof that there is none: multipliers did not settle",
    remedy="smaller increments, less friction, or a model small enough to be condensed",
    evidence="{rounds} rounds, residual {worst:.1e}",
)


@dataclass(frozen=True, kw_only=True, eq=False)
class IncrementLoad:
    """What an increment asks.

    Attributes
    ----------
    f : (b,) forces
    offset : (d, a) relative displacements without z, length
    bound : of the friction forces of a pairs
    force, length : sizes of the data
    floating : whether contact alone holds a body
    tolerance : of the sizes of the data: equilibrium, gaps that should be closed, forces that should have settled
    rounds : most of them
    """

    f: Array
    offset: Array
    bound: Bound
    force: float
    length: float
    floating: bool
    tolerance: float
    rounds: int


def solve_iteratively(bodies: Bodies, load: IncrementLoad, z: Array, forces: Array) -> tuple[ContactAnswer, Array]:
    """Solve one increment: the answer of the pairs, tied ones too, in their own units, and (z,) free displacements.

    Parameters
    ----------
    bodies, load : what is pressed, and by what
    z : (b,) displacements to start from
    forces : (d, a) of the pairs, to start from
    """
    rounds = _Rounds(bodies, load, z, forces)
    worst, best = np.inf, [np.inf]
    for _ in range(load.rounds):
        rounds.newton()
        worst = rounds.update()
        best.append(min(worst, best[-1]))
        as_good_as_it_gets = worst <= bodies.aim or worst > _STILL_FALLS * best[-2]
        if (worst <= load.tolerance and as_good_as_it_gets) or not np.isfinite(worst):
            break
        if len(best) > bodies.patience and best[-1] > 0.5 * best[-1 - bodies.patience]:
            break
    return rounds.answer(worst)


class _Rounds:
    """The iterates of an increment: displacements z, forces of the pairs (``multiplier``), trial forces y and bounds.

    D, C and E are those of the module; ``internal`` is K z, ``relative`` B z + h_0.
    """

    def __init__(self, bodies: Bodies, load: IncrementLoad, z: Array, forces: Array) -> None:
        d, a = load.offset.shape
        self.bodies, self.load = bodies, load
        self.z, self.multiplier = z.copy(), forces.copy()
        self.D, self.C = bodies.stiffness, bodies.compliance
        self.E = 1.0 / (1.0 + self.D * self.C)
        self.softened = self.E * self.D
        self.transposed = bodies.B.T.tocsr()
        self.section = FrictionSection.round(d - 1, a)
        self.moves = np.diff(bodies.B.indptr).reshape(d, a) > 0
        self.internal = bodies.K @ self.z
        self.relative = self._seen(self.z) + load.offset
        self.y = self._trial()
        touching = self.y[0] >= 0
        sticks = np.where(touching & (load.bound.steepest > 0), np.inf, 0.0)
        self.bound = self._bound(forces[0]) if forces.any() else sticks
        self.law = self._law()
        self.cycle: tuple[PairSprings, Callable[[Array], Array]] | None = None
        self.iterations: list[int] = []
        self.changes: list[int] = []

    def newton(self) -> None:
        """Approach equilibrium under the multipliers and bounds of this round."""
        load = self.load
        for _ in range(_MAX_NEWTON):
            forces = self._project(self.y)
            g = load.f + self.transposed @ forces.ravel() - self.internal
            lag = self.transposed @ (forces - self.multiplier).ravel()
            left = float(np.linalg.norm(g))
            if left <= _EQUILIBRIUM_SHARE * float(np.linalg.norm(lag)) or left <= 0.1 * load.tolerance * load.force:
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
        self.internal, self.relative = bodies.K @ self.z, self._seen(self.z) + load.offset
        self.y = self._trial()
        forces = self._project(self.y)
        g = load.f + self.transposed @ forces.ravel() - self.internal
        balance = np.abs(np.concatenate([g, bodies.rigid.T @ g])).max(initial=0.0)
        change = np.abs(forces - self.multiplier)
        motion = np.where(self.moves, change / np.maximum(self.D, 1e-300), 0.0).max(initial=0.0)
        before = self.state
        self.multiplier, self.bound = forces, self._bound(forces[0])
        self.law = self._law()
        self.y = self._trial()
        self.changes.append(int(np.count_nonzero(self.state != before)))
        return float(max(balance / load.force, change.max(initial=0.0) / load.force, motion / load.length))

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
        return answer, self.z[self.bodies.blocks.place]

    def _law(self) -> PairLaw:
        """The law under the friction bounds of this round, but for ties, which carry any force."""
        return PairLaw(bound=FrictionBound.constant(self.bound), section=self.section)

    def _seen(self, z: Array) -> Array:
        return (self.bodies.B @ z).reshape(self.load.offset.shape)

    def _bound(self, normal: Array) -> Array:
        return self.load.bound.at(np.maximum(normal, 0.0))

    def _trial(self) -> Array:
        y = self.E * (self.multiplier - self.D * self.relative)
        # what supports drag along slips as they say, whatever acts on it
        dragged = ~self.moves[1:].any(axis=0) & ~self.bodies.tied
        y[1:, dragged] = -_DRAGGED_STIFFNESS * self.load.offset[1:, dragged]
        return y

    def _project(self, y: Array) -> Array:
        return np.where(self.bodies.tied, y, self.law.split(y)[1])

    def _step(self, g: Array) -> tuple[Array, int]:
        bodies = self.bodies
        pairs = PairSprings.of(self.section, self.y, self.bound, self.softened, bodies.tied)
        if self.load.floating:
            pairs = pairs.floored(_STIFFNESS_FLOOR * self.softened)
        springs = self.transposed @ pairs.matrix() @ bodies.B
        if self.cycle is None or pairs.change(self.cycle[0]) > _SPRING_CHANGE * float(self.softened.max(initial=0.0)):
            self.cycle = pairs, bodies.preconditioner.under(springs)
        return conjugate_gradients(lambda v: bodies.K @ v + springs @ v, self.cycle[1], g, _NEWTON_RESIDUAL)

    def _go(self, step: Array, forces: Array) -> bool:
        """Along a step to where the energy is least: a convex function whose slope is found from the pairs alone.

        Where friction of the bounds of this round does not hold floating bodies it has no minimum: one step is enough.

        Returns
        -------
        Whether this round goes on.
        """
        bodies, load = self.bodies, self.load
        internal, across = bodies.K @ step, self._seen(step)
        stiff, rest = float(step @ internal), float(step @ (load.f - self.internal))

        def downhill(t: float) -> float:
            y = self.y - t * self.softened * across
            return rest - t * stiff + float((across * self._project(y)).sum())

        t = _root(downhill, rest + float((across * forces).sum()))
        slides = t > 1.0 and load.floating and bool(forces.any())
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
