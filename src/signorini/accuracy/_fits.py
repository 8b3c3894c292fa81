# SPDX-License-Identifier: BSD-3-Clause
"""Normal equations of polynomials around nodes, summed patch by patch."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel


@kernel()
def add_points(
    patches: tuple[IntArray, IntArray],
    places: Array,
    values: Array,
    centres: Array,
    sizes: Array,
    normal: Array,
    right: Array,
) -> None:
    """Add the points of the cells around every node to the normal equations of its polynomial.

    Monomials up to degree 1 or 2 of ``(x - centre) / size``, as many as the equations have.

    Parameters
    ----------
    patches : where the cells of every node begin (n + 1,), and these
    places, values : (m, p, d) and (m, p, c) of the points of the cells
    centres, sizes : (n, d) and (n,) of the nodes, length
    normal, right : (n, k, k) and (n, k, c), added to
    """
    starts, cells = patches
    d, count, components = places.shape[2], normal.shape[1], values.shape[2]
    basis = normal[0, 0].copy()
    basis[0] = 1.0
    for v in range(len(starts) - 1):
        for cell in cells[starts[v] : starts[v + 1]]:
            for p in range(places.shape[1]):
                for i in range(d):
                    basis[1 + i] = (places[cell, p, i] - centres[v, i]) / sizes[v]
                if count > d + 1:
                    k = d + 1
                    for i in range(d):
                        for j in range(i, d):
                            basis[k] = basis[1 + i] * basis[1 + j]
                            k += 1
                for i in range(count):
                    for j in range(count):
                        normal[v, i, j] += basis[i] * basis[j]
                    for c in range(components):
                        right[v, i, c] += basis[i] * values[cell, p, c]


@kernel()
def add_work(
    cells: tuple[IntArray, Array, Array],
    shapes: tuple[Array, Array],
    places: Array,
    fitted: tuple[Array, Array, Array],
    compliance: Array,
    found: Array,
) -> None:
    """Work of what stresses of the cells are away from polynomials around their corners, and of these.

    Parameters
    ----------
    cells : corners (m, a), stresses at the points where these are best (m, p, c), volumes (m, q)
    shapes : linear shape functions at the q places (q, a), and values there of what is given at the p points (q, p)
    places : (m, q, d) length
    fitted : centres of all nodes (n, d), sizes (n,), coefficients (n, k, c)
    compliance : (c, c)
    found : (m, 2) both works, added to
    """
    corners, stress, volumes = cells
    linear, own = shapes
    centres, sizes, coefficients = fitted
    d, count, components = places.shape[2], coefficients.shape[1], coefficients.shape[2]
    away, smooth, difference = np.zeros(d), np.zeros(components), np.zeros(components)
    for m in range(len(corners)):
        for q in range(places.shape[1]):
            smooth[:] = 0.0
            for a in range(corners.shape[1]):
                v, share = corners[m, a], linear[q, a]
                for i in range(d):
                    away[i] = (places[m, q, i] - centres[v, i]) / sizes[v]
                for c in range(components):
                    value = coefficients[v, 0, c]
                    for i in range(d):
                        value += away[i] * coefficients[v, 1 + i, c]
                    if count > d + 1:
                        k = d + 1
                        for i in range(d):
                            for j in range(i, d):
                                value += away[i] * away[j] * coefficients[v, k, c]
                                k += 1
                    smooth[c] += share * value
            for c in range(components):
                difference[c] = smooth[c]
                for p in range(stress.shape[1]):
                    difference[c] -= own[q, p] * stress[m, p, c]
            for i in range(components):
                for j in range(components):
                    weight = volumes[m, q] * compliance[i, j]
                    found[m, 0] += weight * difference[i] * difference[j]
                    found[m, 1] += weight * smooth[i] * smooth[j]
