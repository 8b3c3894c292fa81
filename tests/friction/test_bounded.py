# SPDX-License-Identifier: BSD-3-Clause
"""Friction with adhesion and a shear limit on the condensed interface: known laws, every state, proofs, paths."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from signorini.errors import InputError
from signorini.friction.history import follow as follow_load
from signorini.friction.history import initial_state, land
from signorini.friction.newton import by_states, in_states
from signorini.friction.plane.covering import follow_covering
from signorini.friction.plane.state_tree import search_states
from signorini.friction.plane.walls import beyond, constant, jacobian, placed
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import pulled_away
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import all_solutions, always_unique
from signorini.gallery.hard import hard_problem
from signorini.law.bound import ADHESION_SLOPE, FrictionBound
from signorini.law.states import OPEN
from tests.helpers.contact_samples import HELD, block_on_floor, for_all, random_problem
from tests.helpers.path_samples import EqualBodies, Springs, increments, loads_at_breakpoints, one_node, stiff

SEEDS = st.integers(0, 10**6)


def mixed(problem, seed):
    """The same with a law of every kind."""
    rng, n = np.random.default_rng((seed, 1)), problem.pairs
    mu = rng.choice([0.0, 0.2, 0.7, 1.5, 3.0, np.inf], n)
    adhesion = np.where(np.isinf(mu), 0.0, rng.choice([0.0, 0.0, 0.05, 0.3], n))
    return replace(problem, friction=mu, adhesion=adhesion, limit=rng.choice([0.05, 0.3, 1.0, np.inf], n))


@for_all(examples=50, seed=SEEDS)
def test_the_bound_is_what_it_says(seed):
    rng = np.random.default_rng(seed)
    mu = rng.choice([0.0, 0.1, 3.0, np.inf], 40)
    c, L = rng.choice([0.0, 1e-3, 0.5, 2.0], 40), rng.choice([1e-3, 0.5, 0.50005, 2.0, np.inf], 40)
    bound = FrictionBound.of(mu, adhesion=c, limit=L)
    p = 10.0 ** rng.uniform(-7, 3, 40)
    sticks = np.where(np.isinf(L), 1e6, ADHESION_SLOPE) * p
    expected = np.minimum(
        np.where(np.isinf(mu), sticks, np.nan_to_num(mu, posinf=0) * p + np.minimum(ADHESION_SLOPE * p, c)), L
    )
    np.testing.assert_allclose(bound.at(p), expected, rtol=1e-12)
    for code, sign in ((2, 1.0), (3, -1.0)):
        state = bound.coded(np.full(40, code), p)
        np.testing.assert_allclose(bound.slope(state) * p + bound.start(state), sign * expected, rtol=1e-12)


def test_the_equation_is_piecewise_linear_and_its_walls_are_where_the_state_changes():
    problem = mixed(random_problem(3, 6, HELD, 1.0), 3)
    G, rng = np.eye(12) - problem.W, np.random.default_rng(0)
    for _ in range(40):
        y = rng.normal(size=(2, 6)) * 10.0 ** rng.uniform(-4, 1)
        h, r = problem.law.split(y)
        state = problem.law.states(y)
        J = jacobian(G, problem.W, np.abs(problem.bound.slope(state)), state)
        known = constant(G, problem.W, problem.bound, state)
        moved = G @ h.ravel() - problem.W @ r.ravel()
        np.testing.assert_allclose(J @ y.ravel() + known, moved, atol=1e-12 * np.abs(J).max())
        wall, offset = placed(state, problem.bound, problem.law.closed)
        room = wall[:, 0] * y[0] + wall[:, 1] * y[1] - offset
        assert room.min() >= -1e-14 * np.abs(y).max()
        for slot, pair in np.argwhere(wall.any(axis=1)):
            across, back = beyond(int(state[pair]), int(slot), float(y[1, pair]), int(problem.law.closed[pair]))
            other = state.copy()
            other[pair] = across
            mirror, at = placed(other, problem.bound, problem.law.closed)
            np.testing.assert_allclose(mirror[back, :, pair], -wall[slot, :, pair], atol=1e-12)
            np.testing.assert_allclose(at[back, pair], -offset[slot, pair], atol=1e-12)


@for_all(examples=25, seed=SEEDS, pairs=st.sampled_from([1, 2]))
def test_every_method_finds_a_solution_and_indices_sum_to_one(seed, pairs):
    problem = mixed(random_problem(seed, pairs, HELD, 1.0), seed)
    known = all_solutions(problem)
    index = [in_states(problem, problem.law.states(y)).index for y in known]
    assert sum(index) == 1
    assert len(known) == 1 or not always_unique(problem)
    result = solve_contact(problem)
    assert result.solved
    found = [result.y]
    for way in ("open", "press"):
        end = follow_covering(problem, way, budget=200)
        assert end.end == "solution"
        found.append(by_states(problem, end.state, near=end.y).y)
    found.append(by_states(problem, search_states(problem).state).y)
    assert all(min(np.abs(y - other).max() for other in known) < 1e-8 for y in found)


@for_all(examples=25, seed=SEEDS, motions=st.sampled_from([1, 2]))
def test_floating_bodies_are_solved_or_proved_to_leave(seed, motions):
    problem = mixed(random_problem(seed, 2, motions, 1.0), seed)
    known, result = all_solutions(problem), solve_contact(problem)
    assert result.outcome == ("solved" if known else "no_equilibrium")
    assert not known or pulled_away(problem) is None


def test_a_limit_is_what_the_loads_pull_away_at():
    """Four pairs that carry 0.1 each, however hard they are pressed."""
    for push, held in ((0.39, True), (0.41, False)):
        problem = replace(block_on_floor(4, (-10.0, push, 0.0)), limit=np.full(4, 0.1))
        assert solve_contact(replace(problem, limit=None)).solved
        assert solve_contact(problem).solved == held
        pull = pulled_away(problem)
        assert (pull is None) == held
        if pull is not None:
            np.testing.assert_allclose(pull.motion[4:], 1.0, atol=1e-9)


@pytest.mark.slow
def test_the_hard_set_with_limits_and_adhesion_is_answered():
    for case in map(hard_problem, range(20)):
        plain, rng = solve_contact(case.first), np.random.default_rng(case.first.pairs)
        size = plain.normal_force.mean() if plain.solved and plain.normal_force.any() else case.first.scale
        n = case.first.pairs
        result = solve_contact(
            replace(
                case.first,
                friction=np.minimum(case.first.friction, 8.0),
                adhesion=size * rng.choice([0.0, 0.1, 1.0], n),
                limit=size * rng.choice([0.1, 1.0, np.inf], n),
            )
        )
        assert result.outcome != "not_found" or result.escape is not None, case.name
        assert result.solved or case.first.floating, case.name


def pressed_bodies(seed, n=8):
    """A random body whose pairs are all pressed hard, dragged to and fro; and its bounds."""
    problem = random_problem(seed, n, HELD, np.inf)
    rng = np.random.default_rng((seed, 2))
    r = np.append(rng.uniform(20.0, 30.0, n), np.zeros(n))
    problem = replace(problem, b=-problem.W @ r + rng.normal(size=2 * n))
    return problem, rng.uniform(0.05, 1.0, n)


@for_all(examples=20, seed=SEEDS)
def test_tresca_minimises_a_convex_energy(seed):
    """Bodies that stay pressed: r minimises ``r'A r / 2 + c'r`` over p >= 0, |r_t| <= limit."""
    problem, limit = pressed_bodies(seed)
    result = solve_contact(replace(problem, limit=limit))
    A, c = problem.image.A, problem.free_motion(problem.b)
    L = np.linalg.cholesky(A)
    box = (np.append(np.zeros(8), -limit), np.append(np.full(8, np.inf), limit))
    least = lsq_linear(L.T, -np.linalg.solve(L, c), bounds=box, tol=1e-14)
    np.testing.assert_allclose(result.normal_force, least.x[:8], atol=1e-7)
    np.testing.assert_allclose(result.tangential_force[0], least.x[8:], atol=1e-7)


@for_all(examples=10, seed=SEEDS)
def test_tresca_in_the_plane_and_in_space_is_one_law(seed):
    """In space Tresca's bound holds whatever the normal force; the second tangents are locked."""
    problem, limit = pressed_bodies(seed)
    wide = np.zeros((24, 24))
    wide[:16, :16] = problem.W
    solid = ContactProblem.of(
        W=wide, b=np.append(problem.b, np.zeros(8)), friction=limit, motions=np.zeros((24, 0)), scale=1.0,
        tresca=np.ones(8, dtype=bool),
    )  # fmt: skip
    flat, deep = solve_contact(replace(problem, limit=limit)), solve_contact(solid)
    np.testing.assert_allclose(deep.normal_force, flat.normal_force, atol=1e-9)
    np.testing.assert_allclose(deep.tangential_force[0], flat.tangential_force[0], atol=1e-9)
    assert (flat.state > 1).any()


