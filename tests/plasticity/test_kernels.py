# SPDX-License-Identifier: BSD-3-Clause
"""What points answer to strains: the tangent beside differences, and that nothing else than strain moves them."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.model.plastic import Plastic
from signorini.plasticity.measure import violation
from tests.helpers.yielding import KINDS, LAWS, points_of

GAIN = 0.03  # of strains: some 5 times that of first yield


def flowing(bodies, seed=0):
    """Displacements under which every point yields, no two in the same direction."""
    return GAIN * np.random.default_rng(seed).normal(size=bodies.space.number_of_dofs)


def once(bodies, u):
    """The state after one increment from rest."""
    return bodies.respond(u, bodies.untouched(), bodies.cold()).state


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", KINDS)
def test_the_consistent_tangent_is_the_derivative(kind, law):
    """From rest and from a state that has flowed: what yielding takes off beside central differences of the forces."""
    bodies = points_of(kind, LAWS[law])
    u, still = flowing(bodies), bodies.cold()
    for old in (bodies.untouched(), once(bodies, 0.2 * flowing(bodies, 1))):
        response = bodies.respond(u, old, still)
        assert response.points.yields.all()
        pattern = bodies.rows()
        pattern.data = bodies.softening(response)
        way = np.random.default_rng(2).normal(size=len(u))
        h = 1e-6 * GAIN
        ends = [bodies.respond(u + sign * h * way, old, still).state.forces for sign in (1.0, -1.0)]
        expected = (ends[0] - ends[1]) / (2.0 * h)
        np.testing.assert_allclose(pattern @ way, expected, rtol=0, atol=2e-7 * np.abs(expected).max())


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_left_of_the_elastic_law_is_its_part_of_the_tangent(kind):
    bodies = points_of(kind, LAWS["linear"])
    response = bodies.respond(flowing(bodies), bodies.untouched(), bodies.cold())
    np.testing.assert_allclose(
        bodies.softening(response, 0.25), 0.75 * bodies.softening(response), rtol=1e-12, atol=1e-12
    )


def test_recovery_from_rest_has_a_symmetric_tangent_too():
    """Armstrong and Frederick's law: only from a backstress that is there already the true tangent is not symmetric."""
    bodies = points_of("plane strain", Plastic(1.0, backstresses=[(50.0, 25.0)]))
    u, old, still = flowing(bodies), bodies.untouched(), bodies.cold()
    matrix = bodies.rows()
    matrix.data = bodies.softening(bodies.respond(u, old, still))
    way, h = np.random.default_rng(2).normal(size=len(u)), 1e-6 * GAIN
    ends = [bodies.respond(u + sign * h * way, old, still).state.forces for sign in (1.0, -1.0)]
    expected = (ends[0] - ends[1]) / (2.0 * h)
    np.testing.assert_allclose(matrix @ way, expected, rtol=0, atol=2e-7 * np.abs(expected).max())


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", KINDS)
def test_one_increment_obeys_the_flow_rule(kind, law):
    bodies = points_of(kind, LAWS[law])
    old, u, still = once(bodies, 0.2 * flowing(bodies, 1)), flowing(bodies), bodies.cold()
    found = violation(bodies, u, old, bodies.respond(u, old, still).state, still)
    assert max(found.excess, found.flow, found.consistency, found.dissipation) < 1e-12


@pytest.mark.parametrize("kind", ["plane strain", "space"])
def test_small_rotations_and_shifts_of_the_whole_body_change_nothing(kind):
    bodies = points_of(kind, LAWS["both"])
    d, at = bodies.space.dimension, bodies.space.mesh.points
    u = flowing(bodies)
    spin = np.random.default_rng(3).normal(size=(d, d))
    rigid = (at @ (spin - spin.T).T + np.arange(1.0, d + 1.0)).ravel()
    one, two = once(bodies, u), once(bodies, u + rigid)
    np.testing.assert_allclose(two.strain, one.strain, rtol=0, atol=1e-12)
    np.testing.assert_allclose(two.forces, one.forces, rtol=0, atol=1e-10)


def test_heat_that_nothing_resists_makes_nothing_flow():
    bodies = points_of("space", LAWS["perfect"])
    swollen = bodies.cold()._replace(swelling=np.full(len(bodies.body), 0.3))
    u = 0.1 * bodies.space.mesh.points.ravel()
    assert not bodies.respond(u, bodies.untouched(), swollen).flows
    rest = violation(bodies, u, bodies.untouched(), bodies.untouched(), swollen)
    assert rest.excess == 0.0


def wrong(kind="plane strain"):
    """Points, displacements that make all of them flow, and the states before and after."""
    bodies = points_of(kind, LAWS["prager"])
    u, old = flowing(bodies), bodies.untouched()
    return bodies, u, old, once(bodies, u), bodies.cold()


def test_violation_sees_too_much_stress():
    bodies, u, old, _, still = wrong()
    assert violation(bodies, u, old, old, still).excess > 1.0


def test_violation_sees_flow_across_the_stress_and_a_backstress_off_its_law():
    bodies, u, old, new, still = wrong()
    aside = new.strain.copy()
    aside[5, 3] += 1e-3
    found = violation(bodies, u, old, replace(new, strain=aside), still)
    assert found.flow > 1e-2
    off = new.back.copy()
    off[5, 0, 3] += 1e-2
    found = violation(bodies, u, old, replace(new, back=off), still)
    assert found.flow > 1e-3


def test_violation_sees_flow_below_the_yield_stress_and_flow_undone():
    bodies, u, old, new, still = wrong()
    # the same plastic strain with next to no stress left
    calm = violation(bodies, np.zeros_like(u), old, replace(new, strain=new.strain * 1e-3), still)
    assert calm.consistency > 0.5
    shrunk = violation(bodies, u, replace(old, equivalent=old.equivalent + 1.0), new, still)
    assert shrunk.consistency > 1.0


def test_violation_sees_flow_against_the_stress():
    bodies, u, old, new, still = wrong()
    found = violation(bodies, u, replace(old, strain=2.0 * new.strain), new, still)
    assert found.dissipation > 1e-2


@pytest.mark.parametrize("kind", KINDS)
def test_a_back_stress_of_next_to_no_size_changes_next_to_nothing(kind):
    """Yield stresses that harden alone have a loop of their own, exact row by row; the other one finds roots."""
    table = [(0.0, 1.0), (0.004, 1.3), (0.01, 1.5), (0.03, 1.6)]
    alone, both = (points_of(kind, Plastic(table, hardening=2.0, backstresses=back)) for back in ((), [(1e-11, 0.0)]))
    old, other = alone.untouched(), both.untouched()
    for seed in range(3):  # strains grow over all rows of the table
        u = (seed + 0.1) * flowing(alone, seed)
        old, other = (bodies.respond(u, state, bodies.cold()) for bodies, state in ((alone, old), (both, other)))
        for name in ("plastic", "equivalent", "direction", "slack", "yields"):
            one, two = getattr(old.points, name), getattr(other.points, name)
            np.testing.assert_allclose(one, two, rtol=1e-9, atol=1e-11, err_msg=name)
        old, other = old.state, other.state
