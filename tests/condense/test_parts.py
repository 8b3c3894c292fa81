# SPDX-License-Identifier: BSD-3-Clause
"""BodyBlocks one by one against the whole: blocks, ties between them, and parts that nothing else holds."""

import numpy as np
import pytest
import scipy.sparse as sp

from signorini.condense.basis import make_basis
from signorini.condense.body_blocks import independent, make_body_blocks


def stiff(rng, size, rigid=None):
    """A random stiffness without resistance along the columns of rigid."""
    H = rng.standard_normal((size, size + 2))
    if rigid is not None:
        H -= rigid @ np.linalg.lstsq(rigid, H)[0]
    return H @ H.T


@pytest.fixture
def bodies():
    """Two bodies in mixed order of their dofs; nothing holds the second along two motions."""
    rng = np.random.default_rng(3)
    order, motions = rng.permutation(9), rng.standard_normal((4, 2))
    S, rigid = np.zeros((9, 9)), np.zeros((9, 2))
    S[np.ix_(order[:5], order[:5])] = stiff(rng, 5)
    S[np.ix_(order[5:], order[5:])] = stiff(rng, 4, motions)
    rigid[order[5:]] = motions
    return rng, order, S, rigid


def test_blocks_are_found_in_any_order(bodies):
    _, order, S, _ = bodies
    found = sorted(independent(S), key=len)
    assert [block.tolist() for block in found] == [sorted(order[5:]), sorted(order[:5])]


def test_balanced_forces_move_the_parts_as_the_pseudo_inverse_says(bodies):
    """But for a rigid motion."""
    rng, _, S, rigid = bodies
    parts = make_body_blocks(S.copy(), np.zeros((0, 9)), rigid, size=1.0)
    basis = make_basis(rigid).R
    force = rng.standard_normal(9)
    force -= basis @ (basis.T @ force)
    moved = parts.solve(force)
    np.testing.assert_allclose(S @ moved, force, atol=1e-12)
    np.testing.assert_allclose(moved - basis @ (basis.T @ moved), np.linalg.pinv(S) @ force, atol=1e-11)


def test_compliance_is_what_solving_gives(bodies):
    rng, _, S, rigid = bodies
    B = sp.random_array((7, 9), density=0.4, rng=rng).tocsr()
    for ties in (np.zeros((0, 9)), rng.standard_normal((2, 9))):
        held = rigid if not len(ties) else np.zeros((9, 0))  # two ties hold two motions
        parts = make_body_blocks(S.copy(), ties, held, size=1.0)
        expected = B @ parts.solve(B.T.toarray())
        found = parts.compliance(B)
        np.testing.assert_allclose(found, expected, atol=1e-11)
        assert np.array_equal(found, found.T)
        np.testing.assert_allclose(ties @ parts.solve(rng.standard_normal(9)), 0.0, atol=1e-12)


def test_what_nothing_holds_is_refused(bodies):
    _, _, S, rigid = bodies
    with pytest.raises(np.linalg.LinAlgError):
        make_body_blocks(S - 1e-9 * np.eye(9), np.zeros((0, 9)), np.zeros_like(rigid), size=1.0)
    with pytest.raises(np.linalg.LinAlgError, match="do not see"):
        make_basis(np.ones((4, 2)))
