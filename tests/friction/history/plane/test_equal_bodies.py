# SPDX-License-Identifier: BSD-3-Clause
"""Cattaneo-Mindlin on equal bodies, where the discrete law of Ciavarella and Jaeger is exact on any mesh; cycles."""

import numpy as np
import pytest

from tests.helpers.path_samples import EqualBodies, at

MU, P = 0.5, 0.6
Q = 0.7 * MU * P
SIZES = [9, 40, 101]


def friction(segment):
    """The friction that balances the pull."""
    return -segment.end.r[1]


@pytest.mark.parametrize("pairs", SIZES)
def test_ciavarella_jaeger(pairs):
    press, pull = EqualBodies(pairs, MU).run((P, 0.0), (P, Q))
    assert press.followed
    assert pull.followed
    less = at(press, (P - Q / MU) / P)[1][:pairs]
    assert np.abs(press.end.r[1]).max() < 1e-13
    assert friction(pull).sum() == pytest.approx(Q, abs=1e-13)
    np.testing.assert_allclose(friction(pull), MU * (press.end.r[0] - less), rtol=0, atol=1e-12)


@pytest.mark.parametrize("pairs", SIZES)
def test_pairs_slip_in_the_reverse_order_in_which_they_closed(pairs):
    press, pull = EqualBodies(pairs, MU).run((P, 0.0), (P, Q))
    closed_at = {k: event.factor * P for event in press.events for k in event.pairs}
    slips = [(event.factor * Q, k) for event in pull.events for k in event.pairs]
    assert {event.what for event in press.events} == {"closes"}
    assert {event.what for event in pull.events} == {"slips"}
    assert len(slips) > pairs // 5
    for load, k in slips:
        assert load == pytest.approx(MU * (P - closed_at[k]), abs=1e-12)


@pytest.mark.parametrize("pairs", SIZES)
def test_a_reversal_mirrors_and_cycles_close(pairs):
    _, pull, back, again, second_back, second_again = EqualBodies(pairs, MU).run(
        (P, 0.0), (P, Q), (P, -Q), (P, Q), (P, -Q), (P, Q)
    )
    assert second_again.followed
    np.testing.assert_allclose(friction(back), -friction(pull), rtol=0, atol=1e-12)
    for first, second in ((pull, again), (back, second_back), (again, second_again)):
        np.testing.assert_allclose(second.end.r, first.end.r, rtol=0, atol=1e-12)
        np.testing.assert_allclose(second.end.h, first.end.h, rtol=0, atol=1e-12)


def test_between_reversals_masing_holds():
    body = EqualBodies(60, MU)
    press, pull, back = body.run((P, 0.0), (P, Q), (P, -0.4 * Q))
    n, drop = 60, 1.4 * Q
    less = at(press, (P - drop / (2 * MU)) / P)[1][:n]
    expected = friction(pull) - 2 * MU * (press.end.r[0] - less)
    np.testing.assert_allclose(friction(back), expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("pairs", SIZES)
def test_dissipation_is_the_area_of_the_loop(pairs):
    body = EqualBodies(pairs, MU)
    segments = body.run((P, 0.0), (P, Q), (P, -Q), (P, Q))
    area = 0.0
    for start, change, segment in ((Q, -2 * Q, segments[2]), (-Q, 2 * Q, segments[3])):
        force = [start + change * piece.factor for piece in segment.pieces]
        area += np.trapezoid(force, [body.travel(piece) for piece in segment.pieces])
    lost = (segments[-1].end.dissipation - segments[1].end.dissipation).sum()
    assert lost > 1e-3
    assert lost == pytest.approx(area, rel=1e-12)
    assert (segments[-1].end.dissipation >= segments[1].end.dissipation - 1e-16).all()


def test_full_sliding_is_named():
    body = EqualBodies(30, MU)
    *_, slide = body.run((P, 0.0), (P, 2 * MU * P))
    assert slide.outcome == "jump"
    assert slide.jump.factor == pytest.approx(0.5, abs=1e-12)
    assert slide.jump.gross_sliding
    assert slide.jump.margin > 0.0
    assert "gross sliding" in slide.message
    assert slide.end.r[1].sum() == pytest.approx(-MU * P, abs=1e-12)


def test_loads_that_lift_the_body_end_the_path():
    *_, lift = EqualBodies(30, MU).run((P, 0.0), (-P, 0.0))
    assert lift.outcome == "jump"
    assert lift.jump.factor == pytest.approx(0.5, abs=1e-12)
    assert not lift.jump.gross_sliding
    assert lift.jump.margin > 0.0
    assert lift.end.r == pytest.approx(0.0, abs=1e-12)
