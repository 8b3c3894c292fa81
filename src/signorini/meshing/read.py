# SPDX-License-Identifier: BSD-3-Clause
"""Meshes from files: Gmsh and whatever else meshio reads."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from pathlib import Path

import meshio
import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where, one_of
from signorini.meshing.files import open_mesh
from signorini.model.mesh import NODES_PER_CELL, NODES_PER_PLANE_CELL, NODES_PER_SOLID_CELL, Mesh

_LINES, _POINTS = ("line", "line3"), "vertex"
NAMED = "set:"
"""Before the name of a set, in arrays of 0 and 1 on cells or points."""

_OF_GMSH = "gmsh:"

_DIMENSIONS = ("point", "curve", "surface", "volume")

NODE_NUMBER = "number"
"""Array of the numbers of nodes, or of cells."""

_PLANE = 1e-9  # of the size: how far a plane mesh may leave its plane


def read_mesh(path: str | Path) -> Mesh:
    """Read a mesh; physical groups (or named cell sets) become bodies, boundaries and node sets.

    A mesh that holds solid cells is one in space: volumes become bodies, surfaces boundaries. Otherwise surfaces become
    bodies and curves boundaries. Points become node sets. A Gmsh file without physical groups has its elementary ones
    instead; groups without a name are called "surface 3", "curve 1", "point 7" by their tags. Cells without any form
    the body "body" if no cell has one. Nodes keep their order: number k of the file is index k - 1, unless an array
    ``number`` says otherwise. Arrays ``set:NAME`` of 0 and 1 name sets too (:mod:`signorini.meshing.write`).

    Parameters
    ----------
    path : any format that meshio reads, or a universal file (``.unv``); a plane mesh lies in a plane z = const. A
        geometry (``.geo``) is meshed first by Gmsh, if that is installed

    Raises
    ------
    InputError
        If the file is missing or unreadable, holds cells of a kind that this version does not have, or has no solid
        cells and is not plane.
    """
    path = Path(path)
    found, named, cells = _opened(path, ("mesh", "file"))
    points = np.asarray(found.points, float)
    if not len(points):
        raise InputError(f"'{path}' holds no nodes", where=("mesh", "file"))
    solid = any(family in NODES_PER_SOLID_CELL for family in cells)
    if points.shape[1] == 3 and not solid:
        if np.ptp(points[:, 2]) > _PLANE * max(np.ptp(points, axis=0).max(), 1e-300):
            raise InputError(f"'{path}' is not plane: z goes from {points[:, 2].min():g} to {points[:, 2].max():g}")
        points = points[:, :2]
    bulk = NODES_PER_SOLID_CELL if solid else NODES_PER_PLANE_CELL
    families = {family: np.vstack(blocks) for family, blocks in cells.items() if family in bulk}
    if not families:
        raise InputError(f"'{path}' holds no triangles or quadrilaterals; it has {', '.join(cells) or 'no cells'}")
    bodies, start = defaultdict(list), 0
    for family, nodes in families.items():
        for name, index in named[family].items():
            bodies[name].append(start + index)
        start += len(nodes)
    return Mesh(
        points=points,
        cells=families,
        bodies={name: np.concatenate(parts) for name, parts in bodies.items()} or {"body": np.arange(start)},
        boundaries=_boundaries(named, cells, solid=solid),
        nodes=_nodes(found, named, cells),
        node_numbers=found.point_data.get(NODE_NUMBER),
        cell_numbers=_cell_numbers(found, families),
    )


def read_facets(path: str | Path, dimension: int, name: str = "") -> tuple[Array, list[IntArray]] | None:
    """Edges (of dimension 1) or faces (2) of a file that holds nothing of more dimensions; None if it holds cells.

    Parameters
    ----------
    path : any format that :func:`read_mesh` reads
    name : of the facets, by default all

    Returns
    -------
    Points (n, 3), and for every number of nodes that the facets have the facets (m, k)

    Raises
    ------
    InputError
        If the file is missing or unreadable, there is no such name, or none is given where the file holds cells.
    """
    path = Path(path)
    found, named, cells = _opened(path, ("file",))
    wanted, higher = (_LINES, NODES_PER_CELL) if dimension == 1 else (NODES_PER_PLANE_CELL, NODES_PER_SOLID_CELL)
    known = {key for family in wanted for key in named[family]}
    if any(family in higher for family in cells):
        if name:
            return None
        raise InputError(f"is not given, but '{path}' holds cells too; it names {_listed(known)}", where=("boundary",))
    if name and name not in known:
        raise InputError(one_of(name, known, "boundary"), where=("boundary",))
    parts = {family: np.vstack(cells[family]) for family in wanted if family in cells}
    if not parts:
        what = "edges" if dimension == 1 else "triangles or quadrilaterals"
        raise InputError(f"'{path}' holds no {what}; it has {_listed(cells)}", where=("file",))
    if name:
        parts = {family: facets[named[family][name]] for family, facets in parts.items() if name in named[family]}
    points = np.asarray(found.points, float)
    return np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))]), list(parts.values())


def _opened(path: Path, where: Where) -> tuple[meshio.Mesh, dict[str, dict[str, IntArray]], dict[str, list[IntArray]]]:
    """What a file holds, see :func:`_named_parts` too."""
    try:
        found = open_mesh(path)
    except InputError as error:
        raise InputError(error.message, where=where) from error.__cause__
    return found, *_named_parts(found, path)


def _listed(names: Collection[str]) -> str:
    return ", ".join(sorted(names)) or "nothing"


def _nodes(
    found: meshio.Mesh, named: dict[str, dict[str, IntArray]], cells: dict[str, list[IntArray]]
) -> dict[str, IntArray]:
    """Node sets, from cells that are points, from sets of points and from arrays on points."""
    sets = {name: np.unique(np.vstack(cells[_POINTS])[index]) for name, index in named[_POINTS].items()}
    sets |= {name: np.unique(np.asarray(members, np.int64)) for name, members in found.point_sets.items()}
    for key, on in found.point_data.items():
        if key.startswith(NAMED):
            sets[key.removeprefix(NAMED)] = np.flatnonzero(on)
    return sets


def _cell_numbers(found: meshio.Mesh, families: Collection[str]) -> IntArray | None:
    """Numbers of the cells, family by family."""
    if NODE_NUMBER not in found.cell_data:
        return None
    numbers = found.cell_data[NODE_NUMBER]
    pairs = list(zip(found.cells, numbers, strict=True))
    return np.concatenate([part for family in families for block, part in pairs if block.type == family])


def _groups(found: meshio.Mesh) -> list[IntArray]:
    """Number of the group of every cell, 0 for none: physical groups of Gmsh, elementary ones where there are none."""
    for key in ("gmsh:physical", "gmsh:geometrical"):
        tags = found.cell_data.get(key)
        if tags is not None and any((part > 0).any() for part in tags):
            return list(tags)
    return [np.zeros(len(block.data), np.int64) for block in found.cells]


def _boundaries(
    named: dict[str, dict[str, IntArray]], cells: dict[str, list[IntArray]], *, solid: bool
) -> dict[str, tuple[IntArray, ...]]:
    """Facets by name, every kind apart; where edges with and without a middle node bear one name, the ends alone."""
    found: dict[str, tuple[IntArray, ...]] = defaultdict(tuple)
    for family in NODES_PER_PLANE_CELL if solid else _LINES:
        for name, index in named[family].items():
            found[name] = (*found[name], np.vstack(cells[family])[index])
    mixed = [] if solid else [name for name, parts in found.items() if len(parts) > 1]
    return found | {name: (np.vstack([part[:, :2] for part in found[name]]),) for name in mixed}


def _named_parts(found: meshio.Mesh, path: Path) -> tuple[dict[str, dict[str, IntArray]], dict[str, list[IntArray]]]:
    """Family to name to indices, and family to the blocks of cells that the indices count through."""
    tags = {(int(dimension), int(tag)): name for name, (tag, dimension) in found.field_data.items()}
    physical = _groups(found)
    named: dict[str, dict[str, list[IntArray]]] = defaultdict(lambda: defaultdict(list))
    cells: dict[str, list[IntArray]] = defaultdict(list)
    counts: dict[str, int] = defaultdict(int)
    for number, (block, tag_of_cell) in enumerate(zip(found.cells, physical, strict=True)):
        family = block.type
        if family not in (*NODES_PER_CELL, *_LINES, _POINTS):
            raise InputError(
                f"'{path}' holds {len(block.data)} cells of the kind '{family}'; this version has "
                f"{', '.join(NODES_PER_CELL)} (write a mesh of first or second order, of Gmsh with "
                "Mesh.SecondOrderIncomplete = 1)",
                where=("mesh", "file"),
            )
        index = counts[family] + np.arange(len(block.data))
        for tag in np.unique(tag_of_cell[tag_of_cell > 0]):
            name = tags.get((block.dim, int(tag)), f"{_DIMENSIONS[block.dim]} {tag}")
            if name not in found.cell_sets:  # of an entity in several groups sets name all, the tag only the first
                named[family][name].append(index[tag_of_cell == tag])
        for name, members in found.cell_sets.items():
            if name.startswith(_OF_GMSH):  # what entities of the geometry bound
                continue
            if members[number] is not None and len(members[number]):
                named[family][name].append(counts[family] + np.asarray(members[number], int))
        for key, on in found.cell_data.items():
            if key.startswith(NAMED) and on[number].any():
                named[family][key.removeprefix(NAMED)].append(counts[family] + np.flatnonzero(on[number]))
        cells[family].append(np.asarray(block.data, np.int64))
        counts[family] += len(block.data)
    parts = defaultdict(dict, {f: {n: np.concatenate(p) for n, p in own.items()} for f, own in named.items()})
    if "gmsh:physical" in found.cell_data:
        for family in cells:
            _merge(cells[family], parts[family])
    return parts, cells


def _merge(blocks: list[IntArray], named: dict[str, IntArray]) -> None:
    """Make one of cells that are written once for every group that they are in, as Gmsh 2 does; in place."""
    cells = np.vstack(blocks)
    factors = np.random.default_rng(0).integers(1, 2**62, cells.shape[1]) * 2 + 1
    _, first, twin = np.unique(cells @ factors, return_index=True, return_inverse=True)  # sums of products that wrap
    if len(first) == len(cells) or not np.array_equal(cells, cells[first[twin]]):
        return
    kept = np.sort(first)
    blocks[:] = [cells[kept]]
    for name, index in named.items():
        named[name] = np.unique(np.searchsorted(kept, first[twin[index]]))
