# SPDX-License-Identifier: BSD-3-Clause
"""Two elastic blocks in space on meshes that do not match, from the faces to the forces: the patch test, and friction.

Finite elements by scikit-fem itself; mortar coupling, frames and Coulomb's law are what is tested.
"""

import numpy as np
import pytest
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

from signorini.fem.boundary import Boundary
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.interface.frames import frames
from signorini.interface.mortar import mortar_coupling
from signorini.law.states import STICK
from tests.helpers.face_samples import rotation

E, NU, PRESSURE, FRICTION = 2000.0, 0.3, 25.0, 0.5


def block(mesh):
    """Stiffness, nodes (n, 3) and the stiffness' nodes by component (3, n) of one block."""
    first, order = (skfem.ElementHex1(), 2) if isinstance(mesh, skfem.MeshHex) else (skfem.ElementTetP1(), 1)
    basis = skfem.Basis(mesh, skfem.ElementVector(first), intorder=order + 2)
    return linear_elasticity(*lame_parameters(E, NU)).assemble(basis).toarray(), mesh.p.T, basis.nodal_dofs


def faces(mesh, z):
    """Faces of a mesh at a height, counter-clockwise seen from above."""
    boundary = mesh.boundary_facets()
    chosen = boundary[np.isclose(mesh.p[2][mesh.facets[:, boundary]], z).all(axis=0)]
    nodes = mesh.facets[:, chosen].T
    centre = mesh.p[:2].T[nodes].mean(axis=1, keepdims=True)
    arm = mesh.p[:2].T[nodes] - centre
    return np.take_along_axis(nodes, np.argsort(np.arctan2(arm[..., 1], arm[..., 0]), axis=1), axis=1)


def box(kind, n, low, high):
    """A mesh of the unit square times [low, high], its inner nodes moved a little."""
    line = np.linspace(0, 1, n + 1)
    mesh = kind.init_tensor(line, line, np.linspace(low, high, n + 1))
    p = mesh.p.copy()
    rng = np.random.default_rng(n)
    for axis, (a, b) in enumerate(((0, 1), (0, 1), (low, high))):
        inner = (p[axis] > a + 1e-9) & (p[axis] < b - 1e-9)
        p[axis, inner] += rng.uniform(-0.15, 0.15, inner.sum()) / n
    return kind(p, mesh.t)


def surface_load(mesh, z):
    """``int N_k`` over the faces at a height, (n,)."""
    side = Boundary.of(mesh.p.T, faces(mesh, z))
    load = np.zeros(mesh.nvertices)
    load[side.nodes] = side.nodal((block.weights for block in side.blocks), corners=True)
    return load


def pressed(kinds, counts, traction, seed):
    """The scaled contact problem of an upper block, held by contact alone, and what recovers the displacements."""
    upper, lower = box(kinds[0], counts[0], 0.0, 1.0), box(kinds[1], counts[1], -1.0, 0.0)
    (K_1, x_1, dofs_1), (K_2, x_2, dofs_2) = block(upper), block(lower)
    n_1, n_2 = len(x_1), len(x_2)
    K = np.block([[K_1, np.zeros((3 * n_1, 3 * n_2))], [np.zeros((3 * n_2, 3 * n_1)), K_2]])
    dofs = np.concatenate([dofs_1, dofs_2 + 3 * n_1], axis=1)
    Q = rotation(seed)
    turn = np.zeros_like(K)  # displacements along the turned axes, node by node
    for k in range(n_1 + n_2):
        turn[np.ix_(dofs[:, k], dofs[:, k])] = Q
    K = turn @ K @ turn.T
    points = np.concatenate([x_1, x_2]) @ Q.T
    side = Boundary.of(points, faces(upper, 0.0)[:, ::-1])
    other = Boundary.of(points, faces(lower, 0.0) + n_1)
    coupling = mortar_coupling(side, other)
    axes = frames(coupling.normals)
    gap = np.sum((coupling.relative @ points) * axes[:, 0], axis=1)
    pairs = len(coupling.nodes)
    B = np.zeros((3 * pairs, len(K)))
    for row in range(3):
        for e in range(3):
            B[row * pairs : (row + 1) * pairs, dofs[e]] += axes[:, row, e, None] * coupling.relative.toarray()
    f = np.zeros(len(K))
    f[dofs[:, :n_1]] = np.outer(Q @ traction, surface_load(upper, 1.0))
    # the lower block: heights held at its bottom, two of its bottom corners against sliding and turning
    bottom = n_1 + np.nonzero(np.isclose(lower.p[2], -1.0))[0]
    corner = [n_1 + np.argmin(np.abs(lower.p.T - place).sum(axis=1)) for place in ((0, 0, -1.0), (1, 0, -1.0))]
    held = [(k, Q[:, 2]) for k in bottom] + [(corner[0], Q[:, 0]), (corner[0], Q[:, 1]), (corner[1], Q[:, 1])]
    C = np.zeros((len(held), len(K)))
    for row, (k, direction) in enumerate(held):
        C[row, dofs[:, k]] = direction
    T = np.linalg.svd(C)[2][len(held) :].T
    arm = points[:n_1] - points[:n_1].mean(axis=0)
    rigid = np.zeros((len(K), 6))
    for a in range(3):
        rigid[dofs[a, :n_1], a] = 1.0
        rigid[dofs[:, :n_1], 3 + a] = np.cross(np.eye(3)[a], arm).T
    D = np.tile(0.1 * E * coupling.area, 3)
    root = np.sqrt(D)
    stiff = T.T @ (K + B.T @ (D[:, None] * B)) @ T
    answer = np.linalg.solve(stiff, np.column_stack([(B @ T).T, T.T @ f]))
    A, moved = B @ T @ answer[:, :-1], B @ T @ answer[:, -1]
    W = root[:, None] * A * root
    h_0 = root * np.concatenate([gap, np.zeros(2 * pairs)])
    problem = ContactProblem.of(
        W=(W + W.T) / 2,
        b=root * moved + h_0 - W @ h_0,
        friction=np.full(pairs, FRICTION),
        motions=root[:, None] * (B @ rigid),
        scale=PRESSURE / E * root.max(),
    )

    def displacement(result):
        h, r = result.h.ravel(), result.r.ravel()
        springs = B.T @ (root * (r + h - h_0))
        return T @ np.linalg.solve(stiff, T.T @ (f + springs))

    return problem, coupling, root, (dofs, points, Q, displacement)


