# SPDX-License-Identifier: BSD-3-Clause
"""What must hold for every problem: answers chosen first, scaling, order, form."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks import lcp_problems as problems
from signorini import lcp

seeds = st.integers(0, 2**31)
sizes = st.integers(1, 25)
METHODS = ["lemke", "least-index", "block-pivoting", "newton", "auto"]


def p_problem(seed: int, n: int) -> problems.PosedLCP:
    rng = np.random.default_rng(seed)
    return problems.random_p(n, rng) if seed % 2 else problems.random_psd(n, n + 2, rng, skew=0.4)


@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=25, deadline=None)
@given(seed=seeds, n=sizes)
def test_finds_the_chosen_answer(method, seed, n):
    posed = p_problem(seed, n)
    solution = lcp.solve(posed.M, posed.q, method=method)
    np.testing.assert_allclose(solution.z, posed.answer, atol=1e-7 * max(1, np.linalg.cond(posed.M) * 1e-7))


@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=25, deadline=None)
@given(seed=seeds, n=sizes, decades=st.floats(0, 8))
def test_positive_scaling_of_rows_and_columns(method, seed, n, decades):
    posed = p_problem(seed, n)
    rows, columns = 10.0 ** np.random.default_rng(seed).uniform(-decades, decades, (2, n))
    solution = lcp.solve(rows[:, None] * posed.M * columns, rows * posed.q, method=method)
    assert solution.solved, solution.message
    accuracy = 1e-7 * max(1, np.linalg.cond(posed.M) * 1e-7)
    np.testing.assert_allclose(solution.z * columns, posed.answer, atol=accuracy)


@settings(max_examples=25, deadline=None)
@given(seed=seeds, n=sizes)
def test_order_of_the_unknowns(seed, n):
    posed = p_problem(seed, n)
    order = np.random.default_rng(seed).permutation(n)
    plain = lcp.solve(posed.M, posed.q)
    turned = lcp.solve(posed.M[np.ix_(order, order)], posed.q[order])
    np.testing.assert_allclose(turned.z, plain.z[order], atol=1e-7 * max(1, np.linalg.cond(posed.M) * 1e-7))


@settings(max_examples=25, deadline=None)
@given(seed=seeds, n=sizes)
def test_dense_and_sparse_agree(seed, n):
    posed = p_problem(seed, n)
    dense, sparse = lcp.solve(posed.M, posed.q), lcp.solve(sp.csr_array(posed.M), posed.q)
    np.testing.assert_allclose(sparse.z, dense.z, atol=1e-7 * max(1, np.linalg.cond(posed.M) * 1e-7))


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seed=seeds, n=st.integers(1, 6))
def test_any_matrix_agrees_with_the_referee(seed, n):
    """No class at all: small integers, full of ties and singular blocks."""
    rng = np.random.default_rng(seed)
    M, q = rng.integers(-2, 3, (n, n)).astype(float), rng.integers(-2, 3, n).astype(float)
    faces = lcp.all_solutions(M, q)
    solution = lcp.solve(M, q)
    assert solution.solved is bool(faces), (M, q, solution.message)
    for face in faces:
        assert lcp.natural_residual(M, q, face.z).worst < 1e-9
        assert set(face.support) == set(np.flatnonzero(face.z > 1e-9))
        for direction in face.directions.T:
            assert lcp.natural_residual(M, q, face.z + 1e-4 * direction).worst < 1e-9
    for method in ("lemke", "newton", "block-pivoting", "interior-point", "least-index"):
        claimed = lcp.solve(M, q, method=method)
        assert bool(faces) or not claimed.solved


@settings(max_examples=40, deadline=None)
@given(seed=seeds, n=sizes)
def test_the_residual_ignores_units_and_sees_errors(seed, n):
    posed = p_problem(seed, n)
    rng = np.random.default_rng(seed)
    wrong = posed.answer + rng.uniform(0.1, 0.5, n)
    first = lcp.natural_residual(posed.M, posed.q, wrong).worst
    rows, columns = 2.0 ** rng.integers(-20, 20, (2, n))
    second = lcp.natural_residual(rows[:, None] * posed.M * columns, rows * posed.q, wrong / columns).worst
    assert first > 1e-3
    assert second == pytest.approx(first, rel=0.5)
