# SPDX-License-Identifier: BSD-3-Clause
"""Yield stresses that depend on temperature: bars that are pulled and heated, beside closed forms."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from tests.helpers.yielding import block

E = 2e5
ONCE = (sg.Step(),)
LAW = sg.Plastic([(0.0, 235.0, 0.0), (0.1, 300.0, 0.0), (0.0, 150.0, 200.0), (0.05, 180.0, 200.0)])
RECOVERS = sg.Plastic([(0.0, 235.0, 0.0), (0.0, 150.0, 200.0), (0.0, 260.0, 300.0)], hardening=1e3)


def bar(law, stress, temperature, *, kind="plane stress", steps=ONCE, **given):
    """A block under uniaxial stress along x, in space and of a ring along its last axis, and a temperature."""
    d = 3 if kind == "space" else 2
    names = ("left", "front", "bottom") if d == 3 else ("left", "bottom")
    supports = [
        sg.Support(name, u=tuple(0.0 if axis == i else None for axis in range(d)))
        for i, name in enumerate(names)
        if kind != "axisymmetric" or name == "bottom"
    ]
    pull = (*(0.0,) * (d - 1), stress)
    loads = [
        sg.Load("top", traction=pull, name="pull"),
        sg.Load("block", temperature=temperature, name="heat"),
    ]
    return block(kind, law, n=2, E=E, supports=supports, loads=loads, steps=list(steps), **given)


KINDS = pytest.mark.parametrize(
    ("kind", "formulation"),
    [("plane stress", None), ("plane stress", "incompatible"), ("axisymmetric", None), ("space", None)]
    + [("space", "incompatible")],
)


@KINDS
def test_pulled_and_heated_at_once(kind, formulation):
    """``170 s = 235 - 85 s`` at first yield; at the end the curve of 200 has 170 at a plastic strain of 1/30."""
    solution = sg.solve(bar(LAW, 170.0, 200.0, kind=kind, formulation=formulation))
    (step,) = solution.steps
    assert step.yielding.first == pytest.approx(235.0 / 255.0, rel=1e-9)
    assert step.yielding.largest == pytest.approx(0.05 * 20.0 / 30.0, rel=1e-7)
    assert step.certificate.passed
    assert abs(step.energy_defect) < 1e-8 * step.work


@KINDS
def test_heat_alone_makes_flow_under_a_load_that_stays(kind, formulation):
    law = sg.Plastic([(0.0, 235.0, 0.0), (0.0, 150.0, 200.0)], hardening=1e3)
    cold, warm = sg.Step(scale={"pull": 1.0, "heat": 0.0}), sg.Step(scale={"pull": 1.0, "heat": 1.0})
    solution = sg.solve(bar(law, 180.0, 200.0, kind=kind, formulation=formulation, steps=[cold, warm]))
    assert solution.steps[0].yielding.first is None
    assert solution.steps[1].yielding.first == pytest.approx(1.0 + 55.0 / 85.0, rel=1e-9)
    assert solution.last.yielding.largest == pytest.approx(0.03, rel=1e-7)


def test_first_yield_between_states_that_do_not():
    """At 200 the bar is weakest: it yields on the way to 300, where it would bear its load; more so at 160 of it."""
    step = sg.Step(increments=100)
    solution = sg.solve(bar(RECOVERS, 240.0, 300.0, steps=[step]))
    assert solution.last.yielding.first == pytest.approx(235.0 / 367.5, rel=1e-9)
    assert solution.last.yielding.largest == pytest.approx(0.01, rel=0.05)
    below = sg.solve(bar(RECOVERS, 220.0, 300.0, steps=[step]))
    assert below.last.yielding.first is None


def test_constant_below_and_above_its_temperatures():
    for temperature, stress in ((-100.0, 235.0), (200.0, 150.0), (1000.0, 150.0)):
        assert LAW.at(np.array(0.0), temperature)[0] == stress
    step = sg.solve(bar(LAW, 240.0, -100.0)).last
    assert step.yielding.first == pytest.approx(235.0 / 240.0, rel=1e-9)


def test_uneven_heat_flows_where_it_is_warm():
    """A bar warm at its right end alone flows there alone; the certificate knows the yield stress of every point."""
    law = sg.Plastic([(0.0, 235.0, 0.0), (0.0, 115.0, 200.0)], hardening=2e3)
    solution = sg.solve(bar(law, 150.0, lambda points: 200.0 * points[:, 0]))
    assert solution.last.certificate.passed
    assert 0.0 < solution.last.yielding.share < 1.0
    assert solution.last.yielding.at[0] > 0.5


def test_limit_loads_are_those_of_the_temperature():
    solution = sg.solve(
        bar(LAW, 400.0, 200.0, steps=[sg.Step(scale={"pull": 0.0, "heat": 1.0}), sg.Step()]), raise_on_failure=False
    )
    assert solution.status == "no_equilibrium"
    assert "flow plastically at 45.000" in solution.message


SOFTENED = sg.Plastic([(0.0, 235.0, 0.0), (0.0, 150.0, 200.0), (0.0, 260.0, 300.0)])
COLD, STEEP = sg.Step(scale={"pull": 1.0, "heat": 0.0}), sg.Step(scale={"pull": 1.0, "heat": 1.0})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("stress", "temperature", "steps", "limit"),
    [
        (235.0, 200.0, [STEEP], 235.0 / 320.0),  # 235 s = 235 - 85 s
        (180.0, 200.0, [COLD, STEEP], 55.0 / 85.0),  # heat alone: 235 - 85 s = 180
        (200.0, 300.0, [COLD, STEEP], 35.0 / 127.5),  # it would bear its load at the end, and not on the way there
        (240.0, -100.0, [STEEP], 235.0 / 240.0),  # colder than its tables
    ],
)
@pytest.mark.parametrize(("kind", "formulation"), [("plane stress", "incompatible"), ("space", None)])
def test_collapse_on_the_way_to_another_temperature_is_named_where_it_is(
    kind, formulation, stress, temperature, steps, limit
):
    model = bar(SOFTENED, stress, temperature, kind=kind, formulation=formulation, steps=steps)
    history = sg.solve(model, raise_on_failure=False)
    assert history.status == "no_equilibrium"
    named = float(history.message.split("flow plastically at ")[1].split("%")[0]) / 100.0
    loose = 0.02 if formulation else 2e-4  # modes leave a motion more ways to flow, dearer ones too
    assert limit * (1.0 - 1e-6) <= named <= limit * (1.0 + loose)


@pytest.mark.slow
@pytest.mark.parametrize("formulation", [None, "incompatible"])
@pytest.mark.parametrize("warm", [-1e-3, 1e-3])
def test_thermal_stresses_are_no_loads_of_a_limit(warm, formulation):
    """They balance each other: in plane stress flow changes areas, on which thermal forces do work all the same."""
    model = bar(LAW, 250.0, lambda points: warm / 1e-5 * points[:, 0], formulation=formulation)
    (body,) = model.bodies
    steel = replace(body.material, expansion=1e-5, plastic=sg.Plastic(235.0))
    history = sg.solve(replace(model, bodies=[replace(body, material=steel)]), raise_on_failure=False)
    assert history.status == "no_equilibrium"
    named = float(history.message.split("flow plastically at ")[1].split("%")[0]) / 100.0
    assert 0.94 * (1.0 - 1e-6) <= named <= 0.94 * 1.001


def test_what_a_table_of_temperatures_cannot_be():
    for rows, words in (
        ([(0.0, 2.0, 20.0), (0.0, 1.0, 10.0)], "yield_stress[1][2]: is 10 after 20; expected increasing temperatures"),
        ([(0.0, 2.0, 20.0), (0.1, 1.0, 30.0)], "yield_stress[1][0]: is 0.1; expected 0, the plastic strain at first"),
        ([(0.0, 2.0, 20.0), (0.0, 0.0, 30.0)], "yield_stress[1][1]: is 0.0; expected a number > 0"),
        (
            [(0.0, 2.0, 0.0), (0.1, 3.0, 0.0), (0.0, 2.2, 9.0), (0.1, 2.5, 9.0)],
            "yield_stress[3][1]: is 2.5: the curve of temperature 9 crosses that of 0 before a plastic strain of 0.1",
        ),
        ([(0.0, 2.0, 20.0), (0.1, 2.0)], "yield_stress: holds what is no number; expected rows of 3 numbers"),
        ([(0.0, 2.0, 20.0), (0.1, 1.0, 20.0)], "yield_stress[1][1]: is 1 after 2: the material softens"),
    ):
        with pytest.raises(sg.InputError) as caught:
            sg.Plastic(rows)
        assert str(caught.value).startswith(words)


def test_a_temperature_needs_a_body_that_feels_it():
    model = bar(LAW, 100.0, 10.0)
    assert model.bodies[0].material.expansion == 0.0
    stiff = [replace(body, material=replace(body.material, plastic=sg.Plastic(1e3))) for body in model.bodies]
    with pytest.raises(sg.InputError, match="'block' has no thermal expansion; expected it in its material"):
        replace(model, bodies=stiff)


def test_histories_go_on_through_an_archive(tmp_path):
    steps = [sg.Step(increments=2), sg.Step(scale={"heat": 0.3, "pull": 1.1}, increments=2)]
    whole = sg.solve(bar(LAW, 170.0, 200.0, steps=steps))
    cut = sg.solve(bar(LAW, 170.0, 200.0, steps=steps[:1]))
    cut.write(tmp_path / "cut.h5")
    rest = sg.solve(bar(LAW, 170.0, 200.0, steps=steps[1:]), start=sg.load(tmp_path / "cut.h5"))
    assert whole.end.state.plastic.equivalent.tolist() == rest.end.state.plastic.equivalent.tolist()
    assert rest.model.bodies[0].material.plastic == LAW
