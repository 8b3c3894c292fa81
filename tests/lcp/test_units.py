# SPDX-License-Identifier: BSD-3-Clause
"""A solution is judged row by row, in units of the row: against rational numbers, and beside other units."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from signorini import lcp

METHODS = ("auto", "lemke", "newton", "block-pivoting", "interior-point", "projected-sor", "mprgp")


def exact_solution(M, q):
    """z in rational numbers: the first complementary basis, of all, whose z and w are not negative."""
    n = len(q)
    entries, right = [[Fraction(x) for x in row] for row in M.tolist()], [Fraction(x) for x in q.tolist()]
    for active in itertools.product((False, True), repeat=n):
        z = [Fraction(0)] * n
        basis = [i for i in range(n) if active[i]]
        for i, value in zip(basis, eliminated(entries, right, basis), strict=True):
            z[i] = value
        w = [sum(a * b for a, b in zip(row, z, strict=True)) + c for row, c in zip(entries, right, strict=True)]
        if min(z) >= 0 and min(w) >= 0:
            return np.array([float(value) for value in z])
    raise AssertionError("a P-matrix has a solution")


def eliminated(entries, right, basis):
    """``M_BB^-1 (-q_B)`` by Gauss and Jordan; the principal blocks of a P-matrix are regular."""
    rows = [[entries[i][j] for j in basis] + [-right[i]] for i in basis]
    for c, _ in enumerate(basis):
        p = next(r for r in range(c, len(rows)) if rows[r][c] != 0)
        rows[c], rows[p] = rows[p], rows[c]
        rows[c] = [value / rows[c][c] for value in rows[c]]
        for r in range(len(rows)):
            if r != c:
                rows[r] = [a - rows[r][c] * b for a, b in zip(rows[r], rows[c], strict=True)]
    return [row[-1] for row in rows]


def reaches(M, q):
    """Whether there is a solution, in rational numbers: shares, none negative, of independent columns make q up."""
    n = len(q)
    entries, right = [[Fraction(x) for x in row] for row in M.tolist()], [Fraction(x) for x in q.tolist()]
    for kinds in itertools.product("-wz", repeat=n):
        columns = [[Fraction(i == j) for i in range(n)] if kind == "w" else [-row[j] for row in entries]
                   for j, kind in enumerate(kinds) if kind != "-"]  # fmt: skip
        shares = combined(columns, right)
        if shares is not None and min(shares, default=0) >= 0:
            return True
    return False


def combined(columns, right):
    """What of each column adds up to a right-hand side; None where they do not, or depend on each other."""
    rows = [[column[i] for column in columns] + [value] for i, value in enumerate(right)]
    for c, _ in enumerate(columns):
        p = next((r for r in range(c, len(rows)) if rows[r][c] != 0), None)
        if p is None:
            return None
        rows[c], rows[p] = rows[p], rows[c]
        rows[c] = [value / rows[c][c] for value in rows[c]]
        for r in range(len(rows)):
            if r != c and rows[r][c] != 0:
                rows[r] = [a - rows[r][c] * b for a, b in zip(rows[r], rows[c], strict=True)]
    return None if any(row[-1] != 0 for row in rows[len(columns) :]) else [row[-1] for row in rows[: len(columns)]]


def singular(seed):
    """A singular M of small whole numbers, and a q that it reaches but for 0.1 to 1e-13."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    rank = int(rng.integers(1, n))
    A, S = rng.integers(-3, 4, (n, rank)).astype(float), rng.integers(-2, 3, (rank, rank))
    other = rng.integers(-3, 4, (rank, n)).astype(float)
    M = [A @ A.T, A @ (np.eye(rank) + S - S.T) @ A.T, A @ other][rng.integers(3)]
    z = rng.integers(0, 4, n) * (rng.random(n) < 0.7)
    w = rng.integers(0, 3, n) * (z == 0) * (rng.random(n) < 0.5)
    return M, w - M @ z + 10.0 ** -rng.uniform(1, 13) * rng.normal(size=n) * (rng.random(n) < 0.7)


