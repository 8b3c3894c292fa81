# SPDX-License-Identifier: BSD-3-Clause
"""Steps with tables and cycles; contacts that come and go, friction and interference that change."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.contact_changes import relaxed
from signorini.engine.examine import examine
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.blocks import dragged_block
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.press_fit import press_fit

FLOOR = sg.Plane(point=(0, 0), normal=(0, 1))


def block(steps, *, friction=0.3, contacts=None):
    """A block 4 x 2, its left side held across, pressed and pulled; on two parts of a floor."""
    mesh = sg.rectangle(width=4.0, height=2.0, nx=8, ny=4)
    bottom = mesh.boundaries["bottom"]
    middle = mesh.points[bottom].mean(axis=1)[:, 0]
    mesh = replace(mesh, boundaries={**mesh.boundaries, "near": bottom[middle < 2.0], "far": bottom[middle > 2.5]})
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0.0, None))],
        loads=[sg.Load("top", pressure=2.0, name="press"), sg.Load("right", traction=(1.0, 0.3), name="pull")],
        contacts=contacts or [sg.Contact("bottom", FLOOR, friction=friction, name="floor")],
        steps=steps,
    )


PARTS = [sg.Contact("near", FLOOR, friction=0.3), sg.Contact("far", FLOOR, friction=0.3)]
PRESS = sg.Step(name="press", scale={"press": 1.0})


def balance(solution):
    """What of the energy is not accounted for, relative to the largest work of a step."""
    stored, lacking = 0.0, []
    for step in solution.steps:
        now = step.strain_energy + step.interface_energy
        lacking.append(step.work - (now - stored) - step.dissipation - step.released)
        stored = now
    return np.abs(lacking).max() / max(abs(step.work) for step in solution.steps)


def same(one, two, tolerance=1e-10):
    for a, b in zip(one.contacts, two.contacts, strict=True):
        size = np.abs(b.pressure).max()
        np.testing.assert_allclose(a.pressure, b.pressure, rtol=0, atol=tolerance * size)
        np.testing.assert_allclose(a.traction, b.traction, rtol=0, atol=tolerance * size)
        np.testing.assert_allclose(a.slip, b.slip, rtol=0, atol=tolerance * np.abs(one.displacement).max())


@pytest.mark.parametrize("number", [None, 3])
def test_a_table_repeated_is_its_segments_one_by_one(number):
    table = sg.solve(block([PRESS, sg.Step(scale={"pull": [1.0, -0.5, 0.7]}, repeat=2, increments=number)]))
    one_by_one = sg.solve(
        block([PRESS, *(sg.Step(scale={"pull": f}, increments=number) for f in 2 * (1.0, -0.5, 0.7))])
    )
    assert len(table.steps) == 2
    same(table.last, one_by_one.last)
    ends = [instant for instant in table.last.instants if instant.what == "segment"]
    np.testing.assert_allclose([end.load_factor for end in ends], 1.0 + np.arange(1, 7) / 6.0, rtol=1e-14)
    for instant, step in zip(ends, one_by_one.steps[1:], strict=True):
        same(replace(table.last, instants=(instant,)), step)
    assert table.last.work == pytest.approx(sum(step.work for step in one_by_one.steps[1:]), rel=1e-9)


def test_results_at_times_and_events():
    steps = [PRESS, sg.Step(scale={"pull": 1.0}, at=[0.25, 0.5])]
    plain = sg.solve(block([PRESS, sg.Step(scale={"pull": 1.0})]))
    asked = sg.solve(block(steps))
    same(asked.last, plain.last)
    quarter, half = (instant for instant in asked.last.instants if instant.what == "asked")
    assert (quarter.load_factor, half.load_factor) == (1.25, 1.5)
    halfway = sg.solve(block([PRESS, sg.Step(scale={"pull": 0.5})]))
    same(replace(asked.last, instants=(half,)), halfway.last)
    np.testing.assert_allclose(half.displacement, halfway.last.displacement, atol=1e-12)
    loads = {event.load_factor for event in plain.last.events}
    assert {instant.load_factor for instant in plain.last.instants if instant.what == "event"} == loads - {2.0, 1.0}
    assert all(instant.displacement is None for instant in plain.last.instants)
    whole = sg.solve(block([PRESS, sg.Step(scale={"pull": 1.0}, at="events")]))
    assert all(instant.displacement is not None for instant in whole.last.instants)
    assert whole.last.work == pytest.approx(plain.last.work, rel=1e-10)


def test_cycles_settle_and_energy_is_balanced():
    steps = [PRESS, sg.Step(name="rock", scale={"pull": [1.0, -1.0]}, repeat=4)]
    solution = sg.solve(block(steps))
    rock = solution.last
    assert balance(solution) < 1e-10
    assert len(rock.cycles) == 4
    assert sum(cycle.dissipation for cycle in rock.cycles) == pytest.approx(rock.dissipation, rel=1e-12)
    assert rock.steadiness == "steady"
    assert rock.cycles[-1].work == pytest.approx(rock.cycles[-1].dissipation, rel=1e-9)
    assert any("steady from cycle" in note for note in rock.notes)
    contact = rock.contacts[0]
    # in a closed cycle a pair goes there and back
    np.testing.assert_allclose(2 * contact.slip_range.max(), rock.cycles[-1].sliding, rtol=1e-9)
    still = sg.solve(block([PRESS, sg.Step(scale={"pull": [0.01, -0.01]}, repeat=3)], friction=2.0)).last
    assert still.steadiness == "shakes down"


def test_interference_grows_with_a_step():
    whole = sg.solve(press_fit(interference=0.01, friction=0.3)).contact("fit")
    model = replace(
        press_fit(interference=0.0, friction=0.3), steps=[sg.Step(interference={"fit": 0.01}, path="exact")]
    )
    solution = sg.solve(model)
    np.testing.assert_allclose(solution.contact("fit").pressure, whole.pressure, rtol=1e-9)
    assert balance(solution) < 1e-10
    assert solution.last.work == pytest.approx(solution.last.strain_energy, rel=1e-9)
    looser = replace(model, steps=[*model.steps, sg.Step(interference={"fit": 0.004})])
    np.testing.assert_allclose(sg.solve(looser).contact("fit").pressure, 0.4 * whole.pressure, rtol=1e-9)


@pytest.mark.parametrize("number", [None, 4])
def test_a_contact_switched_off_leaves_what_the_others_carry(number):
    off = sg.Step(name="off", scale={}, inactive=["far"], increments=number)
    smooth = [replace(contact, friction=0.0) for contact in PARTS]
    solution = sg.solve(block([PRESS, off, sg.Step(scale={"pull": 0.0})], contacts=smooth))
    alone = sg.solve(block([sg.Step(scale={"press": 1.0, "pull": 0.0})], contacts=smooth[:1]))
    near, far = solution.last.contacts
    np.testing.assert_allclose(near.pressure, alone.last.contacts[0].pressure, rtol=0, atol=1e-9 * near.pressure.max())
    assert not far.pressure.any()
    assert far.count("open") == len(far.node)
    assert far.gap.min() < 0.0  # it hangs through where the floor was
    assert solution.steps[1].released > 0.0
    if number is None:
        assert balance(solution) < 1e-10


def test_a_contact_switched_on_again_presses_out_what_overlaps():
    steps = [
        PRESS,
        sg.Step(name="off", scale={}, inactive=["far"]),
        sg.Step(name="on", scale={"pull": 0.0}, active=["far"]),
    ]
    smooth = [replace(contact, friction=0.0) for contact in PARTS]
    solution = sg.solve(block(steps, contacts=smooth))
    for again, first in zip(solution.last.contacts, solution.steps[0].contacts, strict=True):
        np.testing.assert_allclose(again.pressure, first.pressure, rtol=1e-9)
    rubbing = sg.solve(block(steps, contacts=PARTS))
    assert rubbing.last.certificate.passed
    assert balance(rubbing) < 1e-10


def test_a_body_without_its_last_contact_is_named_before_anything_is_solved():
    steps = [PRESS, sg.Step(scale={"pull": 0.0}, inactive=["floor"])]
    with pytest.raises(sg.InputError, match=r"step\[1\].inactive: without floor, body 'block' can move along y"):
        examine(block(steps))


def test_lower_friction_lets_go_at_once():
    """At the same loads as if friction had been low, in increments; friction takes all that slip sets free."""
    steps = [PRESS, sg.Step(scale={"pull": 1.0}), sg.Step(name="oil", scale={}, friction={"floor": 0.05})]
    solution = sg.solve(block(steps, friction=0.6))
    oil = solution.last
    (floor,) = oil.contacts
    assert oil.instants[0].what == "change"
    assert (np.abs(floor.traction) <= 0.05 * floor.pressure * (1 + 1e-9)).all()
    assert oil.dissipation > 0.0
    assert abs(oil.released) <= 1e-12 * oil.dissipation
    assert balance(solution) < 1e-9
    higher = [*steps[:2], sg.Step(scale={"pull": -1.0}, friction={"floor": 2.0})]
    rough = sg.solve(block(higher, friction=0.6))
    assert rough.last.released == 0.0
    assert balance(rough) < 1e-10


def test_what_slips_at_once_is_shown_with_the_bodies_where_all_events_are():
    steps = [PRESS, sg.Step(scale={"pull": 1.0}), sg.Step(scale={}, friction={"floor": 0.05}, at="events")]
    first = sg.solve(block(steps)).last.instants[0]
    assert first.what == "change"
    assert np.abs(first.displacement).max() > 0.0


def test_rounding_of_forces_is_no_friction_that_lets_go():
    """A body that nothing touches any more: what its pairs carry is what digits leave of the loads before."""
    prepared = prepare(block([sg.Step(scale={"press": 1.0, "pull": 0.0})]))
    state = solve_prepared(prepared).end.state
    left = np.full_like(state.forces, 1e-15 * prepared.scale.force)
    left[0] = 0.0
    assert relaxed(prepared, replace(state, forces=left), "step 2") is None
    assert relaxed(prepared, replace(state, forces=1e6 * left), "step 2") is not None


def test_what_floats_keeps_its_energy_balance_through_cycles():
    held = dragged_block(friction=0.3)
    steps = [PRESS, sg.Step(scale={"push": [1.0, -1.0]}, repeat=2)]
    assert balance(sg.solve(replace(held, steps=steps))) < 1e-10


@pytest.mark.slow
def test_increments_until_the_answer_stays():
    exact = sg.solve(zhu_cylinder(refine=2, steps=[sg.Step()])).contact("foundation")
    numbers, errors = [], []
    for tolerance in (0.1, 0.01):
        steps = [sg.Step(increments="auto", tolerance=tolerance)]
        solution = sg.solve(zhu_cylinder(refine=2, steps=steps))
        numbers.append(solution.last.increments)
        error = np.abs(solution.contact("foundation").traction - exact.traction).max()
        errors.append(error / exact.pressure.max())
        assert any("half as many change contact forces by" in note for note in solution.last.notes)
    assert numbers[0] < numbers[1]
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 0.02
    assert sg.solve(zhu_cylinder(refine=2, friction=0.0, steps=steps)).last.increments == 2
    with pytest.raises(sg.SolveFailed, match="8 increments still change contact forces by"):
        sg.solve(zhu_cylinder(refine=1, steps=steps), settings=sg.SolverSettings(automatic_increments=8))


@pytest.mark.slow
def test_increments_that_do_not_settle_are_given_up(monkeypatch):
    monkeypatch.setattr("signorini.engine.automatic._CERTAIN", 1)
    monkeypatch.setattr("signorini.engine.automatic._change", lambda _coarse, _fine: (0.5, "the answer by a half"))
    with pytest.raises(
        sg.SolveFailed, match=r"32 increments still change the answer by a half(.|\n)*\n.*: 2 changed it"
    ):
        sg.solve(zhu_cylinder(refine=1, steps=[sg.Step(increments="auto", tolerance=0.01)]))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: sg.Step(scale={"a": [1, 2], "b": [1]}), r"scale: lists are of different lengths \(a 2, b 1\)"),
        (lambda: sg.Step(scale={"a": []}), r"scale\.a: is an empty list"),
        (lambda: sg.Step(at=[0.5, 1.5]), r"at\[1\]: is 1.5; expected a part of the step, at most 1"),
        (lambda: sg.Step(at="often"), r"at: is 'often'; expected a list of parts"),
        (lambda: sg.Step(active=["a"], inactive=["a"]), r"active: 'a' is switched on and off"),
        (lambda: sg.Step(repeat=0), r"repeat: is 0; expected a whole number >= 1"),
        (lambda: sg.Step(friction={"a": -1.0}), r"friction\.a: is -1.0; expected a number >= 0"),
        (lambda: block([sg.Step(), sg.Step(friction={"flor": 0.1})]), r"step\[1\].friction: unknown contact 'flor'"),
    ],
)
def test_wrong_steps(make, message):
    with pytest.raises(sg.InputError, match=message):
        make()


@pytest.mark.parametrize("d", [2, 3], ids=["plane", "space"])
def test_what_friction_has_taken_stays_when_everything_has_let_go(d):
    """Press, let go altogether, press: where nothing acts and nothing is displaced need not be the beginning."""
    if d == 2:
        down, place, normal = (0.0, -0.01), (0.0, -0.001), (0.0, 1.0)
        mesh = sg.rectangle(width=2.0, height=1.0, nx=8, ny=4)
    else:
        down, place, normal = (0.0, 0.0, -0.01), (0.0, 0.0, -0.001), (0.0, 0.0, 1.0)
        mesh = sg.box(x=np.linspace(0.0, 2.0, 5), y=np.linspace(0.0, 2.0, 3), z=np.linspace(0.0, 1.0, 3))
    model = sg.Model(
        mesh,
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=down, name="press")],
        contacts=[sg.Contact("bottom", sg.Plane(place, normal), friction=0.05, name="floor")],
        steps=[sg.Step(scale={"press": [1.0, 0.0]}, repeat=2), sg.Step(scale={"press": 1.0})],
    )
    rock, again = sg.solve(model).steps
    whole, slid = rock.cycles[0].dissipation, rock.cycles[0].sliding
    assert rock.cycles[1].dissipation == pytest.approx(whole, rel=1e-6)
    assert rock.cycles[1].sliding == pytest.approx(slid, rel=1e-6)
    pressed = next(instant for instant in rock.instants if instant.load_factor == 0.25)
    assert again.dissipation == pytest.approx(sum(contact.dissipation for contact in pressed.contacts), rel=1e-6)
    assert abs(rock.energy_defect) + abs(again.energy_defect) < 1e-3 * again.work  # the tolerance of increments
