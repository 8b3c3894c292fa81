# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loop over cells that yield: what that takes off the stiffness.

Plasticity is a correction of the elastic problem, so that whatever made the elastic stiffness K stays as it is::

    internal forces = K u - f_p,   f_p = sum_q w B^T D eps_p,      K_T = K - sum_q w B^T M B

M is what yielding takes off the elastic law D; in plane stress of both what is left once the strain across has made the
stress across vanish.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem._kernels import scatter
from signorini.plasticity.kernels import strain_rows
from signorini.plasticity.laws import YieldLaws
from signorini.plasticity.linearised import taken
from signorini.plasticity.modes import Modes, softened
from signorini.plasticity.radial_return import Points


@kernel()
def soften(
    cells: IntArray,
    shape: tuple[Array, Array, Modes],
    laws: YieldLaws,
    body: IntArray,
    point: Points,
    dual: Array,
    left: float,
    pattern: tuple[IntArray, IntArray],
    data: Array,
) -> None:
    """Add ``sum_q w B^T M B`` over the yielding points of a group of cells to a matrix on the pattern of the nodes.

    M is that of `linearised.taken`. In cells with internal modes B is that of elastic ones, ``B - G K_aa^-1 K_au``, and
    what modes give way by beyond that is ``C^T (K_aa - sum_q w G^T M G)^-1 C``, ``C = sum_q w G^T M B``.

    Parameters
    ----------
    cells : (m, k) nodes
    shape : gradients (m, q, k, e), weights (m, q) and modes
    laws, body : of the bodies, and of every point (m q,)
    point : the state of the points
    dual : (m q, n) s, a tensor of size at most 1
    left : part of the elastic law that yielding leaves in place, 0 .. 1
    pattern : rows and columns of the graph of the nodes
    data : entries, d unknowns a node
    """
    gradients, weights, modes = shape
    rows, columns = pattern
    m, points, k, _ = gradients.shape
    n = dual.shape[1]
    d = 2 if n == 4 else 3
    B, MB, M, K = np.empty((n, k * d)), np.empty((n, k * d)), np.empty((n, n)), np.empty((k * d, k * d))
    count = modes.stiffness.shape[1]
    G, C = np.empty((n, count)), np.empty((count, k * d))
    loss, L = np.empty((count, count)), np.empty((count, count))
    for c in range(m):
        first = c * points
        if not point.yields[first : first + points].any():
            continue
        K[:], C[:], loss[:] = 0.0, 0.0, 0.0
        for q in range(points):
            i = first + q
            if not point.yields[i]:
                continue
            strain_rows(gradients[c, q], d, B)
            taken(laws, body[i], point, i, dual[i], left, M)
            w = weights[c, q]
            if count:
                strain_rows(modes.gradients[c, q], d, G)
                _subtract_product(G, modes.share[c], B)
            for r in range(n):
                for y in range(k * d):
                    value = 0.0
                    for t in range(n):
                        value += M[r, t] * B[t, y]
                    MB[r, y] = w * value
            for x in range(k * d):
                for r in range(n):
                    part = B[r, x]
                    if part != 0.0:
                        for y in range(k * d):
                            K[x, y] += part * MB[r, y]
            for x in range(count):
                for r in range(n):
                    for y in range(k * d):
                        C[x, y] += G[r, x] * MB[r, y]
                    stress = 0.0
                    for t in range(n):
                        stress += w * M[r, t] * G[t, x]
                    for y in range(count):
                        loss[y, x] += G[r, y] * stress
        if count:
            softened(modes.stiffness[c], loss, L)
            _add_given_way(L, C, K)
        scatter(K, cells[c], d, rows, columns, data)


@part()
def _subtract_product(G: Array, X: Array, B: Array) -> None:
    """Subtract ``G X`` from B."""
    for r in range(len(G)):
        for x in range(len(X)):
            part = G[r, x]
            if part != 0.0:
                for y in range(B.shape[1]):
                    B[r, y] -= part * X[x, y]


@part()
def _add_given_way(L: Array, C: Array, K: Array) -> None:
    """Add ``C^T (L L^T)^-1 C`` to K; C becomes ``L^-1 C``."""
    for x in range(len(C)):
        for t in range(x):
            part = L[x, t]
            for y in range(C.shape[1]):
                C[x, y] -= part * C[t, y]
        for y in range(C.shape[1]):
            C[x, y] /= L[x, x]
        for i in range(len(K)):
            part = C[x, i]
            for y in range(len(K)):
                K[i, y] += part * C[x, y]
