# SPDX-License-Identifier: BSD-3-Clause
"""Bonds where there are no exact paths: in increments, on bodies as they are, on smooth cones, beside what yields."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.engine.bond_tensions import Tensions
from signorini.gallery.cohesion import bonded_bar, cantilever

GENTLE = sg.Cohesion(5.0, opening=0.02)


def beside(one, two, tolerance):
    """Two solutions of one history, step by step: pressures of the largest, and damage."""
    for found, expected in zip(one.steps, two.steps, strict=True):
        assert found.certificate.passed
        for own, other in zip(found.contacts, expected.contacts, strict=True):
            largest = np.abs(other.pressure).max(initial=1e-3)
            assert_allclose(own.pressure, other.pressure, rtol=0, atol=tolerance * largest)
            if own.damage is not None:
                assert_allclose(own.damage, other.damage, rtol=0, atol=tolerance)


def in_increments(model, number=4, **options):
    """A model's solution in so many increments a step."""
    steps = [replace(step, path="increments", increments=number) for step in model.steps]
    return sg.solve(replace(model, steps=steps), **options)


@pytest.mark.parametrize("backend", ["auto", "iterative"])
@pytest.mark.parametrize("compliance", [0.0, 1e-3])
def test_a_bar_is_where_the_exact_path_leads(compliance, backend):
    """Opening, back, up again and beyond, pressed, gone, and pressed again, each in one increment."""
    steps = [sg.Step(scale={"pull": pull}) for pull in (0.004, 0.012, 0.003, 0.016, -0.002, 0.03, -0.001)]
    model = bonded_bar(GENTLE, 1.0, compliance=compliance, steps=steps)
    beside(in_increments(model, 1, backend=backend), sg.solve(model), 1e-9)


BONDS = {
    "soft": sg.Cohesion(2.5, opening=0.024, shear="free"),
    "jumps": sg.Cohesion(10.0, opening=0.006),
    "brittle": sg.Cohesion(10.0, shear="free"),
    "brittle along": sg.Cohesion(10.0, shear_strength=20.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("bond", BONDS.values(), ids=list(BONDS))
def test_an_arm_that_peels_is_where_the_exact_path_lands(bond):
    """Bonds of a process zone soften together, and let go in jumps: increments end at the same equilibrium."""
    steps = [sg.Step(scale={"peel": lift}) for lift in (0.1, 0.3, 0.15, 0.4)]
    model = cantilever(bond, lift=1.0, cells=32, steps=steps)
    exact = sg.solve(model)
    found = in_increments(model)
    beside(found, exact, 1e-9)
    assert 0 < (found.steps[1].contacts[0].damage == 1.0).sum() < len(found.steps[1].contacts[0].damage)
    assert any("bonds let go within increments" in note for note in found.steps[3].notes)
    assert [step.dissipation for step in found.steps] == pytest.approx([step.dissipation for step in exact.steps])


@pytest.mark.slow
def test_a_block_is_torn_off_a_base_as_they_are():
    """Iterated beside condensed: sides that do not match, bonds that go on with friction behind them."""
    meshes = {
        "block": sg.rectangle(width=2.0, height=1.0, nx=6, ny=2),
        "base": sg.rectangle(width=2.0, height=0.5, nx=5, ny=1, origin=(0, -0.5)),
    }
    model = sg.Model(
        sg.join(meshes),
        kind="plane strain",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in meshes],
        supports=[sg.Support("base.bottom", u=(0, 0)), sg.Support("block.left", u=(None, 1.0), name="lift")],
        contacts=[sg.Contact("block.bottom", "base.top", cohesion=sg.Cohesion(2.0, opening=0.01), friction=0.3)],
        steps=[sg.Step(scale={"lift": lift}) for lift in (0.008, 0.012, -0.001)],
    )
    found = in_increments(model, 3, backend="iterative")
    beside(found, in_increments(model, 3), 1e-8)
    assert 0.0 < found.steps[0].contacts[0].damage.max() < 1.0
    assert found.steps[-1].contacts[0].pressure.max() > 0.0


def cubes(**contact):
    """A cube that is torn off another, and pressed on it askew."""
    upper = sg.box(x=[0, 0.5, 1], y=[0, 0.5, 1], z=[0, 1])
    lower = sg.box(x=[0, 1 / 3, 2 / 3, 1], y=[0, 0.5, 1], z=[-0.5, 0])
    return sg.Model(
        sg.join({"upper": upper, "lower": lower}),
        kind="3d",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in ("upper", "lower")],
        supports=[sg.Support("lower.bottom", u=(0, 0, 0)), sg.Support("upper.top", u=(0.3, 0.1, 1.0), name="pull")],
        contacts=[sg.Contact("upper.bottom", "lower.top", cohesion=GENTLE, name="bond", **contact)],
        steps=[sg.Step(scale={"pull": stretch}) for stretch in (0.008, 0.03, 0.0, -0.004)],
    )


