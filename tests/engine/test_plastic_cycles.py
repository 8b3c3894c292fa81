# SPDX-License-Identifier: BSD-3-Clause
"""Cycles of bodies that yield: they shake down, flow to and fro, or ratchet, as closed forms say."""

import numpy as np
import pytest

import signorini as sg
from signorini.engine.cycles import judge
from signorini.gallery.yielding import rolled_half_plane
from signorini.solution.results import Cycle

E, Y = 200.0, 1.0


def bar(plastic, steps, *, stretch=None):
    """A cylinder of one cell under a pull per area of 1, or stretched by so much: uniaxial stress."""
    return sg.Model(
        sg.rectangle(),
        kind="axisymmetric",
        bodies=[sg.Body("block", sg.Elastic(E=E, nu=0.3, plastic=plastic))],
        supports=[sg.Support("bottom", u=(None, 0.0))]
        + ([] if stretch is None else [sg.Support("top", u=(None, stretch), name="pull")]),
        loads=[] if stretch is not None else [sg.Load("top", pressure=-1.0, name="pull")],
        steps=steps,
    )


def test_a_bar_of_prager_shakes_down():
    step = sg.Step(scale={"pull": [1.4, -0.3]}, repeat=4, increments=4)
    result = sg.solve(bar(sg.Plastic(Y, backstresses=[(20.0, 0.0)]), [step])).steps[0]
    assert result.steadiness == "shakes down"
    assert [cycle.flow > 0.0 for cycle in result.cycles] == [True, False, False, False]
    assert result.cycles[0].flow == pytest.approx(0.4 / 20.0, rel=1e-9)


def test_a_stretched_bar_flows_to_and_fro():
    step = sg.Step(scale={"pull": [1.0, -1.0]}, repeat=4, increments=1)
    result = sg.solve(bar(sg.Plastic(Y), [step], stretch=0.02)).steps[0]
    assert result.steadiness == "steady"
    assert result.cycles[-1].flow == pytest.approx(2.0 * (2.0 * 0.02 - 2.0 * Y / E), rel=1e-6)
    assert result.cycles[-1].plastic_drift < 1e-9


@pytest.mark.slow
def test_a_bar_of_armstrong_and_frederick_ratchets():
    C, gamma, low, high = 50.0, 25.0, -1.6, 2.2
    # Lemaitre, Chaboche (1990), Mechanics of Solid Materials, 5.4.4: what each cycle adds under stresses low .. high
    most = C / gamma
    drift = np.log((most**2 - (low + Y) ** 2) / (most**2 - (high - Y) ** 2)) / gamma
    errors = []
    for increments in (60, 120):
        step = sg.Step(scale={"pull": [high, low]}, repeat=3, increments=increments)
        result = sg.solve(bar(sg.Plastic(Y, backstresses=[(C, gamma)]), [step])).steps[0]
        assert result.steadiness == "ratchets"
        errors.append(result.cycles[-1].plastic_drift - drift)
    assert 1.9 <= errors[0] / errors[1] <= 2.3  # backward Euler is of first order


@pytest.mark.parametrize(
    ("flows", "dies"),
    [
        ([9.0, 4.0, 2.0, 1.0], True),
        ([2.0, 1.5, 1.2, 1.06, 1.02], False),  # just above a shakedown limit: falls to what every cycle adds
        ([9.0, 4.0, 2.0], False),  # too few to tell
        ([9.0, 1.0, 0.9, 0.88], False),
    ],
)
def test_flow_dies_out_where_its_decay_leaves_nothing(flows, dies):
    idle = dict.fromkeys(("load_factor", "work", "dissipation", "released", "sliding", "change", "drift"), 0.0)
    cycles = [Cycle(number=i, flow=flow, plastic_drift=flow, **idle) for i, flow in enumerate(flows)]
    verdict, words = judge(cycles, None)
    assert verdict == "not yet"
    assert words.endswith(
        ": flow dies out, bodies tend to shake down" if dies else ", not decided whether flow dies out"
    )


def test_a_drift_that_still_falls_is_no_ratchet():
    """Of a line contact that rolls just below its shakedown limit: as much flow to and fro, less of it left."""
    idle = dict.fromkeys(("load_factor", "work", "dissipation", "released", "sliding", "change", "drift"), 0.0)
    passes = [(3.92e-4, 2.36e-5), (3.853e-4, 1.98e-5), (3.805e-4, 1.74e-5)]
    cycles = [Cycle(number=i, flow=flow, plastic_drift=left, **idle) for i, (flow, left) in enumerate(passes)]
    verdict, words = judge(cycles, None)
    assert verdict == "not yet"
    assert words.endswith("plastic strain grows by 1.74e-05 in the last, 0.879 times as much as in the one before")


@pytest.mark.slow
def test_flow_under_a_rolling_cylinder_dies_out_below_the_shakedown_limit_alone():
    """Of ``4 k``; first yield is at 3.1 k."""
    below, above = (sg.solve(rolled_half_plane(4.0 * part, n=2, passes=5)).last for part in (0.8, 1.1))
    assert "flow dies out, bodies tend to shake down" in below.notes[-1]
    assert below.cycles[-1].flow < 1e-5 * below.cycles[0].flow
    assert not any("dies out" in note for note in above.notes)
    flows = [cycle.flow for cycle in above.cycles]
    assert flows[-1] == pytest.approx(flows[-2], rel=0.01)
