# SPDX-License-Identifier: BSD-3-Clause
"""What the materials and the shape of bodies change at once: stiffness, loads, and how the pairs see the bodies.

With ``K u = f + B^T r`` and ``h = B u + C r + g`` a parameter changes K by K', and so f, B, C and g. With pairs still,

    h' = B K^-1 (f' + B'^T r - K' u) + B' u + C' r + g',

and an output that changes with h by J and with resultants by j changes with w, ``K w = B^T J + Z j``, by

    w . (f' + B'^T r - K' u) + J . (B' u + C' r + g').

Sums of that over points are of low rank: displacements are substituted for as few combinations of them as matter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.low_rank import Combination, combinations
from signorini.derivative.pair_change import PairChange
from signorini.derivative.points import TapePoint
from signorini.derivative.recursion import Adjoint, BoundTerm
from signorini.derivative.view import HistoryView, displacements
from signorini.engine.condensation import whole_stiffness
from signorini.engine.examine import Examined, examine
from signorini.engine.prepare import Prepared
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyChange:
    """A parameter of bodies, by differences of the assembled model at both sides of it.

    Attributes
    ----------
    low, high : the model examined there
    step : half of what the parameter differs by between them
    multiplied : by load, what a prepared model multiplies it by
    """

    low: Examined
    high: Examined
    step: float
    multiplied: Mapping[str, float]

    @classmethod
    def of(cls, prepared: Prepared, low: Model, high: Model, step: float) -> BodyChange:
        """Of models at both sides of the parameter.

        Parameters
        ----------
        prepared : the model as it is, whose loads may be multiplied; temperatures are so in the models
        low, high, step : as of the attributes
        """
        hot = {load.label for load in prepared.model.loads if load.temperature is not None}
        multiplied = {name: factor for name, factor in prepared.multiplied.items() if name not in hot}
        return cls(low=examine(low), high=examine(high), step=step, multiplied=multiplied)

    @cached_property
    def stiffness(self) -> sp.csr_array:
        """(dofs, dofs) K'."""
        return sp.csr_array((whole_stiffness(self.high) - whole_stiffness(self.low)) / (2.0 * self.step))

    @cached_property
    def loads(self) -> Mapping[str, Array]:
        """(dofs,) f' at factor 1, of loads that change."""
        found = {
            name: self.multiplied.get(name, 1.0) * (f - self.low.loads[name]) / (2.0 * self.step)
            for name, f in self.high.loads.items()
        }
        return {name: f for name, f in found.items() if f.any()}

    @cached_property
    def pairs(self) -> PairChange:
        """What it changes of the pairs."""
        return PairChange.between(self.low.interface, self.high.interface, self.step)

    def moved(self, points: Sequence[TapePoint]) -> list[tuple[Array, Array]]:
        """Motions of the pairs and resultants."""
        found = []
        for point in points:
            system = point.system
            prepared, response = system.prepared, system.condensed.response
            u, r = displacements([point]), (system.root * point.r).reshape(-1, 1)
            forces = (self.pairs.on_bodies(system, r) - self.stiffness @ u)[:, 0]
            for name, f in self.loads.items():
                forces += point.load.factors.get(name, 0.0) * f
            load = system.condensed.reduce(prepared.constraints.on_free(forces)).load
            motion = response.moved(load) + self.pairs.motions(system, u, r)[:, 0]
            found.append((motion.reshape(point.r.shape), response.resultant(load)))
        return found

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What areas change of the friction."""
        return self.pairs.bound(system)

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:
        """What it changes of an output through all points, its friction apart."""
        found = 0.0
        for combination in combinations(points, adjoint):
            found += self._of(combination)
        return found

    def views(self, view: HistoryView) -> tuple[HistoryView, HistoryView]:
        """What outputs are read from at both sides of the parameter, motions and forces as they are."""
        low, high = (
            replace(view, model=side.model, space=side.space, interface=side.interface)
            for side in (self.low, self.high)
        )
        return low, high

    def _of(self, combination: Combination) -> float:
        """Of combinations of points of one system: ``w . (f' + B'^T r - K' u) + J . (B' u + C' r + g')``."""
        system, w, u = combination.system, combination.adjoint, combination.displacement
        found = -float(np.vdot(w, self.stiffness @ u))
        for name, f in self.loads.items():
            found += float((f @ w) @ combination.factor(name))
        if self.pairs.any:
            r = combination.forces.reshape(-1, w.shape[1])
            moved = self.pairs.motions(system, u, r)
            moved[: system.pairs] += np.outer(self.pairs.gap[system.active], combination.one - 1.0)
            found += float(np.vdot(w, self.pairs.on_bodies(system, r)))
            found += float(np.vdot(combination.motion.reshape(r.shape), moved))
        return found
