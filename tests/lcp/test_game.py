# SPDX-License-Identifier: BSD-3-Clause
"""Bimatrix games: what is found is an equilibrium, told by the costs of every pure strategy."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp


@pytest.mark.parametrize("n", [2, 30, 41, 100, 300])
@pytest.mark.parametrize("ties", [True, False])
def test_no_player_gains_by_another_strategy(n, ties):
    for seed in range(6):
        rng = np.random.default_rng(seed)
        posed = problems.bimatrix_game(n, rng)
        first = np.arange(n) < n // 2
        M = posed.M if ties else np.where(posed.M > 0, posed.M + rng.uniform(-0.5, 0.5, (n, n)), 0.0)
        order, units = rng.permutation(n), 10.0 ** rng.uniform(-6, 6, (2, n))
        turned = (units[0][:, None] * M * units[1])[np.ix_(order, order)]
        solution = lcp.solve(turned, -units[0][order])
        assert solution.solved, solution.message
        assert solution.method == "lemke-howson"
        z = np.empty(n)
        z[order] = solution.z
        z *= units[1]
        for player in (first, ~first):
            costs = M[player] @ z / z[~player].sum()
            mixed = z[player] / z[player].sum()
            assert mixed @ costs == pytest.approx(costs.min(), rel=1e-10)


@pytest.mark.parametrize(
    ("M", "q"),
    [
        ([[0.0, 1.0], [2.0, 0.0]], [-1.0, 1.0]),
        ([[0.0, 1.0], [0.0, 0.0]], [-1.0, -1.0]),
        ([[0.0, -1.0], [2.0, 0.0]], [-1.0, -1.0]),
        ([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]], [-1.0, -1.0, -1.0]),
        (np.zeros((2, 2)), [-1.0, -1.0]),
    ],
)
def test_what_is_no_game_is_not_played(M, q):
    assert lcp.solve(M, q, method="lemke-howson").status is lcp.Status.NOT_APPLICABLE


def test_a_path_that_is_cut_short_is_no_answer():
    games = [problems.bimatrix_game(300, np.random.default_rng(seed)) for seed in range(6)]
    cut = [lcp.solve(game.M, game.q, method=lcp.LemkeHowson(starts=1, rounds=1)) for game in games]
    assert {solution.status for solution in cut} == {lcp.Status.SOLVED, lcp.Status.MAX_ITERATIONS}
    assert all((solution.z is None) is (not solution.solved) for solution in cut)
