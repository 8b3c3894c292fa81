# SPDX-License-Identifier: BSD-3-Clause
"""Strains of the cells, their internal modes included, and the forces that stresses make of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, among
from signorini.crew import shared
from signorini.fem.elasticity import STRAIN_PARTS
from signorini.fem.jacobian import determinants, gradients_in_space, jacobians
from signorini.fem.links import rigid_nodes
from signorini.fem.measure import measure
from signorini.fem.space import Block, Space
from signorini.meshing.facets import HEXAHEDRON
from signorini.model.model import Model

T = TypeVar("T")

CELLS_AT_ONCE = 1 << 13
"""Cells of a group at most: what is computed at all their points stays in the cache, and threads share the groups."""

BRICKS = {"quad": np.array(HEXAHEDRON[:4])[:, :2] - 1.0, "hexahedron": np.array(HEXAHEDRON[:8]) - 1.0}
"""Families that have the incompatible formulation, with one internal mode along every reference axis; their corners."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Group:
    """Cells of one family and one formulation.

    Attributes
    ----------
    block : their family
    index : (m,) which of its cells
    body : (m,) index of the body of each
    formulation : "standard", "incompatible" with internal modes, or "mean dilatation"
    """

    block: Block
    index: IntArray
    body: IntArray
    formulation: str

    @property
    def cells(self) -> IntArray:
        """(m, k) nodes."""
        return self.block.cells[self.index]

    @property
    def numbers(self) -> IntArray:
        """(m,) of the cells among all."""
        return self.block.first + self.index


