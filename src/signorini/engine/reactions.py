# SPDX-License-Identifier: BSD-3-Clause
"""What supports, elastic foundations, obstacles and rigid bodies bear, and how these move."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signorini.arrays import Array, IntArray, distinct, frozen
from signorini.fem.obstacles import arm
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.model.links import directions
from signorini.model.model import Model
from signorini.solution.obstacle_result import ObstacleMotion, ObstacleResult
from signorini.sparse_rows import chosen_columns


def reactions(
    model: Model, space: Space, constraints: Constraints, displacement: Array, held: Array
) -> dict[str, Array]:
    """Forces of supports and elastic foundations on the bodies, by name.

    Parameters
    ----------
    model, space, constraints : of the bodies
    displacement : (dofs,) length
    held : (dofs,) forces of supports, all together
    """
    owner, d = constraints.owner, model.components
    rigid = {body.name: j for j, body in enumerate(model.rigid_bodies, start=len(model.obstacles))}
    own = np.flatnonzero(owner >= 0)
    total = np.zeros((len(model.supports), d))
    np.add.at(total, (owner[own], own % d), held[own] * space.arms_at(own))
    forces = {}
    for i, support in enumerate(model.supports):
        forces[support.label] = frozen(total[i])
        if (j := rigid.get(str(support.on))) is not None:
            dofs, size = rigid_dofs(model, space, j)
            forces[support.label] = frozen(np.where(owner[dofs] == i, held[dofs] * size, 0.0))
    for name, S in constraints.springs.items():
        seen = distinct(S.indices)
        near, borne = chosen_columns(S, seen), np.zeros(d)
        np.add.at(borne, seen % d, -(near.T @ (near @ displacement[seen])) * space.arms_at(seen))
        forces[name] = frozen(borne)
    return forces


def rigid_dofs(model: Model, space: Space, j: int) -> tuple[IntArray, Array]:
    """Dofs of a rigid body, and what their forces are multiplied by to be forces and moments.

    Parameters
    ----------
    model, space : of the bodies
    j : its number, obstacles first
    """
    d = model.dimension
    dofs = space.obstacle_dofs(j)[: len(directions(d))]
    return dofs, np.where(np.arange(len(dofs)) < d, 1.0, arm(model))


def rigid_result(model: Model, space: Space, j: int, displacement: Array, force: Array) -> ObstacleResult:
    """The motion of the rigid body j, obstacles first, and what acts on it from outside.

    Parameters
    ----------
    model, space : of the bodies
    j : its number
    displacement, force : (dofs,) of all dofs
    """
    d = model.dimension
    dofs, size = rigid_dofs(model, space, j)
    acting = force[dofs] * size
    motion = _motion(model, space, j, displacement)
    return ObstacleResult(**vars(motion), force=frozen(acting[:d]), moment=_number(acting[d:]))


def rigid_motions(model: Model, space: Space, displacement: Array) -> Mapping[str, ObstacleMotion]:
    """The motions of moving obstacles, then of rigid bodies, by name.

    Parameters
    ----------
    model, space : of the bodies
    displacement : (dofs,) of all dofs
    """
    return {name: _motion(model, space, j, displacement) for j, name in enumerate(rigid_names(model))}


def rigid_names(model: Model) -> list[str]:
    """Names of the moving obstacles, then of the rigid bodies: the order of their dofs.

    Parameters
    ----------
    model : with them
    """
    return [obstacle.name for obstacle in model.obstacles] + [body.name for body in model.rigid_bodies]


def _motion(model: Model, space: Space, j: int, displacement: Array) -> ObstacleMotion:
    """The motion of the rigid body j, obstacles first, from displacements (dofs,)."""
    d = model.dimension
    dofs, size = rigid_dofs(model, space, j)
    motion = displacement[dofs] / size
    return ObstacleMotion(displacement=frozen(motion[:d]), rotation=_number(motion[d:]))


def _number(values: Array) -> float | Array:
    """One value as a number."""
    return float(values[0]) if len(values) == 1 else frozen(values)
