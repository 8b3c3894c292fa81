# SPDX-License-Identifier: BSD-3-Clause
"""How many eigenvalues of a symmetric matrix are negative, by the signs of the pivots of ``L D L^T`` (Sylvester)."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from signorini.arrays import Array, IntArray
from signorini.linalg.ordering import nested_dissection, unknowns
from signorini.linalg.system import checked_system, node_graph

_TRUSTED_RESIDUAL = 1e-6
"""Of one solve: factors without pivoting whose solution is worse have grown, and their signs are not those of A."""


def negative_eigenvalues(A: sparse.csr_array, last: IntArray, nodes: IntArray, points: Array | None) -> int | None:
    """Count the negative eigenvalues of A; None where a pivot vanishes, or the factors have grown too much.

    Parameters
    ----------
    A : (n, n) symmetric, of any inertia
    last : (m,) unknowns that are eliminated last, in this order: such as have no pivots of their own
    nodes : (n,) node of every unknown
    points : (k, d) where the nodes are, or None

    Examples
    --------
    >>> A = sparse.csr_array(np.array([[1.0, 2.0, 0.0], [2.0, 1.0, 1.0], [0.0, 1.0, -3.0]]))
    >>> negative_eigenvalues(A, np.array([2]), np.arange(3), None), (np.linalg.eigvalsh(A.toarray()) < 0.0).sum()
    (2, np.int64(2))
    """
    graph = node_graph(checked_system(A, last, nodes, points))
    order = np.concatenate([unknowns(graph, nested_dissection(graph)), last])
    ordered = A[order][:, order].tocsc()
    ordered.indptr, ordered.indices = ordered.indptr.astype(np.int32), ordered.indices.astype(np.int32)
    try:
        factors = splu(ordered, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:  # a pivot is exactly 0
        return None
    return int((factors.U.diagonal() < 0.0).sum()) if _trusted(ordered, factors) else None


def _trusted(A: sparse.csc_array, factors: SuperLU) -> bool:
    """Whether rows were eliminated in the order of the columns, and factors solve what they should."""
    if not np.array_equal(factors.perm_r, factors.perm_c):
        return False
    x = np.random.default_rng(0).uniform(0.5, 1.5, A.shape[0])
    error = factors.solve(A @ x) - x
    return bool(np.linalg.norm(error) <= _TRUSTED_RESIDUAL * np.linalg.norm(x))
