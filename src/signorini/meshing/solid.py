# SPDX-License-Identifier: BSD-3-Clause
"""Solid meshes with named boundaries: a box, and plane meshes raised; to be bent by whoever moves their points."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.checks import choice, text
from signorini.errors import InputError
from signorini.meshing.facets import HEXAHEDRON, make_facets
from signorini.meshing.grids import check_grid, increasing
from signorini.meshing.tetrahedra import tetrahedra
from signorini.model.mesh import CORNERS, NODES_PER_CELL, NODES_PER_SOLID_CELL, Mesh

SolidCells = Literal["hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10"]
SIDES = (("left", "right"), ("front", "back"), ("bottom", "top"))
"""Of a box: its lower and upper boundary along x, y and z."""

_RAISED = {
    **{"quad": "hexahedron", "quad8": "hexahedron20", "quad9": "hexahedron27"},
    **{"triangle": "wedge", "triangle6": "wedge15"},
}
_QUADRILATERAL = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1))  # places of its nodes
_FAMILIES = tuple(family for family in NODES_PER_SOLID_CELL if not family.startswith("wedge"))


def box(*, x: ArrayLike, y: ArrayLike, z: ArrayLike, cells: SolidCells = "hexahedron") -> Mesh:
    """A box "block" with the boundaries left, right (along x), front, back (y), bottom and top (z).

    Parameters
    ----------
    x, y, z : increasing coordinates of the grid planes, length
    cells : "hexahedron", "hexahedron20", "hexahedron27", or every box of the grid cut in six: "tetra", "tetra10"

    Raises
    ------
    InputError
        If coordinates do not increase or the family is unknown.

    Examples
    --------
    >>> box(x=[0, 1, 2], y=[0, 1], z=[0, 1])
    Mesh(12 nodes, 2 hexahedrons; bodies: block; boundaries: left, right, front, back, bottom, top)
    """
    choice(cells, _FAMILIES, ("mesh", "cells"), "family")
    if cells.startswith("tetra"):
        plain = tetrahedra(box(x=x, y=y, z=z, cells="hexahedron" if cells == "tetra" else "hexahedron27"))
    else:
        step, count = 1 if cells == "hexahedron" else 2, NODES_PER_SOLID_CELL[cells]
        lines = [increasing(given, ("mesh", key), step) for key, given in (("x", x), ("y", y), ("z", z))]
        shape = tuple(len(line) for line in lines)
        check_grid(math.prod(shape))
        points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
        used, nodes = np.unique(_hexahedra(np.arange(len(points)).reshape(shape), step, count), return_inverse=True)
        nodes = nodes.reshape(-1, count)
        plain = Mesh(points=points[used], cells={cells: nodes}, bodies={"block": np.arange(len(nodes))})
    return Mesh(points=plain.points, cells=plain.cells, bodies=plain.bodies, boundaries=_sides(plain))


def extruded(mesh: Mesh, *, z: ArrayLike, ends: tuple[str, str] = ("bottom", "top")) -> Mesh:
    """A plane mesh raised along z: its bodies become solids, its boundaries their walls, its nodes upright lines.

    Quadrilaterals become hexahedra of the same order ("quad8" has 20 nodes, "quad9" 27), triangles wedges ("triangle6"
    with 15 nodes).

    Parameters
    ----------
    mesh : with two coordinates, of "quad" and "triangle", or of "quad8", "quad9" and "triangle6"
    z : increasing heights of the layers, length
    ends : names of the boundaries across z, the lower and the upper one

    Raises
    ------
    InputError
        If the mesh is of other cells or of linear and quadratic ones, heights do not increase, or a boundary or node
        set has the name of an end.

    Examples
    --------
    >>> from signorini.meshing.plane import annulus
    >>> extruded(annulus(inner=1, outer=2, n_radial=1, n_angular=4), z=[0, 1])
    Mesh(16 nodes, 4 hexahedrons; bodies: ring; boundaries: inner, outer, bottom, top)

    A rectangle has a bottom and a top of its own:

    >>> from signorini.meshing.plane import rectangle
    >>> extruded(rectangle(nx=2), z=[0, 0.5, 1], ends=("front", "back"))
    Mesh(18 nodes, 4 hexahedrons; bodies: block; boundaries: bottom, top, left, right, front, back)
    """
    steps = {1 if NODES_PER_CELL[plane] == CORNERS[plane] else 2 for plane in mesh.cells}
    if mesh.points.shape[1] != 2 or len(steps) != 1 or not set(mesh.cells) <= set(_RAISED):
        raise InputError(f"is {mesh!r}; expected plane cells of one order of {', '.join(_RAISED)}", where=("mesh",))
    names = tuple(text(name, ("ends", i)) for i, name in enumerate(ends))
    if len(set(names)) != 2:
        raise InputError(f"is {ends!r}; expected two names", where=("ends",))
    for i, name in enumerate(names):
        if name in (*mesh.boundaries, *mesh.nodes):
            raise InputError(f"'{name}' is taken: the plane mesh has it; expected another name", where=("ends", i))
    (step,) = steps
    heights = increasing(z, ("mesh", "z"), step)
    n, layers = len(mesh.points), np.arange(0, len(heights) - 1, step)
    points = np.column_stack([np.tile(mesh.points, (len(heights), 1)), np.repeat(heights, n)])
    solids = {_RAISED[plane]: _layer(plane, cells, n, step) for plane, cells in mesh.cells.items()}
    raised = {family: np.concatenate([nodes + n * k for k in layers]) for family, nodes in solids.items()}
    walls: dict[str, tuple[IntArray, ...]] = {}
    for name in mesh.boundaries:
        (edges,) = mesh.facets(name)
        corners = np.hstack([edges[:, :2], edges[:, 1::-1] + step * n])
        walls[name] = (np.concatenate([corners + n * k for k in layers]),)
    floor = tuple(cells[:, : CORNERS[plane]] for plane, cells in mesh.cells.items())
    walls |= {names[0]: floor, names[1]: tuple(corners + n * (len(heights) - 1) for corners in floor)}
    # hexahedra of 20 nodes have none inside faces
    used = np.unique(np.concatenate([nodes.ravel() for nodes in raised.values()]))
    return Mesh(
        points=points[used],
        cells={family: np.searchsorted(used, nodes) for family, nodes in raised.items()},
        bodies={name: _in_layers(mesh, own, len(layers)) for name, own in mesh.bodies.items()},
        boundaries={name: tuple(np.searchsorted(used, faces) for faces in kinds) for name, kinds in walls.items()},
        nodes={name: np.flatnonzero(np.isin(used % n, own)) for name, own in mesh.nodes.items()},
    )


def _layer(plane: str, cells: IntArray, n: int, step: int) -> IntArray:
    """Nodes of the solids of the lowest layer; those of the next ``step`` heights are n more each."""
    if plane == "triangle":
        return np.hstack([cells, cells + n])
    if plane == "triangle6":
        corners, middles = cells[:, :3], cells[:, 3:]
        return np.hstack([corners, corners + 2 * n, middles, middles + 2 * n, corners + n])
    offsets = np.array(HEXAHEDRON[: NODES_PER_CELL[_RAISED[plane]]])
    column = [_QUADRILATERAL.index((a, b)) for a, b in offsets[:, :2]]
    return cells[:, column] + n * (offsets[:, 2] // (3 - step))


def _in_layers(mesh: Mesh, own: IntArray, layers: int) -> IntArray:
    """Numbers of the solids over cells of a plane mesh: family by family, in each layer by layer."""
    found, first = [], 0
    for cells in mesh.cells.values():
        here = own[(first <= own) & (own < first + len(cells))] - first
        found.append(layers * first + (here + len(cells) * np.arange(layers)[:, None]).ravel())
        first += len(cells)
    return np.concatenate(found)


def _hexahedra(number: IntArray, step: int, count: int) -> IntArray:
    """Hexahedra (m, count) on a grid of node numbers."""
    grids = np.meshgrid(*(np.arange(0, size - 1, step) for size in number.shape), indexing="ij")
    i, j, k = (grid.ravel() for grid in grids)
    offsets = np.array(HEXAHEDRON[:count]) * step // 2
    return np.stack([number[i + a, j + b, k + c] for a, b, c in offsets], axis=1)


def _sides(mesh: Mesh) -> dict[str, IntArray]:
    (faces,) = make_facets(mesh).values()
    lowest, highest = mesh.points.min(axis=0), mesh.points.max(axis=0)
    sides = {}
    for axis, names in enumerate(SIDES):
        for name, value in zip(names, (lowest[axis], highest[axis]), strict=True):
            there: Array = (mesh.points[faces.nodes, axis] == value).all(axis=1)
            sides[name] = faces.nodes[there]
    return sides
