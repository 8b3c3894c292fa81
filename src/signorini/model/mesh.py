# SPDX-License-Identifier: BSD-3-Clause
"""A finite element mesh with named parts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, among, distinct, elsewhere, extent, frozen, stored
from signorini.errors import InputError

NODES_PER_PLANE_CELL = {"triangle": 3, "quad": 4, "triangle6": 6, "quad8": 8, "quad9": 9}
NODES_PER_SOLID_CELL = {
    "tetra": 4,
    "hexahedron": 8,
    "wedge": 6,
    "tetra10": 10,
    "hexahedron20": 20,
    "hexahedron27": 27,
    "wedge15": 15,
}
NODES_PER_CELL = NODES_PER_PLANE_CELL | NODES_PER_SOLID_CELL
"""Families of cells by their names in meshio: corners, then the middles of edges, of faces, then the centre."""

CORNERS = {family: NODES_PER_CELL[family.rstrip("0123456789")] for family in NODES_PER_CELL}
"""Of every family: nodes of the linear one."""

_TETRA10 = ((0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6))
_HEXAHEDRON20 = (
    (0, 3, 2, 1, 11, 10, 9, 8),
    (4, 5, 6, 7, 12, 13, 14, 15),
    (0, 1, 5, 4, 8, 17, 12, 16),
    (1, 2, 6, 5, 9, 18, 13, 17),
    (2, 3, 7, 6, 10, 19, 14, 18),
    (3, 0, 4, 7, 11, 16, 15, 19),
)
_WEDGE15 = (
    (0, 2, 1, 8, 7, 6),
    (3, 4, 5, 9, 10, 11),
    (0, 1, 4, 3, 6, 13, 9, 12),
    (1, 2, 5, 4, 7, 14, 10, 13),
    (2, 0, 3, 5, 8, 12, 11, 14),
)
_CENTRES = (24, 25, 22, 21, 23, 20)  # of the faces of a hexahedron with 27 nodes, in the order above


def _corners_of(faces: tuple[tuple[int, ...], ...]) -> tuple[tuple[int, ...], ...]:
    """Of quadratic faces, which have as many middles."""
    return tuple(face[: len(face) // 2] for face in faces)


FACETS: Mapping[str, tuple[tuple[int, ...], ...]] = {
    "triangle": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "triangle6": ((0, 1, 3), (1, 2, 4), (2, 0, 5)),
    **dict.fromkeys(("quad8", "quad9"), ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))),
    **{"tetra10": _TETRA10, "hexahedron20": _HEXAHEDRON20, "wedge15": _WEDGE15},
    "tetra": _corners_of(_TETRA10),
    "hexahedron": _corners_of(_HEXAHEDRON20),
    "wedge": _corners_of(_WEDGE15),
    "hexahedron27": tuple((*face, centre) for face, centre in zip(_HEXAHEDRON20, _CENTRES, strict=True)),
}
"""Nodes of the facets of cells: of every edge in the plane both ends, anticlockwise, and the middle; of every face of a
solid, anticlockwise seen from outside, corners, middles of edges, and the middle."""


def _edges_of(family: str) -> tuple[tuple[int, int], ...]:
    """Of a quadratic family, from its facets: corners k and k + 1 of a ring have their middle behind all corners."""
    found = {}
    for facet in FACETS[family]:
        linear = 2 if len(facet) == 3 else len(facet) // 2
        for k in range(1 if linear == 2 else linear):
            found[facet[linear + k]] = min(facet[k], facet[(k + 1) % linear]), max(facet[k], facet[(k + 1) % linear])
    return tuple(found[middle] for middle in sorted(found))


EDGES = {family: _edges_of(family) for family in FACETS if NODES_PER_CELL[family] > CORNERS[family]}
"""Of quadratic families: corners at the ends of every edge, in the order in which their middle nodes follow these."""

_NODES_PER_FACET = {2: (2, 3), 3: (3, 4, 6, 8, 9)}

Facets = IntArray | tuple[IntArray, ...]
"""Of a boundary: an array (m, k) of their nodes; in space a tuple of such arrays where they differ in k."""


@elsewhere("points", "cells", "bodies", "node_numbers", "cell_numbers")
@dataclass(frozen=True, kw_only=True, eq=False)
class Mesh:
    """Points, cells and the names of bodies, boundaries and node sets.

    Nodes are counted from 0 here and have numbers in files that people read, from 1 as Gmsh counts by default. Cells
    are counted through all families, in the order of ``cells``.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array of coordinates, length
    cells : family ("triangle", "quad", "triangle6", "quad8", "quad9"; in space "tetra", "hexahedron", "wedge",
        "tetra10", "hexahedron20", "hexahedron27", "wedge15") to (m, k) array of node indices in the order of meshio, in
        either orientation: corners, then the middles of the edges, then the centre; a family without cells is left out
    bodies : name to indices of cells
    boundaries : name to (m, 2) or (m, 3) array, the two end nodes of each facet, and the middle one of a quadratic cell
        (it may be left out); in space (m, 3), (m, 4), (m, 6), (m, 8) or (m, 9): corners, then middle nodes. Triangles
        and quadrilaterals together: a tuple of such arrays, one for each number of nodes (:meth:`facets` has a tuple
        for every boundary)
    nodes : name to node indices, for supports and forces on points
    node_numbers : (n,) what results call the nodes, each once; 1, 2, ... if not given
    cell_numbers : (m,) what they call the cells
    cell_word : what messages call a cell: decks of keywords have elements

    Raises
    ------
    InputError
        If a shape is wrong or an index points to nothing.

    Examples
    --------
    >>> square = Mesh(points=[[0, 0], [1, 0], [1, 1], [0, 1]], cells={"quad": [[0, 1, 2, 3]]},
    ...               bodies={"block": [0]}, boundaries={"bottom": [[0, 1]]})
    >>> square
    Mesh(4 nodes, 1 quad; bodies: block; boundaries: bottom)

    A wedge, whose skin is triangles and quadrilaterals:

    >>> wedge = Mesh(points=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    ...              cells={"wedge": [[0, 1, 2, 3, 4, 5]]}, bodies={"wedge": [0]},
    ...              boundaries={"skin": ([[0, 2, 1], [3, 4, 5]], [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]])})
    >>> [faces.shape for faces in wedge.boundaries["skin"]]
    [(2, 3), (3, 4)]
    """

    points: Array
    cells: Mapping[str, IntArray]
    bodies: Mapping[str, IntArray]
    boundaries: Mapping[str, Facets] = field(default_factory=dict)
    nodes: Mapping[str, IntArray] = field(default_factory=dict)
    node_numbers: IntArray | None = None
    cell_numbers: IntArray | None = None
    cell_word: str = "cell"

    def __post_init__(self) -> None:
        points = frozen(self.points)
        if points.ndim != 2 or points.shape[1] not in (2, 3):
            raise InputError(f"has shape {points.shape}; expected (n, 2) or (n, 3)", where=("mesh", "points"))
        families = NODES_PER_PLANE_CELL if points.shape[1] == 2 else NODES_PER_SOLID_CELL
        if not np.isfinite(points).all():
            row = int(np.nonzero(~np.isfinite(points).all(axis=1))[0][0])
            raise InputError(f"node {row + 1} is at {points[row]}; expected finite numbers", where=("mesh", "points"))
        object.__setattr__(self, "points", points)
        cells = {}
        for family, nodes in self.cells.items():
            if family not in families:
                known = f"{', '.join(families)} with {points.shape[1]} coordinates"
                raise InputError(f"unknown family '{family}'; expected one of {known}", where=("mesh", "cells"))
            if len(nodes):
                cells[family] = self._indices(nodes, len(points), "cells", family, (NODES_PER_CELL[family],))
        object.__setattr__(self, "cells", MappingProxyType(cells))
        for part, limit in (("bodies", self.number_of_cells), ("nodes", len(points))):
            named = {name: self._indices(i, limit, part, name, ()) for name, i in getattr(self, part).items()}
            object.__setattr__(self, part, MappingProxyType(named))
        boundaries = {name: self._facets(given, name) for name, given in self.boundaries.items()}
        object.__setattr__(self, "boundaries", MappingProxyType(boundaries))
        for part, count in (("node_numbers", len(points)), ("cell_numbers", self.number_of_cells)):
            if getattr(self, part) is not None:
                object.__setattr__(self, part, _numbers(getattr(self, part), count, part))

    @staticmethod
    def _indices(values: IntArray, limit: int, part: str, name: str, widths: tuple[int, ...]) -> IntArray:
        array = frozen(values, np.int64)
        if array.ndim != (2 if widths else 1) or (widths and array.shape[1] not in widths):
            expected = " or ".join(f"(m, {width})" for width in widths) or "(m,)"
            raise InputError(f"has shape {array.shape}; expected {expected}", where=("mesh", part, name))
        if array.size and (array.min() < 0 or array.max() >= limit):
            raise InputError(
                f"holds indices from {array.min()} to {array.max()}; expected 0 to {limit - 1}",
                where=("mesh", part, name),
            )
        return array

    def _facets(self, given: Facets, name: str) -> Facets:
        """One array where all facets have as many nodes, otherwise one for each number of nodes, ascending."""
        count, widths = len(self.points), _NODES_PER_FACET[self.points.shape[1]]
        apart = isinstance(given, tuple | list) and len(given) > 0 and np.ndim(given[0]) == 2
        arrays: Iterable[Any] = given if apart else (given,)
        parts = [self._indices(part, count, "boundaries", name, widths) for part in arrays]
        there = [part for part in parts if len(part)] or parts[:1]
        kinds = [[part for part in there if part.shape[1] == width] for width in widths]
        merged = [frozen(np.concatenate(own), np.int64) if len(own) > 1 else own[0] for own in kinds if own]
        if len(merged) > 1 and widths == _NODES_PER_FACET[2]:
            raise InputError(
                "holds edges with and without a middle node; expected one kind", where=("mesh", "boundaries", name)
            )
        return merged[0] if len(merged) == 1 else tuple(merged)

    @property
    def number_of_nodes(self) -> int:
        """Nodes, those of no cell too."""
        return int(stored(self, "points").shape[0])

    @property
    def dimension(self) -> int:
        """Coordinates of a node, 2 or 3."""
        return int(stored(self, "points").shape[1])

    @property
    def shapes(self) -> dict[str, tuple[int, int]]:
        """Of every family how many cells there are, and how many nodes each has."""
        return {family: nodes.shape for family, nodes in stored(self, "cells").items()}

    @property
    def number_of_cells(self) -> int:
        """Cells of all families together."""
        return sum(number for number, _ in self.shapes.values())

    @cached_property
    def extent(self) -> Array:
        """(d,) Size of the box around all nodes, length."""
        return extent(self.points)

    def places_of(self, nodes: IntArray) -> Array:
        """(k, d) Points of some nodes, length."""
        found: Array = stored(self, "points")[nodes]
        return found

    @property
    def labels(self) -> IntArray:
        """What results call the nodes, (n,)."""
        return np.arange(1, self.number_of_nodes + 1) if self.node_numbers is None else self.node_numbers

    @property
    def cell_labels(self) -> IntArray:
        """What results call the cells, (m,)."""
        return np.arange(1, self.number_of_cells + 1) if self.cell_numbers is None else self.cell_numbers

    def labels_of(self, nodes: IntArray) -> IntArray:
        """What results call some nodes (k,)."""
        numbers = stored(self, "node_numbers")
        return nodes + 1 if numbers is None else np.asarray(numbers[nodes])

    def cell_labels_of(self, cells: IntArray) -> IntArray:
        """What results call some cells (k,)."""
        numbers = stored(self, "cell_numbers")
        return cells + 1 if numbers is None else np.asarray(numbers[cells])

    def nodes_of_cells(self, family: str, rows: IntArray) -> IntArray:
        """(k, corners) Nodes of some cells of a family, counted in it."""
        return np.asarray(stored(self, "cells")[family][rows])

    def by_family(self, values: IntArray) -> list[IntArray]:
        """Values of all cells, (m,), in parts for the families."""
        return np.split(values, np.cumsum([count for count, _ in self.shapes.values()])[:-1])

    def cell_name(self, cell: int) -> str:
        """What messages call a cell: ``"cell 12 (quad)"``."""
        counts = np.cumsum([len(nodes) for nodes in self.cells.values()])
        family = list(self.cells)[int(np.searchsorted(counts, cell, side="right"))]
        return f"{self.cell_word} {self.cell_labels[cell]} ({family})"

    def facets(self, name: str) -> tuple[IntArray, ...]:
        """The facets of a boundary, an array (m, k) for each number k of nodes that they have."""
        found = self.boundaries[name]
        return found if isinstance(found, tuple) else (found,)

    def nodes_of(self, name: str) -> IntArray:
        """The sorted nodes of a boundary or node set."""
        found = self.facets(name) if name in self.boundaries else (self.nodes[name],)
        return np.unique(np.concatenate([part.ravel() for part in found]))

    def families(self, body: str) -> dict[str, int]:
        """Families of the cells of a body, and how many there are of each; empty where there is no such body."""
        ends = np.cumsum([len(nodes) for nodes in self.cells.values()])
        counts = np.bincount(np.searchsorted(ends, self.bodies.get(body, ()), side="right"), minlength=len(ends))
        return {family: int(count) for family, count in zip(self.cells, counts, strict=True) if count}

    def bounds_nothing(self, name: str) -> bool:
        """Whether no node of a boundary belongs to a cell: a line or surface of its own, for a rigid obstacle."""
        used = among(self.cells.values(), len(self.points))
        return not used[self.nodes_of(name)].any()

    def __repr__(self) -> str:
        families = ", ".join(f"{len(n)} {f}{'s' if len(n) != 1 else ''}" for f, n in self.cells.items())
        parts = [f"{len(self.points)} nodes, {families}", f"bodies: {', '.join(self.bodies)}"]
        if self.boundaries:
            parts.append(f"boundaries: {', '.join(self.boundaries)}")
        return f"Mesh({'; '.join(parts)})"


def _numbers(values: IntArray, count: int, part: str) -> IntArray:
    numbers = frozen(values, np.int64)
    if numbers.shape != (count,):
        raise InputError(f"has shape {numbers.shape}; expected ({count},)", where=("mesh", part))
    if len(distinct(numbers)) < count:
        raise InputError("has a number twice; expected a number of its own for each", where=("mesh", part))
    return numbers


def join(meshes: Mapping[str, Mesh]) -> Mesh:
    """Several meshes as one, not connected; names become ``"key.name"``, a single body's name becomes the key.

    Parameters
    ----------
    meshes : key to mesh; the key names the part

    Examples
    --------
    >>> one = Mesh(points=[[0, 0], [1, 0], [0, 1]], cells={"triangle": [[0, 1, 2]]}, bodies={"body": [0]},
    ...            boundaries={"bottom": [[0, 1]]})
    >>> join({"left": one, "right": one})
    Mesh(6 nodes, 2 triangles; bodies: left, right; boundaries: left.bottom, right.bottom)
    """
    point_shift = np.cumsum([0] + [len(mesh.points) for mesh in meshes.values()])
    blocks: dict[str, list[IntArray]] = {}
    cell_numbers: list[dict[str, IntArray]] = [{} for _ in meshes]
    count = 0
    for family in NODES_PER_CELL:
        for mesh, shift, own in zip(meshes.values(), point_shift, cell_numbers, strict=False):
            if family in mesh.cells:
                blocks.setdefault(family, []).append(mesh.cells[family] + shift)
                own[family] = count + np.arange(len(mesh.cells[family]))
                count += len(own[family])
    bodies: dict[str, IntArray] = {}
    boundaries: dict[str, Facets] = {}
    nodes_named: dict[str, IntArray] = {}
    for (key, mesh), shift, own in zip(meshes.items(), point_shift, cell_numbers, strict=False):
        numbers = np.concatenate([own[family] for family in mesh.cells])
        for name, index in mesh.bodies.items():
            bodies[key if len(mesh.bodies) == 1 else f"{key}.{name}"] = numbers[index]
        boundaries |= {
            f"{key}.{name}": tuple(facets + shift for facets in mesh.facets(name)) for name in mesh.boundaries
        }
        nodes_named |= {f"{key}.{name}": index + shift for name, index in mesh.nodes.items()}
    return Mesh(
        points=np.vstack([mesh.points for mesh in meshes.values()]),
        cells={family: np.vstack(block) for family, block in blocks.items()},
        bodies=bodies,
        boundaries=boundaries,
        nodes=nodes_named,
    )
