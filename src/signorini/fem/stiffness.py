# SPDX-License-Identifier: BSD-3-Clause
"""The elastic stiffness of a model."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.crew import by_ranges
from signorini.fem import _kernels
from signorini.fem.assembly import Cells
from signorini.fem.assembly import stiffness as assemble
from signorini.fem.elasticity import elasticities, law_tensor
from signorini.fem.kinematics import Group, mode_gradients, of_each, straining_groups
from signorini.fem.measure import measure_of_cells
from signorini.fem.space import Space
from signorini.model.model import Model
from signorini.sparse_rows import rows_of, selection

SHARED_ENTRIES = 1_000_000
"""Entries of a stiffness of which threads share what is kept under supports: ten milliseconds of one thread."""

_PRODUCT_TOL = 64.0 * float(np.finfo(np.float64).eps)  # of the products that an entry is summed from: what is rounding


def stiffness(space: Space, model: Model, groups: Iterable[Group] | None = None) -> sp.csr_array:
    """``K_ij = int eps(phi_i) : C : eps(phi_j) dx``, (dofs, dofs).

    ``dx`` holds the thickness; of axisymmetric bodies ``2 pi r dr dz``, and their strain has the hoop part ``u_r / r``,
    with twist the shear strains ``d_r u_t - u_t / r`` and ``d_z u_t``.
    Cells of rigid bodies have none.
    With a mean dilatation the volume strain is projected on few functions in every cell (Simo, Taylor, Pister 1985).

    Parameters
    ----------
    space, model : the mesh and what is on it
    groups : the cells; None: all that strain
    """
    chosen = straining_groups(space, model) if groups is None else groups
    return _assembled(space, model, chosen, elasticities(model), _bulk_moduli(model))


def stiffness_change(space: Space, before: Model, after: Model, groups: Iterable[Group]) -> sp.csr_array:
    """(dofs, dofs) What other materials add to the stiffness of cells; at once where that is linear in their laws.

    Parameters
    ----------
    space : the mesh
    before, after : models that differ in materials alone
    groups : the cells
    """
    every = list(groups)
    laws, moduli = ((of(after) - of(before)) for of in (elasticities, _bulk_moduli))
    linear = [group for group in every if group.formulation != "incompatible"]
    found = _assembled(space, before, linear, laws, moduli)
    others = [group for group in every if group.formulation == "incompatible"]
    if others:  # internal modes are eliminated
        found = sp.csr_array(found + stiffness(space, after, others) - stiffness(space, before, others))
    return found


def _bulk_moduli(model: Model) -> Array:
    """(bodies,) Force per area."""
    return np.array([body.material.bulk_modulus for body in model.bodies])


def _assembled(space: Space, model: Model, groups: Iterable[Group], D: Array, bulk: Array) -> sp.csr_array:
    """(dofs, dofs) Of groups of cells under laws of the bodies, (b, 4, 4) or (b, 6, 6), with bulk moduli (b,)."""
    law = law_tensor(D, hoop=model.axisymmetric, twist=model.twists)
    every = list(groups)
    blocks = of_each(every, partial(cells_of, space, model))
    K = assemble(space.mesh.points, blocks, law, bulk=bulk, axisymmetric=model.axisymmetric)
    K.resize((space.number_of_dofs, space.number_of_dofs))  # rigid obstacles have no stiffness
    return K


def cells_of(space: Space, model: Model, group: Group) -> Cells:
    """What is integrated over a group of cells.

    Parameters
    ----------
    space, model : the mesh and what is on it
    group : cells of one kind and formulation
    """
    block = group.block

    def places() -> Array:
        at: Array = np.einsum("qk,mki->mqi", block.values, space.mesh.points[group.cells])
        return at

    cells = Cells(
        nodes=group.cells,
        shape_gradients=block.gradients,
        weights=block.weights,
        material=group.body,
        measure=measure_of_cells(model, places, group.numbers),
        shape_values=block.values,
    )
    if group.formulation == "incompatible":
        return cells._replace(modes=mode_gradients(space, model, group))
    return cells._replace(pressures=block.pressures) if group.formulation == "mean dilatation" else cells


def reduced_stiffness(K: sp.csr_array, T: sp.csr_array) -> sp.csr_array:
    """``T^T K T``, (z, z), without what is left by rounding where dofs that move together move rigidly.

    Equations may make a body rigid as a rigid body is; its stiffness cancels then, and rounding must be no spring.

    Examples
    --------
    Two nodes on a spring that move together feel nothing of it:

    >>> K, T = sp.csr_array(np.array([[0.3, -0.3], [-0.3, 0.1 + 0.2]])), sp.csr_array(np.ones((2, 1)))
    >>> (T.T @ K @ T).toarray().tolist(), reduced_stiffness(K, T).toarray().tolist()
    ([[5.551115123125783e-17]], [[0.0]])
    """
    number = np.diff(T.indptr)
    if np.array_equal(T.indices, np.arange(T.shape[1])) and number.max(initial=0) < 2 and (T.data == 1.0).all():
        return _of_free(K, number > 0)  # supports hold dofs, and no sums are to be formed
    reduced = sp.csr_array(T.T @ K @ T)
    together = np.flatnonzero(np.bincount(T.indices, minlength=T.shape[1]) > 1)
    if not len(together):
        return reduced
    size = abs(T[:, together]).T @ abs(K) @ abs(T)
    rows = reduced[together]
    noise = sp.csr_array(rows - rows.multiply(abs(rows) > _PRODUCT_TOL * size))
    put = selection(together, T.shape[1]).T
    spread = put @ noise
    result = sp.csr_array(reduced - spread - spread.T + put @ (noise[:, together] @ put.T))
    result.eliminate_zeros()
    return result


def _of_free(K: sp.csr_array, free: BoolArray) -> sp.csr_array:
    """Rows and columns of K of dofs that are free."""
    number = np.cumsum(free, dtype=np.int32) - np.int32(1)
    number[~free] = -1
    z = int(free.sum())
    every = _kernels.MatrixRows(K.indptr.astype(np.int32, copy=False), K.indices.astype(np.int32, copy=False), K.data)

    def fill(kept: _kernels.MatrixRows) -> None:
        by_ranges(partial(_kernels.keep_rows, every, number, kept), len(free), worth=K.nnz > SHARED_ENTRIES)

    ends = np.zeros(z + 1, dtype=np.int32)
    fill(_kernels.MatrixRows(ends, np.empty(0, dtype=np.int32), np.empty(0)))
    np.cumsum(ends, out=ends)
    found = _kernels.MatrixRows(ends, np.empty(ends[-1], dtype=np.int32), np.empty(ends[-1]))
    fill(found)
    return rows_of(found.data, found.indices, found.indptr, (z, z))
