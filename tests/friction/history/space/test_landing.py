# SPDX-License-Identifier: BSD-3-Clause
"""Jumps in space: one node by hand whatever way it is turned, the plane's jumps and landings, random bodies."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.friction.certificate import certify
from signorini.friction.history import PathSettings, follow, initial_state, land
from signorini.friction.history.rates import Rates
from signorini.friction.history.space.find_rates import find_rates
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, STICK
from tests.helpers.path_samples import Springs, stiff


def turned_node(mu, facets, angle, **bounds):
    """The node of the plane, stiffness 2, coupling -1, with its pull at an angle to the first tangent."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    K = turn @ np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 2.0]]) @ turn.T
    W = np.linalg.inv(K + np.eye(3))
    given = {"W": (W + W.T) / 2, "b": np.zeros(3), "friction": [mu], "motions": np.zeros((3, 0)), "scale": 4.0}
    return ContactProblem.of(**given, facets=facets, **bounds), lambda *force: W @ turn @ [*force, 0.0], turn


def pulled(mu, facets, angle, most=8.0, **bounds):
    problem, load, turn = turned_node(mu, facets, angle, **bounds)
    pressed = follow(problem, initial_state(problem, np.zeros(3)), load(-1.0, 0.0)).end
    return problem, turn, pressed, follow(problem, pressed, load(-1.0, most)), load


# a corner of the section along the pull, an edge across it, and the circle
WAYS = [(4, 0.0, 1.0), (4, np.pi / 2, 1.0), (8, np.pi / 4, 1.0), (0, 0.3, 1.0)]
WAYS += [
    (4, np.pi / 4, np.cos(np.pi / 4)),
    (8, -3 * np.pi / 8, np.cos(np.pi / 8)),
    (16, np.pi / 16, np.cos(np.pi / 16)),
]


@pytest.mark.parametrize(("facets", "angle", "share"), WAYS)
@pytest.mark.parametrize("f_t", [3.0, 5.0])
def test_one_node_jumps_and_lands_by_hand(f_t, facets, angle, share):
    """Sticks up to f_t = mu, slips back to f_t = 2, where it opens; in mu the section's share along the pull."""
    problem, turn, pressed, path, load = pulled(f_t / share, facets, angle)
    assert path.outcome == "jump"
    assert 8.0 * path.jump.factor == pytest.approx(f_t, abs=1e-12)
    assert path.jump.pairs == (0,)
    assert not path.jump.gross_sliding
    assert "combinations of states has rates" in path.jump.proof
    assert path.end.state.tolist() == [STICK]
    np.testing.assert_allclose(turn.T @ path.end.r[:, 0], [1.0, -f_t, 0.0], atol=1e-12)
    landing = land(problem, pressed, path)
    np.testing.assert_allclose(turn.T @ landing.state.h[:, 0], [(f_t - 2) / 3, (2 * f_t - 1) / 3, 0.0], atol=1e-12)
    assert landing.state.state.tolist() == [OPEN]
    assert landing.state.dissipation == pytest.approx(0.5 * f_t, abs=1e-12)
    on = follow(problem, landing.state, load(-1.0, 8.0))
    assert on.followed
    assert not on.events
    np.testing.assert_allclose(turn.T @ on.end.h[:, 0], [2.0, 5.0, 0.0], atol=1e-11)


@pytest.mark.parametrize(("facets", "angle"), [(4, np.pi / 2), (8, np.pi / 4), (0, 0.3)])
def test_what_lies_within_rounding_is_no_proof(facets, angle):
    """As in the plane: along the edge of friction there are rates, beyond it none, by what the pull has too much."""
    problem, load, _ = turned_node(3.0, facets, angle)
    pressed = follow(problem, initial_state(problem, np.zeros(3)), load(-1.0, 0.0)).end
    edge = follow(problem, pressed, load(-1.0, 3.0)).end
    assert isinstance(find_rates(replace(problem, b=load(-1.0, 3.0)), edge, 1e-7), Rates)
    for beyond in (1e-8, 1e-7, 1e-4, 0.1):
        none = find_rates(replace(problem, b=load(-1.0, 3.0 + beyond)), edge, 1e-7)
        assert none.proved == (beyond > 1e-5)
        assert none.proved == ("no proof" not in none.proof)
        if none.proved:
            assert none.margin == pytest.approx(beyond / 7.5, rel=0.3)
            assert f"lacks {none.margin:.2g} of the data" in none.proof


@pytest.mark.slow
@pytest.mark.parametrize("f_t", [2.02, 3.0, 5.0])
@pytest.mark.parametrize("part", [0.002, 0.03, 0.3, 0.97])
@pytest.mark.parametrize("number", [1, 4, 16])
def test_increments_pass_over_no_jump_wherever_and_how_large_it_is(number, part, f_t):
    """On the circle, at a part of the way; the jump of f_t = 2.02 is one of a hundredth of the force."""
    problem, load, _ = turned_node(f_t, 0, 0.3)
    pressed = follow(problem, initial_state(problem, np.zeros(3)), load(-1.0, 0.0)).end
    settings = PathSettings(shortest=1.0 / number, turn=0.04 / number**0.5)
    path = follow(problem, pressed, load(-1.0, f_t / part), settings=settings)
    assert path.outcome == "jump"
    assert path.jump.factor == pytest.approx(part, abs=1e-9)


def test_below_the_critical_friction_nothing_jumps():
    for facets, angle, share in WAYS:
        path = pulled(1.9 / share, facets, angle)[3]
        assert path.followed
        assert [event.what for event in path.events] == ["slips", "opens"]