@pytest.mark.slow
def test_a_cube_is_torn_off_on_smooth_cones():
    """Without friction as exactly as on the exact path; with it beside a polygon of many sides."""
    beside(in_increments(cubes()), sg.solve(cubes()), 1e-12)
    smooth, polygon = in_increments(cubes(friction=0.1)), sg.solve(cubes(friction=0.1, facets=64))
    beside(smooth, polygon, 2e-3)
    assert np.abs(smooth.steps[-1].contacts[0].traction).max() > 0.1
    begun = sg.solve(replace(cubes(friction=0.1), steps=[sg.Step(scale={"pull": 0.008})])).steps[0]
    assert begun.path == "increments"
    assert_allclose(begun.contacts[0].damage, polygon.steps[0].contacts[0].damage, atol=1e-9)


def test_a_ring_is_torn_off_with_twist_on_smooth_cones():
    """Pressed on and turned behind its bond, beside a polygon of many sides."""
    found = []
    for facets in (0, 64):
        ring = sg.Model(
            sg.rectangle(x=[1.0, 1.5, 2.0], y=[0, 0.5, 1.0]),
            kind="axisymmetric twist",
            bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
            supports=[sg.Support("top", u=(0.0, 1.0, 0.3), name="pull")],
            contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), cohesion=GENTLE, friction=0.3, facets=facets)],
            steps=[sg.Step(scale={"pull": stretch}) for stretch in (0.01, 0.03, 0.0, -0.003)],
        )
        found.append(sg.solve(ring) if facets else in_increments(ring))
    beside(*found, 1e-3)
    assert np.abs(found[0].steps[-1].contacts[0].traction).max() > 0.5


@pytest.mark.parametrize("backend", ["auto", "iterative"])
def test_a_bar_that_yields_is_drawn_off(backend):
    """It flows from 4 on, its bond softens from 5 on: stretch = strain + layer + opening, by hand."""
    bars = bonded_bar(sg.Cohesion(5.0, opening=0.04, shear="free"), compliance=1e-3)
    steel = sg.Elastic(E=1000.0, nu=0.0, plastic=sg.Plastic(4.0, hardening=500.0))
    model = replace(
        bars,
        bodies=[sg.Body("block", steel)],
        supports=[sg.Support("left", u=(0, None)), sg.Support("top", u=(None, 1.0), name="pull")],
        steps=[sg.Step(scale={"pull": pull}) for pull in (0.012, 0.018, 0.008)],
    )
    with pytest.raises(
        sg.InputError, match=r'path: is "exact", but bonds are followed in increments where a body yields'
    ):
        sg.solve(replace(model, steps=[sg.Step(path="exact")]), backend=backend)
    _, opened, back = in_increments(model, 4, backend=backend).steps
    flowed = (5.0 - 4.0) / 500.0
    opening = (0.018 - flowed - 0.01) / 0.75
    assert_allclose(opened.contacts[0].damage, opening / 0.04, rtol=1e-8)
    assert_allclose(opened.contacts[0].pressure, -5.0 + 125.0 * opening, rtol=1e-8)
    stiffness = (5.0 - 125.0 * opening) / opening
    assert_allclose(back.contacts[0].pressure, -(0.008 - flowed) / (0.002 + 1.0 / stiffness), rtol=1e-8)


@pytest.mark.slow
def test_an_arm_that_yields_peels_the_same_both_ways():
    model = cantilever(sg.Cohesion(10.0, opening=0.006), lift=0.3, cells=16)
    steel = sg.Elastic(E=1e4, nu=0.0, plastic=sg.Plastic(20.0, hardening=500.0))
    model = replace(model, bodies=[replace(model.bodies[0], material=steel)])
    one, two = (in_increments(model, 4, backend=backend) for backend in ("auto", "iterative"))
    beside(one, two, 1e-7)
    assert (one.steps[0].contacts[0].damage == 1.0).any()
    assert one.steps[0].dissipation > 0.0


