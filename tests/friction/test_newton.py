# SPDX-License-Identifier: BSD-3-Clause
"""Newton on problems small enough to solve by hand."""

import dataclasses

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK

ONE_PAIR = {"W": np.diag([0.5, 0.5]), "b": [-1.0, 0.2], "friction": [0.3], "motions": np.zeros((2, 0)), "scale": 1.0}


def one_pair(normal, tangential, mu):
    """A pair with compliance 1 in both directions (W = 1/2): the motion of the free body is twice b."""
    b = np.array([normal, tangential])
    return ContactProblem.of(**ONE_PAIR | {"b": b, "friction": [mu]})


@pytest.mark.parametrize(
    ("normal", "tangential", "mu", "state", "force", "motion"),
    [
        (0.5, 0.1, 0.3, OPEN, (0, 0), (1, 0.2)),
        (-1, 0.2, 0.3, STICK, (2, -0.4), (0, 0)),
        (-1, 0.5, 0.3, SLIP_MINUS, (2, -0.6), (0, 0.4)),
        (-1, -0.5, 0.3, SLIP_PLUS, (2, 0.6), (0, -0.4)),
        (-1, 0.5, 0.0, SLIP_MINUS, (2, 0), (0, 1)),
        (-1, 5, np.inf, STICK, (2, -10), (0, 0)),
        (0.5, 5, np.inf, OPEN, (0, 0), (1, 10)),
    ],
)
def test_one_pair(normal, tangential, mu, state, force, motion):
    result = solve_contact(one_pair(normal, tangential, mu))
    assert result.solved
    assert result.state.tolist() == [state]
    np.testing.assert_allclose([result.normal_force[0], result.tangential_force[0, 0]], force, atol=1e-14)
    np.testing.assert_allclose([result.gap[0], result.slip[0, 0]], motion, atol=1e-14)


@pytest.mark.parametrize("drag", [-0.2, 0.0, 0.2])
def test_locked_pair_slips_as_its_support_moves(drag):
    problem = ContactProblem.of(
        W=np.diag([0.5, 0.0]), b=np.array([-1.0, drag]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    )
    result = solve_contact(problem)
    assert result.solved
    np.testing.assert_allclose(
        [result.slip[0, 0], result.tangential_force[0, 0]], [drag, -0.6 * np.sign(drag)], atol=1e-14
    )


def test_no_pairs():
    nothing = np.zeros(0)
    problem = ContactProblem.of(W=np.zeros((0, 0)), b=nothing, friction=nothing, motions=np.zeros((0, 0)), scale=0.0)
    assert solve_contact(problem).solved


def test_another_load_shares_the_factorisation():
    problem = one_pair(-1, 0.2, 0.3)
    assert dataclasses.replace(problem, b=np.array([1.0, 0.0])).image is problem.image


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"W": np.zeros((2, 3))}, r"W: has shape \(2, 3\); expected as many rows as columns"),
        ({"motions": np.zeros((3, 1))}, r"motions: has shape \(3, 1\); expected \(2, k\)"),
        ({"b": np.zeros(3)}, r"b: has shape \(3,\); expected \(2,\) for 1 pairs"),
        ({"b": np.array([np.nan, 0])}, "b: has entries that are not finite"),
        ({"friction": [-0.1]}, "friction: has negative entries"),
        ({"W": np.array([[0.5, 0.1], [0.2, 0.5]])}, "W: is not symmetric"),
        ({"scale": np.nan}, "scale: is nan; expected"),
        ({"facets": 8}, "facets: is not 0; in the plane"),
        ({"W": np.diag([0.5, 0]), "friction": [np.inf]}, "friction: is infinite at a pair whose supports drag it"),
    ],
)
def test_wrong_input_is_named(change, message):
    with pytest.raises(InputError, match=message):
        ContactProblem.of(**ONE_PAIR | change)


def test_a_motion_not_given_is_named():
    problem = ContactProblem.of(W=np.eye(2), b=np.ones(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0)
    with pytest.raises(InputError, match="add that motion"):
        solve_contact(problem)


def test_start_is_checked():
    with pytest.raises(InputError, match="start: expected 1 states"):
        solve_contact(one_pair(-1, 0.2, 0.3), np.array([0, 0]))
