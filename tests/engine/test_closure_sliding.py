# SPDX-License-Identifier: BSD-3-Clause
"""Sides that slide far, wear, or both, across what closes by a law: against closed forms and one compliance."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.gallery.closures import GASKET, worn_layer

RADIUS, DEPTH, STROKE = 20.0, 0.03, 0.3
STEEP = 12000.0  # pressure per closure: beyond the steepest line of the gasket


def bed_on_a_circle(closure):
    """A stiff block, 2 wide, with a bed below it, that is pressed on a rigid circle by a depth and driven along it."""
    return sg.Model(
        sg.rectangle(width=2.0, height=0.5, nx=4, ny=1, origin=(-1.0, 0.0)),
        kind="plane strain",
        bodies=[sg.Body("block", sg.Elastic(E=1e7, nu=0.0))],
        supports=[
            sg.Support("top", u=(None, -DEPTH), name="press"),
            sg.Support("top", u=(STROKE, None), name="drive"),
        ],
        contacts=[
            sg.Contact(
                "bottom",
                sg.Circle((0.0, -RADIUS), RADIUS),
                friction=0.1,
                closure=closure,
                sliding="finite",
                name="bed",
            )
        ],
        steps=[sg.Step(scale={"press": 1.0, "drive": 0.0}), sg.Step(scale={"drive": 1.0})],
    )


@cache
def slid(unloading):
    """The bed on the circle, of a gasket that springs back so."""
    return sg.solve(bed_on_a_circle(replace(GASKET, unloading=unloading)))


@pytest.mark.parametrize("unloading", [None, STEEP])
def test_a_bed_that_slides_over_a_circle_has_the_pressures_of_its_table(unloading):
    """Where every node is, its overlap is known; a gasket springs back from the largest that it has met."""
    solution = slid(unloading)
    x = np.linspace(-1.0, 1.0, 5)
    for step, end in zip(solution.steps, (0.0, STROKE), strict=True):
        at = x + np.linspace(0.0, end, 2001)[:, None]
        closed = np.maximum(RADIUS - np.hypot(at, RADIUS - DEPTH), 0.0)
        most = np.interp(closed.max(axis=0), *np.transpose(GASKET.points))
        now = np.interp(closed[-1], *np.transpose(GASKET.points))
        if unloading is not None:
            now = np.maximum(most - unloading * (closed.max(axis=0) - closed[-1]), 0.0)
        assert_allclose(step.contacts[0].pressure, now, rtol=0, atol=1e-4 * most.max())  # the block strains by 1e-6
        assert step.path == "exact"
        assert abs(step.energy_defect) < 1e-14
        assert abs(step.released) < 1e-6 * step.work


@pytest.mark.parametrize("sliding", ["small", "finite"])
def test_pressures_of_a_layer_that_wears_decay(sliding):
    """From cycle to cycle by k p, on every line of its own: in series with the block, whose compliance is 5e-6."""
    table = [(0.0, 0.0), (0.015, 4.3), (0.03, 5.0), (0.04, 40.0)]
    solution = sg.solve(worn_layer(table, cycles=5, sliding=sliding))
    step, closures, pressures = solution.steps[1], *np.transpose(table)
    closed, rubbed = 0.03, 0.0
    for _ in range(5):
        pressure = np.interp(closed, closures + 5e-6 * pressures, pressures)
        closed, rubbed = closed - 1e-3 * pressure, rubbed + pressure
    left = np.interp(closed, closures + 5e-6 * pressures, pressures)
    assert left < 4.3 < np.interp(0.03, closures, pressures)
    assert_allclose(step.contacts[0].pressure, left, rtol=1e-12)
    assert step.contacts[0].wear.depth.max() == pytest.approx(1e-3 * rubbed, rel=1e-12)
    assert abs(step.energy_defect) < 1e-15
    # what the sides lose takes the energy of the layer and of the block with it
    first = solution.steps[0]
    stored = [each.interface_energy + each.strain_energy for each in (first, step)]
    assert step.released == pytest.approx(stored[0] - stored[1], rel=1e-9)


def test_pressures_of_a_layer_that_wears_in_small_cycles_decay_exponentially():
    """``p = p_0 exp(- k s / c)`` with the compliance c of the layer and the block, as cycles become short."""
    left = []
    for cycles in (10, 20):
        model = worn_layer([(0.0, 0.0), (0.02, 4.0)], cycles=cycles, sliding="small", stroke=5.0 / cycles)
        left.append(float(sg.solve(model).steps[1].contacts[0].pressure.mean()))
    extrapolated = 2.0 * left[1] - left[0]
    compliance = 0.005 + 5e-6
    exact = 0.03 / compliance * np.exp(-1e-3 * 10.0 / compliance)
    assert extrapolated == pytest.approx(exact, rel=0.03)
    assert abs(left[1] - exact) < 0.6 * abs(left[0] - exact)


BOTH = sg.Wear(1e-3, mortar=2e-3)


def hub_on_shaft(**given):
    """A press fit that is pushed along its shaft, by more than a facet, and wears both."""
    steel = sg.Elastic(E=200.0, nu=0.3)
    shaft = sg.rectangle(x=np.linspace(0.0, 1.0, 2), y=np.linspace(-0.5, 1.5, 6))
    hub = sg.rectangle(x=np.linspace(1.0, 2.0, 3), y=np.linspace(0.0, 1.0, 3))
    wears = {"friction": 0.2, "sliding": "finite", "interference": 0.02, "wear": BOTH, "name": "fit"}
    return sg.Model(
        mesh=sg.join({"shaft": shaft, "hub": hub}),
        kind="axisymmetric",
        bodies=[sg.Body("shaft", steel), sg.Body("hub", steel)],
        supports=[sg.Support("shaft.bottom", u=(None, 0.0)), sg.Support("hub.bottom", u=(None, 0.2), name="push")],
        contacts=[sg.Contact("hub.left", "shaft.right", **wears | given)],
        steps=[sg.Step(scale={"push": 0.0}), sg.Step(scale={"push": 1.0})],
    )


@pytest.mark.slow
def test_one_line_is_a_compliance_and_a_steep_one_hard_contact():
    """Both sides meshed and worn, axisymmetric, and energies to rounding, which areas that change would miss."""
    line = sg.solve(hub_on_shaft(closure=sg.Closure([(0.0, 0.0), (0.02, 2.0)])))
    for one, two in zip(line.steps, sg.solve(hub_on_shaft(normal_compliance=0.01)).steps, strict=True):
        assert_allclose(one.contacts[0].pressure, two.contacts[0].pressure, rtol=1e-12)
        assert one.released == pytest.approx(two.released, rel=1e-10)
        assert max(abs(step.energy_defect) for step in (one, two)) < 1e-15
    steep, hard = (
        sg.solve(hub_on_shaft(**given)).steps[1].contacts[0].pressure
        for given in ({"closure": sg.Closure([(0.0, 0.0), (1e-8, 1.0)])}, {})
    )
    assert_allclose(steep, hard, rtol=0, atol=1e-4 * hard.max())
    assert np.abs(line.steps[1].contacts[0].pressure - hard).max() > 0.1 * hard.max()


def test_a_gasket_that_slides_goes_on_from_a_file(tmp_path):
    whole = slid(STEEP)
    model = whole.model
    sg.solve(replace(model, steps=model.steps[:1])).save_state(tmp_path / "start.npz")
    rest = sg.solve(replace(model, steps=model.steps[1:]), start=tmp_path / "start.npz").steps[0]
    assert np.array_equal(rest.contacts[0].pressure, whole.steps[1].contacts[0].pressure)
    assert rest.dissipation == whole.steps[1].dissipation
    assert rest.interface_energy == whole.steps[1].interface_energy


@pytest.mark.slow
def test_in_space_a_worn_bed_is_one_compliance_where_its_line_is_one():
    steel = sg.Elastic(E=200.0, nu=0.3)

    def solved(**given):
        sole = {"friction": 0.3, "sliding": "finite", "wear": sg.Wear(0.01)}
        model = sg.Model(
            sg.box(x=[0.0, 0.5, 1.0], y=[0.0, 0.5], z=[0.0, 0.5]),
            kind="3d",
            bodies=[sg.Body("block", steel)],
            supports=[
                sg.Support("top", u=(None, None, -0.05), name="press"),
                sg.Support("top", u=(0.2, 0.1, None), name="drive"),
            ],
            contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)), **sole | given)],
            steps=[sg.Step(scale={"press": 1.0, "drive": 0.0}), sg.Step(scale={"drive": 1.0}, increments=10)],
        )
        return sg.solve(model).steps[1]

    one, two = solved(normal_compliance=0.01), solved(closure=sg.Closure([(0.0, 0.0), (0.02, 2.0)]))
    assert_allclose(one.contacts[0].pressure, two.contacts[0].pressure, rtol=1e-6)
    assert two.energy_defect == pytest.approx(one.energy_defect, rel=1e-6)


def test_blocks_of_cycles_are_refused_by_name():
    for sliding, said in (("small", "no closure"), ("finite", "no closure")):
        model = worn_layer([(0.0, 0.0), (0.02, 4.0)], cycles=4, sliding=sliding)
        step = replace(model.steps[1], block=2)
        with pytest.raises(sg.SolveFailed, match=said):
            sg.solve(replace(model, steps=[model.steps[0], step]))
