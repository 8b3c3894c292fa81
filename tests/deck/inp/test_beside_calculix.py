# SPDX-License-Identifier: BSD-3-Clause
"""Contacts, ties and links of decks beside CalculiX, where it is installed: two blocks of four bricks, one on top.

Penalties of the contacts are part of the decks; forces are small, since contact follows the displaced sides there.
"""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import load_deck
from tests.helpers.calculix import ccx_displacements, needs_ccx

PRESS = "*BOUNDARY\nHEAD,1,2\nHEAD,3,3,-.0005"
PULL = "*BOUNDARY\nHEAD,1,2\nHEAD,3,3,.0005"
SLIDE = "*BOUNDARY\nHEAD,1,1,.002"
SOFT = "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n1.E6\n*FRICTION\n.3,1.E5\n"
TABLE = SOFT.replace("=LINEAR\n1.E6", "=TABULAR\n0.,0.\n.1,1.E-4\n2.,2.E-4")
CURVE = SOFT.replace("=LINEAR\n1.E6", "=EXPONENTIAL\n1.E-4,.1")
FACES = "*CONTACT PAIR,INTERACTION=I,TYPE=SURFACE TO SURFACE\nSL,MA\n"
NODES = FACES.replace("SURFACE TO", "NODE TO")
REFERENCE = "*TIE,NAME=T\nSL,MA\n*SURFACE,NAME=UP\nEB,S2\n*NODE\n101,.5,.5,3.\n102,0,0,0\n"
BODY = f"{REFERENCE}*RIGID BODY,NSET=HEAD,REF NODE=101,ROT NODE=102\n"
WARM = "*TIE,NAME=T\nSL,MA\n*INITIAL CONDITIONS,TYPE=TEMPERATURE\nALL,20.\n"


def law(words: str = SOFT, pair: str = FACES) -> str:
    return f"*SURFACE INTERACTION,NAME=I\n{words}{pair}"


# what the deck says before its steps, its steps, initial gap, increments of CalculiX, and the largest difference as a
# part of the largest displacement: a little more than was measured
CASES: dict[str, tuple[str, list[str], float, int, float]] = {
    "pressed": (law(), [PRESS], 0.0, 1, 2e-4),
    "nodes pressed": (law(pair=NODES), [PRESS], 0.0, 1, 2e-4),
    "pressed on a table of pressures": (law(TABLE, NODES), [PRESS], 0.0, 4, 4e-6),
    "pressed on an exponential law": (law(CURVE, NODES), [PRESS], 0.0, 4, 4e-4),
    "pressed and dragged": (law(), [PRESS, SLIDE], 0.0, 10, 1e-3),
    "friction changed": (
        law(),
        [PRESS, SLIDE, "*CHANGE FRICTION,INTERACTION=I\n*FRICTION\n.1,1.E5\n*BOUNDARY\nHEAD,1,1,.004"],
        0.0,
        10,
        1e-3,
    ),
    "switched off and on": (
        law(),
        [
            PRESS,
            "*MODEL CHANGE,TYPE=CONTACT PAIR,REMOVE\nSL,MA",
            "*MODEL CHANGE,TYPE=CONTACT PAIR,ADD\nSL,MA",
        ],
        0.0,
        1,
        2e-4,
    ),
    "a gap": (law(), [PRESS], 1e-4, 1, 2e-4),
    "a clearance": (law() + "*CLEARANCE,MASTER=MA,SLAVE=SL,VALUE=.0002\n", [PRESS], 0.0, 1, 2e-4),
    "a gap adjusted": (law(pair=FACES.replace("\n", ",ADJUST=.00015\n", 1)), [PRESS], 1e-4, 1, 2e-4),
    "TIED": (
        law("*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=TIED\n1.E7\n*FRICTION\n.3,1.E7\n"),
        [PULL],
        0.0,
        1,
        2e-4,
    ),
    "tied": ("*TIE,NAME=T\nSL,MA\n", [PULL], 0.0, 1, 1e-6),
    "equations": (
        f"{REFERENCE}*EQUATION\n2\n28,3,1.,36,3,-1.\n3\n31,1,1.,32,1,-.5,33,1,-.5\n",
        ["*CLOAD\n36,3,2.\n31,1,.5"],
        0.0,
        1,
        1e-6,
    ),
    "a rigid body loaded": (BODY, ["*CLOAD\n101,1,2.\n102,2,.5\n101,3,-1."], 0.0, 1, 1e-6),
    "a rigid body moved": (BODY, ["*BOUNDARY\n101,1,3,.001\n102,1,3,.002"], 0.0, 1, 1e-6),
    "coupled": (
        f"{REFERENCE}*COUPLING,REF NODE=101,SURFACE=UP,CONSTRAINT NAME=C\n*KINEMATIC\n1,3\n",
        ["*CLOAD\n101,1,2.\n101,5,.5\n101,3,-1."],
        0.0,
        1,
        1e-6,
    ),
    "two directions coupled": (
        f"{REFERENCE}*COUPLING,REF NODE=101,SURFACE=UP,CONSTRAINT NAME=C\n*KINEMATIC\n1\n3\n",
        ["*CLOAD\n101,1,2.\n101,5,.5\n101,3,-1."],
        0.0,
        1,
        1e-6,
    ),
    "warm, then cold": (WARM, ["*TEMPERATURE\nALL,30.", "*TEMPERATURE,OP=NEW\nALL,15."], 0.0, 1, 1e-6),
    "warm by an amplitude": (
        WARM.replace("20.", "0.") + "*AMPLITUDE,NAME=A\n0.,1.,1.,2.\n",
        ["*TEMPERATURE,AMPLITUDE=A\nALL,30.", "*STATIC\n2.,2."],
        0.0,
        1,
        1e-6,
    ),
}


