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
