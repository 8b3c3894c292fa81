# SPDX-License-Identifier: BSD-3-Clause
"""B20: bodies of revolution that turn about their axis."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.api import solve
from signorini.gallery.twisted import (
    BALL,
    STEEL,
    fit_under_torque,
    ring_under_torque,
    screwed_ball,
    shaft_in_torsion,
    turned_punch,
)
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.plastic import Plastic
from signorini.model.step import Step
from signorini.model.varying import Formula
from signorini.reference.torsion import ball_torsion, disc_torque, gross_torque, plastic_torque, shaft_twist
from signorini.verify.check import Check, checks_of

_SHEAR = 1000.0 / 2.6  # of blocks with E 1000 and nu 0.3


def torsion_of_a_shaft() -> Iterator[Check]:
    """A hollow shaft whose end turns by T L / (G J), with linear and quadratic cells."""
    exact = shaft_twist(torque=1000.0, shear_modulus=STEEL.shear_modulus, inner=5.0, outer=10.0, length=8.0)
    for cells in ("quad", "quad8", "quad9"):
        found = solve(shaft_in_torsion(cells=cells)).last
        yield from checks_of(
            f"B20 hollow shaft in torsion, {cells}",
            ("angle between its ends", found.displacement[:, 2].max() / 10.0, exact, 1e-10),
            ("torque on the support", found.reactions["bottom"][2], -1000.0, 1e-10),
            source="Coulomb, T L / (G J)",
        )


def shaft_that_yields() -> Iterator[Check]:
    """A hollow shaft that is twisted beyond first yield and back, with a core that stays elastic."""
    shear = 200.0 / np.sqrt(3.0)
    shaft = shaft_in_torsion(cells="quad8", n=8)
    elastic = shaft_twist(torque=1.0, shear_modulus=STEEL.shear_modulus, inner=5.0, outer=10.0, length=8.0)
    steps = [Step(scale={"turn": part}) for part in (1.3, 1.6, 1.0)]
    found = solve(
        replace(
            shaft,
            bodies=[Body("block", replace(STEEL, plastic=Plastic(yield_stress=200.0)))],
            supports=[*shaft.supports, Support("top", u=(None, None, Formula("0.001*x")), name="turn")],
            loads=[],
            steps=steps,
        )
    )
    first, second, third = (float(step.reactions["turn"][2]) for step in found.steps)
    most, more = (
        plastic_torque(rate=rate / 8.0, shear_modulus=STEEL.shear_modulus, shear_stress=shear, inner=5.0, outer=10.0)
        for rate in (0.0013, 0.0016)
    )
    yield from checks_of(
        "B20 hollow shaft that yields, quad8",
        ("torque with a core of 0.88 of the radius", first, most, 1e-3),
        ("torque with a core of 0.71 of it", second, more, 1e-3),
        ("torque taken back", second - third, 0.0006 / elastic, 1e-9),
        source="Hill (1950), chapter IV",
    )


def torque_of_a_press_fit() -> Iterator[Check]:
    """What a press fit holds: torque alone, force alone, and both at once."""
    for words, turn, pull in (("torque", 0.003, 0.0), ("force", 0.0, 0.03), ("torque and force", 0.003, 0.02)):
        found = solve(fit_under_torque(turn=turn, pull=pull))
        fit, (_, pulled, torque) = found.contact("fit"), found.last.reactions["held"]
        most = 0.2 * float(fit.pressure @ fit.area)
        yield from checks_of(
            f"B20 press fit that slips under {words}",
            ("hypot(T / R, N) over mu F", np.hypot(torque / 10.0, pulled) / most, 1.0, 1e-6),
            source="Coulomb's circle",
        )


def ring_in_space() -> Iterator[Check]:
    """A ring of 48 cells around, turned and pulled, beside its meridian: polygons are that far from circles."""
    ring, whole = solve(ring_under_torque()).last, solve(ring_under_torque(sectors=48)).last
    core, other = ring.rigid_bodies["core"], whole.rigid_bodies["core"]
    yield from checks_of(
        "B20 ring of 48 cells around and its meridian",
        ("torque", np.ravel(other.moment)[2], np.ravel(core.moment)[0], 5e-3),
        ("force along the axis", other.force[2], core.force[1], 5e-3),
        ("strain energy", whole.strain_energy, ring.strain_energy, 5e-3),
        ("dissipation", whole.dissipation, ring.dissipation, 5e-3),
        source="the meridian",
    )


def sticking_punch() -> Iterator[Check]:
    """A flat punch that sticks and is turned."""
    found = solve(turned_punch(turn=0.01, n=12)).contact("seat")
    exact = disc_torque(angle=0.01, shear_modulus=_SHEAR, radius=1.0)
    yield from checks_of(
        "B20 punch that sticks and turns",
        ("torque", found.torque, exact, 0.01),
        source="Reissner, Sagoci (1944)",
    )


def ball_that_turns() -> Iterator[Check]:
    """A ball pressed on a block and turned: torque over angle, and where it sticks."""
    for turn in (0.01, 0.05):
        ball = solve(screwed_ball(turn=turn, n=16)).contact("seat")
        force = -float(ball.normal_force[1])
        radius = float(np.cbrt(0.75 * force * BALL * (1.0 - 0.3**2) / 1000.0))
        parts = np.linspace(0.01, 0.99, 197)
        table = np.array(
            [
                ball_torsion(stick=part * radius, friction=0.5, force=force, radius=radius, shear_modulus=_SHEAR)
                for part in parts
            ]
        )
        stick, torque = (float(np.interp(turn, table[::-1, 0], of[::-1])) for of in (parts, table[:, 1]))
        sticks = ball.points[ball.status == "stick", 0].max()
        most = gross_torque(friction=0.5, force=force, radius=radius)
        yield from checks_of(
            f"B20 ball turned by {turn:g}",
            ("torque, of that of gross slip", ball.torque / most, torque / most, 3e-3),
            ("radius that sticks, of the contact, and 1", 1.0 + sticks / radius, 1.0 + stick, 0.06),
            source="Lubkin (1951)",
        )