@dataclass(frozen=True, kw_only=True, eq=False)
class Kinematics:
    """Gradients of shape functions and internal modes at points of the cells of a group.

    Attributes
    ----------
    gradients : (m, q, k + modes, e) in space; of bodies of revolution the third one is the shape function over the
        radius, with twist the fourth the first less the third
    values : (q, k) shape functions of the nodes
    weights : (m, q) volume of each point
    nodes : k
    """

    gradients: Array
    values: Array
    weights: Array
    nodes: int

    def strain(self, u: Array) -> Array:
        """Strains xx, yy, zz, xy (twice the tensor's) of displacements (m, k or k + modes, 2), (m, q, 4).

        In space of displacements (m, k or k + modes, 3), with yz and xz, (m, q, 6).
        """
        g = self.gradients[:, :, : u.shape[1]]
        strain = np.zeros((*g.shape[:2], 4 if u.shape[2] == 2 else 6))
        for (i, j), part in np.ndenumerate(STRAIN_PARTS[u.shape[2], g.shape[-1]]):
            if part >= 0:  # one slope at a time: a fifth of the time of all at once
                strain[..., part] += np.einsum("mqa,ma->mq", g[..., j], u[..., i])
        return strain

    def forces(self, stress: Array) -> Array:
        """``int B^T sigma`` on nodes and modes, (m, k + modes, d), of stresses (m, q, 4 or 6)."""
        at = STRAIN_PARTS[3 if stress.shape[2] == 6 else 2, self.gradients.shape[-1]]
        tensor = np.where(at >= 0, stress[..., at], 0.0) * self.weights[..., None, None]
        return np.einsum("mqaj,mqij->mai", self.gradients, tensor)

    def relaxed(self, D: Array, stress: Array) -> Array:
        """Stresses (m, q, 4 or 6) with the internal modes in balance.

        Parameters
        ----------
        D : (m, 4, 4) or (m, 6, 6) law of each cell
        stress : (m, q, 4 or 6) before the modes give way
        """
        modes = self.gradients.shape[2] - self.nodes
        if not modes:
            return stress
        d = 2 if D.shape[1] == 4 else 3
        unit = np.zeros((d * modes, len(D), self.nodes + modes, d))
        for i in range(d * modes):
            unit[i, :, self.nodes + i // d, i % d] = 1.0
        strains = np.stack([self.strain(u) for u in unit], axis=-1)
        stresses = np.einsum("mcd,mqdi->mqci", D, strains)
        K = np.einsum("mq,mqci,mqcj->mij", self.weights, strains, stresses)
        out_of_balance = self.forces(stress)[:, self.nodes :].reshape(len(D), -1)
        amplitude = -np.linalg.solve(K, out_of_balance[..., None])[..., 0]
        relaxed: Array = stress + np.einsum("mqci,mi->mqc", stresses, amplitude)
        return relaxed


def mean_in_cells(weights: Array, functions: Array, values: Array, there: Array) -> Array:
    """Values (m, q) projected on a few functions in every cell, at other points, (m, r).

    Parameters
    ----------
    weights : (m, q) volumes of the points
    functions, there : (q, n) and (r, n) at both points
    values : at the quadrature points
    """
    mass = np.einsum("mq,qa,qb->mab", weights, functions, functions)
    share = np.einsum("mq,qa,mq->ma", weights, functions, values)
    mean: Array = np.linalg.solve(mass, share[..., None])[..., 0] @ there.T
    return mean


def groups(space: Space, model: Model) -> Iterator[Group]:
    """All cells, by family and formulation, so many at once that arrays over their points stay small."""
    owner = model.body_of_cells()
    for block in space.blocks:
        body = owner[block.first : block.first + len(block.cells)]
        own = np.array([body.formulation_in(block.family) for body in model.bodies])
        for formulation in np.unique(own):
            every = np.flatnonzero((own == formulation)[body])
            for index in np.split(every, range(CELLS_AT_ONCE, len(every), CELLS_AT_ONCE)):
                if len(index):
                    yield Group(block=block, index=index, body=body[index], formulation=str(formulation))


def straining_groups(space: Space, model: Model) -> Iterator[Group]:
    """All cells but those of rigid bodies, which nothing strains: rounding would make springs of them."""
    rigid = np.zeros(sum(len(block.cells) for block in space.blocks), dtype=np.bool_)
    for j in range(len(model.rigid_bodies)):
        own = among([rigid_nodes(space, model, j)], len(space.mesh.points))
        for block in space.blocks:
            rigid[block.first : block.first + len(block.cells)] |= own[block.cells].all(axis=1)
    for group in groups(space, model):
        strains = ~rigid[group.numbers]
        if strains.any():
            yield replace(group, index=group.index[strains], body=group.body[strains])


def of_bodies(groups: Iterable[Group], bodies: BoolArray) -> Iterator[Group]:
    """Of groups of cells those of some bodies (b,)."""
    for group in groups:
        own = bodies[group.body]
        if own.all():
            yield group
        elif own.any():
            yield replace(group, index=group.index[own], body=group.body[own])


def large(every: Iterable[Group]) -> bool:
    """Whether groups have so many cells together that threads are to share them."""
    return sum(len(group.index) for group in every) > CELLS_AT_ONCE


def of_each(every: Sequence[Group], call: Callable[[Group], T]) -> list[T]:
    """What a function gives of every group; of many cells, threads share the groups."""
    return shared([partial(call, group) for group in every], worth=large(every))


def kinematics(space: Space, model: Model, group: Group, *, best: bool = False) -> Kinematics:
    """Gradients at the quadrature points of a group, or at the points where its stresses are best.

    The two are the same for linear quadrilaterals, which alone have internal modes.

    Parameters
    ----------
    space : of the model
    model : tells its kind
    """
    block, points = group.block, space.mesh.points[group.cells]
    values, reference = (block.stress_values, block.stress_gradients) if best else (block.values, block.gradients)
    bent = jacobians(points, reference)
    gradients = gradients_in_space(bent, reference)
    at = values @ points
    if model.axisymmetric:
        gradients = _revolved(gradients, values / at[..., :1], twists=model.twists)
    weights = np.abs(determinants(bent)) * measure(model, at, group.numbers)
    weights = weights * (1.0 / len(values) if best else block.weights)
    if group.formulation == "incompatible":
        gradients = np.concatenate([gradients, mode_gradients(space, model, group)], axis=2)
    return Kinematics(gradients=gradients, values=values, weights=weights, nodes=group.cells.shape[1])


def mode_gradients(space: Space, model: Model, group: Group) -> Array:
    """Gradients of the modes ``1 - xi^2``, ``1 - eta^2`` of quadrilaterals at their quadrature points, (m, q, d, e).

    ``J_0^-T grad P det J_0 / det J`` with the Jacobian of the centre, less the mean over the cell: a constant stress
    does no work on the modes, so the patch test is passed. They have no hoop strain. Hexahedra have three.

    Parameters
    ----------
    space, model : of the cells
    group : cells of one kind and formulation

    References
    ----------
    Taylor, Beresford, Wilson (1976), Int. J. Numer. Methods Eng. 10, 1211; the mean: Ibrahimbegovic, Wilson (1991),
    Commun. Appl. Numer. Methods 7, 187.
    """
    block, points = group.block, space.mesh.points[group.cells]
    bent = jacobians(points, block.gradients)
    centre, volume = bent.mean(axis=1), determinants(bent)
    xi = block.values @ BRICKS[block.family]
    slopes = -2.0 * xi[:, :, None] * np.eye(xi.shape[1])
    ratio = determinants(centre)[:, None] / volume
    modes = np.einsum("mq,qpj,mji->mqpi", ratio, slopes, np.linalg.inv(centre))
    at = block.values @ points
    weights = np.abs(volume) * measure(model, at, group.numbers)
    modes -= np.einsum("mq,mqpi->mpi", weights, modes)[:, None] / weights.sum(axis=1)[:, None, None, None]
    if model.axisymmetric:
        modes = _revolved(modes, np.zeros(modes.shape[:3]), twists=model.twists)
    return modes


def _revolved(gradients: Array, over_radius: Array, *, twists: bool) -> Array:
    """Gradients (m, q, k, 2) with functions over the radius (m, q, k) as a third, and ``d_r N - N / r`` as a fourth."""
    parts = [gradients, over_radius[..., None]]
    if twists:
        parts.append((gradients[..., 0] - over_radius)[..., None])
    return np.concatenate(parts, axis=-1)
