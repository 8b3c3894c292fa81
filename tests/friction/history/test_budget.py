# SPDX-License-Identifier: BSD-3-Clause
"""A way that is gone in more increments than the user allows ends, and says after how many and where."""

import numpy as np
import pytest

from signorini.friction.history import PathSettings, follow, initial_state
from signorini.friction.problem import ContactProblem
from signorini.outcome import Outcome
from signorini.settings import SolverSettings


def test_increments_in_space_end_where_their_budget_does():
    problem = ContactProblem.of(
        W=0.5 * np.eye(3), b=np.zeros(3), friction=[0.5], motions=np.zeros((3, 0)), scale=1.0, facets=8
    )
    pressed = follow(problem, initial_state(problem, np.zeros(3)), np.array([-0.5, 0.0, 0.0])).end
    few = PathSettings(solver=SolverSettings(path_increments=1))
    pulled = follow(problem, pressed, np.array([-0.5, 0.5, 0.0]), settings=few)
    assert pulled.outcome == Outcome.NOT_FOUND
    assert pulled.message == "all 1 increments that may be followed are behind"


def test_events_in_the_plane_end_where_their_budget_does(monkeypatch):
    monkeypatch.setattr("signorini.friction.history.follower._EVENTS_PER_PAIR", 1)
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    problem = ContactProblem.of(W=W, b=np.zeros(2), friction=[1.0], motions=np.zeros((2, 0)), scale=1.0)
    pressed = follow(problem, initial_state(problem, np.zeros(2)), W @ [-1.0, 0.0]).end
    few = PathSettings(solver=SolverSettings(path_increments=1))
    pulled = follow(problem, pressed, W @ [-1.0, 4.0], settings=few)
    assert pulled.outcome == Outcome.NOT_FOUND
    assert pulled.message == "at factor 0.25: all 1 increments that may be followed are behind"


@pytest.mark.parametrize("facets", [0, 8])
def test_tries_at_an_increment_are_told(facets):
    """The node that sticks up to a pull of 3: how many lengths were tried beyond."""
    W = np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 3.0]]))
    problem = ContactProblem.of(W=W, b=np.zeros(3), friction=[3.0], motions=np.zeros((3, 0)), scale=1.0, facets=facets)
    pressed = follow(problem, initial_state(problem, np.zeros(3)), W @ [-1.0, 0.0, 0.0]).end
    pulled = follow(problem, pressed, W @ [-1.0, 4.0, 0.0])
    assert pulled.jump is not None
    assert " tried: " in pulled.jump.proof
