# SPDX-License-Identifier: BSD-3-Clause
"""Small spatial Coulomb problems: random ones, and an elastic half-space under a punch."""

import numpy as np

from signorini.friction.spatial import SpatialProblem, from_compliance


def random_problem(seed, pairs, friction, *, motions=0, facets=0, tresca=None):
    """Compliance with random eigenvectors and eigenvalues 0.05 .. 0.95 (1 on the motions)."""
    rng = np.random.default_rng(seed)
    Q, _ = np.linalg.qr(rng.normal(size=(3 * pairs, 3 * pairs)))
    values = rng.uniform(0.05, 0.95, 3 * pairs)
    values[:motions] = 1.0
    W = (Q * values) @ Q.T
    return SpatialProblem(
        W=(W + W.T) / 2,
        b=rng.normal(size=3 * pairs),
        friction=np.broadcast_to(friction, (pairs, *np.shape(friction)[1:])).astype(float),
        motions=Q[:, :motions],
        scale=1.0,
        facets=facets,
        tresca=tresca,
    )


def punch(pairs, friction, *, facets=0, push=(0.3, 0.2), turn=0.3):
    """A rough curved punch pressed on an elastic half-space, dragged and turned: A (3n, 3n), c and the problem.

    Compliance of point forces at distance s (Boussinesq, Cerruti; E = 1, nu = 0.3), a disc's own at its centre.
    """
    side = round(pairs**0.5)
    assert side**2 == pairs
    x = np.stack(np.meshgrid(*2 * [np.linspace(-1, 1, side)], indexing="ij"), axis=-1).reshape(-1, 2)
    nu, h = 0.3, 2.0 / (side - 1)
    d = x[:, None] - x
    s = np.hypot(*np.moveaxis(d, 2, 0)) + np.eye(pairs)
    off = 1.0 - np.eye(pairs)
    own = 2.0 * np.eye(pairs) / (h / np.sqrt(np.pi))
    inverse = off / s + own
    A = np.empty((3, pairs, 3, pairs))
    A[0, :, 0] = (1 - nu**2) / np.pi * inverse
    for i in (0, 1):
        A[0, :, 1 + i] = (1 - 2 * nu) * (1 + nu) / (2 * np.pi) * off * d[..., i] / s**2
        A[1 + i, :, 0] = -A[0, :, 1 + i]
        for j in (0, 1):
            A[1 + i, :, 1 + j] = (1 + nu) / np.pi * (nu * off * d[..., i] * d[..., j] / s**3)
        A[1 + i, :, 1 + i] += (1 + nu) / np.pi * ((1 - nu) * inverse + 0.5 * nu * own)
    gap = 0.5 * (x**2).sum(axis=1) - 0.25
    slip = np.array(push) * 0.25 + turn * 0.25 * np.column_stack([-x[:, 1], x[:, 0]])
    c = np.concatenate([gap, slip[:, 0], slip[:, 1]])
    problem, root = from_compliance(A.reshape(3 * pairs, -1), c, np.full(pairs, friction), facets=facets)
    return A.reshape(3 * pairs, -1), c, problem, root


def block_on_floor(load, friction, *, facets=0, side=3):
    """A floating elastic block with six rigid motions; load = (normal, two tangential, two tilting, drilling)."""
    n = side**2
    x = np.stack(np.meshgrid(*2 * [np.linspace(-1, 1, side)], indexing="ij"), axis=-1).reshape(-1, 2)
    one, zero = np.ones(n), np.zeros(n)
    columns = [(one, zero, zero), (zero, one, zero), (zero, zero, one)]
    columns += [(x[:, 0], zero, zero), (x[:, 1], zero, zero), (zero, -x[:, 1], x[:, 0])]
    R = np.stack([np.concatenate(column) for column in columns], axis=1)
    rng = np.random.default_rng(side)
    Q, _ = np.linalg.qr(np.concatenate([R, rng.normal(size=(3 * n, 3 * n - 6))], axis=1))
    W = (Q * np.append(np.ones(6), np.linspace(0.1, 0.9, 3 * n - 6))) @ Q.T
    b = R @ np.linalg.solve(R.T @ R, np.asarray(load, dtype=float))
    problem = SpatialProblem(W=(W + W.T) / 2, b=b, friction=np.full(n, friction), motions=R, scale=1.0, facets=facets)
    return problem, R
