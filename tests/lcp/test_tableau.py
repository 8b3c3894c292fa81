# SPDX-License-Identifier: BSD-3-Clause
"""The tableau after many delayed pivots, against one made anew from the basis; ties, against the basis inverse."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp
from signorini.lcp import walk
from signorini.lcp.delayed import SOLVED, DelayedTableau, Tolerances
from signorini.lcp.tableau import MAX_DELAYED, Tableau


def started(n: int, seed: int) -> Tableau:
    posed = problems.random_psd(n, n, np.random.default_rng(seed), skew=0.3)
    tableau = Tableau(posed.M, posed.q, np.ones(n))
    tableau.pivot(int(np.argmin(posed.q)), 2 * n)
    return tableau


@pytest.mark.parametrize("limit", [1, 2, MAX_DELAYED - 1, MAX_DELAYED, 10 * MAX_DELAYED])
def test_delayed_updates_are_the_updates(limit):
    tableau = started(60, seed=4)
    entering = int(tableau.nonbasic[-1]) + 60
    for _ in range(4):
        reason, entering, _, pivots = tableau.walk(
            entering, limit, Tolerances(pivot=1e-11, tie=1e-12, size=1.0), theta_stays=False
        )
        assert pivots == min(limit, MAX_DELAYED) or reason == SOLVED
        walked = tableau.T.copy()
        assert tableau.refresh()
        np.testing.assert_allclose(walked, tableau.T, atol=1e-11 * np.abs(tableau.T).max())
        np.testing.assert_array_equal(tableau.row_of[tableau.basic], np.arange(60))
        np.testing.assert_array_equal(tableau.column_of[tableau.nonbasic], np.arange(61))
        if reason == SOLVED:
            break
    assert tableau.drift() < 1e-12


@pytest.mark.slow
def test_the_block_does_not_change_the_path(monkeypatch):
    posed = problems.frictional_contact(40, np.random.default_rng(3))
    found = []
    for block in (1, 3, MAX_DELAYED, 500):
        monkeypatch.setattr("signorini.lcp.tableau.MAX_DELAYED", block)
        found.append(lcp.solve(posed.M, posed.q, method="lemke"))
    assert all(solution.solved for solution in found)
    assert len({solution.iterations for solution in found}) == 1
    assert found[0].iterations > 3 * 3


@pytest.mark.parametrize("seed", range(8))
def test_the_lexicographic_row_of_a_tie(seed):
    """With delayed updates present, and w_j in and out of the basis."""
    rng = np.random.default_rng(seed)
    n, used = 7, 2
    M = rng.integers(-2, 3, (n, n)).astype(float)  # small integers: the tie goes on over several columns
    tableau = Tableau(M, np.ones(n), np.ones(n))
    tableau.pivot(0, 2 * n)
    full = np.hstack([np.eye(n), -M, -np.ones((n, 1))])
    inverse = np.linalg.inv(full[:, tableau.basic])
    U, V = np.asfortranarray(rng.integers(-2, 3, (n, 4)).astype(float)), rng.integers(-2, 3, (4, n + 2)).astype(float)
    T = np.asfortranarray(tableau.T + U[:, :used] @ V[:used])
    rates = rng.integers(1, 3, n).astype(float)
    rows = np.sort(rng.permutation(n)[:5])
    expected = min(rows, key=lambda i: tuple(inverse[i] / rates[i]))
    for run in (walk.least_lexicographic, walk.least_lexicographic.py_func):
        arrays = DelayedTableau(
            T, U, V, tableau.basic, tableau.nonbasic, tableau.column_of, tableau.row_of, rows.copy()
        )
        assert run(arrays, used, rates, len(rows), 1e-12) == expected
