# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb's cone on finite elements in space: facets approach it, and it has no directions of its own."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import signorini as sg
from benchmarks.space_peers import cube_on_block
from signorini.engine.increments import free_load
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.friction.solve import solve_contact
from signorini.gallery.cubes import cubes
from signorini.model.conditions import Support
from signorini.solution.state import LoadPoint


def condensed(model):
    """The model's first increment as a problem of the law alone."""
    prepared = prepare(model)
    interface, active = prepared.interface, prepared.paths.condensed.active
    factors = dict.fromkeys(model.scaled_names, 1.0)
    point = LoadPoint(factors=factors, gap=interface.gap, given=np.zeros((3, len(interface))))
    imposed = sum(prepared.constraints.prescribed.values())
    offset = interface.motion(imposed)
    offset[0] += interface.gap
    load = prepared.paths.condensed.reduce(free_load(prepared, point)).load
    return replace(prepared.paths.law, b=prepared.paths.condensed.right_hand_side(load, offset[:, active]))


@pytest.mark.parametrize("upper", [4, 5])
def test_facets_approach_the_cone(upper):
    """Inside a polygon of 2m corners a force is at most ``2 sin(pi / 2m)`` of the bound away from the circle's."""
    law = condensed(cubes(4, upper))
    exact = solve_contact(law)
    bound = 0.3 * exact.normal_force.max()
    errors = []
    for facets in (4, 8, 16, 32, 64):
        found = solve_contact(replace(law, facets=facets))
        assert found.solved
        errors.append(np.linalg.norm(found.tangential_force - exact.tangential_force, axis=0).max() / bound)
    assert all(fine < coarse for coarse, fine in pairwise(errors)), errors
    assert errors[-1] < 0.1 * errors[0]


@pytest.mark.parametrize("turn", [0.4, 1.1, 2.5])
@pytest.mark.parametrize("model", [cubes(4), cubes(3, 4), cube_on_block(3, 5, 2)], ids=["match", "mortar", "block"])
def test_a_turn_about_the_normal_changes_nothing(model, turn):
    """Pairs have their tangents along coordinate axes: a cone with directions of its own would show."""
    Q = Rotation.from_rotvec([0.0, 0.0, turn]).as_matrix()
    turned = replace(
        model,
        mesh=replace(model.mesh, points=model.mesh.points @ Q.T),
        supports=[Support(held.on, u=tuple(Q @ np.array(held.u))) for held in model.supports],
    )
    one, two = (solve(each).last.contacts[0] for each in (model, turned))
    assert {"stick", "slip"} <= set(one.status)
    size = one.pressure.max()
    np.testing.assert_allclose(two.pressure, one.pressure, atol=1e-8 * size)
    np.testing.assert_allclose(two.shear, one.shear @ Q.T, atol=1e-8 * size)
    assert (two.status == one.status).all()


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 1e3, 1e6])
def test_a_soft_body_on_a_stiff_one_is_as_easy_as_two_equal_ones(ratio, swapped):
    """The interface is as stiff as both sides in series: Newton's method needs no more steps."""
    x, sides = np.linspace(0, 1, 3), ("upper.bottom", "lower.top")
    meshes = {"upper": sg.box(x=x, y=x, z=x), "lower": sg.box(x=[0, 0.3, 0.7, 1], y=[0, 0.3, 0.7, 1], z=[-1, -0.5, 0])}
    model = sg.Model(
        sg.join(meshes),
        bodies=[sg.Body("upper", sg.Elastic(E=1.0, nu=0.3)), sg.Body("lower", sg.Elastic(E=ratio, nu=0.3))],
        supports=[sg.Support("lower.bottom", u=(0, 0, 0))],
        loads=[sg.Load("upper.top", force=(0.1 * min(ratio, 1.0), 0, -min(ratio, 1.0)))],
        contacts=[sg.Contact(*sides[:: -1 if swapped else 1], friction=0.3, name="contact")],
        steps=[sg.Step(increments=1)],
    )
    step = sg.solve(model).last
    force = step.contacts[0].normal_force + step.contacts[0].tangential_force
    np.testing.assert_allclose(np.abs(force), np.array([0.1, 0, 1]) * min(ratio, 1.0), atol=1e-8 * min(ratio, 1.0))
    assert step.methods == ("newton",)
    assert step.iterations[0] <= 10
