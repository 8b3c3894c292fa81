# SPDX-License-Identifier: BSD-3-Clause
"""The inverse that changes by rank one, against states solved afresh."""

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.friction.history.plane.responses import Responses
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.friction.newton import in_states, y_in_states
from signorini.law.states import OPEN, STICK
from tests.helpers.contact_samples import block_on_floor, for_all, random_problem


def answer(responses, state, b):
    """Motions and forces under a load, refined."""
    return responses.balanced(state, b, *responses.respond(state, responses.free(b)))


@for_all(examples=25, seed=st.integers(0, 10**6), motions=st.sampled_from([0, 2]))
def test_a_walk_over_states_ends_where_a_fresh_start_does(seed, motions):
    rng = np.random.default_rng(seed)
    problem = random_problem(seed, 12, motions, friction=0.5)
    responses, state = Responses(problem), np.full(12, STICK)
    for _ in range(60):
        state = state.copy()
        state[rng.integers(12, size=2)] = rng.integers(0, 4, size=2)
        fresh = in_states(problem, state)
        if not fresh.index:
            continue
        y = y_in_states(fresh, np.zeros((2, 12)))
        h, r = answer(responses, state, problem.b)
        np.testing.assert_allclose(r - h, y, rtol=0, atol=1e-9 * np.abs(y).max())
        assert np.abs(problem.misfit(h, r)).max() < 1e-12 * np.abs(y).max()
    assert responses.inverse.factorisations < 10
    assert responses.inverse.updates > 60


def test_an_inverse_that_has_lost_digits_still_responds_to_rounding():
    problem = random_problem(3, 12, 0, friction=0.5)
    state, free = np.full(12, STICK), Responses(problem).free(problem.b)
    exact = Responses(problem).respond(state, free)[1]
    responses = Responses(problem)
    responses.respond(state, free)
    responses.inverse.matrix[:] *= 1.0 + 1e-8 * np.random.default_rng(5).standard_normal(responses.inverse.matrix.shape)
    lost = np.abs(-responses.inverse.matrix @ free[responses.inverse.unknowns] - exact.ravel()).max()
    assert lost > 1e-10 * np.abs(exact).max()
    np.testing.assert_allclose(responses.respond(state, free)[1], exact, rtol=0, atol=1e-13 * np.abs(exact).max())


def test_a_state_that_holds_nothing_is_singular():
    problem = block_on_floor(4, (-1.0, 0.1, 0.0))
    responses = Responses(problem)
    for state in (np.full(4, OPEN), np.full(4, 3), np.array([STICK, OPEN, OPEN, OPEN])):
        with pytest.raises(SingularState):
            answer(responses, state, problem.b)
    h, r = answer(responses, np.full(4, STICK), problem.b)
    assert np.abs(problem.misfit(h, r)).max() < 1e-14


def test_from_a_state_that_holds_to_one_that_does_not():
    problem = block_on_floor(4, (-1.0, 0.1, 0.0))
    responses = Responses(problem)
    answer(responses, np.full(4, STICK), problem.b)
    with pytest.raises(SingularState):
        answer(responses, np.full(4, 3), problem.b)
    _, r = answer(responses, np.full(4, STICK), problem.b)
    assert r[0].sum() == pytest.approx(1.0, abs=1e-14)
