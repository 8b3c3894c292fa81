# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops of the stiffness assembly: the pattern of the nodes, and the blocks added into it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem._element import combine, eliminate, gradients_at, project


@part()
def _first_known(ahead: Int32Array, node: int) -> int:
    """The first node of the piece of a node as far as it is known; the way there is halved for those that ask again."""
    while ahead[node] != node:
        ahead[node] = ahead[ahead[node]]
        node = ahead[node]
    return node


@kernel()
def connected_pieces(start: IntArray, corner: Int32Array, nodes: int) -> Int32Array:
    """Give the connected piece of each node, (nodes,), in the order of their first nodes.

    Parameters
    ----------
    start, corner, nodes : see `node_pattern`
    """
    ahead = np.arange(nodes).astype(np.int32)  # a node of the same piece, never a later one
    for e in range(len(start) - 1):
        one = _first_known(ahead, corner[start[e]])
        for p in range(start[e] + 1, start[e + 1]):
            other = _first_known(ahead, corner[p])
            one, other = min(one, other), max(one, other)
            ahead[other] = one
    found, count = np.empty(nodes, np.int32), 0
    for i in range(nodes):
        if ahead[i] == i:
            found[i] = count
            count += 1
        else:
            found[i] = found[ahead[i]]
    return found


@kernel()
def node_pattern(start: IntArray, corner: Int32Array, nodes: int) -> tuple[IntArray, Int32Array]:
    """Give the sorted rows of the graph that joins all nodes of an element; a node is its own neighbour.

    Parameters
    ----------
    start, corner : element e has the nodes ``corner[start[e]:start[e + 1]]``
    """
    first = np.zeros(nodes + 1, np.int64)
    for p in range(len(corner)):
        first[corner[p] + 1] += 1
    for i in range(nodes):
        first[i + 1] += first[i]
    element = np.empty(len(corner), np.int32)
    fill = first[:-1].copy()
    for e in range(len(start) - 1):
        for p in range(start[e], start[e + 1]):
            element[fill[corner[p]]] = e
            fill[corner[p]] += 1

    mark = np.full(nodes, -1, np.int32)
    rows = np.zeros(nodes + 1, np.int64)
    columns = np.empty(max(16, len(corner) * 3), np.int32)
    top = 0
    for i in range(nodes):
        for q in range(first[i], first[i + 1]):
            for p in range(start[element[q]], start[element[q] + 1]):
                j = corner[p]
                if mark[j] != i:
                    mark[j] = i
                    if top == len(columns):
                        longer = np.empty(2 * top, np.int32)
                        for r in range(top):
                            longer[r] = columns[r]
                        columns = longer
                    columns[top] = j
                    top += 1
        rows[i + 1] = top
    return rows, _transposed(rows, columns[:top])


@part()
def _transposed(rows: IntArray, columns: Int32Array) -> Int32Array:
    """Give the columns of the transposed pattern; of a symmetric one: the same, but sorted."""
    top = rows.copy()
    out = np.empty(len(columns), np.int32)
    for i in range(len(rows) - 1):
        for p in range(rows[i], rows[i + 1]):
            out[top[columns[p]]] = i
            top[columns[p]] += 1
    return out


@kernel()
def unknown_pattern(rows: IntArray, columns: Int32Array, d: int) -> tuple[Int32Array, Int32Array]:
    """Give every node d unknowns, ``d * node + component``.

    Parameters
    ----------
    rows, columns : of the nodes, see :func:`node_pattern`
    d : unknowns a node
    """
    nodes = len(rows) - 1
    indptr = np.empty(nodes * d + 1, np.int32)
    indices = np.empty(len(columns) * d * d, np.int32)
    indptr[0] = 0
    top = 0
    for i in range(nodes):
        for r in range(d):
            for p in range(rows[i], rows[i + 1]):
                for s in range(d):
                    indices[top] = columns[p] * d + s
                    top += 1
            indptr[i * d + r + 1] = top
    return indptr, indices


class MatrixRows(NamedTuple):
    """A sparse matrix by rows, or what is kept of it."""

    indptr: Int32Array
    indices: Int32Array
    data: Array


