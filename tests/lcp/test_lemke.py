# SPDX-License-Identifier: BSD-3-Clause
"""Lemke's method on problems with known answers, on ties, rays and bad input."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp
from signorini.errors import InputError

KOSTREVA_CYCLING = np.array([[1.0, 2, 0], [0, 1, 2], [2, 0, 1]])
KOSTREVA_UNSOLVABLE = np.array([[1.0, -1, 3], [2, -1, 3], [-1, -2, 0]])
MURTY_211 = (np.array([[-1.5, 2.0], [-4.0, 4.0]]), np.array([-5.0, 17.0]))


def test_ties_do_not_cycle_on_kostreva():
    solution = lcp.solve(KOSTREVA_CYCLING, -np.ones(3), method="lemke")
    assert solution.solved
    np.testing.assert_allclose(solution.z, 1 / 3, rtol=1e-14)


@pytest.mark.parametrize("z0", [None, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]])
def test_a_ray_is_a_ray_and_can_be_checked(z0):
    M, q = KOSTREVA_UNSOLVABLE, -np.ones(3)
    solution = lcp.solve(M, q, method=lcp.Lemke(covering=np.ones(3)), z0=z0)
    assert solution.status is lcp.Status.RAY_TERMINATION
    assert solution.z is None
    assert solution.w is None
    ray = solution.ray
    for t in (0.0, 1.0, 7.0):
        z = ray.point + t * ray.direction
        w = M @ z + q + (ray.theta + t * ray.slope) * ray.covering
        assert min(z.min(), w.min()) > -1e-12
        assert abs(z @ w) < 1e-12


def test_the_covering_vector_decides_in_murty_211():
    solution = lcp.solve(*MURTY_211, method="lemke")
    np.testing.assert_allclose(solution.z, [27, 22.75], rtol=1e-13)
    other = lcp.solve(*MURTY_211, method=lcp.Lemke(covering=[5, 16]))
    assert other.status is lcp.Status.RAY_TERMINATION


@pytest.mark.parametrize("n", [3, 50, 500])
def test_murty_and_fathi(n):
    U = np.eye(n) + 2 * np.triu(np.ones((n, n)), 1)
    last, first = np.eye(n)[-1], np.eye(n)[0]
    np.testing.assert_allclose(lcp.solve(U, -np.ones(n), method="lemke").z, last, atol=1e-13)
    np.testing.assert_allclose(lcp.solve(U.T @ U, -np.ones(n), method="lemke").z, first, atol=1e-13)


def test_a_nonnegative_q_needs_no_pivot():
    solution = lcp.solve(-np.eye(2), [0.0, 3.0], method="lemke")
    assert solution.iterations == 0
    np.testing.assert_array_equal(solution.z, 0.0)


def test_warm_start_from_the_answer_needs_no_pivot():
    rng = np.random.default_rng(1)
    A = rng.standard_normal((40, 40))
    M, q = A @ A.T + np.eye(40) + A - A.T, rng.standard_normal(40)
    cold = lcp.solve(M, q, method="lemke")
    warm = lcp.solve(M, q, method="lemke", z0=cold.z)
    assert cold.iterations > 5
    assert warm.iterations == 0
    np.testing.assert_allclose(warm.z, cold.z, rtol=1e-10, atol=1e-12)


def test_the_limit_is_reported_with_a_candidate_and_no_answer():
    rng = np.random.default_rng(2)
    A = rng.standard_normal((30, 30))
    solution = lcp.solve(A @ A.T, rng.standard_normal(30), method=lcp.Lemke(max_pivots=3))
    assert solution.status is lcp.Status.MAX_ITERATIONS
    assert solution.z is None
    assert solution.candidate.min() >= 0
    assert solution.iterations == 3


def test_rows_and_columns_over_sixteen_decades():
    rng = np.random.default_rng(3)
    A = rng.standard_normal((25, 25))
    M, q = A @ A.T + np.eye(25), rng.standard_normal(25)
    z = lcp.solve(M, q, method="lemke").z
    rows, columns = 10.0 ** rng.uniform(-8, 8, (2, 25))
    scaled = lcp.solve(rows[:, None] * M * columns, rows * q, method="lemke")
    assert scaled.residual.worst < 1e-12
    np.testing.assert_allclose(scaled.z * columns, z, rtol=1e-9)


@pytest.mark.parametrize(
    ("M", "q", "message"),
    [
        ([[1.0, 2.0]], [1.0], "square"),
        (np.eye(2), [1.0], r"q: has shape \(1,\); expected \(2,\)"),
        (np.eye(2), [1.0, np.nan], "1 entries that are NaN"),
        ([[np.inf]], [1.0], "M: has 1 entries"),
        (np.zeros((0, 0)), [], "empty"),
        (np.eye(1) * 1j, [1.0], "complex"),
    ],
)
def test_malformed_input_is_named(M, q, message):
    with pytest.raises(InputError, match=message):
        lcp.solve(M, q)


def test_unknown_method_and_bad_covering_vector():
    with pytest.raises(InputError, match="did you mean 'lemke'"):
        lcp.solve([[1.0]], [1.0], method="lemkee")
    with pytest.raises(InputError, match=r"covering: is 0\.0 in row 1"):
        lcp.solve(np.eye(2), [1.0, -1.0], method=lcp.Lemke(covering=[1, 0]))


@pytest.mark.parametrize("seed", range(6))
def test_a_path_that_ends_within_rounding_of_theta_0_is_no_ray(seed):
    """No pressure at open pairs, so the two slip rows of a pair are 0 together; here rounding makes them negative."""
    posed = problems.gap_slip_contact(8, np.random.default_rng(seed))
    q = posed.q - np.repeat([0.0, 1e-8], [8, 16]) * np.abs(posed.q).max()
    method = lcp.Lemke(covering=posed.covering)
    strict, loose = (lcp.solve(posed.M, q, method=method, tolerance=t) for t in (1e-9, 1e-5))
    assert loose.solved
    assert strict.status is lcp.Status.BREAKDOWN
    assert strict.ray is None
    assert strict.residual.worst < 1e-6
    np.testing.assert_array_equal(strict.candidate, loose.z)
    assert "near theta = 0" in strict.message
    assert "of its largest value" in strict.message


@pytest.mark.parametrize("make", [problems.frictional_contact, problems.gap_slip_contact])
def test_theta_leaves_first_in_ties(make):
    """At an open pair two rows reach 0 together with theta; the textbook choice goes on to the end of the path."""
    for seed in range(20):
        posed = make(10, np.random.default_rng(seed))
        solution = lcp.solve(posed.M, posed.q, method=lcp.Lemke(covering=posed.covering))
        assert solution.solved
        assert "near theta = 0" not in solution.message
