# SPDX-License-Identifier: BSD-3-Clause
"""Meshed bodies that roll and turn, each about a hub or held by contact alone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from signorini.meshing.plane import annulus, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.links import RigidBody
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.step import Step

_SECTOR = 6.0
"""Of a disc whose surface is meshed, degrees."""

_HUB = 0.95
"""Of the radius of a disc: its rigid hub."""

_STEEL = Elastic(E=2.0e5, nu=0.3)


def rolling_discs(*, radius: float, cells: int, force: float, facets: float) -> Model:
    """Two steel discs, R 1 mm and another, pressed on each other without slip; one is turned, and turns the other.

    Parameters
    ----------
    radius : of the other, mm
    cells : of six degrees of the first
    force : that presses, N/mm
    facets : of the first that pass the contact
    """
    one = _sector(1.0, cells, (0.0, 0.0), 0.0)
    two = _sector(radius, round(cells * radius), (1.0 + radius, 0.0), 180.0)
    return Model(
        mesh=join({"one": one, "two": two}),
        kind="plane strain",
        bodies=[Body("one", _STEEL), Body("two", _STEEL)],
        supports=[
            Support("driver", u=(0.0, 0.0, math.radians(_SECTOR) / cells * facets), name="turn"),
            Support("driven", u=(None, 0.0, None)),
        ],
        rigid_bodies=[
            RigidBody("driver", on="one.inner", point=(0.0, 0.0)),
            RigidBody("driven", on="two.inner", point=(1.0 + radius, 0.0)),
        ],
        loads=[Load(on="driven", force=(-force, None, None), name="press")],
        contacts=[Contact("two.outer", "one.outer", friction=0.5, sliding="finite", name="tread")],
        steps=[
            Step(name="press", scale={"press": 1.0, "turn": 0.0}),
            Step(name="roll", scale={"press": 1.0, "turn": 1.0}),
        ],
    )


def pushed_disc(*, cells: int, force: float, facets: float) -> Model:
    """A steel disc, R 1 mm, pressed on a bed and pushed at its hub, which is free to turn.

    Parameters
    ----------
    cells : of six degrees of it
    force : that presses, N/mm
    facets : of it that pass the contact
    """
    angle = math.radians(_SECTOR)
    x = np.linspace(-0.5 * angle, 0.5 * angle, round(0.8 * cells) + 1)
    bed = rectangle(x=x, y=np.array([-0.05, -0.02, -0.006, 0.0]))
    return Model(
        mesh=join({"disc": _sector(1.0, cells, (0.0, 1.0), 270.0), "bed": bed}),
        kind="plane strain",
        bodies=[Body("disc", _STEEL), Body("bed", _STEEL)],
        supports=[
            Support("bed.bottom", u=(0.0, 0.0)),
            Support("hub", u=(angle / cells * facets, None, None), name="push"),
        ],
        rigid_bodies=[RigidBody("hub", on="disc.inner", point=(0.0, 1.0))],
        loads=[Load(on="hub", force=(None, -force, None), name="press")],
        contacts=[Contact("bed.top", "disc.outer", friction=0.5, sliding="finite", name="tread")],
        steps=[
            Step(name="press", scale={"press": 1.0, "push": 0.0}),
            Step(name="roll", scale={"press": 1.0, "push": 1.0}),
        ],
    )


def block_on_slope(*, angles: tuple[float, ...], friction: float = 0.5) -> Model:
    """A block that its weight and friction alone hold on a bed, which a hub tilts step by step.

    Parameters
    ----------
    angles : of the bed at the ends of the steps, radians
    friction : Coulomb's coefficient
    """
    block = rectangle(x=np.linspace(-0.5, 0.5, 6), y=np.linspace(0.0, 0.4, 3))
    bed = rectangle(x=np.linspace(-2.0, 2.0, 14), y=np.linspace(-0.5, 0.0, 3))
    rubber = Elastic(E=1.0e3, nu=0.3, density=1.0)
    return Model(
        mesh=join({"block": block, "bed": bed}),
        kind="plane strain",
        bodies=[Body("block", rubber), Body("bed", rubber)],
        supports=[Support("hub", u=(0.0, 0.0, 1.0), name="tilt")],
        rigid_bodies=[RigidBody("hub", on="bed.bottom", point=(0.0, -0.5))],
        loads=[Load(on="block", gravity=(0.0, -9.81), name="weight")],
        contacts=[Contact("block.bottom", "bed.top", friction=friction, sliding="finite", name="sole")],
        steps=[
            Step(name="weight", scale={"weight": 1.0, "tilt": 0.0}),
            *(Step(name=f"tilt by {angle:g}", scale={"weight": 1.0, "tilt": angle}) for angle in angles),
        ],
    )


def _sector(radius: float, cells: int, centre: tuple[float, float], facing: float) -> Mesh:
    """Six degrees of a disc about a direction, degrees from the x axis."""
    mesh = annulus(inner=_HUB * radius, outer=radius, n_radial=3, n_angular=cells, angle=_SECTOR)
    turn = math.radians(facing - 0.5 * _SECTOR)
    c, s = math.cos(turn), math.sin(turn)
    return replace(mesh, points=mesh.points @ np.array([[c, s], [-s, c]]) + centre)
