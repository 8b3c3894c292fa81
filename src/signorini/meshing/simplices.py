# SPDX-License-Identifier: BSD-3-Clause
"""Triangles and tetrahedra that are bisected where they are asked to be: the plane and space alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, among, distinct
from signorini.errors import InputError
from signorini.meshing.edge_keys import SIMPLEX_EDGES, edge_ends, edge_key, edge_keys, merged
from signorini.meshing.facets import facet_corners, make_facets, unshared
from signorini.meshing.tetrahedra import cone_simplices, triangles_of
from signorini.meshing.twin_edges import NO_TWINS, halved_twins, with_twins
from signorini.model.mesh import CORNERS, EDGES, NODES_PER_SOLID_CELL, Mesh

Curve = Callable[[Array], Array]
"""Of a boundary: the points of its true shape that are nearest to points (k, d), length."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Simplices:
    """Triangles or tetrahedra by their corners, with the names of a mesh and the bends of its quadratic edges.

    Attributes
    ----------
    points : (n, d) of corners, and of nodes of no cell, length
    cells : (m, d + 1)
    bodies, nodes : names to cells and to corners
    boundaries : names to the corners of facets, (k, d)
    tools : boundaries of no cell, as the mesh has them: surfaces of rigid tools
    bends : keys of edges, ascending, and how far the middle of each is from that of its ends, (k, d) length
    parents : (n, 2) ends of the edge that a corner has halved; the corner itself, twice, where it has halved none
    origin : (m,) the cell of the mesh, or of the simplices before, that each is a part of
    twins : (k, 4) edges of the plane that are halved alike, see :func:`signorini.meshing.twin_edges.twin_edges`
    """

    points: Array
    cells: IntArray
    bodies: Mapping[str, IntArray]
    nodes: Mapping[str, IntArray]
    boundaries: Mapping[str, IntArray]
    tools: Mapping[str, tuple[IntArray, ...]]
    bends: tuple[IntArray, Array]
    parents: IntArray
    origin: IntArray
    twins: IntArray = field(default_factory=lambda: NO_TWINS)

    @staticmethod
    def of(mesh: Mesh) -> Simplices:
        """Cells of a mesh as simplices on their corners; quadrilaterals, hexahedra and wedges are cut.

        Raises
        ------
        InputError
            If a node set holds the middle of an edge and not its ends: corners alone are kept.

        Examples
        --------
        >>> from signorini.meshing.plane import rectangle
        >>> simplices = Simplices.of(rectangle(nx=2))
        >>> simplices.cells.shape, simplices.refined([0]).cells.shape
        ((4, 3), (13, 3))
        """
        points, d = mesh.points, mesh.points.shape[1]
        number = corner_numbers(mesh)
        kept = number >= 0
        parts, first = [], 0
        for family, cells in mesh.cells.items():
            owner, corners = cone_simplices(family, cells[:, : CORNERS[family]])
            parts.append((first + owner, number[corners]))
            first += len(cells)
        origin, simplices = (np.concatenate(part) for part in zip(*parts, strict=True))
        tools = {name: mesh.facets(name) for name in mesh.boundaries if mesh.bounds_nothing(name)}
        return Simplices(
            points=points[kept],
            cells=simplices,
            bodies={name: np.flatnonzero(np.isin(origin, own)) for name, own in mesh.bodies.items()},
            nodes={name: number[_corners_in(mesh, name, kept)] for name in mesh.nodes},
            boundaries={
                name: number[np.concatenate([_facet_simplices(facets, d) for facets in mesh.facets(name)])]
                for name in mesh.boundaries
                if name not in tools
            },
            tools={name: tuple(number[facets] for facets in own) for name, own in tools.items()},
            bends=_bends(mesh, number),
            parents=np.repeat(np.arange(kept.sum())[:, None], 2, axis=1),
            origin=origin,
        )

    def refined(self, marked: Iterable[int] | IntArray, curves: Mapping[str, Curve] | None = None) -> Simplices:
        """Every edge of marked triangles halved, of tetrahedra the longest, and what keeps the mesh conforming.

        A simplex is only ever bisected at its longest edge (of equally long ones at that of the larger numbers), so
        that what neighbours share is cut alike.

        Parameters
        ----------
        marked : simplices
        curves : true shapes of boundaries, onto which middles of their edges go

        References
        ----------
        Rivara (1984), Int. J. Numer. Methods Eng. 20, 745.
        """
        curves = curves or {}
        halves = _Halves(self)
        cells, origin = self.cells, np.arange(len(self.cells))
        boundaries = dict(self.boundaries)
        own = cells[np.asarray(marked, dtype=np.int64)]
        first = edge_keys(own).ravel() if cells.shape[1] == 3 else halves.longest_edges(own)
        halves.halve(first, boundaries, curves)
        while True:
            asked, longest = halves.longest(cells)
            if not asked.any():
                break
            halves.halve(longest[asked], boundaries, curves)
            cells, source = halves.bisected(cells, asked, longest)
            origin = origin[source]
            for name in curves:  # of the others nothing is asked before the end
                boundaries[name] = halves.bisected_all(boundaries[name])
        boundaries = {name: halves.bisected_all(facets) for name, facets in boundaries.items()}
        parents = np.vstack([np.repeat(np.arange(len(self.points))[:, None], 2, axis=1), halves.ends])
        return replace(
            self,
            points=halves.points,
            cells=cells,
            bodies={name: np.flatnonzero(among([own], len(self.cells))[origin]) for name, own in self.bodies.items()},
            nodes={name: _with_halves(own, parents, len(self.points)) for name, own in self.nodes.items()},
            boundaries=boundaries,
            bends=halves.bends,
            twins=halves.twins,
            parents=parents,
            origin=origin,
        )

    def carried(self, values: Array) -> Array:
        """Values at the corners of the simplices before at all corners: between the ends of an edge that was halved.

        Parameters
        ----------
        values : (k, ...) at the corners that the simplices had before they were refined
        """
        found = np.zeros((len(self.points), *values.shape[1:]))
        found[: len(values)] = values
        for new in _generations(self.parents, len(values)):
            found[new] = found[self.parents[new]].mean(axis=1)
        return found

    def mesh(self, order: int, curves: Mapping[str, Curve] | None = None) -> Mesh:
        """A mesh of linear or quadratic cells.

        Parameters
        ----------
        order : 1, or 2 with middle nodes, on the curves of their boundaries
        curves : true shapes of boundaries
        """
        corners = self.cells.shape[1]
        if order == 1:
            return self._mesh(self.points, {"triangle" if corners == 3 else "tetra": self.cells}, {}, self.nodes)
        keys, number = np.unique(edge_keys(self.cells), return_inverse=True)
        middles = len(self.points) + number.reshape(len(self.cells), -1)
        ends = edge_ends(keys)
        at = self.points[ends].mean(axis=1) + _bend(self.bends, keys)
        boundaries = {}
        for name, facets in self.boundaries.items():
            edges = np.searchsorted(keys, edge_keys(facets))
            if curves and name in curves and len(facets):
                own = distinct(edges)
                at[own] = curves[name](at[own])
            boundaries[name] = np.hstack([facets, len(self.points) + edges])
        family = "triangle6" if corners == 3 else "tetra10"
        nodes = {}
        for name, own in self.nodes.items():
            held = among([own], len(self.points))[ends].all(axis=1)
            nodes[name] = np.concatenate([own, len(self.points) + np.flatnonzero(held)])
        return self._mesh(np.vstack([self.points, at]), {family: np.hstack([self.cells, middles])}, boundaries, nodes)

    def _mesh(
        self,
        points: Array,
        cells: Mapping[str, IntArray],
        boundaries: Mapping[str, IntArray],
        nodes: Mapping[str, IntArray],
    ) -> Mesh:
        facets = dict(self.boundaries) | dict(boundaries) | dict(self.tools)
        return Mesh(points=points, cells=cells, bodies=self.bodies, boundaries=facets, nodes=nodes)


