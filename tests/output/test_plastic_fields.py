# SPDX-License-Identifier: BSD-3-Clause
"""Stresses and plastic strains of bodies that yield, at nodes and in cells."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.fem.space import make_space
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box, extruded
from signorini.output.fields import Fields
from signorini.plasticity.bodies import yielding_bodies
from signorini.plasticity.fields import mean_fields, nodal_fields

PULL = 3.0
STEEL = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(2.0, hardening=10.0, backstresses=[(5.0, 1.0)]))
PLANE = ("quad", "triangle6", "quad8", "quad9")
SOLID = ("hexahedron", "tetra10", "hexahedron20", "hexahedron27")


def bar(mesh, **parts):
    """A bar along x that is pulled and let go; ``parts`` as of its material."""
    solid = mesh.points.shape[1] == 3
    free = (None, None) if solid else (None,)
    sides = [("bottom", (None, None, 0)), ("front", (None, 0, None))] if solid else [("bottom", (None, 0))]
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", STEEL, **parts)],
        supports=[sg.Support("left", u=(0, *free)), *(sg.Support(name, u=u) for name, u in sides)],
        loads=[sg.Load("right", traction=(PULL, 0, 0)[: 2 + solid], name="pull")],
        steps=[sg.Step(increments=4), sg.Step(scale={"pull": 0.0})],
    )


def meshes():
    """A bar of every family that may yield."""
    line = np.array([0.0, 0.7, 2.0])
    for cells in PLANE:
        yield pytest.param(rectangle(x=line, y=[0, 0.4, 1], cells=cells), {}, id=cells)
    for cells in SOLID:
        yield pytest.param(box(x=line, y=[0, 0.4, 1], z=[0, 1], cells=cells), {}, id=cells)
    wedges = extruded(rectangle(x=line, y=[0, 1], cells="triangle6"), z=[-1, 0], ends=("back", "front"))
    z_up = wedges.points[:, [0, 2, 1]] * [1, -1, 1]  # the layers along y, the front at 0
    yield pytest.param(replace(wedges, points=z_up), {}, id="wedge15")


@pytest.mark.parametrize(("mesh", "parts"), [*meshes()])
def test_stresses_are_those_of_elastic_strains(mesh, parts):
    solution = sg.solve(bar(mesh, **parts))
    pulled, freed = (
        np.concatenate([part.stress for part in Fields(solution.model).stresses(step)]) for step in solution.steps
    )
    assert np.allclose(pulled[:, 0], PULL, atol=1e-8)
    assert np.allclose(pulled[:, [1, 3, 4, 5]], 0.0, atol=1e-8)
    assert np.allclose(freed[:, 0], 0.0, atol=1e-8)
    if mesh.points.shape[1] == 3:
        assert np.allclose(pulled[:, 2], 0.0, atol=1e-8)
    points = Fields(solution.model).in_cells(solution.steps[0], "S", np.arange(mesh.number_of_cells))
    assert np.allclose(points[..., 0], PULL, atol=1e-8)
    middle = np.array([[1.0, 0.5, 0.5]])[:, : mesh.points.shape[1]]
    assert np.allclose(solution.along(middle, body="block").stress[:, [0, 1]], 0.0, atol=1e-8)


@pytest.mark.parametrize(("mesh", "parts"), [*meshes()])
def test_what_is_linear_in_space_is_so_at_nodes_and_in_cells(mesh, parts):
    model = bar(mesh, **parts)
    space = make_space(mesh)
    bodies = yielding_bodies(space, model)
    slope = np.arange(1.0, 1.0 + mesh.points.shape[1])

    def field(points):
        return 1.0 + points @ slope

    at, none = field(bodies.places()), bodies.untouched()
    strain = at[:, None] * np.arange(1.0, 1.0 + none.strain.shape[1])
    back = none.back + at[:, None, None]
    state = replace(none, strain=strain, equivalent=at, back=back)
    (found,) = nodal_fields(space, model, state)
    there = field(mesh.points)
    assert np.allclose(found.equivalent, there)
    assert np.allclose(found.strain[:, 2], 3.0 * there)
    assert np.allclose(found.strain[:, 3], 0.5 * 4.0 * there)
    assert np.allclose(found.back[:, 1], there)
    ((family, cells),) = mesh.cells.items()
    means = mean_fields(space, model, state)[family].equivalent
    corners = {"triangle6": 3, "tetra10": 4, "wedge15": 6}.get(family, 4 if mesh.points.shape[1] == 2 else 8)
    assert np.allclose(means, field(mesh.points[cells[:, :corners]].mean(axis=1)))


def test_a_fit_below_zero_is_cut():
    model = bar(rectangle(x=[0, 1], y=[0, 1]))
    space = make_space(model.mesh)
    none = yielding_bodies(space, model).untouched()
    (found,) = nodal_fields(space, model, replace(none, equivalent=np.array([1.0, 0.0, 0.0, 0.0])))
    assert found.equivalent.min() == 0.0
    assert found.equivalent.max() > 1.0
