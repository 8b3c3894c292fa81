# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of revolution that turn about their axis: a shaft in torsion, a press fit, a ball that is screwed down."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from signorini.meshing.plane import Cells, annulus, rectangle
from signorini.meshing.solid import extruded
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.kind import TWIST
from signorini.model.links import RigidBody
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Circle, Plane
from signorini.model.rigid import Rigid
from signorini.model.step import Step

STEEL = Elastic(E=210e3, nu=0.3)

BALL = 50.0
"""Radius of the ball, length."""

_BLOCK = 12.0  # contact radii: what is farther away changes the torque by less than the mesh


def shaft_in_torsion(*, torque: float = 1000.0, n: int = 2, cells: Cells = "quad") -> Model:
    """A hollow shaft, radii 5 and 10, length 8, held at one end and twisted at the other.

    Parameters
    ----------
    torque : on the other end, force times length
    n : cells across the wall and along the shaft
    cells : "quad", "quad8", "triangle", ...
    """
    return Model(
        rectangle(width=5.0, height=8.0, nx=n, ny=n, cells=cells, origin=(5.0, 0.0)),
        kind=TWIST,
        bodies=[Body("block", STEEL)],
        supports=[Support("bottom", u=(None, 0.0, 0.0))],
        loads=[Load("top", torque=torque)],
    )


def fit_under_torque(
    *,
    turn: float = 0.003,
    pull: float = 0.0,
    interference: float = 0.01,
    n: tuple[int, int] = (4, 4),
    cells: Cells = "quad",
    steps: tuple[Step, ...] = (),
    **contact: Any,
) -> Model:
    """A hollow shaft 5..10 in a hub 10..20, length 8, pressed without friction; then a rigid core pulls and turns it.

    Parameters
    ----------
    turn, pull : of the core, radians and length
    interference : of the fit, length
    n : cells along the shaft and along the hub
    cells : "quad", "quad8", "triangle", ...
    steps : in place of one that presses and one that drives
    contact : of the fit, friction 0.2 where nothing else is given
    """
    mesh = join(
        {
            "shaft": rectangle(width=5.0, height=8.0, nx=2, ny=n[0], cells=cells, origin=(5.0, 0.0)),
            "hub": rectangle(width=10.0, height=8.0, nx=3, ny=n[1], cells=cells, origin=(10.0, 0.0)),
        }
    )
    contact = {"friction": 0.2} | contact
    if not steps:
        steps = (
            Step(name="press", scale={"core": 0.0}, friction={"fit": 0.0}),
            Step(name="drive", scale={"core": 1.0}, friction={"fit": contact["friction"]}),
        )
    return Model(
        mesh,
        kind=TWIST,
        title="Press fit that is turned and pulled",
        bodies=[Body("shaft", STEEL), Body("hub", STEEL)],
        supports=[Support("hub.right", u=(None, 0.0, 0.0), name="held"), Support("core", u=(None, pull, turn))],
        rigid_bodies=[RigidBody("core", on="shaft.left", point=(0.0, 0.0))],
        contacts=[
            Contact("shaft.right", "hub.left", interference=interference, name="fit", **contact),
        ],
        steps=steps,
    )


def screwed_ball(*, turn: float, n: int = 10, friction: float = 0.5, radius: float = 2.0) -> Model:
    """A block (E 1000, nu 0.3) lifted without friction against a rigid ball of radius 50, which is then turned.

    Parameters
    ----------
    turn : of the ball about the axis, radians
    n : cells on the contact radius
    friction : Coulomb's coefficient while it turns
    radius : of the contact, by which Hertz's formula says how far the block is lifted, length
    """
    fine = radius / n * np.arange(round(1.3 * n) + 1)
    coarse = np.geomspace(fine[-1], _BLOCK * radius, n + 1)[1:]
    x = np.concatenate([fine, coarse])
    return Model(
        rectangle(x=x, y=-x[::-1]),
        kind=TWIST,
        title="Ball that is screwed down",
        bodies=[Body("block", Elastic(E=1000.0, nu=0.3))],
        supports=[Support("bottom", u=(0.0, radius**2 / BALL, 0.0), name="lift")],
        obstacles=[Rigid("ball", Circle((0.0, BALL), BALL), rotation=turn)],
        contacts=[Contact("top", "ball", friction=friction, name="seat")],
        steps=[
            Step(name="press", scale={"lift": 1.0, "ball": 0.0}, friction={"seat": 0.0}),
            Step(name="turn", scale={"ball": 1.0}, friction={"seat": friction}),
        ],
    )


