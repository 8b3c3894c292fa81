# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that share events: what takes them apart, asked of two ways back, as ways forwards have it."""

import pytest

import signorini as sg
from signorini.derivative.edge_probe import EdgeProbe
from signorini.derivative.validity import edges
from signorini.model.outputs import WeightedSum
from tests.derivative.symmetric import squeezed


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
    work = solution.derivative(sg.dissipation())  # friction takes work from each from where it slips
    assert work.sides("load.one") == pytest.approx(differences(sg.dissipation()), rel=1e-6)
    assert solution.tangent(load="one").of(sg.dissipation()) == pytest.approx(work.by("load.one"), rel=1e-12)


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
