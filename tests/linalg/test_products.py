# SPDX-License-Identifier: BSD-3-Clause
"""Products of displacements down the tree of fronts are those of the displacements themselves."""

import numpy as np
import pytest
from scipy import sparse

from signorini.linalg import registry

SIDES = {"row": (23, 1), "grid": (24, 17)}


@pytest.mark.parametrize("bodies", [1, 2])
@pytest.mark.parametrize("side", SIDES)
def test_products_are_those_of_displacements(side, bodies):
    """Grids with two unknowns a node, of which a row of nodes is the interface; a second body has none of it."""
    rng, (nx, ny) = np.random.default_rng(2), SIDES[side]
    line = [sparse.diags_array([-np.ones(n - 1), np.ones(n - 1)], offsets=[-1, 1], shape=(n, n)) for n in (nx, ny)]
    graph = sparse.kron(abs(line[0]), sparse.eye_array(ny)) + sparse.kron(sparse.eye_array(nx), abs(line[1]))
    one = sparse.kron(graph, np.ones((2, 2)))
    pattern = sparse.csr_array(sparse.block_diag([one] * bodies) + sparse.eye_array(2 * nx * ny * bodies))
    values = sparse.csr_array((rng.uniform(-1.0, 1.0, pattern.nnz), pattern.indices, pattern.indptr))
    K = sparse.csr_array(values + values.T + 40.0 * sparse.eye_array(values.shape[0]))
    interface = rng.permutation(np.concatenate([2 * ny * np.arange(nx), 2 * ny * np.arange(nx) + 1]))
    points = np.argwhere(np.ones((nx, ny * bodies))).astype(float)
    nodes = np.repeat(np.arange(nx * ny * bodies), 2)
    factorisation = registry.factorise(K, interface, nodes=nodes, points=points, backend="multifrontal")
    m = len(interface)
    E = factorisation.reduce(np.zeros((K.shape[0], m))).expand(np.eye(m))
    M = rng.standard_normal((m, m))
    M = M + M.T
    change = sparse.csr_array((rng.standard_normal(K.nnz), K.indices, K.indptr))
    change = sparse.csr_array(change + change.T)
    wanted = float(np.sum((E @ M @ E.T) * change.toarray()))
    assert factorisation.products(M, change) @ change.data == pytest.approx(wanted, rel=1e-11)
