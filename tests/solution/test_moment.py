# SPDX-License-Identifier: BSD-3-Clause
"""Any moment of a history: the same as a solution that was asked for it beforehand."""

from dataclasses import replace

import meshio
import numpy as np
import pytest

import signorini as sg

FLOOR = sg.Plane(point=(0, 0), normal=(0, 1))
FIELDS = ("gap", "pressure", "traction", "slip", "sliding", "slip_range", "worn")


def pushed(*, held: bool = True, steps: tuple[sg.Step, ...] = (), glued: bool = False) -> sg.Model:
    """A block that is pressed on a rough floor and pushed to and fro; held on its left, or by the floor alone."""
    low = sg.rectangle(width=4.0, height=1.0, nx=6, ny=1)
    mesh, sides, contacts = low, ("block",), [sg.Contact("bottom", FLOOR, friction=0.3, name="floor")]
    top, right = "top", "right"
    if glued:
        high = sg.rectangle(width=4.0, height=1.0, nx=6, ny=1, origin=(0.0, 1.0))
        mesh, sides, top, right = sg.join({"low": low, "high": high}), ("low", "high"), "high.top", "high.right"
        contacts = [
            sg.Contact("low.bottom", FLOOR, friction=0.3, name="floor"),
            sg.Contact("high.bottom", "low.top", friction="tied", name="glue"),
        ]
    left = "low.left" if glued else "left"
    return sg.Model(
        mesh,
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in (sides if glued else ("block",))],
        supports=[sg.Support(left, u=(0, None))] if held else [],
        loads=[sg.Load(top, pressure=10.0, name="press"), sg.Load(right, traction=(1.0, 0.0), name="push")],
        contacts=contacts,
        steps=steps
        or (
            sg.Step(name="press", scale={"press": 1.0, "push": 0.0}, path="exact"),
            sg.Step(name="fret", scale={"push": [6.0, -6.0]}, repeat=2, path="exact"),
        ),
    )


@pytest.fixture(scope="module")
def fretted() -> sg.Solution:
    return sg.solve(pushed())


@pytest.mark.parametrize(("held", "glued"), [(True, False), (False, False), (True, True)])
def test_any_load_of_an_exact_path_is_as_if_it_had_been_asked_for(held, glued):
    model, loads = pushed(held=held, glued=glued), (0.07, 0.31, 0.9)
    solution = sg.solve(model)
    asked = sg.solve(replace(model, steps=tuple(replace(step, at=loads) for step in model.steps)))
    floor = solution.last.contacts[0]
    sizes = {"pressure": floor.pressure.max(), "traction": floor.pressure.max(), "worn": floor.worn.max()}
    for kept in (instant for step in asked.steps for instant in step.instants if instant.what == "asked"):
        number = int(kept.load_factor) + 1
        moment, moved = solution.at(number, load=kept.load_factor - (number - 1)), np.abs(kept.displacement).max()
        for found, expected in zip(moment.contacts, kept.contacts, strict=True):
            for name in FIELDS:
                near = 1e-10 * sizes.get(name, moved)
                assert getattr(found, name) == pytest.approx(getattr(expected, name), abs=near), name
            assert found.status.tolist() == expected.status.tolist()
            assert found.dissipation == pytest.approx(expected.dissipation, abs=1e-10)
        assert np.abs(moment.displacement - kept.displacement).max() < 1e-9 * moved
        assert moment.instant.factors == pytest.approx(kept.factors)


def test_ends_of_steps_are_the_results(fretted):
    assert fretted.at().displacement is fretted.last.displacement
    assert fretted.at("press").contact("floor") is fretted.steps[0].contacts[0]
    assert fretted.at(1, load=1.0).instant is fretted.steps[0].instants[-1]
    assert (fretted.at().stress("block").stress == fretted.stress("block").stress).all()
    assert str(fretted.at("press")) == "step 1 'press' at 1 of it: segment"
    begin = fretted.at(2, load=0.0)
    assert begin.contact("floor").pressure.tolist() == fretted.steps[0].contacts[0].pressure.tolist()
    assert (begin.displacement == fretted.steps[0].displacement).all()
    assert not begin.contact("floor").worn.any()
    assert not fretted.at(1, load=0.0).displacement.any()


def test_events_by_number(fretted):
    event = fretted.steps[1].events[2]
    moment = fretted.at("fret", event=3)
    assert moment.load_factor == event.load_factor
    assert moment.instant.what == "event"
    left = fretted.at("fret", load=moment.load - 1e-7)
    assert np.abs(left.displacement - moment.displacement).max() < 1e-6 * np.abs(moment.displacement).max()


def test_stress_and_path_at_a_moment_are_those_of_the_stress_history(fretted, tmp_path):
    history = fretted.stress_history(points=[(1.1, 0.6)], body="block", steps=["fret"])
    moment = fretted.at("fret", event=len(fretted.last.events))  # of the last cycle, which the history is about
    k = int(np.abs(history.load_factor - moment.load_factor).argmin())
    path = moment.along([(1.1, 0.6)], body="block")
    assert path.stress[0] == pytest.approx(history.stress[0, k], rel=1e-9, abs=1e-9)
    moment.write(tmp_path / "then.vtu")
    written = meshio.read(tmp_path / "then.vtu")
    assert (written.point_data["displacement"][:, :2] == moment.displacement).all()
    assert (written.point_data["stress"] == moment.stress("block").stress).all()


def test_increments_by_number_and_nothing_between():
    steps = (sg.Step(name="press", increments=4, scale={"press": 1.0, "push": 1.0}),)
    solution = sg.solve(pushed(steps=steps))
    assert [solution.at(increment=i).load for i in (1, 2, 3, 4)] == [0.25, 0.5, 0.75, 1.0]
    kept = sg.solve(pushed(steps=(replace(steps[0], at=[0.5]),)))
    then = kept.at(load=0.5).displacement
    assert np.abs(solution.at(increment=2).displacement - then).max() < 1e-9 * np.abs(then).max()
    with pytest.raises(sg.InputError) as error:
        solution.at(load=0.3)
    assert str(error.value) == (
        "load: is 0.3; the step was solved in increments, between which nothing is known; expected 0.25, 0.5, 0.75, 1, "
        "or 'at = [...]' in the step"
    )
    with pytest.raises(sg.InputError, match="increment: is 5; step 1 has 4 increments"):
        solution.at(increment=5)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"step": "frett"}, "step: unknown step 'frett'"),
        ({"step": 3}, "step: is 3; expected the number of a step, 1 to 2, or its name"),
        ({"load": 1.5}, "load: is 1.5; expected a part of step 2 between 0 and 1"),
        ({"event": 0}, "event: is 0; step 2 has"),
        ({"increment": 1}, "increment: is 1; step 2 has an exact path, without increments"),
        ({"load": 0.5, "event": 1}, "has more than one of 'load', 'increment' and 'event'"),
    ],
)
def test_what_there_is_not_is_named(fretted, given, words):
    with pytest.raises(sg.InputError, match=words):
        fretted.at(**given)


def test_ties_bear_at_events_what_they_bear_there():
    """Their forces are not unknowns of the path; stresses on the way need them."""
    model = pushed(glued=True)
    whole = replace(model, steps=tuple(replace(step, at="events") for step in model.steps))
    found, expected = (sg.solve(each).stress_history("floor", steps=["fret"]).stress for each in (model, whole))
    assert np.abs(found - expected).max() < 1e-10 * np.abs(expected).max()
