# SPDX-License-Identifier: BSD-3-Clause
"""One solution or several: by hand for one node, by loads at random for a few pairs."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.friction.problem import ContactProblem
from signorini.friction.uniqueness import all_solutions, always_unique, mu_low, search_solutions
from tests.helpers.path_samples import stiff


def node(mu, f_t):
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    return ContactProblem.of(W=W, b=W @ [-1.0, f_t], friction=[mu], motions=np.zeros((2, 0)), scale=1.0)


def random_problem(seed, pairs, mu):
    rng = np.random.default_rng(seed)
    W = np.linalg.inv(stiff(seed, pairs) + np.eye(2 * pairs))
    return ContactProblem.of(
        W=(W + W.T) / 2,
        b=rng.normal(size=2 * pairs),
        friction=np.full(pairs, mu),
        motions=np.zeros((2 * pairs, 0)),
        scale=1.0,
    )


def test_three_solutions_between_2_and_3():
    """The catalogue: stick y = (1, -2.5), slip, open, for mu = 3 and 2 < f_t < 3."""
    for f_t, count in ((1.9, 1), (2.5, 3), (3.1, 1)):
        for found in (all_solutions(node(3.0, f_t)), search_solutions(node(3.0, f_t))):
            assert len(found) == count
    expected = np.array([[1.0, -2.5], [0.5, -1.5 - 0.5], [-1 / 6, -4 / 3]])
    found = np.array(all_solutions(node(3.0, 2.5))).reshape(-1, 2)
    assert all(np.abs(found - y).max(axis=1).min() < 1e-12 for y in expected)


@pytest.mark.parametrize("mu", [0.0, 1.0, 1.99, 2.01, 5.0])
def test_the_critical_friction_of_the_node(mu):
    assert always_unique(node(mu, 0.0)) == (mu < 2.0)


def test_what_is_proved_unique_never_has_two_and_the_rest_sometimes_has():
    several = 0
    for seed in range(12):
        for mu in (0.3, 1.0, 3.0):
            problem = random_problem(seed, 2, mu)
            unique = always_unique(problem)
            if mu < mu_low(problem):
                assert unique
            rng = np.random.default_rng(seed)
            for _ in range(2 if unique else 20):
                count = len(all_solutions(replace(problem, b=rng.normal(size=4))))
                # indices of all solutions sum to one
                assert count % 2 == 1
                assert count == 1 or not unique
                several += count > 1
    assert several > 0


def test_a_search_finds_what_enumeration_finds():
    for seed in range(5):
        problem = random_problem(seed, 3, 3.0)
        assert len(search_solutions(problem)) == len(all_solutions(problem))


def test_too_many_pairs_are_refused():
    with pytest.raises(InputError, match="has 7 pairs; expected at most 6"):
        always_unique(random_problem(0, 7, 0.3))
