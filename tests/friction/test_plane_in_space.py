# SPDX-License-Identifier: BSD-3-Clause
"""A problem in space whose second tangents have nothing to do answers as the plane's: forces, slips, states, proofs.

There are two such problems: supports lock the second tangent of every pair (zero rows of W), or bodies move along it,
stiff or soft, under no load and without a say in the other two directions.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.errors import InputError
from signorini.friction.certificate import certify
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import mu_low
from signorini.law.states import SLIP
from tests.helpers.contact_samples import HELD, block_on_floor, for_all, random_problem

SEEDS = st.integers(0, 10**6)
PAIRS = st.sampled_from([1, 2, 3, 6, 10])
SECOND = st.sampled_from(["locked", "idle"])
LAWS = st.sampled_from(["coulomb", "limit", "adhesion", "dragged"])
ROUNDING = 1e-9  # of the data: both answers are certified to 1e-10


def in_space(problem, second, seed=0):
    """The problem with a second tangent at every pair, locked by supports or idle."""
    n, rng = problem.pairs, np.random.default_rng((seed, 2))
    W = np.zeros((3 * n, 3 * n))
    W[: 2 * n, : 2 * n] = problem.W
    if second == "idle":
        Q, _ = np.linalg.qr(rng.normal(size=(n, n)))
        W[2 * n :, 2 * n :] = (Q * rng.uniform(0.05, 0.95, n)) @ Q.T
    return ContactProblem.of(
        W=(W + W.T) / 2,
        b=np.append(problem.b, np.zeros(n)),
        friction=problem.friction,
        motions=np.concatenate([problem.motions, np.zeros((n, problem.motions.shape[1]))]),
        scale=problem.scale,
        adhesion=problem.adhesion,
        limit=problem.limit,
    )


def with_law(seed, pairs, motions, friction, law):
    """A random problem with bounds on its friction, or with supports that drag some of its pairs along."""
    problem, rng = random_problem(seed, pairs, min(motions, pairs), friction), np.random.default_rng((seed, 1))
    if law in ("limit", "adhesion"):
        problem = replace(problem, limit=rng.choice([0.05, 0.3, 1.0, np.inf], pairs))
    if law == "adhesion":
        sticky = np.isinf(problem.friction)
        problem = replace(problem, adhesion=np.where(sticky, 0.0, rng.choice([0.0, 0.05, 0.3], pairs)))
    if law == "dragged":
        dragged = pairs + np.flatnonzero(rng.random(pairs) < 0.5)
        free = np.setdiff1d(np.arange(2 * pairs), dragged)
        Q, _ = np.linalg.qr(rng.normal(size=(len(free), len(free))))
        values = np.where(np.arange(len(free)) < motions, 1.0, rng.uniform(0.05, 0.95, len(free)))
        W, R, b = np.zeros((2 * pairs, 2 * pairs)), np.zeros((2 * pairs, motions)), np.array(problem.b)
        W[np.ix_(free, free)], R[free] = (Q * values) @ Q.T, Q[:, :motions]
        b[dragged] = rng.choice([-1.0, 0.0, 1.0], len(dragged))
        mu = np.minimum(problem.friction, 3.0)
        problem = ContactProblem.of(W=(W + W.T) / 2, b=b, friction=mu, motions=R, scale=1.0)
    return problem


def check_alike(flat, deep, rubs):
    """Two solutions are one, to rounding, and the states of pairs that rub (n,) have one name."""
    n = len(flat.gap)
    for name in ("gap", "normal_force"):
        np.testing.assert_allclose(getattr(deep, name), getattr(flat, name), rtol=ROUNDING, atol=ROUNDING)
    for name in ("slip", "tangential_force"):
        both = np.concatenate([getattr(flat, name), np.zeros((1, n))])
        np.testing.assert_allclose(getattr(deep, name), both, rtol=ROUNDING, atol=ROUNDING)
    assert np.minimum(flat.state, SLIP)[rubs].tolist() == deep.state[rubs].tolist()


@for_all(examples=40, seed=SEEDS, pairs=PAIRS, law=st.sampled_from(["coulomb", "limit", "adhesion"]), second=SECOND)
def test_every_motion_and_force_lack_as_much(seed, pairs, law, second):
    """Any y, small and large: one law makes motions and forces of it."""
    problem = with_law(seed, pairs, HELD, None, law)
    rng = np.random.default_rng((seed, 3))
    y = rng.normal(size=(2, pairs)) * 10.0 ** rng.uniform(-4, 2, (2, pairs))
    lack = certify(problem, y)
    assert certify(in_space(problem, second, seed), np.append(y, np.zeros((1, pairs)), axis=0)) == pytest.approx(lack)


@for_all(examples=60, seed=SEEDS, pairs=PAIRS, law=LAWS, second=SECOND)
def test_one_solution_is_found_by_both(seed, pairs, law, second):
    law = "limit" if law == "adhesion" else law  # whose steep beginning no bound on uniqueness covers
    problem = with_law(seed, pairs, HELD, 1.0, law)
    problem = replace(problem, friction=np.full(pairs, 0.9 * min(mu_low(problem), 1.0)))
    check_alike(solve_contact(problem), solve_contact(in_space(problem, second, seed)), problem.mu > 0)


@for_all(examples=80, seed=SEEDS, pairs=PAIRS, law=LAWS, second=SECOND, motions=st.sampled_from([HELD, 1, 2]))
def test_an_answer_of_one_is_an_answer_of_the_other(seed, pairs, law, second, motions):
    """Whatever the friction: of several solutions they may find two, and where space finds none the plane may."""
    problem = with_law(seed, pairs, min(motions, pairs), None, law)
    solid = in_space(problem, second, seed)
    flat, deep = solve_contact(problem), solve_contact(solid)
    assert flat.outcome == deep.outcome or deep.outcome == "not_found"
    if flat.solved:
        assert certify(solid, np.append(flat.y, np.zeros((1, pairs)), axis=0)) < ROUNDING
    if deep.solved:
        assert certify(problem, deep.y[:2]) < ROUNDING


@pytest.mark.slow
@for_all(examples=60, seed=SEEDS, law=st.sampled_from(["coulomb", "dragged"]), second=SECOND)
def test_loads_pull_away_the_same_bodies_along_the_same_motion(seed, law, second):
    """What of the load friction cannot take is one projection."""
    problem = with_law(seed, 3, 2, None, law)
    flat, deep = solve_contact(problem), solve_contact(in_space(problem, second, seed))
    assert (flat.method == "rigid motions") == (deep.method == "rigid motions")
    if flat.method == "rigid motions":
        np.testing.assert_allclose(deep.escape, np.append(flat.escape, np.zeros(3)), atol=1e-6)
        assert deep.message == flat.message


@pytest.mark.parametrize("second", ["locked", "idle"])
@pytest.mark.parametrize("load", [(-1.0, 0.29, 0.0), (-1.0, 0.31, 0.0), (-1.0, 0.2, 1.1), (0.1, 0.0, 0.0)])
def test_a_block_on_a_floor_holds_slides_tilts_or_lifts_off_in_both(load, second):
    problem = block_on_floor(5, load)
    flat, deep = solve_contact(problem), solve_contact(in_space(problem, second))
    assert flat.solved == (load[1] == 0.29)
    assert deep.outcome == flat.outcome
    assert deep.method == flat.method
    if flat.solved:
        check_alike(flat, deep, problem.mu > 0)
    else:
        np.testing.assert_allclose(deep.escape, np.append(flat.escape, np.zeros(5)), atol=1e-6)


def test_a_pair_that_supports_drag_and_that_may_never_slip_is_refused_in_the_same_words():
    W, b = np.diag([0.5, 0.0]), np.array([-1.0, 0.5])
    data = {"friction": [np.inf], "scale": 1.0}
    with pytest.raises(InputError) as flat:
        ContactProblem.of(W=W, b=b, motions=np.zeros((2, 0)), **data)
    with pytest.raises(InputError) as deep:
        ContactProblem.of(W=np.diag([0.5, 0.0, 0.0]), b=np.append(b, 0.0), motions=np.zeros((3, 0)), **data)
    assert str(deep.value) == str(flat.value)
