# SPDX-License-Identifier: BSD-3-Clause
"""Contact by multipliers and multigrid gives the answers of the condensed interface."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine import memory_check
from signorini.engine.way_costs import Condensing
from signorini.gallery.blocks import block_on_foundation, dragged_block, four_blocks, stacked_blocks
from signorini.meshing.solid import box
from signorini.model.mesh import join


def cubes(friction, *, floating, push=1e-4):
    """A cube on a larger block that its mesh does not match, pressed and pushed by its top or held by contact alone."""
    fine, coarse = np.linspace(0, 1, 5), np.linspace(-0.5, 1.5, 4)
    low, up = box(x=coarse, y=coarse, z=[-1, 0]), box(x=fine, y=fine, z=fine)
    supports = [sg.Support("low.bottom", u=(0, 0, 0))]
    if not floating:
        supports.append(sg.Support("up.top", u=(push, 5e-5, -5e-4)))
    return sg.Model(
        join({"low": low, "up": up}),
        bodies=[sg.Body(name, sg.Elastic(E=2e5, nu=0.3)) for name in ("low", "up")],
        supports=supports,
        loads=[sg.Load("up.top", traction=(5.0, 2.0, -50.0))] if floating else [],
        contacts=[sg.Contact("up.bottom", "low.top", friction=friction)],
        steps=[sg.Step(increments=1)],
    )


def under_something_rigid(*, obstacle):
    """A block under a free obstacle, or a body that is wholly rigid: unknowns without any stiffness of their own."""
    mesh = sg.rectangle(x=np.linspace(0, 3, 7).tolist(), y=[-1, -0.5, 0])
    model = sg.Model(
        mesh if obstacle else join({"block": mesh, "up": sg.rectangle(x=[0.6, 1.4, 2.4], y=[0, 1])}),
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in (["block"] if obstacle else ["block", "up"])],
        supports=[sg.Support("bottom" if obstacle else "block.bottom", u=(0, 0))],
        rigid_bodies=[] if obstacle else [sg.RigidBody("rigid", "up", (1.5, 1.0))],
        loads=[] if obstacle else [sg.Load("rigid", force=(0.5, -5.0, 0.0))],
        contacts=[] if obstacle else [sg.Contact("up.bottom", "block.top", friction=0.3)],
        steps=[sg.Step(increments=1)],
    )
    if not obstacle:
        return model
    ball = sg.Rigid("ball", sg.Circle((1.5, 3.0), 3.0), u=(None, None), rotation=None, force=(0.5, -5.0), moment=0.0)
    return replace(model, obstacles=[ball], contacts=[sg.Contact("top", "ball", friction=0.3)])


MODELS = {
    "plane, a free obstacle": under_something_rigid(obstacle=True),
    "plane, a body wholly rigid": under_something_rigid(obstacle=False),
    "space, frictionless": cubes(0.0, floating=False),
    "space, friction": cubes(0.3, floating=False),
    "space, everything slips": cubes(0.3, floating=False, push=5e-3),
    "space, held by contact alone": cubes(0.3, floating=True),
    "space, stick": cubes("stick", floating=True),
    "plane, four contacts": four_blocks(),
    "plane, meshes that do not match": stacked_blocks(friction=0.3, across=(4, 6)),
    "plane, load beside the contact": block_on_foundation(friction=0.3, across=(3, 5)),
    "plane, a history": dragged_block(),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_same_answers(name):
    model = MODELS[name]
    model = replace(model, steps=[replace(step, increments=step.increments or 1) for step in model.steps])
    one, two = sg.solve(model), sg.solve(model, backend="iterative")
    assert (one.backend, two.backend) == ("multifrontal", "iterative")
    for a, b in zip(one.steps, two.steps, strict=True):
        assert b.certificate.passed
        np.testing.assert_allclose(b.displacement, a.displacement, atol=1e-7 * np.abs(a.displacement).max())
        for here, there in zip(a.contacts, b.contacts, strict=True):
            size = np.abs(here.pressure).max()
            np.testing.assert_allclose(there.pressure, here.pressure, atol=1e-7 * size)
            np.testing.assert_allclose(there.traction, here.traction, atol=1e-7 * size)
            np.testing.assert_array_equal(there.status, here.status)


def test_what_does_not_fit_is_iterated(monkeypatch):
    """And what fits in no way is refused before anything large is made, with what it takes."""
    model = cubes(0.3, floating=False)
    assert sg.solve(model).backend == "multifrontal"
    monkeypatch.setattr(memory_check, "condensing", lambda *_, **__: Condensing(2e9, 0.0, 0))
    monkeypatch.setattr(memory_check, "available_memory", lambda: 1_000_000_000)
    assert sg.solve(model).backend == "iterative"
    with pytest.raises(sg.InputError, match=r"take about 2 GB to factorise .* and 1 GB .* back end 'iterative', a coa"):
        sg.solve(model, backend="superlu")
    rooms = iter(2 * [2_000_000, 100_000])  # before the stiffness is made, and behind it
    monkeypatch.setattr(memory_check, "available_memory", lambda: next(rooms))
    for backend in ("auto", "iterative"):
        with pytest.raises(
            sg.InputError, match=r"GB to iterate on, and 0.0001 GB of memory are free; expected a coarser"
        ):
            sg.solve(model, backend=backend)
    monkeypatch.setattr(memory_check, "available_memory", lambda: 1_000)
    with pytest.raises(sg.InputError, match=r"a solve of \d+ unknowns takes at least"):
        sg.solve(model)


def test_bodies_that_yield_are_counted_with_their_tangents(monkeypatch):
    """Factors of the elastic bodies and of a tangent stand beside each other: what just fits once is iterated."""
    model = cubes(0.3, floating=False)
    soft = [replace(body, material=replace(body.material, plastic=sg.Plastic(100.0))) for body in model.bodies]
    yielding = replace(model, bodies=[replace(body, formulation="mean dilatation") for body in soft])
    monkeypatch.setattr(memory_check, "condensing", lambda *_, **__: Condensing(0.7e9, 0.0, 0))
    monkeypatch.setattr(memory_check, "available_memory", lambda: 1_000_000_000)
    assert sg.solve(model).backend == "multifrontal"
    assert sg.solve(yielding).backend == "iterative"


def test_bodies_without_contact_are_iterated_too():
    block = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2)
    model = sg.Model(
        block,
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0, 0))],
        loads=[sg.Load("top", pressure=1.0)],
    )
    one, other = (sg.solve(model, backend=way).last.displacement for way in ("auto", "iterative"))
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-8 * np.abs(one).max())


@pytest.mark.slow
def test_gross_sliding_is_proved_where_contact_is_iterated_in_space():
    """No condensed interface is asked why: a block pushed beyond its friction is no wrong input; 50 of 80 are held."""
    x = np.linspace(0.0, 2.0, 3)
    model = sg.Model(
        box(x=x, y=x, z=np.linspace(0.0, 1.0, 2)),
        bodies=[sg.Body("block", sg.Elastic(E=1e5, nu=0.3))],
        loads=[
            sg.Load("top", force=(0.0, 0.0, -100.0), name="press"),
            sg.Load("top", force=(80.0, 0.0, 0.0), name="push"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), friction=0.5)],
        steps=[sg.Step(scale={"press": 1.0, "push": 0.0}), sg.Step(scale={"press": 1.0, "push": 1.0}, increments=2)],
    )
    with pytest.raises(sg.SolveFailed, match=r"no equilibrium beyond 62\.5%") as caught:
        sg.solve(model, backend="iterative")
    assert caught.value.status == "no_equilibrium"


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_bodies_that_friction_before_the_load_does_not_hold(friction):
    """Pressed with a twentieth first: friction of the load before holds as much of a push that needs nearly all."""
    upper, lower = sg.rectangle(width=1.0, height=1.0, nx=4, ny=2), sg.rectangle(x=[-0.5, 0.4, 1.5], y=[-1.0, 0.0])
    model = sg.Model(
        join({"upper": upper, "lower": lower}),
        kind="plane stress",
        bodies=[sg.Body(name, sg.Elastic(E=200.0, nu=0.3)) for name in ("upper", "lower")],
        supports=[sg.Support("lower.bottom", u=(0.0, 0.0))],
        loads=[
            sg.Load("upper.top", force=(0.0, -2.0), name="press"),
            sg.Load("upper.bottom", force=(0.97 * 2.0 * friction, 0.0), name="push"),
        ],
        contacts=[sg.Contact("upper.bottom", "lower.top", friction=friction)],
        steps=[sg.Step(scale={"press": p, "push": q}, increments=1) for p, q in ((0.05, 0.0), (1.0, 1.0))],
    )
    one, two = sg.solve(model), sg.solve(model, backend="iterative")
    np.testing.assert_allclose(two.last.displacement, one.last.displacement, atol=1e-7)
