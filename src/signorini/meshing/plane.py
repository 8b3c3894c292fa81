# SPDX-License-Identifier: BSD-3-Clause
"""Small meshes with named boundaries: rectangle, quarter and half disk graded towards the contact, annulus."""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Mapping
from typing import Literal, NamedTuple, ParamSpec

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.checks import number, vector, whole
from signorini.errors import InputError
from signorini.meshing.grids import (
    cell_family,
    check_grid,
    coons_patch,
    grid_sides,
    grid_steps,
    growing_fractions,
    increasing,
    mesh_of_grids,
    ruled,
    subdivided,
)
from signorini.model.mesh import Mesh

Cells = Literal["quad", "triangle", "quad8", "quad9", "triangle6"]
Sizes = ParamSpec("Sizes")


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
    family = cell_family(cells, order)
    step, lines = grid_steps(family), []
    for key, given, size, count, start in (("x", x, width, nx, origin[0]), ("y", y, height, ny, origin[1])):
        if given is None:
            size = number(size, ("mesh", "width" if key == "x" else "height"), above=0.0)
            check_grid(step * whole(count, ("mesh", f"n{key}")), ("mesh", f"n{key}"))
            lines.append(subdivided(start + np.linspace(0.0, size, count + 1), step))
        else:
            lines.append(increasing(given, ("mesh", key), step))
    check_grid(math.prod(len(line) for line in lines))
    grid = np.stack(np.meshgrid(*lines, indexing="xy"), axis=-1)
    return mesh_of_grids([grid], grid_sides(grid), "block", family)


class _Quarter(NamedTuple):
    """A quarter disk.

    Attributes
    ----------
    family : of its cells
    grids : of their nodes, (m, n, 2) each, length
    sides : nodes of its boundaries by name
    """

    family: str
    grids: list[Array]
    sides: Mapping[str, list[Array]]


def _quarter(
    *,
    radius: float,
    contact_length: float,
    contact_spacing: float,
    refine: int = 1,
    cells: Cells = "quad",
    order: int = 1,
) -> _Quarter:
    """The quarter disk: grids along the contact, along the rest of the arc, and the core."""
    family = cell_family(cells, order)
    refine = whole(refine, ("mesh", "refine")) * grid_steps(family)
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
    rest = edge + (np.pi / 2 - edge) * growing_fractions(last, np.pi / 2 - edge, refine, growth=4.0, largest=np.pi / 4)
    depth = 0.35 * radius  # of the core, from the centre
    layers = growing_fractions(0.5 * spacing, radius - depth, refine, growth=1.4, largest=radius / 4)
    check_grid((len(fine) + len(rest)) * len(layers) + len(fine) * len(rest))
    centre = np.array([0.0, radius])

    def on_arc(angles: Array) -> Array:
        return centre + radius * np.column_stack([np.sin(angles), -np.cos(angles)])

    # the core: a quadrilateral, its corner on the ray through the end of the contact but never too flat
    turn = np.clip(edge, np.radians(30.0), np.radians(45.0))
    corner = centre + depth * np.array([np.sin(turn), -np.cos(turn)])
    below = ruled(centre - [0.0, depth], corner, (fine - fine[0]) / (fine[-1] - fine[0]))
    even = np.linspace(0.0, 1.0, len(rest))
    beside = ruled(corner, centre + [depth, 0.0], even)
    contact = ruled(on_arc(fine), below, layers)
    back = ruled(on_arc(rest), beside, layers)
    across = np.linspace(0.0, 1.0, len(fine))
    upper = ruled(centre, centre + [depth, 0.0], across)
    axis = ruled(centre - [0.0, depth], centre, even)
    core = coons_patch(below, upper, axis, beside)
    for grid in (contact, back, core):
        grid[np.abs(grid[..., 0]) < 1e-12 * radius, 0] = 0.0
        grid[np.abs(grid[..., 1] - radius) < 1e-12 * radius, 1] = radius
    contact[0, 0] = 0.0  # the arc touches the foundation exactly
    sides = {
        "arc": [contact[0], back[0]],
        "axis": [contact[:, 0], core[:, 0]],
        "cut": [back[:, -1], core[-1]],
    }
    return _Quarter(family, [contact, back, core], sides)


