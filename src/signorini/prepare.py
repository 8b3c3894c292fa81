# SPDX-License-Identifier: BSD-3-Clause
"""What does not depend on the loads: assembled, checked for free motions and condensed once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, frozen
from signorini.checks import number
from signorini.clock import Clock
from signorini.condense.condensed import Condensed, condense
from signorini.errors import InputError, one_of
from signorini.fem.loads import nodal_loads
from signorini.fem.rigid import Part, describe_motion, free_motions, make_parts, rigid_motions
from signorini.fem.space import Space, make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.supports import Constraints, make_constraints
from signorini.friction.problem import CoulombProblem
from signorini.interface.interface import Interface, make_interface
from signorini.linalg.protocol import NotPositiveDefinite
from signorini.model.model import Model
from signorini.solution.scale import Scale, data_scale


@dataclass(frozen=True, kw_only=True, eq=False)
class Prepared:
    """A model ready for any load.

    Attributes
    ----------
    K : (dofs, dofs) stiffness, supports not applied
    loads : name to nodal forces at factor 1, each (dofs,)
    parts, motions : connected pieces and their rigid motions, (dofs, 3 parts)
    floating : (3 parts, k) rigid motions that supports leave free and contact must hold
    condensed : the interface as the bodies feel it
    law : the contact law on it, without load; ``dataclasses.replace(law, b=...)`` shares what it has computed
    scale : sizes from the data
    clock : seconds spent so far
    """

    model: Model
    space: Space
    constraints: Constraints
    interface: Interface
    K: sp.csr_array
    loads: Mapping[str, Array]
    parts: tuple[Part, ...]
    motions: sp.csr_array
    floating: Array
    condensed: Condensed
    law: CoulombProblem
    scale: Scale
    clock: Clock

    def changed(
        self,
        *,
        friction: Mapping[str, float] | None = None,
        interference: Mapping[str, float] | None = None,
        loads: Mapping[str, float] | None = None,
    ) -> Prepared:
        """The same bodies under another law or load; nothing is factorised again.

        Parameters
        ----------
        friction : contact to Coulomb's coefficient
        interference : contact to its overlap beyond the geometry, length
        loads : load or moving support to what its value is multiplied by

        Raises
        ------
        InputError
            For an unknown name, a wrong value, or a body that is left with nothing but frictionless contact.
        """
        contacts = list(self.model.contacts)
        _refuse_unknown(friction, [c.label for c in contacts], "contact", "friction")
        _refuse_unknown(interference, [c.label for c in contacts], "contact", "interference")
        _refuse_unknown(loads, self.model.scaled_names, "load or moving support", "loads")
        gap = self.interface.gap.copy()
        for i, contact in enumerate(contacts):
            if friction is not None and contact.label in friction:
                contacts[i] = replace(contacts[i], friction=friction[contact.label])
            if interference is not None and contact.label in interference:
                contacts[i] = replace(contacts[i], interference=interference[contact.label])
                gap[self.interface.contact == i] += contact.interference - contacts[i].interference
        factor = {name: number(value, ("loads", name)) for name, value in (loads or {}).items()}
        mu = np.array([contact.coefficient for contact in contacts], float)[self.interface.contact]
        interface = replace(self.interface, gap=gap, friction=mu)
        constraints = replace(
            self.constraints,
            prescribed={name: factor.get(name, 1.0) * u for name, u in self.constraints.prescribed.items()},
        )
        forces = {name: factor.get(name, 1.0) * f for name, f in self.loads.items()}
        _refuse_free_motions(self.space, constraints, interface, self.parts, self.motions)
        model = replace(self.model, contacts=contacts)
        scale = data_scale(model, forces, constraints, interface)
        return replace(
            self,
            model=model,
            interface=interface,
            constraints=constraints,
            loads=forces,
            scale=scale,
            law=replace(
                self.law,
                friction=interface.friction[self.condensed.active],
                scale=scale.length * float(self.condensed.root.max(initial=1.0)),
            ),
            clock=Clock(),
        )


def prepare(model: Model, *, backend: str = "auto", clock: Clock | None = None) -> Prepared:
    """Assemble, check and condense.

    Raises
    ------
    InputError
        If something in the model does not fit the mesh, or a body can move freely: it is named, with its motion.
    """
    clock = clock or Clock()
    with clock.phase("assembly"):
        space = make_space(model.mesh)
        constraints = make_constraints(space, model)
        loads = nodal_loads(space, model)
        interface = make_interface(space, model, constraints)
        parts = make_parts(space, model)
        motions = rigid_motions(space, parts)
        _refuse_free_motions(space, constraints, interface, parts, motions)
        K = stiffness(space, model)
        T = constraints.transform
        reduced, relative = sp.csr_array(T.T @ K @ T), sp.csr_array(interface.B @ T)
    try:
        condensed = condense(reduced, relative, interface, constraints.nodes, backend=backend, clock=clock)
    except NotPositiveDefinite as error:
        raise _singular(model, constraints, parts, error) from error
    scale = data_scale(model, loads, constraints, interface)
    floating = free_motions(motions, constraints, sp.csr_array((0, space.number_of_dofs)))
    return Prepared(
        model=model,
        space=space,
        constraints=constraints,
        interface=interface,
        K=K,
        loads=loads,
        parts=parts,
        motions=motions,
        floating=floating,
        condensed=condensed,
        law=_law(interface, condensed, interface.B @ motions @ floating, scale),
        scale=scale,
        clock=clock,
    )


def _law(interface: Interface, condensed: Condensed, floating: Array, scale: Scale) -> CoulombProblem:
    """The contact law of the active pairs, with no load yet; floating (2 n, k) rigid motions as the pairs see them."""
    rows = condensed.active_rows
    return CoulombProblem(
        W=frozen(condensed.W),
        b=np.zeros(len(rows)),
        friction=interface.friction[condensed.active],
        motions=condensed.root[:, None] * floating[rows],
        scale=scale.length * float(condensed.root.max(initial=1.0)),
    )


def _refuse_unknown(given: Mapping[str, float] | None, known: Sequence[str], what: str, key: str) -> None:
    for name in given or {}:
        if name not in known:
            raise InputError(one_of(name, known, what), where=(key,))


def _refuse_free_motions(
    space: Space, constraints: Constraints, interface: Interface, parts: tuple[Part, ...], motions: sp.csr_array
) -> None:
    """A motion that neither supports nor contact can resist has no place that a solver could find."""
    nodes = np.unique(np.concatenate([interface.node, interface.partner[interface.partner >= 0]]))
    dofs = space.dofs(nodes).ravel()
    touching = sp.csr_array((np.ones(len(dofs)), (np.arange(len(dofs)), dofs)), (len(dofs), space.number_of_dofs))
    free = free_motions(motions, constraints, touching)
    if free.shape[1]:
        raise InputError(f"{_say(parts, free)}: no support or contact holds it; add a support")
    resisting = interface.B[np.concatenate([np.ones(len(interface), bool), interface.friction > 0])]
    free = free_motions(motions, constraints, resisting)
    if free.shape[1]:
        raise InputError(
            f"{_say(parts, free)}: nothing but frictionless contact, which cannot resist; add a support or friction"
        )


def _say(parts: tuple[Part, ...], motions: Array) -> str:
    return ", and ".join(describe_motion(parts, motion) for motion in motions.T)


def _singular(
    model: Model, constraints: Constraints, parts: tuple[Part, ...], error: NotPositiveDefinite
) -> InputError:
    node = constraints.nodes[error.dof]
    label = next(part.label for part in parts if node in part.nodes)
    at = tuple(float(x) for x in model.mesh.points[node].round(6))
    return InputError(
        f"{label} has no stiffness against some motion of node {node + 1} at {at}, though no rigid motion is free; "
        "expected cells that are joined by edges (a hinge at a single node?) and moduli that are not extremely apart"
    )
