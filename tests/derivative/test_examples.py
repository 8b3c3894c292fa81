# SPDX-License-Identifier: BSD-3-Clause
"""The examples of derivatives do what they say, with as few points as show it."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import signorini as sg

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
def test_friction_and_modulus_are_found_from_a_loop():
    fit = example("fit_friction")
    model, outputs = fit.loop(3)
    function = sg.prepare(model).function(["friction.contact", "E.specimen"], outputs)
    found = fit.fit(function, function.values(fit.TRUE), start=1.01 * fit.TRUE, tolerance=1e-5)
    assert found.found == pytest.approx(fit.TRUE, rel=1e-5)
    assert found.solves <= 4


def test_a_punch_is_levelled_to_the_profile_of_a_half_plane():
    punch = example("level_pressure")
    x, before, gap, uneven = punch.level(10)
    assert before.max() > 3.0 * before.min()
    assert len(uneven) == 2
    assert uneven[-1] < 1e-9
    wanted = punch.half_plane(x)
    rest = gap - wanted
    rest -= x**2 * (rest @ x**2) / (x**2 @ x**2)  # of the finite block
    assert np.abs(rest).max() < 0.01 * wanted.max()


def test_tolerances_of_a_press_fit_are_those_of_lame():
    fit = example("press_fit_tolerances")
    pressure, found = fit.derivatives(3)
    assert pressure == pytest.approx(fit.lame(*(1.0, 2.0, 3.0), fit.OVERLAP, fit.SHAFT, fit.HUB), rel=1e-3)
    exact = fit.closed()
    for name, derivative in found.items():
        assert derivative == pytest.approx(exact[name], rel=4e-3), name


@pytest.mark.slow
def test_a_crown_levels_a_roller_and_is_lundbergs_away_from_its_end():
    roller = example("crown_roller")
    places, loads, profile = roller.crown(10, 3)
    straight, of_lundberg, found = loads[0], loads[1], loads[-1]
    assert straight[-1] > 2.0
    assert np.abs(of_lundberg - 1.0).max() < 0.5 * (straight[-1] - 1.0)
    assert np.abs(found - 1.0).max() < 1e-6
    assert len(loads) <= 7
    inside = slice(2, 8)  # from a fifth to four fifths of its length
    assert profile[inside] == pytest.approx(roller.lundberg(places)[inside], rel=0.15)
    assert (np.diff(profile) > 0.0).all()


def test_arrows_of_a_shape_are_drawn(tmp_path):
    arrows = example("shape_arrows")
    arrows.main(tmp_path)
    assert (tmp_path / "shape_arrows.png").stat().st_size > 10_000
