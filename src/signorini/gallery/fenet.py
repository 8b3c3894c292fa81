# SPDX-License-Identifier: BSD-3-Clause
"""NAFEMS/FENET advanced contact benchmark 1: a steel cylinder on an aluminium block."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.gallery.large_bodies import graded_lines, with_seat
from signorini.meshing.plane import quarter_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.reference.hertz import HertzLine, contact_modulus

RADIUS, BLOCK, FORCE = 50.0, 200.0, 35000.0
SEAT = 10.0
"""Half-width of the part with even cells, where the two may touch."""

STEEL, ALUMINIUM = Elastic(E=210e3, nu=0.3), Elastic(E=70e3, nu=0.3)

HERTZ = HertzLine(force=FORCE, radius=RADIUS, modulus=contact_modulus((210e3, 0.3), (70e3, 0.3)))


def cylinder_on_block(*, friction: float, across: tuple[int, int], steps: tuple[Step, ...] = (Step(),)) -> Model:
    """The right half: two quarters of the cylinder, tied at its equator, a point load of 35000 N/mm on its top.

    Parameters
    ----------
    friction : Coulomb's coefficient between cylinder and block
    across : cells of cylinder (nonmortar) and block along the 10 mm where they may touch
    steps : of the load history; "pole" is the load

    Examples
    --------
    >>> print(round(HERTZ.half_width, 5), round(HERTZ.peak_pressure, 2))
    6.21463 3585.36
    """
    lower = quarter_disk(radius=RADIUS, contact_length=SEAT, contact_spacing=SEAT / across[0])
    upper = replace(lower, points=np.array(lower.points) * [1.0, -1.0] + [0.0, 2.0 * RADIUS])
    spacing = SEAT / across[1]
    x, depth = graded_lines(SEAT, spacing, 0.5 * BLOCK), graded_lines(4.0 * spacing, spacing, BLOCK)
    block = with_seat(rectangle(x=x, y=-depth[::-1]), "top", SEAT)
    return Model(
        join({"lower": lower, "upper": upper, "block": block}),
        title="FENET benchmark 1: cylinder on a block",
        units="mm, N, MPa",
        bodies=[Body("lower", STEEL), Body("upper", STEEL), Body("block", ALUMINIUM)],
        supports=[
            *(Support(name, u=(0.0, None)) for name in ("lower.axis", "upper.axis", "block.left")),
            Support("block.bottom", u=(0.0, 0.0)),
        ],
        loads=[Load((0.0, 2.0 * RADIUS), force=(0.0, -0.5 * FORCE), name="pole")],
        contacts=[
            Contact("lower.arc", "block.seat", friction=friction, name="contact"),
            Contact("upper.cut", "lower.cut", friction="tied", name="equator"),
        ],
        steps=steps,
    )