@for_all(examples=10, seed=SEEDS, motions=st.sampled_from([0, 2]))
def test_a_limit_out_of_reach_is_none(seed, motions):
    problem = random_problem(seed, 6, motions, 0.7)
    one, two = (solve_contact(replace(problem, limit=limit)) for limit in (None, np.full(6, 1e12)))
    assert one.outcome == two.outcome
    if one.solved:
        np.testing.assert_allclose(two.y, one.y, atol=1e-12)


def pulled(problem, load, most=4.0):
    pressed = follow_load(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.0)).end
    return pressed, follow_load(problem, pressed, load(-1.0, most))


def test_one_node_with_a_limit_by_hand():
    """mu = 1, limit 0.4: slips at 0.4; p = 1 - s falls to the kink 0.4 at s = 0.6; opens at s = 1."""
    problem, load = one_node(1.0)
    pressed, path = pulled(replace(problem, limit=np.array([0.4])), load)
    assert path.followed
    assert [event.what for event in path.events] == ["slips", "kinks", "opens"]
    np.testing.assert_allclose([4 * event.factor for event in path.events], [0.4, 1.6, 2.0], rtol=0, atol=1e-13)
    np.testing.assert_allclose([event.state.h[1, 0] for event in path.events], [0.0, 0.6, 1.0], rtol=0, atol=1e-13)
    np.testing.assert_allclose(path.end.h[:, 0], [2 / 3, 7 / 3], rtol=0, atol=1e-13)
    assert path.end.dissipation == pytest.approx(0.4 * 0.6 + 0.5 * 0.4 * 0.4, abs=1e-13)
    back = follow_load(replace(problem, limit=np.array([0.4])), path.events[1].state, load(-1.0, -0.5))
    assert [event.what for event in back.events] == ["sticks", "slips"]
    # sticks at s = 0.6 under p = 0.4, r_t = 1.2 - f_t: slips back where that is 0.4, on either branch of the bound
    assert 1.6 - 2.1 * back.events[1].factor == pytest.approx(0.8, abs=1e-13)
    assert pressed.r[:, 0].tolist() == pytest.approx([1.0, 0.0])


