# SPDX-License-Identifier: BSD-3-Clause
"""The order of the methods, their budgets, and what each says."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.friction.certificate import certify
from signorini.friction.newton import by_states
from signorini.friction.plane.covering import follow_covering
from signorini.friction.plane.restricted import restrict_to
from signorini.friction.plane.state_tree import search_states
from signorini.friction.plane.walls import beyond, columns, jacobian, placed
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.gallery.hard import hard_problem
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED
from signorini.settings import SolverSettings
from tests.helpers.contact_samples import block_on_floor, for_all, random_problem


@pytest.fixture(scope="module")
def cycling():
    """A held problem on which Newton repeats its states."""
    return next(
        step
        for problem in map(hard_problem, range(100))
        for step in [problem.step(0, np.zeros(problem.first.pairs))]
        if not step.floating and by_states(step).attempt.end == "states repeat"
    )


def test_newton_cycles_and_the_path_takes_over(cycling):
    result = solve_contact(cycling)
    assert result.solved
    assert [attempt.method for attempt in result.trace] == ["newton", "path open"]
    assert result.trace[0].end == "states repeat"
    assert result.index == 1
    assert result.residual <= 1e-10


def test_previous_states_come_first(cycling):
    solution = solve_contact(cycling)
    again = solve_contact(cycling, solution.state)
    assert [attempt.method for attempt in again.trace] == ["newton"]
    np.testing.assert_allclose(again.y, solution.y, atol=1e-9 * cycling.scale)


def test_budget_is_kept(cycling):
    assert follow_covering(cycling, "press", budget=2).end == "budget spent"
    assert follow_covering(cycling, "press", budget=2).pivots == 2


def test_long_paths_survive_their_refactorisations(cycling):
    path = follow_covering(cycling, "press", budget=10**4)
    assert path.end == "solution"
    assert certify(cycling, path.y) < 1e-6


@for_all(seed=st.integers(0, 10**6), factor=st.sampled_from([1e-15, 1e-9, 1e15]))
@pytest.mark.parametrize("covering", ["open", "press"])
def test_paths_are_the_same_in_any_units(covering, seed, factor):
    """With a load of 1e-13 to come from, no wall seemed to come nearer: every path ended where it began."""
    problem = random_problem(seed, 4)
    scaled = replace(problem, b=factor * problem.b, scale=factor)
    one, two = (follow_covering(posed, covering, budget=100) for posed in (problem, scaled))
    assert (one.end, one.pivots, one.state.tolist()) == (two.end, two.pivots, two.state.tolist())
    np.testing.assert_allclose(two.y / factor, one.y, atol=1e-9 * np.abs(one.y).max())


@for_all(seed=st.integers(0, 10**6))
def test_the_tree_finds_an_equilibrium_of_bodies_nearly_rigid(seed):
    """What rounding leaves of the normal rows of I - W moves nothing, however far a body goes."""
    pairs, rng = 4, np.random.default_rng(seed)
    Q = np.zeros((2 * pairs, 2 * pairs))
    Q[:pairs, :pairs], Q[pairs:, pairs:] = (np.linalg.qr(rng.normal(size=(pairs, pairs)))[0] for _ in range(2))
    rigid = np.r_[:pairs, pairs : pairs + 2]
    W = (Q * np.append(np.ones(pairs + 2), [0.3, 0.4])) @ Q.T
    problem = ContactProblem.of(
        W=(W + W.T) / 2, b=np.zeros(2 * pairs), friction=np.full(pairs, 0.5), motions=Q[:, rigid], scale=1.0
    )
    h, r = problem.law.split(rng.normal(size=(2, pairs)))
    posed = replace(problem, b=-problem.misfit(h, r, np.zeros(2 * pairs)))
    assert search_states(posed).end == "solution"


def wedged_out():
    """The first small floating step of the hard set whose forces can balance, but in no state of the pairs."""
    for problem in map(hard_problem, range(200)):
        step = problem.step(0, np.zeros(problem.first.pairs))
        if step.floating and step.pairs < 9:
            result = solve_contact(step)
            if result.method == "tree":
                return step, result
    raise AssertionError("no such step")


def test_tree_proves_and_springs_name_the_escape():
    step, proved = wedged_out()
    assert proved.outcome == "no_equilibrium"
    assert "no state of the pairs" in proved.message
    named = solve_contact(step, settings=SolverSettings(tree_pairs=0))
    assert named.outcome == "not_found"
    assert named.escape is not None
    np.testing.assert_allclose(np.abs(named.escape).max(), 1.0)
    R = step.image.R
    np.testing.assert_allclose(R @ (R.T @ named.escape), named.escape, atol=1e-3)
    assert (named.escape[: step.pairs] > -1e-3).all()
    assert "run away" in named.message


def test_press_path_of_a_floating_block():
    path = follow_covering(block_on_floor(6, (-1.0, 0.2, 0.0)), "press", budget=100)
    assert path.end == "solution"


def test_press_path_of_a_lifted_block_is_a_ray():
    problem = block_on_floor(6, (1.0, 0.0, 0.0))
    path = follow_covering(problem, "press", budget=100)
    gaps = problem.law.split(path.y)[0][0]
    assert path.end == "ray"
    assert gaps.min() >= 0.0  # the block may turn about its last node
    assert np.count_nonzero(gaps > 0.0) >= 5


def test_crossing_a_wall_changes_the_jacobian_by_rank_one():
    problem = random_problem(5, 3, friction=0.7)
    G = np.eye(6) - problem.W
    closed = np.full(3, UNDECIDED)
    for state in (OPEN, STICK, SLIP_PLUS, SLIP_MINUS):
        before = np.array([STICK, state, OPEN])
        for slot, wall in enumerate(placed(before, problem.pieces, closed)[0][:, :, 1]):
            if not wall.any():
                continue
            after = before.copy()
            after[1], back = beyond(state, slot, 1.0, UNDECIDED)
            np.testing.assert_allclose(placed(after, problem.pieces, closed)[0][back, :, 1], -wall, atol=1e-15)
            change = columns(G, problem.W, 0.7, int(after[1]), 1) - columns(G, problem.W, 0.7, state, 1)
            np.testing.assert_allclose(change, np.outer(change @ wall, wall), atol=1e-14)


def test_jacobian_is_the_derivative():
    problem = random_problem(6, 4, friction=0.7)
    y = np.random.default_rng(0).normal(size=(2, 4))
    h, r = problem.law.split(y)
    state = problem.law.states(y)
    G = np.eye(8) - problem.W
    moved = G @ h.ravel() - problem.W @ r.ravel()
    np.testing.assert_allclose(jacobian(G, problem.W, problem.mu, state) @ y.ravel(), moved, atol=1e-13)


def test_a_path_among_touching_pairs_finds_the_same(cycling):
    whole = solve_contact(cycling)
    few = solve_contact(cycling, settings=SolverSettings(many_pairs=0))
    assert few.solved
    np.testing.assert_allclose(few.y, whole.y, atol=1e-9 * cycling.scale)


def test_releasing_open_pairs_changes_nothing():
    problem = block_on_floor(8, (-1.0, 0.2, 0.9))
    whole = solve_contact(problem)
    kept = whole.state != OPEN
    few = solve_contact(restrict_to(problem, kept))
    assert 0 < np.count_nonzero(kept) < 8
    np.testing.assert_allclose(few.normal_force, whole.normal_force[kept], atol=1e-9)
    np.testing.assert_allclose(few.tangential_force, whole.tangential_force[:, kept], atol=1e-9)


@pytest.mark.parametrize("problem", [block_on_floor(8, (-1.0, 0.2, 0.9)), random_problem(3, 8)], ids=["floats", "held"])
def test_what_is_left_is_the_schur_complement_of_the_image_form(problem):
    """``r_o = 0`` leaves ``W_cc + W_co G_oo^-1 W_oc`` and ``b_c + W_co G_oo^-1 b_o``."""
    kept = np.arange(8) % 3 > 0
    c, o = np.flatnonzero(np.tile(kept, 2)), np.flatnonzero(~np.tile(kept, 2))
    way = problem.W[np.ix_(c, o)] @ np.linalg.inv(np.eye(len(o)) - problem.W[np.ix_(o, o)])
    few = restrict_to(problem, kept)
    np.testing.assert_allclose(few.W, problem.W[np.ix_(c, c)] + way @ problem.W[np.ix_(o, c)], atol=1e-12)
    np.testing.assert_allclose(few.b, problem.b[c] + way @ problem.b[o], atol=1e-12)
    assert np.array_equal(few.friction, problem.friction[kept])


def test_pairs_that_hold_nothing_cannot_be_kept_alone():
    problem = block_on_floor(8, (-1.0, 0.2, 0.0))
    assert restrict_to(problem, np.zeros(8, dtype=bool)) is None
