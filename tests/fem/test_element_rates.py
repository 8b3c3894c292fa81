# SPDX-License-Identifier: BSD-3-Clause
"""Convergence of the elements on a manufactured smooth problem without contact: L2 two, H1 one.

``u = (sin 2x cos y, e^x sin y)`` on the unit square, its values on the whole boundary, the body force that it needs,
meshes whose inner nodes are moved off the grid.
"""

import numpy as np
import pytest
import scipy.sparse.linalg

from signorini.fem.jacobian import gradients_in_space, jacobians
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.stress import body_stresses
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from tests.helpers.families import lame


def exact(x):
    x, y = np.moveaxis(x, -1, 0)
    return np.stack([np.sin(2 * x) * np.cos(y), np.exp(x) * np.sin(y)], axis=-1)


def slope(x):
    x, y = np.moveaxis(x, -1, 0)
    rows = [
        [2 * np.cos(2 * x) * np.cos(y), -np.sin(2 * x) * np.sin(y)],
        [np.exp(x) * np.sin(y), np.exp(x) * np.cos(y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def body_force(x, lame, shear):
    """``-(lambda + G) grad div u - G lap u``."""
    u = exact(x)
    x, y = np.moveaxis(x, -1, 0)
    grad_div = [
        (np.exp(x) - 4 * np.sin(2 * x)) * np.cos(y),
        -(2 * np.cos(2 * x) + np.exp(x)) * np.sin(y),
    ]
    lap = np.stack([-5 * u[..., 0], 0 * x], axis=-1)
    return -(lame + shear) * np.stack(grad_div, axis=-1) - shear * lap


def crooked_square(n, cells):
    mesh = rectangle(nx=n, ny=n, cells=cells)
    x, y = mesh.points.T
    bump = 0.15 / n * np.sin(np.pi * x) * np.sin(np.pi * y)
    phase = np.arange(len(x)) * 2.4
    moved = mesh.points + bump[:, None] * np.column_stack([np.cos(phase), np.sin(phase)])
    return Mesh(points=moved, cells=mesh.cells, bodies=mesh.bodies, boundaries=mesh.boundaries)


def errors(n, cells, kind):
    model = Model(crooked_square(n, cells), kind=kind, bodies=[Body("block", Elastic(E=3.0, nu=0.3))])
    space = make_space(model.mesh)
    lambda_, shear = lame(model)
    K, points = stiffness(space, model), model.mesh.points
    (block,), (volumes,) = space.blocks, space.volumes
    bent = jacobians(points[block.cells], block.gradients)
    at = np.einsum("qk,mki->mqi", block.values, points[block.cells])
    load = np.zeros_like(points)
    np.add.at(load, block.cells, np.einsum("mq,qk,mqi->mki", volumes, block.values, body_force(at, lambda_, shear)))
    rim = np.unique(np.concatenate([facets.ravel() for facets in model.mesh.boundaries.values()]))
    held = space.dofs(rim).ravel()
    free = np.setdiff1d(np.arange(points.size), held)
    u = exact(points).ravel()
    u[free] = scipy.sparse.linalg.spsolve(K[free][:, free].tocsc(), load.ravel()[free] - K[free][:, held] @ u[held])
    u = u.reshape(-1, 2)
    if cells == "triangle":  # the gradient is constant; the middles of the edges integrate exactly enough
        corners = points[block.cells]
        at = 0.5 * (corners + np.roll(corners, -1, axis=1))
        values = 0.5 * (u[block.cells] + np.roll(u[block.cells], -1, axis=1))
        weights = np.repeat(volumes.sum(axis=1, keepdims=True) / 3, 3, axis=1)
    else:
        values, weights = np.einsum("qk,mki->mqi", block.values, u[block.cells]), volumes
    gradient = np.einsum("mqkj,mki->mqij", gradients_in_space(bent, block.gradients), u[block.cells])
    l2 = np.sqrt(np.sum(weights[..., None] * (values - exact(at)) ** 2))
    h1 = np.sqrt(np.sum(weights[..., None, None] * (gradient - slope(at)) ** 2))
    (stress,) = body_stresses(space, model, u)
    strain = slope(points)
    xx = (lambda_ + 2 * shear) * strain[:, 0, 0] + lambda_ * strain[:, 1, 1]
    xy = shear * (strain[:, 0, 1] + strain[:, 1, 0])
    inside = np.setdiff1d(stress.nodes, rim)
    nodal = max(
        np.abs(stress.stress[inside, 0] - xx[inside]).max(), np.abs(stress.stress[inside, 3] - xy[inside]).max()
    )
    return l2, h1, nodal


@pytest.mark.parametrize("kind", ["plane strain", "plane stress"])
@pytest.mark.parametrize("cells", ["quad", "triangle"])
def test_rates(cells, kind):
    table = np.array([errors(n, cells, kind) for n in (8, 16, 32)])
    rates = np.log2(table[:-1] / table[1:])
    np.testing.assert_allclose(rates[:, 0], 2.0, atol=0.15)
    np.testing.assert_allclose(rates[:, 1], 1.0, atol=0.15)
    assert rates[:, 2].min() > 0.8, rates  # averaged nodal stresses converge too
