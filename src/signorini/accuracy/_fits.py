# SPDX-License-Identifier: BSD-3-Clause
"""Normal equations of polynomials around nodes, summed patch by patch."""

from __future__ import annotations

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
