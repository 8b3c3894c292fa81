# SPDX-License-Identifier: BSD-3-Clause
"""An inverse that is bordered, cut and changed by low ranks, beside that of the matrix that it belongs to."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signorini.linalg.changed_inverse import COLLECTED, ChangedInverse


def random_matrix(rng, m, *, symmetric):
    """Well conditioned, by columns."""
    matrix = rng.normal(size=(m, m)) / np.sqrt(max(m, 1)) + 3.0 * np.eye(m)
    return np.asfortranarray(matrix @ matrix.T if symmetric else matrix)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), symmetric=st.booleans(), often=st.booleans())
def test_a_walk_of_changes_ends_where_the_matrix_does(seed, symmetric, often):
    """Low ranks in, borders and cuts, fewer and more than are collected; what is asked on the way changes nothing."""
    rng = np.random.default_rng(seed)
    X = ChangedInverse(random_matrix(rng, 7, symmetric=symmetric), symmetric=symmetric)
    expected = X.times(np.eye(7))
    for _ in range(3 * COLLECTED if often else 8):
        m, kind = len(expected), rng.integers(3)
        if kind == 0 and m:
            u, v = rng.normal(size=(m, 2)), 0.1 * rng.normal(size=(2, m))
            X.add(u, v)
            expected = expected + u @ v
        elif kind == 1:
            k = int(rng.integers(1, 4))
            X.border(k)
            corner = rng.normal(size=(k, m + k))
            X.add(np.eye(m + k)[:, m:], corner)
            expected = np.vstack([np.pad(expected, ((0, 0), (0, k))), corner])
        else:
            places = rng.permutation(m)[: max(m - int(rng.integers(3)), 0)]
            X.keep(places)
            expected = expected[np.ix_(places, places)]
    m = len(X)
    assert expected.shape == (m, m)
    b, some = rng.normal(size=m), rng.permutation(m)[: (m + 1) // 2]
    close = {"rtol": 0, "atol": 1e-12 * max(1.0, np.abs(expected).max(initial=0.0))}
    for _ in range(2):  # of what is collected, and of the whole
        np.testing.assert_allclose(X.times(b), expected @ b, **close)
        np.testing.assert_allclose(X.transposed_times(b[:, None]), (expected.T @ b)[:, None], **close)
        np.testing.assert_allclose(X.columns(some), expected[:, some], **close)
        np.testing.assert_allclose(X.rows(some), expected[some], **close)
        np.testing.assert_allclose(X.whole, expected, **close)


@pytest.mark.parametrize("symmetric", [False, True])
def test_it_inverts_and_says_how_far_the_matrix_is_from_one_without_an_inverse(symmetric):
    matrix = random_matrix(np.random.default_rng(3), 40, symmetric=symmetric)
    X = ChangedInverse(matrix.copy(order="F"), symmetric=symmetric)
    for found in (X.times(np.eye(40)), X.whole):
        np.testing.assert_allclose(found @ matrix, np.eye(40), rtol=0, atol=1e-13)
    true = 1.0 / np.linalg.cond(matrix, 1)
    assert true <= X.condition * (1.0 + 1e-12) <= 10.0 * true
    matrix[:, -1] = matrix[:, 0]
    matrix[-1] = matrix[0]
    assert ChangedInverse(matrix, symmetric=symmetric).condition < 1e-15