def scattered(seed):
    """A diagonally dominant problem, coupled weakly or not at all, in units over up to 30 decades."""
    rng = np.random.default_rng(seed)
    n, decades = int(rng.integers(1, 6)), rng.choice([0, 3, 6, 9, 12, 15])
    M = rng.uniform(-1, 1, (n, n)) * 10.0 ** -rng.uniform(0, rng.choice([0.1, 5, 15]), (n, n))
    M *= rng.random((n, n)) < rng.choice([0.3, 0.7, 1])
    M = np.tril(M) if rng.random() < 0.3 else M
    np.fill_diagonal(M, 0.0)
    np.fill_diagonal(M, 1.2 * np.abs(M).sum(axis=1) + rng.choice([1.0, 1e-3]))
    q = rng.normal(size=n) * 10.0 ** -rng.uniform(0, rng.choice([0.1, 6, 16]), n) * (rng.random(n) > 0.15)
    rows, columns = 10.0 ** rng.uniform(-decades, decades, (2, n))
    rows = np.ones(n) if rng.random() < 0.3 else rows
    return rows[:, None] * M * columns, rows * q


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_what_is_solved_is_so_in_every_row(seed):
    M, q = scattered(seed)
    z = exact_solution(M, q)
    size = np.abs(q) + np.abs(M) @ z
    size[size == 0] = 1.0
    alone = np.divide(size[:, None], np.abs(M), out=np.full(M.shape, np.inf), where=M != 0).min(axis=0)
    for method in (METHODS[0], METHODS[seed % len(METHODS)]):
        solution = lcp.solve(M, q, method=method)
        assert solution.solved or method != "auto", solution.message
        if solution.solved:
            w, share = solution.w / size, solution.z / np.where(z > 0, z, alone)
            assert max((-w).max(), (-share).max(), np.minimum(w, share).max()) < 1e-6


def test_a_large_z_hides_no_row_that_misses():
    """The rows add up to ``w_1 + w_2 = -5e-6``, whatever z: 500000 times as large as q, it hides that in its terms."""
    assert not lcp.solve([[1.0, -1.0], [-1.0, 1.0]], [-1.0, 1.0 - 5e-6]).solved


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 600, 50))
def test_singular_problems_nearly_without_solution(first):
    """What is solved misses no row by 1e-6 of q, exactly; what is not has no solution."""
    for seed in range(first, first + 50):
        M, q = singular(seed)
        solution = lcp.solve(M, q)
        if not solution.solved:
            assert not reaches(M, q), seed
            continue
        z = [Fraction(x) for x in solution.z.tolist()]
        w = [sum(Fraction(a) * b for a, b in zip(row, z, strict=True)) for row in M.tolist()]
        missed = [abs(min(a + Fraction(b), c)) for a, b, c in zip(w, q.tolist(), z, strict=True)]
        assert max(missed) <= 1e-6 * np.abs(q).max(), seed


@pytest.mark.parametrize("method", METHODS)
def test_a_large_row_excuses_no_small_one(method):
    solution = lcp.solve(np.diag([1e-10, 1e10]), [-1.0, -1.0], method=method)
    assert solution.solved
    np.testing.assert_allclose(solution.z, [1e10, 1e-10], rtol=1e-6)


@pytest.mark.parametrize("coupling", [0.0, 1e-30, 1e-18])
@pytest.mark.parametrize("decades", [-14, -10, -6, 6, 10, 14])
def test_no_solution_beside_larger_numbers(coupling, decades):
    """The first two rows add up to less than -1: an enormous z_1 = z_2 balances that beside larger data."""
    M = np.array([[1.0, -1, -coupling, 0], [-1, 1, 0, 0], [0, 0, 2, 1], [0, coupling, 1, 2]])
    units = 10.0 ** np.array([-decades, -decades, decades, decades])
    assert not lcp.solve(units[:, None] * M, units * [-1.0, 0, -1, -1]).solved
    assert not lcp.solve(units[:, None] * M, [-1.0, 0, -1, -1]).solved


def test_rounding_where_nothing_is_left_is_no_violation():
    """The answer decays by 0.27 a row, to far below what iterations can tell from 0 beside its largest value."""
    n = 20_000
    M = sp.diags_array([-1.0, 4.0, -1.0], offsets=[-1, 0, 1], shape=(n, n)).tocsr()
    q = np.zeros(n)
    q[7] = -1.0
    solution = lcp.solve(M, q)
    assert solution.chain[-1].startswith("multigrid: SOLVED")
    np.testing.assert_allclose(solution.z[7], (1.0 - (2.0 - 3.0**0.5) ** 16) / 12.0**0.5, rtol=1e-9)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("unit", [1e-310, 1e-290, 1e290])
def test_numbers_at_the_ends_of_the_range_are_numbers(unit):
    """Whose reciprocals overflow, and whose squares do."""
    found = lcp.solve(unit * np.array([[2.0, 1.0], [1.0, 2.0]]), unit * np.array([-5.0, -6.0]))
    np.testing.assert_allclose(found.z, [4.0 / 3.0, 7.0 / 3.0], rtol=1e-9)
