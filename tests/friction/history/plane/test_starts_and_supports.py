# SPDX-License-Identifier: BSD-3-Clause
"""First states, bodies held by contact alone, pairs that supports hold or drag, and input that is wrong."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.errors import InputError, SolveFailed
from signorini.friction.history import PathSettings, follow, initial_state
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS
from signorini.settings import SolverSettings
from tests.helpers.contact_samples import block_on_floor, for_all
from tests.helpers.path_samples import Springs, increments, loads_at_breakpoints, one_node, stiff


def test_at_rest_the_gaps_are_open():
    body = Springs(stiff(1, 4), np.full(4, 0.3), np.array([0.0, 0.1, 0.2, 0.3]))
    state = initial_state(body.problem, body.load(np.zeros(8)))
    np.testing.assert_allclose(state.h.ravel(), body.gap, rtol=0, atol=1e-14)
    assert state.state.tolist() == [OPEN] * 4
    assert state.note == "nothing has moved"
    assert not state.r.any()


def test_an_interference_is_one_increment_and_says_so():
    body = Springs(stiff(2, 4), np.full(4, 0.3), np.array([-0.1, -0.1, 0.0, 0.1]))
    state = initial_state(body.problem, body.load(np.zeros(8)))
    assert state.note == "the load presses: one increment from zero slip"
    assert state.r[0].max() > 0
    path = follow(body.problem, state, body.load(np.append(np.full(4, -0.3), np.full(4, 0.1))))
    assert path.followed
    assert path.residual < 1e-13


@for_all(examples=25, seed=st.integers(0, 10**6), pairs=st.sampled_from([2, 5, 9]))
def test_floating_blocks_follow_their_increments(seed, pairs):
    rng = np.random.default_rng(seed)
    problem = block_on_floor(pairs, (0.0, 0.0, 0.0))
    elastic = problem.image.A @ rng.normal(size=2 * pairs) * 0.03
    own = (np.eye(2 * pairs) - problem.W) @ elastic
    loads = [load + k * own for k, load in enumerate(_resultants(problem, rng))]
    state = initial_state(problem, np.zeros(2 * pairs), motion=np.zeros((2, pairs)))
    start, ends = state, []
    for b in loads:
        path = follow(problem, state, b)
        assert path.followed, path.message
        ends += loads_at_breakpoints(path, state.b, b)
        state = path.end
    h, r = increments(problem, start, ends)
    np.testing.assert_allclose(state.r, r, rtol=0, atol=1e-10)
    np.testing.assert_allclose(state.h, h, rtol=0, atol=1e-10)


def _resultants(problem, rng):
    """Loads that press, push a little and turn a little."""
    R = problem.motions
    for _ in range(3):
        yield R @ np.linalg.solve(R.T @ R, [-1.0, rng.uniform(-0.25, 0.25), rng.uniform(-0.5, 0.5)])


def dragged(friction):
    """Two pairs; supports lock the tangential motion of the second."""
    S = stiff(3, 2)[:3, :3]
    W = np.zeros((4, 4))
    W[:3, :3] = np.linalg.inv(S + np.eye(3))
    return ContactProblem.of(
        W=(W + W.T) / 2, b=np.zeros(4), friction=np.full(2, friction), motions=np.zeros((4, 0)), scale=1.0
    )


def test_a_dragged_pair_slips_as_its_support_moves():
    problem = dragged(0.4)
    pressed = follow(problem, initial_state(problem, np.zeros(4)), np.array([-0.3, -0.3, 0.0, 0.0])).end
    there = follow(problem, pressed, np.array([-0.3, -0.3, 0.0, 0.1])).end
    back = follow(problem, there, np.array([-0.3, -0.3, 0.0, 0.0])).end
    p = pressed.r[0, 1]
    assert p > 0.1
    assert pressed.r[1, 1] == 0.0
    assert (there.state[1], back.state[1]) == (SLIP_MINUS, SLIP_PLUS)
    assert there.r[1, 1] == pytest.approx(-0.4 * p, abs=1e-14)
    assert back.r[1, 1] == pytest.approx(0.4 * p, abs=1e-14)
    assert there.h[1, 1] == 0.1
    assert back.dissipation[1] == pytest.approx(0.4 * p * 0.2, abs=1e-14)
    assert back.slip[0, 1] == pytest.approx(0.0, abs=1e-15)


def test_what_is_wrong_is_said():
    problem, load = one_node(1.0)
    start = initial_state(problem, np.zeros(2))
    with pytest.raises(InputError, match=r"b_end: is of shape \(3,\); expected \(2,\)"):
        follow(problem, start, np.zeros(3))
    with pytest.raises(InputError, match="b_end: has entries that are not finite"):
        follow(problem, start, np.array([np.nan, 0.0]))
    with pytest.raises(InputError, match=r"b: has shape \(1,\); expected \(2,\)"):
        initial_state(problem, np.zeros(1))
    with pytest.raises(InputError, match="motion: expected a gap >= 0"):
        initial_state(problem, np.zeros(2), motion=np.array([[-1.0], [0.0]]))
    with pytest.raises(InputError, match="motion: is not in equilibrium with b"):
        initial_state(problem, load(0.0, 1.0), motion=np.array([[1.0], [0.0]]))
    with pytest.raises(InputError, match="neither slip nor stick"):
        follow(dragged(np.inf), initial_state(dragged(np.inf), np.zeros(4)), np.array([-0.3, -0.3, 0.0, 0.1]))


def test_friction_that_was_lowered_below_what_a_pair_carries_is_refused():
    problem, load = one_node(1.0)
    pressed = follow(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.0)).end
    held = follow(problem, pressed, load(-1.0, 0.9)).end
    assert follow(replace(problem, friction=[0.95]), held, load(-1.0, 0.92)).followed
    with pytest.raises(InputError, match="start: pair 0 carries more friction than it can"):
        follow(replace(problem, friction=[0.5]), held, load(-1.0, 1.5))


def test_starts_and_paths_keep_to_the_limits_that_the_user_gives():
    few = SolverSettings(newton_steps=1, searched_steps=1, pivots_per_pair=(1,), tree_pairs=0, proximal_rounds=0)
    for directions in (2, 3):
        body = np.random.default_rng(1).normal(size=(6 * directions, 6 * directions))
        W = body @ body.T / (1.0 + np.linalg.norm(body @ body.T, 2))
        b = np.random.default_rng(2).normal(size=6 * directions)
        problem = ContactProblem.of(
            W=W, b=np.zeros_like(b), friction=np.full(6, 0.4), motions=np.zeros((6 * directions, 0)), scale=1.0
        )
        assert initial_state(problem, b).note == "the load presses: one increment from zero slip"
        with pytest.raises(SolveFailed, match="at the start of the history: no certified equilibrium"):
            initial_state(problem, b, settings=replace(few, swept_rounds=0))
    problem, load = one_node(0.3)
    exact = PathSettings(solver=SolverSettings(tolerance=1e-300))
    turned = load(-0.7, 0.1 / 3.0)
    lost = follow(problem, initial_state(problem, np.zeros(2)), turned, settings=exact)
    assert follow(problem, initial_state(problem, np.zeros(2)), turned).followed
    assert "fails its certificate" in lost.message


def test_states_are_read_only():
    problem, _ = one_node(1.0)
    state = initial_state(problem, np.zeros(2))
    with pytest.raises(ValueError, match="read-only"):
        state.h[0, 0] = 1.0
    assert replace(state, note="").note == ""


def test_slip_counts_where_more_than_rounding_is_borne():
    """Of a pair that nothing but rounding presses none does; friction that needs no pressure is enough."""
    problem = ContactProblem.of(
        W=0.5 * np.eye(6), b=np.zeros(6), friction=[0.3, 0.3, 0.3], motions=np.zeros((6, 0)), scale=1.0
    )
    still = initial_state(problem, np.zeros(6))
    pressed, rubbed = np.array([[1e-14, 1e-3, 0.0], [1e-14, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1e-3]])
    assert still.bears(pressed, problem.scale).tolist() == [False, True, False]
    assert still.bears(rubbed, problem.scale).tolist() == [False, False, True]
    assert replace(still, r=pressed).bears(rubbed, problem.scale).tolist() == [False, True, True]
    assert not still.bears(pressed, 1e12).any()
