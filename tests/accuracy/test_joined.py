"""Bolts and equations on refined meshes: what they say holds whatever the halves of a section have become."""

import numpy as np
import pytest

import signorini as sg
from signorini.accuracy.meshes import Growth, RefinedMeshes
from signorini.meshing.halves import halves_match

E = 100.0
BAR = [sg.Body("block", sg.Elastic(E=E, nu=0.0))]


def test_a_bolt_on_halves_that_are_refined_alone():
    """A bar between walls, drawn together by a force in its middle: by ``F L / (E A)``, on whatever cells."""
    bar = sg.rectangle(width=4.0, height=2.0, nx=4, ny=2, cells="triangle")
    mesh = sg.cut(bar, "section", body="block", point=(2.0, 0.0), normal=(1.0, 0.0))
    model = sg.Model(
        mesh,
        bodies=BAR,
        supports=[
            sg.Support("left", u=(0.0, None)),
            sg.Support("right", u=(0.0, None)),
            sg.Support((0, 0), u=(None, 0)),
        ],
        bolts=[sg.Bolt("section", force=6.0)],
    )
    meshes = RefinedMeshes(model, sg.Accuracy(0.1, of="energy"))
    meshes.first()
    middle = meshes.simplices.points[meshes.simplices.cells].mean(axis=1)
    posed = meshes.next(np.where(middle[:, 0] < 2.0, 1.0, 1e-9), Growth(least=2.0, most=2.0))
    assert not halves_match(posed.mesh, "section")
    solution = sg.solve(posed, accuracy="estimate")
    assert solution.last.bolts["section"].shortening == pytest.approx(6.0 * 4.0 / (E * 2.0), rel=1e-9)
    assert solution.accuracy.energy < 1e-6
    assert sg.solve(model, accuracy=sg.Accuracy(0.1, of="energy")).accuracy.met


def bent(equations, **more):
    """A cantilever whose tip is loaded at a corner; all of its end goes as that corner does."""
    mesh = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2, cells="triangle", order=2)
    return sg.Model(
        mesh,
        bodies=BAR,
        supports=[sg.Support("left", u=(0.0, 0.0))],
        loads=[sg.Load("top", pressure=1.0)],
        equations=equations,
        **more,
    )


def test_equations_of_a_side_and_a_node():
    mesh = bent([]).mesh
    corner = int(mesh.labels[np.argmin(np.linalg.norm(mesh.points - (2.0, 0.0), axis=1))])
    solution = sg.solve(
        bent([sg.Equation([("right", "y", 1.0), (corner, "y", -1.0)])]), accuracy=sg.Accuracy(0.05, of="energy")
    )
    assert len(solution.accuracy.levels) > 1
    end = solution.last.displacement[solution.model.mesh.nodes_of("right"), 1]
    np.testing.assert_allclose(end, end[0], rtol=1e-12)
    assert end[0] < -1e-3


def test_what_goes_from_node_to_node_is_named():
    pairs = bent([sg.Equation([("right", "y", 1.0), ("bottom", "y", -1.0)])])
    with pytest.raises(sg.InputError, match="does not know equations between the nodes of two sides"):
        sg.solve(pairs, accuracy=0.1)
    mesh = pairs.mesh
    middle = int(mesh.labels[np.argmin(np.linalg.norm(mesh.points - (2.0, 0.25), axis=1))])
    with pytest.raises(sg.InputError, match=f"is node {middle}; expected a corner"):
        sg.solve(
            bent([sg.Equation([("right", "y", 1.0), (middle, "y", -1.0)])]), accuracy=sg.Accuracy(0.1, of="energy")
        )
