# SPDX-License-Identifier: BSD-3-Clause
"""The contact LCPs of the benchmark, from assembled finite elements, against the package's own Coulomb solver."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import lcp_contact
from signorini import lcp
from signorini.friction.solve import solve_contact


@pytest.fixture
def law(monkeypatch):
    """The laws that the generators see on their way."""
    seen = []
    loaded = lcp_contact.loaded
    monkeypatch.setattr(lcp_contact, "loaded", lambda *given: seen.append(loaded(*given)) or seen[-1])
    return seen


@pytest.mark.parametrize("method", ["lemke", "auto"])
@pytest.mark.parametrize("seed", range(4))
def test_force_form_of_the_rough_block(seed, method, law):
    posed = lcp_contact.rough_block(60, np.random.default_rng(seed))
    z, w = agreed(posed, method)
    p, gap = z[:20], w[:20]
    p_t = z[20:40] - law[0].mu * p
    compared(law[0], p, p_t, gap, w[20:40] - z[40:])


@pytest.mark.parametrize("method", ["lemke", "auto"])
@pytest.mark.parametrize("seed", range(4))
def test_gap_slip_form_of_the_cylinder(seed, method, law):
    posed = lcp_contact.cylinder(60, np.random.default_rng(seed))
    z, w = agreed(posed, method)
    n, moves = law[0].pairs, np.flatnonzero(~law[0].locked)
    slip, p_t = np.zeros((2, n))
    slip[moves] = z[n : n + len(moves)] - z[n + len(moves) :]
    p_t[moves] = (w[n : n + len(moves)] - w[n + len(moves) :]) / 2
    assert n - len(moves) == 1
    compared(law[0], w[:n], p_t, z[:n], slip)


def agreed(posed, method):
    solution = lcp.solve(posed.M, posed.q, method=lcp.Lemke(covering=posed.covering) if method == "lemke" else method)
    assert solution.solved, solution.message
    return solution.z, solution.w


def compared(law, p, p_t, gap, slip):
    """With the answer of the law's solver, in all four quantities; contact, gaps and slip all occur."""
    result = solve_contact(law)
    assert result.solved
    size = np.abs(law.b).max()
    closed = p > 1e-9 * size
    assert 0 < closed.sum() < len(p)
    assert np.abs(slip[closed]).max() > 1e-6 * size
    np.testing.assert_allclose(p, result.normal_force, atol=1e-8 * size)
    np.testing.assert_allclose(p_t, result.tangential_force[0], atol=1e-8 * size)
    np.testing.assert_allclose(gap, result.gap, atol=1e-8 * size)
    np.testing.assert_allclose(slip[closed], result.slip[0, closed], atol=1e-8 * size)