def edge_corners(corners: int) -> IntArray:
    """(e, 2) Which corners of a simplex its edges join, in the order of their middle nodes."""
    return np.array(SIMPLEX_EDGES[corners])


def corner_numbers(mesh: Mesh) -> IntArray:
    """(n,) Of the nodes of a mesh among those that simplices keep: corners, and nodes of no cell; -1 of others."""
    inside = among(mesh.cells.values(), len(mesh.points))
    corner = among((cells[:, : CORNERS[family]] for family, cells in mesh.cells.items()), len(mesh.points))
    kept = corner | ~inside
    return np.where(kept, np.cumsum(kept) - 1, -1)


class _Halves:
    """Edges that are halved, and the corners in their middles."""

    def __init__(self, simplices: Simplices) -> None:
        self.points = simplices.points
        self.bends, self.twins = simplices.bends, simplices.twins
        self.ends = np.empty((0, 2), np.int64)
        self._keys: IntArray = np.empty(0, np.int64)
        self._corner: IntArray = np.empty(0, np.int64)
        self._ended = np.zeros(len(self.points), dtype=np.bool_)

    def halve(self, keys: IntArray, boundaries: Mapping[str, IntArray], curves: Mapping[str, Curve]) -> None:
        """Corners for those of some edges that have none yet.

        Parameters
        ----------
        keys : of the edges
        boundaries : the corners of their facets
        curves : true shapes of boundaries
        """
        keys = with_twins(distinct(keys), self.twins)
        keys = keys[self.corner(keys) < 0]
        ends = edge_ends(keys)
        bend = _bend(self.bends, keys)
        at = self.points[ends].mean(axis=1) + bend
        for name, curve in curves.items():
            of_boundary = edge_keys(boundaries[name]).ravel()
            own = np.minimum(np.searchsorted(keys, of_boundary), len(keys) - 1)
            own = own[keys[own] == of_boundary] if len(keys) else own[:0]
            if len(own):
                at[own] = curve(at[own])
        corner = len(self.points) + np.arange(len(keys))
        self._keys, self._corner = merged((self._keys, self._corner), (keys, corner))
        self.points, self.ends = np.vstack([self.points, at]), np.vstack([self.ends, ends])
        self._ended = np.concatenate([self._ended, np.zeros(len(keys), dtype=np.bool_)])
        self._ended[ends] = True
        bent = bend.any(axis=1)
        halves = [edge_key(end[bent], corner[bent]) for end in ends.T]
        given = np.concatenate(halves), np.tile(bend[bent] / 4.0, (2, 1))  # of a parabola at a quarter
        order = np.argsort(given[0])
        self.bends = merged(self.bends, (given[0][order], given[1][order]))
        self.twins = halved_twins(self.twins, self.corner)

    def corner(self, keys: IntArray) -> IntArray:
        """In the middle of edges, -1 of those that are not halved."""
        if not len(self._keys):
            return np.full(keys.shape, -1)
        at = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        return np.where(self._keys[at] == keys, self._corner[at], -1)

    def longest(self, simplices: IntArray) -> tuple[BoolArray, IntArray]:
        """(m,) Which simplices have a halved edge, and the key of the longest edge of each."""
        asked: BoolArray = np.count_nonzero(self._ended[simplices], axis=1) > 1  # most have no such corners
        if asked.any():
            asked[asked] = (self.corner(edge_keys(simplices[asked])) >= 0).any(axis=1)
        longest = np.full(len(simplices), -1)
        if asked.any():
            longest[asked] = self.longest_edges(simplices[asked])
        return asked, longest

    def longest_edges(self, simplices: IntArray) -> IntArray:
        """(m,) Keys of the longest edges; of equally long ones that with the larger numbers."""
        keys = edge_keys(simplices)
        ends = np.diff(self.points[edge_ends(keys)], axis=2)[:, :, 0]
        length = np.einsum("mei,mei->me", ends, ends)
        return np.asarray(np.where(length == length.max(axis=1, keepdims=True), keys, -1).max(axis=1))

    def bisected(self, simplices: IntArray, asked: BoolArray, longest: IntArray) -> tuple[IntArray, IntArray]:
        """Simplices with those asked for in halves, and the simplex that each comes from.

        Parameters
        ----------
        simplices, asked : all, and which
        longest : (m,) keys of their longest edges, where they are asked for
        """
        own, longest = simplices[asked], longest[asked]
        keys = edge_keys(own)
        edge = np.argmax(keys == longest[:, None], axis=1)
        middle, row = self.corner(longest), np.arange(len(own))
        first, second = own.copy(), own.copy()
        ends = np.array(SIMPLEX_EDGES[own.shape[1]])[edge]
        first[row, ends[:, 1]] = middle
        second[row, ends[:, 0]] = middle
        source = np.flatnonzero(asked)
        return np.vstack([simplices[~asked], first, second]), np.concatenate([np.flatnonzero(~asked), source, source])

    def bisected_all(self, facets: IntArray) -> IntArray:
        """Facets, bisected until none has a halved edge, as far as their longest edges are."""
        while len(facets):
            asked, longest = self.longest(facets)
            asked &= self.corner(longest) >= 0
            if not asked.any():
                break
            facets, _ = self.bisected(facets, asked, longest)
        return facets


