# SPDX-License-Identifier: BSD-3-Clause
"""How the virtual work of stresses changes with the place of every node of the mesh, in one pass over the cells.

With ``W = sum_k int eps(w_k) : C : eps(u_k)`` a node b that moves by e_m changes gradients by ``-d_m N_a d_i N_b`` and
volumes by ``d_m N_b``, so that

    dW/dx_bm = sum_q dV [ (sum_k sig(u_k) : eps(w_k)) d_m N_b - sum_i Q_mi d_i N_b ],
    Q_mi = sum_k (d_m w_k . sig(u_k)_i + d_m u_k . sig(w_k)_i),

exactly as it is integrated: Eshelby's energy-momentum tensor. Bodies of revolution add what radii do. Cells with
internal modes or a mean dilatation are differentiated by differences, all cells at once, a node of each at a time.

References
----------
Eshelby (1975), The elastic energy-momentum tensor, Journal of Elasticity 5:321.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem._kernels import gradients_at
from signorini.fem.elasticity import elasticities, law_tensor
from signorini.fem.kinematics import Group, straining_groups
from signorini.fem.measure import measure_of_cells
from signorini.fem.space import Space
from signorini.fem.stiffness import stiffness
from signorini.model.model import Model

_STEP = 1e-5  # of the size of a cell: differences of its stiffness are right to 1e-10 then


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


def add_node_work(found: Array, space: Space, model: Model, products: Products) -> None:
    """Add ``d(sum_k w_k . K u_k) / dx`` to (nodes, d), where K depends on the places x of the nodes.

    Parameters
    ----------
    found : added to, work per length
    space, model : the mesh and what is on it
    products : of displacements w and u
    """
    d, c = space.dimension, space.components
    law = law_tensor(elasticities(model), hoop=model.axisymmetric)
    terms = np.argwhere((law != 0.0).any(axis=0))
    entries, values = np.column_stack([terms[:, 0], terms[:, 2], terms[:, 1], terms[:, 3]]), law[:, *terms.T]
    for group in straining_groups(space, model):
        if group.formulation != "standard":
            np.add.at(found, group.cells, _by_differences(space, model, group, products))
            continue
        places = partial(np.einsum, "qk,mki->mqi", group.block.values, space.mesh.points[group.cells])
        weights = measure_of_cells(model, places, group.numbers) * group.block.weights
        of_cells = (np.ascontiguousarray(group.cells), group.body, weights)
        block = (group.block.values, np.ascontiguousarray(group.block.gradients))
        _add(found, space.mesh.points, of_cells, block, (entries, np.ascontiguousarray(values)), products, c, d)


def _by_differences(space: Space, model: Model, group: Group, products: Products) -> Array:
    """(m, k, d) Of the nodes of the cells of a group, each cell on nodes of its own."""
    block, d = group.block, space.dimension
    alone = replace(block, cells=np.arange(block.cells.size).reshape(block.cells.shape))
    apart = replace(group, block=alone)
    places = space.mesh.points[block.cells]
    size = np.ptp(places, axis=1).max(axis=1)
    sums = _of_cells(np.ascontiguousarray(group.cells), space.components, products)
    found = np.empty((*group.cells.shape, d))
    for a, i in np.ndindex(found.shape[1:]):
        step = np.zeros_like(places)
        step[:, a, i] = _STEP * size
        low, high = (
            stiffness(space.at((places + way * step).reshape(-1, d), np.zeros(0)), model, [apart]).data
            for way in (-1.0, 1.0)
        )
        change = ((high - low).reshape(sums.shape) * sums).sum(axis=(1, 2))
        found[:, a, i] = change / (2.0 * _STEP * size[group.index])
    return found


@part(fastmath={"reassoc", "contract"})
def _products(cell: IntArray, c: int, products: Products, place: IntArray, M: Array) -> None:
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
def _no_places(products: Products) -> IntArray:
    """(rows of the sums,) -1."""
    return np.full(max(0, len(products.indptr) - 1), -1)


@kernel()
def _of_cells(cells: IntArray, c: int, products: Products) -> Array:
    """(m, k c, k c) Sums of products of all displacements of the nodes of cells (m, k).

    Parameters
    ----------
    cells, c : their nodes, and components of a displacement
    products : of displacements
    """
    size = cells.shape[1] * c
    found, place = np.empty((len(cells), size, size)), _no_places(products)
    for t in range(len(cells)):
        _products(cells[t], c, products, place, found[t])
    return found


@kernel()
def _add(
    found: Array,
    points: Array,
    of_cells: tuple[IntArray, IntArray, Array],
    block: tuple[Array, Array],
    law: tuple[IntArray, Array],
    products: Products,
    c: int,
    d: int,
) -> None:
    """Add what cells of the standard formulation have, see the module.

    Parameters
    ----------
    found : (nodes, d) added to
    points : (nodes, d)
    of_cells : (m, k) nodes, (m,) materials and (m, q) weights times thickness or circumference
    block : (q, k) shape functions and (q, k, d) their reference gradients
    law : (t, 4) numbers r, s, i, j and (n, t) values of ``C_risj``
    products : of displacements
    c, d : components of a displacement and of a place
    """
    cells, material, weights = of_cells
    values, gradients = block
    entries, moduli = law
    nodes, hoop = cells.shape[1], moduli.shape[1] > 0 and entries[:, 2].max() == d
    e = d + 1 if hoop else d
    summed = len(products.data) > 0 or products.w.shape[1] > nodes  # of few columns slopes are cheaper than products
    M, g, x = np.empty((nodes * c, nodes * c)), np.empty(nodes * e), np.empty((nodes, d))
    place = _no_places(products)
    J, I = np.eye(3), np.empty((3, 3))  # noqa: E741
    T, H, Q = np.empty((c, e, nodes * c)), np.empty((c, e, c, e)), np.empty((d, e))
    for t in range(len(cells)):
        if summed:
            _products(cells[t], c, products, place, M)
        for a in range(nodes):
            for m in range(d):
                x[a, m] = points[cells[t, a], m]
        for q in range(len(gradients)):
            volume = abs(gradients_at(x, gradients[q], J, I, g, e)) * weights[t, q]
            if hoop:
                radius = 0.0
                for a in range(nodes):
                    radius += values[q, a] * x[a, 0]
                for a in range(nodes):
                    g[a * e + d] = values[q, a] / radius
            if summed:
                _slopes(M, g, nodes, T, H)
            else:
                _slopes_of_columns(cells[t], products, g, T, H)
            work = 0.0
            for m in range(d):
                for i in range(e):
                    Q[m, i] = 0.0
            for n in range(len(entries)):
                r, s, i, j = entries[n, 0], entries[n, 1], entries[n, 2], entries[n, 3]
                modulus = moduli[material[t], n]
                work += modulus * H[r, i, s, j]
                for m in range(d):
                    if i < d:
                        Q[m, i] += modulus * H[r, m, s, j]
                    if j < d:
                        Q[m, j] += modulus * H[r, i, s, m]
                if hoop:
                    Q[0, d] += modulus * H[r, i, s, j] * ((i == d) + (j == d))
            for b in range(nodes):
                for m in range(d):
                    part = work * g[b * e + m]
                    for i in range(d):
                        part -= Q[m, i] * g[b * e + i]
                    if hoop and m == 0:
                        part += (work - Q[0, d]) * g[b * e + d]
                    found[cells[t, b], m] += volume * part


@part()
def _slopes_of_columns(cell: IntArray, products: Products, g: Array, T: Array, H: Array) -> None:
    """Overwrite H, (c, e, c, e), by the products of all slopes of both displacements of a cell, from their columns.

    Parameters
    ----------
    cell : (k,) nodes
    products : of displacements, without sums
    g : (k e,) gradients of shape functions
    T : scratch, as of `_slopes`
    H : overwritten
    """
    c, e = H.shape[:2]
    for k in range(products.w.shape[1]):
        for r in range(c):
            for i in range(e):
                slope, other = 0.0, 0.0
                for a in range(len(cell)):
                    slope += g[a * e + i] * products.w[cell[a] * c + r, k]
                    other += g[a * e + i] * products.u[cell[a] * c + r, k]
                T[r, i, 0], T[r, i, 1] = slope, other
        for r in range(c):
            for i in range(e):
                for s in range(c):
                    for j in range(e):
                        H[r, i, s, j] = (H[r, i, s, j] if k else 0.0) + T[r, i, 0] * T[s, j, 1]


@part()
def _slopes(M: Array, g: Array, nodes: int, T: Array, H: Array) -> None:
    """Overwrite H, (c, e, c, e), by the products of all slopes of both displacements at a point; T is scratch."""
    c, e = H.shape[:2]
    for r in range(c):
        for i in range(e):
            for column in range(nodes * c):
                total = 0.0
                for a in range(nodes):
                    total += g[a * e + i] * M[a * c + r, column]
                T[r, i, column] = total
            for s in range(c):
                for j in range(e):
                    total = 0.0
                    for b in range(nodes):
                        total += g[b * e + j] * T[r, i, b * c + s]
                    H[r, i, s, j] = total
