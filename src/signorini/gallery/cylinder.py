# SPDX-License-Identifier: BSD-3-Clause
"""The paper's example: a long elastic cylinder pressed on a rigid foundation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from signorini.meshing.plane import Cells, quarter_disk
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step
from signorini.reference.hertz import HertzLine, contact_modulus

RADIUS, E, NU, FORCE = 8.0, 200.0, 0.3, 156.0
"""Data that reproduce the paper's Hertz row (METHOD 9); the force acts on the whole cylinder."""

HERTZ = HertzLine(force=FORCE, radius=RADIUS, modulus=contact_modulus((E, NU)))


def zhu_cylinder(
    *,
    friction: float = 0.4,
    refine: int = 1,
    compliance: float = 0.0,
    spread: Literal["traction", "displacement"] = "traction",
    cells: Cells = "quad",
    contact_length: float = 4.0,
    contact_spacing: float = 0.5,
    force: float = FORCE,
    steps: Sequence[Step] | None = None,
) -> Model:
    """A quarter of the cylinder on the rigid plane y = 0, plane strain.

    Parameters
    ----------
    friction : Coulomb's coefficient
    refine : the paper's mesh (76 cells) with every edge divided by it
    compliance : of the interface in both directions, length per pressure; 1 / E_n is the paper's penalty
    spread : "traction", uniform on the cut, or "displacement", a rigid cut that carries the same force
    cells : "quad" or "triangle"
    contact_length, contact_spacing : see :func:`signorini.meshing.plane.quarter_disk`
    force : on the whole cylinder per thickness
    steps : by default one, of one increment

    Examples
    --------
    >>> zhu_cylinder().mesh
    Mesh(93 nodes, 76 quads; bodies: disk; boundaries: arc, axis, cut)
    """
    return Model(
        quarter_disk(
            radius=RADIUS,
            contact_length=contact_length,
            contact_spacing=contact_spacing,
            refine=refine,
            cells=cells,
        ),
        title="Elastic cylinder on a rigid foundation",
        bodies=[Body("disk", Elastic(E=E, nu=NU))],
        supports=[Support("axis", u=(0.0, None))],
        loads=[Load("cut", force=(None, -force / 2.0), spread=spread)],
        contacts=[
            Contact(
                "arc",
                Plane(point=(0.0, 0.0), normal=(0.0, 1.0)),
                friction=friction,
                normal_compliance=compliance,
                tangential_compliance=compliance,
                name="foundation",
            )
        ],
        steps=steps or [Step(name="press", increments=1)],
    )
