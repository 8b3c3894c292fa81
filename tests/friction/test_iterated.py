# SPDX-License-Identifier: BSD-3-Clause
"""Newton in the plane with iterated systems against factorised ones: held and floating bodies, bounds of friction."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume
from hypothesis import strategies as st

from signorini.friction.krylov import iterate
from signorini.friction.linear import Unknowns
from signorini.friction.newton import by_states
from signorini.law.pair import Tangent
from tests.helpers.coulomb_samples import block_on_floor, for_all, random_problem


@for_all(examples=30, seed=st.integers(0, 10**6), motions=st.sampled_from([0, 2]), bounded=st.booleans())
def test_the_states_of_a_solution_are_balanced_as_by_a_factorisation(seed, motions, bounded):
    problem, rng = random_problem(seed, 12, motions, 0.3), np.random.default_rng(seed)
    if bounded:
        problem = replace(problem, limit=rng.uniform(0.05, 0.3, 12), adhesion=rng.uniform(0.0, 0.04, 12))
    end = by_states(problem)
    assume(end.attempt.end == "certified")
    law = Tangent.of_states(problem.pieces, end.state)
    r, a = np.zeros((2, 12)), np.zeros(motions)
    for _ in range(12):  # each time a thousandth of what is lacking is left
        r, a, h = iterate(problem, law, r, a, forward=1e-3)
    np.testing.assert_allclose(r - Unknowns(law).prescribed(h), end.y, rtol=0, atol=1e-9 * np.abs(end.y).max())


@pytest.mark.parametrize("load", [(-1.0, 0.1, 0.0), (-3.0, 0.4, 0.5), (-1.0, 0.29, 0.2)])
@pytest.mark.parametrize("pairs", [8, 30])
def test_newton_ends_where_it_does_with_factorisations(load, pairs, monkeypatch):
    problem = block_on_floor(pairs, load)
    expected = by_states(problem)
    monkeypatch.setattr("signorini.friction.newton.ITERATED_UNKNOWNS", 1)
    found = by_states(problem)
    assert found.attempt.end == expected.attempt.end
    if found.attempt.end == "certified":
        assert (found.index, found.residual <= 1e-10) == (expected.index, True)
        np.testing.assert_array_equal(found.state, expected.state)
        np.testing.assert_allclose(found.y, expected.y, rtol=0, atol=1e-10 * np.abs(expected.y).max())
