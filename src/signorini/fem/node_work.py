# SPDX-License-Identifier: BSD-3-Clause
"""How the virtual work of stresses changes with the place of every node of the mesh, in one pass over the cells.

With ``W = sum_k int eps(w_k) : C : eps(u_k)`` a node b that moves by e_m changes gradients by ``-d_m N_a d_i N_b`` and
volumes by ``d_m N_b``, so that

    dW/dx_bm = sum_q dV [ (sum_k sig(u_k) : eps(w_k)) d_m N_b - sum_i Q_mi d_i N_b ],
    Q_mi = sum_k (d_m w_k . sig(u_k)_i + d_m u_k . sig(w_k)_i),

exactly as it is integrated: Eshelby's energy-momentum tensor. Bodies of revolution add what radii do. Cells of one
material stand side by side, along the last axis of arrays: the innermost loops are over them, as vector instructions.
Cells with internal modes or a mean dilatation are differentiated by differences, all cells at once, a node of each at a
time.

References
----------
Eshelby (1975), The elastic energy-momentum tensor, Journal of Elasticity 5:321.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.fem.displacement_products import Products, no_places, products_of_cell, products_of_cells
from signorini.fem.elasticity import elasticities, law_tensor
from signorini.fem.kinematics import Group, of_bodies, straining_groups
from signorini.fem.space import Space
from signorini.fem.stiffness import cells_of, stiffness
from signorini.model.model import Model

_STEP = 1e-5  # of the size of a cell: differences of its stiffness are right to 1e-10 then
_LANES = 64  # cells side by side: all that is known of them stays in the cache that is next to the core
_REVOLVED = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, -1]])  # derivatives with twist by those without


def add_node_work(found: Array, space: Space, model: Model, products: Products) -> None:
    """Add ``d(sum_k w_k . K u_k) / dx`` to (nodes, d), where K depends on the places x of the nodes.

    Parameters
    ----------
    found : added to, work per length
    space, model : the mesh and what is on it
    products : of displacements w and u
    """
    c, law = space.components, law_tensor(elasticities(model), hoop=model.axisymmetric, twist=model.twists)
    if model.twists:
        law = np.einsum("nrisj,ik,jl->nrksl", law, _REVOLVED, _REVOLVED)
    every = list(straining_groups(space, model))
    for body in range(len(model.bodies)):
        entries = np.argwhere(law[body])
        of_law = (entries, law[body][tuple(entries.T)])
        for group in of_bodies(every, np.arange(len(model.bodies)) == body):
            if group.formulation != "standard":
                np.add.at(found, group.cells, _by_differences(space, model, group, products))
                continue
            cells = cells_of(space, model, group)
            at_points = (cells.shape_values, np.ascontiguousarray(cells.shape_gradients))
            of_cells = (cells.nodes, cells.measure * cells.weights)
            _add(found, space.mesh.points, of_cells, at_points, of_law, products, (c, law.shape[2]))


def node_work(space: Space, model: Model, w: Array, u: Array) -> Array:
    """(nodes, d) ``d(sum_k w_k . K u_k) / dx``, of displacements w and u (dofs, k).

    Parameters
    ----------
    space, model : the mesh and what is on it
    w, u : displacements
    """
    found = np.zeros_like(space.mesh.points)
    add_node_work(found, space, model, Products.of(w, u))
    return found


def _by_differences(space: Space, model: Model, group: Group, products: Products) -> Array:
    """(m, k, d) Of the nodes of the cells of a group, each cell on nodes of its own."""
    block, d = group.block, space.dimension
    alone = replace(block, cells=np.arange(block.cells.size).reshape(block.cells.shape))
    apart = replace(group, block=alone)
    places = space.mesh.points[block.cells]
    size = np.ptp(places, axis=1).max(axis=1)
    sums = products_of_cells(np.ascontiguousarray(group.cells), space.components, products)
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


@kernel(fastmath={"contract"})
def _add(
    found: Array,
    points: Array,
    of_cells: tuple[IntArray, Array],
    block: tuple[Array, Array],
    law: tuple[IntArray, Array],
    products: Products,
    slopes: tuple[int, int],
) -> None:
    """Add what cells of the standard formulation and of one material have, see the module.

    Parameters
    ----------
    found : (nodes, d) added to
    points : (nodes, d)
    of_cells : (m, k) nodes, and (m, q) weights times thickness or circumference
    block : (q, k) shape functions and (q, k, d) their reference gradients
    law : (t, 4) numbers r, i, s, j and (t,) values of ``C_risj``
    products : of displacements
    slopes : numbers c of components of a displacement and e of slopes of each, around an axis ``w / r`` among them
    """
    cells, weights = of_cells
    values, gradients = block
    c, e = slopes
    nodes, d, columns = cells.shape[1], points.shape[1], products.w.shape[1]
    summed = len(products.data) > 0 or columns > nodes  # of few columns slopes are cheaper than products
    size, columns = (nodes * c, 0) if summed else (0, columns)
    place, M = no_places(products), np.empty((size, size))
    every, T = np.empty((size, size, _LANES)), np.empty((c, e, size, _LANES))
    w, u = np.empty((columns, nodes, c, _LANES)), np.empty((columns, nodes, c, _LANES))
    S, P, H = np.empty((2, c, e, _LANES)), np.empty((2, c, e, _LANES)), np.empty((c, e, c, e, _LANES))
    Q, volume, work = np.empty((e, e, _LANES)), np.empty(_LANES), np.empty(_LANES)
    x, force = np.empty((nodes, d, _LANES)), np.empty((nodes, d, _LANES))
    J, I, g = np.empty((3, 3, _LANES)), np.empty((3, 3, _LANES)), np.empty((nodes, e, _LANES))  # noqa: E741
    for first in range(0, len(cells), _LANES):
        for lane in range(_LANES):
            cell = cells[min(first + lane, len(cells) - 1)]  # behind the last one it stands again, for nothing
            for a in range(nodes):
                for m in range(d):
                    x[a, m, lane], force[a, m, lane] = points[cell[a], m], 0.0
                for r in range(c):
                    for k in range(columns):
                        w[k, a, r, lane] = products.w[cell[a] * c + r, k]
                        u[k, a, r, lane] = products.u[cell[a] * c + r, k]
            if summed:
                products_of_cell(cell, c, products, place, M)
                for i in range(size):
                    for j in range(size):
                        every[i, j, lane] = M[i, j]
        for q in range(len(gradients)):
            _gradients(x, values[q], gradients[q], J, I, g, volume)
            for lane in range(_LANES):
                volume[lane] *= weights[min(first + lane, len(cells) - 1), q]
            if summed:
                _of_products(every, g, law, T, H, Q)
            else:
                _of_columns(w, u, g, law, S, P, Q)
            _pull(Q, volume, g, work, force)
        for lane in range(min(_LANES, len(cells) - first)):
            for b in range(nodes):
                for m in range(d):
                    found[cells[first + lane, b], m] += force[b, m, lane]


@part(fastmath={"contract"})
def _gradients(x: Array, values: Array, reference: Array, J: Array, I: Array, g: Array, volume: Array) -> None:  # noqa: E741
    """Overwrite the gradients of the shape functions at one point of every cell, and ``|det J|``.

    Parameters
    ----------
    x : (k, d, lanes) nodes
    values, reference : (k,) shape functions, and (k, d) their reference gradients
    J, I : (3, 3, lanes) scratch for the Jacobian matrix, which in the plane the last axis is added to, and its inverse
    g, volume : (k, e, lanes) and (lanes,) overwritten
    """
    nodes, d = reference.shape
    for r in range(3):
        for s in range(3):
            for lane in range(_LANES):
                J[r, s, lane] = 1.0 if r == s and r >= d else 0.0
    for a in range(nodes):
        for r in range(d):
            for s in range(d):
                for lane in range(_LANES):
                    J[r, s, lane] += x[a, r, lane] * reference[a, s]
    volume[:] = 0.0
    for r in range(d):
        for s in range(d):
            r1, r2, s1, s2 = (r + 1) % 3, (r + 2) % 3, (s + 1) % 3, (s + 2) % 3
            for lane in range(_LANES):
                I[r, s, lane] = J[r1, s1, lane] * J[r2, s2, lane] - J[r1, s2, lane] * J[r2, s1, lane]
    for s in range(d):
        for lane in range(_LANES):
            volume[lane] += J[0, s, lane] * I[0, s, lane]
    for lane in range(_LANES):
        J[0, 0, lane], volume[lane] = 1.0 / volume[lane], abs(volume[lane])
    g[:] = 0.0
    for r in range(d):
        for s in range(d):
            for lane in range(_LANES):
                I[r, s, lane] *= J[0, 0, lane]
            for a in range(nodes):
                for lane in range(_LANES):
                    g[a, r, lane] += reference[a, s] * I[r, s, lane]
    if g.shape[1] > d:
        for lane in range(_LANES):
            J[0, 0, lane] = 0.0
        for a in range(nodes):
            for lane in range(_LANES):
                J[0, 0, lane] += values[a] * x[a, 0, lane]
        for a in range(nodes):
            for lane in range(_LANES):
                g[a, d, lane] = values[a] / J[0, 0, lane]


@part(fastmath={"contract"})
def _of_columns(w: Array, u: Array, g: Array, law: tuple[IntArray, Array], S: Array, P: Array, Q: Array) -> None:
    """Overwrite Q, (e, e, lanes), by the products of slopes of displacements with the stresses of the other one.

    Parameters
    ----------
    w, u : (columns, k, c, lanes) displacements of the nodes
    g : (k, e, lanes) gradients of shape functions
    law : see `_add`
    S, P : (2, c, e, lanes) scratch for the slopes of one column of both, and for the stresses of the other one
    Q : overwritten
    """
    entries, moduli = law
    c, e = S.shape[1:3]
    Q[:] = 0.0
    for k in range(len(w)):
        S[:] = 0.0
        P[:] = 0.0
        for a in range(len(g)):
            for r in range(c):
                for i in range(e):
                    for lane in range(_LANES):
                        S[0, r, i, lane] += g[a, i, lane] * w[k, a, r, lane]
                        S[1, r, i, lane] += g[a, i, lane] * u[k, a, r, lane]
        for n in range(len(entries)):
            r, i, s, j = entries[n, 0], entries[n, 1], entries[n, 2], entries[n, 3]
            for lane in range(_LANES):
                P[0, r, i, lane] += moduli[n] * S[1, s, j, lane]
                P[1, r, i, lane] += moduli[n] * S[0, s, j, lane]
        for r in range(c):
            for m in range(e):
                for i in range(e):
                    for lane in range(_LANES):
                        Q[m, i, lane] += S[0, r, m, lane] * P[0, r, i, lane] + S[1, r, m, lane] * P[1, r, i, lane]


@part(fastmath={"contract"})
def _of_products(M: Array, g: Array, law: tuple[IntArray, Array], T: Array, H: Array, Q: Array) -> None:
    """Overwrite Q as `_of_columns` does, from the sums of products of displacements.

    Parameters
    ----------
    M : (k c, k c, lanes) sums of products of displacements of the nodes
    g : (k, e, lanes) gradients of shape functions
    law : see `_add`
    T, H : (c, e, k c, lanes) and (c, e, c, e, lanes) scratch for products of slopes with displacements, and with slopes
    Q : overwritten
    """
    entries, moduli = law
    c, e = T.shape[:2]
    T[:] = 0.0
    H[:] = 0.0
    Q[:] = 0.0
    for r in range(c):
        for i in range(e):
            for a in range(len(g)):
                for column in range(T.shape[2]):
                    for lane in range(_LANES):
                        T[r, i, column, lane] += g[a, i, lane] * M[a * c + r, column, lane]
            for s in range(c):
                for j in range(e):
                    for b in range(len(g)):
                        for lane in range(_LANES):
                            H[r, i, s, j, lane] += g[b, j, lane] * T[r, i, b * c + s, lane]
    for n in range(len(entries)):
        r, i, s, j = entries[n, 0], entries[n, 1], entries[n, 2], entries[n, 3]
        for m in range(e):
            for lane in range(_LANES):
                Q[m, i, lane] += moduli[n] * H[r, m, s, j, lane]
                Q[m, j, lane] += moduli[n] * H[r, i, s, m, lane]


@part(fastmath={"contract"})
def _pull(Q: Array, volume: Array, g: Array, work: Array, force: Array) -> None:
    """Add to force, (k, d, lanes), what Eshelby's tensor, the work less Q, does at the nodes.

    Parameters
    ----------
    Q, volume : (e, e, lanes), and (lanes,) of the points
    g : (k, e, lanes) gradients of shape functions
    work : (lanes,) scratch
    force : added to
    """
    nodes, d = force.shape[:2]
    work[:] = 0.0
    for m in range(len(Q)):
        for lane in range(_LANES):
            work[lane] += 0.5 * Q[m, m, lane]
    for m in range(len(Q)):
        for lane in range(_LANES):
            Q[m, m, lane] -= work[lane]
        for i in range(len(Q)):
            for lane in range(_LANES):
                Q[m, i, lane] *= volume[lane]
    for b in range(nodes):
        for m in range(d):
            for i in range(d):
                for lane in range(_LANES):
                    force[b, m, lane] -= Q[m, i, lane] * g[b, i, lane]
        if len(Q) > d:
            for lane in range(_LANES):
                force[b, 0, lane] -= Q[d, d, lane] * g[b, d, lane]
