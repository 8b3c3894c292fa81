# SPDX-License-Identifier: BSD-3-Clause
"""Bounds and free variables, reduced and put back."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from signorini import lcp
from signorini.errors import InputError


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("sparse", [False, True])
def test_a_box_problem_made_from_its_answer(seed, sparse):
    rng = np.random.default_rng(seed)
    n = 12
    B = rng.standard_normal((n, n))
    M = B @ B.T + np.eye(n) + 0.5 * (B - B.T)
    lower, upper = rng.uniform(-2, 0, n), rng.uniform(0.5, 2, n)
    lower[rng.random(n) < 0.3], upper[rng.random(n) < 0.3] = -np.inf, np.inf
    upper[:2] = lower[:2] = 0.3
    inside = rng.uniform(0, 1, n) * 0.4
    side = rng.integers(0, 3, n)
    z = np.where((side == 0) & np.isfinite(lower), lower, np.where((side == 1) & np.isfinite(upper), upper, inside))
    z[:2] = 0.3
    w = np.where(z == lower, rng.uniform(0.1, 1, n), 0.0) - np.where((z == upper) & (z != lower), 0.7, 0.0)
    q = w - M @ z
    box = lcp.BoxLCP(M=sp.csr_array(M) if sparse else M, q=q, lower=lower, upper=upper)
    solution = box.solve()
    assert solution.solved, solution.message
    np.testing.assert_allclose(solution.z, z, atol=1e-10)
    np.testing.assert_allclose(solution.w, w, atol=1e-9)


@pytest.mark.parametrize("seed", range(10))
def test_a_mixed_problem_made_from_its_answer(seed):
    rng = np.random.default_rng(seed)
    n = 15
    B = rng.standard_normal((n, n))
    M = B @ B.T + np.eye(n) + B - B.T
    free = rng.random(n) < 0.4
    z = np.where(free, rng.standard_normal(n), np.maximum(rng.standard_normal(n), 0))
    w = np.where(free | (z > 0), 0.0, rng.uniform(0, 1, n))
    solution = lcp.MixedLCP(M=M, q=w - M @ z, free=free).solve()
    assert solution.solved, solution.message
    np.testing.assert_allclose(solution.z, z, atol=1e-10)


def test_all_free_is_a_linear_system_and_all_fixed_is_nothing():
    M, q = np.array([[2.0, 1.0], [1.0, 3.0]]), np.array([1.0, -1.0])
    free = lcp.MixedLCP(M=M, q=q, free=[True, True]).solve()
    np.testing.assert_allclose(free.z, np.linalg.solve(M, -q))
    fixed = lcp.BoxLCP(M=M, q=q, lower=[1.0, 2.0], upper=[1.0, 2.0]).solve()
    np.testing.assert_array_equal(fixed.z, [1.0, 2.0])


def test_an_undetermined_free_variable_is_reported():
    solution = lcp.MixedLCP(M=[[0.0, 1.0], [1.0, 1.0]], q=[0.0, 1.0], free=[True, False]).solve()
    assert solution.status is lcp.Status.SINGULAR
    assert solution.z is None


@pytest.mark.parametrize(
    ("lower", "upper", "message"),
    [([1.0], [0.0], "lower <= upper"), ([np.nan], [1.0], "NaN"), ([0.0, 0.0], [1.0], "shape")],
)
def test_wrong_bounds(lower, upper, message):
    with pytest.raises(InputError, match=message):
        lcp.BoxLCP(M=[[1.0]], q=[1.0], lower=lower, upper=upper).solve()
