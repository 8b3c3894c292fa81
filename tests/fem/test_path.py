# SPDX-License-Identifier: BSD-3-Clause
"""Fields along paths: exact where the cells are, per body, and points outside are told."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.fem.path import along
from signorini.fem.space import make_space
from signorini.meshing.solid import extruded
from signorini.model.mesh import join
from tests.helpers.families import FAMILIES, MIXED, block


def model_of(mesh, kind="plane strain"):
    return sg.Model(mesh, kind=kind, bodies=[sg.Body(name, sg.Elastic(E=3.0, nu=0.3)) for name in mesh.bodies])


@pytest.mark.parametrize("family", [*FAMILIES, *MIXED])
def test_linear_fields_on_crooked_meshes(family):
    model = model_of(block(family))
    points = np.random.default_rng(3).uniform([1.05, 0.05], [1.95, 0.95], (200, 2))
    slope = np.array([[0.2, 0.1], [-0.4, -0.3]])
    result = along(make_space(model.mesh), model, model.mesh.points @ slope.T, points, body="block")
    np.testing.assert_allclose(result.displacement, points @ slope.T, atol=1e-13)
    np.testing.assert_allclose(result.stress, np.tile(result.stress[0], (len(points), 1)), atol=1e-12)
    np.testing.assert_allclose(np.diff(result.distance), np.linalg.norm(np.diff(points, axis=0), axis=1))


@pytest.mark.parametrize("family", FAMILIES)
def test_a_disk_of_cells_of_many_sizes(family):
    """Cells from a hundredth of the radius to half of it, bent edges: a linear field is exact in all of them."""
    mesh = sg.quarter_disk(radius=8.0, contact_length=0.5, contact_spacing=0.0625, cells=family)
    radius, turn = np.linspace(0.01, 7.2, 60), np.linspace(0.05, 1.5, 60)
    points = np.column_stack([radius * np.sin(turn), 8.0 - radius * np.cos(turn)])
    slope = np.array([[0.2, 0.1], [-0.4, -0.3]])
    result = along(make_space(mesh), model_of(mesh), mesh.points @ slope.T, points, body="disk")
    np.testing.assert_allclose(result.displacement, points @ slope.T, atol=1e-12)


def solid(family):
    """A crooked block of one family of cells in space."""
    grid = np.linspace(0.0, 1.0, 4)
    raised = {"wedge": "triangle", "wedge15": "triangle6"}
    if family in raised:
        mesh = extruded(sg.rectangle(nx=3, ny=3, cells=raised[family]), z=[0.0, 0.4, 1.0], ends=("low", "high"))
    else:
        mesh = sg.box(x=grid, y=grid, z=grid, cells=family)
    x, y, z = mesh.points.T
    bent = 0.02 * np.column_stack([np.sin(3.0 * y + z), np.sin(4.0 * z), np.sin(3.0 * x)])
    return replace(mesh, points=mesh.points + bent)


SOLIDS = ("tetra", "tetra10", "hexahedron", "hexahedron20", "hexahedron27", "wedge", "wedge15")


@pytest.mark.parametrize("family", SOLIDS)
def test_linear_fields_in_space(family):
    mesh = solid(family)
    points = np.random.default_rng(3).uniform(0.05, 0.95, (100, 3))
    slope = np.array([[0.2, 0.1, 0.0], [-0.4, -0.3, 0.1], [0.3, 0.0, 0.2]])
    result = along(make_space(mesh), model_of(mesh, "3d"), mesh.points @ slope.T, points, body=next(iter(mesh.bodies)))
    np.testing.assert_allclose(result.displacement, points @ slope.T, atol=1e-12)
    np.testing.assert_allclose(result.stress, np.tile(result.stress[0], (len(points), 1)), atol=1e-11)


def test_points_need_as_many_coordinates_as_the_body():
    mesh = solid("tetra")
    with pytest.raises(sg.InputError, match="points have 2 coordinates; expected 3"):
        along(make_space(mesh), model_of(mesh, "3d"), np.zeros_like(mesh.points), [(0.5, 0.5)], body="block")


def test_bodies_that_touch_keep_their_own_stress():
    mesh = join({"upper": sg.rectangle(nx=2, ny=2, origin=(0.0, 1.0)), "lower": sg.rectangle(nx=3, ny=3)})
    model = model_of(mesh)
    u = np.zeros_like(mesh.points)
    u[mesh.nodes_of("upper.bottom")] = (0.0, 0.1)
    ends = [(0.0, 1.0), (1.0, 1.0)]
    space = make_space(mesh)
    upper, lower = (along(space, model, u, ends, body=name) for name in ("upper", "lower"))
    assert np.abs(upper.stress).max() > 0.1
    np.testing.assert_allclose(lower.stress, 0.0)
    with pytest.raises(sg.InputError, match=r"point 2 at \(1.0, 1.5\) is not in the body 'lower'"):
        along(space, model, u, [(0.5, 0.5), (1.0, 1.5)], body="lower")
    with pytest.raises(sg.InputError, match="unknown body 'loer'; did you mean 'lower'"):
        along(space, model, u, ends, body="loer")
