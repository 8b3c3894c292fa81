# SPDX-License-Identifier: BSD-3-Clause
"""Against all 4^n states tried one by one: answers, proofs, indices, uniqueness."""

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.friction.newton import admissible, in_states
from signorini.friction.plane.covering import follow_covering
from signorini.friction.plane.state_tree import search_states
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import pulled_away
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import mu_low
from tests.helpers.contact_samples import HELD, all_solutions, for_all, random_problem, with_stiffness

seeds = st.integers(0, 10**6)


def is_one_of(result, solutions):
    return any(np.allclose(result.y, y, atol=1e-8) for y, _ in solutions)


@for_all(seed=seeds, pairs=st.integers(1, 4))
def test_held_answer_is_a_solution_and_the_indices_sum_to_one(seed, pairs):
    problem = random_problem(seed, pairs)
    result, solutions = solve_contact(problem), all_solutions(problem)
    assert result.solved
    assert result.residual <= 1e-10
    assert is_one_of(result, solutions)
    assert result.index == in_states(problem, admissible(problem, result.state)).index
    assert sum(sign for _, sign in solutions) == 1


@for_all(seed=seeds, pairs=st.integers(1, 4), motions=st.integers(1, 2))
def test_floating_answer_or_proof(seed, pairs, motions):
    problem = random_problem(seed, pairs, motions)
    result, solutions = solve_contact(problem), all_solutions(problem)
    if result.solved:
        assert is_one_of(result, solutions) or result.index == 0
    else:
        assert not solutions
        assert result.outcome == "no_equilibrium" or result.escape is not None


@for_all(seed=seeds, pairs=st.integers(1, 4), motions=st.integers(0, 2))
def test_tree_agrees(seed, pairs, motions):
    problem = random_problem(seed, pairs, motions)
    tree, solutions = search_states(problem), all_solutions(problem)
    if tree.end == "impossible":
        assert not solutions
    elif tree.end == "solution":
        assert solve_contact(problem, tree.state).solved


@for_all(seed=seeds, pairs=st.integers(2, 4), motions=st.integers(1, 2), digits=st.sampled_from([8, 14, 20, 26]))
def test_rounding_proves_nothing(seed, pairs, motions, digits):
    """An interface stiffness far too small leaves few digits of the problem: its answer is lost, and not refuted."""
    problem = random_problem(seed, pairs, motions)
    poor = with_stiffness(problem, 10.0**-digits)
    if solve_contact(problem).solved:
        assert search_states(poor, budget=200).end != "impossible"
        assert pulled_away(poor) is None


@for_all(seed=seeds, pairs=st.integers(1, 12), friction=st.sampled_from([0.2, 1.0, 4.0]))
def test_both_paths_of_a_held_body_end_at_index_one(seed, pairs, friction):
    problem = random_problem(seed, pairs, HELD, friction)
    for covering in ("open", "press"):
        path = follow_covering(problem, covering, budget=1000)
        assert path.end == "solution"
        assert in_states(problem, admissible(problem, path.state)).index == 1


@for_all(seed=seeds, pairs=st.integers(1, 4))
def test_one_solution_below_mu_low(seed, pairs):
    bound = mu_low(random_problem(seed, pairs, HELD, 1.0))
    assert len(all_solutions(random_problem(seed, pairs, HELD, 0.99 * bound))) == 1


@pytest.mark.parametrize(
    ("friction", "load", "solutions"),
    [(1.0, 0.5, 1), (1.0, 2.5, 1), (3.0, 0.5, 1), (3.0, 2.5, 3), (3.0, 3.2, 1)],
)
def test_one_node(friction, load, solutions):
    """K = [[2, 1], [1, 2]]: unique below the critical friction 2, else three solutions for 2 < f_t < 3."""
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    problem = ContactProblem.of(W=W, b=W @ [-1.0, load], friction=[friction], motions=np.zeros((2, 0)), scale=1.0)
    found = all_solutions(problem)
    assert len(found) == solutions
    result = solve_contact(problem)
    assert is_one_of(result, found)
    assert (mu_low(problem) > friction) == (friction == 1.0)
    if solutions == 3:
        assert sorted(sign for _, sign in found) == [-1, 1, 1]
        np.testing.assert_allclose(result.y, [[1.0], [-2.5]], atol=1e-12)
        opened = solve_contact(problem, np.array([0]))
        np.testing.assert_allclose([opened.gap[0], opened.slip[0, 0]], [1 / 6, 4 / 3], atol=1e-12)
        sliding = solve_contact(problem, np.array([3]))
        np.testing.assert_allclose([sliding.normal_force[0], sliding.slip[0, 0]], [0.5, 0.5], atol=1e-12)
        assert sliding.index == -1
        assert "more solutions" in sliding.message
