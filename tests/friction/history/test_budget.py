# SPDX-License-Identifier: BSD-3-Clause
"""A way that is gone in more increments than the user allows ends, and says after how many and where."""

import numpy as np
import pytest

from signorini.attempt import Spent
from signorini.friction.approach import approach
from signorini.friction.history import PathSettings, follow, initial_state, land
from signorini.friction.overload import overload
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import pulled_away
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import _from_states, _starts, starts
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
    _, _, pulled = jumping(facets)
    assert pulled.jump is not None
    assert " tried, at most 60: " in pulled.jump.proof


def jumping(facets):
    """The node, its state where it is pressed, and its path up to where it jumps."""
    W = np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 3.0]]))
    problem = ContactProblem.of(W=W, b=np.zeros(3), friction=[3.0], motions=np.zeros((3, 0)), scale=1.0, facets=facets)
    pressed = follow(problem, initial_state(problem, np.zeros(3)), W @ [-1.0, 0.0, 0.0]).end
    return problem, pressed, follow(problem, pressed, W @ [-1.0, 4.0, 0.0])


def test_a_landing_says_that_its_turns_are_spent(monkeypatch):
    monkeypatch.setattr("signorini.friction.history.landing.TURNS", 0)
    found = land(*jumping(8))
    assert str(found) == "all 0 turns of the load behind the jump that may be tried are spent"


def test_a_landing_says_that_not_all_departures_were_tried(monkeypatch):
    monkeypatch.setattr("signorini.friction.history.space.find_rates.DEPARTURES", 0)
    found = land(*jumping(8))
    assert isinstance(found, Spent)
    assert "combinations of next states of acting pairs that may be tried are spent" in str(found)


def slab(friction=0.3):
    """A rigid point in space, pressed by 1 and pulled by 1.2 askew to every direction that is known beforehand."""
    problem = ContactProblem.of(
        W=np.eye(3), b=np.array([-1.0, 0.0, 0.0]), friction=[friction], motions=np.eye(3), scale=1.0
    )
    return problem, np.array([-1.0, 1.2 * np.cos(0.3), 1.2 * np.sin(0.3)])


@pytest.mark.parametrize(("limit", "of"), [("MAX_ROUNDS", "linear programmes"), ("MAX_PIVOTS", "pivots")])
def test_the_load_that_contact_holds_is_told_or_that_the_budget_is_spent(monkeypatch, limit, of):
    problem, end = slab()
    assert overload(problem, -problem.by_pair(problem.b), end).factor == pytest.approx(0.25, abs=1e-6)
    monkeypatch.setattr(f"signorini.friction.overload.{limit}", 1 if limit == "MAX_ROUNDS" else 0)
    found = overload(problem, -problem.by_pair(problem.b), end)
    assert isinstance(found, Spent)
    assert (
        found.of
        == f"{of} {'about' if of != 'pivots' else 'of a linear programme about'} the load that contact can hold"
    )
    pressed = initial_state(problem, problem.b)
    assert found in follow(problem, pressed, end).spent


def test_a_proof_by_a_rigid_motion_says_that_its_rounds_are_spent(monkeypatch):
    _, end = slab()
    pulled = ContactProblem.of(W=np.eye(3), b=end, friction=[0.3], motions=np.eye(3), scale=1.0)
    monkeypatch.setattr("signorini.friction.pull_away.ROUNDS", 1)
    assert isinstance(pulled_away(pulled), Spent)
    trace = solve_contact(pulled).trace
    ends = [run.end for run in trace if run.method == "rigid motions"]
    assert ends == ["all 1 rounds of a proof by a rigid motion that may be tried are spent"]


def test_an_approach_says_that_its_pieces_are_spent(monkeypatch):
    """A point that falls on a floor, slides to a wall and stays."""
    P = np.array([[0.0, 1.0], [-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    given = P, np.array([2.0, 1.0]), np.zeros((1, 2)), np.array([0.5, -1.0])
    assert np.allclose(approach(*given, width=1e-12).gap, 0.0)
    monkeypatch.setattr("signorini.friction.approach.MAX_PIECES", 1)
    assert str(approach(*given, width=1e-12)) == "all 1 straight pieces of a rigid approach that may be tried are spent"


def test_a_path_without_driven_pivots_is_the_same(monkeypatch):
    W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))

    def gone(friction):
        problem = ContactProblem.of(W=W, b=np.zeros(2), friction=[friction], motions=np.zeros((2, 0)), scale=1.0)
        pressed = follow(problem, initial_state(problem, np.zeros(2)), W @ [-1.0, 0.0]).end
        return follow(problem, pressed, W @ [-1.0, 4.0])

    driven = gone(1.0)
    monkeypatch.setattr("signorini.friction.history.plane.driven_pivots.PIVOTS", 0)
    alone = gone(1.0)
    assert [event.what for event in alone.events] == [event.what for event in driven.events] == ["slips", "opens"]
    assert [event.factor for event in alone.events] == pytest.approx([event.factor for event in driven.events])
    assert gone(3.0).jump.proof.startswith("all 0 driven pivots that may be tried are spent; ")


@pytest.mark.parametrize("directions", [2, 3])
@pytest.mark.parametrize("floating", [False, True])
@pytest.mark.parametrize("pairs", [1, 12])
def test_a_search_for_other_solutions_counts_its_starts(directions, floating, pairs, monkeypatch):
    monkeypatch.setattr("signorini.friction.uniqueness.by_states", lambda *_, **__: Found())
    n = directions * pairs
    motions = np.eye(n)[:, :1] if floating else np.zeros((n, 0))
    problem = ContactProblem.of(
        W=np.eye(n) if floating else 0.5 * np.eye(n), b=-np.ones(n), friction=np.ones(pairs), motions=motions, scale=1.0
    )
    monkeypatch.setattr("signorini.friction.uniqueness.follow_covering", lambda *_, **__: Found())
    every = _from_states(problem) if directions == 2 else _starts(problem)
    assert len(list(every)) == starts(problem)


class Found:
    """The end of any search."""

    y, state, end = None, None, "solution"