def deck(folder: Path, words: str, steps: list[str], gap: float, increments: int) -> Path:
    nodes, cells = [], []
    for first, height in ((1, 0.0), (19, 1.0 + gap)):
        nodes += [f"{first + i + 3 * j + 9 * k},{i},{j},{height + k}" for k, j, i in np.ndindex(2, 3, 3)]
        corners = first + np.array([0, 1, 4, 3, 9, 10, 13, 12])
        cells.append([",".join(map(str, [first + 2 * j + i, *(corners + i + 3 * j)])) for j, i in np.ndindex(2, 2)])
    head = [
        *("*NODE,NSET=ALL", *nodes, "*ELEMENT,TYPE=C3D8,ELSET=EA", *cells[0], "*ELEMENT,TYPE=C3D8,ELSET=EB", *cells[1]),
        *("*NSET,NSET=BASE,GENERATE", "1,9", "*NSET,NSET=HEAD,GENERATE", "28,36"),
        *("*SURFACE,NAME=MA", "EA,S2", "*SURFACE,NAME=SL", "EB,S1"),
        *("*MATERIAL,NAME=M", "*ELASTIC", "1000.,.3", "*EXPANSION", "1.E-4"),
        *("*SOLID SECTION,ELSET=EA,MATERIAL=M", "*SOLID SECTION,ELSET=EB,MATERIAL=M"),
        f"{words}*BOUNDARY\nBASE,1,3\n",
    ]
    path = folder / "deck.inp"
    path.write_text("\n".join(head))
    static = f"*STATIC,DIRECT\n{1.0 / increments:g},1.\n"
    with path.open("a") as file:
        for step in steps:
            start = "" if step.startswith("*STATIC") else static
            file.write(f"*STEP\n{start}{step}\n*NODE PRINT,NSET=ALL\nU\n*END STEP\n")
    return path


@pytest.mark.slow
@needs_ccx
@pytest.mark.parametrize("case", CASES)
def test_displacements_are_those_of_calculix(tmp_path: Path, case: str) -> None:
    words, steps, gap, increments, largest = CASES[case]
    path = deck(tmp_path, words, steps, gap, increments)
    printed = ccx_displacements(path)
    printed = printed[len(printed) // len(steps) - 1 :: len(printed) // len(steps)]  # at the ends of the steps
    found = np.array([step.displacement[:36] for step in sg.solve(sg.read(path)).steps])
    np.testing.assert_allclose(found, printed, rtol=0.0, atol=largest * np.abs(printed).max())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("TABULAR\n0.,0.\n.1,1.E-4,20.", "66: *SURFACE BEHAVIOR: a table that depends on temperature is not supported"),
        (
            "TABULAR\n0.,0.\n.2,1.E-4\n.1,2.E-4",
            "67: *SURFACE BEHAVIOR: pressure and overlap: is 0.1 after 0.2; expected pressures that grow",
        ),
        (
            "TABULAR\n0.,0.",
            "65: *SURFACE BEHAVIOR: pressure and overlap: expected two points or more, each [closure, pressure]",
        ),
        ("EXPONENTIAL\n0.,1.", "65: has 0 in field 1; expected the clearance c0, a number > 0"),
    ],
)
def test_what_is_no_law_of_pressure(tmp_path, words, said):
    behaviour = f"*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE={words}\n"
    with pytest.raises(sg.InputError) as caught:
        sg.read(deck(tmp_path, law(behaviour), [PRESS], 0.0, 1))
    assert said in str(caught.value)


def test_the_exponential_law_is_told_to_be_calculixs(tmp_path):
    notes = load_deck(deck(tmp_path, law(CURVE), [PRESS], 0.0, 1)).notes
    assert any(note.startswith("PRESSURE-OVERCLOSURE=EXPONENTIAL is p0 exp(-ln(100) gap / c0)") for note in notes)
