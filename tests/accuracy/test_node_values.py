"""What a model says node by node stays what it is where its mesh is refined."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.accuracy.meshes import Growth, RefinedMeshes
from signorini.meshing.tetrahedra import tetrahedra

STEEL = sg.Elastic(E=200.0, nu=0.3, expansion=1e-3)
MESHES = {
    "triangle": lambda: sg.rectangle(nx=2, ny=2, cells="triangle"),
    "triangle6": lambda: sg.rectangle(nx=2, ny=2, cells="triangle", order=2),
    "quad8": lambda: sg.rectangle(nx=2, ny=2, cells="quad", order=2),
    "hexahedron": lambda: sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1]),
    "wedge": lambda: wedges(),
    "tetra10": lambda: tetrahedra(sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1], cells="hexahedron27")),
}


def wedges():
    """Two that make a cube."""
    points = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
    return sg.Mesh(
        points=points,
        cells={"wedge": np.array([[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]])},
        bodies={"block": np.arange(2)},
        boundaries={"bottom": np.array([[0, 1, 2], [0, 2, 3]]), "top": np.array([[4, 5, 6], [4, 6, 7]])},
    )


def field(mesh, points):
    """Linear; where cells are quadratic with a square, which they have too."""
    x, y = points[:, 0], points[:, -1]
    return (
        1.0
        + 2.0 * x
        - 3.0 * y
        + (0.0 if next(iter(mesh.cells)) in ("triangle", "hexahedron", "wedge") else x * x - x * y)
    )


@pytest.mark.parametrize("family", MESHES)
def test_values_between_nodes_are_those_of_the_cells(family):
    """Temperatures of all nodes, pressures at those of a side alone, by the numbers of the file."""
    mesh = MESHES[family]()
    side = np.flatnonzero(mesh.points[:, -1] == 1.0)
    model = sg.Model(
        mesh,
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("bottom", u=(0.0,) * mesh.points.shape[1])],
        loads=[
            sg.Load("block", temperature=field(mesh, mesh.points), name="warm"),
            sg.Load("top", pressure=sg.NodeValues(field(mesh, mesh.points[side]), nodes=mesh.labels[side])),
        ],
    )
    meshes = RefinedMeshes(model, sg.Accuracy(0.1, of="energy"))
    posed = meshes.first()
    for _ in range(2):
        np.testing.assert_allclose(posed.loads[0].temperature, field(mesh, posed.mesh.points), rtol=1e-12)
        pressed = posed.loads[1].pressure
        own = np.searchsorted(posed.mesh.labels, pressed.nodes)
        np.testing.assert_allclose(pressed.values, field(mesh, posed.mesh.points[own]), rtol=1e-12)
        facets = np.unique(np.concatenate([part.ravel() for part in posed.mesh.facets("top")]))
        assert np.isin(facets, own).all()
        first = np.linalg.norm(posed.mesh.points[meshes.simplices.cells].mean(axis=1), axis=1)
        posed = meshes.next(1.0 / first**4, Growth(least=3.0, most=3.0))


def test_an_accuracy_of_a_model_with_values_at_nodes():
    """A gap that is given node by node is as good as the formula that it was computed by: linear between its nodes."""
    lines = np.linspace(0.0, 2.0, 5)
    mesh = sg.rectangle(x=lines, y=np.linspace(0.0, 1.0, 3), cells="triangle")
    model = sg.Model(
        mesh,
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("top", u=(0.0, -0.02))],
        contacts=[sg.Contact("bottom", sg.Plane((0.0, 0.0), (0.0, 1.0)), gap="0.01 * x", name="seat")],
    )
    given = replace(model, contacts=[replace(model.contacts[0], gap=0.01 * mesh.points[:, 0])])
    one, other = (sg.solve(each, accuracy=sg.Accuracy(0.1, of="energy")) for each in (model, given))
    np.testing.assert_allclose(one.contact("seat").pressure, other.contact("seat").pressure, rtol=1e-9, atol=1e-9)
    assert len(one.accuracy.levels) > 1
