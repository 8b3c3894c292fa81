"""Forces that are given node by node, and equations between single nodes, on meshes that are refined."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery import coarse

FORCES = np.array([[0.0, -0.3], [0.0, -0.1], [0.0, -0.5], [0.0, -0.0], [0.0, -0.05]])


def pressed(forces=FORCES, nodes=None):
    """Half a block on a circle, pressed by forces at nodes of its top, or at others."""
    model = coarse.hertz_line()
    mesh = model.mesh
    corners = np.unique(mesh.facets("top")[0][:, :2])
    chosen = corners[::2] if nodes is None else nodes
    mesh = replace(mesh, nodes={**mesh.nodes, "screws": chosen})
    return replace(model, mesh=mesh, loads=[sg.Load("screws", nodal_forces=forces, name="pull")])


def test_forces_stay_at_their_nodes():
    """They are as many, where they were, and their sum is carried by the contact."""
    solution = sg.solve(pressed(), accuracy=sg.Accuracy(0.1, nodes=20_000))
    assert solution.accuracy.met
    (load,) = solution.model.loads
    first, last = pressed().mesh, solution.model.mesh
    assert load.label == "pull"
    assert np.allclose(last.points[last.nodes_of(load.on)], first.points[first.nodes_of("screws")])
    contact = solution.contact("seat")
    assert contact.area @ contact.pressure == pytest.approx(-FORCES[:, 1].sum(), rel=1e-3)


def test_forces_that_cannot_be_kept_or_estimated_are_named():
    model = pressed()
    middle = model.mesh.facets("top")[0][:5, 2]
    with pytest.raises(sg.InputError, match=r"nodal_forces: are at node .*, the middle of an edge; expected corners"):
        sg.solve(pressed(nodes=np.sort(middle)), accuracy=0.1)
    with pytest.raises(sg.InputError, match="which have no limit at forces given node by node"):
        sg.solve(model, accuracy=sg.Accuracy(0.1, of="energy"))


def test_equations_between_nodes_that_stay():
    """Two rows of single nodes that are not neighbours keep their equations; neighbours are refused."""
    model = coarse.hertz_line()
    mesh = model.mesh
    corners = np.unique(mesh.facets("top")[0][:, :2])
    rows = {"even": corners[[2, 6]], "odd": corners[[4, 8]], "near": corners[[5, 6]]}
    model = replace(model, mesh=replace(mesh, nodes={**mesh.nodes, **rows}))
    for second in ("odd", "near"):
        tied = replace(model, equations=[sg.Equation([("even", "y", 1.0), (second, "y", -1.0)])])
        if second == "near":
            with pytest.raises(sg.InputError, match="does not know equations between the nodes of two sides"):
                sg.solve(tied, accuracy=0.1)
            continue
        solution = sg.solve(tied, accuracy=sg.Accuracy(0.1, nodes=20_000))
        fine, u = solution.model.mesh, solution.last.displacement
        assert len(fine.points) > len(mesh.points)
        assert u[fine.nodes["even"], 1] == pytest.approx(u[fine.nodes["odd"], 1], rel=1e-9)
