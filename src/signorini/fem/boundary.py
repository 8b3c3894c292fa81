# SPDX-License-Identifier: BSD-3-Clause
"""Facets of named boundaries, of one kind or, in space, several: normals, sizes and integrals at their nodes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray, distinct
from signorini.errors import Where
from signorini.fem.facet_block import FacetBlock
from signorini.fem.space import Space
from signorini.meshing.facets import outer_facets, turned_facet


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
        >>> side.nodal(block.weights for block in side.blocks).round(12).tolist(), side.nodal_normals[0].tolist()
        ([0.5, 0.5, 0.5, 0.5], [0.0, 0.0, 1.0])
        """
        x = np.asarray(points, float)
        kinds = [np.asarray(nodes, np.int64) for nodes in facets]
        none = np.full(max(map(len, kinds)), -1)
        return cls(points=x, blocks=tuple(FacetBlock(facets=f, points=x[f], cells=none[: len(f)]) for f in kinds))

    def turned(self) -> Boundary:
        """Boundary of the same facets, seen from the other side: normals point into the body."""
        blocks = []
        for block in self.blocks:
            order = turned_facet(block.corners, block.count)
            blocks.append(FacetBlock(facets=block.facets[:, order], points=block.points[:, order], cells=block.cells))
        return Boundary(points=self.points, blocks=tuple(blocks))

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
        return distinct(np.concatenate([block.nodes for block in self.blocks]))

    @cached_property
    def corner_nodes(self) -> IntArray:
        """Sorted nodes at corners of facets: those that carry pairs."""
        return distinct(np.concatenate([block.corner_nodes.ravel() for block in self.blocks]))

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
    points = space.mesh.points
    found = outer_facets(space.facets_at_boundaries, space.mesh, name, where)
    blocks = (FacetBlock(facets=facets, points=points[facets], cells=cells) for facets, cells in found)
    return Boundary(points=points, blocks=tuple(blocks))
