# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that slide or roll over many elements."""

from __future__ import annotations

import math

import numpy as np

from signorini.arrays import Array
from signorini.meshing.plane import half_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.obstacle import Circle
from signorini.model.rigid import Rigid
from signorini.model.step import Step

_FAR = np.array([0.2, 0.5, 1.0, 1.8, 3.0, 5.0, 8.0, 12.0, 18.0, 26.0])
"""Where nodes are beyond the fine part of a half-plane, half-widths of contact."""

_GROWTH = 1.4  # of cells below and beside the fine part of a half-plane, from one to the next
_DEPTH = 50.0  # half-widths: a bed is some four times as deep, and stretches by 1 % of what rolling asks for

HALF_WIDTH = 1.0
"""Of the contact of `dragged_cylinder`, mm."""

PRESSING = math.pi * 72.0e3 / (2.0 * (1.0 - 0.33**2)) * HALF_WIDTH**2 / (4.0 * 50.0)
"""Of the force on it, N/mm: Hertz's for that width."""


def half_width(load: float, radius: float, modulus: float) -> float:
    """Half-width of Hertz's line contact, length.

    Parameters
    ----------
    load : force per length
    radius : relative radius of both bodies, length
    modulus : of both bodies together, E*, force per area

    Examples
    --------
    >>> round(half_width(math.pi, 1.0, 4.0), 12)
    1.0
    """
    return math.sqrt(4.0 * load * radius / (math.pi * modulus))


def dragged_cylinder(*, stroke: float, spacing: float, friction: float = 0.3) -> Model:
    """A half cylinder, R 50 mm, pressed on a flat, half-width 1 mm, and dragged along it; aluminium.

    Parameters
    ----------
    stroke : mm
    spacing : of the nodes of both bodies where they touch, mm
    friction : Coulomb's coefficient
    """
    aluminium = Elastic(E=72.0e3, nu=0.33)
    pad = half_disk(radius=50.0, contact_length=1.6, contact_spacing=spacing)
    return Model(
        mesh=join({"pad": pad, "flat": _half_plane(-1.6, stroke + 1.6, spacing, _FAR[:8])}),
        kind="plane strain",
        bodies=[Body("pad", aluminium), Body("flat", aluminium)],
        supports=[Support("flat.bottom", u=(0.0, 0.0)), Support("pad.cut", u=(stroke, None), name="drag")],
        loads=[Load(on="pad.cut", force=(None, -PRESSING), spread="displacement", name="press")],
        contacts=[Contact("pad.arc", "flat.top", friction=friction, sliding="finite", name="contact")],
        steps=[
            Step(name="press", scale={"press": 1.0, "drag": 0.0}),
            Step(name="drag", scale={"press": 1.0, "drag": 1.0}),
        ],
    )


def driven_wheel(*, ratio: float, ways: tuple[float, float], across: int, friction: float = 0.3) -> Model:
    """A rigid wheel, R 100, on an incompressible half-plane that moves under it, and a moment that it resists.

    Parameters
    ----------
    ratio : tangential force over friction times normal force
    ways : of two steps in which it rolls, half-widths of contact
    across : elements in the half-width
    friction : Coulomb's coefficient
    """
    E, nu, radius, force = 200.0, 0.499, 100.0, 10.0
    a = half_width(force, radius, E / (1.0 - nu**2))
    whole = sum(ways) * a
    bed = _half_plane(-1.5 * a, whole + 1.5 * a, a / across, a * _FAR)
    wheel = Rigid(
        "wheel",
        Circle((0.0, radius), radius),
        u=(0.0, None),
        force=(None, -force),
        rotation=None,
        moment=ratio * friction * force * radius,
    )
    return Model(
        mesh=bed,
        kind="plane strain",
        bodies=[Body(next(iter(bed.bodies)), Elastic(E=E, nu=nu), formulation="mean dilatation")],
        supports=[Support("bottom", u=(-whole, 0.0), name="move")],
        obstacles=[wheel],
        contacts=[Contact("top", "wheel", friction=friction, sliding="finite", name="tread")],
        steps=[
            Step(name="press", scale={"wheel": 1.0, "move": 0.0}),
            Step(name="roll", scale={"wheel": 1.0, "move": ways[0] / sum(ways)}),
            Step(name="on", scale={"wheel": 1.0, "move": 1.0}),
        ],
    )


def free_wheel(*, friction: float, ways: tuple[float, float], across: int) -> Model:
    """A rigid wheel, R 2000, that rolls freely on a half-plane with half-widths of 1 as an aluminium roller on steel.

    How two bodies roll depends on their modulus together and on Dundurs' beta alone, which is (1 - 2 nu) / (2 (1 - nu))
    where one is rigid: with this nu the 0.14385 of aluminium on steel. The radius is large, for the normals of a rigid
    wheel are tilted where those between two rollers of one radius are not.

    Parameters
    ----------
    friction : Coulomb's coefficient
    ways : of two steps in which it rolls, half-widths
    across : quadratic cells in the half-width
    """
    radius, E, nu, whole = 2000.0, 200.0, 0.41599, sum(ways)
    force = math.pi * E / (1.0 - nu**2) / (4.0 * radius)
    cell = 1.0 / across
    x = np.linspace(-1.4, whole + 1.4, round((whole + 2.8) * across) + 1)
    y = np.linspace(-1.2, 0.0, round(1.2 * across) + 1)
    far = np.cumsum(1.3 * cell * _GROWTH ** np.arange(math.ceil(math.log(_DEPTH * across, _GROWTH))))
    bed = rectangle(
        x=np.concatenate([x[0] - far[::-1], x, x[-1] + far]), y=np.concatenate([y[0] - far[::-1], y]), cells="quad9"
    )
    wheel = Rigid("wheel", Circle((0.0, radius), radius), u=(0.0, None), force=(None, -force), rotation=None)
    return Model(
        mesh=bed,
        kind="plane strain",
        bodies=[Body(next(iter(bed.bodies)), Elastic(E=E, nu=nu))],
        supports=[Support("bottom", u=(-whole, 0.0), name="move")],
        obstacles=[wheel],
        contacts=[Contact("top", "wheel", friction=friction, sliding="finite", name="tread")],
        steps=[
            Step(name="press", scale={"wheel": 1.0, "move": 0.0}),
            Step(name="roll", scale={"wheel": 1.0, "move": ways[0] / whole}),
            Step(name="on", scale={"wheel": 1.0, "move": 1.0}),
        ],
    )


def _half_plane(low: float, high: float, spacing: float, far: Array) -> Mesh:
    """A rectangle below y = 0, fine from ``low`` to ``high`` and eight cells deep; nodes beyond are ``far`` away."""
    x = np.linspace(low, high, round((high - low) / spacing) + 1)
    deep = min(high - low, 8.0 * spacing)
    y = np.linspace(-deep, 0.0, round(deep / spacing) + 1)
    return rectangle(x=np.concatenate([x[0] - far[::-1], x, x[-1] + far]), y=np.concatenate([y[0] - far[::-1], y]))
