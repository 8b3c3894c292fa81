# SPDX-License-Identifier: BSD-3-Clause
"""Unknowns of moving obstacles and rigid bodies: two nodes behind the mesh, one to translate and one to rotate each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from signorini.arrays import Array, BoolArray
from signorini.fem.space import Space
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle


def arm(model: Model) -> float:
    """What rotations are multiplied by to be displacements: half the diagonal of the mesh, length."""
    return float(np.linalg.norm(model.mesh.extent) / 2.0)


def carried(model: Model, points: Array, about: Array) -> Array:
    """Displacement of points with the unknowns of what is rigid, (k, c, 2 c): in 2D ``u_x, u_y, theta arm``, none.

    ``u(x) = u + theta (-(y - y_c), x - x_c)``; in space ``u + theta x (x - x_c)`` with three rotations. With twist
    ``u_r, u_z`` and ``u_t = theta r``.

    Parameters
    ----------
    model : tells the dimension, and the arm of rotations
    points : (k, d)
    about : (d,) the point x_c about which it rotates
    """
    lever = (points - about) / arm(model)
    d = lever.shape[1]
    if model.twists:
        found = np.zeros((len(points), 3, 6))
        found[:, 0, 0] = found[:, 1, 1] = 1.0
        found[:, 2, 2] = points[:, 0] / arm(model)
        return found
    result = np.zeros((len(points), d, 2 * d))
    result[:, :, :d] = np.eye(d)
    if d == 2:
        result[:, 0, 2], result[:, 1, 2] = -lever[:, 1], lever[:, 0]
    else:
        result[:, :, 3:] = np.cross(np.eye(3), lever[:, None]).swapaxes(1, 2)
    return result


@dataclass(frozen=True, eq=False)
class Placed:
    """A rigid obstacle where its unknowns have taken it: turned about its point by its finite angle, then moved.

    Attributes
    ----------
    shape : as it was given
    about : (d,) the point about which it turns, as it was given
    shift : (d,) its displacement, length
    turn : (d, d) its rotation
    """

    shape: Obstacle
    about: Array
    shift: Array
    turn: Array

    def __str__(self) -> str:
        return str(self.shape)

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Signed distance of points (n, d), positive outside the obstacle, and its outward normals there (n, d)."""
        distance, normals = self.shape.nearest((points - self.about - self.shift) @ self.turn + self.about)
        return distance, normals @ self.turn.T


def placed(space: Space, model: Model, j: int) -> Placed:
    """Obstacle j where the displacement of a space has taken it.

    Parameters
    ----------
    space, model : where the obstacles are, and which
    j : number of the obstacle
    """
    obstacle, d = model.obstacles[j], model.dimension
    motion = space.displacement[space.obstacle_dofs(j)] if len(space.displacement) else np.zeros(2 * d)
    turned = motion[d:] / arm(model)
    angles = np.array([0.0, 0.0, turned[0]]) if d == 2 else turned
    turn = Rotation.from_rotvec(angles).as_matrix()[:d, :d]
    return Placed(obstacle.shape, np.array(obstacle.about), motion[:d], turn)


def driven(model: Model, j: int) -> tuple[BoolArray, Array]:
    """Which unknowns of obstacle j are prescribed, and their values at factor 1, (2 c,) each."""
    obstacle = model.obstacles[j]
    turns = tuple(None if turn is None else turn * arm(model) for turn in obstacle.rotations)
    given = (*obstacle.u, *turns, *(0.0,) * (2 * model.components - len(obstacle.u) - len(turns)))
    return np.array([part is not None for part in given]), np.array([part or 0.0 for part in given])


def obstacle_loads(space: Space, model: Model) -> dict[str, Array]:
    """Forces on all dofs, (dofs,), of every obstacle that bears a load, by name."""
    loads = {}
    for j, obstacle in enumerate(model.obstacles):
        if any(obstacle.force or ()) or any(obstacle.moments):
            forces = np.zeros(space.number_of_dofs)
            dofs, d = space.obstacle_dofs(j), model.dimension
            forces[dofs[:d]] = [part or 0.0 for part in obstacle.force or (0.0,) * d]
            forces[dofs[d : d + len(obstacle.moments)]] = np.array(obstacle.moments) / arm(model)
            loads[obstacle.label] = forces
    return loads
