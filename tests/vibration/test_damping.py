"""Loops of a mode under friction: a bar that sticks out of a rough bed, by hand."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.vibrating import bar_in_a_bed


@pytest.mark.slow
def test_loops_of_a_bar_in_a_bed():
    model, exact = bar_in_a_bed(cells=24)
    solution = sg.solve(model)
    assert sg.natural_modes(solution, 1).frequencies[0] == pytest.approx(exact.frequency, rel=1e-3)
    found = sg.joint_damping(solution, [exact.amplitude(part) for part in (0.2, 0.4, 0.8)], cycles=1)
    assert found.message == ""
    force = np.array([loop.force.max() for loop in found.loops])
    assert found.dissipations == pytest.approx(exact.dissipation(force), rel=0.05)
    assert found.ratios == pytest.approx(exact.ratio(force), rel=0.05)
    assert (found.frequencies < exact.frequency).all()
    assert (np.diff(found.frequencies) < 0.0).all()
    assert all(loop.closure < 1e-12 for loop in found.loops)
    assert (found.exponents > 2.0).all()
    assert (found.exponents < 3.0).all()


def test_loops_enclose_what_friction_takes():
    model, exact = bar_in_a_bed(cells=10)
    (loop,) = sg.joint_damping(sg.solve(model), [exact.amplitude(0.7)], cycles=1).loops
    area = float(np.trapezoid(loop.force, loop.coordinate))
    assert area == pytest.approx(loop.dissipation, rel=0.01)  # between points that are asked for the way is curved
    # Masing: both halves are alike
    half = len(loop.force) // 2
    assert loop.coordinate[: half + 1] == pytest.approx(-loop.coordinate[half:], rel=1e-9, abs=1e-9 * loop.half_range)


@pytest.mark.slow
def test_a_joint_that_slides_as_a_whole_ends_the_table():
    model, exact = bar_in_a_bed(cells=10)
    found = sg.joint_damping(sg.solve(model), [exact.amplitude(0.5), exact.amplitude(1.5)], cycles=1)
    assert len(found.loops) == 1
    assert "loop 2" in found.message


@pytest.mark.slow
def test_a_press_fit_shakes_down_after_a_cycle():
    """What slips in the first cycle alone is no damping: the second one tells."""
    rings = {"hub": [1.0, 1.5, 2.0], "rim": [2.0, 2.5, 3.0]}
    steel = sg.Elastic(E=200.0, nu=0.3, density=2.0)
    model = sg.Model(
        sg.join({name: sg.rectangle(x=x, y=[0.0, 0.5, 1.0]) for name, x in rings.items()}),
        kind="axisymmetric",
        bodies=[sg.Body(name, steel) for name in rings],
        supports=[sg.Support("hub.left", u=(None, 0.0))],
        contacts=[sg.Contact("rim.left", "hub.right", friction=0.2, interference=0.001)],
    )
    solution = sg.solve(model)
    first, second = (sg.joint_damping(solution, [5e-4], cycles=count) for count in (1, 2))
    assert first.loops[0].closure > 1e-3
    assert first.ratios[0] > 1e-3
    assert second.loops[0].closure < 1e-12
    assert second.ratios[0] < 1e-12
    assert second.frequencies == pytest.approx(second.frequency, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("facets", [0, 4])
def test_loops_in_space_end_where_the_joint_slides(facets):
    parts = {"lower": [0.0, 0.5], "upper": [0.5, 1.0]}
    steel = sg.Elastic(E=200.0, nu=0.3, density=2.0)
    model = sg.Model(
        sg.join({name: sg.box(x=[0.0, 0.5, 1.0], y=[0.0, 0.5, 1.0], z=z) for name, z in parts.items()}),
        bodies=[sg.Body(name, steel) for name in parts],
        supports=[sg.Support("lower.bottom", u=(0.0, 0.0, 0.0))],
        loads=[sg.Load("upper.top", pressure=1.0)],
        contacts=[sg.Contact("upper.bottom", "lower.top", friction=0.3, facets=facets)],
    )
    found = sg.joint_damping(sg.solve(model), [0.001, 0.02], cycles=1)
    assert len(found.loops) == 1
    assert found.frequencies == pytest.approx(found.frequency, rel=1e-8)
    assert "gross sliding" in found.message


def test_a_joint_that_does_not_slip_damps_nothing():
    model, exact = bar_in_a_bed(cells=10)
    rough = replace(model, contacts=[replace(model.contacts[0], friction=50.0)])
    found = sg.joint_damping(sg.solve(rough), [exact.amplitude(0.2), exact.amplitude(0.4)], cycles=1)
    assert found.frequencies == pytest.approx(found.frequency, rel=1e-9)
    assert found.ratios == pytest.approx(0.0, abs=1e-12)
    assert np.isnan(found.exponents).all()


@pytest.mark.parametrize(
    ("amplitudes", "mode", "words"),
    [
        ([], 1, "amplitudes: are none; expected one length or more"),
        ([2.0, 1.0], 1, "amplitudes: are [2.0, 1.0]; expected them to ascend"),
        ([1.0], 0, "mode: is 0; expected a whole number >= 1"),
    ],
)
def test_what_is_asked_wrongly_is_named(amplitudes, mode, words):
    model, _ = bar_in_a_bed(cells=4)
    with pytest.raises(sg.InputError) as error:
        sg.joint_damping(sg.solve(model), amplitudes, mode=mode)
    assert str(error.value) == words
