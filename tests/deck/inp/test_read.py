# SPDX-License-Identifier: BSD-3-Clause
"""Whole decks: the model that they mean, and what is refused rather than left out."""

import csv
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.deck import DeckError, load_deck

DECKS = Path(__file__).parent / "decks"
TWO_BLOCKS = (DECKS / "two_blocks.inp").read_text()


def in_python() -> sg.Model:
    """What two_blocks.inp says."""
    low = sg.rectangle(width=2.0, height=1.0, nx=2, ny=1)
    mesh = sg.join({"low": low, "up": sg.rectangle(width=2.0, height=1.0, nx=2, ny=1, origin=(0.0, 1.0))})
    steel = sg.Elastic(E=210e3, nu=0.3)
    return sg.Model(
        mesh,
        bodies=[sg.Body("low", steel), sg.Body("up", steel)],
        supports=[
            sg.Support("low.bottom", u=(0, 0)),
            sg.Support("up.top", u=(0.01, None), name="drag"),
            sg.Support("up.top", u=(None, -0.001), name="press"),
        ],
        contacts=[sg.Contact("up.bottom", "low.top", friction=0.3)],
        steps=[sg.Step(scale={"press": 1.0}), sg.Step(scale={"drag": 1.0})],
    )


@pytest.mark.parametrize("name", ["two_blocks.inp", "instances.inp"])
def test_a_deck_is_the_model_that_it_means(name: str) -> None:
    found, expected = sg.solve(sg.read(DECKS / name)), sg.solve(in_python())
    for mine, theirs in zip(found.steps, expected.steps, strict=True):
        assert mine.contacts[0].normal_force == pytest.approx(theirs.contacts[0].normal_force, rel=1e-10, abs=1e-9)
        assert mine.contacts[0].tangential_force == pytest.approx(theirs.contacts[0].tangential_force, abs=1e-9)
        assert mine.strain_energy == pytest.approx(theirs.strain_energy, rel=1e-10)


def test_numbers_of_the_deck_survive(tmp_path: Path) -> None:
    assert main(["run", str(DECKS / "two_blocks.inp"), "-o", str(tmp_path), "--quiet"]) == 0
    with (tmp_path / "contact.csv").open() as file:
        assert {row["node"] for row in csv.DictReader(file)} == {"11", "12", "13"}
    model = sg.read(DECKS / "two_blocks.inp")
    assert model.mesh.cell_labels.tolist() == [10, 20, 30, 40]


def test_instances_get_numbers_of_their_own() -> None:
    deck = load_deck(DECKS / "instances.inp")
    assert deck.model.mesh.labels.tolist() == [*range(1, 7), *range(7, 13)]
    assert any("raised" in note for note in deck.notes)
    # turned by half a turn, the first node of the upper block is its upper right corner
    assert deck.model.mesh.points[6] == pytest.approx([2.0, 2.0])


def test_what_is_left_out_is_told_once() -> None:
    notes = load_deck(DECKS / "instances.inp").notes
    assert sum("*OUTPUT" in note and "*RESTART" in note for note in notes) == 1
    assert any("small sliding" in note for note in notes)
    assert any("--increments deck" in note for note in notes)


def test_increments_of_the_deck() -> None:
    model = sg.read(DECKS / "instances.inp", deck_increments=True)
    assert [step.increments for step in model.steps] == [10, 1]
    assert [step.increments for step in sg.read(DECKS / "instances.inp").steps] == [None, None]


def edited(folder: Path, old: str, new: str) -> Path:
    assert old in TWO_BLOCKS
    deck = folder / "deck.inp"
    deck.write_text(TWO_BLOCKS.replace(old, new, 1))
    return deck


