# SPDX-License-Identifier: BSD-3-Clause
"""Compiled sweeps of Gauss-Seidel by blocks, each of which reads a symmetric matrix once or only half of it.

Matrices are in rows of blocks, columns sorted: row i has the blocks ``data[indptr[i]:indptr[i + 1]]``, (d, d) each, in
the columns ``indices[...]``. A tuple of d items tells the compiler how long the inner loops are.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array
from signorini.compilation import kernel


@kernel()
def sweep_from_zero(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, data: Array, inverses: Array, b: Array
) -> tuple[Array, Array]:
    """A forward sweep from zero over ``A x = b``: x and the residual ``b - A x``, both (m, d).

    What is left below the diagonal is what is not solved for yet, so that the residual is made of the upper half alone.

    Parameters
    ----------
    block : d items
    indptr, indices, data : A
    inverses : (m, d, d) of the blocks on its diagonal
    b : (m, d)
    """
    d = len(block)
    x, residual = np.zeros_like(b), np.zeros_like(b)
    left = np.empty(d)
    for i in range(len(b)):
        for p in range(d):
            left[p] = b[i, p]
        end = indptr[i]
        while indices[end] < i:
            j = indices[end]
            for p in range(d):
                total = 0.0
                for q in range(d):
                    total += data[end, p, q] * x[j, q]
                left[p] -= total
            end += 1
        for p in range(d):
            total = 0.0
            for q in range(d):
                total += inverses[i, p, q] * left[q]
            x[i, p] = total
        for k in range(indptr[i], end):
            j = indices[k]
            for p in range(d):
                total = 0.0
                for q in range(d):
                    total += data[k, q, p] * x[i, q]
                residual[j, p] -= total
    return x, residual


@kernel()
def sweep_back(
    block: tuple[int, ...], indptr: Int32Array, indices: Int32Array, data: Array, inverses: Array, b: Array, x: Array
) -> None:
    """A backward sweep over ``A x = b`` in place.

    Parameters
    ----------
    block, indptr, indices, data, inverses, b : see `sweep_from_zero`
    x : (m, d)
    """
    d = len(block)
    left = np.empty(d)
    for i in range(len(b) - 1, -1, -1):
        for p in range(d):
            left[p] = b[i, p]
        for k in range(indptr[i], indptr[i + 1]):
            j = indices[k]
            if j != i:
                for p in range(d):
                    total = 0.0
                    for q in range(d):
                        total += data[k, p, q] * x[j, q]
                    left[p] -= total
        for p in range(d):
            total = 0.0
            for q in range(d):
                total += inverses[i, p, q] * left[q]
            x[i, p] = total
