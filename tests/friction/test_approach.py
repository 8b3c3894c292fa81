# SPDX-License-Identifier: BSD-3-Clause
"""Rigid approaches: against linear programs, and what they end in."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog, nnls

from signorini.friction.approach import approach, relieved
from signorini.friction.pull_away import unresisted
from signorini.law.section import FrictionSection


def random_bodies(seed, d, k, n):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(d * n, k)), rng.uniform(0.0, 1.0, n) * rng.integers(0, 2, n), rng.normal(size=k)


@given(st.integers(0, 10**6), st.integers(2, 3), st.integers(1, 6), st.integers(1, 12))
@settings(max_examples=60, deadline=None)
def test_without_friction_loads_work_as_much_as_gaps_allow(seed, d, k, n):
    """The work of the loads over all motions that leave no overlap is a linear program; its ray is no approach."""
    P, gap, load = random_bodies(seed, d, k, n)
    found = approach(P, gap, np.zeros((d - 1, n)), load, width=1e-12)
    program = linprog(-load, A_ub=-P[:n], b_ub=gap, bounds=[(None, None)] * k)
    if found.escape is not None:
        assert program.status in (2, 3)  # unbounded, which some presolve calls infeasible: no motion at all is not
        assert load @ found.escape > 0.0
        assert (P[:n] @ found.escape).min() >= -1e-9
        return
    assert program.status == 0
    assert (gap + P[:n] @ found.motion).min() >= -1e-9
    np.testing.assert_allclose(load @ found.motion, -program.fun, atol=1e-7)


@given(st.integers(0, 10**6), st.integers(1, 6), st.integers(1, 12))
@settings(max_examples=60, deadline=None)
def test_overlaps_are_relieved_by_the_least_motion(seed, k, n):
    """It is orthogonal to what would make it less; none is found only where a linear program knows none either."""
    P, gap, _ = random_bodies(seed, 1, k, n)
    gap[0] = -1.0
    motion = relieved(P, gap, width=1e-9)
    program = linprog(np.zeros(k), A_ub=-P, b_ub=gap, bounds=[(None, None)] * k)
    assert (motion is None) == (program.status == 2)
    if motion is not None:
        left = gap + P @ motion
        assert left.min() >= -1e-9
        touching = left < 1e-7
        _, distance = nnls(P[touching].T, motion)  # the gaps that close hold it back
        assert distance < 1e-7 * np.linalg.norm(motion)


@given(st.integers(0, 10**6), st.integers(2, 3), st.integers(1, 6), st.integers(1, 12), st.floats(0.0, 3.0))
@settings(max_examples=60, deadline=None)
def test_with_friction_it_ends_where_contact_can_bear_the_load(seed, d, k, n, mu):
    P, gap, load = random_bodies(seed, d, k, n)
    found = approach(P, gap, np.full((d - 1, n), mu), load, width=1e-12)
    if found is None or found.escape is not None:
        return
    assert load @ found.motion >= 0.0
    np.testing.assert_allclose(np.maximum(gap + P[:n] @ found.motion, 0.0), found.gap, atol=1e-9)
    touching = np.tile(found.gap == 0.0, d)
    count = int(touching.sum()) // d
    cones = FrictionSection(axes=np.full((d - 1, count), mu), sides=np.zeros(count, dtype=np.int64))
    assert unresisted(P[touching], cones, load / np.linalg.norm(load)) is None


def test_friction_holds_what_lands_on_a_slope():
    """A point falls on a slope of 0.5 and slides down to a wall where friction is less than that."""
    slope = np.array([0.5, 1.0]) / np.sqrt(1.25)
    along = np.array([slope[1], -slope[0]])
    P = np.stack([slope, [-1.0, 0.0], along, [0.0, 1.0]])
    for mu, ends in ((0.6, [0.0, -1.0]), (0.4, [2.0, -2.0])):
        found = approach(P, np.array([slope[1], 2.0]), np.full((1, 2), mu), np.array([0.0, -1.0]), width=1e-12)
        np.testing.assert_allclose(found.motion, ends, atol=1e-12)
