# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that share events, one after the other: both derivatives of what takes them apart, beside the whole program."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from tests.derivative.symmetric import random_squeezed, squeezed, squeezed_in_space

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
