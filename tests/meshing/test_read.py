# SPDX-License-Identifier: BSD-3-Clause
"""Meshes from files: physical groups become names, whatever the version of the format, and mistakes are told."""

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.meshing.read import read_mesh

NAMES = """$PhysicalNames
5
0 3 "corner"
1 1 "bottom"
1 2 "top"
2 4 "block"
2 5 "wedge"
$EndPhysicalNames
"""

# a unit square beside a triangle
VERSION_2 = f"""$MeshFormat
2.2 0 8
$EndMeshFormat
{NAMES}$Nodes
5
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 2 0 0
$EndNodes
$Elements
6
1 15 2 3 1 1
2 1 2 1 1 1 2
3 1 2 1 1 2 5
4 1 2 2 2 3 4
5 3 2 4 1 1 2 3 4
6 2 2 5 2 2 5 3
$EndElements
"""

VERSION_4 = f"""$MeshFormat
4.1 0 8
$EndMeshFormat
{NAMES}$Entities
1 2 2 0
1 0 0 0 1 3
1 0 0 0 2 0 0 1 1 0
2 0 1 0 1 1 0 1 2 0
1 0 0 0 1 1 0 1 4 0
2 1 0 0 2 1 0 1 5 0
$EndEntities
$Nodes
1 5 1 5
2 1 0 5
1
2
3
4
5
0 0 0
1 0 0
1 1 0
0 1 0
2 0 0
$EndNodes
$Elements
5 6 1 6
0 1 15 1
1 1
1 1 1 2
2 1 2
3 2 5
1 2 1 1
4 3 4
2 1 3 1
5 1 2 3 4
2 2 2 1
6 2 5 3
$EndElements
"""


@pytest.fixture(params=[VERSION_2, VERSION_4], ids=["msh 2.2", "msh 4.1"])
def text(request):
    return request.param


def write(folder, text):
    path = folder / "mesh.msh"
    path.write_text(text)
    return path


def test_groups_become_names(tmp_path, text):
    mesh = read_mesh(write(tmp_path, text))
    assert mesh.points.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0]]
    assert {family: cells.tolist() for family, cells in mesh.cells.items()} == {
        "quad": [[0, 1, 2, 3]],
        "triangle": [[1, 4, 2]],
    }
    assert set(mesh.bodies) == {"block", "wedge"}
    families = list(mesh.cells)
    assert mesh.bodies["block"].tolist() == [families.index("quad")]
    assert mesh.bodies["wedge"].tolist() == [families.index("triangle")]
    assert mesh.boundaries["bottom"].tolist() == [[0, 1], [1, 4]]
    assert mesh.boundaries["top"].tolist() == [[2, 3]]
    assert mesh.nodes["corner"].tolist() == [0]
    assert sum(volumes.sum() for volumes in make_space(mesh).volumes) == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.replace("3 1 1 0\n", "3 1 1 0.5\n"), r"is not plane: z goes from 0 to 0.5"),
        (lambda t: t.replace("6 2 2 5 2 2 5 3", "6 21 2 5 2 2 5 3 1 1 1 1 1 1 1"), "1 cells of the kind 'triangle10'"),
        (lambda t: t[:200], "meshio cannot read"),
        (lambda _: "nonsense", "meshio cannot read"),
    ],
    ids=["not plane", "third order", "cut off", "no mesh"],
)
def test_mistakes_in_a_file(tmp_path, change, message):
    with pytest.raises(InputError, match=message):
        read_mesh(write(tmp_path, change(VERSION_2)))


def test_a_mesh_without_nodes_is_refused(tmp_path):
    path = tmp_path / "mesh.msh"
    path.write_bytes(b"$MeshFormat\n2.2 1 8\n" + np.int32(1).tobytes() + b"\n$EndMeshFormat\n$Nodes\n-2147483649\n")
    with pytest.raises(InputError, match="holds no nodes"):
        read_mesh(path)


def test_lines_alone_are_no_mesh(tmp_path):
    text = VERSION_2.replace("\n6\n1 15", "\n4\n1 15")
    text = "\n".join(line for line in text.splitlines() if not line.startswith(("5 3 2 4", "6 2 2 5")))
    with pytest.raises(InputError, match="holds no triangles or quadrilaterals; it has vertex, line"):
        read_mesh(write(tmp_path, text + "\n"))


