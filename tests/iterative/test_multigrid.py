# SPDX-License-Identifier: BSD-3-Clause
"""Multigrid of bodies and the springs of their contacts."""

import numpy as np
import pytest
import scipy.sparse as sp

from signorini.engine.prepare import prepare
from signorini.gallery.cubes import cubes
from signorini.linalg._sweeps import sweep_back, sweep_from_zero
from signorini.linalg.krylov import conjugate_gradients


@pytest.fixture(scope="module")
def bodies():
    return prepare(cubes(9, 7), backend="iterative").solver.bodies


@pytest.mark.parametrize("d", [2, 3, 6])
def test_sweeps_are_those_of_triangles(d):
    rng = np.random.default_rng(d)
    whole = np.kron(sp.random_array((20, 20), density=0.2, rng=rng).toarray() != 0, np.ones((d, d)))
    whole *= rng.standard_normal(whole.shape)
    whole = whole + whole.T + 20.0 * d * np.eye(20 * d)
    A = sp.bsr_array(whole, blocksize=(d, d))
    A.sort_indices()
    diagonal = np.stack([whole[i : i + d, i : i + d] for i in range(0, 20 * d, d)])
    parts = ((0,) * d, A.indptr, A.indices, A.data, np.linalg.inv(diagonal))
    below = np.tril(np.kron(np.tril(np.ones((20, 20)), -1), np.ones((d, d)))) * whole
    lower = below + sp.block_diag(diagonal).toarray()
    b = rng.standard_normal(20 * d)
    x, residual = sweep_from_zero(*parts, b.reshape(-1, d))
    np.testing.assert_allclose(lower @ x.ravel(), b, atol=1e-12)
    np.testing.assert_allclose(residual.ravel(), b - whole @ x.ravel(), atol=1e-12)
    y = x.copy()
    sweep_back(*parts, b.reshape(-1, d), y)
    np.testing.assert_allclose(lower.T @ y.ravel(), b - below @ x.ravel(), atol=1e-12)


def springs(bodies, normal, tangential):
    """Of all pairs, as parts of their stiffness."""
    shares = np.repeat([normal, tangential, tangential], len(bodies.pairs))
    return sp.csr_array(bodies.B.T @ sp.diags_array(shares * np.tile(bodies.stiffness, 3)) @ bodies.B)


def test_a_cycle_is_symmetric_and_positive(bodies):
    cycle = bodies.preconditioner.under(springs(bodies, 1.0, 0.1))
    x, y = np.random.default_rng(1).standard_normal((2, bodies.K.shape[0]))
    assert x @ cycle(y) == pytest.approx(y @ cycle(x), rel=1e-10)
    assert x @ cycle(x) > 0


def test_springs_replace_those_before_at_the_nodes_of_contacts(bodies):
    """On the finest level: the matrix is that of bodies and the last springs, whatever there was before."""
    for parts in ((1.0, 1.0), (0.3, 0.0)):
        own = springs(bodies, *parts)
        level = bodies.preconditioner.under(own).levels[0]
        np.testing.assert_allclose((level.A - bodies.K - own).data, 0.0, atol=1e-12 * bodies.K.data.max())
        whole = (bodies.K + own).toarray()
        d = level.A.blocksize[0]
        for i in (0, int(bodies.B.indices[0]) // d):
            block = whole[d * i : d * i + d, d * i : d * i + d]
            np.testing.assert_allclose(level.inverses[i] @ block, np.eye(d), atol=1e-10)


@pytest.mark.parametrize("parts", [(0.0, 0.0), (1.0, 0.0), (1.0, 0.1), (1.0, 1.0)])
def test_every_state_of_contact_takes_the_same_few_iterations(bodies, parts):
    own = springs(bodies, *parts)
    force = bodies.B.T @ np.random.default_rng(2).standard_normal(bodies.B.shape[0])
    cycle = bodies.preconditioner.under(own)
    _, count = conjugate_gradients(lambda v: bodies.K @ v + own @ v, cycle, force, 1e-8)
    assert count <= 32