def _of(quarter: Callable[Sizes, _Quarter]) -> Callable[[Callable[[_Quarter], Mesh]], Callable[Sizes, Mesh]]:
    """What is made of a quarter disk as a function of its sizes, whose names and defaults stand once."""

    def with_sizes(make: Callable[[_Quarter], Mesh]) -> Callable[Sizes, Mesh]:
        @functools.wraps(make)
        def made(*sizes: Sizes.args, **named: Sizes.kwargs) -> Mesh:
            return make(quarter(*sizes, **named))

        signature = inspect.signature(quarter).replace(return_annotation="Mesh")
        setattr(made, "__signature__", signature)  # noqa: B010  # read by decks, and by help
        return made

    return with_sizes


@_of(_quarter)
def quarter_disk(quarter: _Quarter) -> Mesh:
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
    return mesh_of_grids(quarter.grids, quarter.sides, "disk", quarter.family)


@_of(_quarter)
def half_disk(quarter: _Quarter) -> Mesh:
    """The lower half "disk": a quarter disk and its mirror image, boundaries "arc" and "cut" (y = radius).

    Parameters
    ----------
    radius, contact_length, contact_spacing, refine, cells, order : see :func:`quarter_disk`; the contact length counts
        to either side

    Examples
    --------
    >>> half_disk(radius=8.0, contact_length=4.0, contact_spacing=0.5)
    Mesh(177 nodes, 152 quads; bodies: disk; boundaries: arc, cut)
    """
    family, grids, sides = quarter
    mirror = np.array([-1.0, 1.0])
    both = [*grids, *(grid[:, ::-1] * mirror for grid in grids)]
    lines = {
        name: [*parts, *(part[::-1] * mirror for part in parts)] for name, parts in sides.items() if name != "axis"
    }
    return mesh_of_grids(both, lines, "disk", family)


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
    family = cell_family(cells, order)
    step = grid_steps(family)
    around = whole(n_angular, ("mesh", "n_angular"), least=3 if full else 1)
    check_grid(step * around * step * whole(n_radial, ("mesh", "n_radial")))
    turns = np.radians(np.linspace(0.0, angle, step * around + 1))
    radii = np.linspace(inner, outer, step * whole(n_radial, ("mesh", "n_radial")) + 1)
    ray = np.column_stack([np.cos(turns), np.sin(turns)])
    ray[np.abs(ray) < 1e-15] = 0.0  # a sector that ends on an axis ends there exactly
    grid = np.array(centre) + ray[:, None, :] * radii[None, :, None]
    if full:
        grid[-1] = grid[0]
    sides = grid_sides(grid)
    named = {"inner": sides["left"], "outer": sides["right"]}
    if not full:
        named |= {"start": sides["bottom"], "end": sides["top"]}
    return mesh_of_grids([grid], named, "ring", family)


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
    family = cell_family(cells, order)
    step = grid_steps(family)
    check_grid(quarters * (step * whole(n, ("mesh", "n"))) * step * (n + 2 * len(given)), ("mesh", "n"))
    across = np.linspace(0.0, 1.0, step * n + 1)
    circles = subdivided(given, step)
    # a core whose corner is between that of a square and that of a circle keeps all angles away from 0 and 180 degrees
    side, corner = 0.5 * given[0] * np.eye(2), np.full(2, 0.4 * given[0])
    core = coons_patch(across[:, None] * side[0], ruled(side[1], corner, across), across[:, None] * side[1],
                        ruled(side[0], corner, across))  # fmt: skip
    rim = np.vstack([core[:, -1], core[-1, -2::-1]])
    turns = np.radians(np.linspace(0.0, 90.0, len(rim)))
    ray = np.column_stack([np.cos(turns), np.sin(turns)])
    inner = ruled(rim, given[0] * ray, across)
    rings = np.concatenate([inner, circles[1:, None, None] * ray])
    grids = [np.stack([c * g[..., 0] - s * g[..., 1], s * g[..., 0] + c * g[..., 1]], axis=-1)
             for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))[:quarters] for g in (core, rings)]  # fmt: skip
    for grid in grids:
        grid[np.abs(grid) < 1e-12 * given[-1]] = 0.0
    sides = {"outer": [grid[-1] for grid in grids[1::2]]}
    if quarters < 4:
        sides["start"] = [grids[0][0], grids[1][:, 0]]
        sides["end"] = [grids[-2][:, 0], grids[-1][:, -1]]
    return mesh_of_grids(grids, sides, "disk", family)
