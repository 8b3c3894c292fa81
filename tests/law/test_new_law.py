# SPDX-License-Identifier: BSD-3-Clause
"""A law that nobody has, as a test of the design: it is one class beside `law.bound`, and every method takes it.

Friction is a quadratic function of the normal force, ``F(p) = mu p - mu^2 p^2 / (4 L)`` up to its largest value L at
``p = 2 L / mu``, and L beyond: asperities that share the load bear less and less more.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.arrays import Array, BoolArray
from signorini.errors import InputError
from signorini.friction.certificate import certify
from signorini.friction.history import follow, initial_state
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import pulled_away
from signorini.friction.solve import solve_contact
from signorini.law.bound import Bound, FrictionBound
from signorini.law.states import OPEN, STICK
from tests.helpers.contact_samples import for_all

SEEDS = st.integers(0, 10**6)
DIRECTIONS = st.sampled_from([2, 3])


@dataclass(frozen=True, kw_only=True, eq=False)
class QuadraticBound(Bound):
    """Friction mu, (n,), at the smallest normal forces, and the most there is, (n,) forces."""

    friction: Array
    limit: Array

    def at(self, p: Array) -> Array:
        share = np.minimum(self.friction * p / (2.0 * self.limit), 1.0)
        return self.limit * share * (2.0 - share)

    def tangent(self, p: Array) -> tuple[Array, Array]:
        slope = self.friction * (1.0 - np.minimum(self.friction * p / (2.0 * self.limit), 1.0))
        return slope, self.at(p) - slope * p

    @property
    def steepest(self) -> Array:
        return self.friction

    def among(self, kept: BoolArray) -> "QuadraticBound":
        return QuadraticBound(friction=self.friction[kept], limit=self.limit[kept])


def posed(seed, directions, pairs=6, *, motions=0, press=1.0):
    """A random body, pressed, with a quadratic bound at every pair."""
    rng = np.random.default_rng((seed, directions))
    size = directions * pairs
    Q, _ = np.linalg.qr(rng.normal(size=(size, size)))
    W = (Q * np.append(np.ones(motions), rng.uniform(0.05, 0.95, size - motions))) @ Q.T
    b = rng.normal(size=size)
    b[:pairs] -= press
    bound = QuadraticBound(friction=rng.uniform(0.1, 0.8, pairs), limit=rng.uniform(0.05, 0.5, pairs))
    return ContactProblem.of(W=(W + W.T) / 2, b=b, friction=bound, motions=Q[:, :motions], scale=1.0)


@for_all(examples=30, seed=SEEDS, directions=DIRECTIONS)
def test_it_is_solved_and_certified_in_the_plane_and_in_space(seed, directions):
    problem = posed(seed, directions)
    answer = solve_contact(problem)
    assert answer.solved, answer.message
    assert certify(problem, answer.y) <= 1e-10
    # the law, written out: what presses has no gap, friction is what p bears and opposes the slip where there is any
    (gap, *slip), (p, *friction) = answer.h, answer.r
    most, size, moved = problem.friction.at(p), np.linalg.norm(friction, axis=0), np.linalg.norm(slip, axis=0)
    assert (gap * p == 0.0).all()
    assert (size <= most * (1.0 + 1e-9)).all()
    slides = (answer.state != OPEN) & (moved > 1e-6)
    np.testing.assert_allclose(size[slides], most[slides], rtol=1e-9)
    np.testing.assert_allclose((np.array(slip) * friction).sum(axis=0)[slides], -(moved * most)[slides], rtol=1e-6)
    assert not moved[answer.state == STICK].any()


def test_it_is_neither_coulombs_law_nor_a_limit():
    """One pair of compliance 1, pressed by 1 and pulled: it slips where the pull is above F(1), between both."""
    bound = QuadraticBound(friction=np.array([0.5]), limit=np.array([0.4]))
    most = 0.5 - 0.25 / (4.0 * 0.4)
    assert most < min(0.5, 0.4)
    for pull, state in ((0.98 * most, STICK), (1.02 * most, 3)):
        problem = ContactProblem.of(
            W=np.diag([0.5, 0.5]), b=np.array([-0.5, 0.5 * pull]), friction=bound, motions=np.zeros((2, 0)), scale=1.0
        )
        answer = solve_contact(problem)
        assert answer.state.tolist() == [state]
        np.testing.assert_allclose(answer.r[:, 0], [1.0, -min(pull, most)], atol=1e-12)


@for_all(examples=15, seed=SEEDS, directions=DIRECTIONS)
def test_frozen_at_its_own_forces_it_is_trescas_law(seed, directions):
    problem = posed(seed, directions)
    answer = solve_contact(problem)
    frozen = problem.friction.frozen(answer.r[0])
    assert isinstance(frozen, FrictionBound)
    y = answer.y.copy()
    other = ContactProblem(image=problem.image, b=problem.b, friction=frozen, scale=1.0)
    assert certify(other, y) <= 1e-9


@for_all(examples=15, seed=SEEDS, directions=DIRECTIONS)
def test_what_floats_is_solved_or_proved_to_leave(seed, directions):
    """The proof takes the steepest slope: the cone of it holds all forces that the law allows."""
    problem = posed(seed, directions, motions=1, press=0.2)
    answer = solve_contact(problem)
    pull = pulled_away(problem)
    assert (answer.outcome == "no_equilibrium") == (pull is not None and not answer.solved)
    if pull is not None:
        h, r = problem.by_pair(pull.motion), problem.half_axes
        assert (h[0] - np.linalg.norm(r * h[1:], axis=0)).min() > -1e-6
        assert not answer.solved


def test_what_needs_straight_branches_says_so():
    problem = posed(1, 3)
    with pytest.raises(InputError, match="friction: has no straight branches, which exact histories follow"):
        follow(problem, initial_state(problem, np.zeros(18), motion=np.zeros(18)), problem.b)
