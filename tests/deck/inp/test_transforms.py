# SPDX-License-Identifier: BSD-3-Clause
"""``*TRANSFORM``: the block turned as a whole says what is held, pushed, coupled and printed; and CalculiX does."""

import subprocess
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from signorini.engine.solve import solve
from signorini.output.dat import write_dat
from signorini.output.fields import Fields
from tests.helpers.calculix import needs_ccx
from tests.helpers.eight_cells import eight_cells

HEAD = eight_cells()
ANGLE = np.deg2rad(30.0)
TURN = np.array([[np.cos(ANGLE), -np.sin(ANGLE), 0.0], [np.sin(ANGLE), np.cos(ANGLE), 0.0], [0.0, 0.0, 1.0]])
AXES = f"*TRANSFORM,NSET=ALL\n{','.join(f'{x:.12f}' for x in (*TURN[:, 0], *(TURN[:, 1] + TURN[:, 0])))}\n"
CYLINDER = "*TRANSFORM,NSET=ALL,TYPE=C\n.1,-.2,.3,.4,.5,2.\n"
MODEL = "*BOUNDARY\nR,2\n*EQUATION\n2\n6,1,1.,12,2,-2.\n"
STEP = "*STEP\n*STATIC\n*CLOAD\n18,1,1.\n18,3,2.\nR,3,.5\n*NODE PRINT,NSET=ALL{}\nU\n*END STEP\n"
STEPS = STEP.format(",GLOBAL=YES") + STEP.format("").replace("18,1,1.", "9,1,1.")


def written(folder: Path, text: str) -> Path:
    path = folder / "deck.inp"
    path.write_text(text)
    return path


def turned(text: str) -> str:
    """The block turned by the angle."""
    begin, end = text.index("*NODE,NSET=ALL\n") + len("*NODE,NSET=ALL\n"), text.index("*ELEMENT")
    rows = np.array([line.split(",") for line in text[begin:end].split()], float)
    points = rows[:, 1:] @ TURN.T
    lines = [f"{int(n)},{x:.14g},{y:.14g},{z:.14g}\n" for n, (x, y, z) in zip(rows[:, 0], points, strict=True)]
    return text[:begin] + "".join(lines) + text[end:]


def displacements(path: Path) -> np.ndarray:
    return np.array([step.displacement for step in sg.solve(sg.read(path)).steps])


def test_turned_axes_are_those_of_a_turned_block(tmp_path: Path) -> None:
    """Supports, forces and equations along them do to it what those along x, y, z do to the block as it was."""
    plain = displacements(written(tmp_path, HEAD + MODEL + STEPS))
    deck = load_deck(written(tmp_path, turned(HEAD) + AXES + MODEL + STEPS))
    assert sum("their forces are not among the reactions" in note for note in deck.notes) == 1
    found = np.array([step.displacement for step in solve(deck.model).steps])
    np.testing.assert_allclose(found, plain @ TURN.T, rtol=0.0, atol=1e-12 * np.abs(plain).max())


def test_a_quarter_turn_moves_supports_too(tmp_path: Path) -> None:
    """Directions that are axes of the model are supports, moved and with reactions."""
    move = "*STEP\n*STATIC\n*BOUNDARY\nR,{},{},{}\n*END STEP\n"
    plain = displacements(written(tmp_path, HEAD + move.format(1, 1, -0.02)))
    axes = "*TRANSFORM,NSET=R\n0.,1.,0.,-1.,0.,0.\n"
    np.testing.assert_array_equal(displacements(written(tmp_path, HEAD + axes + move.format(2, 2, 0.02))), plain)


@needs_ccx
@pytest.mark.parametrize("axes", [AXES, CYLINDER])
def test_they_are_those_of_calculix(tmp_path: Path, axes: str) -> None:
    """Tables too: along the axes of the nodes, with an L behind each row, unless they are asked for otherwise."""
    path = written(tmp_path, HEAD + axes + MODEL + STEPS)
    subprocess.run(["ccx", "deck"], cwd=tmp_path, capture_output=True, check=True, timeout=60)
    theirs = path.with_suffix(".dat").read_text()
    deck = load_deck(path)
    history = solve(deck.model)
    write_dat(history, Fields(deck.model), deck.prints, tmp_path / "ours.dat")
    ours = (tmp_path / "ours.dat").read_text()
    rows = [[line.split() for line in text.splitlines() if line[:10].strip().isdigit()] for text in (theirs, ours)]
    assert [[row[0], len(row)] for row in rows[0]] == [[row[0], len(row)] for row in rows[1]]
    assert len(rows[0]) == 54
    values = [np.array([row[1:4] for row in found], float) for found in rows]
    np.testing.assert_allclose(values[1], values[0], rtol=0.0, atol=1e-6 * np.abs(values[0]).max())


def test_the_last_transform_of_a_node_counts(tmp_path: Path) -> None:
    one, two = (displacements(written(tmp_path, HEAD + axes + STEPS)) for axes in (AXES, CYLINDER + AXES))
    np.testing.assert_array_equal(one, two)


PLANE = HEAD.replace("C3D8", "CPE4")
WRONG = {
    "no direction": (AXES.split("\n")[0] + "\n1.,0.,0.,2.,0.,0.\n", "its points leave no direction; expected points"),
    "no axis": (CYLINDER.split("\n")[0] + "\n1.,0.,0.,1.,0.,0.\n", "its points leave no direction; expected points"),
    "a type": (AXES.replace("NSET=ALL", "NSET=ALL,TYPE=S"), "TYPE: unknown value 'S'. Known: C, R"),
    "moved": (AXES + "*BOUNDARY\nR,1,1,.1\n", r"moves node 3 along direction 1 of its \*TRANSFORM, across the axes"),
    "a reference": (
        AXES + "*NODE,NSET=ALL\n101,3.,0.,0.\n*RIGID BODY,NSET=R,REF NODE=101\n*BOUNDARY\n101,2\n",
        r"acts on the reference node 101, which \*TRANSFORM turns",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_not_understood_stops(tmp_path: Path, case: str) -> None:
    lines, said = WRONG[case]
    with pytest.raises(DeckError, match=r"deck.inp:\d+: \*\w+: .*" + said):
        load_deck(written(tmp_path, HEAD + lines + STEPS))
