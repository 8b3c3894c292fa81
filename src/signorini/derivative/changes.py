# SPDX-License-Identifier: BSD-3-Clause
"""What the parameters of contacts and loads change at once: friction, gaps, and the size of what is imposed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.derivative.adjoint_terms import Adjoint, BoundTerm
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint
from signorini.derivative.recursion import AtOnce
from signorini.law.bound import FrictionBound
from signorini.law.friction import PairFriction

_STEP = 1e-5  # of a parameter of the friction: differences of a bound with kinks are right to 1e-10 then


@dataclass(frozen=True, kw_only=True, eq=False)
class FrictionChange:
    """One parameter of the friction of a contact grows.

    Attributes
    ----------
    parameter : "friction", "adhesion" or "shear_limit", or one of another law
    contact : number of the contact
    coefficient : name of that which a step gives; empty for what the contact itself has
    """

    parameter: str
    contact: int
    coefficient: str = ""

    def moved(self, points: Sequence[TapePoint]) -> tuple[()]:  # noqa: ARG002
        """Nothing moves at once."""
        return ()

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:  # noqa: ARG002
        """Nothing but by the friction."""
        return 0.0

    def bound(self, system: InterfaceSystem) -> BoundTerm:
        """Slopes, starts and kinks per unit of the parameter."""
        law, term = system.law, BoundTerm.of(system.law.pieces)
        changed = system.friction.get(system.prepared.model.contacts[self.contact].label, "")
        if self.parameter == "friction" and changed != self.coefficient:
            return term
        own = system.prepared.interface.contact[system.active] == self.contact
        if law.pieces.branches == 1 and self.parameter == "friction":
            term.slopes[0, own & np.isfinite(law.pieces.slopes[0]) & (law.law.section.axes.any(axis=0))] = 1.0
            return term
        given = system.prepared.interface.friction.parameters[self.parameter]
        step = _STEP * float(np.nanmax(given[system.prepared.interface.contact == self.contact]))
        high, low = (self._moved_bound(system, sign * step) for sign in (1.0, -1.0))
        for name in ("slopes", "starts"):
            setattr(term, name, (getattr(high, name) - getattr(low, name)) / (2.0 * step))
        inside = np.isfinite(high.kinks[:-1]) & np.isfinite(low.kinks[:-1])
        term.kinks[inside] = (high.kinks[:-1][inside] - low.kinks[:-1][inside]) / (2.0 * step)
        return term

    def _moved_bound(self, system: InterfaceSystem, step: float) -> FrictionBound:
        """The bound of the active pairs with the parameter changed by a step."""
        interface, active, blocks, first = system.prepared.interface, system.condensed.active, [], 0
        own = interface.contact == self.contact
        for law, parameters in interface.friction.blocks:
            count = len(next(iter(parameters.values())))
            here = own[first : first + count]
            values = {
                name: np.where(here, of + step, of) if name == self.parameter else of for name, of in parameters.items()
            }
            blocks.append((law, values))
            first += count
        posed = PairFriction(blocks=tuple(blocks)).among(active).posed(interface.area[active] / system.root)
        return replace(system.law, **posed).pieces


@dataclass(frozen=True, kw_only=True, eq=False)
class GapChange:
    """Gaps grow, each by its own number.

    Attributes
    ----------
    gap : (n,) of all pairs, length per unit
    """

    gap: Array

    def moved(self, points: Sequence[TapePoint]) -> list[tuple[Array, Array]]:
        """Motions of the pairs, and no resultants."""
        found = []
        for point in points:
            motion = np.zeros((point.system.directions, point.system.pairs))
            motion[0] = self.gap[point.system.active]
            found.append((motion, np.zeros(point.system.motions)))
        return found

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:  # noqa: ARG002
        """What the gaps change of an output."""
        return float(adjoint.by_gaps @ self.gap)

    def bound(self, system: InterfaceSystem) -> None:  # noqa: ARG002
        """The friction stays."""
        return


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadChange:
    """A load, a temperature or a motion of supports is multiplied by 1 plus the parameter.

    Attributes
    ----------
    name : of it
    """

    name: str

    def factor(self, point: TapePoint) -> float:
        """What the load grows by at a point, per unit of the parameter: its load factor."""
        return point.load.factors.get(self.name, 0.0)

    def moved(self, points: Sequence[TapePoint]) -> list[tuple[Array, Array]]:
        """Motions of the pairs and resultants, at the load factors of the points."""
        found = []
        for point in points:
            factor, unit = self.factor(point), point.system.unit(self.name)
            found.append((factor * unit.motion, factor * unit.resultant))
        return found

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:
        """What the load changes of an output by motions and forces of the pairs."""
        found = 0.0
        for stack in adjoint.stacks:
            factors = np.array([self.factor(points[i]) for i in stack.numbers])
            unit = stack.system.unit(self.name)
            found += stack.of(unit.motion, unit.resultant, factors)
        return found

    def bound(self, system: InterfaceSystem) -> None:  # noqa: ARG002
        """The friction stays."""
        return


@dataclass(frozen=True, kw_only=True, eq=False)
class LockChange(LoadChange):
    """The shortening at which a bolt has locked grows by a length."""

    def factor(self, point: TapePoint) -> float:
        """1 where the bolt is locked."""
        return float(self.name in point.load.factors)


@dataclass(frozen=True, kw_only=True, eq=False)
class ChangeWithLocks:
    """What a parameter changes at once, and by the shortenings at which bolts have locked before.

    Attributes
    ----------
    change : at once
    shortenings : by name, length per unit
    """

    change: AtOnce
    shortenings: Mapping[str, float]

    def moved(self, points: Sequence[TapePoint]) -> Sequence[tuple[Array, Array]]:
        """Motions of the pairs (d, a), length, and resultants (k,), force, at points."""
        found = list(self.change.moved(points))
        for name, size in self.shortenings.items():
            more = [(size * motion, size * resultant) for motion, resultant in LockChange(name=name).moved(points)]
            pairs = zip(found, more, strict=True)
            found = [(m + n, p + q) for (m, p), (n, q) in pairs] if found else more
        return found

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What it changes of the friction."""
        return self.change.bound(system)
