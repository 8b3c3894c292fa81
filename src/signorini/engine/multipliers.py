# SPDX-License-Identifier: BSD-3-Clause
"""Contact by multipliers on the bodies as they are, where the condensed interface does not fit or loses its digits.

What a thin body yields to a force is many orders of magnitude more than what it is compressed by; a dense compliance
keeps the digits of the large one. The stiffness of the bodies has both. So where the condensed way finds nothing, and
nothing is proved either, multipliers are iterated with factors of the bodies and the springs of their contacts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.engine.examine import Examined
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.engine.solver import CondensedSolver
from signorini.errors import InputError
from signorini.interface.active import FreeBodies
from signorini.interface.interface import Interface
from signorini.iterative.bodies import Bodies, make_bodies
from signorini.iterative.pairs import IteratedPairs
from signorini.iterative.pressed import IncrementLoad
from signorini.settings import SolverSettings
from signorini.solution.scale import Scale

MAX_ENTRIES = 3_000_000
"""Entries of K: what factors some dozen times within minutes."""

PATIENCE = 30
"""Rounds without progress after which an increment is given up: what converges takes some 20 in all."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MultiplierSolver:
    """The method of multipliers on stiffness and pairs in blocks of nodes.

    Attributes
    ----------
    bodies : stiffness and pairs
    settings : limits of the rounds
    most : conjugate gradients that an increment may take, before bodies are condensed after all
    """

    bodies: IteratedPairs
    settings: SolverSettings
    most: float = np.inf

    @property
    def name(self) -> str:
        """Of the back end, for reports."""
        return self.bodies.name

    @property
    def active(self) -> BoolArray:
        """(n,) Pairs that the law is asked of."""
        return self.bodies.active

    @property
    def held(self) -> BoolArray:
        """(n,) Pairs that supports hold on both sides."""
        return self.bodies.held

    @property
    def paths(self) -> None:
        """None: nothing is condensed."""

    @property
    def condensed(self) -> None:
        """None as well."""

    @property
    def elastic(self) -> MultiplierSolver:
        """Itself."""
        return self

    def under(self, interface: Interface, scale: Scale, absent: BoolArray) -> MultiplierSolver:  # noqa: ARG002
        """Bodies without pairs that are switched off; the law is asked for in every increment.

        Parameters
        ----------
        interface, scale : not looked at
        absent : (n,) pairs that are switched off
        """
        return self.without(absent)

    def without(self, absent: BoolArray) -> MultiplierSolver:
        """Bodies without pairs (n,) that are switched off."""
        return replace(self, bodies=self.bodies.among(~absent)) if absent.any() else self

    def moving(self, ways: Array, interface: Interface, scale: Scale) -> MultiplierSolver:  # noqa: ARG002
        """Itself: multipliers need no springs.

        Parameters
        ----------
        ways, interface, scale : not looked at
        """
        return self

    def paired(self, elastic: CondensedSolver, interface: Interface) -> CondensedSolver:  # noqa: ARG002
        """Bodies with other pairs, see `ContactSolver.paired`: those are they.

        Parameters
        ----------
        elastic : the same bodies with these pairs
        interface : not looked at
        """
        return elastic

    def closing(self, compliance: Array, rest: Array) -> MultiplierSolver:
        """Bodies whose interface closes otherwise along its normals.

        Parameters
        ----------
        compliance, rest : (n,) length per force, and what it has closed without force, length
        """
        own = self.bodies.pairs
        return replace(self, bodies=self.bodies.closing(compliance[own], rest[own]))

    def solve(self, increment: Increment) -> IncrementAnswer:
        """Solve one increment, from an answer near it or from as far ahead of the state as the last increment led."""
        state, last, near = increment.state, increment.last, increment.near
        scale = increment.system.scale
        if near is not None:
            return self.solve_near(increment, near.free, near.forces, scale.length)
        (u, _), r = state.nodal, state.forces
        if last is not None:
            u, r = 2.0 * u - last.nodal[0], 2.0 * r - last.forces
        return self.solve_near(increment, increment.system.constraints.free_of(u), r, scale.length)

    def solve_near(self, increment: Increment, free: Array, forces: Array, length: float) -> IncrementAnswer:
        """Solve one increment.

        Parameters
        ----------
        free, forces : (z,) displacements and (d, n) forces of the pairs near which the answer may be
        length : to whose digits motions are wanted
        """
        bodies, own, system = self.bodies, self.bodies.pairs, increment.system
        load = IncrementLoad(
            f=increment.f,
            offset=bodies.rested(increment.offset[:, own]),
            bound=system.interface.bound.among(np.isin(np.arange(len(bodies.active)), own)),
            force=system.scale.force,
            length=length,
            tolerance=max(self.settings.tolerance, increment.allowed_lack),
            rounds=self.settings.multiplier_rounds,
            most=self.most,
            floating=increment.floating,
        )
        with increment.clock.phase("complementarity"):
            found, near = bodies.answered(load, free, forces[:, own])
        carried, moved = np.zeros_like(increment.offset), np.zeros_like(increment.offset)
        carried[:, own], moved[:, own] = found.r, found.h
        return IncrementAnswer(
            outcome=found.outcome,
            message=found.message,
            forces=carried,
            moved=moved,
            free=near,
            status=found.state[~bodies.tied],
            trace=found.trace,
            lost=found.residual * length,
        )


def make_multipliers(
    examined: Examined, K: sp.csr_array, B: sp.csr_array, candidates: BoolArray, settings: SolverSettings
) -> MultiplierSolver:
    """Put bodies and pairs into blocks.

    Parameters
    ----------
    examined : the model
    K : (z, z) stiffness of the free displacements
    B : (d n, z) relative displacements of the pairs in terms of them
    candidates : (n,) pairs that may touch
    settings : limits of the rounds

    Raises
    ------
    InputError
        If a section of the friction cone is no circle.
    """
    T, d, interface = examined.constraints.transform, examined.space.components, examined.interface
    refuse_sections(interface)
    bodies = make_bodies(
        FreeBodies(K, B, examined.constraints.nodes, examined.space.mesh.points),
        interface,
        examined.constraints.leaders % d,
        rigid=sp.csr_array(T.T @ examined.motions),
        candidates=candidates,
    )
    return MultiplierSolver(bodies=bodies, settings=settings)


def with_factors(solver: MultiplierSolver, nodes: IntArray, points: Array, patience: int) -> MultiplierSolver:
    """Bodies of this process with factors in place of multigrid.

    Parameters
    ----------
    solver : on them
    nodes, points, patience : see `Bodies.factored`
    """
    assert isinstance(solver.bodies, Bodies)
    return replace(solver, bodies=solver.bodies.factored(nodes, points, patience=patience))


def refuse_sections(interface: Interface) -> None:
    """Refuse friction cones whose section is no circle.

    Raises
    ------
    InputError
        The first contact with one.
    """
    if interface.facets.any() or (interface.anisotropy != 1.0).any():
        i = int(interface.contact[np.argmax((interface.facets > 0) | (interface.anisotropy != 1.0).any(axis=1))])
        raise InputError(
            "two coefficients and facets need the condensed interface, and this model is solved by iteration, because "
            "its factor does not fit or because it was asked for; expected one coefficient and no facets",
            where=("contact", i),
        )
