# SPDX-License-Identifier: BSD-3-Clause
"""Only ``solve`` grants SOLVED, whatever a method says; its chain and its messages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp
from signorini.errors import InputError
from signorini.lcp.solution import Attempt

M, q = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-5.0, -6.0])
ANSWER = np.array([4 / 3, 7 / 3])


@dataclass(frozen=True, kw_only=True)
class Claims:
    """A method that says what it is told to say."""

    name: ClassVar[str] = "claims"
    matrices: ClassVar[str] = "any"

    z: tuple[float, ...] | None
    ending: lcp.Status = lcp.Status.SOLVED

    def attempt(self, problem, z0, tolerance):  # noqa: ARG002
        return Attempt(z=None if self.z is None else np.array(self.z), ending=self.ending, iterations=1)


@pytest.mark.parametrize("z", [(0.0, 0.0), (-1.0, 3.0), (1.0, 2.0), (1e9, 1e9)])
def test_a_false_claim_is_a_breakdown(z):
    solution = lcp.solve(M, q, method=Claims(z=z))
    assert solution.status is lcp.Status.BREAKDOWN
    assert solution.z is None
    np.testing.assert_array_equal(solution.candidate, z)
    assert "Natural residual of the candidate" in solution.message


@pytest.mark.parametrize("z", [(np.nan, 1.0), (np.inf, 0.0)])
def test_a_claim_that_is_not_a_number(z):
    assert lcp.solve(M, q, method=Claims(z=z)).status is lcp.Status.NONFINITE


def test_a_right_candidate_is_solved_whatever_the_method_thinks():
    solution = lcp.solve(M, q, method=Claims(z=tuple(ANSWER), ending=lcp.Status.MAX_ITERATIONS))
    assert solution.solved
    assert not solution.z.flags.writeable


def test_rounding_in_an_enormous_z_is_no_solution():
    """w = z_1 - z_2 - 1 and z_2 - z_1: no solution, but large z_1 = z_2 balances everything relatively."""
    A, b = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([-1.0, 0.0])
    assert not lcp.solve(A, b, method=Claims(z=(1e15, 1e15))).solved
    assert lcp.all_solutions(A, b) == ()


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan])
def test_a_tolerance_is_positive(tolerance):
    with pytest.raises(InputError, match="tolerance"):
        lcp.solve(M, q, tolerance=tolerance)


@pytest.mark.parametrize("z0", [[1.0], [np.nan, 0.0]])
def test_a_start_fits_and_is_finite(z0):
    with pytest.raises(InputError, match="z0"):
        lcp.solve(M, q, z0=z0)


@pytest.mark.parametrize("status", list(lcp.Status))
def test_every_status_says_what_happened(status):
    assert len(status.value) > 40
    assert status.value.endswith(".")


def test_auto_starts_with_lemke_where_two_multipliers_rise_together():
    """The gap-slip form, whose bases are often singular, at a size where other matrices start with a factorisation."""
    n = 510
    posed = problems.gap_slip_contact(n, np.random.default_rng(5), friction=3.0)
    solution = lcp.solve(posed.M, posed.q)
    assert solution.solved
    assert solution.chain == (f"lemke: SOLVED after {solution.iterations} iterations",)
    other = problems.random_p(3 * n, np.random.default_rng(5))
    assert lcp.solve(other.M, other.q).method == "block-pivoting"