def _bend(bends: tuple[IntArray, Array], keys: IntArray) -> Array:
    """Of edges, (k, d) length; 0 where they are straight."""
    known, offsets = bends
    if not len(known):
        return np.zeros((len(keys), offsets.shape[1]))
    at = np.minimum(np.searchsorted(known, keys), len(known) - 1)
    return np.where((known[at] == keys)[:, None], offsets[at], 0.0)


def _bends(mesh: Mesh, number: IntArray) -> tuple[IntArray, Array]:
    """Of the edges of quadratic cells that are not straight, by the new numbers of their ends.

    Those alone that bound something: inside a body halves of bent edges would fold where a mesh is coarse.
    """
    found, points = [], mesh.points
    bounding = _bounding_edges(mesh)
    for family, cells in mesh.cells.items():
        for i, (one, other) in enumerate(EDGES.get(family, ())):
            ends = cells[:, [one, other]]
            offset = points[cells[:, CORNERS[family] + i]] - points[ends].mean(axis=1)
            length = np.linalg.norm(np.diff(points[ends], axis=1)[:, 0], axis=1)
            bent = np.linalg.norm(offset, axis=1) > 1e-12 * length  # rounding of coordinates
            bent &= np.isin(edge_key(*ends.T), bounding)
            found.append((edge_key(*number[ends[bent]].T), offset[bent]))
    if not found:
        return np.empty(0, np.int64), np.empty((0, points.shape[1]))
    keys, first = np.unique(np.concatenate([key for key, _ in found]), return_index=True)
    return keys, np.concatenate([offset for _, offset in found])[first]


