# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of other programs: geometries of Gmsh, groups of MED files, sets of Abaqus meshes."""

import sys
from pathlib import Path

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.fem.space import make_space
from signorini.meshing.read import read_mesh
from tests.helpers.gmsh_block import GEOMETRY

POINTS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]])
QUADS, LINES = np.array([[0, 1, 2, 3], [1, 4, 5, 2]]), np.array([[0, 1], [1, 4]])


def test_groups_of_a_med_file_are_names(tmp_path: Path) -> None:
    """Cells 0 and 1 are of the families one and two, which share a group; edges and points have theirs."""
    mesh = meshio.Mesh(
        POINTS,
        [("quad", QUADS), ("line", LINES)],
        point_data={"point_tags": np.array([1, 0, 0, 1, 0, 0])},
        cell_data={"cell_tags": [np.array([-1, -2]), np.array([-3, -3])]},
    )
    mesh.point_tags = {1: ["left nodes"]}
    mesh.cell_tags = {-1: ["one", "both"], -2: ["two", "both"], -3: ["bottom"]}
    meshio.write(tmp_path / "mesh.med", mesh)
    found = read_mesh(tmp_path / "mesh.med")
    assert {name: cells.tolist() for name, cells in found.bodies.items()} == {"one": [0], "two": [1], "both": [0, 1]}
    assert found.boundaries["bottom"].tolist() == LINES.tolist()
    assert found.nodes["left nodes"].tolist() == [0, 3]


def test_sets_of_an_abaqus_mesh_are_names(tmp_path: Path) -> None:
    sets = {"one": [np.array([0])], "two": [np.array([1])]}
    mesh = meshio.Mesh(POINTS, [("quad", QUADS)], point_sets={"left": np.array([0, 3])}, cell_sets=sets)
    meshio.write(tmp_path / "mesh.inp", mesh)
    found = read_mesh(tmp_path / "mesh.inp")
    assert {name: cells.tolist() for name, cells in found.bodies.items()} == {"one": [0], "two": [1]}
    assert found.nodes["left"].tolist() == [0, 3]


def test_a_geometry_is_meshed(tmp_path: Path) -> None:
    pytest.importorskip("gmsh")
    (tmp_path / "block.geo").write_text(GEOMETRY)
    found = read_mesh(tmp_path / "block.geo")
    assert set(found.cells) == {"triangle6"}
    assert set(found.bodies) == {"block"}
    assert found.boundaries["bottom"].shape[1] == 3
    assert sum(volumes.sum() for volumes in make_space(found).volumes) == pytest.approx(2.0)
    (tmp_path / "broken.geo").write_text("Rectangle(1) = {0, 0;\n")
    with pytest.raises(sg.InputError, match=r"Gmsh cannot mesh '.*broken.geo'"):
        read_mesh(tmp_path / "broken.geo")


def test_a_geometry_needs_gmsh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gmsh", None)
    (tmp_path / "block.geo").write_text(GEOMETRY)
    with pytest.raises(sg.InputError, match=r"there is no Gmsh .* expected pip install 'signorini\[gmsh\]'"):
        read_mesh(tmp_path / "block.geo")


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("solid", [False, True])
def test_universal_files_are_what_gmsh_means(tmp_path: Path, order: int, solid: bool) -> None:
    """The same mesh with the same groups through Gmsh's own format; middle nodes are in the middles of their edges."""
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
        gmsh.option.setNumber("Mesh.ElementOrder", order)
        occ = gmsh.model.occ
        tag = occ.addBox(0, 0, 0, 1, 1, 1) if solid else occ.addRectangle(0, 0, 0, 2, 1)
        occ.synchronize()
        d = 3 if solid else 2
        sides = gmsh.model.getBoundary([(d, tag)], oriented=False)
        gmsh.model.addPhysicalGroup(d, [tag], name="block")
        gmsh.model.addPhysicalGroup(d - 1, [sides[0][1]], name="side")
        gmsh.model.mesh.generate(d)
        for name in ("mesh.msh", "mesh.unv"):
            gmsh.write(str(tmp_path / name))
    finally:
        gmsh.finalize()
    one, two = (read_mesh(tmp_path / f"mesh.{suffix}") for suffix in ("msh", "unv"))
    ((family, cells),) = two.cells.items()
    assert {family: len(nodes) for family, nodes in one.cells.items()} == {family: len(cells)}
    assert (set(two.bodies), set(two.boundaries)) == ({"block"}, {"side"})
    np.testing.assert_allclose(one.points[one.cells[family]], two.points[cells], atol=1e-12)
    np.testing.assert_allclose(
        one.points[one.boundaries["side"]].mean(axis=(0, 1)), two.points[two.boundaries["side"]].mean(axis=(0, 1))
    )
    make_space(two)


@pytest.mark.parametrize(("kind", "quads"), [("hexahedron20", True), ("wedge15", False)])
def test_quadratic_bricks_and_wedges_of_universal_files(tmp_path: Path, kind: str, quads: bool) -> None:
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        for name, value in (("General.Terminal", 0), ("Mesh.SecondOrderIncomplete", 1), ("Mesh.ElementOrder", 2)):
            gmsh.option.setNumber(name, value)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 1.0)
        geo = gmsh.model.geo
        corners = [geo.addPoint(x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        edges = [geo.addLine(corners[i], corners[(i + 1) % 4]) for i in range(4)]
        base = geo.addPlaneSurface([geo.addCurveLoop(edges)])
        if quads:
            for edge in edges:
                geo.mesh.setTransfiniteCurve(edge, 2)
            geo.mesh.setTransfiniteSurface(base)
            geo.mesh.setRecombine(2, base)
        raised = geo.extrude([(2, base)], 0, 0, 1, [1], recombine=True)
        geo.synchronize()
        gmsh.model.addPhysicalGroup(3, [tag for d, tag in raised if d == 3], name="block")
        gmsh.model.mesh.generate(3)
        for name in ("mesh.msh", "mesh.unv"):
            gmsh.write(str(tmp_path / name))
    finally:
        gmsh.finalize()
    one, two = (read_mesh(tmp_path / f"mesh.{suffix}") for suffix in ("msh", "unv"))
    np.testing.assert_allclose(one.points[one.cells[kind]], two.points[two.cells[kind]], atol=1e-12)


def test_a_broken_universal_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mesh.unv").write_text("    -1\n  2412\n 1 44 1 1 1 4\n 1 2\n    -1\n")
    with pytest.raises(sg.InputError, match="is no universal file that can be read"):
        read_mesh(tmp_path / "mesh.unv")
    (tmp_path / "mesh.unv").write_text("    -1\n  2412\n 1 171 1 1 1 1\n 1\n    -1\n")
    with pytest.raises(sg.InputError, match="holds element 1 of the kind 171"):
        read_mesh(tmp_path / "mesh.unv")
