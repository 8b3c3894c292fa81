# SPDX-License-Identifier: BSD-3-Clause
"""B21: sides that are bonded and torn off."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from signorini.api import solve
from signorini.gallery.cohesion import (
    ARM_HEIGHT,
    ARM_LENGTH,
    ARM_MODULUS,
    BAR_AREA,
    BAR_LENGTH,
    BAR_MODULUS,
    CRACK,
    bonded_bar,
    cantilever,
)
from signorini.law.cohesion import Cohesion
from signorini.model.kind import Kind
from signorini.model.step import Step
from signorini.reference.peeling import peel
from signorini.verify.check import Check, checks_of

_LAYER = 1e-3  # length per pressure, in series with the bar


def bar_torn_off() -> Iterator[Check]:
    """A strip, a plug and a bar in space on an elastic layer, drawn off gradually, and at once where it is unstable."""
    bars: tuple[tuple[Kind, str, float], ...] = (
        ("plane stress", "bar", BAR_AREA),
        ("axisymmetric", "plug", math.pi * BAR_AREA**2),
        ("3d", "bar in space", BAR_AREA),
    )
    for kind, name, area in bars:
        yield from _gradually(kind, f"B21 {name} drawn off an elastic layer", area)
        yield from _at_once(kind, f"B21 {name} torn off at once", area, Cohesion(5.0))
        if kind != "axisymmetric":  # the rim of a plug holds on when its middle has let go, where they differ
            yield from _at_once(kind, f"B21 {name} torn off at once that softens", area, Cohesion(5.0, opening=0.004))


def _gradually(kind: Kind, title: str, area: float) -> Iterator[Check]:
    """A bar of an area that is drawn off its bond, let back and drawn off."""
    soft = BAR_LENGTH / BAR_MODULUS + _LAYER
    bond = Cohesion(5.0, opening=0.04)
    steps = [Step(scale={"pull": stretch}) for stretch in (0.012, 0.004, 0.06)]
    drawn, back, gone = solve(bonded_bar(bond, 1.0, kind=kind, compliance=_LAYER, steps=steps)).steps
    opening = (0.012 / soft - 5.0) / (1.0 / soft - 125.0)
    slope = 5.0 * (1.0 / opening - 25.0)
    yield from checks_of(
        title,
        ("tension where it softens", -drawn.contacts[0].pressure.mean(), (0.012 - opening) / soft, 1e-12),
        ("tension on the way back", -back.contacts[0].pressure.mean(), 0.004 * slope / (1.0 + soft * slope), 1e-12),
        ("stretch at which it softens", drawn.events[0].load_factor * 0.012, 5.0 * soft, 1e-12),
        ("work, energy per area times area", sum(s.work for s in (drawn, back, gone)), area * bond.energy, 1e-12),
        source="series of bar, layer and bond",
    )


def _at_once(kind: Kind, title: str, area: float, bond: Cohesion) -> Iterator[Check]:
    """A bar of an area whose bond gives way faster than bar and layer spring back."""
    soft = BAR_LENGTH / BAR_MODULUS + _LAYER
    step = solve(bonded_bar(bond, 0.02, kind=kind, compliance=_LAYER)).steps[0]
    stored = 0.5 * 5.0**2 * soft * area
    yield from checks_of(
        title,
        ("work up to there", step.work, stored, 1e-12),
        ("energy taken by the bond", step.dissipation, area * bond.energy, 1e-12),
        ("energy set free", step.released, stored - area * bond.energy, 1e-11),
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


def strip_in_space() -> Iterator[Check]:
    """An arm in space, that does not contract, turned off its glue."""
    bond = Cohesion(2.5, opening=0.024, shear="free")
    limit = math.sqrt(2.0 * ARM_MODULUS * ARM_HEIGHT**3 / 12.0 * bond.energy)
    steps = [Step(scale={"peel": turn}) for turn in (0.06, 0.08)]
    turned = solve(cantilever(bond, rotation=1.0, solid=True, steps=steps)).steps
    moment = turned[1].rigid_bodies["grip"].moment
    yield from checks_of(
        "B21 strip in space peeled off by a moment",
        ("moment, M^2 = 2 E I G", float(np.abs(moment).max()), limit, 5e-3),
        ("work of 0.02 radians", turned[1].work, 0.02 * limit, 1e-3),
        source="beam theory, energy per area of a growing crack",
    )


def brittle_arm() -> Iterator[Check]:
    """An arm on an elastic layer that breaks node by node: the lift at which its crack is 1 longer, on finer cells."""
    bond, compliance, lift, lifts = Cohesion(3.0, shear="free"), 0.02, 0.36, list[float]()
    exact = peel(
        strength=bond.strength, compliance=compliance, crack=CRACK + 1.0, modulus=ARM_MODULUS, height=ARM_HEIGHT
    )
    source = "beam with shear on a Winkler bed (Kanninen 1973)"
    for cells, tolerance in ((32, 0.1), (64, 0.05), (128, 0.025)):
        step = solve(cantilever(bond, lift=lift, cells=cells, compliance=compliance)).steps[0]
        breaks = [event for event in step.events if event.what == "breaks"]
        lifts.append(breaks[round(cells / ARM_LENGTH)].load_factor * lift)
        yield from checks_of(
            f"B21 brittle arm, cells of {ARM_LENGTH / cells:g} of its height",
            ("lift at which the bond breaks there", lifts[-1], exact.lift, tolerance),
            ("work less what is stored and set free, of it", step.energy_defect / step.work, 0.0, 1e-12),
            source=source,
        )
    yield from checks_of(
        "B21 brittle arm, extrapolated",
        ("lift at which the bond breaks there", 2.0 * lifts[-1] - lifts[-2], exact.lift, 1e-3),
        source=source,
    )
