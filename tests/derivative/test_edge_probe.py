# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that share events: what takes them apart, asked of two ways back, as ways forwards have it."""

import re
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.derivative.edge_probe import EdgeProbe
from signorini.derivative.validity import edges
from signorini.model.outputs import WeightedSum


def squeezed(one=1.0):
    """A block that is pressed, and squeezed from both sides, from the left by ``one``: at 1 pairs slip in twos."""
    return sg.Model(
        sg.rectangle(nx=4, ny=2, width=2.0, origin=(-1.0, 0.0)),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, -0.01), name="down")],
        loads=[
            sg.Load("left", traction=(20.0, 0.0), name="one"),
            sg.Load("right", traction=(-20.0, 0.0), name="other"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.2, name="joint")],
        kind="plane strain",
        steps=[
            sg.Step(scale={"down": 1.0}, path="exact"),
            sg.Step(scale={"one": one, "other": 1.0}, path="exact"),
        ],
    )


@pytest.fixture(scope="module")
def solution():
    return sg.solve(squeezed(), tape=True)


@pytest.fixture(scope="module")
def symmetric(solution):
    return solution._taped


def differences(output, step=1e-6):
    """Of an output by the load from the left, downwards and upwards."""
    low, middle, high = (
        sg.solve(squeezed(1.0 + part), tape=True).derivative(output).value for part in (-step, 0.0, step)
    )
    return (middle - low) / step, (high - middle) / step


@pytest.mark.parametrize("parameter", ["friction.joint", "E.block", "support.down", "load.one", "load.other"])
def test_the_probe_finds_what_ways_forwards_find(symmetric, parameter):
    kind, _, name = parameter.partition(".")
    probe = EdgeProbe(symmetric.view.points)
    assert probe
    wanted = bool(edges(symmetric.view, symmetric.forward(symmetric.change(kind, name), 1.0)))
    assert wanted == (kind == "load")
    assert probe.takes_apart(symmetric.change(kind, name)) == wanted


def test_an_output_that_remembers_nothing_of_the_order_in_which_pairs_slip_has_one_derivative(solution):
    """Two pairs that slip together slip one after the other under loads that differ, and hold nothing of it."""
    traction = sg.traction("joint")[1]
    derivative = solution.derivative(traction)
    assert derivative.sides("load.one") == pytest.approx(differences(traction), rel=1e-6)
    assert derivative.by("load.one") == derivative.sides("load.one")[1]
    with pytest.raises(sg.InputError, match=r"slips with another at load factor .* may have two sides there"):
        solution.derivative(sg.dissipation()).by("load.one")  # friction takes work from each from where it slips
    with pytest.raises(sg.InputError, match="slips with another at load factor"):
        solution.tangent(load="one")


def test_a_largest_pressure_that_two_nodes_share_has_two_sides(solution):
    """Upwards it is that which grows most, downwards that which falls least; together they may have one."""
    peak = sg.pressure("joint").peak
    derivative = solution.derivative(peak)
    low, high = derivative.sides("load.one")
    assert (low, high) == pytest.approx(differences(peak), rel=1e-6)
    assert low < 0.0 < high
    with pytest.raises(sg.InputError, match=r"nodes 1 and 5 of 'joint' have the largest pressure alike: .* two sides"):
        derivative.by("load.one")
    assert derivative.by("friction.joint") == pytest.approx(solution.tangent(friction="joint").of(peak), rel=1e-9)
    minus = solution.derivative(WeightedSum(parts=((-2.0, peak),)))
    assert minus.sides("load.one") == pytest.approx((-2.0 * low, -2.0 * high), rel=1e-12)


def random_squeezed(seed, one=1.0):
    """The same by a seed: crowned or flat, squeezed or pulled, mostly back again; ``one`` breaks its symmetry."""
    random = np.random.default_rng(seed)
    mesh = sg.rectangle(nx=int(random.choice([4, 6, 8])), ny=2, width=2.0, origin=(-1.0, 0.0))
    x, y = mesh.points.T
    crowned = np.column_stack([x, y + random.choice([0.0, 0.003, 0.01]) * x**2 * (1.0 - y)])
    traction = random.choice([-1.0, 1.0]) * random.uniform(5.0, 40.0)
    model, again = squeezed(), random.uniform(-1.0, 0.9)
    scales = [(one, 1.0), (again * one, again)][: 1 + (random.random() < 0.7)]
    return replace(
        model,
        mesh=replace(mesh, points=crowned),
        loads=[
            sg.Load("left", traction=(traction, 0.0), name="one"),
            sg.Load("right", traction=(-traction, 0.0), name="other"),
        ],
        contacts=[replace(model.contacts[0], friction=random.uniform(0.1, 0.7))],
        steps=[
            model.steps[0],
            *(sg.Step(scale=dict(zip(("one", "other"), part, strict=True)), path="exact") for part in scales),
        ],
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_what_breaks_a_symmetry_has_the_derivatives_of_differences_or_is_refused_by_name(seed):
    solution, step, refused = sg.solve(random_squeezed(seed), tape=True), 1e-6, []
    low, high = (sg.solve(random_squeezed(seed, 1.0 + part), tape=True) for part in (-step, step))
    nodes = solution.steps[-1].contacts[0].node[:2]
    peak, force = sg.pressure("joint").peak, sg.force("joint", along=(1, 0))
    for output in (peak, force, sg.dissipation(), *(sg.traction("joint")[node] for node in nodes)):
        derivative = solution.derivative(output)
        below, above = (part.derivative(output).value - derivative.value for part in (low, high))
        try:
            sides = derivative.sides("load.one")
        except sg.InputError as error:
            refused.append(str(error))
            continue
        assert sides == pytest.approx((-below / step, above / step), rel=1e-5, abs=1e-5)
    assert len(refused) <= 3
    assert all(re.search("with another at load factor .* on the other side is not known", why) for why in refused)
