# SPDX-License-Identifier: BSD-3-Clause
"""One node, stiffness 2, coupling -1, pressed by 1 and pulled sideways: all branches by hand."""

import numpy as np
import pytest

from signorini.friction.history import follow, initial_state
from signorini.law.states import OPEN, SLIP_MINUS, STICK
from tests.helpers.path_samples import at, one_node


def pull(mu, most=4.0):
    problem, load = one_node(mu)
    pressed = follow(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.0))
    return follow(problem, pressed.end, load(-1.0, most))


def test_slips_then_opens():
    path = pull(1.0)
    assert path.followed
    assert [(event.what, event.pairs) for event in path.events] == [("slips", (0,)), ("opens", (0,))]
    np.testing.assert_allclose([4 * event.factor for event in path.events], [1.0, 2.0], rtol=0, atol=1e-13)
    assert [event.state.state.tolist() for event in path.events] == [[SLIP_MINUS], [OPEN]]
    np.testing.assert_allclose(path.end.h[:, 0], [2 / 3, 7 / 3], rtol=0, atol=1e-13)
    assert path.end.dissipation == pytest.approx(0.5, abs=1e-13)
    assert path.end.slip[0] == pytest.approx(1.0, abs=1e-13)
    assert path.residual < 1e-14


def test_a_closed_form_point_between_events():
    h, r = at(pull(1.0), 1.5 / 4)
    np.testing.assert_allclose(h, [0.0, 0.5], rtol=0, atol=1e-13)
    np.testing.assert_allclose(r, [0.5, -0.5], rtol=0, atol=1e-13)


def test_sticks_where_it_is_let_go_and_slips_back():
    problem, load = one_node(0.5)
    states = [initial_state(problem, np.zeros(2))]
    for forces in ((-1.0, 0.0), (-1.0, 0.8), (-1.0, -0.9)):
        path = follow(problem, states[-1], load(*forces))
        assert path.followed
        states.append(path.end)
    assert [event.what for event in path.events] == ["sticks", "slips"]
    assert path.events[0].factor == 0.0
    assert path.events[0].state.anchor == pytest.approx(states[-2].h[1:])


def test_a_jump_is_named_and_proved():
    path = pull(3.0)
    assert path.outcome == "jump"
    assert 4 * path.jump.factor == pytest.approx(3.0, abs=1e-13)
    assert path.jump.pairs == (0,)
    assert not path.jump.gross_sliding
    assert "none of the 2 combinations" in path.jump.proof
    assert "lacks 0.33 of the data" in path.jump.proof  # sticking 4/3 of a pull of 4, slip 4 of a force of 12
    assert path.end.state.tolist() == [STICK]
    np.testing.assert_allclose(path.end.h[:, 0], [0.0, 0.0], atol=1e-14)
    np.testing.assert_allclose(path.end.r[:, 0], [1.0, -3.0], atol=1e-13)


@pytest.mark.parametrize(
    ("beyond", "outcome"), [(0.0, "followed"), (1e-8, "not_found"), (1e-7, "not_found"), (1e-5, "jump"), (0.1, "jump")]
)
def test_what_lies_within_rounding_is_no_proof(beyond, outcome):
    """Loads along the edge of friction 3 hold a node there; beyond it, sticking lacks what the pull has too much."""
    problem, load = one_node(3.0)
    pressed = follow(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.0)).end
    edge = follow(problem, pressed, load(-1.0, 3.0)).end
    path = follow(problem, edge, load(-2.0, 6.0 + beyond))
    assert path.outcome == outcome
    assert (path.jump is not None) == (outcome == "jump")
    if path.jump is not None:
        # (f_t - mu p) over the larger of 1 and mu, of the larger rate, the friction: 3
        assert path.jump.margin == pytest.approx(beyond / 9.0, rel=0.04)
        assert f"lacks {path.jump.margin:.2g} of the data" in path.jump.proof
    if outcome == "not_found":
        assert "no proof" in path.message


def test_a_slip_that_nothing_determines_is_refused_by_a_program():
    """At friction 2 slip has no stiffness: the node moves at one load, and no rates obey the law whatever they are."""
    path = pull(2.0)
    assert path.outcome == "jump"
    assert 0.1 < path.jump.margin < 1.0


@pytest.mark.parametrize(("mu", "factor"), [(2.0, 2.0 / 4), (2.5, 2.5 / 4)])
def test_much_friction_jumps_where_it_is_used_up(mu, factor):
    assert pull(mu).jump.factor == pytest.approx(factor, abs=1e-12)


def test_without_load_change_nothing_happens():
    problem, load = one_node(1.0)
    start = follow(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.5)).end
    path = follow(problem, start, start.b)
    assert path.followed
    assert not path.events
    np.testing.assert_allclose(path.end.r, start.r, rtol=0, atol=1e-15)
