# SPDX-License-Identifier: BSD-3-Clause
"""What friction remembers: unloading, reopening, accumulated slip, energy; against every combination of states."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.gallery.blocks import dragged_block, stacked_blocks
from signorini.gallery.cylinder import zhu_cylinder
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step
from tests.helpers.every_state import follow

FLOOR = Plane(point=(0.0, 0.0), normal=(0.0, 1.0))


def driven_block(steps, *, friction=0.3, nu=0.3, nx=3, u=(0.03, -0.02)):
    """A block 3 x 1.5 whose top is driven: "down" and "across" are scaled apart."""
    return Model(
        rectangle(width=3.0, height=1.5, nx=nx, ny=2),
        bodies=[Body("block", Elastic(E=100.0, nu=nu))],
        supports=[Support("top", u=(None, u[1]), name="down"), Support("top", u=(u[0], None), name="across")],
        contacts=[Contact("bottom", FLOOR, friction=friction, name="floor")],
        steps=steps,
    )


def pressed_block(steps, *, friction=0.4, gap="geometry"):
    """A block held on its left edge across, pressed and pulled by forces."""
    return Model(
        rectangle(width=3.0, height=1.0, nx=3, ny=2),
        bodies=[Body("block", Elastic(E=100.0, nu=0.3))],
        supports=[Support("left", u=(0.0, None))],
        loads=[Load("top", pressure=2.0, name="press"), Load("right", traction=(1.0, 0.3), name="pull")],
        contacts=[Contact("bottom", FLOOR, friction=friction, gap=gap)],
        steps=steps,
    )


def floating_block(steps, *, friction=0.5):
    """No support at all."""
    return Model(
        rectangle(width=2.0, height=1.0, nx=2, ny=2),
        bodies=[Body("block", Elastic(E=100.0, nu=0.3))],
        loads=[Load("top", pressure=1.0, name="press"), Load("left", traction=(0.6, 0.0), name="pull")],
        contacts=[Contact("bottom", FLOOR, friction=friction)],
        steps=steps,
    )


PRESS_DRAG_BACK_LIFT = [
    Step(name="press", scale={"down": 1.0}, increments=2),
    Step(name="drag", scale={"across": 1.0}, increments=3),
    Step(name="back", scale={"across": -0.5}, increments=3),
    Step(name="nearly lift", scale={"down": 0.2}, increments=2),
    Step(name="lift", scale={"down": -0.5}, increments=1),
    Step(name="press again", scale={"down": 0.7}, increments=2),
]
PRESS_PULL_RELEASE = [
    Step(name="press", scale={"press": 1.0}, increments=2),
    Step(name="pull", scale={"pull": 1.0}, increments=3),
    Step(name="let go", scale={"pull": 0.0}, increments=3),
    Step(name="half", scale={"press": 0.5}, increments=2),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    "model",
    [
        driven_block(PRESS_DRAG_BACK_LIFT),
        driven_block(PRESS_DRAG_BACK_LIFT, friction=0.0),
        pressed_block(PRESS_PULL_RELEASE),
        pressed_block(PRESS_PULL_RELEASE, friction=0.1, gap=0.002),
        floating_block(PRESS_PULL_RELEASE),
    ],
    ids=["driven", "driven, smooth", "pressed", "pressed over a gap", "held by contact alone"],
)
def test_every_combination_of_states_tried(model):
    history = solve(model)
    ends = follow(model)
    size = max(np.abs(end.normal).max() for end in ends)
    far = max(np.abs(end.displacement).max() for end in ends)
    for step, end in zip(history.steps, ends, strict=True):
        (contact,) = step.contacts
        np.testing.assert_allclose(contact.pressure * contact.area, end.normal, rtol=0, atol=1e-9 * size)
        np.testing.assert_allclose(contact.traction * contact.area, end.tangential, rtol=0, atol=1e-9 * size)
        np.testing.assert_allclose(contact.slip, end.slip, rtol=0, atol=1e-9 * far)
        np.testing.assert_allclose(step.displacement.ravel(), end.displacement, rtol=0, atol=1e-9 * far)


def test_a_released_block_keeps_tractions_that_only_history_explains():
    history = solve(dragged_block(friction=0.2))
    pressed, _, released = history.steps
    (before,), (after,) = pressed.contacts, released.contacts
    size = after.pressure.max()
    # the same loads, other tractions, in balance as the first
    assert np.abs(after.traction - before.traction).max() > 0.02 * size
    np.testing.assert_allclose(after.tangential_force, 0.0, atol=1e-10 * size)
    assert (np.abs(after.traction) <= 0.2 * after.pressure * (1 + 1e-12)).all()
    assert released.displacement[:, 0].mean() > pressed.displacement[:, 0].mean()


@pytest.mark.parametrize(
    "model",
    [
        replace(stacked_blocks(), steps=[Step(scale={"upper.top": 1.0}), Step(scale={"upper.top": 0.0})]),
        pressed_block([Step(), Step(scale={"press": 0.0, "pull": 0.0})], friction=0.0),
        zhu_cylinder(friction=0.0, steps=[Step(), Step(scale={"cut": 0.0})]),
    ],
    ids=["driven", "pressed", "cylinder"],
)
def test_frictionless_bodies_return_to_zero(model):
    loaded, unloaded = solve(model).steps
    size = np.abs(loaded.displacement).max()
    elastic = unloaded.displacement - unloaded.displacement.mean(axis=0)  # nothing holds an unloaded body down
    assert np.abs(elastic).max() < 1e-12 * size
    (contact,) = unloaded.contacts
    assert np.abs(contact.pressure).max() < 1e-12 * loaded.contacts[0].pressure.max()
    assert unloaded.strain_energy < 1e-20 * loaded.strain_energy
    assert unloaded.dissipation == 0.0


def test_a_pair_that_opens_forgets_where_it_stuck():
    """Pressed, lifted, carried aside, pressed again: no friction, and no slip while it was in the air."""
    steps = [
        Step(scale={"down": 1.0}),
        Step(scale={"down": -0.5}),
        Step(scale={"across": 1.0}),
        Step(scale={"down": 1.0}),
    ]
    history = solve(driven_block(steps, nu=0.0))
    first, lifted, _, again = (step.contacts[0] for step in history.steps)
    assert not lifted.closed.any()
    assert again.closed.all()
    np.testing.assert_allclose(again.pressure, first.pressure, rtol=1e-10)
    np.testing.assert_allclose(again.traction, 0.0, atol=1e-10 * again.pressure.max())
    np.testing.assert_allclose(again.slip, 0.0, atol=1e-13)
    np.testing.assert_allclose(history.last.displacement[again.node, 0], 0.03, rtol=1e-10)


def test_slip_accumulates():
    """Dragged far: the bottom follows the top by as much as it has moved, and comes back with hysteresis."""
    far = 10.0
    steps = [
        Step(scale={"down": 1.0}),
        Step(scale={"across": far}, increments=4),
        Step(scale={"across": 0.0}, increments=4),
    ]
    _, there, back = solve(driven_block(steps, nu=0.0)).steps
    for step, sign in ((there, -1.0), (back, 1.0)):
        (contact,) = step.contacts
        assert contact.count("slip") == len(contact.status)
        np.testing.assert_allclose(contact.traction, sign * 0.3 * contact.pressure, rtol=1e-9)
        moved = step.displacement[contact.node, 0]
        np.testing.assert_allclose(contact.slip, moved, rtol=1e-9)  # closed all the time, from rest
    # shear lag both ways: it never comes back to where it began
    assert (back.contacts[0].slip > 0).all()


def test_energy_goes_to_strain_and_friction():
    """Work = strain + dissipation in the limit; the end-of-increment law dissipates with an error of first order."""

    def lost(n):
        steps = [Step(scale={"down": 1.0}, increments=n), Step(scale={"across": 1.0}, increments=n)]
        history = solve(driven_block(steps, nx=12))
        work, dissipation = (sum(getattr(step, name) for step in history.steps) for name in ("work", "dissipation"))
        assert dissipation > 0.1 * work
        return abs(work - dissipation - history.last.strain_energy) / work

    errors = [lost(n) for n in (4, 16, 64)]
    assert np.log2(errors[0] / errors[-1]) / 4 > 0.9, errors
    assert errors[-1] < 2e-3


@pytest.mark.parametrize("model", [driven_block, pressed_block])
def test_one_increment_or_two_without_friction(model):
    def end(n):
        return solve(model([Step(increments=n)], friction=0.0)).last

    one, two = end(1), end(2)
    np.testing.assert_allclose(two.displacement, one.displacement, rtol=0, atol=1e-13)
    np.testing.assert_allclose(two.contacts[0].pressure, one.contacts[0].pressure, rtol=1e-11, atol=1e-11)


def test_reactions_balance_loads_and_contact():
    history = solve(pressed_block(PRESS_PULL_RELEASE))
    for step, (press, pull) in zip(history.steps, [(1, 0), (1, 1), (1, 0), (0.5, 0)], strict=True):
        applied = press * np.array([0.0, -6.0]) + pull * np.array([1.0, 0.3])
        (contact,) = step.contacts
        total = applied + contact.normal_force + contact.tangential_force + sum(step.reactions.values())
        np.testing.assert_allclose(total, 0.0, atol=1e-10)
