# SPDX-License-Identifier: BSD-3-Clause
"""One side of a contact in space: faces of any kinds, their normals and areas."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray, frozen
from signorini.errors import InputError
from signorini.fem.facet_block import FacetBlock
from signorini.interface.smooth import Facets, Smooth, smooth_surfaces
from signorini.interface.spatial.faces import node_places, pieces, shapes_at, slopes_at
from signorini.interface.tilt import turns
from signorini.meshing.faces import CORNERS

_RULE = 3


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Faces of one kind.

    Attributes
    ----------
    faces : (m, c) nodes, c = 3, 4, 6, 8 or 9
    points : (m, c, 3) their coordinates, length
    """

    faces: IntArray
    points: Array

    @property
    def nodes_a_face(self) -> int:
        """3, 4, 6, 8 or 9."""
        return int(self.faces.shape[1])

    @cached_property
    def corners(self) -> IntArray:
        """(m, 3 or 4) Nodes that carry pairs."""
        return self.faces[:, : CORNERS[self.nodes_a_face]]

    @cached_property
    def plane_pieces(self) -> Array:
        """(m, s, 3 or 4, 3) Corners of the pieces that stand for each face, see `faces.pieces`."""
        places = pieces(self.nodes_a_face)
        weights = shapes_at(self.nodes_a_face, places.reshape(-1, 2)).reshape(*places.shape[:2], -1)
        return np.einsum("sac,mcd->msad", weights, self.points)

    @cached_property
    def parallelograms(self) -> bool:
        """Whether every piece is a triangle or a parallelogram, which quadrature of low degree integrates exactly."""
        corners = self.plane_pieces
        if corners.shape[2] == 3:
            return True
        skew = np.abs(corners[:, :, 0] - corners[:, :, 1] + corners[:, :, 2] - corners[:, :, 3]).max(initial=0.0)
        return bool(skew <= 1e-10 * np.ptp(corners, axis=2).max(initial=0.0))

    def outward(self, places: Array) -> Array:
        """(m, q, 3) Outward normals times area per reference area, at reference coordinates (q, 2)."""
        along = np.einsum("qec,mcd->mqed", slopes_at(self.nodes_a_face, places), self.points)
        return np.cross(along[:, :, 0], along[:, :, 1])


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """Faces of one side with their outward normals; build it with `make_surface`.

    Attributes
    ----------
    points : (n, 3) of all nodes of the mesh, length
    blocks : faces by their kind
    """

    points: Array
    blocks: tuple[Block, ...]

    @cached_property
    def nodes(self) -> IntArray:
        """(k,) Sorted nodes."""
        return np.unique(np.concatenate([block.faces.ravel() for block in self.blocks]))

    @cached_property
    def corners(self) -> IntArray:
        """Sorted nodes at corners of faces: those that carry pairs."""
        return np.unique(np.concatenate([block.corners.ravel() for block in self.blocks]))

    @property
    def linear(self) -> bool:
        """Whether all faces have nodes at their corners only."""
        return all(block.nodes_a_face <= 4 for block in self.blocks)

    @cached_property
    def nodal_normals(self) -> Array:
        """(k, 3) Outward unit normals at ``nodes``: means of those of the faces there, weighted with their areas."""
        total = np.zeros((len(self.nodes), 3))
        for block in self.blocks:
            facets = FacetBlock(facets=block.faces, points=block.points, cells=np.zeros(len(block.faces), np.int64))
            total[np.searchsorted(self.nodes, facets.nodes)] += facets.nodal_spans
        length = np.linalg.norm(total, axis=1, keepdims=True)
        normals: Array = total / np.where(length > 0, length, 1.0)
        return normals

    @cached_property
    def smooth(self) -> tuple[Smooth, ...]:
        """What the faces stand for, block by block."""
        kinds = [Facets(block.faces, block.points, block.corners.shape[1]) for block in self.blocks]
        return smooth_surfaces(kinds)

    def turns(self, block: Block) -> Array:
        """(m,) Angle by which the side turns from every face of a block to the next, see `interface.tilt.turns`."""
        mean = block.outward(reference_rule(CORNERS[block.nodes_a_face])[0]).mean(axis=1)
        mean /= np.linalg.norm(mean, axis=1, keepdims=True)
        return turns(mean, self.nodal_normals[np.searchsorted(self.nodes, block.faces)])

    @cached_property
    def nodal_areas(self) -> Array:
        """(k,) ``int N_k`` of the linear functions of the corners; 0 at other nodes."""
        result = np.zeros(len(self.nodes))
        for block in self.blocks:
            count = CORNERS[block.nodes_a_face]
            places, weights = reference_rule(count)
            size = np.linalg.norm(block.outward(places), axis=2) * weights
            np.add.at(result, np.searchsorted(self.nodes, block.corners), size @ shapes_at(count, places))
        return result

    @cached_property
    def nodal_normal_areas(self) -> Array:
        """(k, 3) ``int N_k n`` of the linear functions of the corners, n outward; 0 at other nodes."""
        result = np.zeros((len(self.nodes), 3))
        for block in self.blocks:
            count = CORNERS[block.nodes_a_face]
            places, weights = reference_rule(count)
            shares = np.einsum("mqd,q,qa->mad", block.outward(places), weights, shapes_at(count, places))
            np.add.at(result, np.searchsorted(self.nodes, block.corners), shares)
        return result

    @cached_property
    def nodal_lengths(self) -> Array:
        """(k,) Roots of ``nodal_areas``."""
        return np.asarray(np.sqrt(self.nodal_areas), dtype=np.float64)


