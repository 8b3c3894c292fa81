# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that share events, one after the other: both derivatives of what takes them apart, beside the whole program."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from benchmarks import random_cones
from benchmarks.symmetric_cones import limits
from tests.derivative.symmetric import flat_on_cones, random_squeezed, squeezed, squeezed_in_space, turning_alike

PEAK, WORK = sg.pressure("joint").peak, sg.dissipation()


def beside(solution, low, high, outputs, sides, step):
    """How many of some outputs have two derivatives; each is put beside differences with the models low and high."""
    two = 0
    for output in outputs:
        derivative = solution.derivative(output)
        below, above = (part.derivative(output).value - derivative.value for part in (low, high))
        found, wanted = sides(derivative), (-below / step, above / step)
        assert found == pytest.approx(wanted, rel=1e-5, abs=1e-4 * max(1.0, abs(wanted[0])))
        two += abs(found[0] - found[1]) > 1e-3 * max(map(abs, found))
    return two


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_what_breaks_a_symmetry_has_the_derivatives_of_differences(seed):
    solution, step = sg.solve(random_squeezed(seed), tape=True), 1e-6
    low, high = (sg.solve(random_squeezed(seed, 1.0 + part), tape=True) for part in (-step, step))
    nodes = solution.steps[-1].contacts[0].node[:2]
    outputs = (PEAK, sg.force("joint", along=(1, 0)), WORK, *(sg.traction("joint")[node] for node in nodes))
    beside(solution, low, high, outputs, lambda derivative: derivative.sides("load.one"), step)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2, 8, 45, 46])
def test_motions_of_single_nodes_have_both_derivatives_through_every_event_that_pairs_share(seed):
    """Also from a side that touches all along, where pairs have slipped before friction takes work from that."""
    model, step = random_squeezed(seed), 1e-8
    motion = np.random.default_rng(seed).uniform(-1.0, 1.0, model.mesh.points.shape)
    motion[model.mesh.points[:, 1] > 0.99] = 0.0
    solution, low, high = (
        sg.solve(replace(model, mesh=replace(model.mesh, points=model.mesh.points + part * motion)), tape=True)
        for part in (0.0, -step, step)
    )
    node = int(solution.steps[-1].contacts[0].node[0])
    outputs = (PEAK, sg.force("joint", along=(1, 0)), WORK, sg.traction("joint")[node])
    assert beside(solution, low, high, outputs, lambda derivative: derivative.shape_sides(motion), step)
    with pytest.raises(sg.InputError, match=r"has two sides, .*; shape_sides"):
        solution.derivative(WORK).shape(motion)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 5])
def test_on_polygons_too(seed):
    solution, step = sg.solve(squeezed_in_space(seed), tape=True), 1e-6
    low, high = (sg.solve(squeezed_in_space(seed, 1.0 + part), tape=True) for part in (-step, step))
    history = solution._taped
    assert len(history.edges(history.change("load", "one"))) > 4
    node = int(solution.steps[-1].contacts[0].node[0])
    outputs = (PEAK, sg.force("joint", along=(1, 0, 0)), WORK, sg.traction("joint")[node, 0])
    beside(solution, low, high, outputs, lambda derivative: derivative.sides("load.one"), step)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 5, 9, 35])
def test_on_smooth_cones_too(seed):
    """The first of the events ends an increment, the next one goes over the others; others tell lengths by turning."""
    solution = sg.solve(squeezed_in_space(seed, facets=0), tape=True)
    assert any(point.at_event and point.shared for point in solution._taped.view.points)
    node = int(solution.steps[-1].contacts[0].node[0])
    outputs = (PEAK, sg.force("joint", along=(0, 1, 0)), WORK, sg.traction("joint")[node, 0])
    wanted, two = limits(outputs, lambda one: squeezed_in_space(seed, one, facets=0), 1e-6), 0
    for output, sides in zip(outputs, wanted, strict=True):
        found = solution.derivative(output).sides("load.one")
        assert found == pytest.approx(sides, rel=1e-5, abs=1e-5)
        two += abs(found[0] - found[1]) > 1e-3 * max(map(abs, found))
    assert two > 1


@pytest.mark.slow
def test_a_history_that_goes_back_to_where_it_was_has_one_derivative():
    """Pairs come to their events at one load, whatever is varied; only rounding tells them apart."""
    solution = sg.solve(squeezed_in_space(54, facets=0), tape=True)
    assert any(point.at_event and len(point.shared) > 2 for point in solution._taped.view.points)
    outputs = (WORK, sg.force("joint", along=(0, 1, 0)))
    wanted = limits(outputs, lambda one: squeezed_in_space(54, one, facets=0), 1e-6)
    for output, sides in zip(outputs, wanted, strict=True):
        below, above = solution.derivative(output).sides("load.one")
        assert below == above == pytest.approx(sides.mean(), rel=1e-6)


