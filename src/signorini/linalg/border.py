# SPDX-License-Identifier: BSD-3-Clause
"""A matrix with a border: forces beside the stiffness that they act on."""

from __future__ import annotations

from scipy import sparse


def bordered(K: sparse.csr_array, B: sparse.csr_array) -> sparse.csr_array:
    """``[[K, B^T], [B, 0]]``, (n + m, n + m); with the border as its interface it condenses to ``-B K^-1 B^T``.

    Parameters
    ----------
    K : (n, n)
    B : (m, n)

    Examples
    --------
    >>> import numpy as np
    >>> K, B = sparse.csr_array(np.diag([2.0, 4.0])), sparse.csr_array(np.array([[1.0, -1.0]]))
    >>> bordered(K, B).toarray().tolist()
    [[2.0, 0.0, 1.0], [0.0, 4.0, -1.0], [1.0, -1.0, 0.0]]
    """
    none = sparse.csr_array((B.shape[0], B.shape[0]))
    return sparse.csr_array(sparse.block_array([[K, sparse.csr_array(B.T)], [B, none]], format="csr"))
