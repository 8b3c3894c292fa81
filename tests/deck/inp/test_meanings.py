# SPDX-License-Identifier: BSD-3-Clause
"""What cards of loads and supports mean together: beside a deck that says it plainly, and beside CalculiX."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from tests.helpers.calculix import ccx_displacements, needs_ccx
from tests.helpers.eight_cells import eight_cells

RAMPS = """*AMPLITUDE,NAME=A
0.,.2,1.,.5,2.,.9
*AMPLITUDE,NAME=TOTAL,TIME=TOTAL TIME
0.,0.,1.,1.,2.,.3,6.,2.
"""
HEAD = eight_cells() + RAMPS
PULL = "*CLOAD\nR,3,1."
SPIN = "*DLOAD\nE,CENTRIF,10.,0,0,0,0,0,1"

# steps of a deck, and steps that say the same without what is tried; a step may begin with its *STATIC
CASES = {
    "OP=NEW in two cards": (
        ["*CLOAD\nR,3,1.", "*CLOAD,OP=NEW\nR,1,.5\n*CLOAD,OP=NEW\nR,2,.5"],
        ["*CLOAD\nR,3,1.", "*CLOAD\nR,3,0.\nR,1,.5\nR,2,.5"],
    ),
    "OP=NEW behind a card without": (
        ["*CLOAD\nR,3,1.", "*CLOAD\nR,1,.5\n*CLOAD,OP=NEW\nR,2,.5"],
        ["*CLOAD\nR,3,1.", "*CLOAD\nR,1,.5\nR,2,.5"],
    ),
    "OP=NEW of supports behind a card without": (
        ["*BOUNDARY\nR,3,3,.1", "*BOUNDARY\nR,1,1,.1\n*BOUNDARY,OP=NEW\n18,2,2,.1"],
        ["*BOUNDARY\nR,3,3,.1", "*BOUNDARY\nR,1,1,.1\n18,2,2,.1"],
    ),
    "OP=NEW of both kinds of distributed loads": (
        ["*DSLOAD\nTOP,P,2.\n*DLOAD\nE,GRAV,9.,0,1,0", "*DLOAD,OP=NEW\nE,GRAV,3.,0,1,0\n*DSLOAD,OP=NEW\nTOP,P,1."],
        ["*DSLOAD\nTOP,P,2.\n*DLOAD\nE,GRAV,9.,0,1,0", "*DLOAD\nE,GRAV,3.,0,1,0\n*DSLOAD\nTOP,P,1."],
    ),
    "OP=NEW of *DLOAD takes *DSLOAD too": (
        ["*DSLOAD\nTOP,P,2.", "*DLOAD,OP=NEW\nE,GRAV,3.,0,1,0"],
        ["*DSLOAD\nTOP,P,2.", "*DSLOAD\nTOP,P,0.\n*DLOAD\nE,GRAV,3.,0,1,0"],
    ),
    "two directions of gravity": (
        ["*DLOAD\nE,GRAV,4.,1,0,0\nE,GRAV,3.,0,0,-1"],
        ["*DLOAD\nE,GRAV,5.,4,0,-3"],
    ),
    "one direction of gravity twice": (
        ["*DLOAD\nE,GRAV,10.,0,0,-1\n*DLOAD\nE,GRAV,5.,0,0,-2"],
        ["*DLOAD\nE,GRAV,15.,0,0,-1"],
    ),
    "gravity with another direction in a later step": (
        ["*DLOAD\nE,GRAV,4.,1,0,0", "*DLOAD\nE,GRAV,3.,0,0,-1"],
        ["*DLOAD\nE,GRAV,4.,1,0,0", "*DLOAD,OP=NEW\nE,GRAV,5.,4,0,-3"],
    ),
    "gravity with its direction in a later step": (
        ["*DLOAD\nE,GRAV,4.,1,1,0", "*DLOAD\nE,GRAV,3.,2,2,0"],
        ["*DLOAD\nE,GRAV,4.,1,1,0", "*DLOAD,OP=NEW\nE,GRAV,3.,1,1,0"],
    ),
    "rotation faster in a later step": (
        [SPIN, "*DLOAD\nE,CENTRIF,20.,0,0,0,0,0,2"],
        [SPIN, "*DLOAD,OP=NEW\nE,CENTRIF,20.,0,0,0,0,0,1"],
    ),
    "a face pressed twice": (
        ["*DSLOAD\nTOP,P,2.\n*DLOAD\n5,P2,1.\n5,P2,1.", "*DLOAD\n5,P2,3."],
        ["*DSLOAD\nTOP,P,2.\n*DLOAD\n5,P2,2.", "*DLOAD\n5,P2,3."],
    ),
    "forces per volume": (["*DLOAD\nE,BX,2.\nE,BY,1.\nE,BX,2."], ["*DLOAD\nE,BX,4.\nE,BY,1."]),
    "a node of two sets moved": (["*BOUNDARY\nR,3,3,.1\n18,3,3,.2"], ["*BOUNDARY\nR,3,3,.1\n*BOUNDARY\n18,3,3,.2"]),
    "an amplitude of step time ends with its step": (
        ["*STATIC\n1.,1.\n*CLOAD,AMPLITUDE=A\nR,3,1.\n*DLOAD,AMPLITUDE=A\nE,GRAV,2.,0,1,0", "*STATIC\n2.,2."],
        ["*CLOAD\nR,3,.5\n*DLOAD\nE,GRAV,1.,0,1,0", ""],
    ),
    "an amplitude of total time goes on": (
        ["*STATIC\n1.,1.\n*BOUNDARY,AMPLITUDE=TOTAL\nR,3,3,.1", "*STATIC\n1.,1.\n*CLOAD\n18,1,1."],
        ["*BOUNDARY\nR,3,3,.1", "*BOUNDARY\nR,3,3,.03\n*CLOAD\n18,1,1."],
    ),
    "two amplitudes in two directions": (
        ["*DLOAD,AMPLITUDE=A\nE,GRAV,8.,1,0,0\n*DLOAD,AMPLITUDE=TOTAL\nE,GRAV,3.,0,0,-1"],
        ["*DLOAD\nE,GRAV,5.,4,0,-3"],
    ),
    "an amplitude inside a step": (["*AMPLITUDE,NAME=B\n0.,1.,1.,2.\n*CLOAD,AMPLITUDE=B\nR,3,1."], ["*CLOAD\nR,3,2."]),
    "TOTAL TIME AT START": (
        ["*CLOAD,AMPLITUDE=TOTAL\nR,3,1.", "*STATIC,TOTAL TIME AT START=4.\n1.,2.\n*CLOAD,AMPLITUDE=TOTAL\nR,3,1."],
        ["*CLOAD\nR,3,1.", "*CLOAD\nR,3,2."],
    ),
    "TIME RESET": (
        ["*CLOAD,AMPLITUDE=TOTAL\nR,3,1.", "*STATIC,TIME RESET\n*CLOAD,AMPLITUDE=TOTAL\nR,3,2.", "*CLOAD\nR,1,1."],
        ["*CLOAD\nR,3,1.", "*CLOAD\nR,3,2.", "*CLOAD\nR,3,.6\nR,1,1."],
    ),
    "supports at once": (["*STEP,AMPLITUDE=STEP\n*STATIC\n.5,1.\n*BOUNDARY\nR,3,3,.1"], ["*BOUNDARY\nR,3,3,.1"]),
    "loads at once": (
        ["*STEP,AMPLITUDE=STEP\n*STATIC\n.5,1.\n*CLOAD\nR,3,1.", "*CLOAD\nR,3,3."],
        ["*CLOAD\nR,3,1.", "*CLOAD\nR,3,3."],
    ),
}


def deck(folder: Path, steps: list[str], head: str = HEAD) -> Path:
    path = folder / "deck.inp"
    words = []
    for step in steps:
        start = "" if step.startswith("*STEP") else "*STEP\n" if step.startswith("*STATIC") else "*STEP\n*STATIC\n"
        words.append(f"{start}{step}\n*NODE PRINT,NSET=ALL\nU\n*END STEP\n".replace("\n\n", "\n"))
    path.write_text(head + "".join(words))
    return path


# heads of decks for one load
BODIES = {
    "bricks with and without incompatible modes": eight_cells(lower="C3D8I", skew=0.0),
    "engineering constants in space, turned": eight_cells()
    .replace("*ELASTIC\n1000.,.27", "*ELASTIC,TYPE=ENGINEERING CONSTANTS\n1000,700,400,.2,.25,.3,300,250,\n200,20.")
    .replace("MATERIAL=M\n", "MATERIAL=M,ORIENTATION=O\n*ORIENTATION,NAME=O\n2.,1.,0.,0.,1.,0.\n3,20.\n"),
    "stiffnesses of an orthotropic material": eight_cells().replace(
        "*ELASTIC\n1000.,.27", "*ELASTIC,TYPE=ORTHO\n1250.,330.,900.,240.,210.,560.,300.,250.,\n200."
    ),
    "elements of two sections": eight_cells().replace(
        "*BOUNDARY", "*SOLID SECTION,ELSET=LOW,MATERIAL=N\n*MATERIAL,NAME=N\n*ELASTIC\n300.,.2\n*BOUNDARY"
    ),
    "one direction of a coupling": eight_cells()
    + "*NODE\n101,3.,.7,.4\n*SURFACE,NAME=RS,TYPE=NODE\nR\n*COUPLING,REF NODE=101,SURFACE=RS,CONSTRAINT NAME=C\n"
    "*KINEMATIC\n1,1\n*BOUNDARY\n101,4,6\n101,1,1,.02\n",
}


def displacements(path: Path) -> list[np.ndarray]:
    return [step.displacement for step in sg.solve(sg.read(path)).steps]


@pytest.mark.parametrize("case", CASES)
def test_it_is_what_is_said_plainly(tmp_path: Path, case: str) -> None:
    found, plain = (displacements(deck(tmp_path, steps)) for steps in CASES[case])
    assert len(found) == len(plain)
    np.testing.assert_allclose(found, plain, rtol=0.0, atol=1e-12 * np.abs(plain).max())


@needs_ccx
@pytest.mark.parametrize("case", CASES)
def test_it_is_what_calculix_takes_it_for(tmp_path: Path, case: str) -> None:
    path = deck(tmp_path, CASES[case][0])
    printed = ccx_displacements(path)
    np.testing.assert_allclose(displacements(path), printed, rtol=0.0, atol=1e-6 * np.abs(printed).max())


@needs_ccx
@pytest.mark.parametrize("body", BODIES)
def test_bodies_are_those_of_calculix(tmp_path: Path, body: str) -> None:
    path = deck(tmp_path, ["*CLOAD\n18,3,1.\n9,2,2."], BODIES[body])
    printed = ccx_displacements(path)
    found = np.array(displacements(path))[:, :27]
    np.testing.assert_allclose(found, printed, rtol=0.0, atol=1e-6 * np.abs(printed).max())


def test_incompatible_modes_are_those_of_their_own_elements(tmp_path: Path) -> None:
    """A section of both kinds is what two sections are."""
    head = eight_cells(lower="C3D8I")
    apart = head.replace("*ELSET,ELSET=LOW\n", "*ELSET,ELSET=HIGH\n5,6,7,8\n*ELSET,ELSET=LOW\n").replace(
        "*SOLID SECTION,ELSET=E,MATERIAL=M\n",
        "*SOLID SECTION,ELSET=LOW,MATERIAL=M\n*SOLID SECTION,ELSET=HIGH,MATERIAL=M\n",
    )
    model = sg.read(deck(tmp_path, [PULL], head))
    assert {body.name: body.formulation for body in model.bodies} == {"E": "standard", "E C3D8I": "incompatible"}
    one, two = (displacements(deck(tmp_path, [PULL], words)) for words in (head, apart))
    np.testing.assert_allclose(one, two, rtol=0.0, atol=1e-13)


def test_the_last_section_of_an_element_counts(tmp_path: Path) -> None:
    """As in CalculiX, with a note; a section of which nothing is left is no body."""
    found = load_deck(deck(tmp_path, [PULL], BODIES["elements of two sections"]))
    assert [(body.name, body.material.E) for body in found.model.bodies] == [("E", 1000.0), ("LOW", 300.0)]
    assert "elements in several sections are of the last one, as in CalculiX; Abaqus refuses them" in found.notes
    again = HEAD.replace("*BOUNDARY", "*ELSET,ELSET=ALSO\nE\n*SOLID SECTION,ELSET=ALSO,MATERIAL=M\n*BOUNDARY")
    assert [body.name for body in load_deck(deck(tmp_path, [PULL], again)).model.bodies] == ["ALSO"]


def test_a_viscous_step_of_what_does_not_creep_is_static(tmp_path: Path) -> None:
    plain, viscous = (f"*{word}\n.1,2.\n*CLOAD\nR,3,1." for word in ("STATIC", "VISCO,CETOL=1."))
    one, two = (
        displacements(deck(tmp_path, [step, step.replace("1.", ".5")])) for step in (plain, f"*STEP\n{viscous}")
    )
    np.testing.assert_array_equal(one, two)
    assert "*VISCO is taken as *STATIC: no material of the deck creeps" in load_deck(tmp_path / "deck.inp").notes
    creeps = HEAD.replace("*DENSITY", "*CREEP\n1.,2.,0.\n*DENSITY")
    with pytest.raises(DeckError, match=r"\*CREEP: is not supported, and it may change the answer"):
        load_deck(deck(tmp_path, [f"*STEP\n{viscous}"], creeps))


def test_a_surface_of_faces_has_its_name_before_one_of_nodes(tmp_path: Path) -> None:
    """CalculiX keeps two kinds of one name apart; two of a kind are a mistake."""
    surface = "*SURFACE,NAME=TOP,TYPE=NODE\n19\n"
    press = ["*DSLOAD\nTOP,P,1."]
    plain = displacements(deck(tmp_path, press))
    first = HEAD.replace("*SURFACE,NAME=TOP", f"{surface}*SURFACE,NAME=TOP", 1)
    for head in (HEAD + surface, first):
        np.testing.assert_array_equal(displacements(deck(tmp_path, press, head)), plain)
    with pytest.raises(DeckError, match="there is another surface 'TOP'"):
        load_deck(deck(tmp_path, press, HEAD + surface + surface))


def test_a_surface_of_nodes_holds_whole_faces(tmp_path: Path) -> None:
    """A node that belongs to none of them would go through the other side unseen."""
    lines = "*SURFACE,NAME=S,TYPE=NODE\n19\n20\n22\n23\n27\n*SURFACE INTERACTION,NAME=I\n*SURFACE BEHAVIOR\n"
    pair = "*CONTACT PAIR,INTERACTION=I\nS,BOT\n"
    said = r"deck.inp:\d+: surface 'S' has nodes of no face that it holds as a whole: 27; expected all nodes of faces"
    for steps, more in (([PULL], lines + pair), (["*DSLOAD\nS,P,1."], lines)):
        with pytest.raises(DeckError, match=said):
            load_deck(deck(tmp_path, steps, HEAD + more))


@pytest.mark.parametrize(
    ("lines", "angle"),
    [
        ("1.,1.,0.,0.,1.,0.\n3,0.", 45.0),
        ("1.,1.,0.,0.,1.,0.\n3,-20.", 25.0),
        ("1.,1.,0.,0.,1.,0.\n1,0.", 45.0),
        ("4.,2.,1.,3.,3.,1.,3.,1.,1.", 45.0),
        ("1.,1.,0.,0.,1.,0.\n,0.", 45.0),
    ],
)
def test_an_orientation_is_turned(tmp_path: Path, lines: str, angle: float) -> None:
    """By the second line that CAE writes; points may be given from a third one."""
    head = BODIES["engineering constants in space, turned"].replace("2.,1.,0.,0.,1.,0.\n3,20.", lines)
    assert sg.read(deck(tmp_path, [PULL], head)).bodies[0].material.angle == pytest.approx(angle)
    out = head.replace(lines, "1.,1.,0.,0.,1.,0.\n2,5.")
    with pytest.raises(DeckError, match=r"\*ORIENTATION: turns by 5 degrees about axis 2; expected axis 3"):
        load_deck(deck(tmp_path, [PULL], out))


def test_gravity_without_a_set_is_that_of_all(tmp_path: Path) -> None:
    """As CAE writes it."""
    whole, named = (displacements(deck(tmp_path, [f"*DLOAD\n{word},GRAV,9.,0,0,-1"])) for word in ("", "E"))
    np.testing.assert_array_equal(whole, named)


def test_a_support_before_the_steps_is_replaced(tmp_path: Path) -> None:
    """It is of no step, so that an amplitude contradicts nothing."""
    move = "*BOUNDARY,AMPLITUDE=A\nR,3,3,.2"
    replaced = displacements(deck(tmp_path, [move], f"{HEAD}*BOUNDARY\nR,3,3,.1\n"))
    np.testing.assert_array_equal(replaced, displacements(deck(tmp_path, [move])))


def plane_cells(kind: str) -> str:
    """A skew quadrilateral and its neighbour, held at the left, as decks have them."""
    nodes = "*NODE,NSET=ALL\n1,1.,0.\n2,2.1,.1\n3,3.,0.\n4,1.,1.\n5,1.9,1.2\n6,3.1,.9\n*NSET,NSET=FIX\n1,4\n"
    cells = f"*ELEMENT,TYPE={kind},ELSET=E\n1,1,2,5,4\n2,2,3,6,5\n*SOLID SECTION,ELSET=E,MATERIAL=M\n"
    return f"{nodes}{cells}*MATERIAL,NAME=M\n*ELASTIC\n1000.,.27\n*DENSITY\n2.5\n*BOUNDARY\nFIX,1,2\n"


AXES = {  # head, and the data of two rotations
    "space": (HEAD, "10.,0,0,0,0,0,1", "5.,0,1,0,1,0,1"),
    "plane strain": (plane_cells("CPE4"), "10.,0,0,0,0,0,1", "5.,3,2,0,0,0,1"),
    "plane stress": (plane_cells("CPS4"), "10.,0,0,0,0,0,1", "5.,3,2,0,0,0,1"),
    "axisymmetric": (plane_cells("CAX4"), "10.,0,0,0,0,1,0", "5.,0,2,0,0,1,0"),
}


@pytest.mark.parametrize("case", AXES)
def test_axes_of_rotation_add_up(tmp_path: Path, case: str) -> None:
    """In one card, in two and in two steps; behind OP=NEW there is the new one alone."""
    head, *data = AXES[case]
    one, two = (f"*DLOAD\nE,CENTRIF,{words}" for words in data)
    alone = [displacements(deck(tmp_path, [step], head))[-1] for step in (one, two)]
    cases = {
        "one card": ([f"{one}\nE,CENTRIF,{data[1]}"], sum(alone)),
        "two cards": ([f"{two}\n{one}"], sum(alone)),
        "OP=NEW": ([one, two.replace("*DLOAD", "*DLOAD,OP=NEW")], alone[1]),
        "two steps": ([one, two], alone[1] if case == "axisymmetric" else sum(alone)),  # there it is the one axis
        "twice as fast": ([f"{one}\n{two}", f"{two}\n{one}".replace("10.", "40.")], 4.0 * alone[0] + alone[1]),
    }
    for name, (steps, expected) in cases.items():
        found = displacements(deck(tmp_path, steps, head))[-1]
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * np.abs(expected).max(), err_msg=name)
        notes = " ".join(load_deck(deck(tmp_path, steps, head)).notes)
        several = case != "axisymmetric" and name != "OP=NEW"
        assert ("about several axes on the same elements; to CalculiX the first is the only one" in notes) is several
        assert ("CENTRIF of step 2 acts beside that of an earlier" in notes) is (several and name == "two steps")


@needs_ccx
@pytest.mark.parametrize("case", ["space", "plane strain"])
def test_each_axis_of_rotation_is_that_of_calculix(tmp_path: Path, case: str) -> None:
    """CalculiX 2.20 leaves out every axis of an element but the first: both are what it says of each, added up."""
    head, *data = AXES[case]
    printed = sum(ccx_displacements(deck(tmp_path, [f"*DLOAD\nE,CENTRIF,{words}"], head))[-1] for words in data)
    found = displacements(deck(tmp_path, [f"*DLOAD\nE,CENTRIF,{data[0]}\nE,CENTRIF,{data[1]}"], head))[-1]
    np.testing.assert_allclose(found, printed[:, : found.shape[1]], rtol=0.0, atol=1e-6 * np.abs(printed).max())


@pytest.mark.parametrize(
    ("steps", "named", "said"),
    [
        ([f"{PULL}\n*CLOAD,AMPLITUDE=A\n18,3,2."], "18,3,2.", r"\*CLOAD: acts with 'A' where line \d+ .* no amplitude"),
        (["*DLOAD,AMPLITUDE=A\n5,P2,1.\n*DSLOAD,AMPLITUDE=TOTAL\nTOP,P,1."], "TOP,P", "acts with 'TOTAL' where"),
        (["*BOUNDARY,AMPLITUDE=A\nR,1,1,.1\n*BOUNDARY\nR,1,1,.2"], "R,1,1,.2", "acts with no amplitude where"),
        (["*AMPLITUDE,NAME=B,VALUE=ABSOLUTE\n0.,1."], "*AMPLITUDE,NAME=B", "VALUE: unknown value 'ABSOLUTE'"),
        (["*AMPLITUDE,NAME=a\n0.,1."], "*AMPLITUDE,NAME=a", "there is another amplitude 'a'"),
        (["*STATIC,TOTAL TIME AT START=x"], "*STATIC", "TOTAL TIME AT START=X: expected a time, a number"),
    ],
)
def test_what_contradicts_itself_is_refused(tmp_path: Path, steps: list[str], named: str, said: str) -> None:
    path = deck(tmp_path, steps)
    with pytest.raises(DeckError, match=said) as caught:
        load_deck(path)
    assert path.read_text().splitlines()[(caught.value.line or 0) - 1].startswith(named)


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ("OP=NEW behind a card without", "takes nothing away, as in CalculiX: the first *CLOAD of the step"),
        ("OP=NEW of *DLOAD takes *DSLOAD too", "takes away what *DSLOAD has set too, as in CalculiX"),
        ("gravity with another direction in a later step", "GRAV of step 2 acts beside that of an earlier step"),
        ("supports at once", "supports move at the beginning of step 1, by its AMPLITUDE=STEP, as in CalculiX"),
    ],
)
def test_where_programs_differ_is_said(tmp_path: Path, case: str, said: str) -> None:
    odd, plain = CASES[case]
    assert any(said in note for note in load_deck(deck(tmp_path, odd)).notes)
    assert not any("CalculiX" in note for note in load_deck(deck(tmp_path, plain)).notes)
