# SPDX-License-Identifier: BSD-3-Clause
"""Mesh files that want to run something, to reach other files, or to claim more than they hold."""

from collections.abc import Callable
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest

from signorini.errors import InputError
from signorini.hdf5 import check_hdf5
from signorini.meshing.files import open_mesh
from tests.helpers.gmsh_block import GEOMETRY

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
VTK = "# vtk DataFile Version 4.2\n\nASCII\nDATASET UNSTRUCTURED_GRID\n"
SQUARE = meshio.Mesh(POINTS, [("quad", np.array([[0, 1, 2, 3]]))])


@pytest.mark.parametrize(
    ("word", "line"),
    [
        ("SystemCall", 'SystemCall "touch {folder}/ran";'),
        ("NonBlockingSystemCall", 'NonBlockingSystemCall "touch {folder}/ran";'),
        ("ExternalProcess", "Field[1] = ExternalProcess;"),
        ("CommandLine", 'Field[1].CommandLine = "touch {folder}/ran";'),
        ("Merge", 'Merge "/etc/passwd";'),
        ("Include", 'Include "/etc/passwd";'),
        ("Parse", 'x = Parse["SystemCall"];'),
        ("General", "General.SaveSession = 1;"),
        ("Exit", "Exit;"),
        ("Printf", 'Printf("a") > "{folder}/ran";'),
        ("Whatever", 'Whatever "comes later";'),
        ("SystemCall", '// a comment\rSystemCall "touch {folder}/ran";'),
        ("SystemCall", 'If (1) x = 1;2SystemCall "touch {folder}/ran"; EndIf'),
        ("Save", 'Save = 1; Save "{folder}/ran";'),
    ],
)
def test_a_geometry_makes_nothing_but_a_mesh(tmp_path: Path, word: str, line: str) -> None:
    pytest.importorskip("gmsh")
    (tmp_path / "block.geo").write_text(GEOMETRY + line.format(folder=tmp_path) + "\n")
    with pytest.raises(InputError, match=f"has '{word}', which may do more than make a mesh"):
        open_mesh(tmp_path / "block.geo")
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize("line", ['x = "a\n" SystemCall "b";', r'x = "a\" ; " SystemCall "b\" ";', 'SystemCall "a'])
def test_a_geometry_hides_nothing_in_strings(tmp_path: Path, line: str) -> None:
    pytest.importorskip("gmsh")
    (tmp_path / "block.geo").write_text(GEOMETRY + line)
    with pytest.raises(InputError, match="has strings that are not clear"):
        open_mesh(tmp_path / "block.geo")


def test_a_geometry_may_have_names_comments_and_options(tmp_path: Path) -> None:
    pytest.importorskip("gmsh")
    own = 'Size = 0.5; // SystemCall "x"\n/* Merge */ Sizes[] = {1, 2}; For K In {0:1} Size = Size / 1.1; EndFor\n'
    (tmp_path / "block.geo").write_text(own + GEOMETRY + "Mesh.MeshSizeMax = Size; Mesh.Algorithm = 6;\n")
    assert len(open_mesh(tmp_path / "block.geo").points) > 4


def external_link(folder: Path) -> None:
    with h5py.File(folder / "a.h5", "w") as file:
        file["data"] = h5py.ExternalLink("/etc/other.h5", "/data")


def external_data(folder: Path) -> None:
    with h5py.File(folder / "a.h5", "w") as file:
        file.create_dataset("data", (4,), "u1", external=[("/etc/hostname", 0, 4)])


def virtual_data(folder: Path) -> None:
    layout = h5py.VirtualLayout((4,), "f8")
    layout[:] = h5py.VirtualSource("/etc/other.h5", "data", shape=(4,))
    with h5py.File(folder / "a.h5", "w") as file:
        file.create_virtual_dataset("data", layout)


def claim(folder: Path) -> None:
    with h5py.File(folder / "a.h5", "w") as file:
        file.create_dataset("data", (10**13,), "f8", chunks=(1000,))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (external_link, "links 'data' to another file"),
        (external_data, "has data of another file in 'data'"),
        (virtual_data, "has data of another file in 'data'"),
        (claim, r"a\.h5' takes 8e\+04 GB of memory; there are"),
    ],
)
def test_hdf5_files_hold_what_they_hold(tmp_path: Path, make: Callable[[Path], None], said: str) -> None:
    make(tmp_path)
    with pytest.raises(InputError, match=said):
        check_hdf5(tmp_path / "a.h5")
    meshio.write(tmp_path / "a.xdmf", SQUARE)
    make(tmp_path)
    with pytest.raises(InputError, match=said):
        open_mesh(tmp_path / "a.xdmf")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            lambda text: text.replace("a.h5:", "/etc/a.h5:"),
            "names the file '/etc/a.h5'; expected",
        ),
        (lambda text: text.replace("a.h5:", "../a.h5:"), "names the file"),
        (lambda text: text.replace('Format="HDF"', 'Format="Binary"'), "names the file"),
        (lambda text: '<!DOCTYPE a [<!ENTITY b "c">]>' + text, "defines entities of XML"),
        (lambda text: text.replace("<", "?", 1), "is no XML that can be read"),
    ],
)
def test_xdmf_stays_beside_itself(tmp_path: Path, change: Callable[[str], str], said: str) -> None:
    meshio.write(tmp_path / "a.xdmf", SQUARE)
    assert len(open_mesh(tmp_path / "a.xdmf").points) == 4
    (tmp_path / "a.xdmf").write_text(change((tmp_path / "a.xdmf").read_text()))
    with pytest.raises(InputError, match=said):
        open_mesh(tmp_path / "a.xdmf")


@pytest.mark.parametrize("line", ["*INCLUDE, INPUT=/etc/passwd", "*include,input=x", "**INC*LUDE,INPUT=x"])
def test_a_mesh_of_keywords_includes_nothing(tmp_path: Path, line: str) -> None:
    meshio.write(tmp_path / "a.inp", SQUARE)
    with (tmp_path / "a.inp").open("a") as file:
        file.write(f"{line}\n")
    with pytest.raises(InputError, match="includes another file"):
        open_mesh(tmp_path / "a.inp")


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.off", "OFF\n# nothing else\n", "ends too early"),
        ("a.ply", "ply\nformat ascii 1.0\n", "ends too early"),
        ("a.bdf", "BEGIN BULK\n", "ends too early"),
        ("a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1000000000000 1 1\n", "meshio cannot read"),
        ("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1000000000000\n", "meshio cannot read"),
        ("a.vtk", f"{VTK}POINTS 1000000000000 double\n", "meshio cannot read"),
        ("a.stl", b"\0" * 80 + b"\xff\xff\xff\xff", "holds no points"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "holds a cell of node 9, but 3 nodes"),
        ("a.unv", "    -1\n  2467\n 1 0 0 0 0 0 0 9\n    -1\n", "is no universal file that can be read"),
    ],
)
def test_what_is_claimed_and_not_there_is_refused(tmp_path: Path, name: str, text: str | bytes, said: str) -> None:
    (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError, match=said):
        open_mesh(tmp_path / name)
