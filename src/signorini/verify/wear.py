# SPDX-License-Identifier: BSD-3-Clause
"""Contacts that wear: worn volumes, a cylinder that is rubbed flat, the limit of partial slip."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.engine.solve import solve
from signorini.gallery.half_planes import EQUAL, HALF_WIDTH, equal_half_planes
from signorini.gallery.half_planes import FRICTION as EQUAL_FRICTION
from signorini.gallery.sliding import driven_wheel, half_width
from signorini.gallery.wearing import FRICTION, RADIUS, WEAR, block_in_space, fretting, rubbed_cylinder, to_and_fro
from signorini.model.conditions import Support
from signorini.model.step import Step
from signorini.model.wear import Wear
from signorini.verify.check import Check, checks_of

_COEFFICIENT = 4.8e-6  # 1/MPa, of both sides together: a hundred times that of steel in fretting


def worn_volumes() -> Iterator[Check]:
    """A cylinder rubbed on a flat, nodes opposite nodes and not: 5 cycles, each side its own coefficient."""
    archard = Wear(0.4 * _COEFFICIENT, mortar=0.6 * _COEFFICIENT)
    for ratio in (1.0, 0.75):
        history = solve(rubbed_cylinder(to_and_fro(5), wear=archard, spacing=0.02, ratio=ratio))
        contact, state = history.steps[-1].contacts[0], history.end.state if history.end else None
        assert contact.wear is not None
        assert state is not None
        assert state.wear is not None
        rubbed = sum(step.dissipation for step in history.steps) / FRICTION  # all that slides is at mu p
        pending = float(state.wear.loose.sum())  # by the last change of pressures
        one, other = contact.wear.volume
        step = history.steps[-1]
        yield from checks_of(
            f"worn volume, {'matching' if ratio == 1.0 else 'other'} meshes",
            ("worn volume / k int p ds", (one + other + pending) / (_COEFFICIENT * rubbed), 1.0, 1e-12),
            ("mortar / nonmortar side", other / one, 1.5, 1e-12),
            ("energy defect / work", step.energy_defect / step.work, 0.0, 1e-12, "first law"),
            source="Archard (1953)",
        )
    alpha = _COEFFICIENT / FRICTION
    by_energy = Wear(energy=0.4 * alpha, mortar=0.6 * alpha)
    ends = [solve(rubbed_cylinder(to_and_fro(3), wear=wear, spacing=0.02)).end for wear in (archard, by_energy)]
    depth, same = (end.state.wear.depth for end in ends if end is not None and end.state.wear is not None)
    yield from checks_of(
        "wear by energy, mu constant",
        ("depths: largest difference / deepest", np.abs(depth - same).max() / depth.max(), 0.0, 1e-12),
        source="alpha = k / mu",
    )


def worn_cylinder() -> Iterator[Check]:
    """A cylinder that is rubbed flat: 100 cycles that wear as 4000, one by one, nodes at 0.02."""
    wear = Wear(40.0 * 4e-8)
    contact = solve(rubbed_cylinder(to_and_fro(100), wear=wear, spacing=0.02, stroke=0.025)).steps[-1].contacts[0]
    assert contact.wear is not None
    half = float((1.5 * RADIUS * sum(contact.wear.volume)) ** (1.0 / 3.0))
    yield from checks_of(
        "cylinder rubbed flat",
        ("half-width, to a node distance", 0.5 * contact.closed_area, half, 0.02 / half, "worn area 2 a^3 / 3 R"),
        ("deepest", contact.wear.deepest[0], half**2 / (2.0 * RADIUS), 0.03, "a^2 / 2 R"),
        source="rigid cylinder",
    )


def fretting_over_elements() -> Iterator[Check]:
    """McColl, Ding and Leen's cylinder, 1000 cycles of 25 um to and fro in blocks of 100, nodes at 0.02."""
    steps = fretting(1000, block=100)
    history = solve(rubbed_cylinder(steps, spacing=0.02, stroke=0.025, sliding="finite"))
    step = history.steps[-1]
    assert step.contacts[0].wear is not None
    assert history.end is not None
    assert history.end.state.wear is not None
    wear = history.end.state.wear
    rubbed = sum(step.dissipation for step in history.steps) / FRICTION
    coefficients = WEAR.nonmortar + WEAR.mortar
    yield from checks_of(
        "fretting over elements, 1000 cycles",
        ("depth of the flat, um", 1e3 * step.contacts[0].wear.deepest[1], 0.3784, 0.02, "level sets (published)"),
        ("worn volume / k int p ds", float((wear.volume + wear.loose).sum()) / (coefficients * rubbed), 1.0, 1e-12),
        ("energy defect / work", step.energy_defect / step.work, 0.0, 1e-12, "first law"),
        source="Archard (1953)",
    )