# what is changed, to what, how the line that is named begins, what is said
WRONG = {
    "creep": ("210000., .3\n", "210000., .3\n*CREEP\n1.,2.,0.\n", "*CREEP", r"\*CREEP: is not supported"),
    "element": ("40, 12, 13, 16, 15", "40, 12,\n13,\n99, 15", "40, 12", r"\*ELEMENT: there is no node 99"),
    "twice": ("20, 2, 3, 6, 5", "10, 2, 3, 6, 5", "10, 2", "element 10 is there twice"),
    "counted from 0": ("20, 2, 3, 6, 5", "0, 2, 3, 6, 5", "0, 2", "element has the number 0; expected one >= 1"),
    "not plane": ("6, 2., 1.", "6, 2., 1., 3.", "20, 2", "element 20 has node 6 at z = 3, others are at z = 0"),
    "moved": ("11, 0., 1., 0.", "11, 0., 1., 0.\n3, 2., 2.", "3, 2., 2.", "node 3 is there twice"),
    "no number": ("5, 1., 1.", "5.5, 1., 1.", "5.5", "a node has the number 5.5"),
    "node of a set": ("14, 15, 16\n*SURF", "14, 15,\n16, 99\n*SURF", "16, 99", r"\*NSET: there is no node 99"),
    "no section": ("*SOLID SECTION, ELSET=Upper, MATERIAL=Steel\n1.\n", "", "30, 11", "element 30 has no section"),
    "times": ("*STEP\n", "*AMPLITUDE, NAME=A\n0., 0., 2., 1.,\n1., 1.\n*STEP\n", "1., 1.", "has the time 1 after 2"),
    "clearance": (
        "*BOUNDARY\nBase",
        "*CLEARANCE, MASTER=Sslave, SLAVE=Smaster, VALUE=1.\n*BOUNDARY\nBase",
        "*CLEARANCE",
        "there is no contact pair of 'Smaster' and 'Sslave'",
    ),
    "empty tie": (
        "*BOUNDARY\nBase",
        "*TIE, NAME=T\n*BOUNDARY\nBase",
        "*TIE",
        "has no data line; expected the slave and",
    ),
    "a part of a tie": (
        "*BOUNDARY\nBase",
        "*TIE, TIED NSET=Top\n*BOUNDARY\nBase",
        "*TIE",
        "TIED NSET is not supported",
    ),
    "support": ("Top, 1, 1\n*STEP", "Top, 1, 1\n99, 1\n*STEP", "99, 1", "there is no node 99"),
    "type": ("TYPE=CPE4", "TYPE=C3D14", "*ELEMENT", "TYPE=C3D14 is not supported"),
    "beam": (
        "TYPE=CPE4, ELSET=Lower\n10, 1, 2, 5, 4\n20, 2, 3, 6, 5",
        "TYPE=B31, ELSET=Lower\n10, 1, 2\n20, 2, 3",
        "*SOLID",
        "'Lower' holds B31 beside CPE4 of the model; expected no section for these",
    ),
    "set": ("Base, 1, 2", "Basis, 1, 2", "Basis", "unknown node set 'Basis'; did you mean 'Base'"),
    "face": ("Upper, S1", "Upper, S5", "Upper, S5", "these elements have no face 'S5'"),
    "direction": ("Top, 1, 1\n", "Top, 1, 3, 0.1\n", "Top, 1, 3", "direction 3 moves"),
    "dynamics": ("*STATIC\n", "*DYNAMIC\n", "*DYNAMIC", r"\*DYNAMIC: is not supported"),
    "poisson": ("210000., .3", "210000., .5", "210000.", "nu: is 0.5; expected a number > -1 and < 0.5"),
    "friction": ("0.3\n*CONTACT", "-0.3\n*CONTACT", "-0.3", "expected a number >= 0"),
    "parameter": ("*BOUNDARY\nBase", "*BOUNDARY, SUBMODEL\nBase", "*BOUNDARY", "parameter SUBMODEL is not supported"),
    "material": (
        "MATERIAL=Steel\n1.",
        "MATERIAL=Stell\n1.",
        "*SOLID",
        "unknown material 'Stell'; did you mean 'Steel'",
    ),
    "not a number": ("2.0D0", "2.0.0", "14, 0.", "has '2.0.0'"),
    "outside": ("*STEP\n", "*CLOAD\n14, 2, 1.\n*STEP\n", "*CLOAD", "is not supported outside a step"),
    "unfinished": ("0.01\n*END STEP", "0.01\n", "*STEP", "is not ended"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_changes_the_answer_stops_with_its_line(tmp_path: Path, case: str) -> None:
    old, new, begins, said = WRONG[case]
    deck = edited(tmp_path, old, new)
    with pytest.raises(DeckError, match=said) as caught:
        load_deck(deck)
    assert caught.value.line is not None
    assert deck.read_text().splitlines()[caught.value.line - 1].startswith(begins)


def test_what_is_found_later_has_its_line_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Shapes of elements are looked at when the deck is read: its line is found in it again."""
    deck = edited(tmp_path, "20, 2, 3, 6, 5", "20, 2, 3, 5, 6")
    assert main(["check", str(deck)]) == 2
    line = deck.read_text().splitlines().index("20, 2, 3, 5, 6") + 1
    assert f"deck.inp:{line}: *ELEMENT: element 20 (quad) near (1.5, 0.5) has no area" in capsys.readouterr().err


def test_small_strain_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    stays = edited(tmp_path, "*STEP\n", "*STEP, NLGEOM\n")
    stays.write_text(stays.read_text().replace("*CONTACT PAIR,", "*CONTACT PAIR, SMALL SLIDING,"))
    deck = str(stays)
    assert main(["check", deck]) == 2
    assert "NLGEOM asks for large displacements" in capsys.readouterr().err
    assert main(["check", deck, "--small-strain"]) == 0
    assert "NLGEOM is ignored" in capsys.readouterr().out


def test_pairs_follow_the_bodies_where_displacements_are_large(tmp_path: Path) -> None:
    """With ``NLGEOM``, unless they are said to stay."""
    deck = edited(tmp_path, "*STEP\n", "*STEP, NLGEOM\n")
    assert [contact.sliding for contact in load_deck(deck).model.contacts] == ["finite"]
    assert [contact.sliding for contact in load_deck(deck, small_strain=True).model.contacts] == ["small"]
    deck.write_text(deck.read_text().replace("*CONTACT PAIR,", "*CONTACT PAIR, SMALL SLIDING,"))
    with pytest.raises(DeckError, match=r"here pairs stay .*--small-strain"):
        load_deck(deck)
    deck = edited(tmp_path, "*STEP\n", "*CLEARANCE, MASTER=Smaster, SLAVE=Sslave, VALUE=0.001\n*STEP, NLGEOM\n")
    assert [(contact.sliding, contact.gap) for contact in load_deck(deck).model.contacts] == [("finite", 0.001)]


def test_loads_carry_over_change_and_go(tmp_path: Path) -> None:
    """A force that stays, is doubled, is removed and reversed; a pressure that a set and single elements share."""
    steps = """*STEP
*STATIC
*CLOAD
14, 2, -3.
Top, 2, -1.
*DLOAD
Upper, P3, 5.
*END STEP
*STEP
*STATIC
*CLOAD
Top, 2, -2.
*END STEP
*STEP
*STATIC
*CLOAD, OP=NEW
*DLOAD
Upper, P3, -5.
*END STEP
"""
    model = sg.read(edited(tmp_path, TWO_BLOCKS[TWO_BLOCKS.index("*STEP") :], steps))
    loads = {load.label: load for load in model.loads}
    total = []
    for factors in model.factors()[1:]:
        force = 0.0
        for name, given in loads.items():
            if given.pressure is not None:
                force -= 2.0 * given.pressure * factors[name]
            elif given.force is not None:
                force += given.force[1] * factors[name]
            else:
                force += given.nodal_forces[:, 1].sum() * factors[name]
        total.append(force)
    # -3 and three times -1, pressure 5 on length 2; then the forces of the set are replaced, not those of node 14 ...
    assert total == pytest.approx([-6.0 - 10.0, -6.0 - 10.0, 10.0])


def test_a_deck_of_many_nodes_is_read_in_bulk(tmp_path: Path) -> None:
    n = 120
    grid = np.arange(1, n * n + 1).reshape(n, n)
    nodes = "".join(f"{k}, {i}., {j}.\n" for k, (j, i) in zip(grid.ravel(), np.ndindex(n, n), strict=True))
    corners = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1).reshape(-1, 4)
    cells = "".join(f"{e}, {a}, {b}, {c}, {d}\n" for e, (a, b, c, d) in enumerate(corners, start=1))
    deck = tmp_path / "big.inp"
    deck.write_text(
        f"*NODE, NSET=N\n{nodes}*ELEMENT, TYPE=CPS4, ELSET=E\n{cells}*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n0.5\n*BOUNDARY\n1, 1, 2\n2, 2\n*STEP\n*STATIC\n*CLOAD\n3, 1, 1.\n"
        "*END STEP\n"
    )
    model = sg.read(deck)
    assert model.mesh.number_of_cells == (n - 1) ** 2
    assert (model.kind, model.thickness) == ("plane stress", 0.5)


def test_sections_have_their_own_thickness(tmp_path: Path) -> None:
    """The upper block half as thick: twice as soft, and the blocks touch over its thickness."""
    deck = edited(tmp_path, "ELSET=Upper, MATERIAL=Steel\n1.", "ELSET=Upper, MATERIAL=Steel\n.5")
    model = sg.read(deck)
    assert (model.thickness, model.thicknesses, model.bodies[0].thickness) == (1.0, [1.0, 0.5], None)
    one, half = (sg.solve(sg.read(path)).steps[0].contacts[0] for path in (DECKS / "two_blocks.inp", deck))
    assert half.area == pytest.approx(0.5 * one.area)
    assert 0.5 * one.normal_force[1] < half.normal_force[1] < one.normal_force[1]


def test_tied_surfaces_are_one_body(tmp_path: Path) -> None:
    """Tied blocks pulled apart deform as one: the same forces as a single mesh would carry."""
    tie = "*TIE, NAME=Glue, POSITION TOLERANCE=0.1\nSslave, Smaster\n*BOUNDARY\nBase, 1, 2"
    deck = edited(tmp_path, "*BOUNDARY\nBase, 1, 2", tie)
    lines = deck.read_text().replace("-0.001", "0.001")
    a, b = lines.index("*SURFACE INTERACTION"), lines.index("*TIE")
    deck.write_text(lines[:a] + lines[b:])
    pulled = sg.solve(sg.read(deck))
    whole = sg.rectangle(width=2.0, height=2.0, nx=2, ny=2)
    one = sg.Model(
        whole,
        bodies=[sg.Body("block", sg.Elastic(E=210e3, nu=0.3))],
        supports=[sg.Support("bottom", u=(0, 0)), sg.Support("top", u=(0, 0.001))],
    )
    force = sg.solve(one).last.reactions["top"][1]
    assert pulled.steps[0].reactions["Top u2"][1] == pytest.approx(force, rel=1e-9)


def test_a_stiffness_of_tied_surfaces_is_left_out_with_a_note(tmp_path: Path) -> None:
    """The contact of blocks that are pulled apart holds them, and says that it is exact."""
    text = (DECKS / "two_blocks.inp").read_text()
    a, b = text.index("*SURFACE INTERACTION"), text.index("*CONTACT PAIR")
    name = text[a:].split("NAME=")[1].split()[0]
    law = f"*SURFACE INTERACTION, NAME={name}\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e6\n"
    deck = tmp_path / "deck.inp"
    deck.write_text((text[:a] + law + text[b:]).replace("-0.001", "0.001"))
    found = load_deck(deck)
    assert any("tied exactly" in note for note in found.notes)
    assert sg.solve(found.model).steps[0].contacts[0].normal_force[1] != 0.0


def test_every_deck_is_solved_and_balanced() -> None:
    """What pushes on the bodies is what the supports take: a deck for every kind of element and interface."""
    for path in sorted(DECKS.glob("*.inp")):
        model = sg.read(path)
        solution = sg.solve(model)
        for step, factors in zip(solution.steps, model.factors()[1:], strict=True):
            assert step.certificate.passed
            d = model.dimension
            total = sum((force[:d] for force in step.reactions.values()), np.zeros(d))  # moments of rigid bodies follow
            if path.name == "rigid.inp":
                total = total + [0.0, -10.0]
            if path.name == "wedges.inp":  # pressure, and the mass 0.2 at the arm (-1/4, 1/2, 1/4)
                total = total + [0.0, 0.0, -5.0] + 0.2 * 4.0 * np.array([-0.25, 0.5, 0.25])
            if path.name == "quadratic.inp":
                total = total + [2.0 * factors["forces on single nodes"], -6.0 * 2.0 * 0.5]
            if path.name == "shrink_fit.inp":
                total = total[1:] - 9810.0 * 7.8e-9 * np.pi * (1.0 - 0.25) * 0.2  # the weight of the shaft
            assert total == pytest.approx(np.zeros(len(total)), abs=1e-9)


def test_a_shrink_fit_has_the_pressure_of_lame() -> None:
    """The mean pressure of a cooled ring on a hollow shaft; one element across each is 4 % off."""
    step = sg.solve(sg.read(DECKS / "shrink_fit.inp")).steps[0]
    a, b, c, modulus = 0.5, 1.0, 1.5, 210e3
    flexibility = ((b**2 + a**2) / (b**2 - a**2) + (c**2 + b**2) / (c**2 - b**2)) / modulus
    pressure = 12e-6 * 100.0 * b / (b * flexibility)
    mean = step.contacts[0].normal_force[0] / (2 * np.pi * b * 0.2)
    assert mean == pytest.approx(pressure, rel=0.08)


def test_sections_and_axes_are_read() -> None:
    model = sg.read(DECKS / "quadratic.inp")
    wood = model.bodies[0].material
    assert isinstance(wood, sg.Orthotropic)
    assert (wood.angle, wood.E2, wood.G12, model.thickness) == (pytest.approx(45.0), 600.0, 300.0, 0.5)
    contact = model.contacts[0]
    assert (contact.normal_compliance, contact.tangential_compliance, contact.adjust) == (1e-6, 1e-5, 0.01)


@pytest.mark.parametrize(("adjust", "given"), [("0.01", ("geometry", 0.01)), ("Touching", ("zero", None))])
def test_gaps_are_adjusted(tmp_path: Path, adjust: str, given: tuple[object, object]) -> None:
    deck = edited(tmp_path, "*CONTACT PAIR, ", f"*NSET, NSET=Touching\n11, 12, 13\n*CONTACT PAIR, ADJUST={adjust}, ")
    contact = sg.read(deck).contacts[0]
    assert (contact.gap, contact.adjust) == given
    deck.write_text(deck.read_text().replace("11, 12, 13", "11, 12"))
    if adjust == "Touching":
        with pytest.raises(DeckError, match="does not hold all nodes of the slave surface"):
            load_deck(deck)


MIXED = """*NODE
1,0,0
2,1,0
3,1,1
4,0,1
11,3,0
12,4,0
13,4,1
14,3,1
15,3.5,0
16,4,0.5
17,3.5,1
18,3,0.5
*ELEMENT,TYPE=CPS4,ELSET=L
1,1,2,3,4
*ELEMENT,TYPE=CPS8,ELSET=Q
2,11,12,13,14,15,16,17,18
*ELSET,ELSET=A
L,Q
*SURFACE,NAME=S
A,S3
*MATERIAL,NAME=M
*ELASTIC
100.,0.
*SOLID SECTION,ELSET=A,MATERIAL=M
*BOUNDARY
1,1,2
2,2
11,1,2
12,2
15,2
"""


def test_one_load_on_linear_and_quadratic_elements(tmp_path: Path) -> None:
    """Both squares are pressed by one line of the deck, and by a surface that holds both."""
    for load_words in ("*DLOAD\nA,P3,2.\n", "*DSLOAD\nS,P,2.\n"):
        path = tmp_path / "deck.inp"
        path.write_text(f"{MIXED}*STEP\n*STATIC\n{load_words}*END STEP\n")
        model = sg.read(path)
        step = sg.solve(model).last
        top = model.mesh.points[:, 1] == 1.0
        np.testing.assert_allclose(step.displacement[top, 1], -0.02, rtol=1e-12)


def test_a_contact_surface_is_of_one_order(tmp_path: Path) -> None:
    path = tmp_path / "deck.inp"
    pair = "*SURFACE INTERACTION,NAME=I\n*CONTACT PAIR,INTERACTION=I\nS,S\n"
    path.write_text(f"{MIXED}{pair}*STEP\n*STATIC\n*END STEP\n")
    with pytest.raises(DeckError, match=r"deck.inp:\d+: surface 'S' has faces of linear and of quadratic elements"):
        load_deck(path)


def test_how_others_stabilise_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "deck.inp"
    static = "*STATIC, STABILIZE=2E-4, FACTOR=2E-4, ALLSDTOL=0, CONTINUE=NO\n0.1, 1.\n"
    path.write_text(f"{MIXED}*STEP\n{static}*DLOAD\nA,P3,2.\n*END STEP\n")
    assert load_deck(path).model.steps[0].name == "step 1"


CLEARANCE = "*CLEARANCE, SLAVE=Sslave, MASTER=Smaster, "


def with_clearance(folder: Path, lines: str) -> Path:
    path = folder / "clearance.inp"
    path.write_text(TWO_BLOCKS.replace("*BOUNDARY\nBase", f"{CLEARANCE}{lines}\n*BOUNDARY\nBase"))
    return path


def test_clearances_are_given_by_node(tmp_path: Path) -> None:
    one = sg.solve(sg.read(with_clearance(tmp_path, "VALUE=5.E-4"))).steps[0].contacts[0]
    same = sg.solve(sg.read(with_clearance(tmp_path, "TABULAR\n11, 5.E-4\n12, 5.E-4\n13, 5.E-4"))).steps[0].contacts[0]
    bent = sg.solve(sg.read(with_clearance(tmp_path, "TABULAR\n11, 2.\n12, 0.\n13, 2."))).steps[0].contacts[0]
    assert one.pressure.tolist() == same.pressure.tolist()
    assert bent.pressure.tolist()[::2] == [0.0, 0.0]
    assert bent.pressure[1] > one.pressure[1]


@pytest.mark.parametrize(
    ("lines", "begins", "said"),
    [
        ("TABULAR\n11, 0.\n12, 0.", CLEARANCE, "gives node 13 of 'Sslave' no clearance"),
        ("TABULAR\n11, 0., 0., 1.", "11, 0.", "has a normal beside the clearance, which is not supported"),
        ("TABULAR", CLEARANCE, "has no data line; expected a node or a node set, and a clearance"),
        ("TABULAR, VALUE=1.\n11, 0.", CLEARANCE, "has VALUE and TABULAR; expected one of them"),
    ],
)
def test_a_table_of_clearances_is_whole(tmp_path: Path, lines: str, begins: str, said: str) -> None:
    path = with_clearance(tmp_path, lines)
    with pytest.raises(DeckError, match=said) as told:
        load_deck(path)
    assert path.read_text().splitlines()[told.value.line - 1].startswith(begins)
