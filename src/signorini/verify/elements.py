# SPDX-License-Identifier: BSD-3-Clause
"""Axisymmetric bodies, quadratic cells, incompatible modes and loads inside bodies against closed forms."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from signorini.api import solve
from signorini.meshing.plane import Cells, annulus, quarter_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.reference.discs import rotating_disc
from signorini.reference.hertz import contact_modulus
from signorini.reference.hertz_point import HertzPoint
from signorini.reference.lame import hollow_sphere
from signorini.verify.check import Check, checks_of

_STEEL = Elastic(E=200.0, nu=0.3, density=2.0, expansion=1e-3)


def sphere_on_a_plane() -> Iterator[Check]:
    """An elastic sphere pressed on a rigid plane, contact radius a tenth of the radius, quadratic cells."""
    mesh = quarter_disk(radius=8.0, contact_length=1.0, contact_spacing=0.0625, order=2)
    model = Model(
        mesh,
        kind="axisymmetric",
        bodies=[Body("disk", _STEEL)],
        loads=[Load("cut", force=(0.0, -20.0))],
        contacts=[Contact("arc", Plane(point=(0, 0), normal=(0, 1)))],
    )
    contact = solve(model).contact("arc")
    hertz = HertzPoint(force=20.0, radius=8.0, modulus=contact_modulus((_STEEL.E, _STEEL.nu)))
    r = contact.points[:, 0]
    inside = r < 0.8 * hertz.contact_radius
    worst = np.abs(contact.pressure - hertz.pressure(r))[inside].max() / hertz.peak_pressure
    yield from checks_of(
        "Sphere on a plane (axisymmetric)",
        ("peak pressure", contact.pressure[r.argmin()], hertz.peak_pressure, 0.01),
        ("largest error of the pressure, r < 0.8 a, over the peak", worst, 0.0, 0.01),
        source="Hertz; Johnson (1985) 4.2(a)",
    )


def revolved_hollow_spheres() -> Iterator[Check]:
    """A hollow sphere under pressure: steel in quadratic cells, rubber in cells with a mean dilatation."""
    cases: tuple[tuple[float, Cells, Literal["standard", "mean dilatation"]], ...] = (
        (0.3, "quad8", "standard"),
        (0.49999, "quad", "mean dilatation"),
        (0.49999, "triangle6", "mean dilatation"),
        (0.49999, "quad8", "mean dilatation"),
    )
    for nu, cells, formulation in cases:
        body = Body("ring", Elastic(E=200.0, nu=nu), formulation)
        model = Model(
            annulus(inner=1.0, outer=2.0, n_radial=16, n_angular=32, angle=90.0, cells=cells),
            kind="axisymmetric",
            bodies=[body],
            supports=[Support("start", u=(None, 0))],
            loads=[Load("inner", pressure=3.0)],
        )
        found = solve(model).along([(1.0, 0.0), (1.5, 0.0)], body="ring")
        u, _, hoop = hollow_sphere(np.array([1.0, 1.5]), inner=1.0, outer=2.0, pressure=3.0, E=200.0, nu=nu)
        yield from checks_of(
            f"Hollow sphere, nu = {nu:g}, {cells}" + (f", {formulation}" if nu > 0.4 else ""),
            ("displacement inside", found.displacement[0, 0], u[0], 0.01),
            ("hoop stress in the middle", found.stress[1, 2], hoop[1], 0.01),
            source="Lame; Timoshenko, Goodier 136",
        )


def cantilever() -> Iterator[Check]:
    """Eight square cells in a row, bent by a force at the tip."""
    length, E, nu = 8.0, 1000.0, 0.3
    for cells, order in (("quad, incompatible", 1), ("quad8", 2)):
        bent = Model(
            rectangle(width=length, nx=8, origin=(0.0, -0.5), order=order),
            kind="plane stress",
            bodies=[Body("block", Elastic(E=E, nu=nu), "standard" if order == 2 else "incompatible")],
            supports=[Support("left", u=(0, None)), Support((0.0, -0.5), u=(None, 0))],
            loads=[Load("right", traction=(0, 1.0))],
        )
        tip = solve(bent).along([(length, -0.5)], body="block").displacement[0, 1]
        exact = 4.0 * length**3 / E + 2.4 * length * (1.0 + nu) / E
        yield from checks_of(
            f"Cantilever of 1 x 8 cells, {cells}", ("deflection of the tip", tip, exact, 0.01, "Timoshenko's beam")
        )


def inside_bodies() -> Iterator[Check]:
    """A spinning disc, and a block heated between two walls."""
    mesh = annulus(inner=1.0, outer=2.0, n_radial=8, n_angular=12, angle=90.0, order=2)
    spinning = Model(
        mesh,
        kind="plane stress",
        bodies=[Body("ring", _STEEL)],
        supports=[Support("start", u=(None, 0)), Support("end", u=(0, None))],
        loads=[Load("ring", centrifugal=3.0)],
    )
    found = solve(spinning).along([(1.0, 0.0), (1.5, 0.0)], body="ring")
    at = np.array([1.0, 1.5])
    u, _, hoop = rotating_disc(at, inner=1.0, outer=2.0, omega=3.0, density=2.0, E=_STEEL.E, nu=_STEEL.nu)
    yield from checks_of(
        "Rotating disc, quad8",
        ("displacement inside", found.displacement[0, 0], u[0], 0.005),
        ("hoop stress in the middle", found.stress[1, 1], hoop[1], 0.005),
        source="Timoshenko, Goodier 32",
    )
    heated = Model(
        rectangle(nx=3, ny=2),
        bodies=[Body("block", _STEEL)],
        supports=[Support("bottom", u=(None, 0)), Support("top", u=(None, 0)), Support((0.0, 0.0), u=(0, None))],
        loads=[Load("block", temperature=10.0)],
    )
    stress = solve(heated).stress("block").stress[:, 1].max()
    exact = -10.0 * _STEEL.expansion * _STEEL.E / (1.0 - _STEEL.nu)
    yield from checks_of("Block heated between walls, plane strain", ("stress", stress, exact, 1e-9, "Hooke's law"))
