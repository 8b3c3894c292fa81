# SPDX-License-Identifier: BSD-3-Clause
"""What changes the answer exactly as it must: units; and what changes nothing: where one stands and how one counts."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve, solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.press_fit import press_fit
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Plane, Sphere
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from tests.helpers.changed_models import mapped, renumbered, rescaled

few = settings(max_examples=8, deadline=None, derandomize=True)
powers = st.floats(-4, 4).map(lambda x: 10.0**x)


def driven_blocks(*, friction=0.3, cells="quad", compliance=0.0):
    """A narrow block pressed and dragged over a clamped one by full vectors; a gap, a traction, a body force."""
    upper = rectangle(width=1.0, height=0.8, nx=4, ny=3, origin=(1.0, 1.0), cells=cells)
    lower = rectangle(x=[0, 0.5, 1, 1.25, 1.5, 1.75, 2, 3], y=[0, 0.5, 1.0], cells=cells)
    top = lower.boundaries["top"]
    seat = top[(lower.points[top].mean(axis=1)[:, 0] > 1) & (lower.points[top].mean(axis=1)[:, 0] < 2)]
    lower = replace(lower, boundaries={**lower.boundaries, "seat": seat})
    return Model(
        join({"upper": upper, "lower": lower}),
        bodies=[Body("upper", Elastic(E=70.0, nu=0.2)), Body("lower", Elastic(E=100.0, nu=0.35))],
        supports=[
            Support("lower.bottom", u=(0.0, 0.0)),
            Support("upper.top", u=(0.0, -0.03), name="press"),
        ],
        loads=[
            Load("upper.left", traction=(1.5, 0.2), name="push"),
            Load("lower", body_force=(0.1, -0.4), name="weight"),
        ],
        contacts=[
            Contact(
                "upper.bottom",
                "lower.seat",
                friction=friction,
                gap=0.004,
                normal_compliance=compliance,
                tangential_compliance=2 * compliance,
            )
        ],
        steps=[
            Step(name="press", scale={"press": 1.0, "weight": 1.0}, increments=3),
            Step(name="push", scale={"push": 1.0}, increments=3),
        ],
    )


def blocks_that_do_not_match(*, cells="quad", friction=0.3):
    """The same with another mesh of the upper block, and the whole top of the lower one opposite it."""
    model = driven_blocks(cells=cells, friction=friction)
    meshes = {
        "upper": rectangle(width=1.0, height=0.8, nx=5, ny=3, origin=(1.05, 1.0), cells=cells),
        "lower": rectangle(x=[0, 0.5, 1, 1.2, 1.5, 1.75, 2, 3], y=[0, 0.5, 1.0], cells=cells),
    }
    contact = Contact("upper.bottom", "lower.top", friction=friction, gap=0.004)
    return replace(model, mesh=join(meshes), contacts=[contact])


def fields(history):
    """Everything with a unit, at the end of the last step: lengths, then stresses."""
    step = history.last
    lengths = [step.displacement.ravel(), *(c.slip for c in step.contacts), *(c.gap for c in step.contacts)]
    stresses = [*(c.pressure for c in step.contacts), *(c.traction for c in step.contacts)]
    return np.concatenate(lengths), np.concatenate(stresses)


def assert_same(found, expected):
    for here, there in zip(found, expected, strict=True):
        np.testing.assert_allclose(here, there, rtol=0, atol=1e-9 * np.abs(there).max())


def assert_interesting(history):
    """All three states occur, so that the comparison sees them."""
    seen = {status for step in history.steps for contact in step.contacts for status in contact.status}
    assert {"stick", "slip"} <= seen


@pytest.mark.slow
@pytest.mark.parametrize("compliance", [0.0, 0.001])
@few
@given(length=powers, displacement=powers, modulus=powers)
def test_units_of_the_blocks(compliance, length, displacement, modulus):
    model = driven_blocks(compliance=compliance)
    here = solve(model)
    assert_interesting(here)
    there = solve(rescaled(model, length=length, displacement=displacement, modulus=modulus))
    lengths, stresses = fields(here)
    assert_same(fields(there), (length * displacement * lengths, modulus * displacement * stresses))
    work = modulus * (length * displacement) ** 2
    assert there.last.work == pytest.approx(work * here.last.work, rel=1e-9)
    assert there.last.dissipation == pytest.approx(work * here.last.dissipation, rel=1e-9)
    assert [c.status.tolist() for c in there.last.contacts] == [c.status.tolist() for c in here.last.contacts]


@few
@given(length=powers, modulus=powers, friction=st.sampled_from([0.0, 0.4]))
def test_units_of_the_cylinder(length, modulus, friction):
    """Gaps from the geometry: lengths, displacements and gaps share one unit."""
    model = zhu_cylinder(friction=friction, compliance=1e-4)
    lengths, stresses = fields(solve(model))
    assert_same(fields(solve(rescaled(model, length=length, modulus=modulus))), (length * lengths, modulus * stresses))


@few
@given(displacement=powers)
def test_interference_and_pressure_are_proportional(displacement):
    model = press_fit(friction=0.2)
    lengths, stresses = fields(solve(model))
    found = fields(solve(rescaled(model, displacement=displacement)))
    assert_same(found, (displacement * lengths, displacement * stresses))


@few
@given(thickness=powers)
def test_thickness(thickness):
    model = driven_blocks()
    here, there = solve(model), solve(replace(model, thickness=thickness))
    assert_same(fields(there), fields(here))
    for contact, other in zip(here.last.contacts, there.last.contacts, strict=True):
        np.testing.assert_allclose(other.normal_force, thickness * contact.normal_force, rtol=1e-9)
    assert there.last.work == pytest.approx(thickness * here.last.work, rel=1e-9)


def on_a_plane():
    """The upper block alone on a rigid plane, driven by full vectors."""
    model = driven_blocks()
    mesh = rectangle(width=1.0, height=0.8, nx=4, ny=3)
    return Model(
        mesh,
        bodies=[Body("block", Elastic(E=70.0, nu=0.2))],
        supports=[Support("top", u=(0.0, -0.03), name="press")],
        loads=[Load("left", traction=(3.5, 0.2), name="push")],
        contacts=[Contact("bottom", Plane(point=(0.0, 0.0), normal=(0.0, 1.0)), friction=0.3)],
        steps=[Step(name="press", scale={"press": 1.0}), model.steps[1]],
    )


@pytest.mark.slow
@pytest.mark.parametrize("make", [driven_blocks, on_a_plane, blocks_that_do_not_match])
@few
@given(angle=st.floats(-np.pi, np.pi), shift=st.tuples(st.floats(-5, 5), st.floats(-5, 5)))
def test_rotation_and_translation(make, angle, shift):
    model = make()
    here = solve(model)
    assert_interesting(here)
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    there = solve(mapped(model, Q, shift))
    turned = here.last.displacement @ Q.T
    np.testing.assert_allclose(there.last.displacement, turned, rtol=0, atol=1e-9 * np.abs(turned).max())
    for contact, other in zip(here.last.contacts, there.last.contacts, strict=True):
        for name in ("pressure", "traction", "slip", "gap"):
            size = np.abs(getattr(contact, "pressure" if name == "traction" else name)).max()
            np.testing.assert_allclose(getattr(other, name), getattr(contact, name), rtol=0, atol=1e-9 * size + 1e-14)
        np.testing.assert_allclose(other.normals, contact.normals @ Q.T, atol=1e-12)
        np.testing.assert_allclose(other.normal_force, contact.normal_force @ Q.T, atol=1e-8)


@pytest.mark.parametrize("make", [driven_blocks, on_a_plane, zhu_cylinder, press_fit, blocks_that_do_not_match])
def test_mirror(make):
    model = make()
    here, there = solve(model), solve(mapped(model, np.diag([-1.0, 1.0])))
    flip = np.array([-1.0, 1.0])
    np.testing.assert_allclose(there.last.displacement, here.last.displacement * flip, rtol=0, atol=1e-11)
    for contact, other in zip(here.last.contacts, there.last.contacts, strict=True):
        size = contact.pressure.max()
        np.testing.assert_allclose(other.pressure, contact.pressure, rtol=0, atol=1e-9 * size)
        np.testing.assert_allclose(other.traction, -contact.traction, rtol=0, atol=1e-9 * size)
        np.testing.assert_allclose(other.slip, -contact.slip, rtol=0, atol=1e-11)
        assert other.status.tolist() == contact.status.tolist()


@pytest.mark.slow
@pytest.mark.parametrize("cells", ["quad", "triangle"])
@pytest.mark.parametrize("make", [driven_blocks, blocks_that_do_not_match])
@few
@given(seed=st.integers(0, 10**6))
def test_numbering(make, cells, seed):
    model = make(cells=cells)
    here = solve(model)
    other, new = renumbered(model, np.random.default_rng(seed))
    there = solve(other)
    size = np.abs(here.last.displacement).max()
    np.testing.assert_allclose(there.last.displacement[new], here.last.displacement, rtol=0, atol=1e-9 * size)
    for contact, renamed in zip(here.last.contacts, there.last.contacts, strict=True):
        place = np.argsort(new[contact.node])
        assert renamed.node.tolist() == new[contact.node][place].tolist()
        for name in ("pressure", "traction"):
            np.testing.assert_allclose(
                getattr(renamed, name), getattr(contact, name)[place], rtol=0, atol=1e-9 * contact.pressure.max()
            )
        assert renamed.status.tolist() == contact.status[place].tolist()


def ball_on_block(length, modulus):
    """A rigid ball on a quarter of a block in space, under a force."""
    x = length * np.array([0, 0.3, 0.6, 0.9, 1.3, 2, 4])
    return Model(
        box(x=x, y=x, z=-x[::-1]),
        bodies=[Body("block", Elastic(E=1000.0 * modulus, nu=0.3))],
        supports=[
            Support("left", u=(0, None, None)),
            Support("front", u=(None, 0, None)),
            Support("bottom", u=(None, None, 0)),
        ],
        obstacles=[
            Rigid(
                "ball",
                Sphere((0, 0, 10 * length), 10 * length),
                u=(0, 0, None),
                force=(None, None, -30 * modulus * length**2),
            )
        ],
        contacts=[Contact("top", "ball", friction=0.3)],
        steps=[Step(increments=2)],
    )


@pytest.mark.parametrize("length", [2.0**-30, 2.0**-10, 2.0**20])
def test_units_in_space(length):
    """With powers of two every number is the same to the last digit: the certificate, and which pairs are left out."""
    modulus = 2.0**12
    here, there = (prepare(ball_on_block(*units)) for units in ((1.0, 1.0), (length, modulus)))
    np.testing.assert_array_equal(there.solver.active, here.solver.active)
    assert 0 < here.solver.active.sum() < len(here.interface)
    one, two = (solve_prepared(prepared).last for prepared in (here, there))
    np.testing.assert_array_equal(two.contacts[0].pressure, modulus * one.contacts[0].pressure)
    assert two.certificate == one.certificate


def test_pairs_that_touch_are_kept():
    """The ball closes what is kept, and nothing is solved twice: under its force as under what that moves it."""
    for factor in (0.01, 1.0, 100.0):
        model = ball_on_block(1.0, 1.0)
        ball = model.obstacles[0]
        force = replace(ball, force=(None, None, factor * ball.force[2]))
        pressed = prepare(replace(model, obstacles=[force]))
        found = solve_prepared(pressed).last
        closed = found.contacts[0].closed
        assert not closed[~pressed.solver.active].any()
        moved = replace(ball, u=(0, 0, found.obstacles["ball"].displacement[2]), force=None)
        driven = prepare(replace(model, obstacles=[moved]))
        assert not closed[~driven.solver.active].any()
