# SPDX-License-Identifier: BSD-3-Clause
"""Bodies as soft as their yielding points make them: stiffness on one pattern, factorised on one plan."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.clock import Clock
from signorini.condense.condensed import condense
from signorini.condense.kept import Kept
from signorini.engine.bond_solver import with_laws
from signorini.engine.condensation import free_bodies
from signorini.engine.examine import Examined
from signorini.engine.multipliers import PATIENCE, make_multipliers
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.interface.active import FreeBodies
from signorini.interface.interface import Interface
from signorini.iterative.bodies import ITERATIVE
from signorini.linalg.one_pattern import on_one_pattern
from signorini.linalg.plan import Plans
from signorini.plasticity.bodies import PlasticResponse, YieldingBodies
from signorini.settings import SolverSettings


@dataclass(frozen=True, eq=False)
class TangentBodies:
    """Makes the bodies of a round.

    Attributes
    ----------
    examined : the model
    yielding : the points of the bodies that yield
    K : (dofs, dofs) elastic stiffness
    stiffness : (z, z) the same on the free displacements
    near : (n,) pairs that the law is asked of
    whole : whether contact is iterated on the bodies as they are
    backend, settings : of the factorisation and the methods
    plans : the plan of the factorisation, made once, with the elastic bodies if they have the pattern
    """

    examined: Examined
    yielding: YieldingBodies
    K: sp.csr_array
    stiffness: sp.csr_array
    near: BoolArray
    whole: bool
    backend: str
    settings: SolverSettings
    plans: Plans

    @cached_property
    def _patterns(self) -> tuple[sp.csr_array, sp.csr_array, sp.csc_array]:
        """Once for all tangents, where there is any.

        Pattern (dofs, dofs) of what yielding takes off; `stiffness` on a pattern (z, z) that holds what that is there,
        and (entries of the one, entries of the other) what takes it there.
        """
        rows = self.yielding.rows()
        return rows, *on_one_pattern(self.stiffness, rows, self.examined.constraints.transform)

    def paired(self, interface: Interface) -> TangentBodies:
        """Tangents of the same bodies with other pairs, as many and in the same order: sides have slid."""
        made = replace(self, examined=replace(self.examined, interface=interface))
        made.__dict__["_patterns"] = self._patterns  # those of the bodies, whatever their pairs
        return made

    @cached_property
    def bodies(self) -> FreeBodies:
        """With the elastic stiffness."""
        return free_bodies(self.examined, self.stiffness)

    @cached_property
    def kept(self) -> Kept:
        """What is kept of the bodies for the pairs."""
        return Kept.of(self.bodies, self.examined.interface, self.near)

    @cached_property
    def rigid(self) -> Array:
        """(z, k) Rigid motions that neither supports nor ties resist."""
        examined = self.examined
        return np.asarray((examined.motions @ examined.floating)[examined.constraints.leaders], dtype=np.float64)

    @cached_property
    def diagonal(self) -> Array:
        """(z,) Of the elastic stiffness."""
        return np.asarray(self.stiffness.diagonal(), dtype=np.float64)

    def softened(self, at: PlasticResponse, left: float) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
        """What yielding takes off, (dofs, dofs), and what is left of the stiffness, (dofs, dofs) and (z, z).

        Parameters
        ----------
        at : what the tangent is made at
        left : part of the elastic law that yielding leaves in place, 0 .. 1
        """
        data, (rows, wide, gather) = self.yielding.softening(at, left), self._patterns
        S = sp.csr_array((data, rows.indices, rows.indptr), shape=rows.shape)
        reduced = sp.csr_array((wide.data - gather @ data, wide.indices, wide.indptr), shape=wide.shape)
        return S, self.K - S, reduced

    def solver(self, reduced: sp.csr_array, clock: Clock) -> ContactSolver:
        """Contact on bodies of a stiffness (z, z) on the pattern of all tangents; ``clock`` counts the seconds.

        Raises
        ------
        NotPositiveDefinite
            If the bodies are so soft that something moves without resistance.
        LinAlgError
            If contact hardly holds a body.
        """
        examined, settings = self.examined, self.settings
        if self.whole:
            found = make_multipliers(examined, reduced, self.bodies.B, self.near, settings)
            found = replace(found, bodies=replace(found.bodies, patience=PATIENCE))
            return with_laws(found, examined) if examined.has_laws else found
        scale = examined.scale
        condensed = condense(
            self.bodies._replace(K=reduced),
            examined.interface,
            kept=self.kept,
            rigid=self.rigid,
            stiffness=scale.stiffness,
            backend="auto" if self.backend == ITERATIVE else self.backend,
            clock=clock,
            plans=self.plans,
        )
        made = CondensedSolver.of(condensed, examined.interface, scale, settings)
        return with_laws(made, examined) if examined.has_laws else made

    def substitution_share(self, solver: ContactSolver, operations: float) -> float | None:
        """Price of a round on the factor at hand over that of one on a new factor; None: not known, or in the plane.

        Parameters
        ----------
        solver : with the factor
        operations : that take as long as to move an entry of the factor through memory in one round
        """
        paths = solver.paths
        if paths is None or self.examined.space.dimension == 2:
            return None
        plan = paths.condensed.factorisation.plan
        if plan is None:
            return None
        kept = operations * plan.nnz_factor
        return kept / (kept + plan.flops)
