# SPDX-License-Identifier: BSD-3-Clause
"""Grids of points in the plane, and the mesh that several of them make."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.checks import choice, vector, whole
from signorini.errors import InputError, Where
from signorini.memory import check_memory
from signorini.meshing.facets import numbered_inside_out
from signorini.model.mesh import CORNERS, NODES_PER_CELL, NODES_PER_PLANE_CELL, Mesh

_PER_POINT = 350
"""Bytes: what making a mesh takes for a point of its grid, at least (a rectangle; a box takes 1000)."""

_QUADRATIC = {"quad": "quad8", "triangle": "triangle6"}


def check_grid(points: float, where: Where = ("mesh",)) -> None:
    """Refuse a grid that takes more memory than there is, before it is made.

    Raises
    ------
    InputError
        With its points and both sizes.
    """
    check_memory(_PER_POINT * points, f"a grid of {points:.3g} points", where)


def increasing(given: ArrayLike, where: Where, steps: int) -> Array:
    """Increasing coordinates, with those between them where a cell takes two steps of the grid.

    Parameters
    ----------
    given : (n,) as the user gives them, length
    where : what errors call the place
    steps : of the grid a cell

    Raises
    ------
    InputError
        If they are fewer than two or do not increase.
    """
    line = np.array(vector(given, where))
    if len(line) < 2 or (np.diff(line) <= 0).any():
        raise InputError("does not increase; expected two or more increasing coordinates", where=where)
    return subdivided(line, steps)


def subdivided(line: Array, steps: int) -> Array:
    """(steps (n - 1) + 1,) Numbers (n,), each way from one to the next cut in equal steps."""
    return np.interp(np.arange(steps * (len(line) - 1) + 1) / steps, np.arange(len(line)), line)


def cell_family(cells: str, order: int) -> str:
    """The family of cells of an order."""
    choice(cells, NODES_PER_PLANE_CELL, ("mesh", "cells"), "cells")
    if whole(order, ("mesh", "order")) > 2:
        raise InputError(f"is {order}; expected 1 or 2", where=("mesh", "order"))
    return _QUADRATIC.get(cells, cells) if order == 2 else cells


def grid_steps(family: str) -> int:
    """Steps of the grid along an edge of a cell."""
    return 1 if NODES_PER_CELL[family] == CORNERS[family] else 2


def mesh_of_grids(grids: list[Array], sides: Mapping[str, list[Array]], body: str, family: str) -> Mesh:
    """One mesh from grids whose common points coincide; quadratic cells take two steps of a grid.

    Parameters
    ----------
    grids : (a, b, 2) points
    sides : lines (n, 2) of their points by the names of boundaries
    body : its name
    family : of the cells
    """
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
            ends = [index[:-1], index[1:]] if grid_steps(family) == 1 else [index[:-2:2], index[2::2], index[1::2]]
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
    if grid_steps(family) == 1:
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
    n, inside_out = CORNERS[family], numbered_inside_out(points, family, cells)
    back = list(range(n))[::-1]
    if grid_steps(family) == 2:  # the edge k of the reversed cell is the edge n - 2 - k
        back += [n + k % n for k in range(n - 2, -2, -1)] + list(range(2 * n, NODES_PER_CELL[family]))
    return np.where(inside_out[:, None], cells[:, back], cells)


def growing_fractions(before: float, length: float, refine: int, *, growth: float, largest: float) -> Array:
    """Fractions 0 .. 1 of a length in steps that grow from the step before them up to a largest; each refined.

    Parameters
    ----------
    before : the step before the first, length
    length : to be divided
    refine : steps that each is cut into
    growth : from step to step
    largest : step, length
    """
    steps = [min(before * growth, largest)]
    while sum(steps) < length:
        steps.append(min(steps[-1] * growth, largest))
    if len(steps) > 1 and sum(steps) - length > 0.5 * steps[-1]:
        steps.pop()
    coarse = np.concatenate([[0.0], np.cumsum(steps)]) / sum(steps)
    return subdivided(coarse, refine)


def ruled(start: Array, end: Array, fractions: Array) -> Array:
    """Points (m, ..., 2) on straight lines from ``start`` (..., 2) to ``end``, at ``fractions`` (m,) of the way."""
    return start + np.multiply.outer(fractions, end - start)


def coons_patch(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """Coons patch between four curves, (up, along, 2), straight left and right allowed.

    Parameters
    ----------
    bottom, top : (n, 2) points, from left to right
    left, right : (m, 2) points, upwards
    """
    s = np.linspace(0.0, 1.0, len(bottom))[None, :, None]
    t = (np.linalg.norm(left - left[0], axis=1) / np.linalg.norm(left[-1] - left[0]))[:, None, None]
    corners = (1 - s) * (1 - t) * bottom[0] + s * (1 - t) * bottom[-1] + (1 - s) * t * top[0] + s * t * top[-1]
    patch: Array = (1 - t) * bottom + t * top + (1 - s) * left[:, None] + s * right[:, None] - corners
    return patch


def grid_sides(grid: Array) -> dict[str, list[Array]]:
    """The four sides of a grid, (n, 2) each, by their names."""
    return {"bottom": [grid[0]], "top": [grid[-1]], "left": [grid[:, 0]], "right": [grid[:, -1]]}
