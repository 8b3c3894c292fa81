# SPDX-License-Identifier: BSD-3-Clause
"""Products of displacements down the tree of fronts are those of the displacements themselves."""

import numpy as np
import pytest
from scipy import sparse

from signorini.errors import InputError
from signorini.linalg import registry
from signorini.linalg._front_ranks import LEAST_ROWS
from tests.helpers.lattices import lattice

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


def test_entries_where_the_factor_has_none_are_refused():
    """Two leaves of the tree are not joined in any front: what their numbers are there is anything."""
    p = lattice((30, 20))
    factorisation = registry.factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal")
    first, last = factorisation.plan.order[0], factorisation.plan.order[p.K.shape[0] // 2]
    apart = sparse.csr_array(([1.0, 1.0], ([first, last], [last, first])), shape=p.K.shape)
    assert p.K[first, last] == 0.0
    with pytest.raises(InputError, match="the pattern has an entry where the factor has none; expected those of the"):
        factorisation.products(np.eye(len(p.interface)), sparse.csr_array(p.K + apart))


def test_products_far_from_the_interface_are_those_of_a_few_combinations():
    """Of a plate that is pulled at its upper edge all displacements far below are smooth; every entry is right."""
    p = lattice((60, 80))
    factorisation = registry.factorise(p.K, p.interface, nodes=p.nodes, points=p.points, backend="multifrontal")
    assert (factorisation.plan.fronts.below >= LEAST_ROWS).sum() > 8
    m = len(p.interface)
    E = factorisation.reduce(np.zeros((p.K.shape[0], m))).expand(np.eye(m))
    M = np.random.default_rng(3).standard_normal((m, m))
    entries = sparse.coo_array(p.K)
    wanted = np.einsum("pm,pm->p", (E @ (M + M.T))[entries.row], E[entries.col])
    found = sparse.csr_array((factorisation.products(M + M.T, p.K), p.K.indices, p.K.indptr), shape=p.K.shape)
    both = sparse.csr_array(0.5 * (found + found.T))
    assert both.toarray()[entries.row, entries.col] == pytest.approx(wanted, rel=0, abs=1e-12 * np.abs(wanted).max())