def lidded(**lid):
    """A block that is bonded below, and lifted at one end against a lid on something that closes."""
    blocks = {
        "lid": sg.rectangle(width=2.0, height=0.5, nx=3, ny=1, origin=(0, 1)),
        "block": sg.rectangle(width=2.0, height=1.0, nx=4, ny=2),
    }
    return sg.Model(
        sg.join(blocks),
        kind="plane stress",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.2)) for name in blocks],
        supports=[sg.Support("lid.top", u=(0.002, -0.0005), name="drag")],
        loads=[sg.Load("block.right", traction=(0.0, 1.2), name="lift")],
        contacts=[
            sg.Contact("lid.bottom", "block.top", name="lid", friction=0.3, **lid),
            sg.Contact("block.bottom", sg.Plane((0, 0), (0, 1)), cohesion=sg.Cohesion(1.0, opening=0.01), name="bond"),
        ],
        steps=[sg.Step(scale={"drag": drag, "lift": lift}) for drag, lift in ((1.0, 1.0), (1.5, 0.2), (0.5, 1.3))],
    )


@pytest.mark.slow
def test_a_closure_beside_a_bond():
    """One of a single line is a compliance; one with a kink is the same condensed and on bodies as they are."""
    straight = sg.Closure([(0.0, 0.0), (1e-3, 1.0), (2e-3, 2.0)])
    found = in_increments(lidded(closure=straight))
    beside(found, sg.solve(lidded(normal_compliance=1e-3)), 1e-9)
    kinked = lidded(closure=sg.Closure([(0.0, 0.0), (1e-3, 0.02), (2e-3, 3.0)]))
    one = in_increments(kinked)
    beside(one, in_increments(kinked, backend="iterative"), 1e-8)
    pressure = one.steps[0].contacts[0].pressure
    assert pressure.min() < 0.02 < pressure.max()


def test_a_closure_beside_a_bond_on_a_layer_stores_what_a_compliance_does():
    """The layer of the bond is drawn, and its energy is there, too."""
    found = []
    for lid in ({"normal_compliance": 1e-3}, {"closure": sg.Closure([(0.0, 0.0), (1e-3, 1.0), (2e-3, 2.0)])}):
        model = lidded(**lid)
        contacts = [model.contacts[0], replace(model.contacts[1], normal_compliance=5e-4)]
        found.append(in_increments(replace(model, contacts=contacts)))
    beside(*found, 1e-9)
    for one, two in zip(*(each.steps for each in found), strict=True):
        assert one.work == pytest.approx(two.work, rel=1e-9)
        assert one.energy_defect == pytest.approx(two.energy_defect, abs=1e-9 * abs(one.work))


def rubbed(drag, lift=1.4, **rub):
    """A block that is bonded below and lifted at one end, while a slider is drawn over it."""
    blocks = {
        "slider": sg.rectangle(width=0.6, height=0.3, nx=2, ny=1, origin=(0.2, 1.0)),
        "block": sg.rectangle(width=2.0, height=1.0, nx=4, ny=2),
    }
    return sg.Model(
        sg.join(blocks),
        kind="plane strain",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in blocks],
        supports=[sg.Support("slider.top", u=(drag, -0.004), name="drag")],
        loads=[sg.Load("block.right", traction=(0.0, lift), name="lift")],
        contacts=[
            sg.Contact("slider.bottom", "block.top", friction=0.3, name="rub", **rub),
            sg.Contact("block.bottom", sg.Plane((0, 0), (0, 1)), cohesion=sg.Cohesion(1.2, opening=0.02), name="bond"),
        ],
        steps=[sg.Step()],
    )


@pytest.mark.slow
def test_sides_of_another_contact_slide_far():
    """Not moved at all they are those that stay; drawn by facets they slide, and the bond goes on to open."""
    beside(*(in_increments(rubbed(0.0, 1.0, **sides), 2) for sides in ({}, {"sliding": "finite"})), 1e-9)
    near, far = (in_increments(rubbed(0.15, **sides), 1).steps[0] for sides in ({}, {"sliding": "finite"}))
    assert far.certificate.passed
    assert np.abs(far.contacts[0].slip).max() > 0.14
    assert 0.0 < far.contacts[1].damage.max() < 1.0
    assert not np.allclose(far.contacts[1].damage, near.contacts[1].damage, atol=1e-3)


