# SPDX-License-Identifier: BSD-3-Clause
"""The elastic stiffness of a model."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.fem.assembly import Cells
from signorini.fem.assembly import stiffness as assemble
from signorini.fem.space import Space
from signorini.model.model import Model


def lame_parameters(model: Model) -> tuple[Array, Array]:
    """Lame's parameters (lambda, G) of every body, force per area; lambda is the plane one in plane stress.

    ``lambda = E nu / ((1 + nu)(1 - 2 nu))``; plane stress ``2 lambda G / (lambda + 2 G)``.
    """
    E = np.array([body.material.E for body in model.bodies])
    nu = np.array([body.material.nu for body in model.bodies])
    shear = np.array([body.material.shear_modulus for body in model.bodies])
    lame = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    if model.kind == "plane stress":
        lame = 2.0 * lame * shear / (lame + 2.0 * shear)
    return lame, shear


def stiffness(space: Space, model: Model) -> sp.csr_array:
    """``K_ij = int (lambda div phi_i div phi_j + 2 G eps(phi_i):eps(phi_j)) dx``, (dofs, dofs).

    ``dx`` holds the thickness; of axisymmetric bodies ``2 pi r dr dz``, and their strain has the hoop part ``u_r / r``.
    """
    lame, shear = lame_parameters(model)
    owner = model.body_of_cells()
    blocks = []
    for block in space.blocks:
        own = owner[block.first : block.first + len(block.cells)]
        blocks.append(
            Cells(
                nodes=block.cells,
                shape_gradients=block.gradients,
                weights=block.weights,
                lame_lambda=lame[own],
                lame_mu=shear[own],
                thickness=model.thickness,
                shape_values=block.values,
            )
        )
    K = assemble(space.mesh.points, blocks, axisymmetric=model.axisymmetric)
    K.resize((space.number_of_dofs, space.number_of_dofs))  # rigid obstacles have no stiffness
    return K
