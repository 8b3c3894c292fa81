# SPDX-License-Identifier: BSD-3-Clause
"""A block on a bed that closes by a law, with its closed form."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from signorini.law.closure import Closure
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step
from signorini.model.varying import Formula
from signorini.model.wear import Wear

GASKET = Closure([(0.0, 0.0), (0.01, 1.0), (0.015, 4.0), (0.04, 8.0), (0.042, 30.0)])
"""Lines that stiffen and soften in turn, so that pairs on a way to one pressure pass kinks of both kinds."""

MODULUS, HEIGHT = 1000.0, 1.0
"""Of the block: force over area, and length. It does not contract, so that uniform pressure strains it uniformly."""


def block_on_a_bed(
    pressure: float | str = 1.0,
    closure: Closure = GASKET,
    *,
    friction: float = 0.0,
    kind: Literal["plane strain", "plane stress", "axisymmetric"] = "plane strain",
    steps: Sequence[Step] | None = None,
    cells: int = 8,
    interference: float = 0.0,
) -> Model:
    """A block of width 2 on a rigid plane, with something between both that closes by a law, and loads "p" and "q".

    Under a uniform pressure p its top goes down by ``closure(p) + p / E`` times the height.

    Parameters
    ----------
    pressure : "p" on its top, force over area, a number or a formula
    closure : of what lies below it
    friction : there; without it a support guides the block, with it contact alone holds it
    kind : of the model
    steps : of its history; one to all of "p" where not given, followed exactly
    cells : along the bed
    interference : overlap to begin with, length
    """
    top = Formula(pressure) if isinstance(pressure, str) else pressure
    return Model(
        rectangle(width=2.0, height=HEIGHT, nx=cells, ny=4),
        kind=kind,
        bodies=[Body("block", Elastic(E=MODULUS, nu=0.0))],
        supports=[] if friction else [Support("left", u=(0, None))],
        loads=[
            Load("top", pressure=top, name="p"),
            *([Load("top", traction=(1.0, 0.0), name="q")] if friction else []),
        ],
        contacts=[
            Contact(
                "bottom",
                Plane((0, 0), (0, 1)),
                friction=friction,
                closure=closure,
                interference=interference,
                name="bed",
            )
        ],
        steps=steps or [Step(scale={"p": 1.0}, path="exact")],
    )


def worn_layer(
    table: Sequence[tuple[float, float]], *, cycles: int, sliding: Literal["small", "finite"], stroke: float = 0.5
) -> Model:
    """A block, of modulus 1e5 and height 1/2, held down by 0.03 on a layer, rubbed by twice a stroke in every cycle.

    With Archard's coefficient 1e-3 a cycle takes 1e-3 times its pressure and its way from the overlap.

    Parameters
    ----------
    table : closures and pressures of the layer
    cycles : how often it is rubbed
    sliding : of its sides
    stroke : there, and back, length
    """
    return Model(
        rectangle(width=2.0, height=0.5, nx=1, ny=1),
        kind="plane strain",
        bodies=[Body("block", Elastic(E=1e5, nu=0.0))],
        supports=[Support("top", u=(None, -0.03), name="press"), Support("top", u=(stroke, None), name="drive")],
        contacts=[
            Contact(
                "bottom", Plane((0, 0), (0, 1)), closure=Closure(table), sliding=sliding, wear=Wear(1e-3), name="sole"
            )
        ],
        steps=[
            Step(scale={"press": 1.0, "drive": 0.0}, path="exact"),
            Step(scale={"drive": [1.0, 0.0]}, repeat=cycles, path="exact"),
        ],
    )
