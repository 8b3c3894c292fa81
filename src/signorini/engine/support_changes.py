# SPDX-License-Identifier: BSD-3-Clause
"""Supports that steps release, and that hold again: other free displacements, and what goes on from there."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.engine.condensation import closed
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.errors import InputError
from signorini.fem.supports import Constraints
from signorini.model.model import Model
from signorini.model.stage import Stage, Standing
from signorini.solution.state import LoadPoint, State

_PLACE_TOL = 1e-9  # of the largest displacement: what compilers of other machines may change in it


def handed_over(prepared: Prepared, before: Constraints, state: State) -> State:
    """The state under the supports of a step, where they are not those of the step before.

    What a support that lets go bears becomes a given force on the bodies, which the step takes to zero. What holds
    again, or another support holds, is where it is: beyond what the support prescribes there is an offset.

    Parameters
    ----------
    prepared : under the supports of the step
    before : those of the step before
    state : at its end
    """
    now = prepared.constraints
    # at the end of a step nothing is left of what supports bore that it released
    point = state.point.changed(reaction=np.zeros(0), offset=np.zeros(0))
    (loads, imposed), (u, external), (_, last) = applied(prepared, point), state.nodal, state.point.left
    was, held = before.held, now.held
    reaction = np.where(was & ~held, before.support_forces(external - loads), 0.0)
    other = held & ((now.owner != before.owner) | ~was)
    offset = np.where(other, u - imposed, np.where(held, last if len(last) else now.zeros, 0.0))
    return state.changed(point=state.point.changed(reaction=reaction, offset=completed(prepared, offset)))


def locks_bolts(model: Model, before: Standing, after: Standing) -> bool:
    """Whether supports change from step to step by nothing but bolts that lock, which a force has tightened.

    Parameters
    ----------
    model : with what its bolts stand for
    before, after : what stands in a step and the next
    """
    held = before.released - after.released
    return after.released < before.released and held <= {bolt.label for bolt in model.bolts if bolt.force is not None}


def refuse_moved(prepared: Prepared, state: State) -> None:
    """A state under other prescribed displacements than those that it has is no beginning.

    Parameters
    ----------
    prepared : under the supports of the state

    Raises
    ------
    InputError
        The first place that is held elsewhere, and the support that holds it.
    """
    constraints, u = prepared.constraints, state.displacement
    imposed = applied(prepared, state.point)[1]
    off = np.where(constraints.held, np.abs(u - imposed), 0.0)
    if off.max(initial=0.0) <= _PLACE_TOL * max(np.abs(u).max(initial=0.0), np.abs(imposed).max(initial=0.0)):
        return
    dof = int(np.argmax(off))
    model, (node, axis) = prepared.model, divmod(dof, prepared.model.components)
    of_mesh = node < model.mesh.number_of_nodes
    at = f"node {model.mesh.labels[node]}" if of_mesh else "an obstacle or rigid body"
    owner = constraints.owner[dof]
    by = f"support '{model.supports[owner].label}'" if owner >= 0 else "the model"
    raise InputError(
        f"has moved {at} by {u[dof]:.6g} in {model.axes[axis]}, where {by} prescribes {imposed[dof]:.6g}; expected "
        "supports and obstacles that prescribe the same. A step's scale changes it",
        where=("start",),
    )


def at_the_end(prepared: Prepared, stage: Stage, point: LoadPoint) -> tuple[Array, Array]:
    """Given forces and offsets (dofs,) at the end of a step that begins with some: supports that restore have none.

    Parameters
    ----------
    prepared : under the supports of the step
    stage : the step
    point : of the load history at its beginning
    """
    labels = [support.label for support in prepared.model.supports]
    constraints, (reaction, offset) = prepared.constraints, point.left
    kept = np.where(constraints.held, offset, 0.0)
    for name in stage.step.restore:
        kept = np.where(constraints.owner == labels.index(name), 0.0, kept)
    return np.zeros_like(reaction), completed(prepared, kept)


def completed(prepared: Prepared, offset: Array) -> Array:
    """Offsets (dofs,) of held dofs, and with them what equations and ties make of them.

    Parameters
    ----------
    prepared : under supports that hold them
    offset : (dofs,) length, 0 of dofs that are not held
    """
    completed = prepared.constraints.completed(offset)
    paths = prepared.solver.paths
    ties = None if paths is None else paths.condensed.ties
    return completed if ties is None else closed(prepared, ties, completed)
