# SPDX-License-Identifier: BSD-3-Clause
"""``*PRE-TENSION SECTION``: as CalculiX takes it, in steps, and what it refuses."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from tests.helpers.calculix import ccx_displacements, needs_ccx
from tests.helpers.eight_cells import eight_cells

MIDDLE = "1,S4\n3,S4\n5,S4\n7,S4"
PRINT = "*NODE PRINT,NSET=R\nU\n"


def deck(folder: Path, steps: list[str], *, faces: str = MIDDLE, normal: str = "", node: int = 900) -> Path:
    """Eight cells, half of them bolted to the other half, held at both ends along the bolt."""
    section = f"*NODE,NSET=REF\n900,0.,0.,0.\n*SURFACE,NAME=MIDDLE\n{faces}\n*PRE-TENSION SECTION,SURFACE=MIDDLE,NODE="
    path = folder / "bolt.inp"
    text = "".join(f"*STEP\n*STATIC\n{step}\n{PRINT}*END STEP\n" for step in steps)
    path.write_text(f"{eight_cells()}R,1\n{section}{node}\n{normal}{text}")
    return path


STEPS = {
    "force": ["*CLOAD\n900,1,3."],
    "pressed": ["*CLOAD\n900,1,-3."],
    "length": ["*BOUNDARY\n900,1,1,.01"],
    "beside another load": ["*CLOAD\n900,1,3.\nR,2,.2"],
    "tightened, then loaded": ["*CLOAD\n900,1,3.", "*CLOAD\n900,1,3.\nR,3,.2"],
}
NORMALS = {"none": "", "outwards": "1.,0.,0.\n", "into the elements": "-1.,0.,0.\n", "inclined": "1.,.2,0.\n"}


@pytest.mark.slow
@needs_ccx
@pytest.mark.parametrize("normal", NORMALS)
@pytest.mark.parametrize("steps", STEPS)
def test_it_is_what_calculix_takes_it_for(tmp_path: Path, steps: str, normal: str) -> None:
    path = deck(tmp_path, STEPS[steps], normal=NORMALS[normal])
    model = sg.read(path)
    theirs = ccx_displacements(path)
    ours = np.array([step.displacement[model.mesh.nodes["R"]] for step in sg.solve(model).steps])
    assert ours == pytest.approx(theirs, abs=2e-6 * np.abs(theirs).max())


def test_a_bolt_is_locked_by_a_support_that_stays(tmp_path: Path) -> None:
    path = deck(tmp_path, ["*CLOAD\n900,1,3.", "*BOUNDARY,FIXED\n900,1,1\n*CLOAD\nR,2,.2"])
    tight, pulled = sg.solve(sg.read(path)).steps
    node = sg.read(path).mesh.nodes["REF"][0]
    assert pulled.displacement[node] == pytest.approx(tight.displacement[node], rel=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"faces": "1,S4"}, "surface 'MIDDLE' does not cut the body apart"),
        ({"faces": "1,S1"}, "surface 'MIDDLE' has 1 facets that do not lie between two cells"),
        ({"node": 14}, "NODE=14 belongs to an element; expected a node of its own"),
        ({"node": 901}, "there is no node 901"),
        ({"normal": "0.,0.,0.\n"}, "is zero; expected the direction of the normal"),
    ],
)
def test_what_is_no_section_is_told_at_its_line(tmp_path: Path, given: dict[str, object], said: str) -> None:
    path = deck(tmp_path, ["*CLOAD\n900,1,3."], **given)
    with pytest.raises(DeckError, match=said) as told:
        load_deck(path)
    line = path.read_text().splitlines()[told.value.line - 1]
    assert line.startswith(("*PRE-TENSION", "0.,0.,0."))


def test_beams_are_refused(tmp_path: Path) -> None:
    path = deck(tmp_path, ["*CLOAD\n900,1,3."])
    path.write_text(path.read_text().replace("SECTION,SURFACE=MIDDLE", "SECTION,ELEMENT=1"))
    with pytest.raises(DeckError, match="ELEMENT is a beam, which is not supported; expected SURFACE"):
        load_deck(path)
