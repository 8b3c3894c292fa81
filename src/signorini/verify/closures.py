# SPDX-License-Identifier: BSD-3-Clause
"""B19: sides that close on what lies between them."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from signorini.api import solve
from signorini.gallery.closures import GASKET, HEIGHT, MODULUS, block_on_a_bed, worn_layer
from signorini.law.closure import Closure
from signorini.model.step import Step
from signorini.verify.check import Check, checks_of

_ROUGHNESS = 0.01, 2.0  # clearance, length, and pressure where sides touch


def block_on_a_gasket() -> Iterator[Check]:
    """A block on a gasket: its top, where kinks are met, and the energy against the table's own integral."""
    closures, pressures = np.transpose(GASKET.points)
    for pressure in (2.5, 6.0, 35.0):
        step = solve(block_on_a_bed(pressure)).steps[0]
        slope = (closures[-1] - closures[-2]) / (pressures[-1] - pressures[-2])
        closed = float(np.interp(pressure, pressures, closures)) + slope * max(0.0, pressure - pressures[-1])
        at = np.append(pressures[pressures < pressure], pressure)
        by = np.append(closures[pressures < pressure], closed)
        energy = 2.0 * float(np.trapezoid(at, by))
        kinks = [event.load_factor for event in step.events if event.what in ("stiffens", "softens")]
        yield from checks_of(
            f"B19 block on a gasket, p {pressure:g}",
            ("how far its top goes down", -step.displacement[:, 1].min(), closed + pressure * HEIGHT / MODULUS, 1e-12),
            ("energy of the gasket", step.interface_energy, energy, 1e-12),
            ("work of the load", step.work, energy + pressure**2 / MODULUS * HEIGHT, 1e-12),
            ("load of the last kink", kinks[-1] * pressure, pressures[:-1][pressures[:-1] < pressure][-1], 1e-12),
            source="the table of the gasket",
        )


def gasket_in_a_cycle() -> Iterator[Check]:
    """A block on a gasket that keeps closure: pressed, let go and pressed again, farther."""
    law = Closure([(0.0, 0.0), (0.1, 2.0), (0.15, 10.0)], unloading=400.0)
    steps = [Step(scale={"p": part}, path="exact") for part in (0.6, 0.0, 1.0)]
    pressed, free, again = solve(block_on_a_bed(10.0, law, steps=steps)).steps
    yield from checks_of(
        "B19 block on a gasket that keeps closure",
        ("closure kept of 0.125", -free.contacts[0].gap.mean(), 0.125 - 6.0 / 400.0, 1e-12),
        ("energy taken", pressed.dissipation, 2.0 * (0.1 + 0.025 * 4.0 - 6.0**2 / 800.0), 1e-12),
        ("part of the way at which it goes on as before", again.events[-1].load_factor - 2.0, 0.6, 1e-12),
        ("energy taken then", again.dissipation, 2.0 * (0.025 * 8.0 - (10.0**2 - 6.0**2) / 800.0), 1e-12),
        source="the lines of the gasket",
    )


def rough_interface() -> Iterator[Check]:
    """A block on roughness of an exponential law: closures of secants, beside the law itself."""
    clearance, touching = _ROUGHNESS
    law = Closure.exponential(clearance, touching, tolerance=1e-3)
    for x in (0.5, 1.0, 3.0):
        pressure = touching * x * math.expm1(x) / math.expm1(1.0)
        gap = solve(block_on_a_bed(pressure, law, steps=[Step(increments=1)])).contact("bed").gap
        yield from checks_of(
            f"B19 block on roughness, p {pressure:.3g}",
            ("gap over the clearance, and 1", 1.0 + float(gap.mean()) / clearance, 2.0 - x, 2e-3),
            source="p = p_0 x (exp x - 1) / (e - 1)",
        )


def layer_that_wears() -> Iterator[Check]:
    """A layer of two lines that is rubbed and worn, on sides that slide far: cycle by cycle in closed form."""
    table, cycles = [(0.0, 0.0), (0.02, 4.0), (0.04, 20.0)], 6
    step = solve(worn_layer(table, cycles=cycles, sliding="finite")).steps[-1]
    closures, pressures = np.transpose(table)
    overlap, worn = 0.03, 0.0
    for _ in range(cycles):
        loss = 1e-3 * float(np.interp(overlap, closures + 5e-6 * pressures, pressures))
        overlap, worn = overlap - loss, worn + loss
    contact = step.contacts[0]
    assert contact.wear is not None
    yield from checks_of(
        "B19 layer that is worn by sliding",
        (
            "pressure left",
            float(contact.pressure.mean()),
            float(np.interp(overlap, closures + 5e-6 * pressures, pressures)),
            1e-11,
        ),
        ("worn depth", float(contact.wear.depth.max()), worn, 1e-11),
        ("energy balance, and 1", 1.0 + step.energy_defect / step.released, 1.0, 1e-12),
        source="k p s of every cycle",
    )
