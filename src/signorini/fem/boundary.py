# SPDX-License-Identifier: BSD-3-Clause
"""Facets of named boundaries, of one kind or, in space, several: normals, sizes and integrals at their nodes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.facet_block import FacetBlock
from signorini.fem.space import Space
from signorini.meshing.faces import outer_faces


@dataclass(frozen=True, kw_only=True, eq=False)
class Boundary:
    """Facets of a boundary: edges in the plane, faces in space.

    Attributes
    ----------
    points : (p, d) of all nodes of the mesh, length
    blocks : facets by the number of their nodes, ascending; all linear or all quadratic; in the plane one block
    """

    points: Array
    blocks: tuple[FacetBlock, ...]

    @classmethod
    def of(cls, points: ArrayLike, *facets: ArrayLike) -> Boundary:
        """Facets of no cells, as they are.

        Parameters
        ----------
        points : (p, d) of all nodes, length
        facets : arrays (m, k) of nodes, see :mod:`signorini.fem.facets` for the order; each a block

        Examples
        --------
        >>> side = Boundary.of([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
        >>> side.nodal_areas.round(12).tolist(), side.nodal_normals[0].tolist()
        ([0.5, 0.5, 0.5, 0.5], [0.0, 0.0, 1.0])
        """
        x = np.asarray(points, float)
        kinds = [np.asarray(nodes, np.int64) for nodes in facets]
        none = np.full(max(map(len, kinds)), -1)
        return cls(points=x, blocks=tuple(FacetBlock(facets=f, points=x[f], cells=none[: len(f)]) for f in kinds))

    @property
    def dimension(self) -> int:
        """Of space."""
        return self.blocks[0].dimension

    @property
    def quadratic(self) -> bool:
        """Whether the facets have nodes in the middle."""
        return self.blocks[0].quadratic

    @cached_property
    def nodes(self) -> IntArray:
        """(n,) Sorted nodes."""
        return np.unique(np.concatenate([block.nodes for block in self.blocks]))

    @cached_property
    def corner_nodes(self) -> IntArray:
        """Sorted nodes at corners of facets: those that carry pairs."""
        return np.unique(np.concatenate([block.corner_nodes.ravel() for block in self.blocks]))

    @property
    def cells(self) -> IntArray:
        """(m,) Numbers of the cells that the facets bound, block after block."""
        return np.concatenate([block.cells for block in self.blocks])

    @property
    def lengths(self) -> Array:
        """(m,) Of the facets, block after block; in space the sides of squares of their areas."""
        return np.concatenate([block.lengths for block in self.blocks])

    @cached_property
    def nodal_normals(self) -> Array:
        """(n, d) Outward unit normals at the nodes, averaged with the sizes of the facets there."""
        total = self._gathered(block.nodal_spans for block in self.blocks)
        collapsed = np.linalg.norm(total, axis=1) == 0.0  # at the ends of a side without length, in all facets there
        if collapsed.any():
            total[collapsed] = self._gathered(block.level_spans for block in self.blocks)[collapsed]
        normals: Array = total / np.linalg.norm(total, axis=1, keepdims=True)
        return normals

    @cached_property
    def nodal_areas(self) -> Array:
        """(n,) ``int N_k`` of the hats of the corners, length or area; 0 at other nodes."""
        return self.nodal((block.weights for block in self.blocks), corners=True)

    @cached_property
    def nodal_normal_areas(self) -> Array:
        """(n, d) ``int N_k n`` of the hats of the corners, n outward; 0 at other nodes."""
        return self.nodal((block.outward for block in self.blocks), corners=True)

    @property
    def nodal_lengths(self) -> Array:
        """(n,) Tributary length of every node; in space the side of a square of its area."""
        total = self.nodal(block.weights for block in self.blocks)
        return total if self.dimension == 2 else np.sqrt(np.maximum(total, 0.0))

    def nodal(self, integrands: Iterable[Array], *, corners: bool = False) -> Array:
        """``int N_k f`` at every node, (n, ...) in the order of ``nodes``.

        Parameters
        ----------
        integrands : for every block f at the quadrature points times what belongs to them, (m, q, ...)
        corners : N are the hats of the corners; 0 at other nodes
        """
        parts = zip(self.blocks, integrands, strict=True)
        return self._gathered(block.nodal(own, corners=corners) for block, own in parts)

    def at_facets(self, block: FacetBlock) -> Array:
        """(m, k, d) Outward unit normals of the boundary at the nodes of the facets of one of its blocks."""
        return self.nodal_normals[np.searchsorted(self.nodes, block.facets)]

    def _gathered(self, parts: Iterable[Array]) -> Array:
        """Values at the nodes of every block, summed at those of all, (n, ...)."""
        given = list(parts)
        total = np.zeros((len(self.nodes), *given[0].shape[1:]))
        for block, values in zip(self.blocks, given, strict=True):
            total[np.searchsorted(self.nodes, block.nodes)] += values
        return total


def boundary(space: Space, name: str, where: Where) -> Boundary:
    """A named boundary of the mesh with its outward normals.

    Parameters
    ----------
    space : of the mesh
    name : of the boundary
    where : what errors call the place

    Raises
    ------
    InputError
        If a facet is no edge or face of a cell, or lies between two cells (shared by two bodies, or inside one); if it
        belongs to both linear and quadratic cells, or names another middle node than the cell.

    Examples
    --------
    >>> from signorini.meshing.plane import rectangle
    >>> from signorini.fem.space import make_space
    >>> boundary(make_space(rectangle(width=2, height=1, nx=2, ny=1)), "top", ("load", 0)).nodal_normals
    array([[0., 1.],
           [0., 1.],
           [0., 1.]])
    """
    kinds = space.mesh.facets(name)
    points = space.mesh.points
    if not len(kinds[0]):
        raise InputError(f"'{name}' is empty; expected a boundary with edges or faces", where=where)
    if space.dimension == 3:
        found = outer_faces(space.faces, kinds, len(points), name, where)
    else:
        found = [_outer_edges(space, kinds[0], name, where)]
    blocks = (FacetBlock(facets=facets, points=points[facets], cells=cells) for facets, cells in found)
    return Boundary(points=points, blocks=tuple(blocks))


def _outer_edges(space: Space, given: IntArray, name: str, where: Where) -> tuple[IntArray, IntArray]:
    """Edges with the body on their left, (m, 2 or 3), and their cells, (m,)."""
    points = space.mesh.points
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
    return facets, space.edges.cell[edge]


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
