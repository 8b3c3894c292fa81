# SPDX-License-Identifier: BSD-3-Clause
"""Where a history goes on after a jump: by hand for one node; an equilibrium that energy allows for many."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.friction.certificate import certify
from signorini.friction.history import follow, initial_state, land
from signorini.law.states import OPEN, SLIP_PLUS
from tests.helpers.path_samples import EqualBodies, Springs, one_node, stiff


def pulled(mu, most=4.0):
    problem, load = one_node(mu)
    pressed = follow(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.0)).end
    return problem, load, pressed, follow(problem, pressed, load(-1.0, most))


@pytest.mark.parametrize("mu", [2.5, 3.0, 7.0])
def test_one_node_leaves_the_wall(mu):
    """Sticks up to f_t = mu (here at most 4); slip leads back to f_t = 2, where it opens, and open forward again."""
    problem, load, pressed, path = pulled(mu, 8.0)
    landing = land(problem, pressed, path)
    f_t = mu
    np.testing.assert_allclose(landing.state.h[:, 0], [(f_t - 2) / 3, (2 * f_t - 1) / 3], rtol=0, atol=1e-13)
    assert landing.state.state.tolist() == [OPEN]
    # friction mu (2 - f_t(u)) with u from 0 to 1 on the way back: the force falls linearly from mu to 0
    assert landing.state.dissipation == pytest.approx(0.5 * mu, abs=1e-12)
    on = follow(problem, landing.state, load(-1.0, 8.0))
    assert on.followed
    assert not on.events
    np.testing.assert_allclose(on.end.h[:, 0], [2.0, 5.0], rtol=0, atol=1e-12)


def test_the_catalogue_with_its_energy():
    """mu = 3: from stick at f_t = 3 to (gap, u_t) = (1/3, 5/3); friction takes 1.5, 5/6 are set free."""
    problem, _, pressed, path = pulled(3.0)
    landing = land(problem, pressed, path)
    np.testing.assert_allclose(landing.state.h[:, 0], [1 / 3, 5 / 3], rtol=0, atol=1e-13)
    assert landing.state.dissipation == pytest.approx(1.5, abs=1e-13)
    K, force, u = np.array([[2.0, -1.0], [-1.0, 2.0]]), np.array([-1.0, 3.0]), landing.state.h[:, 0]
    assert force @ u - 0.5 * u @ K @ u - 1.5 == pytest.approx(5 / 6, abs=1e-12)


def test_back_down_from_the_landing_is_another_branch():
    problem, load, pressed, path = pulled(3.0)
    away = land(problem, pressed, path).state
    down = follow(problem, away, load(-1.0, 0.0))
    # open down to f_t = 2, where it touches at u_t = 1 without force; then it slips back, 2 u_t - f_t = 3 (1 - u_t)
    assert [event.what for event in down.events] == ["closes"]
    assert 3.0 * (1.0 - down.events[0].factor) == pytest.approx(2.0, abs=1e-12)
    assert down.end.state.tolist() == [SLIP_PLUS]
    np.testing.assert_allclose([*down.end.h[:, 0], *down.end.r[:, 0]], [0.0, 0.6, 0.4, 1.2], rtol=0, atol=1e-12)


def test_gross_sliding_lands_nowhere():
    body = EqualBodies(9, 0.5)
    press, pull = body.run((0.6, 0.0), (0.6, 0.4))
    assert pull.jump.gross_sliding
    assert land(body.problem, press.end, pull) is None


def histories(seed, pairs, mu):
    """Random loads one after the other; yields (problem, start, segment, its nodal forces) at every jump, and lands."""
    rng = np.random.default_rng(seed)
    springs = Springs(stiff(seed, pairs), np.full(pairs, mu))
    state, before = (
        initial_state(springs.problem, springs.load(np.zeros(2 * pairs)), motion=springs.gap.reshape(2, -1)),
        None,
    )
    before = np.zeros(2 * pairs)
    for _ in range(3):
        F = rng.normal(size=2 * pairs)
        F[:pairs] -= 1.0
        for _ in range(20):
            segment = follow(springs.problem, state, springs.load(F))
            if segment.followed:
                break
            landing = land(springs.problem, state, segment)
            before = before + segment.jump.factor * (F - before)
            yield springs, segment.end, landing, before
            if landing is None:
                return
            state = landing.state
        state, before = segment.end, F


def test_landings_are_equilibria_where_less_is_stored_than_the_loads_gave():
    landed, nowhere = 0, 0
    for pairs, mu, seeds in ((1, 4.0, 60), (3, 4.0, 60), (6, 4.0, 20)):
        for seed in range(seeds):
            for springs, limit, landing, F in histories(seed, pairs, mu):
                if landing is None:
                    nowhere += 1
                    continue
                landed += 1
                state = landing.state
                origin = np.stack([np.zeros(pairs), state.h[1]])
                b = limit.b + springs.problem.W @ origin.ravel() - origin.ravel()
                assert certify(replace(springs.problem, b=b), state.r - (state.h - origin)) < 1e-10
                work = F @ (state.h - limit.h).ravel()
                stored = springs.strain_energy(state) - springs.strain_energy(limit)
                assert (state.dissipation >= limit.dissipation - 1e-12).all()
                assert work > stored
    assert landed >= 10
    assert nowhere <= landed // 5
