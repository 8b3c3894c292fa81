# SPDX-License-Identifier: BSD-3-Clause
"""Faces and lines that meshers write beside the cells: for sets and surfaces, and nothing else."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from tests.helpers.eight_cells import eight_cells

SKINS = """*ELEMENT,TYPE=T3D2,ELSET=EDGE
101,19,20
102,20,21
*ELEMENT,type=CPS4,ELSET=LID
111,19,20,23,22
112,20,21,24,23
113,22,25,26,23
114,23,24,27,26
"""
LOADS = "*STEP\n*STATIC\n*DSLOAD\nS,P,2.\n*EL PRINT,ELSET=LID\nS\n*EL PRINT,ELSET=E\nS\n*EL PRINT\nS\n*END STEP\n"


def deck(folder: Path, words: str) -> Path:
    path = folder / "deck.inp"
    path.write_text(words)
    return path


def test_they_carry_nothing(tmp_path: Path) -> None:
    """The body is the same without them; a surface of faces is that of the cells behind them."""
    head = eight_cells()
    with_lid = head.replace("*NSET,NSET=FIX", f"{SKINS}*NSET,NSET=FIX", 1) + "*SURFACE,NAME=S\nLID\n"
    found = load_deck(deck(tmp_path, with_lid + LOADS))
    assert any(note.startswith("T3D2, CPS4: faces and lines of the bodies") for note in found.notes)
    assert found.prints is not None
    assert [len(table.members) for table in found.prints.tables] == [0, 8, 8]
    plain = sg.read(deck(tmp_path, head + LOADS.replace("S,P", "TOP,P").replace("*EL PRINT,ELSET=LID\nS\n", "")))
    np.testing.assert_array_equal(
        sg.solve(found.model).last.displacement, sg.solve(plain).last.displacement, strict=True
    )
    assert found.model.mesh.cell_labels.tolist() == list(range(1, 9))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("ELSET=E,MATERIAL=M\n", "ELSET=E,MATERIAL=M\n*SOLID SECTION,ELSET=LID,MATERIAL=M\n", "holds CPS4 beside C3D8"),
        ("S,P,2.", "S,P,2.\n*DLOAD\nLID,P1,1.", "these elements have no face 'P1'"),
        ("TYPE=C3D8", "TYPE=S8R", "TYPE=S8R is not supported; expected CPE"),
    ],
)
def test_they_are_no_cells(tmp_path: Path, old: str, new: str, said: str) -> None:
    words = eight_cells().replace("*NSET,NSET=FIX", f"{SKINS}*NSET,NSET=FIX", 1) + "*SURFACE,NAME=S\nLID\n" + LOADS
    with pytest.raises(DeckError, match=said):
        load_deck(deck(tmp_path, words.replace(old, new)))


@pytest.mark.parametrize(("order", "dimension"), [(1, 2), (2, 2), (1, 3), (2, 3)])
def test_what_gmsh_writes_is_read(tmp_path: Path, order: int, dimension: int) -> None:
    """A bar that is pulled at the face or line that Gmsh calls Right."""
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.ElementOrder", order)
        gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", 1)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7)
        shape = gmsh.model.occ.addBox if dimension == 3 else gmsh.model.occ.addRectangle
        whole = shape(0, 0, 0, 2, 1, *([1] if dimension == 3 else []))
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(dimension, [whole], name="Bar")
        for name, x in (("Left", 0.0), ("Right", 2.0)):
            near = gmsh.model.getEntitiesInBoundingBox(x - 0.1, -1, -1, x + 0.1, 2, 2, dimension - 1)
            gmsh.model.addPhysicalGroup(dimension - 1, [tag for _, tag in near], name=name)
        gmsh.model.mesh.generate(dimension)
        gmsh.write(str(tmp_path / "mesh.inp"))
    finally:
        gmsh.finalize()
    model = sg.read(
        deck(
            tmp_path,
            "*INCLUDE,INPUT=mesh.inp\n*MATERIAL,NAME=M\n*ELASTIC\n100.,0.\n*SOLID SECTION,ELSET=Bar,MATERIAL=M\n"
            f"*SURFACE,NAME=S\nRight\n*BOUNDARY\nLeft,1,{dimension}\n*STEP\n*STATIC\n*DSLOAD\nS,P,-5.\n*END STEP\n",
        )
    )
    moved = sg.solve(model).last.displacement
    np.testing.assert_allclose(moved[:, 0], 0.05 * model.mesh.points[:, 0], atol=1e-13)
    np.testing.assert_allclose(moved[:, 1:], 0.0, atol=1e-13)