def test_one_node_with_adhesion_by_hand():
    """mu = 0.5, adhesion 0.2: slips at 0.7; where p has fallen to 1e-3 c adhesion lets go: the node jumps."""
    problem, load = one_node(0.5)
    problem = replace(problem, adhesion=np.array([0.2]))
    pressed, path = pulled(problem, load)
    assert [event.what for event in path.events] == ["slips"]
    assert 4 * path.events[0].factor == pytest.approx(0.7, abs=1e-13)
    assert path.outcome == "jump"
    left = 0.2 / ADHESION_SLOPE
    assert 4 * path.jump.factor == pytest.approx(0.7 + 1.5 * (1.0 - left), abs=1e-12)
    np.testing.assert_allclose(path.end.r[:, 0], [left, -0.2 - 0.5 * left], rtol=0, atol=1e-12)
    landing = land(problem, pressed, path)
    f = 4 * path.jump.factor
    assert landing.state.state.tolist() == [OPEN]
    np.testing.assert_allclose(landing.state.h[:, 0], [(f - 2) / 3, (2 * f - 1) / 3], rtol=0, atol=1e-12)


def test_slip_that_presses_comes_to_the_limit():
    """The other way round the coupling presses: friction grows with the slip until the limit is reached."""
    problem, load = one_node(0.5)
    problem = replace(problem, limit=np.array([0.8]))
    pressed = follow_load(problem, initial_state(problem, np.zeros(2)), load(-1.0, 0.0)).end
    path = follow_load(problem, pressed, load(-1.0, -4.0))
    # p = 1 + s, slip s against 0.5 p = 0.8 at s = 0.6: 2 s = f - 0.8
    assert [event.what for event in path.events] == ["slips", "kinks"]
    np.testing.assert_allclose([4 * event.factor for event in path.events], [0.5, 2.0], rtol=0, atol=1e-13)
    np.testing.assert_allclose(path.end.h[:, 0], [0.0, -1.6], rtol=0, atol=1e-13)
    np.testing.assert_allclose(path.end.r[:, 0], [2.6, 0.8], rtol=0, atol=1e-13)


