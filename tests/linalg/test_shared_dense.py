# SPDX-License-Identifier: BSD-3-Clause
"""Dense matrices that threads share: what LAPACK makes of them, and the same bits for any number of threads."""

import numpy as np
import pytest
from scipy.linalg import lapack

from signorini.blas_threads import one_thread
from signorini.cores import threads
from signorini.linalg.shared_dense import (
    SHARED,
    add_product,
    cholesky,
    factorise_with_pivots,
    inverse_of_cholesky,
    inverse_of_factors,
    product,
)

SIZE = SHARED + 77  # tiles of which the last ones are narrow


@pytest.fixture(scope="module")
def symmetric():
    """Positive definite, with NaN above the diagonal, where nobody may look."""
    rows = np.random.default_rng(0).standard_normal((SIZE, SIZE))
    whole = rows @ rows.T + np.diag(np.geomspace(1.0, 1e3, SIZE))
    return np.asfortranarray(whole), np.asfortranarray(np.where(np.tri(SIZE, dtype=bool), whole, np.nan))


@pytest.fixture(scope="module")
def general():
    return np.asfortranarray(np.random.default_rng(1).standard_normal((SIZE, SIZE)))


def factored(matrix):
    own = matrix.copy(order="F")
    return own, cholesky(own)


def test_cholesky_is_that_of_lapack(symmetric):
    whole, lower = symmetric
    own, failed = factored(lower)
    assert failed == 0
    assert np.isnan(own[np.triu_indices(SIZE, 1)]).all()
    np.testing.assert_allclose(np.tril(own), np.linalg.cholesky(whole), atol=1e-12 * np.sqrt(whole.max()))


@pytest.mark.parametrize("number", [1, 2])
def test_cholesky_leaves_what_is_above_the_diagonal(symmetric, general, number):
    own = np.asfortranarray(np.tril(symmetric[0]) + np.triu(general, 1))
    with threads(number):
        assert cholesky(own) == 0
    np.testing.assert_array_equal(np.triu(own, 1), np.triu(general, 1))


@pytest.mark.parametrize("column", [3, 700, SIZE - 1])
@pytest.mark.parametrize("number", [1, 2])
def test_the_first_pivot_that_is_not_positive_is_named(symmetric, column, number):
    wrong = symmetric[1].copy(order="F")
    wrong[column, column] = -1.0
    wrong[SIZE - 1, SIZE - 1] = -1.0
    with threads(number):
        assert cholesky(wrong) == column + 1


def test_inverses_are_inverses(symmetric, general):
    whole, lower = symmetric
    inverse = inverse_of_cholesky(factored(lower)[0])
    np.testing.assert_array_equal(inverse, inverse.T)
    np.testing.assert_allclose(inverse @ whole, np.eye(SIZE), atol=1e-10)
    own, found = general.copy(order="F"), np.zeros((SIZE + 3, SIZE + 3), order="F")
    inverse_of_factors(own, factorise_with_pivots(own)[0], found[:SIZE, :SIZE])
    np.testing.assert_allclose(found[:SIZE, :SIZE] @ general, np.eye(SIZE), atol=1e-8)
    assert not found[SIZE:].any()


def test_pivots_are_those_of_lapack(general):
    own = general.copy(order="F")
    swapped, failed = factorise_with_pivots(own)
    lu, expected, _ = lapack.dgetrf(general)
    assert failed == 0
    np.testing.assert_array_equal(swapped, expected)
    np.testing.assert_allclose(own, lu, atol=1e-9 * np.abs(lu).max())


def test_the_first_pivot_that_is_zero_is_named(general):
    singular = general.copy(order="F")
    singular[:, 300] = singular[:, 1200] = 0.0
    assert factorise_with_pivots(singular)[1] == 301


@pytest.mark.parametrize("order", ["C", "F"])
def test_products_are_those_of_blas(general, order):
    """Of views into larger memory too, by rows or by columns."""
    larger = np.full((SIZE + 5, SIZE + 9), np.nan, order=order)
    view, x = larger[:SIZE, :SIZE], general[0]
    view[:] = general
    np.testing.assert_allclose(product(view, x), general @ x, atol=1e-11)


@pytest.mark.parametrize("columns", [1, 4])
def test_products_are_added_in_place(general, columns):
    u, v = np.asfortranarray(general[:, :columns]), general[-columns:]
    own = general.copy(order="F")
    add_product(own[:, : SIZE - 11], u, v[:, : SIZE - 11])
    np.testing.assert_allclose(own[:, : SIZE - 11], (general + u @ v)[:, : SIZE - 11], atol=1e-13)
    np.testing.assert_array_equal(own[:, SIZE - 11 :], general[:, SIZE - 11 :])


def test_bits_do_not_depend_on_the_number_of_threads(symmetric, general):
    def made(number):
        with one_thread(), threads(number):
            factor, _ = factored(symmetric[1])
            own, found = general.copy(order="F"), np.zeros((SIZE, SIZE), order="F")
            swapped, _ = factorise_with_pivots(own)
            inverse_of_factors(own, swapped, found)
            products = product(general, general[0]), product(general.T, general[0]), general.copy(order="F")
            for columns in (1, 4):
                add_product(products[-1], np.asfortranarray(general[:, :columns]), general[:columns])
            return np.tril(factor), inverse_of_cholesky(factor, overwrite=True), own, swapped, found, *products

    first = made(1)
    for number in (2, 3):
        for one, other in zip(first, made(number), strict=True):
            np.testing.assert_array_equal(one, other)
