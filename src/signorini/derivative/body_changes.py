# SPDX-License-Identifier: BSD-3-Clause
"""What the materials and the shape of bodies change at once: stiffness, loads, and how the pairs see the bodies.

With ``K u = f + B^T r`` and ``h = B u + C r + g`` a parameter changes K by K', and so f, B, C and g. With pairs still,

    h' = B K^-1 (f' + B'^T r - K' u) + B' u + C' r + g',

which is linear in the states of the history: it is found for as few combinations of them as there are, all at once, and
kept. An output that changes with h by J and with resultants by j changes by ``J . h' + j . Z^T (f' + B'^T r - K' u)``;
where bodies are condensed onto contact nodes that is found without h', from sums over the history.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.derivative.adjoint_terms import Adjoint, BoundTerm, ByPlaces
from signorini.derivative.body_side import BodySide, multiplier
from signorini.derivative.contact_sums import ContactSums
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.low_rank import StateColumns, columns_of, of_same_bodies, state_columns, times
from signorini.derivative.pair_change import PairChange
from signorini.derivative.points import TapePoint
from signorini.derivative.view import HistoryView
from signorini.engine.prepare import Prepared
from signorini.fem.kinematics import straining_groups

_SUBSTITUTED_POINTS = 3  # points of a history at most: adjoint displacements are found one by one of so many
_SAME_CONDITION = 1e-12  # of the data of the law: by how much conditions differ between bodies that are the same


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyChange:
    """A parameter of bodies, by differences of what is assembled of them at both sides of it.

    Attributes
    ----------
    prepared : the model as it is, whose loads may be multiplied
    low, high : bodies and pairs at both sides
    step : half of what the parameter differs by between them
    tilts : whether pairs may see the bodies otherwise
    motion : (nodes, d) that moves the nodes, length per unit; None where they stay
    """

    prepared: Prepared
    low: BodySide
    high: BodySide
    step: float
    tilts: bool
    motion: Array | None = None
    _moved: dict[TapePoint, tuple[Array, Array]] = field(default_factory=dict, init=False)

    @property
    def rounding(self) -> float:
        """What rounding makes of the change of a condition, of the data of the law."""
        return _SAME_CONDITION / self.step

    @cached_property
    def stiffness(self) -> Any:
        """(dofs, dofs) K', see `BodySide.stiffness_change`."""
        return self.low.stiffness_change(self.high, 2.0 * self.step)

    @cached_property
    def loads(self) -> Mapping[str, Array]:
        """(dofs,) f' at factor 1, of loads that change."""
        found = {
            name: multiplier(self.prepared, name) * (f - self.low.loads[name]) / (2.0 * self.step)
            for name, f in self.high.loads.items()
        }
        return {name: f for name, f in found.items() if f.any()}

    @cached_property
    def pairs(self) -> PairChange | None:
        """What it changes of the pairs; None where that is nothing."""
        if not self.tilts:
            return None
        found = PairChange.between(self.low.interface, self.high.interface, self.step)
        return found if found.any else None

    def moved(self, points: Sequence[TapePoint]) -> list[tuple[Array, Array]]:
        """Motions of the pairs and resultants."""
        missing: dict[tuple[int, ...], list[TapePoint]] = {}
        for point in points:
            if point not in self._moved:
                missing.setdefault(point.system.bodies, []).append(point)
        for own in missing.values():
            system = own[0].system
            motion = np.zeros((system.directions * system.pairs, len(own)))
            resultant = np.zeros((system.motions, len(own)))
            for states in state_columns(own):
                of_motion, of_resultant = self._of(system, states)
                motion += of_motion @ states.shares
                resultant += of_resultant @ states.shares
            rows = (system.directions, system.pairs)
            self._moved.update({point: (motion[:, i].reshape(rows), resultant[:, i]) for i, point in enumerate(own)})
        return [self._moved[point] for point in points]

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What areas change of the friction."""
        return None if self.pairs is None else self.pairs.bound(system)

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:
        """What it changes of an output through all points, its friction apart."""
        found = 0.0
        for own in of_same_bodies(points, adjoint):
            many = ContactSums.knows(points[own[0]].system, len(own))
            found_at_once = self._by_sums(points, own, adjoint) if many else None
            if found_at_once is None:
                few = len(own) <= _SUBSTITUTED_POINTS and self._by_cells
                found_at_once = (self._by_columns if few else self._by_states)(points, own, adjoint)
            found += found_at_once
        return found

    def _by_columns(self, points: Sequence[TapePoint], own: Sequence[int], adjoint: Adjoint) -> float:
        """What it changes through a few points of the same bodies, by adjoint and actual displacements."""
        columns = columns_of(points, own, adjoint)
        w, u, k = columns.adjoint, columns.displacement, len(columns.one)
        found = 0.0
        if self.pairs is not None:
            forces = columns.forces.reshape(-1, k)
            moved = self.pairs.motions(columns.system, u, forces, columns.one)
            found += float(np.vdot(columns.motion.reshape(-1, k), moved))
            found += float(np.vdot(forces, self.pairs.seen(columns.system, w)))
        for name, f in self.loads.items():
            found += float(f @ (w @ columns.factor(name)))
        return found - self._of_cells(own, adjoint, columns)

    @cached_property
    def _by_cells(self) -> bool:
        """Whether cells tell what moving their nodes changes of the work of their stresses."""
        model = self.prepared.model
        return (
            self.motion is not None
            and not model.foundations
            and all(group.formulation == "standard" for group in straining_groups(self.prepared.space, model))
        )

    def _of_cells(self, own: Sequence[int], adjoint: Adjoint, sums: ByPlaces) -> float:
        """``sum w . K' u`` where nodes move.

        Parameters
        ----------
        own, adjoint : numbers of the points, and the output's way back, which keeps what every node does
        sums : over these points
        """
        assert self.motion is not None
        return float(adjoint.work_by_places(own, [sums]) @ self.motion.ravel())

    def _by_sums(self, points: Sequence[TapePoint], own: Sequence[int], adjoint: Adjoint) -> float | None:
        """What it changes through points of the same bodies; None where pairs see more than their contact nodes."""
        sums, found = ContactSums(points, own, adjoint), 0.0
        if self.pairs is not None:
            system, J, r = sums.system, sums.motion, sums.forces
            rows = system.condensed.active
            B = sp.csr_array(self.pairs.B[np.tile(rows, system.directions)])
            if not sums.meets(B):
                return None
            w, u = sums.on_contact(B)
            found += float(np.vdot(r, w) + np.vdot(J, u) + self.pairs.compliance[:, rows].ravel() @ (J * r).sum(axis=1))
            found += float(J[: system.pairs].sum(axis=1) @ self.pairs.gap[rows])
        for name in self.loads.keys() & sums.weighted.keys():
            found += float(self.loads[name] @ sums.weighted[name])
        if self._by_cells and not len(self.prepared.constraints.dependent):
            return found - self._of_cells(own, adjoint, sums)
        return found - sums.of_stiffness(self.stiffness)

    def _by_states(self, points: Sequence[TapePoint], own: Sequence[int], adjoint: Adjoint) -> float:
        """What it changes through points of the same bodies, by displacements of their states."""
        terms = {i: adjoint.terms[i] for i in own if i in adjoint.terms}
        at_once, found = self.moved([points[i] for i in terms]), 0.0
        for term, (motion, resultant) in zip(terms.values(), at_once, strict=True):
            found += float(np.vdot(term.motion, motion) + term.resultant @ resultant)
        for i in own:
            for states in state_columns([points[i]]) if i in adjoint.pulled else ():
                forces = self._forces(points[i].system, states) @ states.shares
                found += float(adjoint.pulled[i] @ points[i].system.prepared.constraints.on_free(forces[:, 0]))
        return found

    def views(self, view: HistoryView) -> tuple[HistoryView, HistoryView]:
        """What outputs are read from at both sides of the parameter, motions and forces as they are."""
        low, high = (replace(view, model=side.model, space=side.space) for side in (self.low, self.high))
        if self.pairs is not None:
            return replace(low, interface=self.pairs.low), replace(high, interface=self.pairs.high)
        return low, high

    def _forces(self, system: InterfaceSystem, states: StateColumns) -> Any:
        """(dofs, k) ``f' + B'^T r - K' u``, where vectors of all displacements are."""
        forces = -(self.stiffness @ states.displacement)
        for name, f in self.loads.items():
            forces += times(system.prepared.constraints, f, states.factor(name))
        if self.pairs is not None:
            forces += self.pairs.on_bodies(system, states.forces)
        return forces

    def _of(self, system: InterfaceSystem, states: StateColumns) -> tuple[Array, Array]:
        """(d a, k) Motions of the pairs, and (motions, k) resultants."""
        condensed = system.condensed
        load = condensed.reduce(system.prepared.constraints.on_free(self._forces(system, states))).load
        motion = condensed.response.moved(load)
        if self.pairs is not None:
            motion = motion + self.pairs.motions(system, states.displacement, states.forces, states.one)
        return motion, condensed.response.resultant(load)