def histories(seed, pairs, law):
    """A random body with gaps under random forces, one segment after the other, with bounds of every size."""
    rng = np.random.default_rng((seed, pairs))
    gap = rng.uniform(0.0, 0.3, pairs) * (rng.random(pairs) < 0.7)
    body = Springs(stiff((seed, pairs), pairs), rng.choice([0.1, 0.3, 0.6], pairs), gap)
    press = np.append(np.ones(pairs), np.zeros(pairs))
    forces = [rng.normal(size=2 * pairs) - press for _ in range(3)]
    bounds = {"limit": rng.choice([0.01, 0.05, 0.2, np.inf], pairs)}
    if law == "adhesion":
        bounds = {"adhesion": rng.choice([0.0, 0.02, 0.1], pairs), "limit": 2.0 * bounds["limit"]}
    body.problem = replace(body.problem, **bounds)
    return body, forces


@pytest.mark.slow
@for_all(examples=20, seed=SEEDS, pairs=st.sampled_from([1, 3, 6, 15]), law=st.sampled_from(["limit", "adhesion"]))
def test_paths_obey_law_and_energy_and_increments_at_their_events_are_the_same(seed, pairs, law):
    body, forces = histories(seed, pairs, law)
    segments = body.run(*forces)
    assert all(segment.outcome in ("followed", "jump") for segment in segments)
    assert max(segment.residual for segment in segments) < 1e-10
    for segment in segments:
        for piece in segment.pieces:
            gap, (p, q) = piece.h[0], piece.r
            assert np.abs(gap * p).max() == 0
            assert (np.abs(q) <= body.problem.bound.at(p) * (1 + 1e-14)).all()
    assert law == "adhesion" or segments[-1].followed
    if not segments[-1].followed:
        return
    end = segments[-1].end
    assert body.work(segments, forces) == pytest.approx(body.strain_energy(end) + end.dissipation.sum(), abs=1e-11)
    if law == "limit":  # with adhesion an increment may have more than one solution
        ends, before = [], body.load(np.zeros(2 * pairs))
        for segment, F in zip(segments, forces, strict=True):
            ends += loads_at_breakpoints(segment, before, body.load(F))
            before = body.load(F)
        start = initial_state(body.problem, body.load(np.zeros(2 * pairs)), motion=body.gap.reshape(2, -1))
        h, r = increments(body.problem, start, ends)
        np.testing.assert_allclose(end.h, h, rtol=0, atol=1e-11)
        np.testing.assert_allclose(end.r, r, rtol=0, atol=1e-11)


def test_wrong_bounds_are_refused():
    problem = random_problem(0, 2, HELD, 0.3)
    with pytest.raises(InputError, match=r"limit: has shape \(3,\)"):
        replace(problem, limit=np.ones(3))
    with pytest.raises(InputError, match="adhesion: has negative entries"):
        replace(problem, adhesion=np.array([0.1, -0.1]))


@pytest.mark.parametrize("friction", [0.5, np.inf])
def test_equal_bodies_slide_when_every_pair_is_at_its_bound(friction):
    """A_nt = 0: shear leaves the pressures alone, and Q reaches exactly the sum of the bounds."""
    body = EqualBodies(12, friction)
    limit = np.full(12, 0.02)
    body.problem = replace(body.problem, limit=limit)
    pressed, sheared = body.run((0.6, 0.0), (0.6, 1.0))
    p = pressed.end.r[0]
    most = np.minimum(np.minimum(friction, ADHESION_SLOPE) * p, limit)
    assert sheared.outcome == "jump"
    assert sheared.jump.gross_sliding
    assert sheared.jump.margin > 0.0
    assert "nothing takes" in sheared.jump.proof
    assert sheared.jump.factor == pytest.approx(most.sum(), abs=1e-12)
    np.testing.assert_allclose(sheared.end.r[0], p, rtol=0, atol=1e-12)
    np.testing.assert_allclose(np.abs(sheared.end.r[1]), most, rtol=0, atol=1e-12)
    at_limit = most >= limit
    assert at_limit.any()
    assert np.isinf(friction) or not at_limit[p > 0].all()
