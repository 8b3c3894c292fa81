# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over cells that yield: strains, nodal forces, and what yielding takes off the stiffness.

Plasticity is a correction of the elastic problem, so that whatever made the elastic stiffness K stays as it is::

    internal forces = K u - f_p,   f_p = sum_q w B^T D eps_p,      K_T = K - sum_q w B^T M B

M is what yielding takes off the elastic law D; in plane stress of both what is left once the strain across has made the
stress across vanish.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from signorini.arrays import Array, IntArray
from signorini.fem._kernels import scatter
from signorini.plasticity.radial_return import Points, YieldLaws


@njit(cache=True)
def strains(cells: IntArray, gradients: Array, u: Array, d: int, out: Array) -> None:
    """Strains of displacements at the points of a group of cells.

    Parameters
    ----------
    cells : (m, k) nodes
    gradients : (m, q, k, e) of the shape functions; a third one in the plane is the function over the radius
    u : (dofs,) displacements
    d : dimension, 2 or 3
    out : (m q, n) strains; in plane stress the strain across is left as it is
    """
    m, points, k, e = gradients.shape
    for c in range(m):
        for q in range(points):
            g, s = gradients[c, q], out[c * points + q]
            s[0], s[1], s[3] = 0.0, 0.0, 0.0
            if d == 3 or e == 3:
                s[2] = 0.0
            if d == 3:
                s[4], s[5] = 0.0, 0.0
            for a in range(k):
                at = d * cells[c, a]
                s[0] += g[a, 0] * u[at]
                s[1] += g[a, 1] * u[at + 1]
                s[3] += g[a, 1] * u[at] + g[a, 0] * u[at + 1]
                if d == 3:
                    s[2] += g[a, 2] * u[at + 2]
                    s[4] += g[a, 2] * u[at + 1] + g[a, 1] * u[at + 2]
                    s[5] += g[a, 2] * u[at] + g[a, 0] * u[at + 2]
                elif e == 3:
                    s[2] += g[a, 2] * u[at]


@njit(cache=True)
def add_forces(cells: IntArray, gradients: Array, weights: Array, stress: Array, d: int, out: Array) -> None:
    """Add the nodal forces ``sum_q w B^T sigma`` of stresses at the points of a group of cells.

    Parameters
    ----------
    cells, gradients, d : as of `strains`
    weights : (m, q) volumes of the points
    stress : (m q, n) tensors
    out : (dofs,) forces
    """
    m, points, k, e = gradients.shape
    for c in range(m):
        for q in range(points):
            s, w, g = stress[c * points + q], weights[c, q], gradients[c, q]
            if not s.any():
                continue
            for a in range(k):
                at = d * cells[c, a]
                if d == 2:
                    out[at] += w * (g[a, 0] * s[0] + g[a, 1] * s[3])
                    out[at + 1] += w * (g[a, 1] * s[1] + g[a, 0] * s[3])
                    if e == 3:
                        out[at] += w * g[a, 2] * s[2]
                else:
                    out[at] += w * (g[a, 0] * s[0] + g[a, 1] * s[3] + g[a, 2] * s[5])
                    out[at + 1] += w * (g[a, 1] * s[1] + g[a, 0] * s[3] + g[a, 2] * s[4])
                    out[at + 2] += w * (g[a, 2] * s[2] + g[a, 1] * s[4] + g[a, 0] * s[5])


@njit(cache=True)
def _strain_rows(g: Array, d: int, ring: bool, B: Array) -> None:
    """B, (n, k d), of one point."""
    B[:] = 0.0
    for a in range(len(g)):
        at = d * a
        B[0, at], B[1, at + 1] = g[a, 0], g[a, 1]
        B[3, at], B[3, at + 1] = g[a, 1], g[a, 0]
        if d == 3:
            B[2, at + 2] = g[a, 2]
            B[4, at + 1], B[4, at + 2] = g[a, 2], g[a, 1]
            B[5, at], B[5, at + 2] = g[a, 2], g[a, 0]
        elif ring:
            B[2, at] = g[a, 2]


@njit(cache=True)
def _taken(laws: YieldLaws, body: int, point: Points, i: int, dual: Array, left: float, M: Array) -> None:
    """M, (n, n), at point i: what yielding takes off the elastic law; see `soften`."""
    n, G2 = len(dual), 2.0 * laws.shear[body] * (1.0 - left)
    a, b, way = point.slack[i, 0], point.slack[i, 1], point.direction[i]
    for r in range(n):
        for c in range(n):
            value = 0.5 * b * (way[r] * dual[c] + dual[r] * way[c])
            if r == c:
                value += a * (1.0 if r < 3 else 0.5)
            if r < 3 and c < 3:
                value -= a / 3.0
            M[r, c] = G2 * value
    if not laws.thin:
        return
    # the stress across vanishes with the elastic law D, and with the tangent D - M: both lose the strain across
    G, K = laws.shear[body], laws.bulk[body]
    lame, stiff = K - 2.0 / 3.0 * G, K + 4.0 / 3.0 * G
    rest = stiff - M[2, 2]
    for r in range(n):
        for c in range(n):
            if r != 2 and c != 2:
                one, two = (lame if r < 3 else 0.0), (lame if c < 3 else 0.0)
                M[r, c] += (one - M[r, 2]) * (two - M[2, c]) / rest - one * two / stiff
    for r in range(n):
        M[r, 2], M[2, r] = 0.0, 0.0


@njit(cache=True)
def soften(
    cells: IntArray,
    shape: tuple[Array, Array],
    laws: YieldLaws,
    body: IntArray,
    point: Points,
    dual: Array,
    left: float,
    pattern: tuple[IntArray, IntArray],
    data: Array,
) -> None:
    """Add ``sum_q w B^T M B`` over the yielding points of a group of cells to a matrix on the pattern of the nodes.

    ``M = 2 G (1 - left) (a I_dev + b sym(s n^T))``; s = n is the consistent tangent of the radial return.

    Parameters
    ----------
    cells : (m, k) nodes
    shape : gradients (m, q, k, e) and weights (m, q)
    laws, body : of the bodies, and of every point (m q,)
    point : the state of the points
    dual : (m q, n) s, a tensor of size at most 1
    left : part of the elastic law that yielding leaves in place, 0 .. 1
    pattern : rows and columns of the graph of the nodes
    data : entries, d unknowns a node
    """
    gradients, weights = shape
    rows, columns = pattern
    m, points, k, e = gradients.shape
    n = dual.shape[1]
    d = 2 if n == 4 else 3
    B, MB, M, K = np.empty((n, k * d)), np.empty((n, k * d)), np.empty((n, n)), np.empty((k * d, k * d))
    for c in range(m):
        first = c * points
        if not point.yields[first : first + points].any():
            continue
        K[:] = 0.0
        for q in range(points):
            i = first + q
            if not point.yields[i]:
                continue
            _strain_rows(gradients[c, q], d, e == 3, B)
            _taken(laws, body[i], point, i, dual[i], left, M)
            w = weights[c, q]
            for r in range(n):
                for y in range(k * d):
                    value = 0.0
                    for t in range(n):
                        value += M[r, t] * B[t, y]
                    MB[r, y] = w * value
            for x in range(k * d):
                for r in range(n):
                    factor = B[r, x]
                    if factor != 0.0:
                        for y in range(k * d):
                            K[x, y] += factor * MB[r, y]
        scatter(K, cells[c], d, rows, columns, data)
