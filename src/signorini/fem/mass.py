# SPDX-License-Identifier: BSD-3-Clause
"""The consistent mass of a model."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.fem.jacobian import determinants, jacobians
from signorini.fem.measure import measure
from signorini.fem.space import Space, shapes_in_cells
from signorini.model.mesh import CORNERS
from signorini.model.model import Model

_LINEAR_DEGREE, _QUADRATIC_DEGREE = 3, 6
"""Of polynomials that the quadratures integrate: products of two shape functions, on cells that are bent or revolved
with the Jacobian and the radius."""


def mass_matrix(space: Space, model: Model) -> sp.csr_array:
    """``M_ij = int rho phi_i . phi_j dx``, (dofs, dofs), mass; ``dx`` as that of the stiffness.

    Rigid bodies have the mass of their cells. Rigid obstacles have none, and internal modes of cells none.

    Raises
    ------
    InputError
        If a body has no density.
    """
    for i, body in enumerate(model.bodies):
        if body.material.density == 0.0:
            raise InputError(f"'{body.name}' has no density; modes need one in its material", where=("body", i))
    density = np.array([body.material.density for body in model.bodies])[model.body_of_cells()]
    count, d = len(space.mesh.points), space.components
    M = sp.csr_array((count, count))
    for block in space.blocks:
        linear = block.cells.shape[1] == CORNERS[block.family]
        degree = _LINEAR_DEGREE if linear else _QUADRATIC_DEGREE
        values, gradients, weights = shapes_in_cells(block.family, degree)
        points = space.mesh.points[block.cells]
        numbers = block.first + np.arange(len(block.cells))
        at = np.einsum("qk,mki->mqi", values, points)
        volumes = np.abs(determinants(jacobians(points, gradients))) * weights * measure(model, at, numbers)
        M = M + _assembled(block.cells, (volumes * density[numbers][:, None]) @ _products(values), count)
    M = sp.csr_array(sp.kron(M, sp.eye_array(d), format="csr"))
    M.resize((space.number_of_dofs, space.number_of_dofs))
    return M


def _products(values: Array) -> Array:
    """Products of shape functions (q, k) with one another, (q, k k)."""
    products: Array = np.einsum("qk,ql->qkl", values, values).reshape(len(values), -1)
    return products


def _assembled(cells: IntArray, entries: Array, count: int) -> sp.csr_array:
    """Matrices (m, k k) of cells (m, k), summed over ``count`` nodes."""
    k = cells.shape[1]
    rows, columns = np.repeat(cells, k, axis=1), np.tile(cells, (1, k))
    found = sp.coo_array((entries.ravel(), (rows.ravel(), columns.ravel())), shape=(count, count))
    return sp.csr_array(found)
