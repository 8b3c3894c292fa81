# SPDX-License-Identifier: BSD-3-Clause
"""Large bodies that stand for half-spaces: a ball on a plane or on a block, a round punch, balls pulled sideways."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.gallery.large_bodies import bend, flip, graded_lines, quarter_supports, with_seat
from signorini.meshing.plane import Cells, target
from signorini.meshing.solid import box, extruded
from signorini.meshing.tetrahedra import tetrahedra
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step
from signorini.reference.hertz import contact_modulus
from signorini.reference.hertz_point import HertzPoint, MindlinPoint

E, NU = 200.0, 0.3
RADIUS, CONTACT_RADIUS = 100.0, 1.0
"""Of a ball (a paraboloid), and of its contact, length."""

FLOOR = Plane(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
SOFT = Elastic(E=E, nu=NU)


def hertz(bodies: int) -> HertzPoint:
    """What half-spaces would do: one elastic body (on a rigid plane) or two."""
    modulus = contact_modulus(*[(E, NU)] * bodies)
    force = 4.0 * modulus * CONTACT_RADIUS**3 / (3.0 * RADIUS)
    return HertzPoint(force=force, radius=RADIUS, modulus=modulus)


def ball(
    *,
    n: int = 6,
    block: int | None = None,
    cells: Cells | Literal["tetra10"] = "quad",
    angle: float = 90.0,
    size: float = 20.0,
) -> Model:
    """An elastic ball of radius 100 pressed without friction on a rigid plane or on an elastic block, contact radius 1.

    Cells on rings about the contact; a quarter or half of it, held by its planes of symmetry, or the whole.

    Parameters
    ----------
    n : cells along half the side of the core of the ball, about 2 n to the contact radius
    block : the same of the block below; None for a rigid plane
    cells : "quad" (hexahedra of 8 nodes), "quad8" (20), "quad9" (27), or "tetra10", six to a hexahedron
    angle : 90, 180 or 360 degrees
    size : radius and height of the bodies, in units of the contact radius
    """
    upper = bend(_cylinder(n, cells, angle, size), RADIUS)
    sides = {"ball": with_seat(upper, "bottom", 1.3)}
    force = hertz(1 if block is None else 2).force * angle / 360.0
    contact = Contact("ball.seat", FLOOR, name="contact")
    supports = _symmetric("ball", angle)
    if block is not None:
        below = flip(_cylinder(block, cells, angle, size))
        sides["block"] = with_seat(below, "bottom", 1.3 if block == n else 1.6)
        contact = replace(contact, mortar="block.seat")
        supports += [*_symmetric("block", angle), Support("block.top", u=(None, None, 0.0))]
    if angle > 90.0:
        supports += [Support(f"{name}.axis", u=(0.0, 0.0, None)) for name in sides]
        supports += [Support(f"{name}.side", u=(None, 0.0, None)) for name in sides]
    return Model(
        join(sides),
        title="Elastic ball on a rigid plane" if block is None else "Elastic ball on an elastic block",
        bodies=[Body(name, SOFT) for name in sides],
        supports=supports,
        loads=[Load("ball.top", force=(None, None, -force), spread="displacement", name="press")],
        contacts=[contact],
    )


def body_on_round_punch(*, n: int) -> Model:
    """A quarter of an elastic cylinder 20 times as large pressed by 1 in all on a flat rigid punch of radius 1.

    Parameters
    ----------
    n : cells along half the side of the core, about 2 n to the radius of the punch; they shrink towards its edge
    """
    radii = [0.7, *(1.0 - 0.3 * 0.65 ** np.arange(1, n)), 1.0, *(1.0 + graded_lines(0.01, 0.01, 19.0, 1.35)[1:])]
    mesh = extruded(target(radii=radii, n=n), z=graded_lines(0.06, 0.02, 20.0, 1.35))
    return Model(
        join({"body": with_seat(mesh, "bottom", 1.0)}),
        title="Elastic body on a flat round punch",
        bodies=[Body("body", SOFT)],
        supports=quarter_supports("body"),
        loads=[Load("body.top", force=(None, None, -0.25), spread="displacement", name="press")],
        contacts=[Contact("body.seat", FLOOR, name="punch")],
    )


EQUAL = MindlinPoint(normal=hertz(2), friction=0.5, shear_compliance=2.0 * (2.0 - NU) / SOFT.shear_modulus)
"""Two equal bodies with friction, pressed and pulled."""


def equal_half_spaces(steps: Sequence[Step], *, spacing: float) -> Model:
    """Half of two equal balls as two blocks, the difference of height in the upper one, pulled along x.

    The top of the upper block moves without turning; "press" and "pull" at factor 1 are P and mu P on it.

    Parameters
    ----------
    steps : factors of "press" and "pull"; pull 1 is the onset of full sliding
    spacing : of the nodes where they touch, in units of the contact radius
    """
    right = graded_lines(1.2, spacing, 5.0, 1.4)
    x, z = np.concatenate([-right[:0:-1], right]), graded_lines(2 * spacing, spacing, 5.0, 1.4)
    upper = bend(box(x=x, y=right, z=z), RADIUS)
    lower = box(x=x, y=right, z=-z[::-1])
    P = EQUAL.normal.force / 2.0
    return Model(
        join({"upper": with_seat(upper, "bottom", 1.2), "lower": with_seat(lower, "top", 1.2)}),
        title="Two equal balls, pressed and pulled",
        bodies=[Body("upper", SOFT), Body("lower", SOFT)],
        supports=[
            Support("upper.front", u=(None, 0.0, None)),
            Support("lower.front", u=(None, 0.0, None)),
            Support("lower.bottom", u=(0.0, 0.0, 0.0)),
        ],
        loads=[
            Load("upper.top", force=(None, None, -P), spread="displacement", name="press"),
            Load("upper.top", force=(EQUAL.friction * P, None, None), spread="displacement", name="pull"),
        ],
        contacts=[Contact("upper.seat", "lower.seat", friction=EQUAL.friction, name="contact")],
        steps=steps,
    )


def _cylinder(n: int, cells: Cells | Literal["tetra10"], angle: float, size: float) -> Mesh:
    """Rings about the contact, of cells that grow with depth and distance; named nodes to hold more than a quarter."""
    plane: Cells = "quad9" if cells == "tetra10" else cells
    spacing = 0.5 / n
    radii = 1.0 + np.concatenate([[0.0], graded_lines(0.4, 0.1 if n < 6 else 0.6 * spacing, size - 1.0, 1.35)[1:]])
    mesh = extruded(
        target(radii=radii, n=n, angle=angle, cells=plane), z=graded_lines(2 * spacing, spacing, size, 1.35)
    )
    if cells == "tetra10":
        mesh = tetrahedra(mesh)
    top = mesh.points[:, 2] == size
    axis = np.flatnonzero(top & (np.hypot(*mesh.points.T[:2]) == 0.0))
    side = np.flatnonzero(top & (mesh.points[:, 1] == 0.0) & (mesh.points[:, 0] == mesh.points[:, 0].max()))
    return replace(mesh, nodes={"axis": axis, "side": side})


def _symmetric(body: str, angle: float) -> list[Support]:
    """The planes of symmetry of a quarter or half."""
    if angle == 90.0:
        return quarter_supports(body)
    if angle == 180.0:
        return [Support(f"{body}.{side}", u=(None, 0.0, None)) for side in ("start", "end")]
    return []