def turned_punch(*, turn: float = 0.01, n: int = 12) -> Model:
    """A rigid flat punch of radius 1 that sticks to a block (E 1000, nu 0.3), pressed on it and turned.

    Parameters
    ----------
    turn : of the punch about the axis, radians
    n : cells on its radius, finer towards its edge, and as many beyond it
    """
    inner = 1.0 - (1.0 - np.linspace(0.0, 1.0, n + 1)) ** 2
    outer = 1.0 + (_BLOCK - 1.0) * np.linspace(0.0, 1.0, 2 * n + 1)[1:] ** 3
    x = np.concatenate([inner, outer])
    y = -_BLOCK * np.linspace(1.0, 0.0, 3 * n + 1) ** 3
    mesh = rectangle(x=x, y=y)
    (top,) = mesh.facets("top")
    seat = top[mesh.points[top, 0].max(axis=1) <= 1.0]
    return Model(
        replace(mesh, boundaries={**mesh.boundaries, "seat": seat}),
        kind=TWIST,
        title="Punch that is turned",
        bodies=[Body("block", Elastic(E=1000.0, nu=0.3))],
        supports=[Support("bottom", u=(0.0, 0.01, 0.0), name="lift")],
        obstacles=[Rigid("punch", Plane((0.0, 0.0), (0.0, -1.0)), rotation=turn)],
        contacts=[Contact("seat", "punch", friction="stick", name="seat")],
    )


def ring_under_torque(*, sectors: int = 0, turn: float = 0.003, pull: float = 0.02) -> Model:
    """A ring 5..10 on another one 10..20, a slice of `fit_under_torque` one cell high, as its meridian or in space.

    Parameters
    ----------
    sectors : cells around the axis of the ring in space; 0 for its meridian
    turn, pull : of the core, radians and length
    """
    radii = {"shaft": (5.0, 10.0), "hub": (10.0, 20.0)}
    on_axis: tuple[float, ...]
    driven: tuple[float, ...]
    if sectors:
        rings = {
            name: annulus(inner=a, outer=b, n_radial=1, n_angular=sectors, angle=360.0)
            for name, (a, b) in radii.items()
        }
        mesh, inside, outside = extruded(join(rings), z=[0.0, 4.0]), "inner", "outer"
        on_axis, driven = (0.0, 0.0, 0.0), (0.0, 0.0, pull, 0.0, 0.0, turn)
    else:
        cells = {name: rectangle(width=b - a, height=4.0, origin=(a, 0.0)) for name, (a, b) in radii.items()}
        mesh, inside, outside = join(cells), "left", "right"
        on_axis, driven = (0.0, 0.0), (0.0, pull, turn)
    return Model(
        mesh,
        kind="3d" if sectors else TWIST,
        title="Ring that is turned and pulled",
        bodies=[Body(name, STEEL) for name in radii],
        supports=[Support(f"hub.{outside}", u=(0.0, 0.0, 0.0), name="held"), Support("core", u=driven)],
        rigid_bodies=[RigidBody("core", on=f"shaft.{inside}", point=on_axis)],
        contacts=[Contact(f"shaft.{outside}", f"hub.{inside}", friction=0.2, interference=0.01, name="fit")],
        steps=[
            Step(name="press", scale={"core": 0.0}, friction={"fit": 0.0}),
            Step(name="drive", scale={"core": 1.0}, friction={"fit": 0.2}, increments=4),
        ],
    )
