# SPDX-License-Identifier: BSD-3-Clause
"""Cells with internal modes that yield: their modes are in balance, their tangent is the derivative."""

from itertools import pairwise

import numpy as np
import pytest

import signorini as sg
from signorini.engine.plastic_solver import PlasticSolver
from signorini.fem.kinematics import kinematics
from signorini.plasticity.measure import deviator, full_strains, violation
from tests.helpers.yielding import LAWS, block, points_of

KINDS = ("plane strain", "plane stress", "axisymmetric", "space")
GAIN = 0.03  # of strains: some 5 times that of first yield


def cells(kind, law, **given):
    """The points of bent cells, displacements under which they yield, and no temperature."""
    bodies = points_of(kind, law, formulation="incompatible", bent=0.2, **given)
    u = GAIN * np.random.default_rng(0).normal(size=bodies.space.number_of_dofs)
    return bodies, u, bodies.cold()


def forces_on_modes(bodies, u, state, heat):
    """``int G^T sigma`` of all cells, over its terms."""
    stress = deviator(bodies, u, state.strain, heat)
    volume = full_strains(bodies, u, state.strain, heat)[:, :3].sum(axis=1) - heat.swelling
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
    warm = still._replace(swelling=np.linspace(0.0, 1e-3, len(still.swelling)))
    old = bodies.untouched()
    for way, heat in ((0.3 * u, still), (u, warm), (-u, still)):
        new = bodies.respond(way, old, heat).state
        assert (new.equivalent > 0.0).any()
        assert forces_on_modes(bodies, way, new, heat) < 1e-11
        found = violation(bodies, way, old, new, heat)
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


@pytest.mark.parametrize("kind", ["plane strain", "plane stress", "space"])
def test_uniform_flow_is_exact_on_bent_cells(kind):
    """The patch test: stretched along the last axis and free across, every point has the strain and stress of one."""
    d = 3 if kind == "space" else 2
    names = ("left", "front", "bottom") if d == 3 else ("left", "bottom")
    supports = [
        sg.Support(name, u=tuple(0.0 if axis == i else None for axis in range(d))) for i, name in enumerate(names)
    ]
    supports.append(sg.Support("top", u=(*(None,) * (d - 1), 0.02), name="pull"))
    given = {"supports": supports, "steps": [sg.Step(increments=2)], "formulation": "incompatible"}
    law = LAWS["both"]
    patch, one = (sg.solve(block(kind, law, n=n, bent=bent, **given)) for n, bent in ((3, 0.25), (1, 0.0)))
    assert one.last.yielding.largest > 0.01
    for name in ("strain", "equivalent", "back"):
        found, expected = (getattr(solution.end.state.plastic, name) for solution in (patch, one))
        np.testing.assert_allclose(
            found, np.broadcast_to(expected[:1], found.shape), atol=1e-7 * np.abs(expected).max()
        )
    assert patch.last.reactions["pull"] == pytest.approx(one.last.reactions["pull"], rel=1e-8)


def test_two_cells_through_the_height_bend_as_a_beam_does_at_first_yield_and_beyond():
    """Points of two layers at 0.211 and 0.789 of a half: moments are sums of theirs, in closed form."""
    Y, E, length = 1.0, 1000.0, 4.0
    mesh = sg.rectangle(x=np.linspace(0.0, length, 3), y=np.linspace(-1.0, 1.0, 3))
    ends = np.unique(mesh.facets("right")[0])
    y = mesh.points[ends, 1]
    at = 0.5 + 0.5 * np.array([-1.0, 1.0]) / np.sqrt(3.0)
    for part in (1.2, 3.0):  # of the curvature at which the outer points yield
        curvature = part * Y / (E * at[1])
        turned = [sg.Support((length, h), u=(-curvature * length * h, None), name=f"turn {h:g}") for h in y]
        model = sg.Model(
            mesh,
            kind="plane stress",
            bodies=[sg.Body("block", sg.Elastic(E=E, nu=0.3, plastic=sg.Plastic(Y)), "incompatible")],
            supports=[sg.Support("left", u=(0.0, None)), sg.Support((0.0, -1.0), u=(None, 0.0)), *turned],
            steps=[sg.Step(increments=1)],
        )
        solution = sg.solve(model)
        moment = -solution.last.external[ends, 0] @ y
        assert moment == pytest.approx(2.0 * np.minimum(E * curvature * at, Y) @ at / 2.0, rel=1e-8)


def test_rounds_converge_as_newtons_do(monkeypatch):
    """Of a cantilever far beyond first yield: few, and a round near the end gains more than two digits at once."""
    lacks = []
    measure = PlasticSolver._lack
    monkeypatch.setattr(PlasticSolver, "_lack", lambda *given: lacks.append(measure(*given)) or lacks[-1])
    model = sg.Model(
        sg.rectangle(x=np.linspace(0.0, 8.0, 9), y=np.linspace(0.0, 1.0, 3)),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3, plastic=LAWS["linear"]), "incompatible")],
        supports=[sg.Support("left", u=(0.0, 0.0)), sg.Support("right", u=(None, -0.4), name="press")],
        steps=[sg.Step(increments=1)],
    )
    assert sg.solve(model).last.yielding.share > 0.3
    assert len(lacks) <= 8
    assert min(two / one for one, two in pairwise(lacks) if two > 1e-8) < 5e-3
