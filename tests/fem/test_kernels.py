# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over the cells of a mesh."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from signorini.fem._kernels import connected_pieces


@pytest.mark.parametrize("seed", range(20))
def test_pieces_are_those_of_the_graph_in_the_order_of_their_first_nodes(seed):
    rng = np.random.default_rng(seed)
    nodes, sizes = int(rng.integers(1, 60)), rng.integers(1, 5, size=rng.integers(1, 40))
    corner = rng.integers(0, nodes, sizes.sum()).astype(np.int32)
    cell = nodes + np.repeat(np.arange(len(sizes)), sizes)
    graph = sp.csr_array((np.ones(len(cell)), (cell, corner)), shape=(nodes + len(sizes),) * 2)
    _, expected = connected_components(graph, connection="weak")
    found = connected_pieces(np.append(0, np.cumsum(sizes)), corner, nodes)
    assert found.tolist() == expected[:nodes].tolist()
