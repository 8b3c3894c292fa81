# SPDX-License-Identifier: BSD-3-Clause
"""Contact problems on meshes to begin with, which are refined to an accuracy."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.arrays import Array
from signorini.meshing.plane import half_disk, quarter_disk, rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Circle, Plane, Profile, Sphere
from signorini.model.rigid import Rigid

Cells = Literal["triangle", "quad"]

SOFT = Elastic(E=200.0, nu=0.3)
PLANE_MODULUS = SOFT.E / (1.0 - SOFT.nu**2)
"""``E / (1 - nu^2)`` of that."""

_HALVES = Support("left", u=(0.0, None))


def hertz_line(friction: float = 0.0, *, cells: Cells = "triangle", order: int = 2) -> Model:
    """Half of a block on a rigid circle of radius 200 that it touches on a half-width of 1, a twentieth of its own.

    Parameters
    ----------
    friction : coefficient
    cells, order : family of the cells, linear or quadratic
    """
    lines = np.linspace(0.0, 20.0, 9)
    return Model(
        rectangle(x=lines, y=lines, cells=cells, order=order),
        bodies=[Body("block", SOFT)],
        supports=[_HALVES],
        loads=[Load("top", force=(None, -np.pi * PLANE_MODULUS / 1600.0))],
        contacts=[Contact("bottom", Circle((0.0, -200.0), 200.0), friction=friction, name="seat")],
        title="Hertz, line contact",
    )


def cylinder(friction: float = 0.4, *, cells: Cells = "triangle", order: int = 2) -> Model:
    """The paper's cylinder on a rigid plane, a quarter of a disk, with four corners on the arc.

    Parameters
    ----------
    friction : coefficient
    cells, order : family of the cells, linear or quadratic
    """
    return Model(
        quarter_disk(radius=8.0, contact_length=4.0, contact_spacing=2.0, cells=cells, order=order),
        bodies=[Body("disk", SOFT)],
        supports=[Support("axis", u=(0.0, None))],
        loads=[Load("cut", force=(None, -78.0))],
        contacts=[Contact("arc", Plane((0.0, 0.0), (0.0, 1.0)), friction=friction, name="seat")],
        title="The cylinder of the paper",
    )


def two_cylinders(friction: float = 0.3) -> Model:
    """Halves of two disks of other radii and materials, whose meshes do not match, pressed together."""
    upper, lower = (
        half_disk(radius=radius, contact_length=3.0, contact_spacing=spacing, cells="triangle", order=2)
        for radius, spacing in ((8.0, 1.5), (12.0, 1.0))
    )
    return Model(
        join({"upper": upper, "lower": _moved(lower, np.array([1.0, -1.0]))}),
        bodies=[Body("upper", SOFT), Body("lower", Elastic(E=70.0, nu=0.33))],
        supports=[Support("lower.cut", u=(0.0, 0.0)), Support("upper.cut", u=(0.0, -0.5))],
        contacts=[Contact("upper.arc", "lower.arc", friction=friction, name="seat")],
        title="Two cylinders",
    )


def rounded_punch(friction: float = 0.3) -> Model:
    """A punch of half-width 4 with edges of radius 1, pressed 0.02 into half of a block."""
    lines = np.linspace(0.0, 20.0, 9)
    return Model(
        _moved(rectangle(x=lines, y=lines, cells="triangle", order=2), np.ones(2), np.array([0.0, -20.0])),
        bodies=[Body("block", SOFT)],
        supports=[_HALVES, Support("bottom", u=(0.0, 0.0))],
        contacts=[
            Contact(
                "top", Profile(((4, 6), (4, -0.02), (-4, -0.02), (-4, 6)), fillet=1.0), friction=friction, name="seat"
            )
        ],
        title="A rounded punch",
    )


def flat_punch(friction: float = 0.3) -> Model:
    """A block whose middle, a half-width of 1, stands on a rigid plane: its pressure has no limit at the edges."""
    lines = np.array([0.0, 1.0, 2.0, 4.0, 8.0, 14.0, 20.0])
    mesh = rectangle(x=lines, y=lines, cells="triangle", order=2)
    (edges,) = mesh.facets("bottom")
    seat = edges[mesh.points[edges[:, :2], 0].max(axis=1) <= 1.0]
    return Model(
        replace(mesh, boundaries={**mesh.boundaries, "bottom": seat}),
        bodies=[Body("block", SOFT)],
        supports=[_HALVES],
        loads=[Load("top", force=(None, -1.0))],
        contacts=[Contact("bottom", Plane((0.0, 0.0), (0.0, 1.0)), friction=friction, name="seat")],
        title="A flat punch",
    )


def ball(*, size: float = 12.0) -> Model:
    """A rigid ball of radius 100 on a quarter of a block, which it touches within a radius of 1.

    Parameters
    ----------
    size : of the block, in radii of the contact
    """
    lines = np.array([0.0, 1.0, 2.5, 0.5 * size, size])
    force = PLANE_MODULUS / 75.0 / 4.0  # a quarter of 4 E* a^3 / 3 R
    return Model(
        box(x=lines, y=lines, z=-lines[::-1]),
        bodies=[Body("block", SOFT)],
        supports=[
            Support("left", u=(0.0, None, None)),
            Support("front", u=(None, 0.0, None)),
            Support("bottom", u=(None, None, 0.0)),
        ],
        obstacles=[Rigid("ball", Sphere((0.0, 0.0, 100.0), 100.0), u=(0.0, 0.0, None), force=(None, None, -force))],
        contacts=[Contact("top", "ball", name="seat")],
        title="Hertz, point contact",
    )


def _moved(mesh: Mesh, scale: Array, shift: Array | float = 0.0) -> Mesh:
    return replace(mesh, points=mesh.points * scale + shift)