def make_surface(points: ArrayLike, *faces: ArrayLike) -> Surface:
    """A side of a contact from node arrays.

    Parameters
    ----------
    points : (n, 3) of all nodes of the mesh, length
    faces : arrays (m, c) of nodes, c = 3, 4, 6, 8 or 9, counter-clockwise seen from outside; see `faces` for the order

    Raises
    ------
    InputError
        For other numbers of nodes, nodes that are not there, or a face without area.

    Examples
    --------
    >>> side = make_surface([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    >>> side.nodal_areas.round(12).tolist(), side.nodal_normals[0].tolist()
    ([0.5, 0.5, 0.5, 0.5], [0.0, 0.0, 1.0])
    """
    x = frozen(points)
    if x.ndim != 2 or x.shape[1] != 3:
        raise InputError(f"has shape {x.shape}; expected (n, 3)", where=("points",))
    blocks = []
    for i, given in enumerate(faces):
        nodes = frozen(given, dtype=np.int64)
        if nodes.ndim != 2 or nodes.shape[1] not in CORNERS:
            raise InputError(f"has shape {nodes.shape}; expected (m, c), c = 3, 4, 6, 8 or 9", where=("faces", i))
        if not len(nodes):
            continue
        if nodes.min() < 0 or nodes.max() >= len(x):
            raise InputError(f"names node {nodes.max()} of {len(x)}", where=("faces", i))
        block = Block(faces=nodes, points=x[nodes])
        count = nodes.shape[1]
        size = np.linalg.norm(block.outward(node_places(count)[: CORNERS[count]].mean(axis=0, keepdims=True)), axis=2)
        if (size <= 0).any():
            flat = nodes[int(np.argmin(size))]
            raise InputError(f"has a face without area, with nodes {(flat + 1).tolist()}", where=("faces", i))
        blocks.append(block)
    if not blocks:
        raise InputError("are none; expected at least one face", where=("faces",))
    return Surface(points=x, blocks=tuple(blocks))


def reference_rule(corners: int, order: int = _RULE) -> tuple[Array, Array]:
    """Gauss points (q, 2) and weights of the reference triangle or square; those of the triangle are collapsed."""
    x, w = np.polynomial.legendre.leggauss(order)
    if corners == 4:
        places = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
        return places, np.outer(w, w).ravel()
    t, w = (1.0 + x) / 2.0, w / 2.0
    a, b = (grid.ravel() for grid in np.meshgrid(t, t, indexing="ij"))
    return np.column_stack([a, (1.0 - a) * b]), np.outer(w, w).ravel() * (1.0 - a)


def search_distance(nonmortar: Surface, mortar: Surface) -> float:
    """How far apart faces can be and still be opposite each other: half the size of the smaller side."""
    return 0.5 * float(min(np.linalg.norm(np.ptp(side.points[side.nodes], axis=0)) for side in (nonmortar, mortar)))
