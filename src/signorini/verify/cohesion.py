# SPDX-License-Identifier: BSD-3-Clause
"""B21: sides that are bonded and torn off."""

from __future__ import annotations

import math
from collections.abc import Iterator

from signorini.api import solve
from signorini.gallery.cohesion import (
    ARM_HEIGHT,
    ARM_MODULUS,
    BAR_AREA,
    BAR_LENGTH,
    BAR_MODULUS,
    bonded_bar,
    cantilever,
)
from signorini.law.cohesion import Cohesion
from signorini.model.step import Step
from signorini.verify.check import Check, checks_of

_LAYER = 1e-3  # length per pressure, in series with the bar


def bar_torn_off() -> Iterator[Check]:
    """A bar on an elastic layer, drawn off gradually, and at once where the bond is stiffer than both."""
    soft = BAR_LENGTH / BAR_MODULUS + _LAYER
    bond = Cohesion(5.0, opening=0.02)
    steps = [Step(scale={"pull": stretch}) for stretch in (0.012, 0.004, 0.03)]
    drawn, back, gone = solve(bonded_bar(bond, 1.0, compliance=_LAYER, steps=steps)).steps
    opening = (0.012 / soft - 5.0) / (1.0 / soft - 250.0)
    slope = 5.0 * (1.0 / opening - 50.0)
    yield from checks_of(
        "B21 bar drawn off an elastic layer",
        ("tension where it softens", -drawn.contacts[0].pressure.mean(), (0.012 - opening) / soft, 1e-12),
        ("tension on the way back", -back.contacts[0].pressure.mean(), 0.004 * slope / (1.0 + soft * slope), 1e-12),
        ("stretch at which it softens", drawn.events[0].load_factor * 0.012, 5.0 * soft, 1e-12),
        ("work, energy per area times area", sum(s.work for s in (drawn, back, gone)), BAR_AREA * bond.energy, 1e-12),
        source="series of bar, layer and bond",
    )
    sudden = Cohesion(5.0, opening=0.004)
    step = solve(bonded_bar(sudden, 0.02, compliance=_LAYER)).steps[0]
    stored = 0.5 * 5.0**2 * soft * BAR_AREA
    yield from checks_of(
        "B21 bar torn off at once",
        ("work up to there", step.work, stored, 1e-12),
        ("energy taken by the bond", step.dissipation, BAR_AREA * sudden.energy, 1e-12),
        ("energy set free", step.released, stored - BAR_AREA * sudden.energy, 1e-11),
        source="series of bar, layer and bond",
    )


def double_cantilever() -> Iterator[Check]:
    """An arm of a double cantilever beam, turned and lifted: moments of linear fracture mechanics of beams."""
    inertia = ARM_HEIGHT**3 / 12.0
    bond = Cohesion(2.5, opening=0.024, shear="free")
    limit = math.sqrt(2.0 * ARM_MODULUS * inertia * bond.energy)
    steps = [Step(scale={"peel": turn}) for turn in (0.06, 0.08)]
    turned = solve(cantilever(bond, rotation=1.0, steps=steps)).steps
    crack = bond.energy * ARM_MODULUS * inertia / limit * 0.02
    yield from checks_of(
        "B21 arm peeled off by a moment",
        ("moment, M^2 = 2 E I G", abs(float(turned[1].rigid_bodies["grip"].moment)), limit, 5e-3),
        ("work of 0.02 radians", turned[1].work, 0.02 * limit, 5e-3),
        ("energy taken meanwhile", turned[1].dissipation, crack, 4e-2),
        source="beam theory, energy per area of a growing crack",
    )
    fast = Cohesion(5.0, opening=0.012, shear="free")
    lifted = solve(cantilever(fast, lift=1.0, steps=[Step(scale={"peel": lift}) for lift in (0.3, 0.5)])).steps
    for lift, step in zip((0.3, 0.5), lifted, strict=True):
        force = abs(float(step.rigid_bodies["grip"].force[1]))
        # deflection of the arm, P a^3 / 3 E I with shear, of the length a that P a = M gives
        arm = limit / force
        bent = force * arm**3 / (3.0 * ARM_MODULUS * inertia) + 1.2 * force * arm / (0.5 * ARM_MODULUS * ARM_HEIGHT)
        yield from checks_of(
            f"B21 arm lifted by {lift:g}",
            ("lift of a beam that ends where M^2 = 2 E I G", lift, bent, 2e-2),
            source="beam theory, energy per area of a growing crack",
        )
