# SPDX-License-Identifier: BSD-3-Clause
"""Who owns which node and which pair: a mesh cut through few edges, pairs shared evenly whatever the cut.

A node belongs to the rank that has its rows of the matrix. A pair can be on any rank, which then asks others for the
displacements of nodes that it sees: so a contact that the cut leaves whole is no burden of one rank.
"""

from __future__ import annotations

import numpy as np
import pymetis
import scipy.sparse as sp

from signorini.arrays import Array, IntArray, index_type
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
        return np.zeros(count, dtype=np.int32)
    sizes = np.concatenate([[0], *(np.full(len(block.cells), block.cells.shape[1]) for block in space.blocks)])
    corners = np.concatenate([block.cells.astype(np.int32).ravel() for block in space.blocks])
    indptr, indices = node_pattern(np.cumsum(sizes), corners, count)
    graph = _pattern(indices, indptr, count)
    seen = sp.csr_array(B[:, : space.components * count])
    together = _pattern(seen.indices // space.components, seen.indptr, count)
    graph = sp.csr_array(graph + together.T @ together)
    entries = np.diff(graph.indptr)
    graph.setdiag(False)
    graph.eliminate_zeros()
    neighbours = pymetis.CSRAdjacency(graph.indptr, graph.indices)
    own = pymetis.part_graph(ranks, neighbours, vweights=entries.tolist())[1]
    owner = np.asarray(own, dtype=np.int32)
    least = int(np.bincount(owner[space.used_nodes], minlength=ranks).min())
    if least == 0:
        raise InputError(f"{count} nodes are too few for {ranks} ranks: one would own none; expected fewer ranks")
    return owner


def pair_owners(seen: sp.csr_array, at: Array, centres: Array) -> IntArray:
    """(a,) The rank that has each pair: the one that owns most of what the pair sees, up to ``ceil(a / ranks)`` pairs.

    Others take what is over, those with most pairs first: the pairs of which they own most, then those that are nearest
    to their nodes, so that what a rank takes lies together.

    Parameters
    ----------
    seen : (a, ranks) unknowns of every rank that each pair sees
    at : (a, d) where the pairs are, length
    centres : (ranks, d) of the nodes of every rank, length

    Examples
    --------
    >>> whole = sp.csr_array([[3, 0], [3, 0], [2, 1], [3, 0]])
    >>> pair_owners(whole, np.array([[0.0], [1.0], [2.0], [3.0]]), np.array([[1.0], [9.0]]))
    array([0, 0, 1, 1])
    """
    a, ranks = seen.shape
    if a == 0 or ranks == 1:
        return np.zeros(a, dtype=np.int64)
    owner = np.asarray(seen.argmax(axis=1), dtype=np.int64).ravel()
    share, count, by_rank = -(-a // ranks), np.bincount(owner, minlength=ranks), sp.csc_array(seen)
    for rank in np.argsort(-count, kind="stable"):
        over = np.flatnonzero(count[owner] > share)
        apart = np.square(at[over] - centres[rank]).sum(axis=1)
        order = over[np.lexsort((apart, -by_rank[:, [rank]].toarray().ravel()[over]))]
        taken = order[_place_among_own(owner[order]) < (count - share)[owner[order]]]
        owner[taken[: max(share - count[rank], 0)]] = rank
        count = np.bincount(owner, minlength=ranks)
    return owner


def _place_among_own(group: IntArray) -> IntArray:
    """How many before each are of the same group."""
    order = np.argsort(group, kind="stable")
    found = np.empty(len(group), dtype=np.int64)
    found[order] = np.arange(len(group)) - np.searchsorted(group[order], group[order])
    return found


def _pattern(columns: IntArray, indptr: IntArray, width: int) -> sp.csr_array:
    """Where rows have entries; columns may stand in them more than once."""
    narrow = index_type(max(len(columns), width))
    places = columns.astype(narrow, copy=False), indptr.astype(narrow, copy=False)
    return sp.csr_array((np.ones(len(columns), dtype=np.bool_), *places), shape=(len(indptr) - 1, width))
