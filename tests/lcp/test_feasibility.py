# SPDX-License-Identifier: BSD-3-Clause
"""The proof that no z >= 0 makes w >= 0."""

import re

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp


@pytest.mark.parametrize("seed", range(3))
def test_auto_names_an_infeasible_problem(seed):
    posed = problems.infeasible(50, np.random.default_rng(seed))
    solution = lcp.solve(posed.M, posed.q)
    assert solution.status is lcp.Status.NO_SOLUTION
    assert re.search(r"Margin: -q\.y is 0\.\d+ of y\.\|q\|", solution.message)


def test_a_ray_is_no_proof():
    """Feasible, but without a solution: min(z_1, w_1) = 0 asks w_2 = -1. Nothing is proved by feasibility."""
    M, q = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([-1.0, 0.0])
    solution = lcp.solve(M, q, method=lcp.Feasibility())
    assert solution.status is lcp.Status.STAGNATION
    assert not solution.solved


@pytest.mark.parametrize("posed", [p for p in problems.bank() if p.n <= 60], ids=lambda p: p.name)
def test_no_proof_against_a_problem_with_a_solution(posed):
    found = lcp.solve(posed.M, posed.q, method=lcp.Feasibility()).status
    if lcp.solve(posed.M, posed.q).solved:
        assert found is lcp.Status.STAGNATION
