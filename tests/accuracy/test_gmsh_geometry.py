"""New nodes of a refined mesh on the curves and faces of the geometry that it was made of."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.accuracy.meshes import Growth, RefinedMeshes
from signorini.cli.main import main
from signorini.errors import InputError

ELLIPSE = """
Point(1) = {0, 0, 0, 1}; Point(2) = {2, 0, 0, 1}; Point(3) = {0, 1, 0, 1};
Ellipse(1) = {3, 1, 2, 2}; Line(2) = {2, 1}; Line(3) = {1, 3};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Physical Curve("arc") = {1}; Physical Curve("base") = {2}; Physical Curve("axis") = {3}; Physical Surface("body") = {1};
"""
SOLID = """
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 1, 0, Pi/2, Pi/2}; Dilate {{0, 0, 0}, {2, 1, 1}} { Volume{1}; }
Mesh.MeshSizeMax = 0.7;
Physical Surface("skin") = Boundary{ Volume{1}; }; Physical Volume("body") = {1};
"""


@pytest.fixture(scope="module", autouse=True)
def _gmsh():
    pytest.importorskip("gmsh", exc_type=ImportError)


@pytest.fixture
def ellipse(tmp_path):
    (tmp_path / "part.geo").write_text(ELLIPSE)
    return tmp_path / "part.geo"


def off(points):
    """How far from the ellipse or ellipsoid of half-axes 2, 1, 1, roughly."""
    return np.abs(np.sqrt((points[:, 0] / 2.0) ** 2 + (points[:, 1:] ** 2).sum(axis=1)) - 1.0)


def held(mesh):
    return sg.Model(
        mesh,
        bodies=[sg.Body("body", sg.Elastic(E=200.0, nu=0.3))],
        supports=[sg.Support("base" if mesh.points.shape[1] == 2 else "skin", u=(0.0,) * mesh.points.shape[1])],
    )


def test_new_nodes_are_on_the_curve(ellipse):
    mesh = sg.read_mesh(ellipse)
    meshes = RefinedMeshes(held(mesh), sg.Accuracy(0.1, of="energy", geometry=ellipse))
    meshes.first()
    assert meshes.notes == ("'arc' follows the geometry 'part.geo'",)
    for _ in range(2):
        posed = meshes.next(np.ones(len(meshes.simplices.cells)), Growth(least=3.0, most=3.0))
    nodes = posed.mesh.nodes_of("arc")
    assert len(nodes) > 2 * len(mesh.nodes_of("arc"))
    assert off(posed.mesh.points[nodes]).max() < 1e-9
    straight = RefinedMeshes(held(mesh), sg.Accuracy(0.1, of="energy"))
    straight.first()
    bent = straight.next(np.ones(len(straight.simplices.cells)), Growth(least=3.0, most=3.0)).mesh
    assert off(bent.points[bent.nodes_of("arc")]).max() > 1e-3


def test_what_has_no_name_follows_too(ellipse):
    """The arc without its name; and not where the mesh is no more that of the geometry."""
    mesh = sg.read_mesh(ellipse)
    nodes = mesh.nodes_of("arc")
    bare = replace(mesh, boundaries={name: own for name, own in mesh.boundaries.items() if name != "arc"})
    meshes = RefinedMeshes(held(bare), sg.Accuracy(0.1, of="energy", geometry=ellipse))
    meshes.first()
    assert meshes.notes == ("'the rest of the skin' follows the geometry 'part.geo'",)
    fine = meshes.next(np.ones(len(meshes.simplices.cells)), Growth(least=3.0, most=3.0)).mesh
    assert sorted(fine.boundaries) == ["axis", "base"]
    inside = (fine.points > 1e-9).all(axis=1)
    assert np.count_nonzero(inside & (off(fine.points) < 1e-9)) > 2 * (len(nodes) - 2)
    del meshes  # Gmsh has one geometry at a time
    moved = replace(bare, points=np.where(mesh.points[:, :1] * mesh.points[:, 1:] > 0.0, 0.99, 1.0) * mesh.points)
    assert RefinedMeshes(held(moved), sg.Accuracy(0.1, of="energy", geometry=ellipse)).notes == ()


def test_new_nodes_are_on_the_faces_of_a_solid(tmp_path):
    """One boundary of a curved face and three flat ones."""
    (tmp_path / "part.geo").write_text(SOLID)
    mesh = sg.read_mesh(tmp_path / "part.geo")
    meshes = RefinedMeshes(held(mesh), sg.Accuracy(0.1, of="energy", geometry=tmp_path / "part.geo"))
    meshes.first()
    points = meshes.next(np.ones(len(meshes.simplices.cells)), Growth(least=2.0, most=2.0)).mesh
    skin = points.points[points.nodes_of("skin")]
    flat = np.abs(skin).min(axis=1) < 1e-9
    assert off(skin[~flat]).max() < 1e-6


@pytest.mark.slow
@pytest.mark.usefixtures("ellipse")
def test_a_deck_names_the_geometry(tmp_path, capsys):
    deck = tmp_path / "deck.toml"
    deck.write_text(
        """
mesh = { file = "part.geo" }
solve = { accuracy = 0.2, of = "energy", geometry = "part.geo" }
material = { steel = { E = 200.0, nu = 0.3 } }
body = [{ name = "body", material = "steel" }]
support = [{ on = "base", u = [0.0, 0.0] }]
load = [{ on = "arc", pressure = 1.0 }]
"""
    )
    assert main(["run", str(deck), "-o", str(tmp_path / "out")]) == 0
    assert "mesh: 'arc' follows the geometry 'part.geo'" in capsys.readouterr().out


def test_what_is_no_mesh_of_the_geometry_is_named(ellipse, tmp_path):
    mesh = sg.read_mesh(ellipse)
    model = held(replace(mesh, points=mesh.points * 1.1))
    with pytest.raises(InputError, match=r"node \d+ of boundary 'arc' is not on '.*part.geo'; expected a mesh of it"):
        sg.solve(model, accuracy=sg.Accuracy(0.1, of="energy", geometry=ellipse))
    with pytest.raises(InputError, match=r"accuracy\.geometry: there is no file 'none\.geo'"):
        sg.solve(model, accuracy=sg.Accuracy(0.1, of="energy", geometry="none.geo"))
    (tmp_path / "bad.geo").write_text('SystemCall "ls";')
    with pytest.raises(InputError, match="may do more than make a mesh"):
        sg.solve(model, accuracy=sg.Accuracy(0.1, of="energy", geometry=tmp_path / "bad.geo"))
