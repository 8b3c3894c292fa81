# SPDX-License-Identifier: BSD-3-Clause
"""Hill's tube under pressure beyond first yield: how far it flows, its stresses, what is left of them, its limit."""

import re

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.yielding import tube
from signorini.outcome import Outcome
from signorini.reference.plasticity import HillTube
from signorini.verify.yielding_points import yielding_points

HILL = HillTube(inner=1.0, outer=2.0, shear_strength=1.0)
LOADED = (sg.Step(increments=1),)
UNLOADED = (*LOADED, sg.Step(scale={"pressure": 0.0}))

# cells through the wall, error of the stresses over k (root of the mean square), that of the bound of the limit load
MESHES = [("quad", 16, 0.032, 7e-4), ("quad8", 8, 0.007, 1e-5)]


def lacking(solution, exact, pressure):
    points = yielding_points(solution)
    r, *found = points.polar
    square = sum((one - two) ** 2 for one, two in zip(found, exact(r, pressure), strict=True))
    return np.sqrt(points.weights @ square / points.weights.sum())


@pytest.mark.parametrize(("cells", "n", "allowed", "_"), MESHES)
def test_the_zone_spreads_and_stresses_are_left(cells, n, allowed, _):
    given = {"pressure": 1.2, "n": n, "cells": cells}
    loaded, unloaded = sg.solve(tube(**given, steps=LOADED)), sg.solve(tube(**given, steps=UNLOADED))
    assert lacking(loaded, HILL.stress, 1.2) < allowed
    assert lacking(unloaded, HILL.residual_stress, 1.2) < allowed
    points = yielding_points(loaded)
    r, flows = points.polar[0], points.equivalent > 0.0
    assert abs(r[flows].max() - HILL.plastic_radius(1.2)) < 0.6 / n
    assert points.mises.max() < np.sqrt(3.0) * (1.0 + 1e-8)
    after = unloaded.end.state.plastic
    np.testing.assert_array_equal(after.equivalent, loaded.end.state.plastic.equivalent)


@pytest.mark.parametrize(("cells", "n", "_", "off"), MESHES)
def test_beyond_the_limit_the_tube_flows_and_the_load_is_named(cells, n, _, off):
    for pressure in (1.01 * HILL.limit, 2.0 * HILL.limit):
        with pytest.raises(sg.SolveFailed) as caught:
            sg.solve(tube(pressure=pressure, n=n, cells=cells, steps=LOADED))
        failure = caught.value
        assert failure.status == Outcome.NO_EQUILIBRIUM
        named = float(re.search(r"flow plastically at ([\d.]+)%", str(failure))[1]) / 100.0 * pressure
        assert abs(named / HILL.limit - 1.0) < off
        assert "proved for this mesh" in str(failure)


@pytest.mark.parametrize(("cells", "n", "_", "off"), MESHES)
def test_just_below_the_limit_there_is_equilibrium(cells, n, _, off):
    assert sg.solve(tube(pressure=(1.0 - off) * 0.9995 * HILL.limit, n=n, cells=cells, steps=LOADED)).solved


def test_first_yield_is_where_and_when_it_should_be():
    """At the bore, at k (1 - a^2 / b^2), to what the innermost points lie off it."""
    solution = sg.solve(tube(pressure=1.2, n=32))
    (note,) = (note for note in solution.last.notes if "first yield" in note)
    share, x, y = (float(re.search(rf"{word}([-\d.e]+)", note)[1]) for word in ("at ", r"\(", ", (?=[^,]*\\)$)"))
    assert np.hypot(x, y) == pytest.approx(1.0, abs=1.0 / 32)
    assert share / 100.0 * 1.2 == pytest.approx(HILL.first_yield, rel=0.03)
