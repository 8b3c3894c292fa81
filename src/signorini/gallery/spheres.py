# SPDX-License-Identifier: BSD-3-Clause
"""Whole spheres, not paraboloids: solid ones pressed on a plane or on another, and a hollow one in two parts."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.arrays import Array
from signorini.gallery.large_bodies import flip, graded_lines, quarter_supports, with_seat
from signorini.meshing.plane import Cells, target
from signorini.meshing.solid import extruded
from signorini.meshing.tetrahedra import tetrahedra
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Plane

RADIUS, MATERIAL = 50.0, Elastic(E=20000.0, nu=0.3)
"""Of the equal spheres."""

WALL = {"inner": 20.0, "outer": 40.0, "pressure": 25.0, "E": 2000.0, "nu": 0.3}
"""Of the hollow sphere, as :func:`signorini.reference.lame.hollow_sphere` takes it; it is cut in two at radius 30."""

_CAP = np.pi / 3.0  # of the sphere, from the pole: what the flat side of a cylinder of cells becomes


def hemisphere(*, radius: float, seat: float, n: int, cells: Cells = "quad") -> Mesh:
    """A quarter of the lower half of a sphere that touches z = 0 at the origin, fine where it touches.

    A cylinder of cells on rings, its flat side bent to a cap of the sphere and its wall to the rest.

    Parameters
    ----------
    radius : of the sphere, length
    seat : radius within which cells are small; their faces on the sphere are the boundary "seat"
    n : cells along half the side of the core, which is half as wide as the seat
    cells : "quad" (hexahedra of 8 nodes), "quad8" (20) or "quad9" (27)

    Returns
    -------
    mesh "disk" with the boundaries seat, start (y = 0), end (x = 0) and top (the equator)
    """
    core = 0.5 * seat
    spacing = 0.5 * core / n
    rings = core + graded_lines(seat - core, spacing, _CAP * radius - core, 1.3)[1:]
    mesh = extruded(target(radii=[core, *rings], n=n, cells=cells), z=graded_lines(2.0 * spacing, spacing, radius, 1.3))
    mesh = with_seat(mesh, "bottom", seat)
    boundaries = {name: mesh.boundaries[name] for name in ("start", "end", "top", "seat")}
    return replace(mesh, points=_rounded(mesh.points, radius), boundaries=boundaries)


def equal_spheres(*, approach: float, n: int = 4, other: int | None = None, cells: Cells = "quad") -> Model:
    """Two spheres, R = 50, E = 20000, nu = 0.3, whose equators approach: one on its plane of symmetry, or both.

    Parameters
    ----------
    approach : of the equators, both together, length; the seat is 1.3 times as wide as Hertz's contact
    n : see :func:`hemisphere`
    other : cells of the second sphere; None for one alone, which its plane of symmetry stands for
    cells : see :func:`hemisphere`
    """
    seat = 1.3 * float(np.sqrt(0.5 * RADIUS * approach))
    parts = {"upper": hemisphere(radius=RADIUS, seat=seat, n=n, cells=cells)}
    contact = Contact("upper.seat", Plane(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)), name="contact")
    if other is not None:
        parts["lower"] = flip(hemisphere(radius=RADIUS, seat=seat, n=other, cells=cells))
        contact = replace(contact, mortar="lower.seat")
    supports = []
    for name, moved in zip(parts, (-0.5 * approach, 0.5 * approach), strict=False):
        supports += quarter_supports(name)
        supports.append(Support(f"{name}.top", u=(None, None, moved)))
    return Model(
        join(parts),
        title="Two equal spheres",
        bodies=[Body(name, MATERIAL) for name in parts],
        supports=supports,
        contacts=[contact],
    )


def hollow_spheres(*, n: tuple[int, int], cells: Cells | Literal["tetra10"] = "quad8") -> Model:
    """An eighth of a hollow sphere of two parts, each of two layers, under a pressure inside: radii 20, 30 and 40.

    Parameters
    ----------
    n : cells along half an edge of an octant, of the inner and the outer part
    cells : "quad" (hexahedra of 8 nodes), "quad8" (20), "quad9" (27), or "tetra10", six to a hexahedron
    """
    middle = 0.5 * (WALL["inner"] + WALL["outer"])
    parts = {
        "inner": _octant(WALL["inner"], middle, n[0], cells),
        "outer": _octant(middle, WALL["outer"], n[1], cells),
    }
    supports = []
    for name in parts:
        supports += quarter_supports(name)
        supports.append(Support(f"{name}.outer", u=(None, None, 0.0)))
    return Model(
        join(parts),
        title="Hollow sphere in two parts",
        bodies=[Body(name, Elastic(E=WALL["E"], nu=WALL["nu"])) for name in parts],
        supports=supports,
        loads=[Load("inner.bottom", pressure=WALL["pressure"])],
        contacts=[Contact("inner.top", "outer.bottom", name="interface")],
    )


def _octant(inner: float, outer: float, n: int, cells: Cells | Literal["tetra10"]) -> Mesh:
    """An eighth of a shell between two radii: a quarter of a disk, its radius the angle from the z axis."""
    plane: Cells = "quad9" if cells == "tetra10" else cells
    disk = target(radii=np.linspace(0.45, 1.0, n + 1), n=n, cells=plane)
    mesh = extruded(disk, z=np.linspace(inner, outer, 3))
    if cells == "tetra10":
        mesh = tetrahedra(mesh)
    x, y, radius = mesh.points.T
    reach = np.hypot(x, y)
    polar = 0.5 * np.pi * reach
    turned = np.divide(np.sin(polar), reach, out=np.zeros_like(reach), where=reach > 0)
    height = np.where(reach > 1.0 - 1e-9, 0.0, np.cos(polar))
    return replace(mesh, points=radius[:, None] * np.column_stack([x * turned, y * turned, height]))


def _rounded(points: Array, radius: float) -> Array:
    """A cylinder of radius ``_CAP radius`` and height ``radius`` to half a sphere, between its four sides in (r, z)."""
    reach = np.hypot(*points.T[:2])
    s, t = reach / (_CAP * radius), points[:, 2] / radius

    def on_sphere(angle: Array) -> Array:
        return radius * np.stack([np.sin(angle), 1.0 - np.cos(angle)])

    bottom, wall = on_sphere(_CAP * s), on_sphere(_CAP + t * (0.5 * np.pi - _CAP))
    axis, top = radius * np.stack([0.0 * t, t]), radius * np.stack([s, np.ones_like(s)])
    corner, rim = on_sphere(np.array([_CAP])), radius * np.ones((2, 1))
    pole, centre = np.zeros((2, 1)), radius * np.array([[0.0], [1.0]])
    corners = (1 - s) * (1 - t) * pole + s * (1 - t) * corner + (1 - s) * t * centre + s * t * rim
    r, z = (1 - t) * bottom + t * top + (1 - s) * axis + s * wall - corners
    turned = np.divide(r, reach, out=np.zeros_like(r), where=reach > 0)
    return np.column_stack([points[:, :2] * turned[:, None], z])
