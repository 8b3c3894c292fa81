# SPDX-License-Identifier: BSD-3-Clause
"""Sides that close by a law: on every way through a step, in every kind of model, and what the certificate sees."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.engine.increments import measured
from signorini.engine.prepare import prepare
from signorini.gallery.closures import GASKET, block_on_a_bed
from signorini.output.ccx_contact import slave_energies

CLOSURES, PRESSURES = np.transpose(GASKET.points)
SLANTED = "1 + 7*x"  # over a width of 2: pairs pass kinks of all kinds, one after the other

PRESS, LET_GO = sg.Step(scale={"p": 1.0}, path="exact"), sg.Step(scale={"p": 0.0}, path="exact")


def obeys(contact: sg.Contact) -> None:
    """Every pair is on the table, or open."""
    closed = np.interp(contact.pressure, PRESSURES, CLOSURES)
    assert contact.pressure.max() < PRESSURES[-1]
    assert_allclose(np.where(contact.pressure > 0, -contact.gap, 0.0), closed, rtol=0, atol=1e-15)


@pytest.mark.parametrize("kind", ["plane strain", "plane stress", "axisymmetric"])
def test_a_way_to_a_load_and_back_is_followed_from_kink_to_kink(kind):
    solution = sg.solve(block_on_a_bed(SLANTED, kind=kind, steps=[PRESS, LET_GO], cells=4))
    there, back = solution.steps
    obeys(there.contacts[0])
    assert not back.contacts[0].pressure.any()
    kinks = [[e for e in step.events if e.what in ("stiffens", "softens")] for step in (there, back)]
    assert sum(len(event.nodes) for event in kinks[0]) >= 9
    # without friction the way back is the way there
    mirrored = [(2.0 - event.load_factor, sorted(event.nodes)) for event in reversed(kinks[1])]
    for event, (factor, nodes) in zip(kinks[0], mirrored, strict=True):
        assert event.load_factor == pytest.approx(factor, abs=1e-10)
        assert sorted(event.nodes) == nodes
    assert max(abs(step.energy_defect) for step in solution.steps) < 1e-14 * there.work
    assert back.work == pytest.approx(-there.work, rel=1e-12)
    assert back.interface_energy == pytest.approx(0.0, abs=1e-16)


@pytest.mark.slow
def test_friction_and_kinks_on_an_exact_path_and_in_increments():
    ways = [{"p": 1.0}, {"q": 1.0}, {"q": -1.0}]
    exact = sg.solve(block_on_a_bed(SLANTED, friction=0.15, steps=[sg.Step(scale=way) for way in ways]))
    steps = [sg.Step(scale=way, increments=60) for way in ways]
    fine = sg.solve(block_on_a_bed(SLANTED, friction=0.15, steps=steps))
    for one, two in zip(exact.steps, fine.steps, strict=True):
        assert one.path == "exact"
        assert abs(one.energy_defect) < 1e-14
        obeys(one.contacts[0])
        assert_allclose(one.contacts[0].pressure, two.contacts[0].pressure, rtol=0, atol=3e-3)
        assert_allclose(one.contacts[0].traction, two.contacts[0].traction, rtol=0, atol=3e-3)
    assert exact.steps[0].dissipation > 1e-4


def test_multipliers_answer_the_same():
    steps = [sg.Step(scale={"p": 1.0}, increments=3), sg.Step(scale={"q": 1.0}, increments=2)]
    model = block_on_a_bed(SLANTED, friction=0.3, steps=steps, cells=5)
    for one, two in zip(sg.solve(model).steps, sg.solve(model, backend="iterative").steps, strict=True):
        assert_allclose(one.contacts[0].pressure, two.contacts[0].pressure, rtol=1e-8)
    with pytest.raises(sg.InputError, match="an exact path needs the condensed interface"):
        sg.solve(replace(model, steps=[sg.Step(path="exact")]), backend="iterative")


def test_a_joint_of_two_meshes_that_do_not_match():
    upper = sg.rectangle(width=2.0, height=1.0, nx=5, ny=3)
    lower = sg.rectangle(width=2.0, height=1.0, nx=8, ny=3, origin=(0, -1))
    model = sg.Model(
        sg.join({"upper": upper, "lower": lower}),
        kind="plane strain",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in ("upper", "lower")],
        supports=[sg.Support("lower.bottom", u=(0, 0))],
        loads=[sg.Load("upper.top", pressure=sg.Formula(SLANTED))],
        contacts=[sg.Contact("upper.bottom", "lower.top", friction=0.3, closure=GASKET, name="joint")],
    )
    step = sg.solve(model).steps[0]
    assert step.contacts[0].coupling == "mortar"
    assert {"stiffens", "softens"} <= {event.what for event in step.events}
    obeys(step.contacts[0])
    assert abs(step.energy_defect) < 1e-14


def cube(facets, steps):
    """A block in space on a bed."""
    return sg.Model(
        sg.box(x=[0, 0.5, 1.0], y=[0, 0.5, 1.0], z=[0, 0.5]),
        kind="3d",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        loads=[
            sg.Load("top", pressure=sg.Formula("2 + 9*x + 3*y"), name="p"),
            sg.Load("top", traction=(1.0, 0.3, 0), name="q"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=0.3, facets=facets, closure=GASKET)],
        steps=steps,
    )


@pytest.mark.slow
def test_in_space_paths_on_facets_are_exact_and_increments_come_near():
    exact = sg.solve(cube(8, [sg.Step(scale={"p": 1.0}, path="exact"), sg.Step(scale={"q": 1.0}, path="exact")]))
    fine = sg.solve(cube(8, [sg.Step(scale={"p": 1.0}, increments=40), sg.Step(scale={"q": 1.0}, increments=40)]))
    for one, two in zip(exact.steps, fine.steps, strict=True):
        assert abs(one.energy_defect) < 1e-14
        assert {event.what for event in one.events} & {"stiffens", "softens"}
        assert_allclose(one.contacts[0].pressure, two.contacts[0].pressure, rtol=0, atol=5e-3)
        obeys(one.contacts[0])
        obeys(two.contacts[0])


def test_pairs_that_come_to_a_kink_together_cross_it_together():
    solution = sg.solve(
        block_on_a_bed(12.0, friction=0.2, steps=[sg.Step(scale={"p": 1.0, "q": 0.0}), sg.Step(scale={"p": 0.3})])
    )
    found = [(round(event.load_factor, 12), event.what, len(event.nodes)) for event in solution.steps[0].events[1:]]
    assert found == [(round(p / 12, 12), what, 9) for p, what in ((1, "stiffens"), (4, "softens"), (8, "stiffens"))]
    found = [(round(event.load_factor, 9), event.what, len(event.nodes)) for event in solution.steps[1].events]
    assert found == [(round(1 + (12 - p) / 8.4, 9), w, 9) for p, w in ((8, "softens"), (4, "stiffens"))]


def test_an_overlap_presses_over_kinks_before_the_loads():
    step = sg.solve(block_on_a_bed(6.0, interference=0.02)).steps[0]
    assert_allclose(step.contacts[0].pressure, 6.0, rtol=1e-12)
    assert_allclose(step.contacts[0].gap, -0.0275, rtol=1e-12)
    assert abs(step.energy_defect) < 1e-14


@pytest.mark.slow
def test_a_history_goes_on_from_a_file_and_not_with_another_closure(tmp_path):
    steps = [PRESS, replace(PRESS, scale={"q": 1.0}), replace(PRESS, scale={"p": 0.6})]
    model = block_on_a_bed(SLANTED, friction=0.3, steps=steps)
    whole = sg.solve(model)
    part = sg.solve(replace(model, steps=steps[:2]))
    part.write(tmp_path / "part.h5")
    part.save_state(tmp_path / "start.npz")
    assert sg.load(tmp_path / "part.h5").model.contacts[0].closure == GASKET
    rest = sg.solve(replace(model, steps=steps[2:]), start=tmp_path / "start.npz")
    assert np.array_equal(rest.steps[0].contacts[0].pressure, whole.steps[2].contacts[0].pressure)
    assert rest.steps[0].dissipation == whole.steps[2].dissipation
    other = block_on_a_bed(SLANTED, sg.Closure([*GASKET.points[:-1], (0.05, 30.0)]), friction=0.3, steps=steps[2:])
    with pytest.raises(sg.InputError, match="the compliance of line 4 of the closure") as caught:
        sg.solve(other, start=tmp_path / "start.npz")
    assert "contact 'bed'" in str(caught.value)


def test_bodies_that_yield_on_a_bed():
    model = block_on_a_bed(SLANTED, cells=4, steps=[sg.Step(scale={"p": 1.0}, increments=2)])
    soft = sg.Elastic(E=1000.0, nu=0.0, plastic=sg.Plastic(12.0, hardening=100.0))
    step = sg.solve(replace(model, bodies=[sg.Body("block", soft)])).steps[0]
    assert step.yielding.share > 0.05
    obeys(step.contacts[0])


def test_the_certificate_asks_the_table():
    prepared = prepare(block_on_a_bed(SLANTED, steps=[sg.Step(increments=1)]))
    state = sg.solve(prepared.model).end.state
    assert measured(prepared, state).passed
    closure = prepared.interface.closure
    other = replace(
        closure, rest=np.where(np.arange(len(closure.rest))[:, None] == 3, closure.rest + 1e-6, closure.rest)
    )
    wrong = replace(prepared, interface=replace(prepared.interface, closure=other))
    found = measured(wrong, state)
    assert not found.passed
    assert max(found.penetration, found.complementarity) > 1e-6


def test_modes_are_those_about_the_lines_of_the_pressures():
    solution = sg.solve(block_on_a_bed(6.0))
    lightly = replace(solution.model, bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.0, density=1.0))])
    at = sg.natural_modes(sg.solve(lightly), 2).frequencies
    bed = replace(lightly.contacts[0], closure=None, normal_compliance=0.025 / 4.0)
    line = sg.natural_modes(sg.solve(replace(lightly, contacts=[bed])), 2).frequencies
    assert_allclose(at, line, rtol=1e-9)


KEPT = sg.Closure([(0.0, 0.0), (0.1, 2.0), (0.15, 10.0)], unloading=400.0)  # of 10, 0.125 is kept of 0.15


def test_a_gasket_springs_back_along_its_own_line_and_keeps_the_rest():
    """Closed forms of closure, stored and dissipated energy, to a pressure, to none, to less, to more and to less."""
    loads = (6.0, 0.0, 3.0, 10.0, 2.0)
    steps = [sg.Step(scale={"p": load / 10.0}, path="exact") for load in loads]
    solution = sg.solve(block_on_a_bed(10.0, KEPT, steps=steps))
    most, lost = 0.0, {0.0: 0.0, 6.0: 2.0 * (0.1 + 0.1 - 6.0**2 / 800), 10.0: 2.0 * (0.1 + 0.3 - 10.0**2 / 800)}
    for load, step in zip(loads, solution.steps, strict=True):
        before, most = most, max(most, load)
        closed = np.interp(most, [0.0, 2.0, 10.0], [0.0, 0.1, 0.15]) - (most - load) / 400.0
        assert_allclose(step.contacts[0].gap, -closed, rtol=1e-12)
        assert step.interface_energy == pytest.approx(2.0 * load**2 / 800.0, abs=1e-15)
        assert step.dissipation == pytest.approx(lost[most] - lost[before], abs=1e-13)
        assert step.strain_energy == pytest.approx(2.0 * load**2 / 2000.0, abs=1e-13)
        assert abs(step.energy_defect) < 1e-14
    kinks = [(event.what, round(event.load_factor, 9)) for event in solution.steps[3].events]
    assert kinks == [("softens", round(3.0 + 3.0 / 7.0, 9))]


@pytest.mark.slow
def test_gaskets_with_friction_are_followed_exactly_where_nothing_is_asked_and_answered_alike_elsewhere():
    ways = [{"p": 0.6, "q": 0.0}, {"p": 0.1}, {"p": 0.8, "q": 1.0}]
    model = block_on_a_bed(SLANTED, KEPT, friction=0.2, cells=5, steps=[sg.Step(scale=way) for way in ways])
    exact = sg.solve(model)
    fine = sg.solve(replace(model, steps=[sg.Step(scale=way, increments=40) for way in ways]))
    coarse = replace(model, steps=[sg.Step(scale=way, increments=1) for way in ways])
    for one, two, three, four in zip(
        exact.steps, fine.steps, sg.solve(coarse).steps, sg.solve(coarse, backend="iterative").steps, strict=True
    ):
        assert one.path == "exact"
        assert abs(one.energy_defect) < 1e-14
        assert_allclose(one.contacts[0].pressure, two.contacts[0].pressure, rtol=0, atol=2e-3)
        assert_allclose(three.contacts[0].pressure, four.contacts[0].pressure, rtol=0, atol=1e-7)
    alone = replace(block_on_a_bed(SLANTED, KEPT), steps=[sg.Step()])
    assert sg.solve(alone).steps[0].path == "exact"  # the way there counts, without friction too


@pytest.mark.slow
def test_a_gasket_in_space_and_a_state_of_it_in_a_file(tmp_path):
    steps = [sg.Step(scale={"p": part, "q": 0.5 * part}, path="exact") for part in (0.5, 0.1, 0.7)]
    model = cube(4, steps)
    model = replace(model, contacts=[replace(model.contacts[0], closure=KEPT)])
    whole = sg.solve(model)
    assert max(abs(step.energy_defect) for step in whole.steps) < 1e-14
    sg.solve(replace(model, steps=steps[:2])).save_state(tmp_path / "start.npz")
    rest = sg.solve(replace(model, steps=steps[2:]), start=tmp_path / "start.npz").steps[0]
    assert np.array_equal(rest.contacts[0].pressure, whole.steps[2].contacts[0].pressure)
    assert rest.dissipation == whole.steps[2].dissipation > 0.01
    bare = replace(model, steps=steps[2:], contacts=[replace(model.contacts[0], closure=replace(KEPT, unloading=None))])
    with pytest.raises(sg.InputError, match="the compliance of unloading"):
        sg.solve(bare, start=tmp_path / "start.npz")


@pytest.mark.parametrize("closure", [GASKET, KEPT])
def test_energies_of_nodes_that_files_have_add_up_to_that_of_the_interface(closure):
    steps = [PRESS, sg.Step(scale={"p": 0.7}, path="exact")]
    for step in sg.solve(block_on_a_bed(SLANTED, closure, cells=4, steps=steps)).steps:
        contact = sg.Contact("bottom", "top", closure=closure)
        assert slave_energies(contact, step.contacts[0]).sum() == pytest.approx(step.interface_energy, rel=1e-12)


@pytest.mark.parametrize("given", [{"closure": GASKET}, {"cohesion": sg.Cohesion(5.0, opening=0.02)}])
def test_what_lies_between_sides_goes_with_ties_beside_it(given):
    """A block in one piece, and of two that are tied."""

    def pressures(mesh, names, tied):
        return sg.solve(
            sg.Model(
                mesh,
                kind="plane strain",
                bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in names],
                supports=[sg.Support("upper.top" if tied else "top", u=(0, -0.012 if "closure" in given else 0.012))],
                contacts=[
                    *tied,
                    sg.Contact("lower.bottom" if tied else "bottom", sg.Plane((0, 0), (0, 1)), friction=0.2, **given),
                ],
                steps=[sg.Step(path="exact")],
            )
        ).steps[0]

    whole = pressures(sg.rectangle(width=2.0, height=1.0, nx=4, ny=4), ["block"], [])
    halves = {
        name: sg.rectangle(width=2.0, height=0.5, nx=4, ny=2, origin=(0, at))
        for name, at in (("lower", 0), ("upper", 0.5))
    }
    tie = sg.Contact("upper.bottom", "lower.top", friction="tied")
    parts = pressures(sg.join(halves), list(halves), [tie])
    assert np.abs(whole.contacts[-1].pressure).min() > 1.0
    assert_allclose(parts.contacts[-1].pressure, whole.contacts[-1].pressure, rtol=1e-11)
