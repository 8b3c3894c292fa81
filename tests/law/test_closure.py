# SPDX-License-Identifier: BSD-3-Clause
"""Closures as they are given: what is refused, their lines, their energy, the exponential law by secants."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.cli.main import main
from signorini.deck.write import write_deck
from signorini.gallery.closures import GASKET, block_on_a_bed
from signorini.law.closure import PairClosure


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ("steep", "points: expected two points or more, each [closure, pressure]"),
        ([(0, 0)], "points: expected two points or more, each [closure, pressure]"),
        ([(0, 0), 3.0], "points[1]: is 3.0; expected [closure, pressure]"),
        ([(0, 0), (1, math.nan)], "points[1][1]: is nan; expected a number"),
        ([(0, 1), (1, 2)], "points[0][1]: is 1; expected 0, the pressure where closure begins"),
        ([(0, 0), (1, 2), (2, 2)], "points[2][1]: is 2 after 2; expected pressures that grow"),
        ([(0, 0), (1, 2), (0.5, 3)], "points[2][0]: is 0.5 after 1; expected closures that do not fall"),
        ([(1, 0), (1, 2)], "points: do not close; expected a last closure beyond the first one"),
    ],
)
def test_what_is_no_closure(points, said):
    with pytest.raises(sg.InputError) as caught:
        sg.Closure(points)
    assert str(caught.value) == said


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"closure": 3.0}, "closure: is 3.0; expected a Closure"),
        ({"friction": "tied"}, "closure: is given, but the contact is tied; expected one of both"),
        ({"normal_compliance": 0.1}, "closure: is given, but normal_compliance too; expected one of both"),
    ],
)
def test_what_a_closure_does_not_go_with(given, said):
    with pytest.raises(sg.InputError) as caught:
        sg.Contact("a", "b", **({"closure": GASKET} | given))
    assert str(caught.value) == said


def test_lines_and_energy_are_those_of_the_points():
    closures, pressures = np.transpose(GASKET.points)
    pressure = np.linspace(0.0, 30.0, 301)
    pairs = PairClosure.of([None, GASKET], [0.25, 0.0], [1, len(pressure)])
    assert pairs is not None
    own = pairs.among(np.arange(302) > 0)
    assert_allclose(own.at(pressure), np.interp(pressure, pressures, closures), rtol=0, atol=1e-16)
    by_points = [
        np.trapezoid(np.append(pressures[pressures < p], p), np.append(closures[pressures < p], c))
        for p, c in zip(pressure, own.at(pressure), strict=True)
    ]
    assert_allclose(own.energy(pressure), by_points, rtol=1e-13, atol=1e-17)
    linear = pairs.among(np.arange(302) == 0)
    assert linear.at(np.array([4.0])) == 1.0
    assert linear.energy(np.array([4.0])) == 2.0


@pytest.mark.parametrize("tolerance", [0.1, 0.003])
def test_secants_of_the_exponential_law_are_as_close_as_asked(tolerance):
    law = sg.Closure.exponential(0.01, 2.0, tolerance=tolerance)
    x = np.linspace(0.0, 7.0, 20001)
    exact = 2.0 * x * np.expm1(x) / math.expm1(1.0)
    above = np.interp(0.01 * (x - 1.0), *np.transpose(law.points)) - exact
    error = above / (exact + 0.02)
    assert error.min() > -1e-9
    assert 0.9 * tolerance < error.max() < 1.001 * tolerance


def test_what_springs_back_is_no_softer_than_its_lines():
    with pytest.raises(sg.InputError) as caught:
        sg.Closure(GASKET.points, unloading=5000.0)
    assert str(caught.value) == "unloading: is 5000, less than 11000, the steepest line of the points; expected more"
    assert sg.Closure(GASKET.points, unloading=11000.0).words.endswith("4 lines, springs back by 11000")


def test_check_says_what_closes_and_which_way_a_gasket_is_followed(tmp_path, capsys):
    for unloading in (None, 2e4):
        closure = sg.Closure(GASKET.points, unloading=unloading)
        write_deck(block_on_a_bed(1.0, closure, steps=[sg.Step(name="press")]), tmp_path / "deck.toml")
        assert main(["check", str(tmp_path / "deck.toml")]) == 0
        said = capsys.readouterr().out
        assert "friction 0, closes to 0.042 under 30, 4 lines" in said
        assert ("springs back by 20000" in said) == (unloading is not None)
        assert ("exact path where there is friction, otherwise 1 increment" in said) == (unloading is None)
        assert "press  exact path" in said
