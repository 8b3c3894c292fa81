# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that gives way where sides are worn: their nodes by the worn depth, those behind them by springs.

Between the nodes of a mesh are springs along its edges, as stiff as they are short, so that the cells behind a worn
side are all shortened alike. Nodes on flat parts of the surface and on straight edges stay on them, those of curved
parts, at corners, and between bodies stay where they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.fem.boundary import boundary
from signorini.fem.space import Space
from signorini.meshing.facets import facet_corners
from signorini.model.model import Model

_FLAT_SPREAD = 1e-8  # of the mean square of normals: what those at a node on a flat surface differ by, (angle / 2)^2
_EDGE_SPREAD = 1e-2  # of the same: across an edge, at angles from 0.2 on; what is between is curved
_STEEP_SHARE = 0.5  # of an edge: so much of it is along the normal where it goes into the body
_ALONG_SHARE = 0.1  # of a normal: so much of it is along the other surfaces of a node that can give way along them


class WornSide(NamedTuple):
    """Depths (k,) at nodes (k,) of a boundary of the mesh, length."""

    name: str
    nodes: IntArray
    depths: Array


def worn_places(space: Space, model: Model, worn: Sequence[WornSide]) -> Array:
    """(nodes, d) Places of the nodes of a mesh whose sides are worn.

    Parameters
    ----------
    space, model : of the mesh as it was given
    worn : sides
    """
    from scipy.sparse.linalg import spsolve

    points, d = space.mesh.points, space.dimension
    edges, middles = _edges(space)
    given, motion = _given(space, worn)
    fixed = _fixed(space, model)
    fixed[given] = False
    basis = _free_ways(space, fixed, given)
    stiff = 1.0 / np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    ends = sp.csr_array(
        (np.tile([1.0, -1.0], len(edges)), (np.repeat(np.arange(len(edges)), 2), edges.ravel())),
        shape=(len(edges), len(points)),
    )
    K = sp.kron(ends.T @ sp.diags_array(stiff) @ ends, sp.eye_array(d), format="csr")
    moved = motion.ravel() + basis @ spsolve(sp.csc_array(basis.T @ K @ basis), -(basis.T @ (K @ motion.ravel())))
    moved = moved.reshape(-1, d)
    for middle, corners in middles:
        moved[middle] = moved[corners].mean(axis=1)
    return np.asarray(points + moved)


def cell_heights(space: Space, name: str, nodes: IntArray) -> Array:
    """(k,) Heights of the cells behind nodes of a boundary: how far the next nodes are below the surface, length.

    Parameters
    ----------
    space : of the mesh
    name : of the boundary
    nodes : (k,) corners of its facets
    """
    points, side = space.mesh.points, boundary(space, name, ("contact",))
    on_side = np.zeros(len(points), np.bool_)
    on_side[side.nodes] = True
    edges = _edges(space)[0]
    edges = np.concatenate([edges, edges[:, ::-1]])
    edges = edges[on_side[edges[:, 0]] & ~on_side[edges[:, 1]]]
    normals = side.nodal_normals[np.searchsorted(side.nodes, edges[:, 0])]
    ways = points[edges[:, 1]] - points[edges[:, 0]]
    below = np.abs(np.einsum("ij,ij->i", ways, normals))
    steep = below > _STEEP_SHARE * np.linalg.norm(ways, axis=1)
    heights = np.full(len(points), np.inf)
    np.minimum.at(heights, edges[steep, 0], below[steep])
    own: Array = heights[nodes]
    return np.where(np.isfinite(own), own, own.min())


def _edges(space: Space) -> tuple[IntArray, list[tuple[IntArray, IntArray]]]:
    """(e, 2) Corners at the ends of all edges of cells; and middle nodes (m,) with the corners (m, k) around them."""
    pairs, middles = [], []
    d = space.dimension
    for count, facets in space.facets.items():
        corners = facet_corners(d, count)
        ring = facets.nodes[:, :corners]
        ends = (
            [ring] if d == 2 else [np.stack([ring[:, k], ring[:, (k + 1) % corners]], axis=1) for k in range(corners)]
        )
        pairs += ends
        middles += [(facets.nodes[:, corners + k], ends[k]) for k in range(min(len(ends), count - corners))]
        middles += [(facets.nodes[:, -1], ring)] if count > corners + len(ends) else []
    for block in space.blocks:
        around = {"quad9": 4, "hexahedron27": 8}.get(block.family)
        middles += [(block.cells[:, -1], block.cells[:, :around])] if around else []
    return np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0), middles


def _given(space: Space, worn: Sequence[WornSide]) -> tuple[IntArray, Array]:
    """Nodes of worn sides, and (nodes, d) how far they give way, along the other surfaces that they are on."""
    motion, given = np.zeros_like(space.mesh.points), list[IntArray]()
    for name, nodes, depths in worn:
        side = boundary(space, name, ("contact",))
        normals = side.nodal_normals[np.searchsorted(side.nodes, nodes)]
        along = _along_others(space, side.cells, nodes, normals)
        inwards = np.einsum("ij,ij->i", along, normals)
        slopes = np.where(inwards > _ALONG_SHARE, inwards, 1.0)
        ways = np.where((inwards > _ALONG_SHARE)[:, None], along, normals) / slopes[:, None]
        np.add.at(motion, nodes, -depths[:, None] * ways)
        given.append(nodes)
    return np.unique(np.concatenate(given)), motion


