# SPDX-License-Identifier: BSD-3-Clause
"""Sums of products of adjoint and actual displacements, for every two dofs that share a cell."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part


class Products(NamedTuple):
    """Sums of products of displacements, of two dofs of a cell: of columns, and of others known as sums alone.

    Attributes
    ----------
    w, u : (dofs, k) displacements, k of either
    free : (dofs,) places of dofs in the sums; negative where there is none
    indptr, indices, data : of the sums, by rows; those of both triangles in either or in one
    """

    w: Array
    u: Array
    free: IntArray
    indptr: IntArray
    indices: IntArray
    data: Array

    @classmethod
    def of(cls, w: Array, u: Array) -> Products:
        """Of columns alone.

        Parameters
        ----------
        w, u : (dofs, k)
        """
        none = np.zeros(0, dtype=np.int64)
        return cls(np.ascontiguousarray(w), np.ascontiguousarray(u), np.full(len(w), -1), none, none, np.zeros(0))


@part(fastmath={"reassoc", "contract"})
def products_of_cell(cell: IntArray, c: int, products: Products, place: IntArray, M: Array) -> None:
    """Overwrite M, (k c, k c), by the sums of products of all displacements of the nodes of a cell.

    Parameters
    ----------
    cell, c : its nodes, and components of a displacement
    products : of displacements
    place : (rows of the sums,) scratch, -1 everywhere
    M : overwritten
    """
    w, u, free, indptr, indices, data = products
    columns, size, shared = w.shape[1], len(cell) * c, False
    for i in range(size):
        row = free[cell[i // c] * c + i % c]
        if row >= 0:
            shared = shared or place[row] >= 0  # dofs that move together
            place[row] = i
    for i in range(size):
        row = cell[i // c] * c + i % c
        for j in range(size):
            other = cell[j // c] * c + j % c
            M[i, j] = 0.0
            for k in range(columns):
                M[i, j] += w[row, k] * u[other, k]
        if free[row] < 0:
            continue
        for p in range(indptr[free[row]], indptr[free[row] + 1]):
            if place[indices[p]] < 0:
                continue
            if not shared:
                M[i, place[indices[p]]] += data[p]
                continue
            for j in range(size):
                if free[cell[j // c] * c + j % c] == indices[p]:
                    M[i, j] += data[p]
    for i in range(size):
        if free[cell[i // c] * c + i % c] >= 0:
            place[free[cell[i // c] * c + i % c]] = -1


@part()
def no_places(products: Products) -> IntArray:
    """(rows of the sums,) -1."""
    return np.full(max(0, len(products.indptr) - 1), -1)


@kernel()
def products_of_cells(cells: IntArray, c: int, products: Products) -> Array:
    """(m, k c, k c) Sums of products of all displacements of the nodes of cells (m, k).

    Parameters
    ----------
    cells, c : their nodes, and components of a displacement
    products : of displacements
    """
    size = cells.shape[1] * c
    found, place = np.empty((len(cells), size, size)), no_places(products)
    for t in range(len(cells)):
        products_of_cell(cells[t], c, products, place, found[t])
    return found
