# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops of one element: gradients, its matrix by the law of the material, modes and pressures in it.

What every element does is inlined, so that a kernel which knows the numbers of nodes and components hands them on.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import part


@part(inline="always")
def gradients_at(
    x: Array,
    reference: Array,
    J: Array,
    I: Array,  # noqa: E741
    g: Array,
    nodes: int,
    d: int,
    e: int,
) -> float:
    """Write the gradients at one point, e components a node; give the Jacobian, 0 where it is only round-off.

    Parameters
    ----------
    x, reference : (nodes, d) nodes of the cell, and reference gradients of its shape functions
    J, I : (3, 3) scratch for the Jacobian matrix and its inverse; in the plane the rest of J is a unit matrix
    g : (nodes e,) overwritten
    nodes, d, e : of the cell, coordinates, and components of gradients
    """
    size = 1.0
    for s in range(d):
        length = 0.0
        for r in range(d):
            v = 0.0
            for a in range(nodes):
                v += x[a, r] * reference[a, s]
            J[r, s] = v
            length += v * v
        size *= np.sqrt(length)
    I00 = J[1, 1] * J[2, 2] - J[1, 2] * J[2, 1]
    I10 = J[1, 2] * J[2, 0] - J[1, 0] * J[2, 2]
    I20 = J[1, 0] * J[2, 1] - J[1, 1] * J[2, 0]
    det = J[0, 0] * I00 + J[0, 1] * I10 + J[0, 2] * I20
    if not abs(det) > 1e-12 * size:
        return 0.0
    I[0, 0], I[1, 0], I[2, 0] = I00 / det, I10 / det, I20 / det
    I[0, 1] = (J[0, 2] * J[2, 1] - J[0, 1] * J[2, 2]) / det
    I[1, 1] = (J[0, 0] * J[2, 2] - J[0, 2] * J[2, 0]) / det
    I[2, 1] = (J[0, 1] * J[2, 0] - J[0, 0] * J[2, 1]) / det
    I[0, 2] = (J[0, 1] * J[1, 2] - J[0, 2] * J[1, 1]) / det
    I[1, 2] = (J[0, 2] * J[1, 0] - J[0, 0] * J[1, 2]) / det
    I[2, 2] = (J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]) / det
    for a in range(nodes):
        for r in range(d):
            v = 0.0
            for s in range(d):
                v += reference[a, s] * I[s, r]
            g[a * e + r] = v
    return float(det)


@part(inline="always")
def combine(C: Array, nodes: int, d: int, e: int, entries: IntArray, law: Array, K: Array) -> None:
    """Combine the products of gradients by the law of the material.

    Parameters
    ----------
    C : (nodes e, nodes e) products of all components of gradients, integrated
    nodes, d, e : of the cell with its modes, components of displacements and of gradients
    entries, law : see `Laws`, of one material
    K : (nodes d, nodes d) overwritten
    """
    total = np.empty(d * d)
    for a in range(nodes):
        for b in range(a, nodes):
            row, column = a * e, b * e
            for t in range(d * d):
                total[t] = 0.0
            for t in range(len(law)):
                total[entries[t, 0]] += law[t] * C[row + entries[t, 1], column + entries[t, 2]]
            for r in range(d):
                for s in range(d):
                    K[a * d + r, b * d + s] = total[r * d + s]
                    K[b * d + s, a * d + r] = total[r * d + s]


@part()
def eliminate(K: Array, keep: int) -> None:
    """Eliminate the unknowns behind the first `keep`, the last one first; they bear no load.

    Parameters
    ----------
    K : of the element, overwritten
    keep : how many unknowns stay
    """
    for p in range(len(K) - 1, keep - 1, -1):
        for i in range(p):
            factor = K[i, p] / K[p, p]
            for j in range(p):
                K[i, j] -= factor * K[p, j]


@part()
def project(K: Array, divergence: Array, volume: Array, pressures: Array, bulk: float) -> None:
    """Take away ``bulk int (b - P b)(b - P b)^T``, b the rows of the divergence, P the projection on `pressures`.

    Parameters
    ----------
    K : (n, n) of the element, from which it is taken
    divergence : (q, n) at the points of the quadrature, overwritten
    volume : (q,) of the points
    pressures : (q, p) functions there
    bulk : modulus, force / length^2
    """
    p, n = pressures.shape[1], divergence.shape[1]
    basis = pressures.copy()
    for k in range(p):  # orthonormal in the element, Gram-Schmidt
        for l in range(k):  # noqa: E741
            share = 0.0
            for q in range(len(volume)):
                share += volume[q] * basis[q, k] * basis[q, l]
            for q in range(len(volume)):
                basis[q, k] -= share * basis[q, l]
        size = 0.0
        for q in range(len(volume)):
            size += volume[q] * basis[q, k] * basis[q, k]
        for q in range(len(volume)):
            basis[q, k] /= np.sqrt(size)
        for i in range(n):
            share = 0.0
            for q in range(len(volume)):
                share += volume[q] * basis[q, k] * divergence[q, i]
            for q in range(len(volume)):
                divergence[q, i] -= share * basis[q, k]
    for q in range(len(volume)):
        for i in range(n):
            factor = bulk * volume[q] * divergence[q, i]
            for j in range(n):
                K[i, j] -= factor * divergence[q, j]