@kernel(nogil=True)
def keep_rows(every: MatrixRows, number: Int32Array, kept: MatrixRows, low: int, high: int) -> None:
    """Keep rows and columns of a matrix: those of a range of its rows; with no room for entries, count them.

    Parameters
    ----------
    every : the matrix
    number : of every row and column among those that are kept, -1 of others
    kept : what is written: the entries of row i behind ``indptr[i]``, or their number into ``indptr[i + 1]``
    low, high : range of rows of the matrix
    """
    counts = len(kept.data) == 0
    for i in range(low, high):
        row = number[i]
        if row < 0:
            continue
        top = 0 if counts else kept.indptr[row]
        for p in range(every.indptr[i], every.indptr[i + 1]):
            j = number[every.indices[p]]
            if j < 0:
                continue
            if not counts:
                kept.indices[top], kept.data[top] = j, every.data[p]
            top += 1
        if counts:
            kept.indptr[row + 1] = top


class Cells(NamedTuple):
    """Elements of one kind; what stands here without a dimension goes for all of them.

    Attributes
    ----------
    nodes : (M, k) the nodes of every element
    shape_gradients : (nq, k, d) reference gradients of the shape functions at the points of a quadrature
    weights : (nq,) weights of the quadrature on the reference element
    material : (M,) which of the laws is each element's, or one number
    measure : (M, nq), (M, 1) or one number, what a point of the plane stands for: thickness or circumference, length
    shape_values : (nq, k) the shape functions themselves; axisymmetric bodies need them: ``N_a / r`` joins the
        gradients as a further component, and with twist ``d_r N_a - N_a / r``
    modes : (M, nq, k', e) gradients of internal modes of each element, which are eliminated
    pressures : (nq, p) functions that the dilatation of every element without modes is projected on; with none it stays
    """

    nodes: IntArray
    shape_gradients: Array
    weights: Array
    material: IntArray = np.zeros(1, np.int64)
    measure: Array = np.ones(1)
    shape_values: Array = np.empty((0, 0))
    modes: Array = np.empty((0, 0, 0, 0))
    pressures: Array = np.empty((0, 0))


class Laws(NamedTuple):
    """Laws of materials: the term t adds ``values[m, t]`` times the product of two components of gradients.

    Attributes
    ----------
    entries : (t, 3) directions r and s of the stiffness, as ``c r + s``, and the two components
    values : (n, t) force / length^2
    bulk : (n,) moduli for the projection on pressures
    components : c of a displacement
    """

    entries: IntArray
    values: Array
    bulk: Array
    components: int


class SparsityPattern(NamedTuple):
    """The stiffness by rows of nodes, see :func:`node_pattern`, and its entries, which are added to."""

    rows: IntArray
    columns: Int32Array
    data: Array


class Share(NamedTuple):
    """What one thread adds: the rows of some nodes.

    Attributes
    ----------
    cells : elements that have any of them, ascending
    of : (N,) the share of every node
    number : which one
    """

    cells: Int32Array
    of: Int32Array
    number: int


@kernel(nogil=True)
def add_block(points: Array, elements: Cells, laws: Laws, pattern: SparsityPattern, own: Share) -> tuple[int, int]:
    """Add the stiffness of the elements of one kind; give (-1, 0), or the first bad element and what is wrong with it.

    The products ``C = sum_q w g g^T`` of all gradient components are summed first, which is one rank-one update per
    point; the constitutive law then combines their entries once per element. Wrong may be: 1 the element is folded or
    has no volume, 2 it reaches over the axis.

    Parameters
    ----------
    points : (N, d) of all nodes, length
    elements, laws : of one kind, arrays of full shapes
    pattern : added to
    own : rows that are added to
    """
    inner, e = elements.modes.shape[2:]
    return _add_cells(
        points, elements, laws, pattern, own, (elements.nodes.shape[1], points.shape[1], laws.components, inner, e)
    )


