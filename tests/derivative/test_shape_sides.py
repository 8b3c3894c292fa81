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
