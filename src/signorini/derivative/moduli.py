# SPDX-License-Identifier: BSD-3-Clause
"""What the modulus of a body changes at once where it is a block of its own of the condensed bodies.

Its displacements under forces are as 1 / E then, so that neither its stiffness nor a substitution into it is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.condense.response import ByNodes
from signorini.derivative.adjoint_terms import Adjoint, BoundTerm
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.modulus_pairs import ModulusPairs
from signorini.derivative.pair_change import PairChange, between_bodies
from signorini.derivative.points import TapePoint, factors_of, forces_of, offsets_of
from signorini.derivative.view import HistoryView, displacement_at
from signorini.engine.prepare import Prepared
from signorini.sparse_rows import chosen_columns, chosen_rows, seen_by


@dataclass(frozen=True, kw_only=True, eq=False)
class _Moved:
    """What a modulus moves at points of one system.

    Attributes
    ----------
    numbers : (p,) of the points, rising
    motion, resultant : (p, d a) and (p, k) motions of the pairs and resultants of loads
    """

    numbers: IntArray
    motion: Array
    resultant: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class ModulusChange:
    """Young's modulus of one body grows, which is a block of its own of the condensed bodies.

    Attributes
    ----------
    prepared : the model
    body : number of the body
    seen : what moduli change of the pairs of the model
    """

    prepared: Prepared
    body: int
    seen: ModulusPairs

    @staticmethod
    def knows(prepared: Prepared, body: int) -> bool:
        """Whether the body is a block of its own: condensed by nodes, and neither tied, linked nor on foundations."""
        name = prepared.model.bodies[body].name
        linked = prepared.model.couples or bool(prepared.interface.tied.any()) or bool(prepared.constraints.springs)
        shared = any(name in part.bodies and len(part.bodies) > 1 for part in prepared.parts)
        return isinstance(prepared.paths.condensed.response, ByNodes) and not linked and not shared

    @cached_property
    def modulus(self) -> float:
        """Young's modulus, force per area."""
        return self.prepared.model.bodies[self.body].material.smallest_modulus

    @property
    def pairs(self) -> PairChange:
        """What it changes of the pairs: normals of tilted sides lie nearer to the stiffer one."""
        return self.seen.of(self.body)

    @property
    def step(self) -> float:
        """Half of what the modulus differs by between both sides."""
        return self.seen.step(self.body)

    def views(self, view: HistoryView) -> tuple[HistoryView, HistoryView]:
        """What outputs are read from at both sides of the modulus, motions and forces as they are."""
        low, high = (replace(view, model=model) for model in self.seen.models(self.body))
        if self.tilts:
            return replace(low, interface=self.pairs.low), replace(high, interface=self.pairs.high)
        return low, high

    @cached_property
    def tilts(self) -> bool:
        """Whether it changes any pair: not where only obstacles lie opposite the meshed sides."""
        return between_bodies(self.prepared.model) and self.pairs.any

    def bound(self, system: InterfaceSystem) -> BoundTerm | None:
        """What areas change of the friction."""
        return self.pairs.bound(system) if self.tilts else None

    def moved(self, points: Sequence[TapePoint]) -> list[tuple[Array, Array]]:
        """Motions of the pairs and resultants."""
        found: dict[int, tuple[Array, Array]] = {}
        for system in dict.fromkeys(point.system for point in points):
            known = self._at(system, points)
            for i, motion, resultant in zip(known.numbers, known.motion, known.resultant, strict=True):
                found[int(i)] = motion.reshape(system.directions, -1), resultant
        return [found[i] for i in range(len(points))]

    def _at(self, system: InterfaceSystem, points: Sequence[TapePoint]) -> _Moved:
        """What it moves at those of the points that are of a system; kept for the last points asked for."""
        if self._kept.get(system, (None,))[0] is not points:
            numbers = np.array([i for i, point in enumerate(points) if point.system is system])
            own = [points[i] for i in numbers]
            motion, resultant = self._by_forces(system, own), np.zeros((system.motions, len(numbers)))
            if self.tilts:
                motion += self._by_pairs(system, own)
                resultant = _response(system).rigid.T @ self._on_contact(system, forces_of(own))
            self._kept[system] = points, _Moved(numbers=numbers, motion=motion.T.copy(), resultant=resultant.T.copy())
        return self._kept[system][1]

    @cached_property
    def _kept(self) -> dict[InterfaceSystem, tuple[Sequence[TapePoint], _Moved]]:
        """Of systems so far, see `_at`."""
        return {}

    def total(self, points: Sequence[TapePoint], adjoint: Adjoint) -> float:
        """What it changes of an output through all points, its friction apart."""
        found = -sum(float(y @ self._on_body(points[i])) for i, y in adjoint.pulled.items()) / self.modulus
        for stack in adjoint.stacks:
            system, known = stack.system, self._at(stack.system, points)
            rows = np.searchsorted(known.numbers, stack.numbers)
            found += float(np.vdot(stack.motion.reshape(len(rows), -1), known.motion[rows]))
            found += float(np.vdot(stack.resultant, known.resultant[rows]))
            for i in set(stack.numbers) & set(adjoint.pulled) if self.tilts else ():
                forces = (system.root * points[i].r).reshape(-1, 1)
                found += float(adjoint.pulled[i][system.condensed.dofs] @ self._on_contact(system, forces)[:, 0])
        return found

    def _on_body(self, point: TapePoint) -> Array:
        """(z,) Elastic forces of the body at a point that do not grow with its modulus."""
        prepared = point.system.prepared
        forces = prepared.K @ displacement_at(point)
        for load in prepared.model.loads:
            if load.temperature is not None:
                forces = forces - point.load.factors.get(load.label, 0.0) * prepared.loads[load.label]
        inside = np.zeros(prepared.space.number_of_dofs, dtype=np.bool_)
        inside[prepared.space.dofs(np.flatnonzero(self._nodes))] = True
        return prepared.constraints.on_free(np.where(prepared.constraints.placed(inside), forces, 0.0))

    @cached_property
    def _nodes(self) -> BoolArray:
        """(nodes,) Those of the body."""
        model, cells = self.prepared.model, self.prepared.model.body_of_cells()
        inside = np.zeros(model.mesh.number_of_nodes, dtype=np.bool_)
        for block in self.prepared.space.blocks:
            inside[block.cells[cells[block.first : block.first + len(block.cells)] == self.body]] = True
        return inside

    def _by_forces(self, system: InterfaceSystem, points: Sequence[TapePoint]) -> Array:
        """(d a, p) Motions of the pairs at points of one system: what yields to forces yields less."""
        heats = {load.label for load in self.prepared.model.loads if load.temperature is not None}
        names, factors = factors_of(points)
        response, own = _response(system), self._own(system)
        load = response.B.T @ forces_of(points)
        for name, factor in zip(names, factors, strict=True):
            if name not in heats:
                load += np.outer(system.unit(name).fixed, factor)
        return np.asarray(-(response.B[:, own] @ response.parts.solve(load)[own]) / self.modulus)

    def _by_pairs(self, system: InterfaceSystem, points: Sequence[TapePoint]) -> Array:
        """(d a, p) Motions of the pairs at the displacements of the bodies, seen otherwise, and under other loads."""
        rows, pairs, response, forces = system.condensed.active, self.pairs, _response(system), forces_of(points)
        prescribed, (names, factors) = system.prepared.constraints.prescribed, factors_of(points)
        load = response.B.T @ forces
        for name, factor in zip(names, factors, strict=True):
            load += np.outer(system.unit(name).load, factor)
        x = response.parts.solve(load)
        if system.motions:
            h = np.stack([(point.h / system.root).ravel() for point in points], axis=-1)
            offset = offsets_of(points).reshape(len(points), -1).T
            left = h - system.condensed.compliance.ravel()[:, None] * forces - offset - response.B @ x
            x = x + response.rigid @ system.condensed.travel(left)
        moved = self._on_dofs(system) @ x
        for name, factor in zip(names, factors, strict=True):
            if name in prescribed:
                moved += np.outer(seen_by(pairs.B, prescribed[name])[np.tile(rows, system.directions)], factor)
        moved[: system.pairs] += pairs.gap[rows][:, None]
        moved += pairs.compliance[:, rows].ravel()[:, None] * forces
        return np.asarray(moved + response.B @ response.parts.solve(self._on_contact(system, forces)))

    def _on_contact(self, system: InterfaceSystem, forces: Array) -> Array:
        """(m, p) Loads on the contact dofs that forces (d a, p) of the pairs are otherwise."""
        return np.asarray(self._on_dofs(system).T @ forces)

    def _on_dofs(self, system: InterfaceSystem) -> sp.csr_array:
        """(d a, m) What the modulus changes of the motions of the active pairs per displacement of the contact dofs."""
        if system not in self._seen:
            rows = np.flatnonzero(np.tile(system.condensed.active, system.directions))
            B = self.prepared.constraints.in_free(chosen_rows(self.pairs.B, rows))
            self._seen[system] = chosen_columns(B, system.condensed.dofs)
        return self._seen[system]

    @cached_property
    def _seen(self) -> dict[InterfaceSystem, sp.csr_array]:
        """Of systems so far, see `_on_dofs`."""
        return {}

    def _own(self, system: InterfaceSystem) -> BoolArray:
        """(m,) Contact dofs of the body."""
        nodes = self.prepared.constraints.nodes[system.condensed.dofs]
        return np.append(self._nodes, False)[np.minimum(nodes, len(self._nodes))]


def _response(system: InterfaceSystem) -> ByNodes:
    response = system.condensed.response
    assert isinstance(response, ByNodes)
    return response
