# SPDX-License-Identifier: BSD-3-Clause
"""The paper's cylinder with friction, condensed from its finite elements: convergence, energy, unloading."""

import functools

import numpy as np
import pytest

from signorini.friction.history import follow
from signorini.gallery.blocks import dragged_block
from signorini.gallery.cylinder import zhu_cylinder
from signorini.law.states import STICK
from tests.helpers.path_samples import increments, loads_at_breakpoints
from tests.helpers.prepared_paths import PreparedPath


@functools.cache
def cylinder(refine, friction=0.4):
    return PreparedPath(zhu_cylinder(refine=refine, friction=friction))


def run(path, *loads):
    segments = path.run(*({"cut": load} for load in loads))
    assert all(segment.followed for segment in segments)
    return segments


@pytest.mark.parametrize(("refine", "pressure"), [(1, 37.9050), (4, 38.0972), (6, 38.1227), (8, 38.1331)])
def test_pressure_in_the_middle(refine, pressure):
    path = cylinder(refine)
    (segment,) = run(path, 1.0)
    traction = path.traction(segment.end.r)
    assert traction[: path.pairs].max() == pytest.approx(pressure, abs=1e-4)
    assert segment.residual < 1e-13


def test_it_costs_little_more_than_a_state_an_event():
    path = cylinder(8)
    (segment,) = run(path, 1.0)
    closed = np.count_nonzero(segment.end.state)
    assert len({event.factor for event in segment.events}) <= closed + 2
    assert segment.pivots <= 3 * closed
    assert segment.factorisations == 1


def test_increments_converge_to_it():
    path = cylinder(2)
    (segment,) = run(path, 1.0)
    errors = []
    for number in (10, 80, 640):
        ends = [path.load({"cut": i / number}) for i in range(1, number + 1)]
        _, r = increments(path.problem, path.start(), ends)
        errors.append(np.abs(r - segment.end.r).max() / segment.end.r.max())
    assert errors[0] > 4 * errors[1] > 16 * errors[2]
    assert errors[2] < 1e-3


def test_increments_that_end_at_the_events_are_the_path_through_unloading():
    path = cylinder(4)
    loads = (1.0, 0.05, 1.0)
    segments = run(path, *loads)
    ends, before = [], 0.0
    for load, segment in zip(loads, segments, strict=True):
        ends += loads_at_breakpoints(segment, path.load({"cut": before}), path.load({"cut": load}))
        before = load
    h, r = increments(path.problem, path.start(), ends)
    scale = segments[0].end.r.max()
    np.testing.assert_allclose(segments[-1].end.r, r, rtol=0, atol=1e-10 * scale)
    np.testing.assert_allclose(segments[-1].end.h, h, rtol=0, atol=1e-10 * np.abs(h).max())


def test_without_friction_one_segment_is_one_increment():
    path = cylinder(4, friction=0.0)
    (segment,) = run(path, 1.0)
    _, r = increments(path.problem, path.start(), [path.load({"cut": 1.0})])
    np.testing.assert_allclose(segment.end.r, r, rtol=0, atol=1e-12 * r.max())


def test_energy_of_the_cylinder():
    path = cylinder(2)
    loads = [{"cut": 1.0}, {"cut": 0.05}, {"cut": 1.0}]
    work, strain, dissipation = path.energies(loads)
    assert dissipation > 1e-6 * work
    assert work == pytest.approx(strain + dissipation, rel=1e-10)


def test_energy_of_a_block_that_contact_alone_holds():
    path = PreparedPath(dragged_block(friction=0.3))
    press = {"press": 1.0, "push": 0.0}
    loads = [press, {"press": 1.0, "push": 1.0}, press, {"press": 1.0, "push": -1.0}]
    work, strain, dissipation = path.energies(loads)
    assert dissipation > 1e-4 * work
    assert work == pytest.approx(strain + dissipation, rel=1e-10)


def test_a_block_pushed_too_hard_slides():
    path = PreparedPath(dragged_block(friction=0.1))
    _, push = path.run({"press": 1.0, "push": 0.0}, {"press": 1.0, "push": 1.0})
    assert push.outcome == "jump"
    assert push.jump.gross_sliding
    assert push.jump.factor == pytest.approx(0.1 * 4.0 / (0.3 * 2.0), rel=1e-10)


@pytest.mark.parametrize("part", [0.03, 0.51, 0.999])
def test_a_segment_cut_short_is_the_one_to_a_smaller_load(part):
    """Unloading, where pairs turn their slip, open and stick."""
    path = cylinder(2)
    loaded = run(path, 1.0)[0].end
    way = [path.load({"cut": load}) for load in (1.0, 0.0)]
    whole = follow(path.problem, loaded, way[1])
    shorter = follow(path.problem, loaded, (1.0 - part) * way[0] + part * way[1])
    cut = whole.until(part)
    for name in ("b", "h", "r", "slip", "dissipation"):
        one, two = (getattr(segment.end, name) for segment in (cut, shorter))
        near = 1e-12 * np.abs(two).max()
        if name in ("r", "slip"):  # what is left of motions that cancel: of their rounding
            near += 1e-14 * np.abs(shorter.end.h).max()
        np.testing.assert_allclose(one, two, rtol=0, atol=near, err_msg=name)
    held = shorter.end.state == STICK
    np.testing.assert_array_equal(cut.end.state, shorter.end.state)
    np.testing.assert_allclose(cut.end.anchor[:, held], shorter.end.anchor[:, held], rtol=0, atol=1e-12)
    assert [event.pairs for event in cut.events] == [event.pairs for event in shorter.events]
    assert len(cut.events) <= len(whole.events)
    assert cut.events or part < 0.1
