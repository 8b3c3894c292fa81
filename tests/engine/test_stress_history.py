# SPDX-License-Identifier: BSD-3-Clause
"""Stresses over a history: the same whether displacements were kept or are found from the forces of the contacts."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.engine import recovery
from signorini.gallery.cubes import cubes
from signorini.gallery.half_planes import equal_half_planes, punch

PRESS, PULL = sg.Step(name="press", scale={"press": 1.0}), sg.Step(name="pull", scale={"pull": 0.7})
CYCLES = sg.Step(name="cycles", scale={"pull": [-0.7, 0.7]}, repeat=2)


def both(model, **asked):
    """The stresses of the last step from kept displacements, and from forces."""
    found = []
    for at in ((), "events"):
        steps = [*model.steps[:-1], replace(model.steps[-1], at=at)]
        found.append(sg.solve(replace(model, steps=steps)).stress_history(**asked))
    return found


def agree(one, two, digits=1e-9):
    np.testing.assert_array_equal(one.load_factor, two.load_factor)
    np.testing.assert_allclose(one.stress, two.stress, atol=digits * np.abs(two.stress).max())
    np.testing.assert_allclose(one.strain, two.strain, atol=digits * np.abs(two.strain).max())


@pytest.fixture(scope="module")
def fretting():
    return equal_half_planes([PRESS, PULL, CYCLES], spacing=0.25, size=6.0)


def test_forces_of_contacts_are_enough_in_the_plane(fretting, monkeypatch):
    monkeypatch.setattr(recovery, "_AT_ONCE", 5)
    one, two = both(fretting)
    assert one.exact
    assert one.load_factor[[0, -1]].tolist() == [2.5, 3.0]  # the last cycle
    agree(one, two)
    agree(*both(fretting, where="lower"))


def test_stresses_are_linear_between_events(fretting):
    """At times asked for they are what lies between the events beside them."""
    times = (0.513, 0.601, 0.777, 0.923)
    solution = sg.solve(replace(fretting, steps=[PRESS, PULL, replace(CYCLES, at=times)]))
    history = solution.stress_history("contact")
    asked = np.isin(history.load_factor.round(9), [2.0 + time for time in times])
    assert asked.sum() == len(times)
    others = history.load_factor[~asked], history.stress[:, ~asked]
    for at in np.flatnonzero(asked):
        between = [
            np.interp(history.load_factor[at], others[0], row)
            for row in others[1].transpose(0, 2, 1).reshape(-1, len(others[0]))
        ]
        np.testing.assert_allclose(history.stress[:, at].ravel(), between, atol=1e-9 * np.abs(history.stress).max())


def test_a_history_of_several_steps_begins_at_rest(fretting):
    solution = sg.solve(replace(fretting, steps=[PRESS, PULL]))
    history = solution.stress_history("contact", steps=("press", "pull"))
    assert history.load_factor[[0, -1]].tolist() == [0.0, 2.0]
    assert (np.diff(history.load_factor) > 0.0).all()
    assert not history.stress[:, 0].any()
    lower = [body == "lower" for body in history.bodies]
    np.testing.assert_allclose(
        history.stress[lower, -1],
        solution.stress("lower").stress[np.searchsorted(solution.stress("lower").nodes, history.node[lower])],
        atol=1e-12,
    )


def test_points_are_those_of_along(fretting):
    solution = sg.solve(fretting)
    points = [(0.3, -0.4), (-1.0, -2.0)]
    history = solution.stress_history(points=points, body="lower")
    np.testing.assert_allclose(history.stress[:, -1], solution.along(points, body="lower").stress, atol=1e-12)
    assert history.node.tolist() == [-1, -1]
    with pytest.raises(sg.InputError, match="point 1 at"):
        solution.stress_history(points=[(0.0, 3.0)], body="lower")
    with pytest.raises(sg.InputError, match=r"unknown step 'push'\. Known: cycles, press, pull"):
        solution.stress_history(steps=("push",))


def test_forces_of_contacts_are_enough_of_round_bodies_and_of_bodies_that_contact_holds():
    """A round block that only a punch holds: its rigid motion is not found, and strains nothing."""
    model = punch(curved=False, friction=0.4, spacing=0.2, kind="axisymmetric")
    model = replace(model, steps=[sg.Step(name="press", path="exact")])
    agree(*both(model, where="seat"))
    hot = replace(
        model,
        bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3, expansion=1e-3))],
        loads=[*model.loads, sg.Load("block", temperature=1.0, name="heat")],
    )
    one, two = both(hot, where="block")
    agree(one, two)


def test_increments_in_space_are_recovered_too():
    model = replace(cubes(3), steps=[sg.Step(name="push", increments=4)])
    one, two = both(model)
    assert not one.exact
    assert len(one.load_factor) == 5
    agree(one, two, 1e-7)


def test_archives_give_the_same(fretting, tmp_path):
    solution = sg.solve(fretting)
    solution.write(tmp_path / "kept.h5")
    again = sg.load(tmp_path / "kept.h5").stress_history("contact")
    np.testing.assert_array_equal(again.stress, solution.stress_history("contact").stress)


def yielding_bar(**step):
    steel = sg.Elastic(E=100.0, nu=0.3, plastic=sg.Plastic(4.0, hardening=50.0))
    return sg.Model(
        sg.rectangle(width=2.0, nx=2),
        kind="plane stress",
        bodies=[sg.Body("block", steel)],
        supports=[sg.Support("left", u=(0, None)), sg.Support("bottom", u=(None, 0))],
        loads=[sg.Load("right", traction=(5.0, 0), name="pull")],
        steps=[sg.Step(name="pull", increments=4, **step)],
    )


def test_bodies_that_yield_need_their_displacements():
    with pytest.raises(sg.InputError, match='depend on plastic flow; expected at = "events" in the step'):
        sg.solve(yielding_bar()).stress_history("block")
    history = sg.solve(yielding_bar(at="events")).stress_history("block")
    np.testing.assert_allclose(history.stress[0, -1, 0], 5.0)
    np.testing.assert_allclose(history.strain[0, -1, 0], 0.05 + 0.02, rtol=1e-6)
    np.testing.assert_allclose(history.strain[0, -1, 1], -0.3 * 0.05 - 0.5 * 0.02, rtol=1e-6)


@pytest.mark.slow
def test_sides_that_slide_far_need_their_displacements():
    model = sg.read(Path(__file__).parents[2] / "examples" / "block_over_edge.toml")
    solution = sg.solve(replace(model, steps=[replace(step, at="events") for step in model.steps]))
    light = [tuple(replace(instant, displacement=None) for instant in step.instants) for step in solution.steps]
    steps = tuple(replace(step, instants=own) for step, own in zip(solution.steps, light, strict=True))
    with pytest.raises(sg.InputError, match="depend on pairs that follow the bodies"):
        replace(solution, steps=steps).stress_history()
    history = solution.stress_history()
    body = history.bodies[0]
    last = solution.stress(body)
    own = [name == body for name in history.bodies]
    np.testing.assert_array_equal(history.stress[own, -1], last.stress[np.searchsorted(last.nodes, history.node[own])])
    assert not history.exact


def test_what_begins_in_another_history_begins_at_its_end(fretting, tmp_path):
    whole = sg.solve(replace(fretting, steps=[replace(PRESS, scale={"press": 1.0, "pull": 0.0}), PULL]))
    first = sg.solve(replace(fretting, steps=[replace(PRESS, scale={"press": 1.0, "pull": 0.0})]))
    second = sg.solve(replace(fretting, steps=[PULL]), start=first)
    second.write(tmp_path / "second.h5")
    once = whole.stress_history("contact")
    for history in (second, sg.load(tmp_path / "second.h5")):
        again = history.stress_history("contact")
        np.testing.assert_array_equal(again.stress, once.stress)
        np.testing.assert_array_equal(again.load_factor[0], 0.0)
        ruiz, own = (one.fatigue(sg.fatigue.Ruiz()) for one in (whole, history))
        np.testing.assert_array_equal(own.parameter, ruiz.parameter)
    assert ruiz.parameter.max() > 0.0


def test_a_bar_without_contact_goes_on_from_where_it_is():
    bar = sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=2),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0.0, 0.0))],
        loads=[sg.Load("right", traction=(1.0, 0.0))],
    )
    first = sg.solve(bar)
    second = sg.solve(bar, start=first).stress_history("block")
    assert second.stress[0, 0] == pytest.approx(first.stress_history("block").stress[0, -1], rel=1e-12)
    assert second.stress[0, 0, 0] > 0.0


def test_states_that_do_not_follow_from_forces_are_refused(fretting):
    """Corrupt loads on the way are noticed at the end of the step, whose displacements were kept."""
    solution = sg.solve(fretting)
    step = solution.last
    end = step.instants[-1]
    contacts = tuple(replace(contact, pressure=1.01 * contact.pressure) for contact in end.contacts)
    wrong = replace(step, instants=(*step.instants[:-1], replace(end, contacts=contacts)))
    changed = replace(solution, steps=(*solution.steps[:-1], wrong))
    with pytest.raises(sg.InputError, match="do not follow from loads and contacts alone"):
        changed.stress_history("contact")
