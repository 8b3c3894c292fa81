# SPDX-License-Identifier: BSD-3-Clause
"""Bolts, sectors of rings and loads that vary from place to place, together with bodies that yield."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.bolts import PRELOAD, bolted_sleeve
from signorini.gallery.sectors import ring_on_pads
from tests.helpers.yielding import block

pytestmark = pytest.mark.slow


def sleeve(law):
    """The bolted sleeve whose shank, of area 1, yields."""
    model, *_ = bolted_sleeve()
    bodies = [
        replace(body, material=replace(body.material, plastic=law)) if body.name == "bolt.shank" else body
        for body in model.bodies
    ]
    return replace(model, bodies=bodies)


def test_a_bolt_yields_while_it_is_tightened_and_again_where_it_is_pulled():
    """Its force is the stress of the shank; with its length locked it takes its share of the pull."""
    tighten, pull = sg.solve(sleeve(sg.Plastic(5.0, hardening=20.0))).steps
    assert tighten.yielding.first == pytest.approx(5.0 / PRELOAD, rel=1e-9)
    assert tighten.bolts["bolt"].force == pytest.approx(PRELOAD, rel=1e-9)
    assert tighten.yielding.largest == pytest.approx((PRELOAD - 5.0) / 20.0, rel=0.02)  # but where it is held
    assert pull.yielding.first == pytest.approx(1.0, abs=1e-9)
    assert PRELOAD < pull.bolts["bolt"].force < 2.0 * PRELOAD
    assert all(step.certificate.passed for step in (tighten, pull))
    assert abs(tighten.energy_defect) < 1e-9 * tighten.work


def test_a_bolt_that_cannot_bear_its_force_is_told():
    history = sg.solve(sleeve(sg.Plastic(5.0)), raise_on_failure=False)
    assert history.status == "no_equilibrium"
    assert "step 'tighten': bodies flow plastically at 84.8" in history.message  # 5 / 6 but where it is held


def test_a_sector_of_a_ring_yields_as_the_whole_does():
    found = []
    for whole in (False, True):
        model = ring_on_pads(whole=whole)
        law = sg.Plastic(0.35, hardening=5.0)
        bodies = [sg.Body(body.name, replace(body.material, plastic=law)) for body in model.bodies]
        steps = [replace(step, increments=2) for step in model.steps]
        end = sg.solve(replace(model, bodies=bodies, steps=steps)).last
        assert end.certificate.passed
        found.append((end.yielding.largest, end.contacts[0].pressure))
    assert found[0][0] > 1e-3
    assert found[0][0] == pytest.approx(found[1][0], rel=1e-9)
    np.testing.assert_allclose(found[0][1], found[1][1], rtol=1e-8)


@pytest.mark.parametrize("kind", ["plane strain", "plane stress", "axisymmetric"])
def test_pressure_and_heat_that_vary_condensed_and_iterated(kind):
    wall = sg.Plane(point=(0.0, 1.001), normal=(0.0, -1.0))
    model = block(
        kind,
        sg.Plastic(1.0, hardening=20.0),
        n=3,
        E=1000.0,
        supports=[sg.Support("bottom", u=(0.0, 0.0))],
        contacts=[sg.Contact("top", wall, name="wall")],
    )
    bodies = [replace(body, material=replace(body.material, expansion=1e-3)) for body in model.bodies]
    model = replace(
        model,
        bodies=bodies,
        loads=[
            sg.Load("top", pressure=sg.Formula("2*x")),
            sg.Load("block", temperature=sg.Formula("3*y"), name="heat"),
        ],
        steps=[sg.Step(increments=2), sg.Step(scale={"heat": 0.0}, increments=2)],
    )
    one, two = (sg.solve(model, backend=backend).last for backend in ("auto", "iterative"))
    assert one.certificate.passed
    assert two.certificate.passed
    assert one.yielding.largest > 1e-2
    assert one.yielding.largest == pytest.approx(two.yielding.largest, rel=1e-6)
