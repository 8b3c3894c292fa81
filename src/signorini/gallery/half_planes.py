# SPDX-License-Identifier: BSD-3-Clause
"""Large blocks that stand for half-planes: equal ones under oscillating tangential load, punches, a square block."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from signorini.gallery.large_bodies import bend, graded_lines, with_seat
from signorini.meshing.plane import Cells, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import Kind
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step
from signorini.reference.cattaneo import CattaneoMindlin
from signorini.reference.hertz import HertzLine, contact_modulus

E, NU = 200.0, 0.3
RADIUS, HALF_WIDTH, FRICTION = 5000.0, 1.2, 0.5
"""Of each of two equal cylinders, and half-width and friction of their contact, in consistent units."""

_MODULUS = contact_modulus((E, NU), (E, NU))
_FORCE = float(np.pi * HALF_WIDTH**2 * _MODULUS / (4.0 * RADIUS / 2.0))
EQUAL = CattaneoMindlin(normal=HertzLine(force=_FORCE, radius=RADIUS / 2.0, modulus=_MODULUS), friction=FRICTION)
"""What two equal half-planes would do."""


def equal_half_planes(steps: Sequence[Step], *, spacing: float = 0.05, size: float = 20.0) -> Model:
    """Two equal cylinders as two blocks, their difference of height in the lower side of the upper one.

    The top of the upper block moves without turning; "press" and "pull" at factor 1 are P and mu P on it.

    Parameters
    ----------
    steps : factors of "press" and "pull"; pull 1 is the onset of full sliding
    spacing : of the nodes where they touch, in units of the half-width of contact
    size : of the blocks, in the same units
    """
    a = HALF_WIDTH
    right = a * graded_lines(1.2, spacing, size / 2.0)
    x = np.concatenate([-right[:0:-1], right])
    y = a * graded_lines(1.0, spacing, size / 2.0, 1.25)
    lower = rectangle(x=x, y=-y[::-1])
    upper = bend(rectangle(x=x, y=y), RADIUS / 2.0)
    soft = Elastic(E=E, nu=NU)
    P = EQUAL.normal.force
    return Model(
        join({"upper": with_seat(upper, "bottom", 1.2 * a), "lower": with_seat(lower, "top", 1.2 * a)}),
        title="Two equal cylinders, pressed and pulled to and fro",
        bodies=[Body("upper", soft), Body("lower", soft)],
        supports=[Support("lower.bottom", u=(0.0, 0.0))],
        loads=[
            Load("upper.top", force=(None, -P), spread="displacement", name="press"),
            Load("upper.top", force=(FRICTION * P, None), spread="displacement", name="pull"),
        ],
        contacts=[Contact("upper.seat", "lower.seat", friction=FRICTION, name="contact")],
        steps=steps,
    )


def punch(
    *,
    curved: bool,
    friction: float,
    spacing: float,
    closed: float = 1.0,
    kind: Kind = "plane strain",
    cells: Cells = "quad",
) -> Model:
    """Half of an elastic block pressed on a rigid punch of half-width 1, flat or round (Spence); flat by a force of 1.

    Parameters
    ----------
    curved : the punch is round, and the force is such that the half-width of contact is about ``closed``
    friction : Coulomb's coefficient
    spacing : of the nodes on the punch, length
    closed : half-width of contact, length
    kind : "axisymmetric": the block and the flat punch are round
    cells : "quad", "quad8", "triangle", ...
    """
    x = graded_lines(1.0, spacing, 20.0, 1.2)
    mesh = rectangle(x=x, y=graded_lines(0.2, spacing, 20.0, 1.25), cells=cells)
    radius = 20.0
    force = 1.0
    if curved:
        mesh = bend(mesh, radius)
        force = float(np.pi * closed**2 * contact_modulus((E, NU)) / (4.0 * radius)) / 2.0
    return Model(
        with_seat(mesh, "bottom", 1.0),
        kind=kind,
        title="Elastic block on a rigid punch",
        bodies=[Body("block", Elastic(E=E, nu=NU))],
        supports=[] if kind == "axisymmetric" else [Support("left", u=(0.0, None))],
        loads=[Load("top", force=(None, -force), spread="displacement", name="press")],
        contacts=[Contact("seat", Plane(point=(0.0, 0.0), normal=(0.0, 1.0)), friction=friction, name="punch")],
        steps=[Step(name="press")],
    )


def square_on_half_plane(*, friction: float | Literal["stick"], finest: float) -> Model:
    """Half of a square block 2 x 2 pressed on a large one of the same material: complete contact (benchmark B07).

    Parameters
    ----------
    friction : a number, or "stick"
    finest : length of the cells at the corner; they grow by 1.3 away from it
    """
    towards = graded_lines(4.0 * finest, finest, 1.0, 1.3)
    x = 1.0 - towards[::-1]
    beyond = 1.0 + graded_lines(4.0 * finest, finest, 9.0, 1.3)
    up, down = graded_lines(4.0 * finest, finest, 2.0, 1.3), graded_lines(4.0 * finest, finest, 10.0, 1.3)
    large = rectangle(x=np.concatenate([x, beyond[1:]]), y=-down[::-1])
    soft = Elastic(E=E, nu=NU)
    return Model(
        join({"block": rectangle(x=x, y=up), "base": with_seat(large, "top", 1.0)}),
        title="Square block on a half-plane",
        bodies=[Body("block", soft), Body("base", soft)],
        supports=[
            Support("block.left", u=(0.0, None)),
            Support("base.left", u=(0.0, None)),
            Support("base.bottom", u=(None, 0.0)),
        ],
        loads=[Load("block.top", pressure=1.0, name="press")],
        contacts=[Contact("block.bottom", "base.seat", friction=friction, name="contact")],
        steps=[Step(name="press")],
    )
