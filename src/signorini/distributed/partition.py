# SPDX-License-Identifier: BSD-3-Clause
"""Who owns which node: a cut of the mesh through few edges, with as many entries of the matrix on every rank."""

from __future__ import annotations

import numpy as np
import pymetis
import scipy.sparse as sp

from signorini.arrays import IntArray
from signorini.errors import InputError
from signorini.fem._kernels import node_pattern
from signorini.fem.space import Space


def owners(space: Space, B: sp.csr_array, ranks: int) -> IntArray:
    """(n,) The rank that owns each node of the mesh, by METIS.

    Its graph joins nodes of a cell, and nodes that a pair sees: the pattern of the stiffness with the springs of closed
    pairs. A node weighs as much as its row has entries, so that a rank with a contact on it has less of the bodies.

    Parameters
    ----------
    space : the mesh
    B : (m, dofs) what pairs see
    ranks : how many there are

    Raises
    ------
    InputError
        If a rank would own nothing.

    References
    ----------
    Karypis, Kumar (1998), A fast and high quality multilevel scheme for partitioning irregular graphs, SIAM J. Sci.
    Comput. 20:359.
    """
    count = len(space.mesh.points)
    if ranks == 1:
        return np.zeros(count, dtype=np.int64)
    sizes = np.concatenate([[0], *(np.full(len(block.cells), block.cells.shape[1]) for block in space.blocks)])
    corners = np.concatenate([block.cells.astype(np.int32).ravel() for block in space.blocks])
    indptr, indices = node_pattern(np.cumsum(sizes), corners, count)
    graph = _pattern(indices, indptr, count)
    seen = sp.csr_array(B[:, : space.components * count])
    together = _pattern(seen.indices // space.components, seen.indptr, count)
    graph = sp.csr_array(graph + together.T @ together)
    entries = np.diff(graph.indptr)
    graph.setdiag(0)
    graph.eliminate_zeros()
    neighbours = pymetis.CSRAdjacency(graph.indptr, graph.indices)
    own = pymetis.part_graph(ranks, neighbours, vweights=entries.tolist())[1]
    owner = np.asarray(own, dtype=np.int64)
    least = int(np.bincount(owner[space.used_nodes], minlength=ranks).min())
    if least == 0:
        raise InputError(f"{count} nodes are too few for {ranks} ranks: one would own none; expected fewer ranks")
    return owner


def _pattern(columns: IntArray, indptr: IntArray, width: int) -> sp.csr_array:
    """Where rows have entries, ones; columns may stand in them more than once."""
    return sp.csr_array((np.ones(len(columns)), columns, indptr), shape=(len(indptr) - 1, width))