@pytest.mark.slow
def test_another_contact_wears():
    """So little that nothing changes, and so much that the slider presses less."""
    plain = in_increments(rubbed(0.02), 16).steps[0]
    little, much = (in_increments(rubbed(0.02, wear=sg.Wear(rate)), 16).steps[0] for rate in (1e-9, 3e-3))
    assert_allclose(little.contacts[1].damage, plain.contacts[1].damage, atol=1e-6)
    assert little.contacts[0].wear is not None
    pressed, worn = (float(step.contacts[0].pressure @ step.contacts[0].area) for step in (plain, much))
    assert worn < 0.99 * pressed
    assert much.contacts[1].damage.max() > plain.contacts[1].damage.max() > 0.0


def test_a_load_that_bonds_do_not_bear_is_named():
    model = replace(
        bonded_bar(sg.Cohesion(5.0)),
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", traction=(0, 6.0), name="pull")],
    )
    with pytest.raises(
        sg.SolveFailed, match=r"step 1 at 100%: .*body 'block' can move along y: bonds let go"
    ) as caught:
        in_increments(model, 2)
    assert caught.value.status == "jump"
    assert caught.value.solution.steps[0].load_factor == 0.5


def test_what_rounds_have_seen_tells_whether_bonds_are_stable():
    """Lines of slope 1 beside a compliance W: tensions settle where 1 - W is positive definite, else one is driven."""
    opens, limit, slope = np.ones(2, np.bool_), np.ones(2), np.ones(2)
    for W, stable in ((np.array([[0.5, 0.3], [0.3, 0.6]]), True), (np.array([[0.9, 0.3], [0.3, 0.6]]), False)):
        tensions, tension = Tensions(2), np.ones(2)
        for _ in range(6):
            line = np.clip(0.2 * np.ones(2) + W @ tension, 0.0, 1.0) if stable else np.clip(W @ tension - 0.21, 0, 1)
            if tensions.settled(opens, tension, line, limit, 0.0):
                break
            tension = tensions.following(opens, tension, line, slope, limit)
        assert tensions.driven.any() != stable
        if stable:
            assert_allclose(tension, np.linalg.solve(np.eye(2) - W, [0.2, 0.2]).clip(0, 1), atol=1e-12)


def test_bonds_that_are_free_to_slide_have_no_friction_while_they_hold():
    """Certificates ask none of them, of a block that friction would hold back under a load along its sides."""
    bond = sg.Cohesion(5.0, opening=0.02, shear="free")
    bar = replace(bonded_bar(bond, 0.004), loads=[sg.Load("left", traction=(1.0, 0.0), name="side")])
    model = replace(bar, contacts=[replace(bar.contacts[0], friction=0.3)], steps=[sg.Step()])
    step = in_increments(model, 2).steps[0]
    assert step.certificate.passed
    assert np.abs(step.contacts[0].traction).max() == 0.0
    beside(in_increments(model, 2), sg.solve(model), 1e-12)


def test_increments_go_on_from_a_file_and_check_says_how_bonds_are_followed(tmp_path):
    steps = [sg.Step(scale={"pull": pull}, path="increments", increments=2) for pull in (0.012, 0.004, 0.015)]
    whole = sg.solve(bonded_bar(GENTLE, 1.0, steps=steps))
    sg.solve(bonded_bar(GENTLE, 1.0, steps=steps[:2])).save_state(tmp_path / "start.npz")
    rest = sg.solve(bonded_bar(GENTLE, 1.0, steps=steps[2:]), start=tmp_path / "start.npz").steps[0]
    assert_allclose(rest.contacts[0].pressure, whole.steps[2].contacts[0].pressure, rtol=1e-12)
    told = str(sg.check(bonded_bar(GENTLE, 1.0, steps=[*steps[:1], sg.Step(), sg.Step(increments="auto")])))
    assert "2 increments" in told
    assert "exact path" in told
    assert "increments until forces change less than 0.001" in told
    assert "increments until forces change less than 0.001" in str(
        sg.check(lidded(closure=sg.Closure([(0, 0), (1, 1)])))
    )
