# SPDX-License-Identifier: BSD-3-Clause
"""Cells with internal modes that yield: their modes are in balance, their tangent is the derivative."""

import numpy as np
import pytest

from signorini.fem.kinematics import kinematics
from signorini.plasticity.measure import deviator, full_strains, violation
from tests.helpers.yielding import LAWS, points_of

KINDS = ("plane strain", "plane stress", "axisymmetric", "space")
GAIN = 0.03  # of strains: some 5 times that of first yield


def cells(kind, law, **given):
    """The points of bent cells, displacements under which they yield, and no temperature."""
    bodies = points_of(kind, law, formulation="incompatible", bent=0.2, **given)
    u = GAIN * np.random.default_rng(0).normal(size=bodies.space.number_of_dofs)
    return bodies, u, np.zeros(len(bodies.body))


def forces_on_modes(bodies, u, state, swelling):
    """``int G^T sigma`` of all cells, over its terms."""
    stress = deviator(bodies, u, state.strain, swelling)
    volume = full_strains(bodies, u, state.strain, swelling)[:, :3].sum(axis=1) - swelling
    stress[:, :3] += (bodies.laws.bulk[bodies.body] * volume)[:, None]
    (group,) = bodies.groups
    points = kinematics(bodies.space, bodies.model, group.group)
    shape = (*group.weights.shape, stress.shape[1])
    found = points.forces(stress.reshape(shape))[:, points.nodes :]
    return np.abs(found).max() / np.abs(points.forces(np.abs(stress).reshape(shape))).max()


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", KINDS)
def test_modes_are_in_balance_and_the_flow_rule_holds_with_their_strains(kind, law):
    bodies, u, still = cells(kind, LAWS[law])
    warm = still + 1e-3 * np.arange(len(still)) / len(still)
    old = bodies.untouched()
    for way, swelling in ((0.3 * u, still), (u, warm), (-u, still)):
        new = bodies.respond(way, old, swelling).state
        assert (new.equivalent > 0.0).any()
        assert forces_on_modes(bodies, way, new, swelling) < 1e-11
        found = violation(bodies, way, old, new, swelling)
        assert max(found.excess, found.flow, found.consistency, found.dissipation) < 1e-10
        old = new


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", KINDS)
def test_the_consistent_tangent_is_the_derivative(kind, law):
    bodies, u, still = cells(kind, LAWS[law])
    for old in (bodies.untouched(), bodies.respond(0.2 * u[::-1], bodies.untouched(), still).state):
        response = bodies.respond(u, old, still)
        pattern = bodies.rows()
        pattern.data = bodies.softening(response)
        way = np.random.default_rng(2).normal(size=len(u))
        h = 1e-6 * GAIN
        ends = [bodies.respond(u + sign * h * way, old, still).state.forces for sign in (1.0, -1.0)]
        expected = (ends[0] - ends[1]) / (2.0 * h)
        np.testing.assert_allclose(pattern @ way, expected, rtol=0, atol=1e-6 * np.abs(expected).max())
