# SPDX-License-Identifier: BSD-3-Clause
"""Bodies held by contact alone: pressed, dragged away, lifted, free along the wall."""

import dataclasses

import numpy as np
import pytest

from signorini.condense.operator import InterfaceOperator
from signorini.friction.plane.covering import follow_covering
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN, STICK
from tests.helpers.contact_samples import block_on_floor


@pytest.mark.parametrize(("pairs", "load"), [(8, (-1.0, 0.2, 0.0)), (9, (-1.0, 0.2, 0.1, 0.1, 0.0, 0.1))])
def test_a_pressed_block_is_held_by_friction(pairs, load):
    problem = block_on_floor(pairs, load)
    result = solve_contact(problem)
    assert result.solved
    np.testing.assert_allclose(problem.motions.T @ result.r.ravel(), -np.array(load), atol=1e-10)
    assert STICK in result.state


@pytest.mark.parametrize(
    ("pairs", "load"),
    [
        (8, (1.0, 0.0, 0.0)),
        (8, (-1.0, 0.4, 0.0)),
        (8, (-1.0, -0.4, 0.0)),
        (9, (1.0, 0, 0, 0, 0, 0)),
        (9, (-1.0, 0.3, 0.2, 0, 0, 0)),
        (9, (-1.0, 0, 0, 1.2, 0, 0)),
        (9, (-1.0, 0, 0, 0, 0, 0.5)),
    ],
    ids=["lifted", "dragged", "dragged back", "lifted in space", "dragged in space", "tilted", "turned"],
)
def test_loads_that_pull_the_block_away_are_proved_to(pairs, load):
    problem = block_on_floor(pairs, load)
    result = solve_contact(problem)
    assert result.outcome == "no_equilibrium"
    assert "pull a body away" in result.message
    assert np.isnan(result.gap).all()
    normal, *tangents = result.escape.reshape(-1, pairs)
    assert (normal - 0.3 * np.linalg.norm(tangents, axis=0)).min() > -1e-8
    assert result.escape.ravel() @ problem.b > 0
    if load[0] > 0:
        np.testing.assert_allclose(normal, 1.0, atol=1e-9)


@pytest.mark.parametrize("load", [(-1.0, 0.3, 0.2, 0, 0, 0), (-1.0, 0, 0, 0, 0, 0.5)], ids=["dragged", "turned"])
def test_facets_resist_less_and_as_surely(load):
    problem = block_on_floor(9, load, facets=8)
    result = solve_contact(problem)
    assert result.outcome == "no_equilibrium"
    normal, *tangents = result.escape.reshape(3, 9)
    assert (normal - 0.3 * np.cos(np.pi / 8) * np.linalg.norm(tangents, axis=0)).min() > -1e-8
    assert result.escape.ravel() @ problem.b > 0


def test_frictionless_block_free_along_the_floor_does_not_move():
    result = solve_contact(block_on_floor(8, (-1.0, 0.0, 0.0), friction=0.0))
    assert result.solved
    assert result.index == 0
    assert "least change" in result.message
    np.testing.assert_allclose(result.normal_force.sum(), 1.0, atol=1e-12)
    np.testing.assert_allclose(result.slip.sum(), 0.0, atol=1e-9)


def test_a_push_along_a_frictionless_floor_is_proved_to_have_no_equilibrium():
    assert solve_contact(block_on_floor(8, (-1.0, 1e-3, 0.0), friction=0.0)).outcome == "no_equilibrium"


def test_springs_hold_a_block_that_no_open_path_could_start_from():
    problem = block_on_floor(8, (-1.0, 0.2, 0.0))
    assert follow_covering(problem, "open", budget=100, springs=1e-6).end == "solution"


def test_an_unloaded_block_stays():
    problem = block_on_floor(4, (0.0, 0.0, 0.0))
    result = solve_contact(dataclasses.replace(problem, scale=0.0))
    assert result.solved
    np.testing.assert_array_equal(result.slip, np.zeros((1, 4)))


def test_motions_that_are_none_are_refused():
    problem = block_on_floor(4, (-1.0, 0.0, 0.0))
    with pytest.raises(ValueError, match=r"motions: are no rigid motions: W R differs from R by"):
        InterfaceOperator.of_form(problem.W, np.eye(8)[:, :1])


def test_a_pair_given_twice_shares_its_force():
    once = np.array([[0.5, 0.1], [0.1, 0.4]])
    half = np.repeat(np.repeat(once / 2, 2, axis=0), 2, axis=1)
    b = np.repeat([-1.0, 0.1], 2) / np.sqrt(2)
    problem = ContactProblem.of(W=half, b=b, friction=[0.4, 0.4], motions=np.zeros((4, 0)), scale=1.0)
    result = solve_contact(problem)
    assert result.solved
    assert result.state.tolist() == [STICK, STICK]
    assert result.index == 0
    np.testing.assert_allclose(result.normal_force[0], result.normal_force[1], atol=1e-12)


def test_pairs_of_unlimited_friction_stick_or_open():
    result = solve_contact(block_on_floor(8, (-1.0, 0.5, 0.9), friction=np.inf))
    assert result.solved
    assert set(result.state.tolist()) == {OPEN, STICK}
    np.testing.assert_allclose(result.tangential_force.sum(), -0.5, rtol=1e-10)


def test_unlimited_friction_on_the_verge_of_opening_is_said():
    result = solve_contact(block_on_floor(8, (-1.0, 50.0, 0.9), friction=np.inf))
    assert result.solved
    assert "verge of opening" in result.message
    verge = result.state > STICK
    np.testing.assert_allclose(result.normal_force[verge], np.abs(result.tangential_force[0, verge]) / 1e6, rtol=1e-9)
