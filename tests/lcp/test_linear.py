# SPDX-License-Identifier: BSD-3-Clause
"""Linear systems with rows and columns of few entries, which are taken out first, against NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from signorini.lcp.linear import LIGHT_ROWS_SIZE, factorised


def system(rng: np.random.Generator, *, lone: int, light: int) -> np.ndarray:
    """Dense, but for some columns with one entry and some rows with two, in random order."""
    n = LIGHT_ROWS_SIZE + 60
    A = rng.standard_normal((n, n)) + n**0.5 * np.eye(n)
    A[:, :lone] = 0.0
    A[np.arange(lone), np.arange(lone)] = rng.uniform(1, 2, lone)
    for row in range(lone, lone + light):
        A[row] = 0.0
        A[row, [row, row + light]] = 1.0, rng.uniform(-2, 2)
    return A[rng.permutation(n)][:, rng.permutation(n)]


@pytest.mark.parametrize(("lone", "light"), [(0, 0), (60, 0), (0, 60), (60, 60), (5, 80)])
@pytest.mark.parametrize("columns", [None, 3])
def test_against_numpy(lone, light, columns):
    rng = np.random.default_rng(lone + light)
    A = system(rng, lone=lone, light=light)
    b = rng.standard_normal(len(A) if columns is None else (len(A), columns))
    np.testing.assert_allclose(factorised(A)(b), np.linalg.solve(A, b), rtol=1e-8, atol=1e-9)


def test_singular_ones_are_named():
    A = system(np.random.default_rng(0), lone=60, light=60)
    zero, twice, lone = A.copy(), A.copy(), A.copy()
    zero[:, 7] = 0.0
    twice[3] = 2 * twice[8]
    lone[:, :50] = 0.0
    lone[0, :50] = 1.0
    assert factorised(zero) is None
    assert factorised(twice) is None
    assert factorised(lone) is None
    assert factorised(np.zeros((LIGHT_ROWS_SIZE + 1, LIGHT_ROWS_SIZE + 1))) is None