def plane_and_space(seed, pairs, mu, facets):
    """A random body of the plane, and the same with a second tangent that nothing couples; at every jump both."""
    rng = np.random.default_rng(seed)
    springs = Springs(stiff(seed, pairs), np.full(pairs, mu))
    W = 0.5 * np.eye(3 * pairs)
    W[: 2 * pairs, : 2 * pairs] = springs.problem.W
    wide = ContactProblem.of(
        W=W,
        b=np.zeros(3 * pairs),
        friction=springs.problem.friction,
        motions=np.zeros((3 * pairs, 0)),
        scale=1.0,
        facets=facets,
    )
    flat = initial_state(springs.problem, springs.load(np.zeros(2 * pairs)), motion=springs.gap.reshape(2, -1))
    none = np.zeros(pairs)
    deep = initial_state(wide, np.append(flat.b, none), motion=np.stack([*flat.h, none]))
    for _ in range(3):
        F = rng.normal(size=2 * pairs)
        F[:pairs] -= 1.0
        b = springs.load(F)
        one, two = follow(springs.problem, flat, b), follow(wide, deep, np.append(b, none))
        landed = (None, None) if one.followed else (land(springs.problem, flat, one), land(wide, deep, two))
        yield one, two, landed
        if not one.followed:
            return
        flat, deep = one.end, two.end


@pytest.mark.parametrize(
    ("facets", "pairs", "seeds"), [(4, 1, (12, 20)), (8, 3, (7, 22, 26)), (0, 3, (7, 51)), (8, 6, (8,))]
)
def test_the_jumps_of_the_plane_are_those_of_space(facets, pairs, seeds):
    for seed in seeds:
        *_, (one, two, (flat, deep)) = plane_and_space(seed, pairs, 4.0, facets)
        assert one.outcome == two.outcome == "jump"
        assert two.jump.factor == pytest.approx(one.jump.factor, abs=1e-9)
        assert two.jump.pairs == one.jump.pairs
        assert flat is not None
        np.testing.assert_allclose(deep.state.h[:2], flat.state.h, atol=1e-8)
        np.testing.assert_allclose(deep.state.dissipation, flat.state.dissipation, atol=1e-8)


def stiff_in_space(seed, pairs):
    """A random stiffness of a held interface with three rows a pair."""
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(3 * pairs, 6 * pairs))
    return B @ B.T / (6 * pairs) + np.diag(rng.uniform(0.2, 1.0, 3 * pairs))


# on the circle the curve behind the jump turns round while the pair slips on
LANDS = [(1, 4, 4.0, 8), (1, 4, 4.0, 13), (2, 8, 4.0, 6), (5, 8, 3.0, 0), (1, 0, 3.0, 13)]


@pytest.mark.slow
@pytest.mark.parametrize(("pairs", "facets", "mu", "seed"), LANDS)
def test_landings_are_equilibria_where_less_is_stored_than_the_loads_gave(pairs, facets, mu, seed):
    S = stiff_in_space(seed, pairs)
    W = np.linalg.inv(S + np.eye(3 * pairs))
    none = np.zeros(3 * pairs)
    friction = np.full(pairs, mu)
    problem = ContactProblem.of(
        W=(W + W.T) / 2, b=none, friction=friction, motions=np.zeros((3 * pairs, 0)), scale=1.0, facets=facets
    )
    state, before = initial_state(problem, none, motion=problem.by_pair(none)), none
    rng = np.random.default_rng((seed, 1))
    for _ in range(4):
        F = rng.normal(size=3 * pairs)
        F[:pairs] -= 1.0
        segment = follow(problem, state, W @ F)
        if not segment.followed:
            break
        state, before = segment.end, F
    assert segment.outcome == "jump"
    limit, landed = segment.end, land(problem, state, segment).state
    origin = np.concatenate([np.zeros((1, pairs)), landed.h[1:]])
    b = limit.b + problem.W @ origin.ravel() - origin.ravel()
    assert certify(replace(problem, b=b), landed.r - (landed.h - origin)) < 1e-10
    end, start = landed.h.ravel(), limit.h.ravel()
    force, moved = before + segment.jump.factor * (F - before), end - start
    stored = 0.5 * (end @ S @ end - start @ S @ start)
    assert (landed.dissipation >= limit.dissipation - 1e-12).all()
    assert force @ moved > stored


@pytest.mark.parametrize(("pairs", "mu", "seed"), [(1, 3.0, 8), (3, 4.0, 18)])
@pytest.mark.parametrize("behind", [0.0, 0.9])
def test_increments_find_the_random_jumps_that_every_event_finds(behind, pairs, mu, seed):
    """On the circle, also where the way begins shortly before the jump."""
    S, none = stiff_in_space(seed, pairs), np.zeros(3 * pairs)
    W = np.linalg.inv(S + np.eye(3 * pairs))
    given = {"W": (W + W.T) / 2, "b": none, "friction": np.full(pairs, mu), "motions": np.zeros((3 * pairs, 0))}
    problem, rng = ContactProblem.of(**given, scale=1.0), np.random.default_rng((seed, 1))
    state, fine = initial_state(problem, none, motion=problem.by_pair(none)), PathSettings(turn=0.1)
    for _ in range(4):
        F = rng.normal(size=3 * pairs)
        F[:pairs] -= 1.0
        segment = follow(problem, state, W @ F, settings=fine)
        if not segment.followed:
            break
        state = segment.end
    assert segment.outcome == "jump"
    at = behind * segment.jump.factor
    begin = follow(problem, state, (1.0 - at) * state.b + at * (W @ F), settings=fine).end
    for number in (1, 4, 16):
        coarse = PathSettings(shortest=1.0 / number, turn=0.04 / number**0.5)
        path = follow(problem, begin, W @ F, settings=coarse)
        assert path.outcome == "jump"
        assert at + (1.0 - at) * path.jump.factor == pytest.approx(segment.jump.factor, abs=1e-6)
