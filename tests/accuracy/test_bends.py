"""Where a side bends pressures have a notch between nodes, which the estimate knows."""

from types import SimpleNamespace

import numpy as np
import pytest

import signorini as sg
from benchmarks.accuracy import pressure_error, variation
from signorini.accuracy.bends import bend_squares, driven_motion
from signorini.solution.obstacle_result import ObstacleMotion


@pytest.mark.slow
def test_a_notch_between_nodes_is_estimated():
    """A punch whose edge begins with a jump of its curvature and slips: half of it was estimated without bends."""
    model = variation("rounded punch", 1)
    solution = sg.solve(model, accuracy=0.03)
    true = pressure_error(solution, sg.solve(solution.model, accuracy=sg.Accuracy(4e-3, nodes=40_000)))
    assert solution.accuracy.met
    assert 0.7 <= solution.accuracy.pressure / true <= 2.0


def arc(closed=True, move=0.1):
    """Nodes of a line that goes over into a circle of radius 2, moved along it or away from it."""
    x = np.linspace(-0.4, 0.4, 9)
    angle = np.maximum(x, 0.0) / 2.0
    points = np.column_stack([np.where(x < 0.0, x, 2.0 * np.sin(angle)), np.minimum(2.0 * np.cos(angle) - 2.0, 0.0)])
    normals = np.column_stack([np.sin(angle), np.cos(angle)])
    tangents = np.column_stack([normals[:, 1], -normals[:, 0]])
    pressure, closed = np.full(9, 4.0), np.full(9, closed)
    result = SimpleNamespace(
        node=np.arange(9), points=points, normals=normals, pressure=pressure, shear=-0.5 * pressure[:, None] * tangents
    )
    result.closed = closed
    return np.column_stack([np.arange(8), np.arange(1, 9)]), result, move * tangents


def test_a_bend_is_a_logarithm():
    """A^2 on the facets at the bend and nowhere else, with A = E* u k / (2 pi); friction is half of the pressure."""
    corners, result, moved = arc()
    pressure, friction = bend_squares(corners, result, moved, modulus=200.0)
    strength = 200.0 * 0.1 / 2.0 / (2.0 * np.pi)
    assert pressure[[3, 4]] == pytest.approx(strength**2, rel=0.01)
    assert np.delete(pressure, [3, 4]).max() < 1e-6 * strength**2
    np.testing.assert_allclose(friction, 0.25 * pressure)
    x = (np.arange(200_000) + 0.5) / 200_000 * 0.5
    assert np.var(strength * np.log(x)) == pytest.approx(strength**2, rel=1e-3)


def test_no_bend_where_nothing_moves_along_it_or_touches():
    corners, result, moved = arc()
    assert not bend_squares(corners, result, 0.0 * moved, modulus=200.0)[0].any()
    assert bend_squares(corners, result, 0.1 * result.normals, modulus=200.0)[0].max() < 1e-20
    corners, result, moved = arc(closed=False)
    assert not bend_squares(corners, result, moved, modulus=200.0)[0].any()


def test_an_obstacle_that_moves_takes_its_bends_along():
    """By (1, 2), and turned by 0.1 about (1, 0)."""
    tool = sg.Rigid("tool", sg.Circle((1.0, 0.0), 1.0), u=(1.0, 2.0), rotation=0.1)
    model = sg.Model(
        sg.rectangle(),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0))],
        obstacles=[tool],
        contacts=[sg.Contact("bottom", "tool")],
    )
    motions = {"tool": ObstacleMotion(displacement=np.array([1.0, 2.0]), rotation=0.1)}
    found = driven_motion(model, 0, np.array([[1.0, 1.0], [3.0, 0.0]]), motions)
    np.testing.assert_allclose(found, [[0.9, 2.0], [1.0, 2.2]])
