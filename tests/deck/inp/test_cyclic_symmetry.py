# SPDX-License-Identifier: BSD-3-Clause
"""``*CYCLIC SYMMETRY MODEL`` in static steps: as CalculiX takes it, and what it refuses."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from tests.helpers.calculix import ccx_displacements, needs_ccx

FLAT = sg.annulus(inner=1.0, outer=2.0, n_radial=2, n_angular=4, angle=60.0, centre=(0.0, 0.0))
SECTOR = sg.extruded(FLAT, z=[0.0, 0.25, 0.5])


def rows(nodes: np.ndarray) -> str:
    return "\n".join(str(node + 1) for node in nodes)


def deck(folder: Path, *, model: str = "N=6,TIE=T1", axis: str = "0.,0.,0.,0.,0.,1.") -> Path:
    """A sector of a ring, spun and pulled at some of its nodes."""
    nodes = "\n".join(f"{k},{x:.10g},{y:.10g},{z:.10g}" for k, (x, y, z) in enumerate(SECTOR.points, start=1))
    bricks = enumerate(SECTOR.cells["hexahedron"], start=1)
    cells = "\n".join(f"{k}," + ",".join(map(str, cell + 1)) for k, cell in bricks)
    sides = "".join(f"*SURFACE,NAME={name},TYPE=NODE\n{rows(SECTOR.nodes_of(name))}\n" for name in ("start", "end"))
    held = np.setdiff1d(SECTOR.nodes_of("inner"), SECTOR.nodes_of("start"))  # those follow, which CalculiX wants
    path = folder / "sector.inp"
    path.write_text(
        f"*NODE,NSET=ALL\n{nodes}\n*ELEMENT,TYPE=C3D8,ELSET=E\n{cells}\n*NSET,NSET=INNER\n{rows(held)}\n{sides}"
        "*MATERIAL,NAME=M\n*ELASTIC\n1000.,.3\n*DENSITY\n2.\n*SOLID SECTION,ELSET=E,MATERIAL=M\n"
        "*BOUNDARY\nINNER,1,3\n*TIE,CYCLIC SYMMETRY,POSITION TOLERANCE=.1,NAME=T1\nstart,end\n"
        f"*CYCLIC SYMMETRY MODEL,{model}\n{axis}\n*STEP\n*STATIC\n*DLOAD\nE,CENTRIF,3.,0.,0.,0.,0.,0.,1.\n"
        "*CLOAD\n9,1,1.5\n9,2,-.5\n9,3,.3\n*NODE PRINT,NSET=ALL\nU\n*END STEP\n"
    )
    return path


def solved(path: Path) -> sg.Solution:
    """What the command line does with a deck."""
    found = load_deck(path)
    try:
        return sg.solve(found.model)
    except sg.InputError as error:
        raise found.locate(error) from error


@needs_ccx
def test_a_sector_is_what_calculix_takes_it_for(tmp_path: Path) -> None:
    path = deck(tmp_path)
    theirs = ccx_displacements(path)[0]
    ours = sg.solve(sg.read(path)).steps[0].displacement
    assert ours == pytest.approx(theirs, abs=2e-6 * np.abs(theirs).max())


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"model": "N=6,TIE=T2"}, "CYCLIC SYMMETRY 'T2'"),
        ({"model": "N=6.5"}, "N is '6.5'; expected a whole number of sectors"),
        ({"model": "N=7"}, "turned by 1/7 of a full turn"),
        ({"model": "N=1"}, "sectors: is 1"),
        ({"model": "N=6,CONTACT"}, "CONTACT is not supported"),
        ({"axis": "1.,0.,0.,1.,0.,0."}, "has one point twice; expected two points of the axis"),
    ],
)
def test_what_is_no_sector_is_told(tmp_path: Path, given: dict[str, str], said: str) -> None:
    path = deck(tmp_path, **given)
    with pytest.raises(DeckError, match=said) as told:
        solved(path)
    assert path.read_text().splitlines()[told.value.line - 1].startswith(("*CYCLIC", "1.,0.,0."))
