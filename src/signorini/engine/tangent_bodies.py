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
from signorini.engine.examine import Examined
from signorini.engine.multipliers import PATIENCE, make_multipliers
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.interface.active import FreeBodies
from signorini.iterative.bodies import ITERATIVE
from signorini.linalg.multifrontal import MultifrontalFactorisation
from signorini.linalg.one_pattern import on_one_pattern
from signorini.linalg.plan import Plans
from signorini.plasticity.bodies import PlasticResponse, YieldingBodies
from signorini.settings import SolverSettings


@dataclass(frozen=True, kw_only=True, eq=False)
class TangentBodies:
    """Makes the bodies of a round.

    Attributes
    ----------
    examined : the model
    yielding : the points of the bodies that yield
    K : (dofs, dofs) elastic stiffness
    reduced : (z, z) the same on the free displacements, on the pattern of all tangents
    B : (d n, z) relative displacements of the pairs
    rows : (dofs, dofs) pattern of what yielding takes off
    gather : (entries of `reduced`, entries of `rows`) takes the one from the other
    near : (n,) pairs that the law is asked of
    whole : whether contact is iterated on the bodies as they are
    backend, settings : of the factorisation and the methods
    plans : the plan of the factorisation, made once, with the elastic bodies if they have the pattern
    """

    examined: Examined
    yielding: YieldingBodies
    K: sp.csr_array
    reduced: sp.csr_array
    B: sp.csr_array
    rows: sp.csr_array
    gather: sp.csc_array
    near: BoolArray
    whole: bool
    backend: str
    settings: SolverSettings
    plans: Plans

    @staticmethod
    def of(
        examined: Examined,
        K: sp.csr_array,
        reduced: sp.csr_array,
        yielding: YieldingBodies,
        near: BoolArray,
        whole: bool,
        backend: str,
        settings: SolverSettings,
        plans: Plans,
    ) -> TangentBodies:
        """Patterns, once for all tangents.

        Parameters
        ----------
        examined : the model
        K, reduced : (dofs, dofs) elastic stiffness, and (z, z) the same on the free displacements
        yielding : the points of the bodies that yield
        near : (n,) pairs that the law is asked of
        whole : whether contact is iterated on the bodies as they are
        backend, settings, plans : of the factorisation and the methods
        """
        T = examined.constraints.transform
        rows = yielding.rows()
        reduced, gather = on_one_pattern(reduced, rows, T)
        return TangentBodies(
            examined=examined,
            yielding=yielding,
            K=K,
            reduced=reduced,
            B=sp.csr_array(examined.interface.B @ T),
            rows=rows,
            gather=gather,
            near=near,
            whole=whole,
            backend="auto" if backend == ITERATIVE else backend,
            settings=settings,
            plans=plans,
        )

    @cached_property
    def bodies(self) -> FreeBodies:
        """With the elastic stiffness."""
        constraints, space = self.examined.constraints, self.examined.space
        return FreeBodies(self.reduced, self.B, constraints.nodes, space.places)

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
        return np.asarray(self.reduced.diagonal(), dtype=np.float64)

    def softened(self, at: PlasticResponse, left: float) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
        """What yielding takes off, (dofs, dofs), and what is left of the stiffness, (dofs, dofs) and (z, z).

        Parameters
        ----------
        at : what the tangent is made at
        left : part of the elastic law that yielding leaves in place, 0 .. 1
        """
        data, rows = self.yielding.softening(at, left), self.rows
        S = sp.csr_array((data, rows.indices, rows.indptr), shape=rows.shape)
        softer = self.reduced.data - self.gather @ data
        reduced = sp.csr_array((softer, self.reduced.indices, self.reduced.indptr), shape=self.reduced.shape)
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
            found = make_multipliers(examined, reduced, self.B, self.near, settings)
            return replace(found, bodies=replace(found.bodies, patience=PATIENCE))
        scale = examined.scale
        condensed = condense(
            self.bodies._replace(K=reduced),
            examined.interface,
            kept=self.kept,
            rigid=self.rigid,
            stiffness=scale.stiffness,
            backend=self.backend,
            clock=clock,
            plans=self.plans,
        )
        return CondensedSolver.of(condensed, examined.interface, scale, settings)

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
        factor = paths.condensed.factorisation
        if not isinstance(factor, MultifrontalFactorisation):
            return None
        kept = operations * factor.plan.nnz_factor
        return kept / (kept + factor.plan.flops)
