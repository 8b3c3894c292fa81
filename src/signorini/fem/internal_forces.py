# SPDX-License-Identifier: BSD-3-Clause
"""Forces of deformed bodies, K u, as if in twice the digits: what slender bodies resist with cancels but for the last.

References
----------
Ogita, Rump, Oishi (2005), Accurate sum and dot product, SIAM J. Sci. Comput. 26:1955-1988.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel

_SPLIT = 134217729.0  # 2^27 + 1: halves the digits of a number


def internal_forces(K: sp.csr_array, u: Array) -> Array:
    """(n,) The product K u, rounded as if once: what the rounding of its terms adds is squared.

    Parameters
    ----------
    K : (n, n) stiffness, or one that multiplies likewise where it is
    u : (n,) displacements

    Examples
    --------
    >>> import numpy as np, scipy.sparse as sp
    >>> K, u = sp.csr_array([[1e16, 1.0, -1e16]]), np.ones(3)
    >>> (K @ u).tolist(), internal_forces(K, u).tolist()
    ([0.0], [1.0])
    """
    if not isinstance(K, sp.csr_array):  # its rows are on ranks
        found: Array = K.internal_forces(u)
        return found
    forces = np.zeros(K.shape[0])
    _multiply(K.indptr, K.indices, K.data, u, forces)
    return forces


@kernel()
def _multiply(indptr: IntArray, indices: IntArray, data: Array, x: Array, y: Array) -> None:
    """Overwrite y by A x: every product and every sum with what its rounding takes away (Dekker, Knuth)."""
    for i in range(len(indptr) - 1):
        total, lost = 0.0, 0.0
        for p in range(indptr[i], indptr[i + 1]):
            a, b = data[p], x[indices[p]]
            product = a * b
            c, d = _SPLIT * a, _SPLIT * b
            a_high, b_high = c - (c - a), d - (d - b)
            a_low, b_low = a - a_high, b - b_high
            of_product = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)
            new = total + product
            part = new - total
            lost += ((total - (new - part)) + (product - part)) + of_product
            total = new
        y[i] = total + lost
