# SPDX-License-Identifier: BSD-3-Clause
"""Contacts that wear: a cylinder that is rubbed on a flat, and a block on its bed in space."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from signorini.gallery.large_bodies import graded_lines, with_seat
from signorini.meshing.plane import half_disk, rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.model.wear import Wear

E, NU, RADIUS, FORCE, FRICTION = 200e3, 0.3, 6.0, 18.5, 0.9
"""Of McColl, Ding and Leen's cylinder on a flat of the same steel: MPa, mm, N per mm of length."""

WEAR = Wear(1.9e-8, mortar=2.9e-8)
"""Of their cylinder and their flat, 1/MPa."""


def rubbed_cylinder(
    steps: Sequence[Step],
    *,
    wear: Wear | None = WEAR,
    spacing: float = 0.01,
    ratio: float = 1.0,
    stroke: float = 0.0025,
    sliding: Literal["small", "finite"] = "small",
) -> Model:
    """A cylinder pressed on a flat that is driven to and fro under it: "press" is the force, "drive" the motion.

    Parameters
    ----------
    steps : factors of "press" and "drive"
    wear : of cylinder and flat
    spacing : of the nodes of the cylinder where they touch, length
    ratio : of the flat's spacing to it; 1: nodes are opposite nodes
    stroke : displacement of the flat at factor 1, length
    sliding : "finite" where that is not a small part of the spacing

    References
    ----------
    McColl, Ding, Leen (2004), Finite element simulation and experimental validation of fretting wear, Wear 256:1114.
    """
    reach = 0.3
    pad = _with_pole(half_disk(radius=RADIUS, contact_length=reach, contact_spacing=spacing), reach)
    wide = reach + (stroke if sliding == "finite" else 0.0)  # the flat goes under the cylinder
    cells = ratio * spacing
    right = graded_lines(cells * math.ceil(wide / cells - 1e-9), cells, RADIUS, 1.3)
    down = graded_lines(0.1, spacing, RADIUS, 1.3)
    flat = with_seat(
        rectangle(x=np.concatenate([-right[:0:-1], right]), y=-down[::-1]), "top", right[right <= wide + cells].max()
    )
    steel = Elastic(E=E, nu=NU)
    return Model(
        join({"pad": pad, "flat": flat}),
        title="A cylinder rubbed on a flat",
        bodies=[Body("pad", steel), Body("flat", steel)],
        supports=[Support("pad.cut", u=(0.0, None)), Support("flat.bottom", u=(stroke, 0.0), name="drive")],
        loads=[Load("pad.cut", force=(None, -FORCE), spread="displacement", name="press")],
        contacts=[Contact("pad.seat", "flat.seat", friction=FRICTION, wear=wear, sliding=sliding, name="contact")],
        steps=steps,
    )


def _with_pole(disk: Mesh, reach: float) -> Mesh:
    """The disk with the facets of its arc around the lowest point as the boundary "seat"."""
    (facets,) = disk.facets("arc")
    x, y = np.moveaxis(disk.points[facets], -1, 0)
    own = (np.abs(x).max(axis=1) <= reach * (1.0 + 1e-9)) & (y.max(axis=1) < 0.5 * RADIUS)
    return replace(disk, boundaries={**disk.boundaries, "seat": facets[own]})


def fretting(cycles: int, **options: object) -> list[Step]:
    """A force that stays, a motion to one end of the stroke, and from there to the other and back as often as asked.

    Parameters
    ----------
    cycles : how often
    options : of the step that repeats
    """
    rub = Step(name="rub", scale={"drive": [1.0, -1.0]}, repeat=cycles, **options)  # type: ignore[arg-type]
    return [Step(name="press", scale={"press": 1.0}), Step(name="out", scale={"drive": -1.0}), rub]


def to_and_fro(cycles: int, **options: object) -> list[Step]:
    """A force that stays, and a motion to and fro, as often as asked.

    Parameters
    ----------
    cycles : how often
    options : of the step that repeats
    """
    rub = Step(name="rub", scale={"drive": [1.0, 0.0, -1.0, 0.0]}, repeat=cycles, **options)  # type: ignore[arg-type]
    return [Step(name="press", scale={"press": 1.0}), rub]


def block_in_space(steps: Sequence[Step], *, wear: Wear, stroke: float, modulus: float) -> Model:
    """A block, 1 by 0.4 by 0.5, under a force of 1 ("press") on a bed along which it is driven ("drive"), mu 0.3.

    Half of one, with a plane of symmetry along its way.

    Parameters
    ----------
    steps : the history
    wear : of block and bed
    stroke : of the drive
    modulus : E of both
    """
    across, steel = np.array([0.0, 0.4]), Elastic(E=modulus, nu=0.3)
    top = box(x=np.linspace(0.0, 1.0, 3), y=across, z=np.array([0.0, 0.5]))
    bed = box(x=np.linspace(-0.5, 1.5, 5), y=across, z=np.array([-0.5, 0.0]))
    return Model(
        mesh=join({"top": top, "bed": bed}),
        kind="3d",
        bodies=[Body("top", steel), Body("bed", steel)],
        supports=[
            Support("bed.bottom", u=(0.0, 0.0, 0.0)),
            Support("top.top", u=(stroke, 0.0, None), name="drive"),
            *(Support(f"{body}.front", u=(None, 0.0, None), name=f"symmetry of {body}") for body in ("top", "bed")),
        ],
        loads=[Load("top.top", force=(None, None, -1.0), spread="displacement", name="press")],
        contacts=[Contact("top.bottom", "bed.top", friction=0.3, sliding="finite", wear=wear, name="sole")],
        steps=steps,
    )
