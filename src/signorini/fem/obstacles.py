# SPDX-License-Identifier: BSD-3-Clause
"""Unknowns of moving rigid obstacles: two nodes behind those of the mesh, one to translate and one to rotate each."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.fem.space import Space
from signorini.model.model import Model


def arm(model: Model) -> float:
    """What rotations are multiplied by to be displacements: half the diagonal of the mesh, length."""
    return float(np.linalg.norm(np.ptp(model.mesh.points, axis=0)) / 2.0)


def carried(model: Model, j: int, points: Array) -> Array:
    """Displacement of points (k, 2) with the unknowns of obstacle j, (k, 2, 4): ``u_x, u_y, theta arm`` and none.

    ``u(x) = u + theta (-(y - y_c), x - x_c)``
    """
    lever = (points - np.array(model.obstacles[j].about)) / arm(model)
    result = np.zeros((len(points), 2, 4))
    result[:, 0, 0] = result[:, 1, 1] = 1.0
    result[:, 0, 2], result[:, 1, 2] = -lever[:, 1], lever[:, 0]
    return result


def driven(model: Model, j: int) -> tuple[BoolArray, Array]:
    """Which unknowns of obstacle j are prescribed, and their values at factor 1, (4,) each."""
    obstacle = model.obstacles[j]
    given = (*obstacle.u, None if obstacle.turn is None else obstacle.turn * arm(model), 0.0)
    return np.array([part is not None for part in given]), np.array([part or 0.0 for part in given])


def obstacle_loads(space: Space, model: Model) -> dict[str, Array]:
    """Forces on all dofs, (dofs,), of every obstacle that bears a load, by name."""
    loads = {}
    for j, obstacle in enumerate(model.obstacles):
        if any(obstacle.force or ()) or obstacle.moment:
            forces = np.zeros(space.number_of_dofs)
            given = (*(part or 0.0 for part in obstacle.force or (0.0, 0.0)), obstacle.moment / arm(model), 0.0)
            forces[space.obstacle_dofs(j)] = given
            loads[obstacle.label] = forces
    return loads
