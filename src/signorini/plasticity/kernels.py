# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over cells that yield: strains of displacements, nodal forces of stresses."""

from __future__ import annotations

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part


@kernel()
def add_strains(cells: IntArray, gradients: Array, u: Array, d: int, out: Array) -> None:
    """Add the strains of displacements at the points of a group of cells.

    Parameters
    ----------
    cells : (m, k) nodes
    gradients : (m, q, k, e) of the shape functions; a third one in the plane is the function over the radius, of bodies
        that twist too, which have ``d_r N - N / r`` as a fourth
    u : (dofs,) displacements
    d : components of a displacement, 2 or 3
    out : (m q, n) strains; in plane stress that across is left as it is
    """
    m, points, k, e = gradients.shape
    for c in range(m):
        for q in range(points):
            g, s = gradients[c, q], out[c * points + q]
            for a in range(k):
                at = d * cells[c, a]
                s[0] += g[a, 0] * u[at]
                s[1] += g[a, 1] * u[at + 1]
                s[3] += g[a, 1] * u[at] + g[a, 0] * u[at + 1]
                if e == 4:
                    s[2] += g[a, 2] * u[at]
                    s[4] += g[a, 1] * u[at + 2]
                    s[5] += g[a, 3] * u[at + 2]
                elif d == 3:
                    s[2] += g[a, 2] * u[at + 2]
                    s[4] += g[a, 2] * u[at + 1] + g[a, 1] * u[at + 2]
                    s[5] += g[a, 2] * u[at] + g[a, 0] * u[at + 2]
                elif e == 3:
                    s[2] += g[a, 2] * u[at]


@kernel()
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
                elif e == 4:
                    out[at] += w * (g[a, 0] * s[0] + g[a, 1] * s[3] + g[a, 2] * s[2])
                    out[at + 1] += w * (g[a, 1] * s[1] + g[a, 0] * s[3])
                    out[at + 2] += w * (g[a, 1] * s[4] + g[a, 3] * s[5])
                else:
                    out[at] += w * (g[a, 0] * s[0] + g[a, 1] * s[3] + g[a, 2] * s[5])
                    out[at + 1] += w * (g[a, 1] * s[1] + g[a, 0] * s[3] + g[a, 2] * s[4])
                    out[at + 2] += w * (g[a, 2] * s[2] + g[a, 1] * s[4] + g[a, 0] * s[5])


@part()
def strain_rows(g: Array, d: int, B: Array) -> None:
    """B of one point: strains of the displacements of its cell.

    Parameters
    ----------
    g : (k, e) gradients of the shape functions, see `add_strains`
    d : components of a displacement, 2 or 3
    B : (n, k d), written
    """
    B[:] = 0.0
    e = g.shape[1]
    for a in range(len(g)):
        at = d * a
        B[0, at], B[1, at + 1] = g[a, 0], g[a, 1]
        B[3, at], B[3, at + 1] = g[a, 1], g[a, 0]
        if e == 4:
            B[2, at] = g[a, 2]
            B[4, at + 2], B[5, at + 2] = g[a, 1], g[a, 3]
        elif d == 3:
            B[2, at + 2] = g[a, 2]
            B[4, at + 1], B[4, at + 2] = g[a, 2], g[a, 1]
            B[5, at], B[5, at + 2] = g[a, 2], g[a, 0]
        elif e == 3:
            B[2, at] = g[a, 2]