def _surface(space: Space) -> tuple[IntArray, Array, IntArray]:
    """Facets of one cell alone: numbers (f, k) of their corners, -1 behind those of triangles, normals and cells."""
    d, points = space.dimension, space.mesh.points
    rings, normals, cells = [], [], []
    for count, facets in space.facets.items():
        alone = ~np.isin(np.arange(len(facets.key)), _twice(facets.key))
        ring = facets.nodes[alone, : facet_corners(d, count)]
        first = points[ring[:, 1]] - points[ring[:, 0]]
        if d == 2:
            normal = np.stack([first[:, 1], -first[:, 0]], axis=1)
        else:
            normal = np.cross(first, points[ring[:, -1]] - points[ring[:, 0]])
        normals.append(normal / np.linalg.norm(normal, axis=1, keepdims=True))
        width = 2 if d == 2 else 4
        rings.append(np.pad(ring, ((0, 0), (0, width - ring.shape[1])), constant_values=-1))
        cells.append(facets.cell[alone])
    return np.concatenate(rings), np.concatenate(normals), np.concatenate(cells)


def _twice(key: IntArray) -> IntArray:
    """Places of equal neighbours in ascending keys."""
    same = np.flatnonzero(key[1:] == key[:-1])
    return np.concatenate([same, same + 1])


def _squares(space: Space, rings: IntArray, normals: Array) -> Array:
    """(nodes, d, d) Mean of the squares of the normals of facets at every node; 0 where there is none."""
    total, count = np.zeros((len(space.mesh.points), *(2 * (space.dimension,)))), np.zeros(len(space.mesh.points))
    square = normals[:, :, None] * normals[:, None, :]
    for corner in rings.T:
        there = corner >= 0
        np.add.at(total, corner[there], square[there])
        np.add.at(count, corner[there], 1.0)
    return np.asarray(total / np.maximum(count, 1.0)[:, None, None])


def _along_others(space: Space, cells: IntArray, nodes: IntArray, normals: Array) -> Array:
    """(k, d) Of normals of a side, at its nodes, what is along the other surfaces there."""
    rings, others, owner = _surface(space)
    # facets of the side are those whose nodes all are on it, of its cells
    on_side = np.zeros(len(space.mesh.points) + 1, np.bool_)
    on_side[nodes] = on_side[-1] = True
    whole = on_side[rings].sum(axis=1) == rings.shape[1]
    side = np.flatnonzero(whole & np.isin(owner, cells))
    squares = _squares(space, np.delete(rings, side, axis=0), np.delete(others, side, axis=0))[nodes]
    sizes, ways = np.linalg.eigh(squares)
    free = np.where(sizes[:, None, :] <= _FLAT_SPREAD, ways, 0.0)
    return np.asarray(np.einsum("kij,klj,kl->ki", free, free, normals))


def _fixed(space: Space, model: Model) -> BoolArray:
    """(nodes,) Nodes that bodies share, and those of the sides of contacts that do not wear."""
    owner, fixed = model.body_of_cells(), np.zeros(len(space.mesh.points), np.bool_)
    bodies = np.zeros((len(model.bodies), len(fixed)), np.bool_)
    for block in space.blocks:
        bodies[owner[block.first : block.first + len(block.cells)][:, None], block.cells] = True
    fixed |= bodies.sum(axis=0) > 1
    for contact in model.contacts:
        sides = (contact.nonmortar, contact.mortar) if contact.wear is None else ()
        for name in (str(side) for side in sides if side in space.mesh.boundaries):
            fixed[space.mesh.nodes_of(name)] = True
    return fixed


def _free_ways(space: Space, fixed: BoolArray, given: IntArray) -> sp.csr_array:
    """(nodes d, free) Directions in which nodes may move: of given ones none, on flat surfaces along them."""
    rings, normals, _ = _surface(space)
    d, nodes = space.dimension, np.unique(rings[rings >= 0])
    corner = np.zeros(len(fixed), np.bool_)
    corner[_edges(space)[0].ravel()] = True
    sizes, ways = np.linalg.eigh(_squares(space, rings, normals)[nodes])
    frames, free = np.tile(np.eye(d), (len(fixed), 1, 1)), np.tile((corner & ~fixed)[:, None], (1, d))
    frames[nodes] = ways
    curved = np.sum((sizes > _FLAT_SPREAD) & (sizes < _EDGE_SPREAD), axis=1, keepdims=True) > 0
    free[nodes] &= (sizes <= _FLAT_SPREAD) & ~curved
    free[given] = False
    node, way = np.nonzero(free)
    rows = d * node[:, None] + np.arange(d)
    columns = np.tile(np.arange(len(node))[:, None], (1, d))
    return sp.csr_array(
        (frames[node, :, way].ravel(), (rows.ravel(), columns.ravel())), shape=(d * len(fixed), len(node))
    )
