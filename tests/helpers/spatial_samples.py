# SPDX-License-Identifier: BSD-3-Clause
"""Small spatial Coulomb problems: random ones, and an elastic half-space under a punch."""

import numpy as np

from benchmarks.spatial_problems import from_compliance, punch
from signorini.friction.problem import ContactProblem


def random_problem(seed, pairs, friction, *, motions=0, facets=0, tresca=None):
    """Compliance with random eigenvectors and eigenvalues 0.05 .. 0.95 (1 on the motions)."""
    rng = np.random.default_rng(seed)
    Q, _ = np.linalg.qr(rng.normal(size=(3 * pairs, 3 * pairs)))
    values = rng.uniform(0.05, 0.95, 3 * pairs)
    values[:motions] = 1.0
    W = (Q * values) @ Q.T
    return ContactProblem.of(
        W=(W + W.T) / 2,
        b=rng.normal(size=3 * pairs),
        friction=np.broadcast_to(friction, (pairs, *np.shape(friction)[1:])).T.astype(float),
        motions=Q[:, :motions],
        scale=1.0,
        facets=facets,
        tresca=tresca,
    )


def pressed_punch(pairs, friction, *, facets=0):
    """A curved punch pressed on a half-space, dragged and turned: A, c, the problem and the roots of its scaling."""
    A, c = punch(round(pairs**0.5))
    problem, root = from_compliance(A, c, np.full(pairs, friction), facets=facets)
    return A, c, problem, root


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
    problem = ContactProblem.of(
        W=(W + W.T) / 2, b=b, friction=np.full(n, friction), motions=R, scale=1.0, facets=facets
    )
    return problem, R
