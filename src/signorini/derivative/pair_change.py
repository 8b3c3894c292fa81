# SPDX-License-Identifier: BSD-3-Clause
"""What a parameter changes of how pairs see the bodies: normals, gaps, areas."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, distinct
from signorini.derivative.adjoint_terms import BoundTerm
from signorini.derivative.interface_system import InterfaceSystem
from signorini.interface.interface import Interface
from signorini.law.bound import FrictionBound
from signorini.model.model import Model
from signorini.sparse_rows import chosen_columns, seen_by


@dataclass(frozen=True, kw_only=True, eq=False)
class PairChange:
    """What a parameter changes of how pairs see the bodies.

    Attributes
    ----------
    B, gap, compliance : derivatives of those of `Interface`
    low, high, step : the pairs at both sides of the parameter, and half of what that differs by
    """

    B: sp.csr_array
    gap: Array
    compliance: Array
    low: Interface
    high: Interface
    step: float

    @classmethod
    def between(cls, low: Interface, high: Interface, step: float) -> PairChange:
        """The differences between both sides of a parameter.

        Parameters
        ----------
        low, high, step : the pairs there, and half of what the parameter differs by
        """
        width = 2.0 * step
        return cls(
            B=sp.csr_array((high.B - low.B) / width),
            gap=(high.gap - low.gap) / width,
            compliance=(high.compliance - low.compliance) / width,
            low=low,
            high=high,
            step=step,
        )

    def mirrored(self, step: float) -> PairChange:
        """What a parameter changes that does the other way what this one does, both per part of themselves.

        Parameters
        ----------
        step : half of what it differs by between both sides, the same part of it
        """
        part = -self.step / step
        changed = {"B": part * self.B, "gap": part * self.gap, "compliance": part * self.compliance}
        return PairChange(**changed, low=self.high, high=self.low, step=step)

    @cached_property
    def any(self) -> bool:
        """Whether anything changes."""
        return bool(self.B.data.any() or self.gap.any() or self.compliance.any())

    def motions(self, system: InterfaceSystem, u: Array, r: Array, one: Array) -> Array:
        """(d a, k) Motions ``B' u + C' r + g'`` of the active pairs.

        Parameters
        ----------
        system : the interface
        u, r : (dofs, k) displacements, (d a, k) forces
        one : (k,) how much of the gaps is in every column
        """
        rows, moved = system.condensed.active, self.seen(system, u)
        moved[: system.pairs] += np.outer(self.gap[rows], one)
        return np.asarray(moved + self.compliance[:, rows].ravel()[:, None] * r)

    def seen(self, system: InterfaceSystem, u: Array) -> Array:
        """(d a, k) Motions ``B' u`` of the active pairs, of displacements (dofs, k)."""
        return seen_by(self.B, u)[np.tile(system.condensed.active, system.directions)]

    def on_bodies(self, system: InterfaceSystem, r: Array) -> Array:
        """(dofs, k) Forces ``B'^T r`` of forces (d a, k) of the active pairs."""
        rows = np.tile(system.condensed.active, system.directions)
        whole = np.zeros((len(rows), r.shape[1]))
        whole[rows] = r
        seen = distinct(self.B.indices)
        return system.prepared.constraints.spread(seen, chosen_columns(self.B, seen).T @ whole)

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What areas change of the friction of the active pairs; None where that does not ask for them."""
        if not asks_for_areas(system):
            return None
        term = BoundTerm.of(system.law.pieces)
        high, low = (bound_at(system, side) for side in (self.high, self.low))
        inside = np.isfinite(high.kinks[:-1]) & np.isfinite(low.kinks[:-1])
        for name in ("slopes", "starts"):
            setattr(term, name, (getattr(high, name) - getattr(low, name)) / (2.0 * self.step))
        term.kinks[inside] = (high.kinks[:-1][inside] - low.kinks[:-1][inside]) / (2.0 * self.step)
        return term


def asks_for_areas(system: InterfaceSystem) -> bool:
    """Whether the friction of the pairs depends on their areas: not where it is a coefficient alone."""
    return system.law.pieces.branches > 1 or bool(system.law.pieces.starts.any())


def bound_at(system: InterfaceSystem, interface: Interface) -> FrictionBound:
    """The bound of the active pairs, scaled, on pairs of other areas."""
    active = system.condensed.active
    posed = interface.friction.among(active).posed(interface.area[active] / system.root)
    return replace(system.law, **posed).pieces


def between_bodies(model: Model) -> bool:
    """Whether a meshed side lies opposite another in any contact, not an obstacle opposite every one."""
    obstacles = {obstacle.name for obstacle in model.obstacles}
    return any(isinstance(contact.mortar, str) and contact.mortar not in obstacles for contact in model.contacts)