def worn_track() -> Iterator[Check]:
    """A rigid wheel that turns by a fifth more than it rolls: its bed is slid over by a fifth of the contact."""
    creepage, coefficient, modulus = 0.2, 1e-6, 200.0 / (1.0 - 0.499**2)
    model = driven_wheel(ratio=0.0, ways=(3.0, 3.0), across=4)
    (wheel,), (tread,) = model.obstacles, model.contacts
    a = half_width(10.0, 100.0, modulus)
    turns = replace(wheel, u=(0.0, 0.0), force=(None, None), rotation=-(1.0 + creepage) * 6.0 * a / 100.0)
    supports = [
        Support("bottom", u=(-6.0 * a, None), name="move"),
        Support("bottom", u=(None, 0.03 * a), name="lift"),
    ]
    steps = [
        Step(name="press", scale={"lift": 1.0, "move": 0.0, "wheel": 0.0}),
        Step(name="roll", scale={"lift": 1.0, "move": 1.0, "wheel": 1.0}),
    ]
    worn = replace(tread, wear=Wear(coefficient))
    step = solve(replace(model, obstacles=[turns], contacts=[worn], supports=supports, steps=steps)).steps[-1]
    wear = step.contacts[0].wear
    assert wear is not None
    middle = wear.depths[np.abs(wear.points[:, 0] - 3.0 * a) < 1.1 * a]
    force = float(np.mean([np.linalg.norm(instant.contacts[0].normal_force) for instant in step.instants]))
    yield from checks_of(
        "worn track of a wheel with creepage",
        ("shallowest in the middle / k P xi", middle.min() / (coefficient * force * creepage), 1.0, 0.01),
        ("deepest", middle.max() / (coefficient * force * creepage), 1.0, 0.01),
        source="int p ds = xi P",
    )


def worn_block() -> Iterator[Check]:
    """A block in space that hardly strains, pushed over its bed ten times to and fro, in blocks of five cycles."""
    rate, stroke, cycles = 1e-6, 0.05, 10
    press = Step(name="press", scale={"press": 1.0, "drive": 0.0})
    rub = Step(name="rub", scale={"press": [1.0, 1.0], "drive": [1.0, 0.0]}, repeat=cycles, block=5)
    both = Wear(rate, mortar=2.0 * rate)
    history = solve(block_in_space([press, rub], wear=both, stroke=stroke, modulus=2e5))
    step, state = history.steps[-1], history.end.state if history.end else None
    assert state is not None
    assert state.wear is not None
    worn = float(state.wear.volume.sum() + state.wear.loose.sum())
    rubbed = sum(step.dissipation for step in history.steps) / 0.3  # all that slides is at mu p
    yield from checks_of(
        "a block slides on its bed in space, blocks of five cycles",
        ("worn volume / k P s, all of the stroke", worn / (3.0 * rate * 2.0 * stroke * cycles), 1.0, 4e-4),
        ("worn volume / k int p ds", worn / (3.0 * rate * rubbed), 1.0, 1e-4),
        ("energy defect / work", step.energy_defect / step.work, 0.0, 1e-4, "first law"),
        source="Archard (1953)",
    )


def worn_annulus() -> Iterator[Check]:
    """Two equal cylinders in partial slip, 0.7 mu P to and fro, worn until the annulus of slip carries nothing."""
    share = 0.7
    steps = [
        Step(name="press", scale={"press": 1.0}),
        Step(name="pull", scale={"pull": share}),
        Step(name="cycles", scale={"pull": [-share, share]}, repeat=200),
    ]
    model = equal_half_planes(steps)
    contact = replace(model.contacts[0], wear=Wear(5.0, mortar=5.0))
    found = solve(replace(model, contacts=[contact])).steps[-1].contacts[0]
    assert found.wear is not None
    force, held = EQUAL.normal.force, EQUAL.stick_half_width(share * EQUAL_FRICTION * EQUAL.normal.force)
    x, spacing = np.abs(found.points[:, 0]), 0.05 * HALF_WIDTH
    stuck = found.status == "stick"
    edge = x[stuck].max() + 0.5 * spacing  # half-way to the first node that carries nothing
    full = force * (edge / HALF_WIDTH) ** 2  # what presses a parabola on so far, the rest as a flat punch
    middle = float(found.pressure[x.argmin()])
    yield from checks_of(
        "partial slip, worn to its limit",
        ("force in the zone of stick / P", (found.pressure * found.area)[stuck].sum() / force, 1.0, 1e-5),
        ("depth there / deepest", found.wear.depth[stuck].max() / max(found.wear.deepest), 0.0, 1e-12),
        ("c/a, to one and a half node distances", edge / HALF_WIDTH, held / HALF_WIDTH, 1.5 * spacing / held),
        ("pressure in the middle", middle, (force + full) / (np.pi * edge), 0.03),
        source="Ciavarella, Hills (1999)",
    )
