# SPDX-License-Identifier: BSD-3-Clause
"""The displacement space: one block of cells a family, all on one numbering of nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import skfem

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.model.mesh import Mesh

_ELEMENTS: Mapping[str, tuple[type[skfem.Element], int]] = {
    # family: scikit-fem element, polynomial degree that the quadrature integrates exactly
    "triangle": (skfem.ElementTriP1, 1),
    "quad": (skfem.ElementQuad1, 2),
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Cells of one family with shape functions at their quadrature points.

    Attributes
    ----------
    family : "triangle", "quad"
    cells : (m, k) nodes of each cell
    first : number of the first cell of the block among all cells
    values : (q, k) shape functions at the quadrature points of the reference cell
    gradients : (q, k, d) their reference gradients
    weights : (q,) quadrature weights
    corners : (k, k, d) reference gradients at the nodes of the reference cell
    """

    family: str
    cells: IntArray
    first: int
    values: Array
    gradients: Array
    weights: Array
    corners: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Space:
    """Displacements of a mesh; component i of node k is dof ``d k + i`` (scikit-fem's numbering).

    Examples
    --------
    >>> mesh = Mesh(points=[[0, 0], [2, 0], [2, 1], [0, 1]], cells={"quad": [[0, 1, 2, 3]]}, bodies={"block": [0]})
    >>> space = make_space(mesh)
    >>> space.number_of_dofs, [float(v.sum()) for v in space.volumes]
    (8, [2.0])
    """

    mesh: Mesh
    blocks: tuple[Block, ...]

    @property
    def dimension(self) -> int:
        """Of space."""
        return int(self.mesh.points.shape[1])

    @property
    def number_of_dofs(self) -> int:
        """Of all nodes, held and unused ones included."""
        return self.mesh.points.size

    @cached_property
    def used_nodes(self) -> IntArray:
        """Nodes of any cell, sorted (a Gmsh file may hold others)."""
        return np.unique(np.concatenate([block.cells.ravel() for block in self.blocks]))

    @cached_property
    def jacobians(self) -> tuple[Array, ...]:
        """``dx/dX`` at the quadrature points, (m, q, d, d) a block."""
        return tuple(self._jacobians(block, block.gradients) for block in self.blocks)

    @cached_property
    def volumes(self) -> tuple[Array, ...]:
        """Quadrature weights times ``|det dx/dX|``, (m, q) a block: area of each quadrature point."""
        return tuple(
            np.abs(np.linalg.det(jacobian)) * block.weights
            for jacobian, block in zip(self.jacobians, self.blocks, strict=True)
        )

    def _jacobians(self, block: Block, gradients: Array) -> Array:
        result: Array = np.einsum("mki,qkj->mqij", self.mesh.points[block.cells], gradients)
        return result

    def gradients(self, block: Block, at: Array) -> Array:
        """Shape function gradients in space, (m, q, k, d), where the reference gradients are ``at`` (q, k, d)."""
        result: Array = np.einsum("qkj,mqji->mqki", at, np.linalg.inv(self._jacobians(block, at)))
        return result

    def dofs(self, nodes: IntArray) -> IntArray:
        """Dofs of nodes, (..., d)."""
        return nodes[..., None] * self.dimension + np.arange(self.dimension)


def make_space(mesh: Mesh) -> Space:
    """The space of a mesh.

    Raises
    ------
    InputError
        For a cell without area or turned inside out, with its number.
    """
    blocks, first = [], 0
    for family, cells in mesh.cells.items():
        element_type, degree = _ELEMENTS[family]
        element = element_type()
        where, weights = skfem.quadrature.get_quadrature(element.refdom, degree)
        values, gradients = _shape(element, where, cells.shape[1])
        _, corners = _shape(element, element.doflocs.T, cells.shape[1])
        blocks.append(
            Block(
                family=family,
                cells=cells,
                first=first,
                values=values,
                gradients=gradients,
                weights=weights,
                corners=corners,
            )
        )
        first += len(cells)
    space = Space(mesh=mesh, blocks=tuple(blocks))
    _check_shapes(space)
    return space


def _shape(element: skfem.Element, where: Array, count: int) -> tuple[Array, Array]:
    found = [element.lbasis(where, i) for i in range(count)]
    values = np.stack([np.broadcast_to(value, where.shape[1:]) for value, _ in found], axis=1)
    gradients = np.stack([np.broadcast_to(gradient, where.shape).T for _, gradient in found], axis=1)
    return values, gradients


def _check_shapes(space: Space) -> None:
    for block in space.blocks:
        determinants = np.linalg.det(space._jacobians(block, block.corners))
        size = np.abs(determinants).max(axis=1)
        # clockwise cells are fine; a change of sign inside a cell, or no area, is not
        bad = (np.abs(determinants.sum(axis=1)) < 1e-12 * size) | (size == 0.0)
        bad |= (determinants * np.sign(determinants[:, :1])).min(axis=1) <= -1e-12 * size
        if bad.any():
            cell = int(np.nonzero(bad)[0][0])
            centre = tuple(float(x) for x in space.mesh.points[block.cells[cell]].mean(axis=0).round(6))
            raise InputError(
                f"cell {block.first + cell + 1} ({block.family}) near {centre} has no "
                "area or is turned inside out (its Jacobian changes sign); expected a convex cell",
                where=("mesh",),
            )
