# SPDX-License-Identifier: BSD-3-Clause
"""Responses of neighbouring states from one inverse are those of each state by itself, and their transposes."""

import numpy as np
import pytest

from signorini.derivative.state_blocks import StateBlocks
from signorini.friction.history.plane.responses import Responses
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK


def problem_and_states(pairs=20, count=60):
    """Floating bodies, and states of which each differs from the one before in a pair or two."""
    rng = np.random.default_rng(5)
    rigid = np.zeros((2 * pairs, 1))
    rigid[:pairs] = pairs**-0.5
    factor = rng.standard_normal((2 * pairs, 2 * pairs))
    factor -= rigid @ (rigid.T @ factor)
    W = factor @ factor.T
    W = 0.5 * W / np.linalg.eigvalsh(W).max() + rigid @ rigid.T
    problem = ContactProblem.of(W=W, b=np.zeros(2 * pairs), friction=np.full(pairs, 0.2), motions=rigid, scale=1.0)
    state = rng.choice([OPEN, STICK, SLIP_PLUS, SLIP_MINUS], pairs)
    state[:2] = STICK
    states = []
    for _ in range(count):
        state = state.copy()
        which = rng.integers(2, pairs, rng.integers(1, 3))
        state[which] = rng.choice([OPEN, STICK, SLIP_PLUS, SLIP_MINUS], len(which))
        states.append(state)
    return problem, states, rng


@pytest.mark.parametrize("looks_ahead", [True, False])
def test_responses_are_those_of_each_state(looks_ahead):
    problem, states, rng = problem_and_states()
    blocks, one_by_one = StateBlocks(problem), Responses(problem)
    for i, state in enumerate(states):
        if looks_ahead and not blocks.covers(state):
            blocks.ahead(states[i:])
        free = one_by_one.free(rng.standard_normal(2 * problem.pairs))
        h, r = blocks.respond(state, free)
        wanted = one_by_one.respond(state, free)
        size = max(np.abs(part).max() for part in wanted)
        assert np.abs(h - wanted[0]).max() < 1e-11 * size
        assert np.abs(r - wanted[1]).max() < 1e-11 * size
        of_h, of_r = rng.standard_normal((2, *h.shape))
        back = blocks.respond_transposed(state, of_h, of_r)
        assert back @ free == pytest.approx(np.vdot(of_h, h) + np.vdot(of_r, r), rel=1e-9)
        none = np.where(np.stack([state != OPEN, state == STICK]), 0.0, of_h)
        assert np.array_equal(blocks.respond_transposed(state, none - of_h, 0.0 * of_r), np.zeros_like(back))


def test_one_inverse_serves_many_states():
    problem, states, _ = problem_and_states()
    blocks, moves = StateBlocks(problem), 0
    for i, state in enumerate(states):
        if not blocks.covers(state):
            blocks.ahead(states[i:])
            moves += 1
    assert moves < len(states) / 6