@kernel(nogil=True)
def add_quadrilaterals(
    points: Array, elements: Cells, laws: Laws, pattern: SparsityPattern, own: Share
) -> tuple[int, int]:
    """What `add_block` does with the same digits, of plane cells of four nodes without modes: half of its time.

    Numbers of nodes and components that the compiler knows make short loops straight code. A plane solve has little
    else that is as long, and kernels that are asked for alone are compiled.

    Parameters
    ----------
    points, elements, laws, pattern, own : as of `add_block`
    """
    return _add_cells(points, elements, laws, pattern, own, (4, 2, 2, 0, 2))


@part(inline="always")
def _add_cells(
    points: Array, elements: Cells, laws: Laws, pattern: SparsityPattern, own: Share, sizes: tuple[int, ...]
) -> tuple[int, int]:
    """What `add_block` does; sizes: nodes of a cell, coordinates, components of displacements, modes, of gradients."""
    cells, gradients, weights, material, measure, values, modes, pressures = elements
    (nodes, d, c, inner, e), (entries, law, bulk, _) = sizes, laws
    rows, columns, data = pattern
    ring = len(values) > 0
    every = nodes + inner
    C = np.empty((every * e, every * e))
    K = np.empty((every * c, every * c))
    g = np.empty(every * e)
    x = np.empty((nodes, d))
    J, I = np.zeros((3, 3)), np.empty((3, 3))  # noqa: E741
    J[2, 2] = 1.0  # of meshes in the plane, which leave the last row and column
    divergence, volume = np.zeros((len(weights), nodes * c)), np.empty(len(weights))
    for t in own.cells:
        for a in range(nodes):
            for r in range(d):
                x[a, r] = points[cells[t, a], r]
        C[:] = 0.0
        sign = 0.0
        for q in range(len(weights)):
            w, det = weights[q], gradients_at(x, gradients[q], J, I, g, nodes, d, e)
            if det == 0.0 or det * sign < 0.0:
                return t, 1
            sign = det
            w *= abs(det)
            if ring:
                radius = 0.0
                for a in range(nodes):
                    radius += values[q, a] * x[a, 0]
                if radius <= 0.0:
                    return t, 2
                for a in range(nodes):
                    g[a * e + d] = values[q, a] / radius
                    if e > d + 1:
                        g[a * e + d + 1] = g[a * e] - g[a * e + d]
            for a in range(inner):
                for i in range(e):
                    g[(nodes + a) * e + i] = modes[t, q, a, i]
            w *= measure[t, q]
            volume[q] = w
            for a in range(nodes):
                for r in range(d):
                    divergence[q, a * c + r] = g[a * e + r]
                if ring:
                    divergence[q, a * c] += g[a * e + d]
            for i in range(every * e):
                wg = w * g[i]
                for j in range(every * e):
                    C[i, j] += wg * g[j]
        combine(C, every, c, e, entries, law[material[t]], K)
        eliminate(K, nodes * c)
        if pressures.shape[1]:
            project(K, divergence, volume, pressures, bulk[material[t]])
        for a in range(nodes):
            if own.of[cells[t, a]] == own.number:
                _scatter_rows(K, cells[t], a, c, rows, columns, data)
    return -1, 0


@part()
def scatter(K: Array, cell: IntArray, d: int, rows: IntArray, columns: IntArray, data: Array) -> None:
    """Add the matrix of an element to a matrix on the pattern of the nodes.

    Parameters
    ----------
    K : (k d, k d) of the element
    cell : (k,) its nodes
    d : unknowns a node
    rows, columns : of the graph of the nodes
    data : entries, d unknowns a node
    """
    for a in range(len(cell)):
        _scatter_rows(K, cell, a, d, rows, columns, data)


@part()
def _scatter_rows(K: Array, cell: IntArray, a: int, d: int, rows: IntArray, columns: IntArray, data: Array) -> None:
    """Add the rows of one of its nodes."""
    low, high = rows[cell[a]], rows[cell[a] + 1]
    for b in range(len(cell)):
        p, end = low, high
        while p < end:
            middle = (p + end) >> 1
            if columns[middle] < cell[b]:
                p = middle + 1
            else:
                end = middle
        for r in range(d):
            at = d * d * low + r * d * (high - low) + d * (p - low)
            for s in range(d):
                data[at + s] += K[a * d + r, b * d + s]
