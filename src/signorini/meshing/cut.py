# SPDX-License-Identifier: BSD-3-Clause
"""Bodies cut along a section through them: the nodes there become two, on two boundaries that face each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.checks import vector
from signorini.errors import InputError, Where, one_of
from signorini.meshing.facets import CellFacets, facet_corners, facet_keys, make_facets, turned_facet
from signorini.model.mesh import Facets, Mesh

_PLANE_TOL = 1e-9  # of the size of the mesh: how far from a plane nodes lie in it
HALF_BELOW, HALF_ABOVE = ".below", ".above"
"""Behind the name of a section: the boundaries that it becomes."""


def cut(
    mesh: Mesh,
    section: str,
    *,
    body: str = "",
    point: Sequence[float] | None = None,
    normal: Sequence[float] | None = None,
    node: bool = True,
) -> Mesh:
    """The mesh with a body cut along a boundary inside it, and a node apart for what moves both halves.

    The boundary ``section`` gives way to ``section.below`` and ``section.above``, whose nodes are opposite each other
    in the order of their numbers, and to the node set ``section``: one node of no cell, in the middle of the section.
    Node sets hold both nodes where they held one.

    Parameters
    ----------
    mesh : with the boundary
    section : name of a boundary whose facets each lie between two cells, and which cuts the cells there apart
    body, point, normal : where the mesh has no such boundary: the facets of a body in the plane through a point (d,)
        with a normal (d,)
    node : whether to make the node apart

    Raises
    ------
    InputError
        If the boundary does not go through a body.

    Examples
    --------
    >>> from signorini.meshing.plane import rectangle
    >>> from dataclasses import replace
    >>> bar = rectangle(width=2.0, height=1.0, nx=2, ny=1)
    >>> cut(replace(bar, boundaries={"middle": [[1, 4]]}), "middle")
    Mesh(9 nodes, 2 quads; bodies: block; boundaries: middle.below, middle.above)
    """
    where: Where = ("mesh", "boundaries", section)
    facets = make_facets(mesh)
    if point is not None and normal is not None:
        drawn = _in_plane(mesh, facets, body, point, normal, where)
    elif section in mesh.boundaries:
        drawn = mesh.facets(section)
    else:
        raise InputError(one_of(section, mesh.boundaries, "boundary"), where=where)
    parts = _pairs(facets, mesh, drawn, where)
    _turn_alike(mesh, parts, where)
    nodes = np.unique(np.concatenate([part.nodes.ravel() for part in parts]))
    above = _above(mesh, facets, parts, nodes, where)
    twin = np.arange(len(mesh.points))
    twin[nodes] = len(mesh.points) + np.arange(len(nodes))
    cells, first = {}, 0
    for family, own in mesh.cells.items():
        moved = above[first : first + len(own)]
        cells[family] = np.where(moved[:, None], twin[own], own)
        first += len(own)
    boundaries: dict[str, Facets] = {
        name: tuple(_moved(own, facets, above, twin, mesh) for own in mesh.facets(name))
        for name in mesh.boundaries
        if name != section
    }
    boundaries[section + HALF_BELOW] = tuple(part.nodes for part in parts)
    boundaries[section + HALF_ABOVE] = tuple(twin[_turned(part.nodes, mesh.points.shape[1])] for part in parts)
    middle = mesh.points[nodes].mean(axis=0)[None, :] if node else np.empty((0, mesh.points.shape[1]))
    count = len(mesh.points) + len(nodes)
    twins = {name: twin[np.intersect1d(own, nodes)] for name, own in mesh.nodes.items()}
    sets = {name: np.union1d(own, twins[name]) for name, own in mesh.nodes.items()}
    labels = mesh.labels
    return Mesh(
        points=np.concatenate([mesh.points, mesh.points[nodes], middle]),
        cells=cells,
        bodies=mesh.bodies,
        boundaries=boundaries,
        nodes=sets | ({section: np.array([count])} if node else {}),
        node_numbers=np.concatenate([labels, labels.max() + 1 + np.arange(len(nodes) + len(middle))]),
        cell_numbers=mesh.cell_numbers,
        cell_word=mesh.cell_word,
    )


def section_normal(mesh: Mesh, section: str) -> Array:
    """Mean of the unit normals of the facets of a section, (d,), from its half below to the one above, as in CalculiX.

    Parameters
    ----------
    mesh : which :func:`cut` has made
    section : its name

    Raises
    ------
    InputError
        If the mesh is not cut there.
    """
    if section + HALF_BELOW not in mesh.boundaries:
        raise InputError(
            f"'{section}' is no section along which the mesh is cut; expected signorini.cut(mesh, '{section}'), of a "
            "boundary inside a body"
        )
    areas = np.concatenate([facet_areas(mesh, own) for own in mesh.facets(section + HALF_BELOW)])
    total = (areas / np.linalg.norm(areas, axis=1, keepdims=True)).sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Pairs:
    """Facets of a section with one number of nodes, outward of the cells on one side.

    Attributes
    ----------
    nodes : (m, k)
    cells : (m, 2) the cell that they are outward of, and the other
    key : (m,) as of all facets
    """

    nodes: IntArray
    cells: IntArray
    key: IntArray


def _in_plane(
    mesh: Mesh,
    facets: dict[int, CellFacets],
    body: str,
    point: Sequence[float],
    normal: Sequence[float],
    where: Where,
) -> tuple[IntArray, ...]:
    """The facets of a body in a plane, between two of its cells, by the number of their nodes."""
    if body not in mesh.bodies:
        raise InputError(one_of(body, mesh.bodies, "body"), where=(*where, "body"))
    d = mesh.points.shape[1]
    at, way = np.array(vector(point, ("point",), dimension=d)), np.array(vector(normal, ("normal",), dimension=d))
    if not way.any():
        raise InputError("is zero; expected a direction", where=("normal",))
    distance = (mesh.points - at) @ (way / np.linalg.norm(way))
    on = np.abs(distance) <= _PLANE_TOL * float(np.ptp(mesh.points, axis=0).max())
    inside = np.zeros(mesh.number_of_cells, bool)
    inside[mesh.bodies[body]] = True
    found = []
    for every in facets.values():
        same = np.flatnonzero(every.key[1:] == every.key[:-1])
        kept = on[every.nodes[same]].all(axis=1) & inside[every.cell[same]] & inside[every.cell[same + 1]]
        if kept.any():
            found.append(every.nodes[same[kept]])
    if not found:
        raise InputError(f"no facet of '{body}' lies in the plane; expected one between its cells", where=("point",))
    return tuple(found)


def _pairs(facets: dict[int, CellFacets], mesh: Mesh, given: tuple[IntArray, ...], where: Where) -> list[_Pairs]:
    """The facets of the section with both their cells."""
    found, d = [], mesh.points.shape[1]
    for own in given:
        corners = facet_corners(d, own.shape[1])
        wanted = np.unique(facet_keys(own[:, :corners], len(mesh.points)))
        left = len(wanted)
        for count, every in facets.items():
            if facet_corners(d, count) != corners:
                continue
            start = np.searchsorted(every.key, wanted)
            twice = np.searchsorted(every.key, wanted, side="right") - start == 2
            start = start[twice]
            left -= len(start)
            if len(start):
                cells = np.column_stack([every.cell[start], every.cell[start + 1]])
                found.append(_Pairs(nodes=every.nodes[start], cells=cells, key=every.key[start]))
        if left:
            raise InputError(
                f"has {left} facets that do not lie between two cells; expected a section inside a body", where=where
            )
    if not found:
        raise InputError("is empty; expected a section inside a body", where=where)
    return found


def _turn_alike(mesh: Mesh, parts: list[_Pairs], where: Where) -> None:
    """Turn all facets to one side."""
    reference = facet_areas(mesh, parts[0].nodes)[0]
    for _ in range(2):  # about the first facet, then about the mean
        total = np.zeros(mesh.points.shape[1])
        for i, part in enumerate(parts):
            areas = facet_areas(mesh, part.nodes)
            back = areas @ reference < 0.0
            nodes = np.where(back[:, None], _turned(part.nodes, len(total)), part.nodes)
            parts[i] = _Pairs(nodes=nodes, cells=np.where(back[:, None], part.cells[:, ::-1], part.cells), key=part.key)
            total += np.where(back[:, None], -areas, areas).sum(axis=0)
        reference = total
    if any((facet_areas(mesh, part.nodes) @ reference <= 0.0).any() for part in parts):
        raise InputError("turns by a right angle or more; expected a section across a body", where=where)


def facet_areas(mesh: Mesh, nodes: IntArray) -> Array:
    """Normals of facets (m, k) times their sizes, (m, d), of the pieces between their corners."""
    d = mesh.points.shape[1]
    at = mesh.points[nodes[:, : facet_corners(d, nodes.shape[1])]]
    if d == 2:
        along = at[:, 1] - at[:, 0]
        return np.column_stack([along[:, 1], -along[:, 0]])
    areas: Array = 0.5 * np.cross(at[:, 2] - at[:, 0], at[:, -1] - at[:, 1])
    return areas


def _turned(nodes: IntArray, dimension: int) -> IntArray:
    """Facets run through the other way round."""
    corners = facet_corners(dimension, nodes.shape[1])
    return nodes[:, turned_facet(corners, nodes.shape[1])]


def _above(
    mesh: Mesh,
    facets: dict[int, CellFacets],
    parts: list[_Pairs],
    nodes: IntArray,
    where: Where,
) -> BoolArray:
    """(m,) Cells whose nodes on the section become new ones: those that hang together with the cells above it."""
    import scipy.sparse as sp  # takes longer to load than a deck without bolts to read
    from scipy.sparse.csgraph import connected_components

    on = np.zeros(len(mesh.points), bool)
    on[nodes] = True
    near = np.concatenate([on[given].any(axis=1) for given in mesh.cells.values()])
    cuts = np.concatenate([part.key for part in parts])
    rows, columns = [], []
    for every in facets.values():
        same = np.flatnonzero(every.key[1:] == every.key[:-1])
        one, other = every.cell[same], every.cell[same + 1]
        kept = near[one] & near[other] & ~np.isin(every.key[same], cuts)
        rows.append(one[kept])
        columns.append(other[kept])
    i, j = np.concatenate(rows), np.concatenate(columns)
    links = sp.coo_array((np.ones(len(i)), (i, j)), shape=(len(near), len(near)))
    group = connected_components(links, directed=False)[1]
    low, high = (np.unique(group[np.concatenate([part.cells[:, side] for part in parts])]) for side in (0, 1))
    both = np.intersect1d(low, high)
    if len(both):
        raise InputError(
            "does not cut the body apart: around its rim cells of both sides hang together; expected it to go through "
            "the whole body",
            where=where,
        )
    return np.asarray(near & np.isin(group, high))


def _moved(own: IntArray, facets: dict[int, CellFacets], above: BoolArray, twin: IntArray, mesh: Mesh) -> IntArray:
    """Facets of another boundary, with the new nodes where their cells have them."""
    d = mesh.points.shape[1]
    corners = facet_corners(d, own.shape[1])
    key = facet_keys(own[:, :corners], len(mesh.points))
    up = np.zeros(len(own), bool)
    for count, every in facets.items():
        if facet_corners(d, count) == corners and len(every.key):
            at = np.minimum(np.searchsorted(every.key, key), len(every.key) - 1)
            up |= (every.key[at] == key) & above[every.cell[at]]
    return np.where(up[:, None], twin[own], own)
