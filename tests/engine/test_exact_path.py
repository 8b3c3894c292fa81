# SPDX-License-Identifier: BSD-3-Clause
"""Exact paths through a whole model: against increments, energy, jumps."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine import increments
from signorini.gallery.blocks import dragged_block, stacked_blocks
from signorini.gallery.cylinder import HERTZ, zhu_cylinder

UP_AND_DOWN = [
    sg.Step(name="press"),
    sg.Step(name="nearly off", scale={"cut": 0.05}),
    sg.Step(name="again", scale={"cut": 1.0}),
]


def in_increments(steps, number):
    return [replace(step, increments=number) for step in steps]


@pytest.mark.slow
def test_increments_converge_to_the_exact_path():
    """First order at best (the findings of any increment: 1 is off by 36 % of mu p_0 in friction on this mesh)."""
    exact = sg.solve(zhu_cylinder(refine=2, steps=[sg.Step(name="press")]))
    assert exact.last.path == "exact"
    contact = exact.contact("foundation")
    errors = []
    for number in (1, 10, 100, 1000):
        found = sg.solve(zhu_cylinder(refine=2, steps=[sg.Step(increments=number)])).contact("foundation")
        errors.append(np.abs(found.traction - contact.traction).max() / (0.4 * HERTZ.peak_pressure))
    assert errors[0] > 0.3
    assert (np.diff(errors) < 0).all()
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("model", [zhu_cylinder(refine=2, steps=UP_AND_DOWN), None], ids=["cylinder", "block"])
def test_work_is_stored_or_dissipated_exactly(model):
    if model is None:
        block = dragged_block()
        model = replace(block, steps=in_increments(block.steps, None))
    solution = sg.solve(model)
    stored = 0.0
    size = max(abs(step.work) for step in solution.steps)
    for step in solution.steps:
        assert step.path == "exact"
        assert step.certificate.passed
        now = step.strain_energy + step.interface_energy
        assert abs(step.work - (now - stored) - step.dissipation) <= 1e-10 * size
        assert step.dissipation >= 0.0
        stored = now
    assert solution.steps[-1].dissipation + solution.steps[-2].dissipation > 0.0


@pytest.mark.parametrize("compliance", [0.0, 1e-3])
def test_increments_that_end_at_the_events_reproduce_the_path(compliance):
    model = zhu_cylinder(refine=1, compliance=compliance, steps=UP_AND_DOWN[:2])
    exact = sg.solve(model)
    steps, factor = [], 0.0
    for number, (step, end) in enumerate(zip(exact.steps, (1.0, 0.05), strict=True)):
        start = factor
        for at in sorted({event.load_factor - number for event in step.events} | {1.0}):
            factor = start + at * (end - start)
            steps.append(sg.Step(scale={"cut": factor}, increments=1))
    found = sg.solve(replace(model, steps=steps)).contact("foundation")
    contact = exact.contact("foundation")
    for name in ("pressure", "traction"):
        np.testing.assert_allclose(
            getattr(found, name), getattr(contact, name), rtol=0, atol=1e-9 * contact.pressure.max()
        )


def test_flat_contact_is_one_piece():
    solution = sg.solve(stacked_blocks(friction=0.3))
    assert solution.last.path == "exact"
    np.testing.assert_allclose(solution.contact("interface").pressure, 1e5, rtol=1e-10)


def test_events_are_reported_by_contact_and_node():
    step = sg.solve(zhu_cylinder(steps=[sg.Step(name="press")])).last
    closing = [event for event in step.events if event.what == "closes"]
    assert [event.contact for event in closing] == ["foundation"] * len(closing)
    # the pairs close one after the other from the centre outwards
    x = [step.contacts[0].points[list(step.contacts[0].node).index(event.nodes[0]), 0] for event in closing]
    assert x == sorted(x)
    assert all(0.0 <= event.load_factor <= 1.0 for event in step.events)


def test_sliding_under_force_control_is_named():
    """Pulled with more than friction carries: exact says where it begins to slide as a whole, and does not go on."""
    steps = [sg.Step(name="press", scale={"press": 1.0}), sg.Step(name="pull", scale={"push": 2.0}, path="exact")]
    with pytest.raises(sg.SolveFailed, match=r"^step 'pull' at 66\.6666..%: gross sliding") as caught:
        sg.solve(replace(dragged_block(friction=0.2), steps=steps))
    assert caught.value.status == "jump"
    press, pull = caught.value.solution.steps
    assert (press.finished, pull.finished) == (True, False)
    np.testing.assert_allclose(pull.load_factor, 1.0 + 2.0 / 3.0, rtol=1e-12)
    (floor,) = pull.contacts
    np.testing.assert_allclose(abs(floor.tangential_force[0]), 0.2 * floor.normal_force[1], rtol=1e-12)


def test_increments_before_one_without_a_solution_are_kept():
    steps = [sg.Step(scale={"press": 1.0}, increments=1), sg.Step(scale={"push": 2.0}, increments=10)]
    solution = sg.solve(replace(dragged_block(friction=0.2), steps=steps), raise_on_failure=False)
    assert solution.status == "no_equilibrium"
    np.testing.assert_allclose(solution.last.load_factor, 1.6)
    assert (solution.last.finished, solution.last.increments) == (False, 6)
    np.testing.assert_allclose(solution.contact("foundation").tangential_force[0], -0.6 * 1.2)
    assert "NOT finished, as far as 60.000000%" in str(solution)


def test_increments_before_an_interruption_are_kept(monkeypatch):
    counted = iter(range(100))
    on_its_way = increments.advance

    def advance(*given, **named):
        if next(counted) == 5:
            raise KeyboardInterrupt
        return on_its_way(*given, **named)

    monkeypatch.setattr(increments, "advance", advance)
    steps = [sg.Step(scale={"press": 1.0}, increments=2), sg.Step(scale={"push": 1.0}, increments=10)]
    solution = sg.solve(replace(dragged_block(), steps=steps), raise_on_failure=False)
    assert solution.status == "interrupted"
    np.testing.assert_allclose(solution.last.load_factor, 1.3)


def rough_block(jump):
    """Clamped on the left, pressed on a very rough floor, lifted on the right: a node cannot let go gradually."""
    return sg.Model(
        sg.rectangle(nx=2, ny=2),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0.0, 0.0))],
        loads=[
            sg.Load("bottom", traction=(0.0, -2.0), name="press"),
            sg.Load("right", traction=(0.0, 2.0), name="lift"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=4.0, name="floor")],
        steps=[sg.Step(scale={"press": 1.0}), sg.Step(name="lift", scale={"lift": 1.0}, jump=jump)],
    )


def test_a_jump_is_followed_by_choice_and_called_a_candidate():
    with pytest.raises(sg.SolveFailed, match=r"^step 'lift' at 75\.8110..%: a jump"):
        sg.solve(rough_block("stop"))
    step = sg.solve(rough_block("follow")).last
    assert step.path == "exact"
    assert [instant.what for instant in step.instants][-3:] == ["jump", "landing", "segment"]
    jump, landing = step.instants[-3:-1]
    assert jump.load_factor == landing.load_factor == pytest.approx(1.7581108, abs=1e-6)
    assert any("candidate" in note for note in step.notes)
    assert step.released > 0.0
    assert abs(step.energy_defect) < 1e-12 * step.work
    # the last state is an equilibrium that increments from there hold
    assert step.certificate.passed


def test_a_pair_that_never_slips_and_can_neither_stick_nor_open_is_named():
    """Where the law has no solution; the usual cause of a failed certificate, extreme ratios, is not to blame."""
    model = sg.Model(
        sg.rectangle(width=1.0, height=0.3, nx=3, ny=1),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        loads=[
            sg.Load("top", traction=(0.0, -1.0), name="press"),
            sg.Load("top", traction=(-1.7, -0.4), name="push"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction="stick", name="floor")],
        steps=[sg.Step(scale={"press": 1.0}), sg.Step(name="push", scale={"push": 1.0}, increments=4)],
    )
    solution = sg.solve(model, raise_on_failure=False)
    assert solution.status == "not_found"
    assert "node 4 of contact 'floor', which never slips, can neither stick nor open" in solution.message
    assert "what to do: finite friction of 'floor'" in solution.message


def test_gross_sliding_is_not_followed():
    steps = [
        sg.Step(name="press", scale={"press": 1.0}),
        sg.Step(name="pull", scale={"push": 2.0}, jump="follow", path="exact"),
    ]
    with pytest.raises(
        sg.SolveFailed, match=r"gross sliding.*; no equilibrium that it could land on was found\n  what to do: hold"
    ):
        sg.solve(replace(dragged_block(friction=0.2), steps=steps))


def in_a_corner(friction, **parts):
    """A block between a floor and a wall, held by contact alone; the node in the corner has a pair with either."""
    return sg.Model(
        sg.rectangle(nx=4, ny=4),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        loads=[sg.Load("top", pressure=1.0, name="press"), sg.Load("right", pressure=1.0, name="push")],
        contacts=[
            sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=friction, name="floor"),
            sg.Contact("left", sg.Plane((0, 0), (1, 0)), friction=friction, name="wall"),
        ],
        steps=[
            sg.Step(name="press", scale={"press": 1.0, "push": 1.0}, **parts),
            sg.Step(name="lift", scale={"press": -0.2}, **parts),
            sg.Step(name="back", scale={"press": 0.5}, **parts),
        ],
    )


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.25, 0.8])
def test_two_contacts_share_a_node_on_an_exact_path(friction):
    """Forces in the corner are not unique; the path is followed all the same, and increments come to the same end."""
    exact = sg.solve(in_a_corner(friction))
    for step, load in zip(exact.steps, (1.0, -0.2, 0.5), strict=True):
        assert step.path == "exact"
        assert all("across, between open ones" in note for note in step.notes)  # the mesh is as coarse as that
        total = sum(contact.normal_force + contact.tangential_force for contact in step.contacts)
        np.testing.assert_allclose(total, [1.0, load], atol=1e-12)
        assert abs(step.energy_defect) < 1e-15
        assert step.certificate.passed
    assert (exact.steps[1].contacts[0].status == "open").any()
    fine = sg.solve(in_a_corner(friction, increments=200))
    size = np.abs(exact.last.displacement).max()
    np.testing.assert_allclose(fine.last.displacement, exact.last.displacement, atol=0.01 * size)
