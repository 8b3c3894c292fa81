# SPDX-License-Identifier: BSD-3-Clause
"""Iterated systems against factorised ones: sticking, slipping and open pairs, held and floating bodies, bounds."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume
from hypothesis import strategies as st

from signorini.friction.krylov import iterate
from signorini.friction.linear import Equilibrium, linear_system
from signorini.friction.newton import by_states
from signorini.friction.solve import solve_contact
from signorini.law.pair import Tangent
from tests.helpers.contact_samples import block_on_floor, for_all, pressed_punch, random_problem

PROBLEMS = {
    "punch": pressed_punch(49, 0.4)[2],
    "floating": block_on_floor(16, (-3.0, 0.4, 0.2, 0.3, 0.1, 0.2), 0.4),
    "bounded": random_problem(5, 12, friction=0.3, directions=3, tresca=np.arange(12) % 2 == 0),
    "ellipses": random_problem(3, 12, friction=np.outer([0.3, 0.1], np.ones(12)), directions=3),
    "lines": random_problem(3, 12, friction=np.outer([0.3, 0.0], np.ones(12)), directions=3),
    "facets": random_problem(2, 12, friction=0.3, directions=3, facets=4),
}


@pytest.mark.parametrize("name", PROBLEMS)
def test_a_linearised_law_is_solved_as_by_a_factorisation(name):
    """The law at the solution, where some pairs slip and some are open, and that where all stick."""
    problem = PROBLEMS[name]
    form = Equilibrium(problem=problem)
    y = solve_contact(problem).y
    for law in (problem.law.sticking, problem.law.tangent(y)):
        expected = linear_system(form, law).solve(np.zeros_like(y), np.zeros(problem.motions.shape[1]))
        r, a = np.zeros_like(y), np.zeros(problem.motions.shape[1])
        for _ in range(8):  # each time a hundredth of what is lacking is left, or less
            r, a, h = iterate(problem, law, r, a, forward=1e-2)
        for found, known in zip((r, a, h), expected, strict=True):
            np.testing.assert_allclose(found, known, rtol=0, atol=1e-10 * np.abs(expected[0]).max())


@pytest.mark.parametrize("name", PROBLEMS)
def test_newton_ends_where_it_does_with_factorisations(name, monkeypatch):
    problem = PROBLEMS[name]
    expected = solve_contact(problem)
    monkeypatch.setattr("signorini.friction.newton.ITERATED_UNKNOWNS", 1)
    found = solve_contact(problem)
    assert found.trace[0].iterations <= expected.trace[0].iterations + 4
    np.testing.assert_array_equal(found.state, expected.state)
    np.testing.assert_allclose(found.y, expected.y, rtol=0, atol=1e-9 * np.abs(expected.y).max())


def test_what_cannot_be_balanced_is_said():
    problem = PROBLEMS["floating"]
    n = problem.pairs
    law = problem.law.tangent(-np.ones((3, n)))  # every pair is open
    a = np.zeros(problem.motions.shape[1])
    assert len(a)
    assert iterate(problem, law, np.zeros((3, n)), a, forward=1e-2) is None


@for_all(examples=30, seed=st.integers(0, 10**6), motions=st.sampled_from([0, 2]), bounded=st.booleans())
def test_the_states_of_a_solution_are_balanced_as_by_a_factorisation(seed, motions, bounded):
    problem, rng = random_problem(seed, 12, motions, 0.3), np.random.default_rng(seed)
    if bounded:
        problem = replace(problem, limit=rng.uniform(0.05, 0.3, 12), adhesion=rng.uniform(0.0, 0.04, 12))
    end = by_states(problem)
    assume(end.attempt.end == "certified")
    law = Tangent.of_states(problem.pieces, end.state)
    r, a = np.zeros((2, 12)), np.zeros(motions)
    for _ in range(12):  # each time a thousandth of what is lacking is left
        r, a, h = iterate(problem, law, r, a, forward=1e-3)
    np.testing.assert_allclose(r - h, end.y, rtol=0, atol=1e-9 * np.abs(end.y).max())


@pytest.mark.parametrize("load", [(-1.0, 0.1, 0.0), (-3.0, 0.4, 0.5), (-1.0, 0.29, 0.2)])
@pytest.mark.parametrize("pairs", [8, 30])
def test_newton_by_states_ends_where_it_does_with_factorisations(load, pairs, monkeypatch):
    problem = block_on_floor(pairs, load)
    expected = by_states(problem)
    monkeypatch.setattr("signorini.friction.newton.ITERATED_UNKNOWNS", 1)
    found = by_states(problem)
    assert found.attempt.end == expected.attempt.end
    if found.attempt.end == "certified":
        assert (found.index, found.residual <= 1e-10) == (expected.index, True)
        np.testing.assert_array_equal(found.state, expected.state)
        np.testing.assert_allclose(found.y, expected.y, rtol=0, atol=1e-10 * np.abs(expected.y).max())


def test_an_answer_that_others_follow_has_the_digits_asked_for(monkeypatch):
    problem = PROBLEMS["punch"]
    monkeypatch.setattr("signorini.friction.newton.ITERATED_UNKNOWNS", 1)
    exact, rough = solve_contact(problem), solve_contact(problem, allowed=1e-4)
    assert rough.trace[0].iterations < exact.trace[0].iterations
    assert exact.residual < 1e-10 < rough.residual <= 1e-4
