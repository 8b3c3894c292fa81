# SPDX-License-Identifier: BSD-3-Clause
"""Models of bodies that yield, written as TOML decks and read again, are solved to the same digits."""

import numpy as np
import pytest

import signorini as sg
from signorini.deck.write import write_deck
from tests.helpers.columns import ELASTIC, column

CHABOCHE = sg.Elastic(
    E=200.0,
    nu=0.3,
    plastic=sg.Plastic([(0.0, 1.0), (0.02, 1.2)], hardening=5.0, backstresses=[(30.0, 10.0), (5.0, 0.0)]),
)


@pytest.mark.parametrize("kind", ["axisymmetric", "plane strain", "3d"])
def test_a_deck_says_all_that_flow_needs(kind, tmp_path):
    steps = [sg.Step(increments=2), sg.Step(scale={"press": -0.2}, increments=2)]
    model = column(kind, upper=CHABOCHE, lower=ELASTIC, friction="tied", steps=steps)
    deck = tmp_path / "column.toml"
    write_deck(model, deck)
    one, two = sg.solve(model), sg.solve(sg.read(deck))
    assert two.model.bodies[0].material == CHABOCHE
    np.testing.assert_array_equal(two.end.state.plastic.equivalent, one.end.state.plastic.equivalent)
    assert one.end.state.plastic.equivalent.max() > 0.0
