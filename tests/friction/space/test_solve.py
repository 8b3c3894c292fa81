# SPDX-License-Identifier: BSD-3-Clause
"""The solver on many pairs: invariances, independent methods, hard problems, loads beyond what friction bears."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.spatial_problems import from_compliance, hard_random, natural_residual
from signorini import lcp
from signorini.condense.operator import InterfaceOperator
from signorini.friction.linear import Equilibrium
from signorini.friction.solve import solve_contact
from signorini.friction.space.sweeps import gauss_seidel
from signorini.settings import SolverSettings
from tests.helpers.contact_samples import block_on_floor, pressed_punch, random_problem
from tests.helpers.faceted import decoded, faceted_lcp
from tests.helpers.limit_load import limit_load
from tests.helpers.violations import violations


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.6, 1.0])
def test_newton_from_sticking_solves_a_punch_in_a_few_steps(friction):
    A, c, problem, root = pressed_punch(100, friction)
    result = solve_contact(problem)
    r = result.r.ravel()
    assert [attempt.method for attempt in result.trace] == ["newton"]
    assert result.trace[0].iterations <= 8
    assert natural_residual(A @ (r * root) + c, r * root, friction, root[:100] ** 2) < 1e-8
    again = solve_contact(problem, result.y)
    assert again.trace[0].iterations == 1
    found = violations(
        result.gap, result.slip, result.normal_force, result.tangential_force, problem.friction, length=1.0, force=1.0
    )
    assert found.worst < 1e-14


@pytest.mark.parametrize("gap", [1.0, 0.0])
def test_random_hard_problems_are_all_solved(gap):
    for _, friction, A, c in hard_random(gap):
        pairs = len(c) // 3
        problem, root = from_compliance(A, c, np.full(pairs, friction))
        r = solve_contact(problem).r.ravel() * root
        assert natural_residual(A @ r + c, r, friction, root[:pairs] ** 2) < 1e-8


@pytest.mark.parametrize("seed", range(4))
def test_turning_the_tangents_turns_the_answer(seed):
    problem = random_problem(seed, 10, friction=0.5, directions=3)
    angle = np.random.default_rng(seed).uniform(0, 2 * np.pi, 10)
    c, s, zero = np.diag(np.cos(angle)), np.diag(np.sin(angle)), np.zeros((10, 10))
    Q = np.block([[np.eye(10), zero, zero], [zero, c, s], [zero, -s, c]])
    W = Q @ problem.W @ Q.T
    turned = replace(problem, image=InterfaceOperator.of_form((W + W.T) / 2, problem.motions), b=Q @ problem.b)
    np.testing.assert_allclose(solve_contact(turned).y.ravel(), Q @ solve_contact(problem).y.ravel(), atol=1e-8)


def test_sweeps_alone_go_to_the_same_forces():
    problem = pressed_punch(25, 0.5)[2]
    r, _ = gauss_seidel(problem, np.zeros((3, 25)), np.zeros(0), count=300)
    np.testing.assert_allclose(r, solve_contact(problem).r, atol=1e-10)


def test_a_proximal_layer_leaves_its_centre_where_that_is_the_solution():
    problem = random_problem(2, 8, friction=0.5, directions=3)
    result = solve_contact(problem)
    h, r = result.h, result.r
    layer = Equilibrium(problem=problem, alpha=0.7, beta=0.7, force=r, motion=np.zeros(0))
    np.testing.assert_allclose(layer.moved(r, np.zeros(0)), h, atol=1e-9)


@pytest.mark.parametrize("facets", [4, 8, 16])
@pytest.mark.parametrize("seed", range(3))
def test_lemke_finds_the_forces_of_the_faceted_newton(seed, facets):
    problem = random_problem(
        seed, 5, friction=np.array([[0.5, 0.3, 0.2, 0.0, 0.7], [0.5, 0.6, 0.2, 0.0, 0.1]]), directions=3, facets=facets
    )
    M, q = faceted_lcp(problem)
    solution = lcp.solve(M, q, method="lemke", tolerance=1e-11)
    assert solution.solved
    result = solve_contact(problem)
    assert result.solved
    np.testing.assert_allclose(decoded(problem, solution.z), result.r, atol=1e-10)


def test_facets_turn_the_force_of_a_slipping_pair_by_no_more_than_half_a_facet():
    for facets in (4, 8, 16, 32):
        bound = 2 * np.sin(np.pi / (2 * facets))
        worst = 0.0
        for angle in np.linspace(0.0, np.pi / 2, 46):
            b = np.array([-1.0, 3 * np.cos(angle), 3 * np.sin(angle)])
            exact, _ = from_compliance(np.eye(3), b, [0.5])
            polygon, _ = from_compliance(np.eye(3), b, [0.5], facets=facets)
            error = solve_contact(exact).tangential_force - solve_contact(polygon).tangential_force
            worst = max(worst, np.linalg.norm(error) / (0.5 * solve_contact(exact).normal_force[0]))
        assert 0.5 * bound < worst <= bound


def test_the_error_of_facets_falls_with_their_number():
    exact = solve_contact(pressed_punch(49, 0.3)[2])
    largest = 0.3 * exact.normal_force.max()
    errors = []
    for facets in (4, 8, 16, 32):
        polygon = solve_contact(pressed_punch(49, 0.3, facets=facets)[2])
        error = np.linalg.norm(polygon.tangential_force - exact.tangential_force, axis=0).max() / largest
        assert error <= 2 * np.sin(np.pi / (2 * facets))
        errors.append(error)
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 0.2 * errors[0]


def test_circular_friction_bears_a_diagonal_drag_up_to_mu_and_the_load_factor_says_so():
    full = block_on_floor(9, (-1.0, 0.6 * 0.6, 0.6 * 0.8, 0, 0, 0))
    base = block_on_floor(9, (-1.0, 0, 0, 0, 0, 0))
    limit = limit_load(full, base.b)
    assert 0.499 <= limit.factor <= 0.5 <= limit.beyond <= 0.501
    assert limit.closed == 9
    assert limit_load(replace(base, b=full.b), full.b) is None


def test_a_limit_load_below_what_statics_allow_names_the_motion():
    # tilted and dragged: forces in the cones could balance the load, but not those that the block takes
    problem = block_on_floor(25, (-1.0, 0.177, -0.23, -0.169, 0.397, 0.126))
    base = block_on_floor(25, (-1.0, 0, 0, 0, 0, 0))
    few = SolverSettings(swept_rounds=2, proximal_rounds=2)
    limit = limit_load(problem, base.b, settings=few)
    assert 0.9 < limit.factor < limit.beyond < 0.95
    assert limit.sticking <= 0.1 * limit.closed
    result = solve_contact(problem, settings=few)
    assert result.outcome == "not_found"
    assert "run away" in result.message
    rho = result.escape
    R = problem.motions
    np.testing.assert_allclose(R @ np.linalg.lstsq(R, rho)[0], rho, atol=1e-5)
    assert rho @ problem.b > 0


def test_a_load_that_has_a_solution_is_reached_as_a_whole():
    full, base = random_problem(5, 6, friction=0.4, directions=3), random_problem(6, 6, friction=0.4, directions=3)
    limit = limit_load(full, base.b)
    assert replace(full, b=base.b).image is full.image
    assert limit.factor == 1.0
    np.testing.assert_allclose(limit.result.y, solve_contact(full).y, atol=1e-8)
