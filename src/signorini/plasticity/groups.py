# SPDX-License-Identifier: BSD-3-Clause
"""Cells that may yield, by family and formulation: shape functions and internal modes at their points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.fem.kinematics import Group, kinematics, of_bodies, straining_groups
from signorini.fem.space import Space
from signorini.model.model import Model
from signorini.plasticity import kernels
from signorini.plasticity.modes import Modes, eliminated


@dataclass(frozen=True, kw_only=True, eq=False)
class PointGroup:
    """Cells of one family that may yield.

    Attributes
    ----------
    group : the cells
    cells : (m, k) nodes
    gradients : (m, q, k, e) of the shape functions
    weights : (m, q) volumes of the points
    values : (q, k) shape functions
    modes : internal modes of the cells
    first : where the points of the group begin among all
    """

    group: Group
    cells: IntArray
    gradients: Array
    weights: Array
    values: Array
    modes: Modes
    first: int

    @property
    def own(self) -> slice:
        """The points of the group among all."""
        return slice(self.first, self.first + self.weights.size)

    @property
    def internal(self) -> bool:
        """Whether the cells have internal modes."""
        return bool(self.modes.gradients.shape[2])

    def amplitudes(self, stress: Array) -> Array:
        """(m k' d,) By which modes give way to stresses (m q, n), compression and all: ``K_aa^-1 int G^T sigma``."""
        cells, m = self._own_cells, len(self.cells)
        forces = np.zeros(cells.size * (2 if stress.shape[1] == 4 else 3))
        kernels.add_forces(cells, self.modes.gradients, self.weights, stress, len(forces) // cells.size, forces)
        found: Array = (self.modes.inverse @ forces.reshape(m, -1, 1)).ravel()
        return found

    def add_mode_strains(self, amplitudes: Array, out: Array) -> None:
        """Add the strains of modes at amplitudes (m k' d,) to those of the points, (m q, n)."""
        cells = self._own_cells
        kernels.add_strains(cells, self.modes.gradients, amplitudes, len(amplitudes) // cells.size, out)

    @property
    def _own_cells(self) -> IntArray:
        """(m, k') Numbers of the modes, each in one cell."""
        m, _, count, _ = self.modes.gradients.shape
        return np.arange(m * count).reshape(m, count)


def point_groups(space: Space, model: Model, elasticity: Array) -> Iterator[PointGroup]:
    """Cells that may yield, with what their points need.

    Parameters
    ----------
    space, model : the mesh and what is on it
    elasticity : (b, n, n) elastic law of every body
    """
    first = 0
    for group in yielding_groups(space, model):
        points = kinematics(space, model, group)
        gradients = np.ascontiguousarray(points.gradients[:, :, : points.nodes])
        modes = np.ascontiguousarray(points.gradients[:, :, points.nodes :])
        weights = np.ascontiguousarray(points.weights)
        yield PointGroup(
            group=group,
            cells=np.ascontiguousarray(group.cells, np.int64),
            gradients=gradients,
            weights=weights,
            values=points.values,
            modes=eliminated(gradients, modes, weights, elasticity[group.body]),
            first=first,
        )
        first += points.weights.size


def yielding_groups(space: Space, model: Model) -> Iterator[Group]:
    """Cells that may yield, by family and formulation: the order of the points."""
    return of_bodies(straining_groups(space, model), np.array([body.material.yields for body in model.bodies]))
