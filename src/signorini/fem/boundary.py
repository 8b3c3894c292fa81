# SPDX-License-Identifier: BSD-3-Clause
"""Facets of named boundaries: which way is out, how long they are, and what area belongs to a node."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.space import Space


@dataclass(frozen=True, kw_only=True, eq=False)
class Boundary:
    """Facets of a boundary, the body on their left.

    Attributes
    ----------
    facets : (m, 2) nodes, the body on the left of the way from the first to the second
    normals : (m, 2) outward unit normals
    lengths : (m,) lengths
    nodes : (k,) sorted nodes
    """

    facets: IntArray
    normals: Array
    lengths: Array
    nodes: IntArray

    def nodal(self, facet_values: Array) -> Array:
        """Half of every facet's value to each of its nodes: trapezoidal rule, (k, ...) in the order of ``nodes``."""
        result = np.zeros((len(self.nodes), *facet_values.shape[1:]))
        for end in (0, 1):
            np.add.at(result, np.searchsorted(self.nodes, self.facets[:, end]), 0.5 * facet_values)
        return result

    @property
    def nodal_lengths(self) -> Array:
        """Tributary length of every node, (k,)."""
        return self.nodal(self.lengths)

    @property
    def nodal_normals(self) -> Array:
        """Outward unit normals averaged at the nodes with the facets' lengths as weights, (k, 2)."""
        total = self.nodal(self.normals * self.lengths[:, None])
        normals: Array = total / np.linalg.norm(total, axis=1, keepdims=True)
        return normals


def boundary(space: Space, name: str, where: Where) -> Boundary:
    """A named boundary of the mesh with its outward normals.

    Raises
    ------
    InputError
        If a facet is no edge of a cell, or lies between two cells (shared by two bodies, or inside one).

    Examples
    --------
    >>> from signorini.fem.generators import rectangle
    >>> from signorini.fem.space import make_space
    >>> boundary(make_space(rectangle(width=2, height=1, nx=2, ny=1)), "top", ("load", 0)).normals
    array([[0., 1.],
           [0., 1.]])
    """
    facets = space.mesh.boundaries[name]
    points = space.mesh.points
    if not len(facets):
        raise InputError(f"'{name}' has no edges; expected a boundary with edges", where=where)
    owner = _owners(space, facets, name, where)
    start, end = points[facets[:, 0]], points[facets[:, 1]]
    along = end - start
    lengths = np.linalg.norm(along, axis=1)
    if not lengths.all():
        raise InputError(f"'{name}' has an edge without length at node {facets[lengths == 0][0, 0] + 1}", where=where)
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / lengths[:, None]
    inward = np.sum(normals * (owner - start), axis=1) > 0
    facets = np.where(inward[:, None], facets[:, ::-1], facets)
    normals = np.where(inward[:, None], -normals, normals)
    return Boundary(facets=facets, normals=normals + 0.0, lengths=lengths, nodes=np.unique(facets))


def _owners(space: Space, facets: IntArray, name: str, where: Where) -> Array:
    """Centres of the cells that the facets belong to, (m, 2)."""
    count = len(space.mesh.points)

    def keys(ends: IntArray) -> IntArray:
        ends = np.sort(ends, axis=-1)
        code: IntArray = ends[..., 0] * count + ends[..., 1]
        return code

    edges, centres = [], []
    for block in space.blocks:
        edge = keys(np.stack([block.cells, np.roll(block.cells, -1, axis=1)], axis=-1))
        edges.append(edge.ravel())
        centres.append(np.repeat(space.mesh.points[block.cells].mean(axis=1), edge.shape[1], axis=0))
    edge_key, centre = np.concatenate(edges), np.vstack(centres)
    order = np.argsort(edge_key, kind="stable")
    edge_key, centre = edge_key[order], centre[order]
    wanted = keys(facets)
    left = np.searchsorted(edge_key, wanted, side="left")
    found = np.searchsorted(edge_key, wanted, side="right") - left
    if (found != 1).any():
        a, b = facets[np.nonzero(found != 1)[0][0]] + 1
        if (found == 0).any():
            a, b = facets[np.nonzero(found == 0)[0][0]] + 1
            raise InputError(f"'{name}' has an edge between nodes {a} and {b} that no cell has", where=where)
        raise InputError(
            f"'{name}' lies inside: the edge between nodes {a} and {b} belongs to two cells. Expected an outer "
            "boundary; bodies that touch need nodes of their own on the interface",
            where=where,
        )
    if len(np.unique(wanted)) != len(wanted):
        raise InputError(f"'{name}' has an edge twice", where=where)
    owners: Array = centre[left]
    return owners
