# SPDX-License-Identifier: BSD-3-Clause
"""Random histories of held bodies: increments that end at the events, energy, jumps, and what must not matter."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import strategies as st

from signorini.friction.certificate import certify
from signorini.friction.history import initial_state
from signorini.friction.uniqueness import mu_low
from signorini.law.states import SLIP_MINUS, SLIP_PLUS
from tests.helpers.contact_samples import for_all
from tests.helpers.path_samples import Springs, increments, loads_at_breakpoints, stiff

SEEDS = st.integers(0, 10**6)


def history(seed, pairs, mu, segments=3):
    """A random body with gaps, and random nodal forces that press more than they pull."""
    rng = np.random.default_rng((seed, pairs))
    gap = rng.uniform(0.0, 0.3, pairs) * (rng.random(pairs) < 0.7)
    body = Springs(stiff((seed, pairs), pairs), np.full(pairs, mu), gap)
    press = np.append(np.ones(pairs), np.zeros(pairs))
    return body, [rng.normal(size=2 * pairs) - press for _ in range(segments)]


@for_all(examples=30, seed=SEEDS, pairs=st.sampled_from([1, 3, 6, 15]), mu=st.sampled_from([0.1, 0.3, 0.6]))
def test_increments_that_end_at_the_events_are_the_path(seed, pairs, mu):
    body, forces = history(seed, pairs, mu)
    segments = body.run(*forces)
    assert all(segment.followed for segment in segments)
    ends, before = [], body.load(np.zeros(2 * pairs))
    for segment, F in zip(segments, forces, strict=True):
        ends += loads_at_breakpoints(segment, before, body.load(F))
        before = body.load(F)
    start = initial_state(body.problem, body.load(np.zeros(2 * pairs)), motion=body.gap.reshape(2, -1))
    h, r = increments(body.problem, start, ends)
    np.testing.assert_allclose(segments[-1].end.h, h, rtol=0, atol=1e-12)
    np.testing.assert_allclose(segments[-1].end.r, r, rtol=0, atol=1e-12)


@for_all(examples=40, seed=SEEDS, pairs=st.sampled_from([1, 3, 6, 15]), mu=st.sampled_from([0.0, 0.3, 1.0, 2.0, 4.0]))
def test_energy_and_law(seed, pairs, mu):
    body, forces = history(seed, pairs, mu)
    segments = body.run(*forces)
    assert all(segment.outcome in ("followed", "jump") for segment in segments)
    assert max(segment.residual for segment in segments) < 1e-12
    if segments[-1].followed:
        end = segments[-1].end
        stored = body.strain_energy(end) + end.dissipation.sum()
        assert body.work(segments, forces) == pytest.approx(stored, abs=1e-12)
    for segment in segments:
        for piece in segment.pieces:
            gap, (p, q) = piece.h[0], piece.r
            assert gap.min() >= 0
            assert p.min() >= 0
            assert np.abs(gap * p).max() == 0
            assert (np.abs(q) <= mu * p * (1 + 1e-14)).all()


@for_all(examples=40, seed=SEEDS, pairs=st.sampled_from([1, 2, 3, 6]))
def test_no_jump_where_the_solution_is_unique(seed, pairs):
    body, forces = history(seed, pairs, 0.1)
    mu = 0.99 * mu_low(replace(body.problem, friction=np.full(pairs, 1.0)))
    body.problem = replace(body.problem, friction=np.full(pairs, mu))
    assert all(segment.followed for segment in body.run(*forces))


@for_all(examples=15, seed=SEEDS, factor=st.sampled_from([1e-6, 1e-3, 1e4]))
def test_units_do_not_matter(seed, factor):
    body, forces = history(seed, 6, 0.5)
    plain = body.run(*forces)
    body.gap = body.gap * factor
    body.problem = replace(body.problem, scale=factor)
    scaled = body.run(*(factor * F for F in forces))
    assert told(plain) == told(scaled)
    np.testing.assert_allclose(scaled[-1].end.h, factor * plain[-1].end.h, rtol=0, atol=1e-12 * factor)
    np.testing.assert_allclose(
        scaled[-1].end.dissipation, factor**2 * plain[-1].end.dissipation, atol=1e-12 * factor**2
    )


@for_all(examples=15, seed=SEEDS)
def test_the_order_of_pairs_does_not_matter(seed):
    body, forces = history(seed, 6, 0.5)
    plain = body.run(*forces)
    order = np.random.default_rng(seed).permutation(6)
    rows = np.append(order, 6 + order)
    permuted = Springs(body.S[np.ix_(rows, rows)], np.full(6, 0.5), body.gap[order]).run(*(F[rows] for F in forces))
    np.testing.assert_allclose(permuted[-1].end.h, plain[-1].end.h[:, order], rtol=0, atol=1e-12)
    np.testing.assert_allclose(permuted[-1].end.r, plain[-1].end.r[:, order], rtol=0, atol=1e-12)
    back = [[(what, tuple(sorted(int(order[k]) for k in pairs))) for what, pairs in told_] for told_ in told(permuted)]
    assert back == told(plain)


@for_all(examples=15, seed=SEEDS)
def test_a_mirror_does_not_matter(seed):
    body, forces = history(seed, 6, 0.5)
    plain = body.run(*forces)
    sign = np.append(np.ones(6), -np.ones(6))
    mirrored = Springs(sign[:, None] * body.S * sign, np.full(6, 0.5), body.gap[:6]).run(*(sign * F for F in forces))
    np.testing.assert_allclose(mirrored[-1].end.h.ravel(), sign * plain[-1].end.h.ravel(), rtol=0, atol=1e-12)
    assert told(plain) == told(mirrored)
    swap = np.array([0, 1, SLIP_MINUS, SLIP_PLUS])
    np.testing.assert_array_equal(mirrored[-1].end.state, swap[plain[-1].end.state])


@for_all(examples=15, seed=SEEDS, cut=st.floats(0.05, 0.95))
def test_a_stop_on_the_way_does_not_matter(seed, cut):
    body, forces = history(seed, 6, 0.5)
    plain = body.run(*forces)
    stops = [
        stop for a, b in zip([0 * forces[0], *forces], forces, strict=False) for stop in ((1 - cut) * a + cut * b, b)
    ]
    halved = body.run(*stops)
    np.testing.assert_allclose(halved[-1].end.h, plain[-1].end.h, rtol=0, atol=1e-12)
    np.testing.assert_allclose(halved[-1].end.dissipation, plain[-1].end.dissipation, rtol=0, atol=1e-12)


@for_all(examples=15, seed=SEEDS)
def test_every_event_state_is_in_equilibrium_and_in_the_law(seed):
    body, forces = history(seed, 6, 0.5)
    for segment in body.run(*forces):
        for event in segment.events:
            state = event.state
            origin = np.append(np.zeros(6), state.h[1])
            held = replace(body.problem, b=state.b + body.problem.W @ origin - origin)
            assert certify(held, state.r - (state.h - origin.reshape(2, -1))) < 1e-12


def told(segments):
    """What happened to whom, in order."""
    return [[(event.what, event.pairs) for event in segment.events] for segment in segments]


def test_without_friction_one_segment_is_one_increment():
    body, forces = history(5, 15, 0.0, segments=1)
    (segment,) = body.run(*forces)
    start = initial_state(body.problem, body.load(0 * forces[0]), motion=body.gap.reshape(2, -1))
    h, r = increments(body.problem, start, [body.load(forces[0])])
    np.testing.assert_allclose(segment.end.h, h, rtol=0, atol=1e-12)
    np.testing.assert_allclose(segment.end.r, r, rtol=0, atol=1e-12)
    assert segment.end.dissipation.max() == 0.0


@for_all(examples=20, seed=SEEDS)
def test_friction_without_bound_never_slips(seed):
    body, forces = history(seed, 6, np.inf)
    for segment in body.run(*forces):
        assert {event.what for event in segment.events} <= {"closes", "opens"}
        assert segment.end.dissipation.max() == 0.0
        if not segment.followed:  # a pair that friction holds back at the moment it loses its pressure
            assert segment.outcome == "jump"
            (pair,) = segment.jump.pairs
            assert "infinite friction" in segment.message
            assert segment.end.r[0, pair] == pytest.approx(0.0, abs=1e-12)
            assert abs(segment.end.r[1, pair]) > 1e-6
