# SPDX-License-Identifier: BSD-3-Clause
"""The one compiled loop: a projected relaxation sweep over the rows of a sparse matrix."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from signorini.arrays import Array, IntArray

Sweep = Callable[[IntArray, IntArray, Array, Array, Array, float, int, bool], float]


@cache
def compiled_sweeps() -> Sweep:
    """The compiled ``sweeps``; Numba is imported here because it takes longer than most problems."""
    from numba import njit

    kernel: Sweep = njit(cache=True, nogil=True)(sweeps)
    return kernel


def sweeps(
    start: IntArray, index: IntArray, value: Array, q: Array, z: Array, omega: float, count: int, symmetric: bool
) -> float:
    """Relax z in place: ``z_i = max(0, z_i - omega (M z + q)_i / M_ii)`` in row order; returns the last largest change.

    Parameters
    ----------
    start, index, value : M by rows (CSR), every M_ii > 0
    omega : relaxation factor
    count : number of sweeps
    symmetric : whether every second sweep runs backwards
    """
    n = len(q)
    change = 0.0
    for sweep in range(count):
        backwards = symmetric and sweep % 2 == 1
        change = 0.0
        for k in range(n):
            i = n - 1 - k if backwards else k
            w = q[i]
            diagonal = 1.0
            for entry in range(start[i], start[i + 1]):
                j = index[entry]
                w += value[entry] * z[j]
                if j == i:
                    diagonal = value[entry]
            new = max(0.0, z[i] - omega * w / diagonal)
            change = max(change, abs(new - z[i]) * diagonal)
            z[i] = new
    return change
