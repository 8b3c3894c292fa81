"""Rates of pairs that touch a smooth section without pressure: one pair by hand, proofs that there are none."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.friction.history import initial_state
from signorini.friction.history.rates import NoRates, Rates
from signorini.friction.history.space.find_rates import find_rates
from signorini.friction.history.space.no_rates_proof import search_regions
from signorini.friction.history.space.smooth_cones import ConeProblem
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN, SLIP, STICK


def obeys(problem, x):
    """Coulomb's law and the complementarity, written out; the tangential force dissipates the most that it can."""
    N, m = problem.numbers, len(problem.closed)
    w = problem.M @ x + problem.q
    (gap, *slip), (p, *force) = x[N:].reshape(3, m), w[N:].reshape(3, m)
    scaled = np.linalg.norm(np.array(force) / problem.friction, axis=0)
    most = p * np.linalg.norm(np.array(slip) * problem.friction, axis=0)
    power = most + (np.array(slip) * force).sum(axis=0)
    least = min(*x[:N], *w[:N], *gap, *p, *(p - scaled), 0.0)
    return least > -1e-9 and max(np.abs(x[:N] * w[:N]).max(initial=0.0), np.abs(gap * p).max(), power.max()) < 1e-9


def one_pair_by_hand(M, q, mu):
    """Whether a pair can be open, stick, or slip: the zeros of one function of the direction, looked for on 20000."""
    if np.linalg.solve(M, q)[0] <= 0.0 or np.linalg.norm(q[1:] / mu) <= q[0]:
        return True
    angle = np.linspace(0.0, 2.0 * np.pi, 20001)
    e = np.stack([np.cos(angle), np.sin(angle)])
    moved = M @ np.stack([0.0 * angle, *(-e / mu[:, None])])
    one = q[1:, None] / mu[:, None] - e * q[0]
    two = moved[1:] / mu[:, None] - e * moved[0]
    crossed = one[0] * two[1] - one[1] * two[0]
    slip = -(one * two).sum(axis=0) / (two**2).sum(axis=0)
    right = (slip >= 0.0) & (q[0] + slip * moved[0] >= 0.0)
    return bool((right[:-1] & (crossed[:-1] * crossed[1:] <= 0.0)).any())


def test_one_pair_has_rates_where_its_closed_form_has():
    rng, none = np.random.default_rng(3), 0
    for _ in range(40):
        B = rng.normal(size=(3, 4))
        M = B @ B.T + 0.05 * np.eye(3)
        M[0, 1:] *= rng.uniform(-3.0, 3.0)  # as where other pairs slip under pressure
        q, mu = rng.normal(size=3), rng.uniform(0.5, 4.0, size=2)
        problem = ConeProblem(M=M, q=q, friction=mu[:, None], closed=np.array([False]))
        found, by_hand = search_regions(problem), one_pair_by_hand(M, q, mu)
        none += not by_hand
        if by_hand:
            assert obeys(problem, found)
        else:
            assert found.proved
            assert problem.found() is None
    assert none >= 3


@pytest.mark.parametrize("numbers", [0, 2])
def test_several_pairs_on_a_held_interface_have_rates(numbers):
    """A symmetric definite M has a solution whatever the friction; the search finds it without Newton's starts."""
    rng, friction = np.random.default_rng(numbers), np.array([[0.5, 2.0], [0.5, 1.0]])
    for _ in range(10):
        size = numbers + 6
        B = rng.normal(size=(size, 2 * size))
        problem = ConeProblem(
            M=B @ B.T / size, q=rng.normal(size=size), friction=friction, closed=np.zeros(2, dtype=bool)
        )
        assert obeys(problem, search_regions(problem))
        assert obeys(problem, problem.found())


def corner(n, seed):
    """Pairs that all touch without pressure, a random interface."""
    rng = np.random.default_rng(seed)
    Q, _ = np.linalg.qr(rng.normal(size=(3 * n, 3 * n)))
    W, none = (Q * rng.uniform(0.05, 0.95, 3 * n)) @ Q.T, np.zeros(3 * n)
    W = (W + W.T) / 2
    problem = ContactProblem.of(W=W, b=none, friction=np.full(n, 0.6), motions=np.zeros((3 * n, 0)), scale=1.0)
    return problem, initial_state(problem, none, motion=none.reshape(3, n)), rng


def test_rates_at_a_corner_are_the_first_increment():
    """From no load at no gap the law of the rates is that of the increment: both are the same problem."""
    states = set()
    for seed in range(8):
        problem, now, rng = corner(3, seed)
        posed = replace(problem, b=rng.normal(size=9) - np.repeat([0.5, 0.0], [3, 6]))
        rates, increment = find_rates(posed, now, 1e-10), solve_contact(posed)
        np.testing.assert_allclose(rates.r, increment.r, atol=1e-9)
        assert rates.state.tolist() == increment.state.tolist()
        states |= set(rates.state.tolist())
    assert states == {OPEN, STICK, SLIP}


def test_a_pair_at_a_corner_beside_one_that_slips_under_pressure():
    """The one lets go of the other where its friction says so; never are rates not found and not disproved."""
    some, none = 0, 0
    for seed in range(25):
        problem, now, rng = corner(2, seed)
        problem = replace(problem, friction=np.full(2, 3.0))
        angle = rng.uniform(0.0, 2.0 * np.pi)
        r = np.array([[1.0, 0.0], [3.0 * np.cos(angle), 0.0], [3.0 * np.sin(angle), 0.0]])
        pressed = replace(now, r=r, state=np.array([STICK, STICK]))
        found = find_rates(replace(problem, b=rng.normal(size=6)), pressed, 1e-9)
        some += isinstance(found, Rates)
        none += isinstance(found, NoRates) and found.proved
    assert some + none == 25
    assert min(some, none) > 0
