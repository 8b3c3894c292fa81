"""Loops of a mode under friction: a bar that sticks out of a rough bed, by hand."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.vibrating import bar_in_a_bed


def test_loops_of_a_bar_in_a_bed():
    model, exact = bar_in_a_bed(cells=40)
    solution = sg.solve(model)
    assert sg.natural_modes(solution, 1).frequencies[0] == pytest.approx(exact.frequency, rel=1e-4)
    found = sg.joint_damping(solution, [exact.amplitude(part) for part in (0.2, 0.4, 0.8)])
    assert found.message == ""
    force = np.array([loop.force.max() for loop in found.loops])
    assert found.dissipations == pytest.approx(exact.dissipation(force), rel=0.02)
    assert found.ratios == pytest.approx(exact.ratio(force), rel=0.02)
    assert (found.frequencies < exact.frequency).all()
    assert (np.diff(found.frequencies) < 0.0).all()
    assert all(loop.closure < 1e-12 for loop in found.loops)
    assert (found.exponents > 2.0).all()
    assert (found.exponents < 3.0).all()


def test_loops_enclose_what_friction_takes():
    model, exact = bar_in_a_bed(cells=10)
    (loop,) = sg.joint_damping(sg.solve(model), [exact.amplitude(0.7)]).loops
    area = float(np.trapezoid(loop.force, loop.coordinate))
    assert area == pytest.approx(loop.dissipation, rel=0.01)  # between points that are asked for the way is curved
    # Masing: both halves are alike
    half = len(loop.force) // 2
    assert loop.coordinate[: half + 1] == pytest.approx(-loop.coordinate[half:], rel=1e-9, abs=1e-9 * loop.half_range)


def test_a_joint_that_slides_as_a_whole_ends_the_table():
    model, exact = bar_in_a_bed(cells=10)
    found = sg.joint_damping(sg.solve(model), [exact.amplitude(0.5), exact.amplitude(1.5)])
    assert len(found.loops) == 1
    assert "loop 2" in found.message


def test_a_joint_that_does_not_slip_damps_nothing():
    model, exact = bar_in_a_bed(cells=10)
    rough = replace(model, contacts=[replace(model.contacts[0], friction=50.0)])
    found = sg.joint_damping(sg.solve(rough), [exact.amplitude(0.2), exact.amplitude(0.4)])
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
