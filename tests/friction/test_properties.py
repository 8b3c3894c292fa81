# SPDX-License-Identifier: BSD-3-Clause
"""What must not change the answer: units, the order of pairs, the mirror, the basis of the rigid motions."""

import dataclasses

import numpy as np
from hypothesis import strategies as st

from signorini.condense.operator import InterfaceOperator
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import mu_low
from signorini.law.states import SLIP_MINUS, SLIP_PLUS
from tests.helpers.contact_samples import HELD, for_all, random_problem

SEEDS = st.integers(0, 10**6)
PAIRS = st.integers(1, 10)
DIRECTIONS = st.sampled_from([2, 3])


def unique(seed, pairs, directions):
    """A held problem with exactly one solution."""
    problem = random_problem(seed, pairs, HELD, 1.0, directions=directions)
    return dataclasses.replace(problem, friction=np.full(pairs, 0.9 * mu_low(problem)))


@for_all(examples=30, seed=SEEDS, pairs=PAIRS, directions=DIRECTIONS, factor=st.floats(1e-12, 1e12))
def test_units(seed, pairs, directions, factor):
    problem = unique(seed, pairs, directions)
    scaled = dataclasses.replace(problem, b=problem.b * factor, scale=problem.scale * factor)
    np.testing.assert_allclose(solve_contact(scaled).y / factor, solve_contact(problem).y, rtol=1e-9, atol=1e-9)


@for_all(examples=30, seed=SEEDS, pairs=PAIRS, directions=DIRECTIONS)
def test_order_of_pairs(seed, pairs, directions):
    problem = unique(seed, pairs, directions)
    order = np.random.default_rng(seed).permutation(pairs)
    rows = np.concatenate([order + pairs * direction for direction in range(directions)])
    other = ContactProblem.of(
        W=problem.W[np.ix_(rows, rows)],
        b=problem.b[rows],
        friction=problem.friction[order],
        motions=problem.motions[rows],
        scale=1.0,
    )
    np.testing.assert_allclose(solve_contact(other).y, solve_contact(problem).y[:, order], atol=1e-9)


@for_all(examples=30, seed=SEEDS, pairs=PAIRS, directions=DIRECTIONS)
def test_mirror(seed, pairs, directions):
    """The first tangent the other way round; what slips in the plane does so with the other friction."""
    problem = unique(seed, pairs, directions)
    sign = np.ones((directions, 1))
    sign[1] = -1.0
    rows = np.repeat(sign, pairs)
    other = ContactProblem.of(
        W=rows[:, None] * problem.W * rows,
        b=rows * problem.b,
        friction=problem.friction,
        motions=problem.motions,
        scale=1.0,
    )
    here, there = solve_contact(problem), solve_contact(other)
    np.testing.assert_allclose(there.y, sign * here.y, atol=1e-9)
    slips = {SLIP_PLUS: SLIP_MINUS, SLIP_MINUS: SLIP_PLUS} if directions == 2 else {}
    assert there.state.tolist() == [slips.get(state, state) for state in here.state.tolist()]


@for_all(examples=30, seed=SEEDS, pairs=st.integers(2, 6), directions=DIRECTIONS)
def test_basis_of_the_rigid_motions(seed, pairs, directions):
    problem = random_problem(seed, pairs, 2, 0.3, directions=directions)
    form = InterfaceOperator.of_form(problem.W, problem.motions @ np.array([[2.0, 0.3], [-1.0, 0.1]]))
    other = dataclasses.replace(problem, image=form)
    here, there = solve_contact(problem), solve_contact(other)
    assert here.outcome == there.outcome
    if here.solved and here.method == there.method == "newton":
        np.testing.assert_allclose(there.y, here.y, atol=1e-7)


@for_all(examples=30, seed=SEEDS, pairs=PAIRS, directions=DIRECTIONS)
def test_a_solution_restarted_from_itself_takes_one_step(seed, pairs, directions):
    problem = random_problem(seed, pairs, friction=None if directions == 2 else 0.5, directions=directions)
    first = solve_contact(problem)
    for start in (first.y, first.state)[: 2 if directions == 2 else 1]:
        again = solve_contact(problem, start)
        assert again.trace[-1].iterations == 1
        np.testing.assert_allclose(again.y, first.y, atol=1e-9)
