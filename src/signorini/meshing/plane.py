# SPDX-License-Identifier: BSD-3-Clause
"""Small meshes with named boundaries: rectangle, quarter and half disk graded towards the contact, annulus."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.checks import choice, number, vector, whole
from signorini.errors import InputError, Where
from signorini.memory import check_memory
from signorini.model.mesh import CORNERS, NODES_PER_CELL, NODES_PER_PLANE_CELL, Mesh

Cells = Literal["quad", "triangle", "quad8", "quad9", "triangle6"]
_PER_POINT = 350
"""Bytes: what making a mesh takes for a point of its grid, at least (a rectangle; a box takes 1000)."""

_QUADRATIC = {"quad": "quad8", "triangle": "triangle6"}


def rectangle(
    *,
    width: float = 1.0,
    height: float = 1.0,
    nx: int = 1,
    ny: int = 1,
    origin: tuple[float, float] = (0.0, 0.0),
    x: ArrayLike | None = None,
    y: ArrayLike | None = None,
    cells: Cells = "quad",
    order: int = 1,
) -> Mesh:
    """A rectangle "block" with the boundaries left, right, bottom and top.

    Parameters
    ----------
    width, height : sizes, length
    nx, ny : numbers of cells
    origin : lower left corner, length
    x, y : instead of sizes and numbers, the increasing coordinates of the grid lines, length
    cells : "quad", or "triangle" (every quadrilateral cut in two), or a quadratic family: "quad8", "quad9", "triangle6"
    order : 2 takes "quad8" for "quad" and "triangle6" for "triangle"

    Examples
    --------
    >>> rectangle(width=2, height=1, nx=4, ny=2)
    Mesh(15 nodes, 8 quads; bodies: block; boundaries: bottom, top, left, right)
    """
    family = _family(cells, order)
    step, lines = _step(family), []
    for key, given, size, count, start in (("x", x, width, nx, origin[0]), ("y", y, height, ny, origin[1])):
        if given is None:
            size = number(size, ("mesh", "width" if key == "x" else "height"), above=0.0)
            check_grid(step * whole(count, ("mesh", f"n{key}")), ("mesh", f"n{key}"))
            lines.append(start + np.linspace(0.0, size, count + 1))
        else:
            lines.append(np.array(vector(given, ("mesh", key))))
            if len(lines[-1]) < 2 or (np.diff(lines[-1]) <= 0).any():
                raise InputError("does not increase; expected two or more increasing coordinates", where=("mesh", key))
    check_grid(math.prod(step * len(line) for line in lines))
    lines = [np.interp(np.arange(step * (len(line) - 1) + 1) / step, np.arange(len(line)), line) for line in lines]
    grid = np.stack(np.meshgrid(*lines, indexing="xy"), axis=-1)
    return _assemble([grid], _sides(grid), "block", family)


def quarter_disk(
    *,
    radius: float,
    contact_length: float,
    contact_spacing: float,
    refine: int = 1,
    cells: Cells = "quad",
    order: int = 1,
) -> Mesh:
    """A quarter "disk" that touches the x axis at the origin: centre (0, radius), x >= 0, y <= radius.

    Boundaries: "arc" (the circle), "axis" (x = 0), "cut" (y = radius). An O-grid: equal steps along x up to
    ``contact_length``, growing ones behind it, layers that grow from the arc inwards. With radius 8, contact length 4
    and spacing 0.5 it has the size of the paper's mesh: 8 contact elements, 76 cells.

    Parameters
    ----------
    radius : length
    contact_length : part of the arc, measured along x, with equal steps; at most 0.7 radius
    contact_spacing : the step, length; the contact length is a whole number of steps
    refine : every edge of the grid is divided by it
    cells, order : as in :func:`rectangle`; middle nodes of a quadratic cell are on the circle

    Examples
    --------
    >>> quarter_disk(radius=8.0, contact_length=4.0, contact_spacing=0.5)
    Mesh(93 nodes, 76 quads; bodies: disk; boundaries: arc, axis, cut)
    """
    family = _family(cells, order)
    refine = whole(refine, ("mesh", "refine")) * _step(family)
    grids, sides = _quarter(radius, contact_length, contact_spacing, refine)
    return _assemble(grids, sides, "disk", family)


def half_disk(
    *,
    radius: float,
    contact_length: float,
    contact_spacing: float,
    refine: int = 1,
    cells: Cells = "quad",
    order: int = 1,
) -> Mesh:
    """The lower half "disk": a quarter disk and its mirror image, boundaries "arc" and "cut" (y = radius).

    Parameters as :func:`quarter_disk`; the contact length counts to either side.

    Examples
    --------
    >>> half_disk(radius=8.0, contact_length=4.0, contact_spacing=0.5)
    Mesh(177 nodes, 152 quads; bodies: disk; boundaries: arc, cut)
    """
    family = _family(cells, order)
    refine = whole(refine, ("mesh", "refine")) * _step(family)
    grids, sides = _quarter(radius, contact_length, contact_spacing, refine)
    mirror = np.array([-1.0, 1.0])
    both = [*grids, *(grid[:, ::-1] * mirror for grid in grids)]
    lines = {
        name: [*parts, *(part[::-1] * mirror for part in parts)] for name, parts in sides.items() if name != "axis"
    }
    return _assemble(both, lines, "disk", family)


def annulus(
    *,
    inner: float,
    outer: float,
    n_radial: int,
    n_angular: int,
    angle: float = 360.0,
    centre: tuple[float, float] = (0.0, 0.0),
    cells: Cells = "quad",
    order: int = 1,
) -> Mesh:
    """A "ring" or a sector of one, from the x axis counterclockwise: boundaries "inner", "outer", "start", "end".

    Parameters
    ----------
    inner, outer : radii, length, 0 < inner < outer
    n_radial, n_angular : numbers of cells
    angle : of the sector, degrees, up to 360; a full ring has neither start nor end
    centre : length
    cells, order : as in :func:`rectangle`; middle nodes of a quadratic cell are on the circle

    Examples
    --------
    >>> annulus(inner=1, outer=2, n_radial=2, n_angular=8)
    Mesh(24 nodes, 16 quads; bodies: ring; boundaries: inner, outer)
    """
    inner = number(inner, ("mesh", "inner"), above=0.0)
    outer = number(outer, ("mesh", "outer"), above=inner)
    angle = number(angle, ("mesh", "angle"), above=0.0)
    if angle > 360.0:
        raise InputError(f"is {angle:g}; expected at most 360 degrees", where=("mesh", "angle"))
    full = angle == 360.0
    family = _family(cells, order)
    step = _step(family)
    around = whole(n_angular, ("mesh", "n_angular"), least=3 if full else 1)
    check_grid(step * around * step * whole(n_radial, ("mesh", "n_radial")))
    turns = np.radians(np.linspace(0.0, angle, step * around + 1))
    radii = np.linspace(inner, outer, step * whole(n_radial, ("mesh", "n_radial")) + 1)
    ray = np.column_stack([np.cos(turns), np.sin(turns)])
    ray[np.abs(ray) < 1e-15] = 0.0  # a sector that ends on an axis ends there exactly
    grid = np.array(centre) + ray[:, None, :] * radii[None, :, None]
    if full:
        grid[-1] = grid[0]
    sides = _sides(grid)
    named = {"inner": sides["left"], "outer": sides["right"]}
    if not full:
        named |= {"start": sides["bottom"], "end": sides["top"]}
    return _assemble([grid], named, "ring", family)


def target(*, radii: ArrayLike, n: int, angle: float = 90.0, cells: Cells = "quad", order: int = 1) -> Mesh:
    """A "disk" about the origin, or a quarter or half of it, of rings about a core of cells, fine at its centre.

    Boundaries: outer; of a quarter and a half also start (on the ray at angle 0) and end (on the ray at ``angle``).

    Parameters
    ----------
    radii : increasing radii of circles of nodes, length; within the first is the core
    n : cells along half a side of the core, and from the core to the first circle; 2 n cells go round a quarter
    angle : 90, 180 or 360 degrees
    cells, order : as in :func:`rectangle`; middle nodes of a quadratic cell are on the circle

    Raises
    ------
    InputError
        If radii do not increase from above 0, or the angle is another.

    Examples
    --------
    >>> target(radii=[1.0, 2.0], n=1)
    Mesh(10 nodes, 5 quads; bodies: disk; boundaries: outer, start, end)
    """
    given = np.array(vector(radii, ("mesh", "radii")))
    if (np.diff(given, prepend=0.0) <= 0.0).any():
        raise InputError("do not increase from above 0; expected increasing radii", where=("mesh", "radii"))
    quarters = {90.0: 1, 180.0: 2, 360.0: 4}.get(number(angle, ("mesh", "angle")))
    if quarters is None:
        raise InputError(f"is {angle:g}; expected 90, 180 or 360 degrees", where=("mesh", "angle"))
    family = _family(cells, order)
    step = _step(family)
    check_grid(quarters * (step * whole(n, ("mesh", "n"))) * step * (n + 2 * len(given)), ("mesh", "n"))
    across = np.linspace(0.0, 1.0, step * n + 1)
    circles = np.interp(np.arange(step * (len(given) - 1) + 1) / step, np.arange(len(given)), given)
    # a core whose corner is between that of a square and that of a circle keeps all angles away from 0 and 180 degrees
    side, corner = 0.5 * given[0] * np.eye(2), np.full(2, 0.4 * given[0])
    core = _transfinite(across[:, None] * side[0], _line(side[1], corner, across), across[:, None] * side[1],
                        _line(side[0], corner, across))  # fmt: skip
    rim = np.vstack([core[:, -1], core[-1, -2::-1]])
    turns = np.radians(np.linspace(0.0, 90.0, len(rim)))
    ray = np.column_stack([np.cos(turns), np.sin(turns)])
    inner = _between(rim, given[0] * ray, across)
    rings = np.concatenate([inner, circles[1:, None, None] * ray])
    grids = [np.stack([c * g[..., 0] - s * g[..., 1], s * g[..., 0] + c * g[..., 1]], axis=-1)
             for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))[:quarters] for g in (core, rings)]  # fmt: skip
    for grid in grids:
        grid[np.abs(grid) < 1e-12 * given[-1]] = 0.0
    sides = {"outer": [grid[-1] for grid in grids[1::2]]}
    if quarters < 4:
        sides["start"] = [grids[0][0], grids[1][:, 0]]
        sides["end"] = [grids[-2][:, 0], grids[-1][:, -1]]
    return _assemble(grids, sides, "disk", family)


def _quarter(
    radius: float, contact_length: float, contact_spacing: float, refine: int
) -> tuple[list[Array], Mapping[str, list[Array]]]:
    """Grids and sides of the quarter disk: along the contact, along the rest of the arc, and the core."""
    radius = number(radius, ("mesh", "radius"), above=0.0)
    length = number(contact_length, ("mesh", "contact_length"), above=0.0)
    spacing = number(contact_spacing, ("mesh", "contact_spacing"), above=0.0)
    if length > 0.7 * radius:
        raise InputError(
            f"is {length:g}; expected at most 0.7 radius = {0.7 * radius:g}", where=("mesh", "contact_length")
        )
    check_grid(length / spacing * refine**2)
    steps = round(length / spacing)
    if steps < 1 or abs(steps * spacing - length) > 1e-9 * length:
        raise InputError(
            f"is {spacing:g}; expected a whole number of steps in the contact length {length:g}",
            where=("mesh", "contact_spacing"),
        )
    edge = np.arcsin(length / radius)
    fine = np.arcsin(np.linspace(0.0, length, steps * refine + 1) / radius)
    fine[-1] = edge
    last = edge - np.arcsin((length - spacing) / radius)
    rest = edge + (np.pi / 2 - edge) * _growing(last, np.pi / 2 - edge, refine, growth=4.0, largest=np.pi / 4)
    depth = 0.35 * radius  # of the core, from the centre
    layers = _growing(0.5 * spacing, radius - depth, refine, growth=1.4, largest=radius / 4)
    check_grid((len(fine) + len(rest)) * len(layers) + len(fine) * len(rest))
    centre = np.array([0.0, radius])

    def on_arc(angles: Array) -> Array:
        return centre + radius * np.column_stack([np.sin(angles), -np.cos(angles)])

    # the core: a quadrilateral, its corner on the ray through the end of the contact but never too flat
    turn = np.clip(edge, np.radians(30.0), np.radians(45.0))
    corner = centre + depth * np.array([np.sin(turn), -np.cos(turn)])
    below = _line(centre - [0.0, depth], corner, (fine - fine[0]) / (fine[-1] - fine[0]))
    even = np.linspace(0.0, 1.0, len(rest))
    beside = _line(corner, centre + [depth, 0.0], even)
    contact = _between(on_arc(fine), below, layers)
    back = _between(on_arc(rest), beside, layers)
    across = np.linspace(0.0, 1.0, len(fine))
    upper = _line(centre, centre + [depth, 0.0], across)
    axis = _line(centre - [0.0, depth], centre, even)
    core = _transfinite(below, upper, axis, beside)
    for grid in (contact, back, core):
        grid[np.abs(grid[..., 0]) < 1e-12 * radius, 0] = 0.0
        grid[np.abs(grid[..., 1] - radius) < 1e-12 * radius, 1] = radius
    contact[0, 0] = 0.0  # the arc touches the foundation exactly
    sides = {
        "arc": [contact[0], back[0]],
        "axis": [contact[:, 0], core[:, 0]],
        "cut": [back[:, -1], core[-1]],
    }
    return [contact, back, core], sides


def _growing(before: float, length: float, refine: int, *, growth: float, largest: float) -> Array:
    """Fractions 0 .. 1 of a length in steps that grow from the step before them up to a largest; each refined."""
    steps = [min(before * growth, largest)]
    while sum(steps) < length:
        steps.append(min(steps[-1] * growth, largest))
    if len(steps) > 1 and sum(steps) - length > 0.5 * steps[-1]:
        steps.pop()
    coarse = np.concatenate([[0.0], np.cumsum(steps)]) / sum(steps)
    fractions: Array = np.interp(np.arange(len(steps) * refine + 1) / refine, np.arange(len(coarse)), coarse)
    return fractions


def _line(start: Array, end: Array, fractions: Array) -> Array:
    return np.asarray(start) + (np.asarray(end) - np.asarray(start)) * fractions[:, None]


def _between(outer: Array, inner: Array, fractions: Array) -> Array:
    """Straight lines from one curve to another, (layers, along, 2)."""
    grid: Array = outer + (inner - outer) * fractions[:, None, None]
    return grid


def _transfinite(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """Coons patch between four curves, (up, along, 2), straight left and right allowed."""
    s = np.linspace(0.0, 1.0, len(bottom))[None, :, None]
    t = (np.linalg.norm(left - left[0], axis=1) / np.linalg.norm(left[-1] - left[0]))[:, None, None]
    corners = (1 - s) * (1 - t) * bottom[0] + s * (1 - t) * bottom[-1] + (1 - s) * t * top[0] + s * t * top[-1]
    patch: Array = (1 - t) * bottom + t * top + (1 - s) * left[:, None] + s * right[:, None] - corners
    return patch


def _sides(grid: Array) -> dict[str, list[Array]]:
    return {"bottom": [grid[0]], "top": [grid[-1]], "left": [grid[:, 0]], "right": [grid[:, -1]]}


def check_grid(points: float, where: Where = ("mesh",)) -> None:
    """Refuse a grid that takes more memory than there is, before it is made.

    Raises
    ------
    InputError
        With its points and both sizes.
    """
    check_memory(_PER_POINT * points, f"a grid of {points:.3g} points", where)


def _family(cells: str, order: int) -> str:
    """The family of cells of an order."""
    choice(cells, NODES_PER_PLANE_CELL, ("mesh", "cells"), "cells")
    if whole(order, ("mesh", "order")) > 2:
        raise InputError(f"is {order}; expected 1 or 2", where=("mesh", "order"))
    return _QUADRATIC.get(cells, cells) if order == 2 else cells


def _step(family: str) -> int:
    """Steps of the grid along an edge of a cell."""
    return 1 if NODES_PER_CELL[family] == CORNERS[family] else 2


def _assemble(grids: list[Array], sides: Mapping[str, list[Array]], body: str, family: str) -> Mesh:
    """One mesh from grids whose common points coincide; quadratic cells take two steps of a grid."""
    lines = [line for parts in sides.values() for line in parts]
    every = np.vstack([grid.reshape(-1, 2) for grid in grids] + lines)
    unit = 1e-9 * np.ptp(every, axis=0).max()
    _, first, number_of = np.unique(np.round(every / unit), axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # nodes are numbered as they first appear
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    number_of = rank[number_of.ravel()]
    points = every[first[order]]
    found, start = [], 0
    for grid in grids:
        index = number_of[start : start + grid[..., 0].size].reshape(grid.shape[:2])
        start += index.size
        found.append(_cells_of(index, family))
    cells = _counterclockwise(points, np.vstack(found), family)
    boundaries = {}
    for name, parts in sides.items():
        facets = []
        for line in parts:
            index = number_of[start : start + len(line)]
            start += len(line)
            ends = [index[:-1], index[1:]] if _step(family) == 1 else [index[:-2:2], index[2::2], index[1::2]]
            facets.append(np.column_stack(ends))
        boundaries[name] = np.vstack(facets)
    used, compact = np.unique(cells, return_inverse=True)  # "quad8" has no nodes inside
    return Mesh(
        points=points[used],
        cells={family: compact.reshape(cells.shape)},
        bodies={body: np.arange(len(cells))},
        boundaries={name: np.searchsorted(used, facets) for name, facets in boundaries.items()},
    )


def _cells_of(index: IntArray, family: str) -> IntArray:
    """Cells on a grid of node numbers."""
    if _step(family) == 1:
        corners = (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
        nodes = np.stack([c.ravel() for c in corners], axis=1)
        return np.vstack([nodes[:, [0, 1, 2]], nodes[:, [0, 2, 3]]]) if family == "triangle" else nodes
    ways = ((0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0), (1, 1))
    rows, columns = (size - 2 for size in index.shape)
    nodes = np.stack([index[i : i + rows : 2, j : j + columns : 2].ravel() for i, j in ways], axis=1)
    if family == "triangle6":
        return np.vstack([nodes[:, [0, 1, 2, 4, 5, 8]], nodes[:, [0, 2, 3, 8, 6, 7]]])
    return nodes[:, : NODES_PER_CELL[family]]


def _counterclockwise(points: Array, cells: IntArray, family: str) -> IntArray:
    n = CORNERS[family]
    corners = points[cells[:, :n]]
    x, y = corners[..., 0], corners[..., 1]
    area = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    back = list(range(n))[::-1]
    if _step(family) == 2:  # the edge k of the reversed cell is the edge n - 2 - k
        back += [n + k % n for k in range(n - 2, -2, -1)] + list(range(2 * n, NODES_PER_CELL[family]))
    return np.where(area[:, None] < 0, cells[:, back], cells)
