# SPDX-License-Identifier: BSD-3-Clause
"""Stresses at the nodes, averaged inside a body and never across bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.fem.space import Block, Space
from signorini.fem.stiffness import lame_parameters
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyStress:
    """Nodal stresses of one body.

    Attributes
    ----------
    body : its name
    nodes : (k,) sorted nodes of the mesh
    stress : (k, 6) force per area: xx, yy, zz, xy, yz, xz, tension positive; of axisymmetric bodies radial, axial, hoop
        and their shear
    """

    body: str
    nodes: IntArray
    stress: Array

    @property
    def von_mises(self) -> Array:
        """``sqrt(3/2 s:s)``, s the deviator, (k,)."""
        return von_mises(self.stress)


def von_mises(stress: Array) -> Array:
    """Von Mises equivalent of stresses (..., 6).

    >>> von_mises(np.array([2.0, 0, 0, 0, 0, 0])).item()
    2.0
    """
    x, y, z, xy, yz, xz = np.moveaxis(stress, -1, 0)
    square = 0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3.0 * (xy**2 + yz**2 + xz**2)
    result: Array = np.sqrt(square)
    return result


def body_stresses(space: Space, model: Model, displacement: Array) -> list[BodyStress]:
    """Stresses of every body: from the best points of a cell to its nodes, then averaged with the cells' areas.

    Parameters
    ----------
    displacement : (n, 2), length
    """
    total = [np.zeros((len(space.mesh.points), 6)) for _ in model.bodies]
    weight = [np.zeros(len(space.mesh.points)) for _ in model.bodies]
    owner = model.body_of_cells()
    lame, shear = lame_parameters(model)
    for block, volumes in zip(space.blocks, space.volumes, strict=True):
        own = owner[block.first : block.first + len(block.cells)]
        gradients = space.gradients(block, block.stress_gradients)
        slope = np.einsum("mqki,mkj->mqij", gradients, displacement[block.cells])
        hoop = _hoop(block, space.mesh.points, displacement) if model.axisymmetric else np.zeros(slope.shape[:2])
        stress = _stress(slope, hoop, lame[own], shear[own], model)
        at_nodes = np.einsum("kq,mqc->mkc", block.to_nodes, stress)
        area = volumes.sum(axis=1)
        for i in range(len(model.bodies)):
            here = own == i
            np.add.at(total[i], block.cells[here], at_nodes[here] * area[here, None, None])
            np.add.at(weight[i], block.cells[here], area[here, None])
    result = []
    for i, body in enumerate(model.bodies):
        nodes = np.nonzero(weight[i])[0]
        result.append(BodyStress(body=body.name, nodes=nodes, stress=total[i][nodes] / weight[i][nodes, None]))
    return result


def _hoop(block: Block, points: Array, displacement: Array) -> Array:
    """Hoop strain ``u_r / r``, (m, p)."""
    radius, moved = (field[block.cells, 0] @ block.stress_values.T for field in (points, displacement))
    strain: Array = moved / radius
    return strain


def _stress(slope: Array, hoop: Array, lame: Array, shear: Array, model: Model) -> Array:
    """Stress components (m, p, 6) from displacement gradients (m, p, 2, 2), Lame parameters (m,) of the plane kind."""
    lame, shear = lame[:, None], shear[:, None]
    xx, yy = slope[..., 0, 0], slope[..., 1, 1]
    trace = lame * (xx + yy + hoop)
    stress = np.zeros((*xx.shape, 6))
    stress[..., 0] = trace + 2.0 * shear * xx
    stress[..., 1] = trace + 2.0 * shear * yy
    if model.kind != "plane stress":
        stress[..., 2] = trace + 2.0 * shear * hoop
    stress[..., 3] = shear * (slope[..., 0, 1] + slope[..., 1, 0])
    return stress
