# SPDX-License-Identifier: BSD-3-Clause
"""Histories in space from event to event: exact on polygons, and where nothing turns; near it on circles."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.friction.history import PathSettings, follow, initial_state
from signorini.friction.history.space.straight import friction_turns, held_until
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from tests.helpers.contact_samples import block_on_floor


def random_history(seed, pairs, rows, segments=3):
    """W, the start (initial gaps, load) and loads that press and push at random; rows a pair 2 or 3."""
    rng = np.random.default_rng(seed)
    size = rows * pairs
    Q, _ = np.linalg.qr(rng.normal(size=(size, size)))
    W = (Q * rng.uniform(0.05, 0.95, size)) @ Q.T
    W = (W + W.T) / 2
    h0 = np.concatenate([0.3 * np.abs(rng.normal(size=pairs)), np.zeros(size - pairs)])
    b0 = h0 - W @ h0
    press = np.concatenate([np.ones(pairs), np.zeros(size - pairs)])
    return W, h0, b0, [b0 + rng.normal(size=size) - press for _ in range(segments)]


def in_space(W, friction, facets, **changes):
    n = len(W) // 3
    given = {"W": W, "b": np.zeros(3 * n), "friction": np.broadcast_to(friction, (n, *np.shape(friction))).T}
    return ContactProblem.of(**given | {"motions": np.zeros((3 * n, 0)), "scale": 1.0, "facets": facets} | changes)


def run(problem, h0, b0, loads, **settings):
    state, segments = initial_state(problem, b0, motion=problem.by_pair(h0)), []
    for b in loads:
        segments.append(follow(problem, state, b, settings=PathSettings(**settings)))
        assert segments[-1].followed, segments[-1].message
        state = segments[-1].end
    return segments


@pytest.mark.parametrize("facets", [0, 4, 8])
@pytest.mark.parametrize("seed", range(4))
def test_forces_in_a_plane_follow_the_exact_path_of_the_plane(seed, facets):
    """A second tangent that nothing loads: same events of the same pairs at the same loads, and the same end."""
    n = 6
    W2, h0, b0, loads = random_history(seed, n, 2)
    W = 0.5 * np.eye(3 * n)
    W[: 2 * n, : 2 * n] = W2
    plane = ContactProblem.of(
        W=W2, b=np.zeros(2 * n), friction=np.full(n, 0.4), motions=np.zeros((2 * n, 0)), scale=1.0
    )
    state = initial_state(plane, b0, motion=plane.by_pair(h0))
    segments = run(in_space(W, 0.4, facets), *(np.append(x, np.zeros(n)) for x in (h0, b0)), wide(loads, n))
    for b, found in zip(loads, segments, strict=True):
        expected = follow(plane, state, b)
        state = expected.end
        for key in ("h", "r", "slip", "dissipation"):
            np.testing.assert_allclose(
                getattr(found.end, key)[: len(getattr(state, key))], getattr(state, key), atol=1e-11
            )
        assert [(event.what, event.pairs) for event in found.events] == [
            (event.what, event.pairs) for event in expected.events
        ]
        np.testing.assert_allclose(
            [event.factor for event in found.events], [event.factor for event in expected.events], atol=1e-11
        )


def wide(loads, n):
    return [np.append(b, np.zeros(n)) for b in loads]


LAWS = [(0.5, 4), (0.5, 8), ((0.2, 0.6), 8), (0.3, 16)]


@pytest.mark.parametrize(("friction", "facets"), LAWS)
def test_stops_on_the_way_do_not_matter(friction, facets):
    W, h0, b0, loads = random_history(facets, 6, 3)
    problem = in_space(W, friction, facets)
    at = (0.237, 0.618, 1.0)
    ends = [b0, *loads]
    stops = [(1.0 - s) * one + s * two for one, two in zip(ends[:-1], loads, strict=True) for s in at]
    whole, parts = run(problem, h0, b0, loads)[-1].end, run(problem, h0, b0, stops)[-1].end
    for key in ("h", "r", "slip", "dissipation"):
        np.testing.assert_allclose(getattr(parts, key), getattr(whole, key), atol=1e-10)


@pytest.mark.parametrize(("friction", "facets"), LAWS)
def test_the_law_holds_all_along_every_piece_and_energy_is_kept(friction, facets):
    """Slip of a piece dissipates the most that the section allows, at its beginning, in its middle and at its end."""
    W, h0, b0, loads = random_history(10 + facets, 6, 3)
    problem = in_space(W, friction, facets)
    segments = run(problem, h0, b0, loads)
    assert sum(len(segment.pieces) for segment in segments) > 20
    lost = 0.0
    for segment in segments:
        for one, two in zip(segment.pieces[:-1], segment.pieces[1:], strict=True):
            slip = (two.h - one.h)[1:]
            pressed = (one.r + two.r)[0] > 0
            best = problem.mu * problem.section.farthest(slip)
            for t in (0.0, 0.5, 1.0):
                h, r = (1 - t) * one.h + t * two.h, (1 - t) * one.r + t * two.r
                power = ((r[1:] + r[0] * best) * slip).sum(axis=0)
                assert np.abs(power[pressed]).max(initial=0.0) < 1e-9
                assert np.abs(r[0] * h[0]).max() < 1e-9
            lost -= 0.5 * float(((one.r + two.r) * (two.h - one.h)).sum())
    assert segments[-1].end.dissipation.sum() == pytest.approx(lost, abs=1e-10)
    assert max(segment.residual for segment in segments) < 1e-10


@pytest.mark.parametrize("facets", [4, 8])
def test_increments_that_end_at_the_same_loads_give_the_same(facets):
    W, h0, b0, loads = random_history(20 + facets, 6, 3)
    problem, n = in_space(W, 0.5, facets), 6
    start = b0
    state = initial_state(problem, b0, motion=problem.by_pair(h0))
    h = state.h
    for segment, b_end in zip(run(problem, h0, b0, loads), loads, strict=True):
        y = None
        for piece in segment.pieces[1:]:
            b = (1.0 - piece.factor) * start + piece.factor * b_end
            origin = np.concatenate([np.zeros((1, n)), h[1:]])
            result = solve_contact(replace(problem, b=b + W @ origin.ravel() - origin.ravel()), y)
            assert result.solved
            h, y = result.h + origin, result.y
        np.testing.assert_allclose(h, segment.end.h, atol=1e-10)
        start = b_end


def test_smooth_sections_come_near_as_friction_may_turn_less():
    W, h0, b0, loads = random_history(5, 4, 3, segments=2)
    problem = in_space(W, 0.5, 0)
    fine = run(problem, h0, b0, loads, turn=0.01)[-1].end.r
    errors = [np.abs(run(problem, h0, b0, loads, turn=turn)[-1].end.r - fine).max() for turn in (0.4, 0.05)]
    assert errors[0] > 2.0 * errors[1]
    assert errors[1] < 1e-2 * np.abs(fine).max()


def test_short_increments_are_not_asked_for_more_often_than_said():
    W, h0, b0, loads = random_history(6, 8, 3)
    problem = in_space(W, 0.5, 0)
    counts = [len(run(problem, h0, b0, loads[:1], shortest=1.0 / k)[0].pieces) - 1 for k in (1, 4, 16)]
    assert counts[0] <= 1 + 8
    assert counts[1] <= 4 + 8
    assert counts[2] <= 16 + 8


@pytest.mark.parametrize("facets", [4, 8])
def test_a_block_pulled_along_a_corner_slides_at_the_friction_of_its_weight(facets):
    pressed = block_on_floor(9, (-1.0, 0, 0, 0, 0, 0), facets=facets)
    pulled = block_on_floor(9, (-1.0, 0.5, 0, 0, 0, 0), facets=facets)
    none = np.zeros_like(pressed.b)
    first = follow(pressed, initial_state(pressed, none, motion=pressed.by_pair(none)), pressed.b)
    second = follow(pressed, first.end, pulled.b)
    assert second.outcome == "jump"
    assert second.jump.gross_sliding
    assert second.jump.factor == pytest.approx(0.3 / 0.5, abs=1e-9)
    # of the load (-1, 0.5) friction 0.3 leaves 0.5 - 0.3 along (0.3, 1); across a corner the octagon leaves less
    most = (0.5 - 0.3) / np.sqrt((1 + 0.25) * (1 + 0.09))
    assert 0.9 * most < second.jump.margin < (1 + 1e-9) * most
    Q = pressed.motions.T @ second.end.r.ravel()
    assert Q[1] == pytest.approx(-0.3 * Q[0], abs=1e-9)


def test_a_block_that_is_lifted_leaves_and_says_how_sure_that_is():
    pressed = block_on_floor(9, (-1.0, 0, 0, 0, 0, 0), facets=8)
    first = follow(
        pressed, initial_state(pressed, np.zeros_like(pressed.b), motion=np.zeros((3, pressed.pairs))), pressed.b
    )
    second = follow(pressed, first.end, -2.0 * pressed.b)
    assert second.outcome == "jump"
    assert second.jump.factor == pytest.approx(1.0 / 3.0, abs=1e-6)
    assert not second.jump.gross_sliding
    assert second.jump.margin == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize(
    ("end", "said"), [(np.zeros(2), r"b_end: is of shape \(2,\); expected \(3,\)"), (np.full(3, np.nan), "not finite")]
)
def test_loads_that_are_no_loads_are_refused(end, said):
    problem = in_space(0.5 * np.eye(3), 0.5, 0)
    with pytest.raises(InputError, match=said):
        follow(problem, initial_state(problem, np.zeros(3)), end)


def test_a_pair_that_leaves_its_limit_and_comes_to_it_elsewhere_sticks_up_to_there():
    """It slips a little at the end of a piece, whose friction has gone along a chord; a turn all the way slips far."""
    problem = in_space(0.5 * np.eye(3), 0.3, 0)
    start = replace(initial_state(problem, np.zeros(3)), h=np.zeros((3, 1)), r=np.array([[1.0], [-0.3], [0.0]]))
    end = np.array([[1.0], [0.0], [-0.3]])
    for slip, until, turn in ((3e-6, 1.0 - 1e-5, 0.0), (3.0, 1.0, np.pi / 2)):
        h = np.array([[0.0], [0.0], [slip]])
        assert held_until(problem, start, h, end, 1e-9) == pytest.approx(until, abs=1e-9)
        assert friction_turns(problem, start, end, h[1:], 1e-9) == pytest.approx(turn)
