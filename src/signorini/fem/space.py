# SPDX-License-Identifier: BSD-3-Clause
"""The displacement space: one block of cells a family, all on one numbering of nodes."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cache, cached_property

import numpy as np
import scipy.sparse as sp
import skfem

from signorini.arrays import Array, BoolArray, IntArray, among, elsewhere, frozen
from signorini.fem.cell_checks import refuse_far_nodes, refuse_negative_radii, refuse_shape
from signorini.fem.jacobian import cell_determinants
from signorini.fem.wedge import QuadraticWedge
from signorini.meshing.facets import HEXAHEDRON, CellFacets, check_conforming, make_facets
from signorini.model.kind import axes, revolves
from signorini.model.mesh import CORNERS, Mesh

ON_AXIS = 1e-10
"""Of the largest radius: nodes of axisymmetric bodies that are nearer are on the axis."""


@dataclass(frozen=True)
class _Element:
    """A scikit-fem element and the degrees of polynomials that its quadratures integrate exactly.

    plane, ring : for plane and for axisymmetric bodies: enough for the patch test on curved elements
    stress : points where stresses are best, extrapolated to the nodes by as many monomials
    pressures : monomials that the dilatation can be projected on so that no cell locks; none for cells that have none
    """

    kind: type[skfem.Element]
    plane: int
    ring: int
    stress: int
    monomials: tuple[tuple[int, ...], ...]
    pressures: tuple[tuple[int, ...], ...] = ()


_LINEAR = ((0, 0), (1, 0), (0, 1))
_BILINEAR = (*_LINEAR, (1, 1))
_SOLID = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
_TRILINEAR = (*_SOLID, (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 1, 1))
_ELEMENTS: Mapping[str, _Element] = {
    "triangle": _Element(skfem.ElementTriP1, 1, 2, 1, ((0, 0),)),
    "quad": _Element(skfem.ElementQuad1, 2, 2, 2, _BILINEAR, _LINEAR[:1]),
    "triangle6": _Element(skfem.ElementTriP2, 2, 4, 2, _LINEAR, _LINEAR[:1]),
    "quad8": _Element(skfem.ElementQuadS2, 5, 7, 2, _BILINEAR, _LINEAR),
    "quad9": _Element(skfem.ElementQuad2, 5, 7, 2, _BILINEAR, _LINEAR),
    "tetra": _Element(skfem.ElementTetP1, 1, 1, 1, _SOLID[:1]),
    "tetra10": _Element(skfem.ElementTetP2, 2, 2, 2, _SOLID, _SOLID[:1]),
    "hexahedron": _Element(skfem.ElementHex1, 2, 2, 2, _TRILINEAR, _SOLID[:1]),
    "hexahedron20": _Element(skfem.ElementHexS2, 5, 5, 2, _TRILINEAR, _SOLID),
    "hexahedron27": _Element(skfem.ElementHex2, 5, 5, 2, _TRILINEAR, _SOLID),
    "wedge": _Element(skfem.ElementWedge1, 3, 3, 2, _SOLID, _SOLID[:1]),
    "wedge15": _Element(QuadraticWedge, 5, 5, 2, (*_SOLID, (1, 0, 1), (0, 1, 1))),
}


@elsewhere("cells")
@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Cells of one family with shape functions at points of the reference cell.

    Attributes
    ----------
    family : as :class:`signorini.model.mesh.Mesh` calls it
    cells : (m, k) nodes of each cell
    first : number of the first cell of the block among all cells
    values : (q, k) shape functions at the quadrature points
    gradients : (q, k, d) their reference gradients
    weights : (q,) quadrature weights
    corners : (k, k, d) reference gradients at the nodes
    stress_values, stress_gradients : (p, k), (p, k, d) the same where stresses are best
    to_nodes : (k, p) from there to the nodes
    to_best : (p, q) from the quadrature points to where stresses are best, least squares by the same monomials
    pressures, stress_pressures : (q, n), (p, n) functions for a mean dilatation at either points; n = 0 without
    """

    family: str
    cells: IntArray
    first: int
    values: Array
    gradients: Array
    weights: Array
    corners: Array
    stress_values: Array
    stress_gradients: Array
    to_nodes: Array
    to_best: Array
    pressures: Array
    stress_pressures: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Space:
    """Displacements of a mesh; component i of c of node k is dof ``c k + i`` (scikit-fem's numbering).

    Examples
    --------
    >>> mesh = Mesh(points=[[0, 0], [2, 0], [2, 1], [0, 1]], cells={"quad": [[0, 1, 2, 3]]}, bodies={"block": [0]})
    >>> space = make_space(mesh)
    >>> space.number_of_dofs, [float(v.sum()) for v in space.volumes]
    (8, [2.0])

    Attributes
    ----------
    mesh, blocks : nodes and cells
    components : of the displacement of a node
    obstacles : how many rigid obstacles and rigid bodies have unknowns of their own, behind those of the nodes
    linked : (k,) nodes that equations name, which may belong to no cell
    displacement : (dofs,) by which the nodes of the mesh, and obstacles, have moved; empty where they have not
    """

    mesh: Mesh
    blocks: tuple[Block, ...]
    components: int
    obstacles: int = 0
    linked: IntArray = field(default_factory=lambda: np.empty(0, np.int64))
    displacement: Array = field(default_factory=lambda: np.zeros(0))

    def moved(self, displacement: Array) -> Space:
        """Cells whose nodes are where a displacement (dofs,) takes them; facets are not looked for again."""
        return self.at(self.mesh.points + self.at_nodes(displacement), displacement)

    def at(self, points: Array, displacement: Array) -> Space:
        """Cells whose nodes are at places (nodes, d), which displacements (dofs,) have brought them to, or none."""
        mesh = copy(self.mesh)  # nothing but the places is another, and nothing is to be checked again
        object.__setattr__(mesh, "points", frozen(points))
        vars(mesh).pop("extent", None)
        found = replace(self, mesh=mesh, displacement=displacement)
        found.__dict__["facets_at_boundaries"] = self.facets_at_boundaries
        if "facets" in self.__dict__:
            found.__dict__["facets"] = self.facets
        return found

    @property
    def undeformed(self) -> Array:
        """(nodes, d) Places of the nodes before anything moved them."""
        return self.mesh.points - self.at_nodes(self.displacement) if len(self.displacement) else self.mesh.points

    def spins(self, rows: sp.csr_array) -> sp.csr_array:
        """(k, 1 or 3) What rows (k, dofs) see of rotations of all nodes about the origin, by one radian each."""
        x = self.mesh.points
        if self.dimension == 2:
            turned = [np.stack([-x[:, 1], x[:, 0]], axis=1)]
        else:
            turned = [np.cross(axis, x) for axis in np.eye(3)]
        return sp.csr_array(rows[:, : self.dofs_of_nodes] @ np.stack([by.ravel() for by in turned], axis=1))

    @property
    def dimension(self) -> int:
        """Of the coordinates; displacements have one component more in bodies of revolution that twist."""
        return self.mesh.dimension

    @property
    def number_of_dofs(self) -> int:
        """Of all nodes, held and unused ones included, and of rigid obstacles."""
        return self.dofs_of_nodes + 2 * self.components * self.obstacles

    @property
    def dofs_of_nodes(self) -> int:
        """How many belong to nodes of the mesh; those of obstacles follow."""
        return self.mesh.number_of_nodes * self.components

    @property
    def places(self) -> Array:
        """(nodes + 2 obstacles, d) Points of the mesh; then, in its middle, the two nodes of every obstacle."""
        points = self.mesh.points
        return np.concatenate([points, np.tile(points.mean(axis=0), (2 * self.obstacles, 1))])

    def obstacle_dofs(self, j: int) -> IntArray:
        """Dofs of rigid obstacle j, (2 c,): its translation, then its rotation times a length; then of rigid bodies."""
        first = self.dofs_of_nodes + 2 * self.components * j
        return np.arange(first, first + 2 * self.components)

    @cached_property
    def used_nodes(self) -> IntArray:
        """Nodes of any cell, sorted (a Gmsh file may hold others)."""
        return np.flatnonzero(self.used)

    @cached_property
    def used(self) -> BoolArray:
        """(nodes,) Whether a node is one of any cell."""
        return among([block.cells for block in self.blocks], self.mesh.number_of_nodes)

    @cached_property
    def loose_nodes(self) -> IntArray:
        """Nodes of no cell that equations name, sorted."""
        return np.unique(self.linked[~self.used[self.linked]])

    @cached_property
    def node_of(self) -> Mapping[int, int]:
        """Node by its number."""
        return {number: node for node, number in enumerate(self.mesh.labels.tolist())}

    @cached_property
    def facets(self) -> dict[int, CellFacets]:
        """Of all cells, by the number of their nodes."""
        return make_facets(self.mesh)

    @cached_property
    def facets_at_boundaries(self) -> dict[int, CellFacets]:
        """Of the cells that have nodes of named boundaries, which are few, by the number of their nodes."""
        mesh = self.mesh
        named = itertools.chain.from_iterable(mesh.facets(name) for name in mesh.boundaries)
        return make_facets(mesh, among(named, mesh.number_of_nodes))

    def forget(self, *names: str) -> None:
        """Let go of what is made anew where somebody asks: as large as the mesh, and of use before it is solved.

        Parameters
        ----------
        names : of properties
        """
        for name in names:
            self.__dict__.pop(name, None)

    @cached_property
    def volumes(self) -> tuple[Array, ...]:
        """Quadrature weights times ``|det dx/dX|``, (m, q) a block: area of each quadrature point."""
        return tuple(self._volumes_in(block) for block in self.blocks)

    def _volumes_in(self, block: Block) -> Array:
        return np.abs(cell_determinants(self.mesh.points, block.cells, block.gradients)) * block.weights

    @cached_property
    def volume(self) -> float:
        """Of all cells; those of points of a large mesh are not kept for it."""
        known = self.__dict__.get("volumes") or map(self._volumes_in, self.blocks)
        return sum(float(volumes.sum()) for volumes in known)

    def volumes_of(self, block: Block) -> Array:
        """Area of each quadrature point of a block, (m, q)."""
        return next(v for b, v in zip(self.blocks, self.volumes, strict=True) if b is block)

    def at_nodes(self, values: Array) -> Array:
        """Values of all dofs (dofs,) at the nodes, (nodes, c), without those of obstacles."""
        return values[: self.dofs_of_nodes].reshape(-1, self.components)

    @property
    def arms(self) -> Array:
        """(dofs,) What forces are multiplied by in resultants: 1, with twist along the hoop the radius: a torque."""
        return self.arms_at(np.arange(self.number_of_dofs))

    def arms_at(self, dofs: IntArray) -> Array:
        """(k,) Those of some dofs (k,)."""
        arms = np.ones(len(dofs))
        if self.components > self.dimension:
            hoop = (dofs % self.components == 2) & (dofs < self.dofs_of_nodes)
            arms[hoop] = self.mesh.places_of(dofs[hoop] // self.components)[:, 0]
        return arms

    def farthest(self, displacement: Array) -> float:
        """The longest way of a node of the mesh, of displacements (dofs,), in whatever direction, length."""
        return float(np.linalg.norm(self.at_nodes(displacement), axis=1).max())

    def dofs(self, nodes: IntArray) -> IntArray:
        """Dofs of nodes, (..., c)."""
        return nodes[..., None] * self.components + np.arange(self.components)


def make_space(mesh: Mesh, *, kind: str = "", obstacles: int = 0, linked: IntArray | None = None) -> Space:
    """The space of a mesh.

    Parameters
    ----------
    kind : of the model; where coordinates are radius and height quadratures are higher; by default plane or in space
    obstacles : rigid ones, and rigid bodies, with unknowns of their own
    linked : nodes that equations name

    Raises
    ------
    InputError
        For a cell without area or turned inside out, with its number; for linear cells that meet quadratic ones along
        an edge; for a negative radius.
    """
    ring = revolves(kind)
    if ring:
        refuse_negative_radii(mesh, ON_AXIS)
    blocks, first = [], 0
    for family, cells in mesh.cells.items():
        blocks.append(Block(family=family, cells=cells, first=first, **_reference(family, ring)))
        first += len(cells)
    linked = np.empty(0, np.int64) if linked is None else linked
    components = len(axes(kind)) if kind else mesh.points.shape[1]
    space = Space(mesh=mesh, blocks=tuple(blocks), components=components, obstacles=obstacles, linked=linked)
    if space.dimension == 2 and any(nodes.shape[1] > CORNERS[family] for family, nodes in mesh.cells.items()):
        check_conforming(mesh, space.facets)
    refuse_far_nodes(mesh, space.used_nodes)
    for block in blocks:
        refuse_shape(mesh, block.family, block.first, block.gradients, block.corners)
    return space


@cache
def _reference(family: str, ring: bool) -> dict[str, Array]:
    """What all cells of a family share, by name of a block: found once, which small models would wait for."""
    what = _ELEMENTS[family]
    element = what.kind()
    where, weights = _rule(element, what.ring if ring else what.plane)
    best, _ = _rule(element, what.stress)
    order = _meshio_order(family, element)
    nodes = element.doflocs[order].T
    values, gradients = _shape(element, where, order)
    stress_values, stress_gradients = _shape(element, best, order)
    return {
        "values": values,
        "gradients": gradients,
        "weights": weights,
        "corners": _shape(element, nodes, order)[1],
        "stress_values": stress_values,
        "stress_gradients": stress_gradients,
        "to_nodes": _monomials(nodes, what.monomials) @ np.linalg.pinv(_monomials(best, what.monomials)),
        "to_best": _monomials(best, what.monomials) @ np.linalg.pinv(_monomials(where, what.monomials)),
        "pressures": _monomials(where, what.pressures),
        "stress_pressures": _monomials(best, what.pressures),
    }


def _rule(element: skfem.Element, degree: int) -> tuple[Array, Array]:
    """Quadrature points (d, q) and weights (q,); scikit-fem's weights of a wedge add up to half its volume."""
    if element.refdom is not skfem.refdom.RefWedge:
        points, weights = skfem.quadrature.get_quadrature(element.refdom, degree)
        return points, weights
    (face, share), (height, part) = (
        skfem.quadrature.get_quadrature(shape, degree) for shape in (skfem.refdom.RefTri, skfem.refdom.RefLine)
    )
    points = np.vstack([np.repeat(face, len(part), axis=1), np.tile(height, len(share))])
    return points, np.outer(share, part).ravel()


def shape_functions(family: str, at: Array) -> tuple[Array, Array]:
    """Shape functions (n, k) of a family and their gradients (n, k, d) at reference coordinates (d, n)."""
    element = _ELEMENTS[family].kind()
    return _shape(element, at, _meshio_order(family, element))


def shapes_in_cells(family: str, degree: int) -> tuple[Array, Array, Array]:
    """Shape functions (q, k) of a family, their gradients (q, k, d) and weights (q,) of a quadrature.

    Parameters
    ----------
    family : of the cells
    degree : of the polynomials that the quadrature integrates exactly
    """
    at, weights = _rule(_ELEMENTS[family].kind(), degree)
    return *shape_functions(family, at), weights


def _monomials(at: Array, of: tuple[tuple[int, ...], ...]) -> Array:
    """(points, monomials) at reference coordinates (d, points)."""
    powers = [np.prod([x**i for x, i in zip(at, each, strict=True)], axis=0) for each in of]
    return np.stack(powers, axis=1) if powers else np.empty((at.shape[1], 0))


def has_mean_dilatation(family: str) -> bool:
    """Whether cells of a family may have one; triangles and tetrahedra with corners alone would lock all the same."""
    return bool(_ELEMENTS[family].pressures)


def _meshio_order(family: str, element: skfem.Element) -> IntArray:
    """For every node in the order of meshio its number in scikit-fem, (k,)."""
    count = len(element.doflocs)
    if not family.startswith("hexahedron"):
        return np.arange(count)
    wanted = np.array(HEXAHEDRON[:count]) / 2.0
    return np.argmin(np.abs(wanted[:, None] - element.doflocs).sum(axis=2), axis=1)


def _shape(element: skfem.Element, where: Array, order: IntArray) -> tuple[Array, Array]:
    found = [element.lbasis(where, i) for i in order]
    values = np.stack([np.broadcast_to(value, where.shape[1:]) for value, _ in found], axis=1)
    gradients = np.stack([np.broadcast_to(gradient, where.shape).T for _, gradient in found], axis=1)
    return values, gradients
