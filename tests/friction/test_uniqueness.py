# SPDX-License-Identifier: BSD-3-Clause
"""The friction below which contact forces are unique: bodies held by contact, and space, against all solutions."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import mu_low, search_solutions
from tests.helpers.contact_samples import all_solutions
from tests.helpers.path_samples import stiff


def lifted(seed, pairs, tilt=0.0):
    """A body that contact alone holds: it moves along the normals, and by ``tilt`` of that along the tangents."""
    S = stiff(seed, pairs)
    R = np.concatenate([np.ones(pairs), np.full(pairs, tilt)])[:, None]
    P = np.eye(2 * pairs) - R @ R.T / (R * R).sum()
    W = np.linalg.inv(np.eye(2 * pairs) + P @ S @ P)
    W = (W + W.T) / 2
    return ContactProblem.of(W=W, b=np.zeros(2 * pairs), friction=np.ones(pairs), motions=R, scale=1.0)


def loads(seed, count, rows):
    """Loads, of which a body that contact holds is pressed by the first half."""
    b = np.random.default_rng(seed).normal(size=(count, rows))
    b[: count // 2, : rows // 2] -= 1.0
    return b


def spread(problem, b):
    """How far the normal and tangential forces of all solutions are apart."""
    found = np.array([y for y, _ in all_solutions(replace(problem, b=b))]).reshape(-1, 2, problem.pairs)
    if len(found) < 2:
        return 0.0
    p = np.maximum(found[:, 0], 0.0)
    most = problem.mu * p
    forces = np.stack([p, np.clip(found[:, 1], -most, most)])
    return np.abs(forces - forces[:, :1]).max()


@pytest.mark.slow
def test_forces_of_bodies_that_contact_holds_are_unique_below_the_bound():
    above = 0.0
    for seed in range(6):
        problem = lifted(seed, 3)
        bound = mu_low(problem)
        for b in loads(seed, 12, 6):
            assert spread(replace(problem, friction=np.full(3, 0.99 * bound)), b) < 1e-9
            above = max(above, spread(replace(problem, friction=np.full(3, 8.0 * bound)), b))
    assert above > 1e-2


def test_no_bound_is_claimed_where_a_free_motion_slides():
    assert mu_low(lifted(0, 3, tilt=0.1)) is None
    assert mu_low(replace(lifted(0, 3, tilt=0.1), friction=np.zeros(3))) == np.inf


def in_space(problem, angles, across=0.3):
    """Pairs of the plane in space, each plane turned about the normal; stiffness ``1 / across - 1`` across it."""
    n = problem.pairs
    W = np.zeros((3 * n, 3 * n))
    W[: 2 * n, : 2 * n], W[2 * n :, 2 * n :] = problem.W, across * np.eye(n)
    turn, c, s = np.eye(3 * n), np.diag(np.cos(angles)), np.diag(np.sin(angles))
    turn[n:, n:] = np.block([[c, -s], [s, c]])
    W = turn @ W @ turn.T
    return ContactProblem.of(
        W=(W + W.T) / 2,
        b=turn @ np.concatenate([problem.b, np.zeros(n)]),
        friction=problem.friction,
        motions=np.zeros((3 * n, 0)),
        scale=1.0,
    )


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_the_bound_of_one_pair_is_that_of_the_plane(angle):
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    node = ContactProblem.of(W=W, b=W @ [-1.0, 2.5], friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    turned = in_space(node, np.array([angle]))
    np.testing.assert_allclose(mu_low(turned), mu_low(node), rtol=1e-12)
    found = sorted(y[0, 0] for y in search_solutions(turned))
    np.testing.assert_allclose(found, [-1 / 6, 0.5, 1.0], atol=1e-9)
    below = replace(turned, friction=np.full(1, 0.99 * mu_low(turned)))
    assert len(search_solutions(below)) == 1


def test_tangents_may_be_turned_and_below_the_bound_searches_find_one_solution():
    rng = np.random.default_rng(5)
    for seed in range(4):
        W = np.linalg.inv(np.eye(6) + stiff(seed, 3))
        plane = ContactProblem.of(
            W=(W + W.T) / 2, b=rng.normal(size=6), friction=np.ones(3), motions=np.zeros((6, 0)), scale=1
        )
        bounds = [mu_low(in_space(plane, angles)) for angles in (np.zeros(3), rng.uniform(0, 6, 3))]
        np.testing.assert_allclose(bounds[1], bounds[0], rtol=1e-10)
        problem = replace(in_space(plane, rng.uniform(0, 6, 3)), friction=np.full(3, 0.99 * bounds[0]))
        (found,) = search_solutions(problem)
        np.testing.assert_allclose(found, solve_contact(problem).y, atol=1e-9)