@pytest.fixture(scope="module")
def alike():
    """A block on smooth cones of which two pairs turn alike, farther than all others."""
    solution = sg.solve(turning_alike(), tape=True)
    points = solution._taped.view.points
    assert any(point.tied for point in points)
    assert not any(point.at_event and point.shared for point in points)
    return solution


def test_what_makes_one_of_two_pairs_turn_farther_has_two_sides(alike):
    derivative = alike.derivative(PEAK)
    with pytest.raises(sg.InputError, match=r"turns as far as another before load factor .* two sides there"):
        derivative.by("load.one")
    with pytest.raises(sg.InputError, match=r"turns as far as another .*: derivatives node by node may have two sides"):
        _ = derivative.gap["joint"]
    low, high = derivative.sides("load.one")
    assert (low, high) == pytest.approx(*limits([PEAK], turning_alike, 1e-6), rel=1e-5)
    assert abs(high - low) > 1e-4 * abs(high)
    assert 0.0 in (derivative.holds("load.one").low, derivative.holds("load.one").high)


def test_what_keeps_the_symmetry_lets_pairs_turn_alike(alike):
    derivative = alike.derivative(PEAK)
    low, high = derivative.sides("friction.joint")
    assert derivative.by("friction.joint") == low == high
    holds = derivative.holds("friction.joint")
    assert holds.low < 0.0 < holds.high


def test_another_pair_that_turns_farthest_ends_what_a_derivative_holds_for():
    model = random_cones.random_model(14)
    holds = sg.solve(model, tape=True).derivative(random_cones.OUTPUTS[0]).holds("load.pull")
    assert "turns farthest" in holds.ends[0]

    def farthest(part):
        points = sg.solve(random_cones.changed(model, "load.pull", part * holds.low), tape=True)._taped.view.points
        return [trial.pair for point in points if point.quiet for trial in point.quiet.trials]

    assert farthest(0.9) == farthest(0.0) != farthest(1.1)


def test_answers_that_jump_with_the_length_of_increments_are_refused():
    """Behind an event that pairs share an increment may be long; behind one of several, it goes over the others."""
    derivative = sg.solve(squeezed_in_space(0, facets=0), tape=True).derivative(PEAK)
    with pytest.raises(sg.InputError, match=r"another length .*, with which answers jump a little"):
        derivative.sides("load.one")
    assert derivative.by("friction.joint") == pytest.approx(derivative.sides("friction.joint")[0])


@pytest.mark.slow
def test_a_history_on_smooth_cones_may_end_where_pairs_come_to_their_events_together():
    """To one side both have slipped before the end, to the other one or none; the loads hold that tells."""
    points = sg.solve(squeezed_in_space(4, facets=0), tape=True)._taped.view.points
    part, leg = next((point.part, point.leg) for point in points if point.leg and len(point.acting) > 1)
    assert leg == 1

    def ended(one):
        model = squeezed_in_space(4, facets=0)
        pressed, squeezed_so, *_ = model.steps
        scale = {"one": one * part * squeezed_so.scale["one"], "other": part * squeezed_so.scale["other"]}
        return replace(model, steps=[pressed, replace(squeezed_so, scale=scale)])

    solution = sg.solve(ended(1.0), tape=True)
    outputs = (PEAK, sg.force("joint", along=(0, 1, 0)), WORK)
    for output, sides in zip(outputs, limits(outputs, ended, 1e-6), strict=True):
        assert solution.derivative(output).sides("load.one") == pytest.approx(sides, rel=1e-5, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 3])
def test_touching_all_along_on_smooth_cones(seed):
    """What overlaps presses at once, with friction that turns later; what is apart closes in the first increment."""
    solution = sg.solve(flat_on_cones(seed), tape=True)
    outputs = (sg.force("joint", along=(1, 0, 0)), PEAK, WORK)
    tangents = solution.tangent_sides(interference="joint")
    for output, wanted in zip(outputs, limits(outputs, lambda q: flat_on_cones(seed, q), 3e-7, here=0.0), strict=True):
        derivative = solution.derivative(output)
        sides = derivative.sides("interference.joint")
        assert sides == pytest.approx(wanted, rel=5e-6)
        assert [tangent.of(output) for tangent in tangents] == pytest.approx(sides, rel=1e-9)
        with pytest.raises(sg.InputError, match=r"touches without a force .* by 'interference.joint' has two sides"):
            derivative.by("interference.joint")
        assert derivative.by("friction.joint") == derivative.sides("friction.joint")[0]