def _bounding_edges(mesh: Mesh) -> IntArray:
    """Keys of the edges of named boundaries and of facets with no cell behind them."""
    d, facets = mesh.points.shape[1], make_facets(mesh)
    named = [part for name in mesh.boundaries for part in mesh.facets(name)]
    named += [own.nodes[unshared(own.key)] for own in facets.values()]
    keys = []
    for part in named:
        corners = part[:, : facet_corners(d, part.shape[1])]
        keys += [edge_key(one, other) for one, other in zip(corners.T, np.roll(corners, -1, axis=1).T, strict=True)]
    return distinct(np.concatenate(keys))


def _facet_simplices(facets: IntArray, dimension: int) -> IntArray:
    """(k, d) Corners of the simplices of facets, cut as the cells beside them are."""
    corners = facets[:, : facet_corners(dimension, facets.shape[1])]
    return triangles_of(corners) if corners.shape[1] == 4 else corners


def _corners_in(mesh: Mesh, name: str, kept: BoolArray) -> IntArray:
    """Nodes of a set that are kept."""
    own = mesh.nodes[name]
    held, covered = among([own], len(mesh.points)), kept.copy()
    for family, cells in mesh.cells.items():
        for i, (one, other) in enumerate(EDGES.get(family, ())):
            whole = held[cells[:, one]] & held[cells[:, other]]
            covered[cells[whole, CORNERS[family] + i]] = True
        if family in NODES_PER_SOLID_CELL or family == "quad9":
            covered[cells[:, CORNERS[family] + len(EDGES.get(family, ())) :]] = True
    lost = own[~covered[own]]
    if len(lost):
        raise InputError(
            f"holds node {mesh.labels[lost[0]]}, the middle of an edge, without both its ends; expected them too where "
            "the mesh is refined",
            where=("mesh", "nodes", name),
        )
    return own[kept[own]]


def _with_halves(own: IntArray, parents: IntArray, before: int) -> IntArray:
    """Corners of a set, and those between two of them."""
    held = among([own], len(parents))
    for new in _generations(parents, before):
        held[new] = held[parents[new]].all(axis=1)
    return np.flatnonzero(held)


def _generations(parents: IntArray, before: int) -> Iterator[slice]:
    """New corners in parts whose parents are all older."""
    start = before
    while start < len(parents):
        young = (parents[start:] >= start).any(axis=1)
        end = start + int(np.argmax(young)) if young.any() else len(parents)
        yield slice(start, end)
        start = end
