# SPDX-License-Identifier: BSD-3-Clause
"""A border instead of an interface: the factorisation gives the compliance that the border sees."""

import numpy as np
import pytest
from scipy import sparse

from signorini.linalg import BACKENDS, NotPositiveDefinite, factorise
from signorini.linalg.registry import BORDERED, takes_borders
from signorini.linalg.system import bordered
from tests.helpers.lattices import lattice, together

BODIES = together(lattice((9, 7)), lattice((5, 4, 4)))


def border(K, rows, seed=5):
    rng = np.random.default_rng(seed)
    return sparse.csr_array(sparse.random_array((rows, K.shape[0]), density=0.02, rng=rng))


@pytest.mark.parametrize("backend", sorted(BORDERED))
@pytest.mark.parametrize("rows", [1, 40])
def test_what_condenses_is_the_compliance(backend, rows):
    K, B = BODIES.K, border(BODIES.K, rows)
    n = K.shape[0]
    nodes = np.concatenate([BODIES.nodes, BODIES.nodes.max() + 1 + np.arange(rows)])
    factor = factorise(bordered(K, B), np.arange(n, n + rows), nodes=nodes, backend=backend)
    yields = np.linalg.solve(K.toarray(), B.toarray().T)
    A = B @ yields
    np.testing.assert_allclose(factor.schur(), -A, rtol=0, atol=1e-12 * np.abs(A).max())
    rng = np.random.default_rng(1)
    f, r = rng.standard_normal(n), rng.standard_normal(rows)
    reduced = factor.reduce(np.concatenate([f, np.zeros(rows)]))
    np.testing.assert_allclose(reduced.load, -(yields.T @ f), atol=1e-10)
    u = reduced.expand(-r)[:n]
    np.testing.assert_allclose(K @ u, f + B.T @ r, atol=1e-10)


def test_a_bordered_matrix_is_symmetric_and_holds_both():
    K, B = BODIES.K, border(BODIES.K, 13)
    found = bordered(K, B).toarray()
    expected = np.block([[K.toarray(), B.toarray().T], [B.toarray(), np.zeros((13, 13))]])
    assert np.array_equal(found, expected)


def test_a_border_does_not_hold_a_body():
    free = lattice((6, 5), held="none")
    n = free.K.shape[0]
    with pytest.raises(NotPositiveDefinite):
        factorise(bordered(free.K, border(free.K, 30)), np.arange(n, n + 30), backend="multifrontal")


def test_others_keep_contact_nodes():
    assert takes_borders("auto")
    assert {name for name in BACKENDS if takes_borders(name)} == BORDERED
