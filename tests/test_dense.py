# SPDX-License-Identifier: BSD-3-Clause
"""Dense systems have the digits of SciPy's functions."""

import numpy as np
import pytest
import scipy.linalg

from signorini import dense


@pytest.mark.parametrize("shape", [(6,), (6, 4), (0,), (0, 3)])
def test_digits_of_scipy(shape):
    rng = np.random.default_rng(4)
    n = shape[0]
    T, b = np.triu(rng.random((n, n))) + np.eye(n), rng.random(shape)
    for triangle in (T, np.asfortranarray(T)):
        for transposed in (False, True):
            expected = scipy.linalg.solve_triangular(triangle, b, trans=int(transposed))
            np.testing.assert_array_equal(dense.solve_triangular(triangle, b, transposed=transposed), expected)
    expected = scipy.linalg.solve_triangular(T.T, b, lower=True)
    np.testing.assert_array_equal(dense.solve_triangular(T.T, b, lower=True), expected)
    np.testing.assert_array_equal(dense.solve_cholesky(T.T, b), scipy.linalg.cho_solve((T.T, True), b))


@pytest.mark.parametrize("n", [0, 1, 3, 70])
def test_eigenvectors_of_scipy(n):
    A = np.random.default_rng(5).random((n, n))
    for found, expected in zip(dense.symmetric_eigen(A + A.T), scipy.linalg.eigh(A + A.T), strict=True):
        np.testing.assert_array_equal(found, expected)


def test_a_singular_triangle_is_told():
    with pytest.raises(np.linalg.LinAlgError, match="singular matrix: resolution failed at diagonal 1"):
        dense.solve_triangular(np.diag([1.0, 0.0]), np.ones(2))