@pytest.mark.slow
def test_what_tilts_a_side_that_touches_all_along_on_smooth_cones():
    """To either side pairs press in one half at once, and those of the other half close."""
    model, solution = flat_on_cones(1), sg.solve(flat_on_cones(1), tape=True)
    x, y, z = model.mesh.points.T
    motion = np.column_stack([0.0 * x, 0.0 * x, np.where(z > 0.5, 0.0, (x - 0.4) + 0.5 * (y - 0.7))])

    def tilted(part):
        return replace(model, mesh=replace(model.mesh, points=model.mesh.points + part * motion))

    outputs = (sg.force("joint", along=(1, 0, 0)), sg.force("joint", along=(0, 0, 1)), WORK)
    for output, wanted in zip(outputs, limits(outputs, tilted, 1e-7, here=0.0), strict=True):
        low, high = solution.derivative(output).shape_sides(motion)
        assert (low, high) == pytest.approx(wanted, rel=1e-5)
        assert abs(low - high) > 1e-4 * abs(low)


@pytest.mark.parametrize("friction", [0.3, 0.0])
def test_pairs_that_touch_together_at_the_end_of_an_increment(friction):
    """Of two that a change presses, or one of them, each is where the other one lets it be."""

    def pressed(down):
        model = turning_alike()
        contacts, step = [replace(model.contacts[0], friction=friction)], sg.Step(scale={"down": down}, increments=1)
        return replace(model, loads=[], contacts=contacts, steps=[step])

    def apart(down):
        point = sg.solve(pressed(down), tape=True)._taped.view.points[-1]
        return (point.h[0] - point.r[0]).max()  # that of two corners

    low, high = 0.3, 0.31
    before, here = apart(low), apart(high)
    for _ in range(8):
        low, high, before = high, high - here * (high - low) / (here - before), here
        here = apart(high)
        if abs(here) < 1e-15:
            break
    model, solution = pressed(high), sg.solve(pressed(high), tape=True)
    x, y, z = model.mesh.points.T
    motion = np.column_stack([0.0 * x, 0.0 * x, (0.7 - z) * (0.01 * x + 0.003 * y)])

    def tilted(part):
        return replace(model, mesh=replace(model.mesh, points=model.mesh.points + part * motion))

    forces = [sg.force("joint", along=along) for along in ((0, 1, 0), (0, 0, 1))]
    outputs = [*forces, sg.moment("joint", about=(0, 0, 0), axis=1)]
    wanted = limits(outputs, tilted, 1e-5, here=0.0)
    for output, sides in zip(outputs, wanted, strict=True):
        assert solution.derivative(output).shape_sides(motion) == pytest.approx(sides, rel=1e-6, abs=1e-6)
    assert np.abs(wanted[:, 0] - wanted[:, 1]).max() > 1e-3


@pytest.fixture(scope="module")
def slipping():
    """Part of the second step of `squeezed` at which the first two pairs slip."""
    points = sg.solve(squeezed(), tape=True)._taped.view.points
    return next(point.part for point in points if point.at_event and point.leg)


@pytest.mark.parametrize(
    "then", [{"down": 1.2}, {"one": -0.5, "other": -0.5}, {"one": 1.0, "other": 1.0}], ids=["press", "back", "on"]
)
def test_loads_that_turn_where_pairs_are_about_to_slip(slipping, then):
    """To one side they slip a little before, to the other side some do not or do so afterwards."""

    def turned(one):
        model = squeezed()
        scales = [{"one": slipping, "other": slipping}, then, {"one": 0.3, "other": 0.3}]
        steps = [scale | {"one": one * scale["one"]} if "one" in scale else scale for scale in scales]
        return sg.solve(
            replace(model, steps=[model.steps[0], *(sg.Step(scale=scale, path="exact") for scale in steps)]), tape=True
        )

    step = 1e-6
    solution, low, high = (turned(one) for one in (1.0, 1.0 - step, 1.0 + step))
    outputs = (PEAK, sg.force("joint", along=(1, 0)), WORK, sg.traction("joint")[0], sg.motion("joint")[1])
    two = beside(solution, low, high, outputs, lambda derivative: derivative.sides("load.one"), step)
    assert two == {"down": 4, "one": 1}[next(iter(then))]


def test_tangents_to_both_sides_are_those_of_outputs():
    model = random_squeezed(13)
    solution = sg.solve(model, tape=True)
    low, high = solution.derivative(WORK).sides("load.one")
    below, above = solution.tangent_sides(load="one")
    assert (below.of(WORK), above.of(WORK)) == pytest.approx((low, high), rel=1e-9)
    assert high - low > 1e-3
    with pytest.raises(sg.InputError, match=r"'load.one' changes has two sides there; tangent_sides\(load='one'\)"):
        solution.tangent(load="one")
