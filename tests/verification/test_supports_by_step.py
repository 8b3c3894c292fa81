# SPDX-License-Identifier: BSD-3-Clause
"""Supports that steps release, hold again and restore: where it ends, work, friction, going on from a state."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.deck import read
from signorini.engine.examine import examine
from signorini.engine.solve import solve
from signorini.errors import InputError

LEFT, RIGHT = sg.Support("left", u=(0, 0)), sg.Support("right", u=(0, 0))
LOAD = sg.Load("top", force=(0.1, -1.0))


def block(*steps, supports=(LEFT, RIGHT), **given):
    mesh = sg.rectangle(width=2.0, height=1.0, nx=8, ny=4)
    body = sg.Body("block", sg.Elastic(E=100.0, nu=0.3))
    return sg.Model(mesh, bodies=[body], supports=supports, **({"loads": [LOAD]} | given), steps=steps)


def same(one, two):
    np.testing.assert_allclose(one.displacement, two.displacement, atol=1e-12)
    np.testing.assert_allclose(one.external, two.external, atol=1e-11)


@pytest.mark.parametrize("number", [1, 3])
def test_supports_come_and_go(number):
    """Elastic bodies end where the supports that are left put them; all of the work is stored."""
    one, both = (solve(block(sg.Step(), supports=held)).last for held in ((LEFT,), (LEFT, RIGHT)))
    history = solve(
        block(
            sg.Step(),
            sg.Step(release=["right"], scale={}, increments=number),
            sg.Step(restore=["right"], scale={}, increments=number),
            sg.Step(release=["right"], scale={}),
            sg.Step(hold=["right"], scale={"top": 0.0}, increments=number),
        )
    )
    pressed, let_go, restored, again, held = history.steps
    same(pressed, both)
    same(let_go, one)
    same(restored, both)
    same(again, one)
    right = held.displacement[history.model.mesh.nodes_of("right")]
    np.testing.assert_allclose(right, one.displacement[history.model.mesh.nodes_of("right")], atol=1e-14)
    assert abs(let_go.reactions["right"]).max() == 0.0
    # without loads the block is bent by the support alone: superposition
    np.testing.assert_allclose(held.reactions["right"], -both.reactions["right"], atol=1e-10)
    for step in history.steps:
        assert abs(step.energy_defect) < 1e-12
        assert step.certificate.passed
    assert sum(step.work for step in history.steps) == pytest.approx(held.strain_energy)


def test_a_support_of_a_later_step():
    """It is off from the beginning, and moves when it comes: from where the nodes are to what it prescribes."""
    push = sg.Support("right", u=(0.05, 0.0), name="push")
    history = solve(
        block(
            sg.Step(release=["push"], scale={"top": 1.0}),
            sg.Step(restore=["push"], scale={"push": 1.0}, at=[0.5]),
            supports=(LEFT, push),
        )
    )
    same(history.last, solve(block(sg.Step(), supports=(LEFT, push))).last)
    own = history.model.mesh.nodes_of("right")
    middle = 0.5 * (history.steps[0].displacement[own] + (0.05, 0.0))
    np.testing.assert_allclose(history.last.instants[0].displacement[own], middle, atol=1e-14)


def test_one_support_takes_over_from_another():
    first = sg.Support("right", u=(0.05, 0.0), name="first")
    second = sg.Support("right", u=(0.0, 0.02), name="second")
    model = block(
        sg.Step(release=["second"], scale={"first": 1.0}),
        sg.Step(release=["first"], hold=["second"], scale={"second": 1.0}),
        sg.Step(release=["first"], restore=["second"], scale={}),
        supports=(LEFT, first, second),
        loads=(),
    )
    with pytest.raises(InputError, match="expected one support to move a node in a direction"):
        examine(replace(model, steps=[sg.Step()]))
    one, two, three = solve(model).steps
    own = model.mesh.nodes_of("right")
    np.testing.assert_allclose(one.displacement[own], np.tile((0.05, 0.0), (len(own), 1)))
    np.testing.assert_allclose(two.displacement[own], np.tile((0.05, 0.02), (len(own), 1)))
    np.testing.assert_allclose(three.displacement[own], np.tile((0.0, 0.02), (len(own), 1)), atol=1e-15)


@pytest.mark.parametrize("path", ["exact", "increments"])
def test_a_block_that_is_let_go_springs_back_until_friction_holds_it(path):
    """Sheared on a rough floor by a support that then lets go; the force on the floor is what is left of it."""
    floor = sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=0.2)
    drag = sg.Support("top", u=(0.02, None), name="drag")
    press = sg.Load("top", force=(None, -1.0), name="press")
    number = None if path == "exact" else 40
    stay = {"press": 1.0, "drag": 1.0}
    steps = [
        sg.Step(scale={"press": 1.0}, path=path, increments=number),
        sg.Step(scale={"drag": 1.0}, path=path, increments=number),
        sg.Step(release=["drag"], scale=stay, path=path, increments=number),
    ]
    model = block(*steps, supports=[drag], loads=[press], contacts=[floor])
    history = solve(model)
    dragged, left = history.steps[1:]
    assert dragged.reactions["drag"][0] == pytest.approx(0.2, rel=1e-6)
    np.testing.assert_allclose(left.contacts[0].tangential_force, [0.0, 0.0], atol=1e-9)
    assert left.dissipation > 0.0
    assert left.work < 0.0
    for step in history.steps:
        assert step.certificate.passed
        assert abs(step.energy_defect) < (1e-12 if path == "exact" else 1e-4)
    # and from a state in between
    before = sg.solve(replace(model, steps=steps[:2]))
    rest = sg.solve(replace(model, steps=steps[2:]), start=before)
    np.testing.assert_allclose(rest.last.displacement, left.displacement, atol=1e-12)
    after = sg.solve(replace(model, steps=[sg.Step(scale=stay, path=path, increments=number)]), start=rest)
    np.testing.assert_allclose(after.last.displacement, left.displacement, atol=1e-12)


def test_equations_hand_on_what_is_released():
    """The right edge follows one node that a support moves and lets go."""
    hook = sg.Support((2.0, 1.0), u=(0.05, 0.0), name="hook")
    equations = [sg.Equation([("right", axis, 1.0), ((2.0, 0.5), axis, -1.0)]) for axis in "xy"]
    model = block(sg.Step(), sg.Step(release=["hook"], scale={}), supports=(LEFT, hook), equations=equations)
    moved, free = solve(model).steps
    own = model.mesh.nodes_of("right")
    np.testing.assert_allclose(moved.displacement[own], np.tile((0.05, 0.0), (len(own), 1)))
    rigid = [replace(LOAD), sg.Load("right", force=(0.0, 0.0), spread="displacement", name="together")]
    alone = solve(block(sg.Step(), supports=(LEFT,), loads=rigid)).last
    np.testing.assert_allclose(free.displacement, alone.displacement, atol=1e-12)
    assert abs(free.energy_defect) < 1e-12


def test_prepared_models_change_values_under_every_set_of_supports():
    push = sg.Support("right", u=(0.05, 0.0), name="push")
    model = block(sg.Step(release=["push"], scale={"top": 1.0}), sg.Step(restore=["push"]), supports=(LEFT, push))
    twice = sg.prepare(model).solve(loads={"push": 2.0})
    own = model.mesh.nodes_of("right")
    np.testing.assert_allclose(twice.last.displacement[own], np.tile((0.1, 0.0), (len(own), 1)))


def test_mistakes_are_named(tmp_path):
    with pytest.raises(InputError, match=r"step\[0\].release: unknown support 'rihgt'; did you mean 'right'"):
        block(sg.Step(release=["rihgt"]))
    with pytest.raises(InputError, match="'right' is named twice"):
        sg.Step(release=["right"], hold=["right"])
    with pytest.raises(InputError, match=r"step\[1\].release: without left, right, body 'block' can move along x"):
        examine(block(sg.Step(), sg.Step(release=["left", "right"])))
    deck = """mesh = { generator = "rectangle", width = 2.0, height = 1.0, nx = 2, ny = 2 }
[material.soft]
E = 100.0
nu = 0.3
[[body]]
name = "block"
material = "soft"
[[support]]
on = "left"
u = [0, 0]
[[support]]
on = "right"
u = [0.1, 0]
[[step]]
[[step]]
release = ["right"]
"""
    (tmp_path / "deck.toml").write_text(deck)
    assert read(tmp_path / "deck.toml").steps[1].release == ("right",)
