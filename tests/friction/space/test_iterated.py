# SPDX-License-Identifier: BSD-3-Clause
"""The iterated system against the factorised one: sticking, slipping and open pairs, held and floating bodies."""

import numpy as np
import pytest

from signorini.friction.krylov import iterate
from signorini.friction.linear import Equilibrium, Unknowns, linear_system
from signorini.friction.solve import solve_contact
from tests.helpers.spatial_samples import block_on_floor, pressed_punch, random_problem

PROBLEMS = {
    "punch": pressed_punch(49, 0.4)[2],
    "floating": block_on_floor((-3.0, 0.4, 0.2, 0.3, 0.1, 0.2), 0.4, side=4)[0],
    "bounded": random_problem(5, 12, 0.3, tresca=np.arange(12) % 2 == 0),
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
        h = Unknowns(law).prescribed(h)
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
