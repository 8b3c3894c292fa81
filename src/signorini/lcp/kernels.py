# SPDX-License-Identifier: BSD-3-Clause
"""The compiled loops: relaxation sweeps and the pivot of a tableau.

Those who use them import them where they do, since Numba takes longer to import than most problems to solve.
"""

from __future__ import annotations

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel


@kernel(nogil=True)
def sweeps(
    start: IntArray,
    index: IntArray,
    value: Array,
    q: Array,
    z: Array,
    omega: float,
    count: int,
    backwards: bool,
) -> None:
    """Relax z in place: ``z_i = max(0, z_i - omega (M z + q)_i / M_ii)``, row after row.

    Parameters
    ----------
    start, index, value : M by rows (CSR); a row without positive diagonal is passed over
    omega : relaxation factor
    count : number of sweeps
    backwards : whether they run from the last row to the first
    """
    n = len(q)
    for _ in range(count):
        for k in range(n):
            i = n - 1 - k if backwards else k
            w = q[i]
            diagonal = 0.0
            for entry in range(start[i], start[i + 1]):
                j = index[entry]
                w += value[entry] * z[j]
                if j == i:
                    diagonal = value[entry]
            if diagonal > 0.0:
                z[i] = max(0.0, z[i] - omega * w / diagonal)


@kernel(brief=True, nogil=True)
def exchange(T: Array, row: int, at: int) -> None:
    """Pivot a Fortran-ordered condensed tableau in place on ``T[row, at]``.

    Parameters
    ----------
    T : (n, m) with ``x_B + T x_N = rhs`` in its columns, rhs among them
    row, at : the basic and the nonbasic variable that change places
    """
    n, m = T.shape
    column = T[:, at].copy()
    pivot = column[row]
    column[row] = 0.0
    T[:, at] = 0.0
    T[row, at] = 1.0
    for j in range(m):
        factor = T[row, j] / pivot
        if factor != 0.0:
            for i in range(n):
                T[i, j] -= factor * column[i]
            T[row, j] = factor
