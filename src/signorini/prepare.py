# SPDX-License-Identifier: BSD-3-Clause
"""What does not depend on the loads: assembled, checked for free motions and condensed once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.clock import Clock
from signorini.condense.condensed import Condensed, condense
from signorini.errors import InputError
from signorini.fem.loads import nodal_loads
from signorini.fem.rigid import Part, describe_motion, free_motions, make_parts, rigid_motions
from signorini.fem.space import Space, make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.supports import Constraints, make_constraints
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
    condensed : the interface as the contact law sees it
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
    scale: Scale
    clock: Clock


def prepare(model: Model, *, backend: str = "auto", clock: Clock | None = None) -> Prepared:
    """Assemble, check and condense.

    Raises
    ------
    InputError
        If something in the model does not fit the mesh, or a body can move freely: it is named, with its motion;
        or a compliance is so large that contact hardly holds a body.
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
    except np.linalg.LinAlgError as error:
        raise InputError(
            "the compliance of the contacts is so large, or the moduli are so far apart, that contact hardly holds a "
            "body; expected smaller compliances, or supports",
            where=("contact",),
        ) from error
    return Prepared(
        model=model,
        space=space,
        constraints=constraints,
        interface=interface,
        K=K,
        loads=loads,
        parts=parts,
        motions=motions,
        floating=free_motions(motions, constraints, sp.csr_array((0, space.number_of_dofs))),
        condensed=condensed,
        scale=data_scale(model, loads, constraints, interface),
        clock=clock,
    )


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
