# SPDX-License-Identifier: BSD-3-Clause
"""Motions of nodes with a derivative to each side, beside differences of the whole program to each side."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import signorini as sg
from tests.derivative.rig import ball_rig, rig

PRESS = [sg.Step(scale={"down": 1.0, "heat": 0.5, "pull": 0.5}, path="exact")]
PEAK, STEP = sg.pressure("joint").peak, 2e-6


def flush():
    """Two straight sides that end where the other does, of facets that do not match."""
    pad = sg.rectangle(nx=6, ny=2, width=2.0, origin=(-1.0, 1.0))
    block = sg.rectangle(nx=7, ny=2, width=2.0, origin=(-1.0, 0.0))
    return replace(rig(steps=PRESS), mesh=sg.join({"pad": pad, "block": block}))


def one_sided(model, motion, middle):
    """Differences of second order of the whole program, to both sides, of a peak that is known in the middle."""

    def peak(part):
        moved = replace(model.mesh, points=model.mesh.points + part * STEP * motion)
        return sg.solve(replace(model, mesh=moved), tape=True).derivative(PEAK).value

    return tuple(way * (4.0 * peak(0.5 * way) - 3.0 * middle - peak(way)) / STEP for way in (-1.0, 1.0))


@pytest.mark.slow
@pytest.mark.parametrize("make", [partial(rig, steps=PRESS), ball_rig])
def test_a_motion_that_bends_a_straight_side_opposite_a_curved_one_has_two_sides(make):
    """One that moves it along, or stretches it, has one: the pad bends on its own."""
    model = make()
    derivative, points = sg.solve(model, tape=True).derivative(PEAK), model.mesh.points
    motion = np.random.default_rng(5).standard_normal(points.shape)
    low, high = derivative.shape_sides(motion)
    assert (low, high) == pytest.approx(one_sided(model, motion, derivative.value), rel=1e-6)
    assert abs(high - low) > 0.002 * abs(low)
    with pytest.raises(sg.InputError, match=r"changes node \d+ of 'joint' otherwise forwards .* shape_sides\(motion\)"):
        derivative.shape(motion)
    with pytest.raises(sg.InputError, match=r"straight side .* do not add up"):
        assert derivative.nodes.any()
    kept = points @ np.random.default_rng(4).standard_normal((points.shape[1],) * 2)
    kept[: len(points) // 8] += 0.1 * motion[: len(points) // 8]
    below, above = one_sided(model, kept, derivative.value)
    assert derivative.shape(kept) == pytest.approx(0.5 * (below + above), rel=1e-6)
    assert derivative.shape(np.ones_like(points)) == pytest.approx(0.0, abs=1e-6 * derivative.value)


def test_a_motion_along_sides_that_end_flush_has_two_sides():
    """To either side it leaves another end without anything opposite."""
    model = flush()
    derivative, along = sg.solve(model, tape=True).derivative(PEAK), np.zeros_like(model.mesh.points)
    along[model.mesh.nodes_of("block.bottom").min() :, 0] = 1.0
    low, high = derivative.shape_sides(along)
    assert (low, high) == pytest.approx(one_sided(model, along, derivative.value), rel=1e-6)
    assert low < 0.0 < high
    with pytest.raises(sg.InputError, match="moves flush ends: the derivative has two sides"):
        derivative.shape(along)


def on_blocks(model):
    """A rig with a pad that is flat, all along a block, and held along its top in every direction."""
    flat = model.mesh.points[model.mesh.nodes_of("block.top"), -1][0]
    points = model.mesh.points.copy()
    points[model.mesh.nodes_of("pad.bottom"), -1] = flat
    (down, *others) = model.supports
    held = replace(down, u=(*(0.0,) * (model.dimension - 1), down.u[-1]))
    return replace(model, mesh=replace(model.mesh, points=points), supports=[held, *others])


def on_polygon():
    """The same in space, with a polygon in place of the cone and an exact path."""
    model = on_blocks(ball_rig())
    step = sg.Step(scale={"down": 1.0, "pull": 0.5}, path="exact")
    return replace(model, contacts=[replace(model.contacts[0], facets=8)], steps=[step])


@pytest.mark.slow
@pytest.mark.parametrize(
    "make", [lambda: on_blocks(rig()), lambda: on_blocks(rig(kind="axisymmetric", friction=0.1)), on_polygon]
)
def test_sides_that_touch_all_along_before_anything_is_loaded_have_two_derivatives(make):
    """They press at once where they are bent one way, and close one pair after another where the other way."""
    model = make()
    solution, bent = sg.solve(model, tape=True), np.zeros_like(model.mesh.points)
    derivative, own = solution.derivative(PEAK), model.mesh.nodes_of("pad.bottom")
    x = model.mesh.points[own, 0] - model.mesh.points[own, 0].mean()
    bent[own, -1] = np.sin(1.3 * x) + 0.5 * x**2
    low, high = derivative.shape_sides(bent)
    assert (low, high) == pytest.approx(one_sided(model, bent, derivative.value), rel=1e-6)
    assert abs(high - low) > 0.002 * abs(low)
    with pytest.raises(sg.InputError, match=r"touches without a force where the history begins: .* two sides, "):
        derivative.shape(bent)
    with pytest.raises(sg.InputError, match="derivatives node by node have two sides"):
        assert derivative.gap["joint"].any()
    with pytest.raises(sg.InputError, match=r"by 'interference.joint' has two sides there, .*; sides\("):
        derivative.by("interference.joint")
    below, above = derivative.sides("interference.joint")

    def peak(overlap):
        other = replace(model, contacts=[replace(model.contacts[0], interference=overlap)])
        return sg.solve(other, tape=True).derivative(PEAK).value

    differences = [(peak(step) - derivative.value) / step for step in (-1e-4, 1e-4)]
    assert (below, above) == pytest.approx(differences, rel=1e-6)
    assert 0.0 in (derivative.holds("interference.joint").low, derivative.holds("interference.joint").high)
    tangents = solution.tangent_sides(interference="joint")
    assert [tangent.of(PEAK) for tangent in tangents] == pytest.approx((below, above), rel=1e-9)
    with pytest.raises(sg.InputError, match=r"what 'interference.joint' changes has two sides there; tangent_sides\("):
        solution.tangent(interference="joint")
    ones = np.ones(len(own))
    assert derivative.profile_sides("joint", ones) == pytest.approx((-above, -below), rel=1e-12)


def test_touching_before_anything_is_loaded_has_one_derivative_where_nothing_remembers_it():
    """Without friction; and where a load carries a pad on one node to the block, wherever that is."""
    smooth = on_blocks(rig(friction=0.0))
    derivative = sg.solve(smooth, tape=True).derivative(PEAK)
    below, above = derivative.sides("interference.joint")
    assert below == above == derivative.by("interference.joint")

    pad = sg.rectangle(nx=6, ny=2, width=2.0, origin=(-1.0, 1.0))
    x, y = pad.points.T
    pad = replace(pad, points=np.column_stack([x, y + 0.02 * x**2 * (2.0 - y)]))
    block = sg.rectangle(nx=6, ny=2, width=2.0, origin=(-1.0, 0.0))
    carried = replace(
        rig(),
        mesh=sg.join({"pad": pad, "block": block}),
        supports=[sg.Support("block.bottom", u=(0.0, 0.0))],
        loads=[
            sg.Load("pad.top", pressure=20.0, name="weight"),
            sg.Load("pad.left", traction=(6.0, 0.0), name="pull"),
        ],
        contacts=[sg.Contact("pad.bottom", "block.top", friction=0.35, name="joint", coupling="nodes")],
        steps=[sg.Step(scale={"weight": 1.0}, path="exact"), sg.Step(scale={"pull": 0.3}, path="exact")],
    )
    derivative = sg.solve(carried, tape=True).derivative(sg.traction("joint")[3])
    assert derivative.sides("interference.joint") == pytest.approx((0.0, 0.0), abs=1e-9 * abs(derivative.value))
    with pytest.raises(
        sg.InputError, match=r"closes with another at load factor .*: derivatives node by node may have"
    ):
        assert derivative.gap["joint"].any()
    with pytest.raises(sg.InputError, match="closes with another at load"):
        assert derivative.nodes.any()


def test_a_pad_that_slides_freely_along_the_side_that_it_touches_is_refused():
    """Bent the smallest bit the block would have it slide until it touches elsewhere: that is a jump."""
    model = on_blocks(rig(steps=PRESS))
    model = replace(model, supports=[replace(model.supports[0], u=(None, -0.02)), *model.supports[1:]])
    derivative, bent = sg.solve(model, tape=True).derivative(PEAK), np.zeros_like(model.mesh.points)
    top = model.mesh.nodes_of("block.top")
    x = model.mesh.points[top, 0]
    bent[top, 1] = np.sin(1.3 * x) + 0.5 * x**2
    with pytest.raises(sg.InputError, match=r"what the history does is not known where their gaps are other ones"):
        derivative.shape(bent)
