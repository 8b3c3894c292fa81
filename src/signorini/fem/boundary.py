# SPDX-License-Identifier: BSD-3-Clause
"""Facets of named boundaries, flat or curved: which way is out, how large they are, and integrals over them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.faces import CORNERS, outer_faces
from signorini.fem.facets import facet_nodes, facet_rule, facet_shapes
from signorini.fem.space import Space


@dataclass(frozen=True, kw_only=True, eq=False)
class Boundary:
    """Facets of a boundary: edges in the plane, faces in space.

    Attributes
    ----------
    facets : (m, k) nodes. In the plane first and second end, the body on the left of the way between them, and the
        middle; in space corners, anticlockwise seen from outside, then middles
    points : (m, k, d) their coordinates, length
    nodes : (n,) sorted nodes
    cells : (m,) numbers of the cells that they bound
    """

    facets: IntArray
    points: Array
    nodes: IntArray
    cells: IntArray

    @property
    def dimension(self) -> int:
        """Of space."""
        return int(self.points.shape[2])

    @property
    def corners(self) -> int:
        """Corners of a facet; its other nodes are in the middle of an edge, or of the facet."""
        return 2 if self.dimension == 2 else CORNERS[self.facets.shape[1]]

    @property
    def quadratic(self) -> bool:
        """Whether the facets have nodes in the middle."""
        return self.facets.shape[1] > self.corners

    @property
    def ends(self) -> IntArray:
        """Sorted nodes at corners of facets; the others are in the middle of one."""
        return np.unique(self.facets[:, : self.corners])

    @cached_property
    def shapes(self) -> tuple[Array, Array]:
        """Shape functions of a facet at its quadrature points (q, k), and their derivatives (q, k, d - 1)."""
        return facet_shapes(self.dimension, self.facets.shape[1], self._rule[0])

    @cached_property
    def at(self) -> Array:
        """Quadrature points of every facet, (m, q, d)."""
        return np.einsum("qa,mai->mqi", self.shapes[0], self.points)

    @cached_property
    def outward(self) -> Array:
        """Outward normal at every quadrature point times its share of the length or area, (m, q, d)."""
        return _outward(self.points, self.shapes[1]) * self._rule[1][:, None]

    @cached_property
    def weights(self) -> Array:
        """Length or area that belongs to every quadrature point, (m, q)."""
        return np.linalg.norm(self.outward, axis=-1)

    @property
    def lengths(self) -> Array:
        """Of every facet, (m,); in space the side of a square of its area."""
        total: Array = self.weights.sum(axis=1)
        return total if self.dimension == 2 else np.sqrt(total)

    @cached_property
    def normals(self) -> Array:
        """Outward unit normal of every facet, of a curved one the mean, (m, d)."""
        total = self.outward.sum(axis=1)
        normals: Array = total / np.linalg.norm(total, axis=1, keepdims=True) + 0.0
        return normals

    def nodal(self, integrand: Array) -> Array:
        """``int N_k f`` at every node, (k, ...) in the order of ``nodes``.

        Parameters
        ----------
        integrand : (m, q, ...) f at the quadrature points times what belongs to them, ``weights`` in the plane
        """
        shares = np.einsum("qa,mq...->ma...", self.shapes[0], integrand)
        result = np.zeros((len(self.nodes), *integrand.shape[2:]))
        np.add.at(result, np.searchsorted(self.nodes, self.facets), shares)
        return result

    @property
    def nodal_lengths(self) -> Array:
        """Tributary length of every node, (n,); in space the side of a square of its area."""
        total = self.nodal(self.weights)
        return total if self.dimension == 2 else np.sqrt(np.maximum(total, 0.0))

    @cached_property
    def nodal_normals(self) -> Array:
        """Outward unit normals at the nodes, averaged with the sizes of their facets, (n, d)."""
        count = self.facets.shape[1]
        own = _outward(self.points, facet_shapes(self.dimension, count, facet_nodes(self.dimension, count))[1])
        own *= (self.weights.sum(axis=1)[:, None] / np.linalg.norm(own, axis=-1))[..., None]
        total = np.zeros((len(self.nodes), self.dimension))
        np.add.at(total, np.searchsorted(self.nodes, self.facets), own)
        normals: Array = total / np.linalg.norm(total, axis=1, keepdims=True)
        return normals

    @property
    def places(self) -> Array:
        """Reference coordinates of the quadrature points, (q, d - 1)."""
        return self._rule[0]

    @property
    def _rule(self) -> tuple[Array, Array]:
        return facet_rule(self.dimension, self.facets.shape[1])


def _outward(points: Array, slopes: Array) -> Array:
    """Outward normals of facets (m, k, d) from the derivatives (q, k, d - 1) of their shape functions, (m, q, d)."""
    along = np.einsum("qas,mai->mqsi", slopes, points)
    if points.shape[-1] == 2:
        return np.stack([along[..., 0, 1], -along[..., 0, 0]], axis=-1)
    return np.cross(along[..., 0, :], along[..., 1, :])


def boundary(space: Space, name: str, where: Where) -> Boundary:
    """A named boundary of the mesh with its outward normals.

    Raises
    ------
    InputError
        If a facet is no edge or face of a cell, or lies between two cells (shared by two bodies, or inside one); if it
        belongs to both linear and quadratic cells, or names another middle node than the cell.

    Examples
    --------
    >>> from signorini.fem.generators import rectangle
    >>> from signorini.fem.space import make_space
    >>> boundary(make_space(rectangle(width=2, height=1, nx=2, ny=1)), "top", ("load", 0)).normals
    array([[0., 1.],
           [0., 1.]])
    """
    given = space.mesh.boundaries[name]
    points = space.mesh.points
    if not len(given):
        raise InputError(f"'{name}' is empty; expected a boundary with edges or faces", where=where)
    if space.dimension == 3:
        facets, cells = outer_faces(space.faces, given, len(points), name, where)
        return Boundary(facets=facets, points=points[facets], nodes=np.unique(facets), cells=cells)
    empty = (points[given[:, 0]] == points[given[:, 1]]).all(axis=1)
    if empty.any():
        raise InputError(
            f"'{name}' has an edge without length at node {space.mesh.labels[given[empty][0, 0]]}", where=where
        )
    edge = _edges(space, given[:, :2], name, where)
    ends, middle = space.edges.ends[edge], space.edges.middle[edge]
    if given.shape[1] == 3 and (given[:, 2] != middle).any():
        wrong = int(np.nonzero(given[:, 2] != middle)[0][0])
        a, b, c = space.mesh.labels[given[wrong]]
        found = f"node {space.mesh.labels[middle[wrong]]}" if middle[wrong] >= 0 else "no node"
        raise InputError(
            f"'{name}' has node {c} between nodes {a} and {b}, where the cell has {found}",
            where=where,
        )
    quadratic = middle >= 0
    if quadratic.any() and not quadratic.all():
        raise InputError(f"'{name}' belongs to linear and to quadratic cells; expected one order", where=where)
    facets = np.column_stack([ends, middle]) if quadratic.any() else ends
    return Boundary(facets=facets, points=points[facets], nodes=np.unique(facets), cells=space.edges.cell[edge])


def _edges(space: Space, facets: IntArray, name: str, where: Where) -> IntArray:
    """Indices of the edges that the facets are, (m,)."""
    wanted = space.edges.key_of(facets)
    left = np.searchsorted(space.edges.key, wanted, side="left")
    found = np.searchsorted(space.edges.key, wanted, side="right") - left
    if (found == 0).any():
        a, b = space.mesh.labels[facets[np.nonzero(found == 0)[0][0]]]
        raise InputError(f"'{name}' has an edge between nodes {a} and {b} that no cell has", where=where)
    if (found > 1).any():
        a, b = space.mesh.labels[facets[np.nonzero(found > 1)[0][0]]]
        raise InputError(
            f"'{name}' lies inside: the edge between nodes {a} and {b} belongs to two cells. Expected an outer "
            "boundary; bodies that touch need nodes of their own on the interface",
            where=where,
        )
    if len(np.unique(wanted)) != len(wanted):
        raise InputError(f"'{name}' has an edge twice", where=where)
    return left
