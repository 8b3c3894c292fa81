# SPDX-License-Identifier: BSD-3-Clause
"""Rates by combinations of states: those that linear programs rule out at once have none."""

import numpy as np
import pytest

from signorini.friction.history import follow, initial_state
from signorini.friction.history.plane import find_rates
from signorini.friction.problem import ContactProblem

PAIRS = 3


@pytest.fixture
def combinations_alone(monkeypatch):
    """Neither Newton's method nor Lemke's."""
    monkeypatch.setattr(find_rates, "_newton", lambda *_: None)
    monkeypatch.setattr(find_rates, "_lemke", lambda *_: (None, "nothing else"))


def segment(seed):
    """From where all pairs just touch, under much friction."""
    rng = np.random.default_rng([seed, PAIRS])
    half = rng.normal(size=(2 * PAIRS, 2 * PAIRS))
    G = half @ half.T + 0.2 * np.eye(2 * PAIRS)
    W = np.linalg.inv(np.eye(2 * PAIRS) + 3.0 * G / np.linalg.eigvalsh(G).max())
    none = np.zeros((2 * PAIRS, 0))
    problem = ContactProblem.of(W=W, b=np.zeros(2 * PAIRS), friction=[4.0] * PAIRS, motions=none, scale=1.0)
    return follow(problem, initial_state(problem, np.zeros(2 * PAIRS)), rng.normal(size=2 * PAIRS))


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.usefixtures("combinations_alone")
def test_bounds_rule_out_nothing_that_has_rates(seed, monkeypatch):
    bounded = segment(seed)
    monkeypatch.setattr(find_rates, "_BOUNDED", np.inf)
    whole = segment(seed)
    assert bounded.outcome == whole.outcome
    np.testing.assert_allclose(bounded.end.r, whole.end.r, atol=1e-10)
    if whole.jump is not None:
        assert 0.0 < bounded.jump.margin <= whole.jump.margin * (1.0 + 1e-9)


@pytest.mark.usefixtures("combinations_alone")
def test_nodes_that_jump_together_are_refused_at_once(monkeypatch):
    """Five times the node that sticks up to a pull of 3 and then has no rates, sticking or slipping."""
    tried, lacking, nodes = [], find_rates._lacking, 5
    monkeypatch.setattr(find_rates, "_lacking", lambda *given: tried.append(given) or lacking(*given))
    W = np.kron(np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]])), np.eye(nodes))
    none = np.zeros((2 * nodes, 0))
    problem = ContactProblem.of(W=W, b=np.zeros(2 * nodes), friction=[3.0] * nodes, motions=none, scale=1.0)
    pressed = follow(problem, initial_state(problem, np.zeros(2 * nodes)), W @ np.repeat([-1.0, 0.0], nodes)).end
    tried.clear()
    pulled = follow(problem, pressed, W @ np.repeat([-1.0, 4.0], nodes))
    assert pulled.jump is not None
    assert pulled.jump.factor == pytest.approx(0.75)
    assert "none of the 32 combinations" in pulled.jump.proof
    assert len(tried) < 32
