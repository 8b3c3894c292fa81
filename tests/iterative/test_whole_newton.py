# SPDX-License-Identifier: BSD-3-Clause
"""Newton's method on equilibrium and law together, beside rounds of multipliers alone."""

import numpy as np
import pytest

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.iterative import solve, whole_newton
from signorini.iterative.springs import PairSprings
from signorini.linalg.krylov import MAX_DIRECTIONS, conjugate_gradients, conjugate_residuals


def iterations(history):
    """Conjugate gradients and residuals of all rounds and steps."""
    return int(history.last.trace[0][-1].end.split()[0])


@pytest.fixture(scope="module")
def prepared():
    return prepare(cubes(9, 7), backend="iterative")


def test_it_takes_some_linear_solves(prepared, monkeypatch):
    """Iterations of two or three, and rounds alone much more, for the same answer."""
    bodies = prepared.solver.bodies
    force = bodies.B.T @ np.random.default_rng(2).standard_normal(bodies.B.shape[0])
    none = PairSprings(normal=np.zeros(len(bodies.pairs)), tangent=np.zeros((2, 2, len(bodies.pairs))))
    cycle = bodies.preconditioner.under(bodies.B, none)
    _, plain = conjugate_gradients(lambda v: bodies.K @ v, cycle, force, 1e-11)
    whole = solve_prepared(prepared)
    assert iterations(whole) <= 2.4 * plain
    monkeypatch.setattr(solve, "newton_on_all", lambda _: None)
    rounds = solve_prepared(prepared)
    assert iterations(rounds) > 1.6 * iterations(whole)
    u, v = whole.last.displacement, rounds.last.displacement
    np.testing.assert_allclose(v, u, rtol=0, atol=1e-8 * np.abs(u).max())
    np.testing.assert_array_equal(rounds.last.contacts[0].status, whole.last.contacts[0].status)


@pytest.mark.parametrize(("limit", "value"), [("_MAX_STEPS", 2), ("_PATIENCE", 1), ("MAX_DIRECTIONS", 3)])
def test_where_it_gets_nowhere_rounds_go_on(prepared, monkeypatch, limit, value):
    monkeypatch.setattr(whole_newton, limit, value)
    history = solve_prepared(prepared)
    assert history.last.certificate.passed
    assert history.last.trace[0][-1].end


def test_conjugate_residuals_are_the_least_and_end():
    """Of a system that is not symmetric, by a preconditioner that is rough; and of one that has no solution."""
    rng = np.random.default_rng(5)
    M = np.diag(np.linspace(1.0, 4.0, 30)) + 0.2 * rng.standard_normal((30, 30))
    b = rng.standard_normal(30)
    x, count = conjugate_residuals(lambda v: M @ v, lambda v: np.float64(np.float32(v)), b, 1e-11)
    assert count <= 30
    np.testing.assert_allclose(M @ x, b, atol=1e-10)
    x, count = conjugate_residuals(lambda v: M @ v, lambda v: v, b, 0.05)
    krylov = np.stack([np.linalg.matrix_power(M, k) @ b for k in range(count)], axis=1)
    best = krylov @ np.linalg.lstsq(M @ krylov, b, rcond=None)[0]
    assert np.linalg.norm(b - M @ x) == pytest.approx(np.linalg.norm(b - M @ best), rel=1e-6)
    singular = np.diag([1.0, 0.0])
    x, count = conjugate_residuals(lambda v: singular @ v, lambda v: v, np.array([1.0, 1.0]), 1e-8)
    assert count < MAX_DIRECTIONS
    np.testing.assert_allclose(x[0], 1.0)
