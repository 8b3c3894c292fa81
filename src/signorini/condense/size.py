# SPDX-License-Identifier: BSD-3-Clause
"""How much memory the condensed interface will take, before anything is factorised."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import BoolArray, IntArray
from signorini.interface.interface import Interface
from signorini.linalg.plan import analyse
from signorini.linalg.system import check

_SMALL = 40_000, 4_000  # free displacements and contact dofs that always fit
_SQUARE = 4, 6  # dense matrices of the size of the contact dofs, and of that of the pairs' rows, held at once


def condensing_bytes(
    K: sp.csr_array, B: sp.csr_array, interface: Interface, nodes: IntArray, *, candidates: BoolArray
) -> int:
    """Bytes at the worst time of :func:`signorini.condense.condensed.condense` and of the law on its result.

    Parameters
    ----------
    K : (z, z) stiffness of the free displacements
    B : (d n, z) relative displacements of the pairs in terms of them
    nodes : (z,) node of each free displacement
    candidates : (n,) pairs that may touch

    Returns
    -------
    0 for a model so small that it is not worth a look
    """
    chosen = interface.rows(candidates | interface.tied)
    dofs = np.unique(B[np.flatnonzero(chosen)].indices)
    if K.shape[0] <= _SMALL[0] and len(dofs) <= _SMALL[1]:
        return 0
    dense = _SQUARE[0] * len(dofs) ** 2 + _SQUARE[1] * int(np.count_nonzero(chosen)) ** 2
    return analyse(check(K, dofs, nodes)).peak_bytes + 8 * dense
