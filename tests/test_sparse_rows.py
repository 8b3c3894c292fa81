# SPDX-License-Identifier: BSD-3-Clause
"""Matrices of rows have the entries of SciPy's results, in their order: sums of them have the same last digits."""

import numpy as np
import pytest
import scipy.sparse as sp

from signorini import sparse_rows


@pytest.fixture(params=[0, 1, 2])
def rng(request):
    return np.random.default_rng(request.param)


def random_rows(rng, shape=(30, 20)):
    return sp.csr_array(sp.random_array(shape, density=0.2, rng=rng))


def assert_same(found, expected):
    expected = expected.tocsr() if expected.format != found.format else expected
    assert found.shape == expected.shape
    for name in ("data", "indices", "indptr"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    found.copy().check_format(full_check=True)


def test_rows_and_columns_are_chosen_as_by_scipy(rng):
    A = random_rows(rng)
    rows, which, columns = rng.integers(0, 30, 40), rng.random(30) < 0.5, np.sort(rng.permutation(20)[:12])
    assert_same(sparse_rows.chosen_rows(A, rows), A[rows])
    assert_same(sparse_rows.chosen_rows(A, which), A[which])
    assert_same(sparse_rows.chosen_columns(A, columns), A[:, columns])
    assert_same(sparse_rows.stacked([A, A[:3]]), sp.vstack([A, A[:3]]))
    assert_same(sparse_rows.transposed(A), A.T)


def test_products_with_what_picks_columns_are_those_of_scipy(rng):
    A, number = random_rows(rng), np.full(20, -1)
    number[rng.permutation(20)[:12]] = np.arange(12)
    kept = np.flatnonzero(number >= 0)
    T = sp.csr_array((np.ones(12), (kept, number[kept])), shape=(20, 12))
    assert_same(sparse_rows.turned_rows(sparse_rows.renumbered(A, number, 12)), A @ T)


def test_entries_and_sums_are_those_of_scipy(rng):
    A, B = random_rows(rng), random_rows(rng)
    like = sp.csr_array((np.where(rng.random(A.nnz) < 0.3, -A.data, B.data[0]), A.indices, A.indptr), shape=A.shape)
    none = sp.csr_array(A.shape)
    for one, other in ((A, B), (A, like), (A, none), (none, A)):
        assert_same(sparse_rows.added(one, other), one + other)
        assert_same(sparse_rows.added(one, other, -1.0), one - other)
    order, C = rng.permutation(A.nnz), A.tocoo()
    for i in (order, np.concatenate([order, order[:4]])):  # every place once, and some twice
        values, rows, columns = C.data[i], C.row[i], C.col[i]
        expected = sp.csr_array((values, (rows, columns)), shape=A.shape)
        assert_same(sparse_rows.of_entries(values, rows, columns, A.shape), expected)


@pytest.mark.parametrize("columns", [3, 120])
def test_products_with_itself_have_the_digits_of_scipy(rng, columns):
    A = random_rows(rng, (200, columns))
    np.testing.assert_array_equal(sparse_rows.gram(A), (A.T @ A).toarray())


def test_what_is_made_shares_nothing_that_changes(rng):
    A = random_rows(rng)
    before = A.copy()
    for made in (
        sparse_rows.scaled_rows(A, np.zeros(30)),
        sparse_rows.renumbered(A, np.arange(20), 20),
        sparse_rows.turned_rows(A),
        sparse_rows.added(A, sp.csr_array(A.shape)),
        sparse_rows.added(sp.csr_array(A.shape), A),
    ):
        made.data[:] = 0.0
        made.eliminate_zeros()
    assert_same(A, before)
