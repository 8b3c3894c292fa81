# SPDX-License-Identifier: BSD-3-Clause
"""Screened enumeration finds what enumeration of every support finds, and only clear cases are screened away."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp
from signorini.lcp import screening


def everything(A, q, tolerance, lack):  # noqa: ARG001
    lack[:] = 0.0


def described(M, q):
    return [(face.support, face.dimension, face.z.round(7).tolist()) for face in lcp.all_solutions(M, q)]


def small_integers(rng: np.random.Generator, kind: int) -> tuple[np.ndarray, np.ndarray]:
    """Matrices full of singular blocks, exact zeros and ties."""
    n = int(rng.integers(1, 6))
    B = rng.integers(-1, 2, (n, int(rng.integers(1, n + 1)))).astype(float)
    M = (B @ B.T, rng.integers(-1, 3, (n, n)).astype(float), B @ B.T + np.triu(np.ones((n, n)), 1))[kind]
    return M, rng.integers(-2, 2, n).astype(float)


@pytest.mark.parametrize("kind", range(3))
@pytest.mark.parametrize("seed", range(40))
def test_screening_loses_no_face(seed, kind, monkeypatch):
    M, q = small_integers(np.random.default_rng(seed), kind)
    screened = described(M, q)
    monkeypatch.setattr(screening, "screen", everything)
    assert screened == described(M, q)


def test_screening_loses_no_face_of_contact(monkeypatch):
    posed = problems.gap_slip_contact(3, np.random.default_rng(2), friction=1.2)
    screened = described(posed.M, posed.q)
    assert screened
    monkeypatch.setattr(screening, "screen", everything)
    assert screened == described(posed.M, posed.q)


def test_screening_leaves_little():
    rng = np.random.default_rng(0)
    for posed in (problems.random_psd(10, 5, rng, skew=0.3), problems.gap_slip_contact(3, rng)):
        lack = np.zeros(2**posed.n)
        screening.screen(posed.M, posed.q, 1e-11, lack)
        assert (lack >= 0.0).all()
        assert 1 <= (lack == 0.0).sum() <= 2**posed.n // 16


@pytest.mark.parametrize(
    ("M", "q", "margin", "screened"),
    [
        ([[-1.0]], [-2.0], 1.0, True),
        ([[-1.0]], [-2.0], 0.5, False),
        ([[1, -1], [-1, 1]], [-1, 0.5], 0.25, True),
        ([[1, -1], [-1, 1]], [-1, 0.5], 0.25, False),
        ([[1, -1], [-1, 1]], [-1, 1 - 4e-6], 2e-6, True),
    ],
)
def test_a_proof_tells_its_margin(M, q, margin, screened, monkeypatch):
    """What every support lacks as it is, or at the best with z and w both a little negative."""
    if not screened:
        monkeypatch.setattr(screening, "screen", everything)
    solution = lcp.solve(M, q, method="enumeration")
    assert solution.status is lcp.Status.NO_SOLUTION
    assert f"lacks {margin:.2g} of the largest entry of q" in solution.message


@pytest.mark.parametrize("method", [lcp.Enumeration(), lcp.Feasibility()])
def test_what_lacks_no_more_than_rounding_is_no_proof(method):
    solution = lcp.solve([[1, -1], [-1, 1]], [-1, 1 - 4e-10], method=method)
    assert solution.status in (lcp.Status.BREAKDOWN, lcp.Status.STAGNATION)


def test_elimination_has_the_rank_and_the_solution():
    rng = np.random.default_rng(1)
    for rank in (1, 3, 5):
        A = rng.standard_normal((5, rank)) @ rng.standard_normal((rank, 5))
        b = A @ rng.standard_normal(5)
        block, order = np.hstack([A, b[:, None]]), np.zeros(5, dtype=np.int64)
        assert screening.eliminate_pivoting(block, 5, order) == rank
        screening.substitute_back(block, 5, rank)
        x = np.zeros(5)
        x[order[:rank]] = block[:rank, 5]
        np.testing.assert_allclose(A @ x, b, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("make", [problems.random_p, lambda n, rng: problems.random_psd(n, n, rng, skew=0.3)])
def test_twenty_unknowns(make):
    posed = make(20, np.random.default_rng(3))
    (face,) = lcp.all_solutions(posed.M, posed.q)
    np.testing.assert_allclose(face.z, posed.answer, atol=1e-8)
