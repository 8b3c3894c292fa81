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
from tests.helpers.coulomb_samples import HELD, answer, for_all, random_problem

seeds = st.integers(0, 10**6)
pair_counts = st.integers(1, 10)


def unique(seed, pairs):
    """A held problem with exactly one solution."""
    problem = random_problem(seed, pairs, HELD, 1.0)
    return dataclasses.replace(problem, friction=np.full(pairs, 0.9 * mu_low(problem)))


@for_all(seed=seeds, pairs=pair_counts, factor=st.floats(1e-12, 1e12))
def test_units(seed, pairs, factor):
    problem = unique(seed, pairs)
    scaled = dataclasses.replace(problem, b=problem.b * factor, scale=problem.scale * factor)
    np.testing.assert_allclose(
        answer(solve_contact(scaled)) / factor, answer(solve_contact(problem)), rtol=1e-9, atol=1e-9
    )


@for_all(seed=seeds, pairs=pair_counts)
def test_order_of_pairs(seed, pairs):
    problem = unique(seed, pairs)
    order = np.random.default_rng(seed).permutation(pairs)
    both = np.append(order, pairs + order)
    other = ContactProblem.of(
        W=problem.W[np.ix_(both, both)],
        b=problem.b[both],
        friction=problem.friction[order],
        motions=problem.motions[both],
        scale=1.0,
    )
    np.testing.assert_allclose(answer(solve_contact(other)), answer(solve_contact(problem))[:, order], atol=1e-9)


@for_all(seed=seeds, pairs=pair_counts)
def test_mirror(seed, pairs):
    problem = unique(seed, pairs)
    sign = np.repeat([1.0, -1.0], pairs)
    other = ContactProblem.of(
        W=sign[:, None] * problem.W * sign,
        b=sign * problem.b,
        friction=problem.friction,
        motions=problem.motions,
        scale=1.0,
    )
    here, there = solve_contact(problem), solve_contact(other)
    np.testing.assert_allclose(answer(there), [[1.0], [-1.0]] * answer(here), atol=1e-9)
    swapped = np.where(here.state == SLIP_PLUS, SLIP_MINUS, np.where(here.state == SLIP_MINUS, SLIP_PLUS, here.state))
    assert there.state.tolist() == swapped.tolist()


@for_all(seed=seeds, pairs=st.integers(2, 6))
def test_basis_of_the_rigid_motions(seed, pairs):
    problem = random_problem(seed, pairs, 2, 0.3)
    image = InterfaceOperator.of_form(problem.W, problem.motions @ np.array([[2.0, 0.3], [-1.0, 0.1]]))
    other = dataclasses.replace(problem, image=image)
    here, there = solve_contact(problem), solve_contact(other)
    assert here.outcome == there.outcome
    if here.solved and here.method == there.method == "newton":
        np.testing.assert_allclose(answer(there), answer(here), atol=1e-7)


@for_all(seed=seeds, pairs=pair_counts)
def test_a_solution_restarted_from_its_states_takes_one_step(seed, pairs):
    problem = random_problem(seed, pairs)
    first = solve_contact(problem)
    again = solve_contact(problem, first.state)
    assert again.trace[-1].iterations == 1
    np.testing.assert_allclose(answer(again), answer(first), atol=1e-9)
