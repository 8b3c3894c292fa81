# SPDX-License-Identifier: BSD-3-Clause
"""Steps of bodies that yield: first yield, increments by themselves, unloading, collapse."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest

import signorini as sg
from signorini.engine import first_yield, plastic_rounds, plastic_solver, plastic_steps
from signorini.engine.chord import Chord
from signorini.engine.plastic_solver import PlasticSolver
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.footings import footing
from signorini.gallery.press_fit import press_fit
from signorini.outcome import Outcome

LIMIT = 2.0 * np.log(2.0)  # of the pressure in a tube of twice the radius outside, over the shear strength


def tube(pressure, *, n=8, order=1, hardening=0.0, steps=None):
    """A quarter of a tube in plane strain, nearly incompressible, of shear strength 1."""
    mesh = sg.annulus(inner=1.0, outer=2.0, n_radial=n, n_angular=2 * n, angle=90.0, order=order)
    plastic = sg.Plastic(3.0**0.5, hardening=hardening)
    return sg.Model(
        mesh,
        bodies=[sg.Body("ring", sg.Elastic(E=200.0, nu=0.4999, plastic=plastic))],
        supports=[sg.Support("start", u=(None, 0.0)), sg.Support("end", u=(0.0, None))],
        loads=[sg.Load("inner", pressure=pressure, name="press")],
        steps=[sg.Step()] if steps is None else steps,
    )


def test_first_yield_is_where_the_elastic_tube_yields():
    step = sg.solve(tube(1.0, n=8, order=2)).steps[0]
    told = next(note for note in step.notes if "first yield" in note)
    part = float(told.split("at ")[1].split("%")[0]) / 100.0
    # Lame, incompressible: p (b/r)^2 / (b^2/a^2 - 1) is the shear strength first at the innermost of 3 Gauss points
    inside = 1.0 + (1.0 / 8.0) * 0.5 * (1.0 - 0.6**0.5)
    assert part == pytest.approx((1.0 - 0.25) * inside**2, rel=2e-3)


def pressed(ratio, **step):
    """A cylinder on a plane with friction, up to p_0 of the elastic contact over the yield stress."""
    elastic = zhu_cylinder(friction=0.3, refine=2, contact_length=1.6, contact_spacing=0.1, force=6.0)
    law = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(7.25 / ratio))
    return replace(elastic, bodies=[sg.Body("disk", law)], steps=[sg.Step(increments=1, **step)])


@pytest.mark.parametrize("ratio", [1.0, 1.9, 4.0])
def test_few_events_need_a_look_to_find_first_yield(ratio):
    """Where displacements are asked for at all events all of them are looked at: that finds the same."""
    with mock.patch.object(Chord, "displacements", autospec=True, side_effect=Chord.displacements) as looks:
        few = sg.solve(pressed(ratio)).steps[0]
    assert len(looks.call_args_list) <= 3
    assert sum(len(call.args[1]) for call in looks.call_args_list) <= 0.9 * len(few.events)
    every = sg.solve(pressed(ratio, at="events")).steps[0]
    assert (few.yielding.first is None) == (ratio == 1.0)
    assert few.yielding.first == (None if ratio == 1.0 else pytest.approx(every.yielding.first, rel=1e-12))
    assert few.notes == every.notes
    assert len(few.events) == len(every.events)


def test_stresses_stay_as_near_to_the_straight_way_as_energy_says():
    with mock.patch.object(first_yield, "_between", side_effect=first_yield._between) as searched:
        sg.solve(pressed(2.0))
    prepared, one, two, between, limit = searched.call_args.args
    states = [state for _, state in between]
    parts = np.array([(factor - one.factor) / (two.factor - one.factor) for factor, _ in between])
    chord, reach = Chord.of(prepared, (one.state, two.state), parts, states), first_yield._full_by_energy
    most = np.maximum(one.full, two.full) + reach(prepared, limit) * chord.energy(-1, len(between)) ** 0.5
    beyond = []
    for state, u in zip(states, chord.displacements(np.arange(len(states))), strict=True):
        full = first_yield._Look.at(prepared, 0.0, replace(state, displacement=u)).full
        assert (full <= most).all()
        beyond.append((full - np.maximum(one.full, two.full)).max())
    assert max(beyond) > 0.0  # else the bound was not needed


def test_a_step_below_yield_is_followed_exactly():
    step = sg.solve(tube(0.5)).steps[0]
    assert step.path == "exact"
    assert any("nothing yields" in note for note in step.notes)


@pytest.mark.parametrize(("increments", "over"), [(1, 1.01), (3, 1.5), ("auto", 1.01), ("auto", 1.5)])
def test_collapse_is_named_with_a_bound_of_the_load(increments, over):
    model = tube(over * LIMIT, steps=[sg.Step(increments=increments)])
    with pytest.raises(sg.SolveFailed, match="flow plastically at") as failed:
        sg.solve(model)
    assert failed.value.status == Outcome.NO_EQUILIBRIUM
    part = float(str(failed.value).split("plastically at ")[1].split("%")[0]) / 100.0
    # an upper bound of the limit of the mesh, which polygons for circles keep below 1.003 of the exact one
    assert 1.0 <= part * over <= 1.003
    assert failed.value.solution.escape.shape == (len(model.mesh.points), 2)


def test_what_is_below_collapse_is_kept():
    history = sg.solve(tube(1.5 * LIMIT), raise_on_failure=False)
    assert not history.solved
    assert history.steps[0].certificate.passed


def test_one_increment_goes_to_the_limit():
    step = sg.solve(tube(0.999 * LIMIT, steps=[sg.Step(increments=1)])).steps[0]
    assert step.certificate.passed
    runs = [run.iterations for tried in step.trace for run in tried if run.method == "plastic flow"]
    assert max(runs) <= 10


def residuals(law, kind, *, rough, **limits):
    """What equilibrium lacks in every round of a block that is dragged in one increment, with a tangent in each.

    Parameters
    ----------
    law, kind : how it yields, and the kind of the model
    rough : on a plane with friction, or held at its foot
    limits : of `plastic_rounds`, in place of its own
    """
    lacks, measure = [], PlasticSolver._lack
    model = sg.Model(
        sg.rectangle(x=np.linspace(1.0, 3.0, 5), y=np.linspace(0.0, 1.0, 3)),
        kind=kind,
        bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3, plastic=law))],
        supports=[sg.Support("top", u=(0.05, -0.04)), *([] if rough else [sg.Support("bottom", u=(0, 0))])],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=0.3)] if rough else [],
        steps=[sg.Step(increments=1)],
    )
    with (
        mock.patch.object(PlasticSolver, "_lack", lambda *given: lacks.append(measure(*given)) or lacks[-1]),
        mock.patch.object(plastic_solver, "_BALANCED", limits.pop("_BALANCED", 1e-13)),
        mock.patch.multiple(plastic_rounds, **({"_KEPT_FROM": 0.0, "_NEARER_ROUNDS": 0} | limits)),
    ):
        sg.solve(model)
    return np.array(lacks)


def order(lacks):
    """Of convergence, from the last three residuals above rounding."""
    one, two, three = np.log(lacks[lacks > 5e-15])[-3:]
    return (three - two) / (two - one)


@pytest.mark.parametrize(
    ("law", "kind", "rough"),
    [
        (sg.Plastic(1.0, hardening=20.0), "plane strain", True),
        (sg.Plastic(1.0), "plane strain", False),
        (sg.Plastic(1.0), "plane stress", True),
    ],
)
def test_rounds_converge_quadratically(law, kind, rough):
    """A secant would have 1.6, a kept tangent 1."""
    assert order(residuals(law, kind, rough=rough)) > 1.85


def test_rounds_on_a_tangent_that_is_kept_do_not():
    kept = {"_KEPT_FROM": 1.0, "_KEPT_GAIN": 1.0, "_BALANCED": 1e-10}
    assert order(residuals(sg.Plastic(1.0, hardening=20.0), "plane strain", rough=False, **kept)) < 1.5


def test_a_hardening_tube_has_no_limit():
    assert sg.solve(tube(1.2 * LIMIT, hardening=20.0, steps=[sg.Step(increments=4)])).solved


def test_unloading_is_elastic_and_exact():
    steps = [sg.Step(name="load", increments=4), sg.Step(name="unload", scale={"press": 0.0})]
    unloading = sg.solve(tube(0.9 * LIMIT, steps=steps)).steps[1]
    assert unloading.path == "exact"
    assert any("nothing yields" in note for note in unloading.notes)


def test_an_exact_path_is_refused_where_bodies_yield():
    with pytest.raises(sg.SolveFailed, match="plastic flow has no exact path"):
        sg.solve(tube(1.2, steps=[sg.Step(path="exact")]))


def test_no_limit_load_is_sought_while_pairs_are_left_out():
    """With the few pairs that an elastic contact can close the cylinder flows away; with all of them it is held."""
    elastic = zhu_cylinder(friction=0.0, contact_length=1.6, contact_spacing=0.1, force=10.0)
    law = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(0.9))
    model = replace(elastic, bodies=[sg.Body("disk", law)], steps=[sg.Step(increments=1)])
    with mock.patch.object(plastic_steps, "collapse", side_effect=plastic_steps.collapse) as sought:
        assert sg.solve(model).solved
    assert not sought.called


@pytest.mark.parametrize("along", [(32, 24), (24, 32)])
def test_a_hub_that_flows_as_a_whole_keeps_its_fit(along):
    """Its tangent yields so far that a condensed compliance loses the digits of the fit; a stiffer one has them."""
    hub = sg.Elastic(E=1000.0, nu=0.4999, plastic=sg.Plastic(3.0**0.5))
    elastic = press_fit(n_radial=12, n_angular=along, kind="plane strain", interference=0.012)
    model = replace(
        elastic,
        bodies=[sg.Body("shaft", sg.Elastic(E=2000.0, nu=0.4999), "mean dilatation"), sg.Body("hub", hub)],
        steps=[sg.Step(increments=1)],
    )
    solution = sg.solve(model)
    found = solution.steps[0].certificate
    assert (
        max(found.penetration, found.complementarity) <= plastic_solver._FITTING
    )  # by which pairs and bodies may part
    contact = solution.contact("fit")
    assert contact.pressure @ contact.area / contact.area.sum() == pytest.approx(2.0 * np.log(1.5), rel=2e-3)


def test_the_bound_named_does_not_depend_on_how_far_beyond_the_load_is():
    bounds = []
    for pressure in (6.0, 20.0):
        with pytest.raises(sg.SolveFailed, match=r"flow plastically at [\d.]+% of the step at most") as found:
            sg.solve(footing(pressure, edge=0.25))
        bounds.append(pressure * float(str(found.value).split("plastically at ")[1].split("%")[0]) / 100.0)
    assert bounds[0] == pytest.approx(bounds[1], rel=1e-3)