@pytest.mark.parametrize(
    "text",
    [
        VERSION_2.replace("$Elements\n6\n", "$Elements\n8\n7 1 2 2 1 1 2\n8 1 2 2 1 2 5\n"),
        VERSION_4.replace("1 0 0 0 2 0 0 1 1 0", "1 0 0 0 2 0 0 2 1 2 0"),
    ],
    ids=["msh 2.2", "msh 4.1"],
)
def test_a_curve_of_several_groups_is_in_all_of_them(tmp_path, text):
    mesh = read_mesh(write(tmp_path, text))
    assert sorted(mesh.boundaries["bottom"].tolist()) == [[0, 1], [1, 4]]
    assert sorted(mesh.boundaries["top"].tolist()) == [[0, 1], [1, 4], [2, 3]]


@pytest.mark.parametrize(
    "text",
    [
        VERSION_2.replace("$Elements\n6\n", "$Elements\n7\n7 3 2 5 1 1 2 3 4\n"),
        VERSION_4.replace("1 0 0 0 1 1 0 1 4 0", "1 0 0 0 1 1 0 2 4 5 0"),
    ],
    ids=["msh 2.2", "msh 4.1"],
)
def test_a_cell_of_several_groups_is_there_once(tmp_path, text):
    """Version 2 writes it once for every group, which would make the body twice as stiff."""
    mesh = read_mesh(write(tmp_path, text))
    square, both = sorted(mesh.bodies.values(), key=len)
    assert (mesh.number_of_cells, len(square), len(both)) == (2, 1, 2)
    assert mesh.cells["quad"].tolist() == [[0, 1, 2, 3]]


def test_a_missing_file(tmp_path):
    with pytest.raises(InputError, match=r"mesh.file: there is no file '.*none.msh'"):
        read_mesh(tmp_path / "none.msh")


def test_without_physical_groups_there_are_elementary_ones(tmp_path):
    text = VERSION_2.replace(NAMES, "").replace(" 2 4 1 1 2", " 2 0 1 1 2").replace(" 2 5 2 2 5", " 2 0 2 2 5")
    for old, new in (("15 2 3", "15 2 0"), ("1 2 1 1", "1 2 0 1"), ("1 2 2 2", "1 2 0 2")):
        text = text.replace(old, new)
    mesh = read_mesh(write(tmp_path, text))
    assert {name: len(cells) for name, cells in mesh.bodies.items()} == {"surface 1": 1, "surface 2": 1}
    assert set(mesh.boundaries) == {"curve 1", "curve 2"}
    assert set(mesh.nodes) == {"point 1"}


@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize("recombine", [False, True])
def test_gmsh(tmp_path, version, recombine):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        disk = gmsh.model.occ.addDisk(0, 0, 0, 2, 2)
        gmsh.model.occ.synchronize()
        (rim,) = (tag for dimension, tag in gmsh.model.getBoundary([(2, disk)]) if dimension == 1)
        gmsh.model.addPhysicalGroup(2, [disk], name="roller")
        gmsh.model.addPhysicalGroup(1, [abs(rim)], name="rim")
        if recombine:
            gmsh.model.mesh.setRecombine(2, disk)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.25)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "disk.msh"))
    finally:
        gmsh.finalize()
    mesh = read_mesh(tmp_path / "disk.msh")
    assert ("quad" in mesh.cells) is recombine
    space = make_space(mesh)
    assert sum(volumes.sum() for volumes in space.volumes) == pytest.approx(4 * np.pi, rel=0.01)
    (side,) = boundary(space, "rim", ("test",)).blocks
    assert side.lengths.sum() == pytest.approx(4 * np.pi, rel=0.01)
    middles = mesh.points[side.facets].mean(axis=1)
    np.testing.assert_allclose(side.normals, middles / np.linalg.norm(middles, axis=1, keepdims=True), atol=1e-9)
    assert set(mesh.bodies) == {"roller"}
    assert len(mesh.bodies["roller"]) == mesh.number_of_cells


def test_gmsh_boxes_without_groups_with_stray_elements_and_of_other_kinds(tmp_path):
    """Elementary groups in space; what "save all" and third order leave is refused with what to do."""
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    path = str(tmp_path / "mesh.msh")
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        gmsh.write(path)
        mesh = read_mesh(path)
        assert set(mesh.bodies) == {"volume 1"}
        assert set(mesh.boundaries) == {f"surface {i}" for i in range(1, 7)}
        gmsh.model.addPhysicalGroup(3, [1], name="block")
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        gmsh.write(path)
        with pytest.raises(InputError, match=r"Save the groups alone, Mesh.SaveAll = 0"):
            read_mesh(path)
        gmsh.option.setNumber("Mesh.SaveAll", 0)
        gmsh.model.mesh.setOrder(3)
        gmsh.write(path)
        with pytest.raises(InputError, match=r"of the kind 'tetra20'.*Mesh.SecondOrderIncomplete = 1"):
            read_mesh(path)
    finally:
        gmsh.finalize()