@pytest.mark.parametrize(
    ("kinds", "counts"),
    [
        ((skfem.MeshHex, skfem.MeshHex), (2, 3)),
        ((skfem.MeshTet, skfem.MeshTet), (2, 3)),
        ((skfem.MeshHex, skfem.MeshTet), (3, 2)),
    ],
    ids=["hex", "tet", "hex on tet"],
)
def test_uniform_pressure_passes_between_meshes_that_do_not_match(kinds, counts):
    problem, coupling, root, (dofs, points, Q, displacement) = pressed(kinds, counts, np.array([0, 0, -PRESSURE]), 4)
    result = solve_contact(problem)
    assert result.solved
    n = problem.pairs
    np.testing.assert_allclose(result.normal_force * root[:n], PRESSURE * coupling.area, rtol=1e-9)
    assert np.abs(result.tangential_force).max() < 1e-9 * result.normal_force.max()
    u = displacement(result)[dofs].T @ Q  # along the axes of the blocks
    x = points @ Q
    strain = PRESSURE / E * np.diag([NU, NU, -1.0])
    rigid = u - x @ strain
    # what is left is a rigid motion of each block
    for nodes in (x[:, 2] > -1e-9, x[:, 2] < 1e-9):
        arm = np.column_stack([np.ones(nodes.sum()), x[nodes]])
        motion = np.linalg.lstsq(arm, rigid[nodes])[0]
        np.testing.assert_allclose(arm @ motion, rigid[nodes], atol=1e-10)
        np.testing.assert_allclose(motion[1:] + motion[1:].T, 0.0, atol=1e-9)


@pytest.mark.parametrize(("drag", "outcome"), [(0.3, "solved"), (0.55, "no_equilibrium")])
def test_friction_holds_the_upper_block_up_to_its_coefficient(drag, outcome):
    # dragged just above the interface, so that it does not tip
    kinds = (skfem.MeshHex, skfem.MeshHex)
    angle = 0.7
    traction = PRESSURE * np.array([0, 0, -1.0])
    problem, coupling, root, _ = pressed(kinds, (2, 3), traction, 2)
    n = problem.pairs
    push = np.zeros(3 * n)
    share = drag * PRESSURE * coupling.area / root[:n]
    push[n : 2 * n], push[2 * n :] = np.cos(angle) * share, np.sin(angle) * share
    loaded = ContactProblem.of(
        W=problem.W,
        b=problem.b + problem.W @ push,
        friction=problem.friction,
        motions=problem.motions,
        scale=problem.scale,
    )
    result = solve_contact(loaded)
    assert result.outcome == outcome
    if result.solved:
        assert (result.state == STICK).any()
        total = (result.tangential_force * root[:n]).sum(axis=1)
        np.testing.assert_allclose(total, -drag * PRESSURE * np.array([np.cos(angle), np.sin(angle)]), rtol=1e-9)
