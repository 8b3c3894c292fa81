# SPDX-License-Identifier: BSD-3-Clause
"""How materials of decks yield: what ``*PLASTIC`` and ``*CYCLIC HARDENING`` mean, and what is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import signorini as sg
from signorini.cli import main
from signorini.deck import DeckError, load_deck
from tests.helpers.calculix import ccx_displacements, ccx_stresses, needs_ccx
from tests.helpers.cyclic_bar import CyclicBar

E, NU = 200.0, 0.3
BRICK = (
    "*NODE,NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
    "*ELEMENT,TYPE=C3D8,ELSET=E\n1,1,2,3,4,5,6,7,8\n*NSET,NSET=PULL\n2,3,6,7\n"
    f"*MATERIAL,NAME=M\n*ELASTIC\n{E},{NU}\n"
)
HELD = "*SOLID SECTION,ELSET=E,MATERIAL=M\n*BOUNDARY\n1,1\n4,1\n5,1\n8,1\n1,2\n2,2\n5,2\n6,2\n1,3\n2,3\n3,3\n4,3\n"
TABLE = "*PLASTIC\n.02,0.\n.02,.001\n.04,.006\n"


def deck(
    folder: Path, law: str, strains: tuple[float, ...] = (0.001,), *, increments: int = 1, nlgeom: str = ""
) -> Path:
    """One brick, pulled along x to one strain after the other."""
    steps = [
        f"*STEP{nlgeom},INC=1000\n*STATIC,DIRECT\n{1 / increments},1.\n*BOUNDARY\nPULL,1,1,{strain}\n"
        f"*EL PRINT,ELSET=E,FREQUENCY={increments}\nS\n*END STEP\n"
        for strain in strains
    ]
    path = folder / "deck.inp"
    path.write_text(BRICK + law + HELD + "".join(steps))
    return path


def read_law(folder: Path, law: str) -> sg.Plastic:
    (body,) = sg.read(deck(folder, law)).bodies
    assert body.formulation == "mean dilatation"
    return body.material.plastic


MEANINGS = {
    "perfect": ("*PLASTIC\n.02\n", sg.Plastic(0.02)),
    "a table": (TABLE, sg.Plastic([(0.0, 0.02), (0.001, 0.02), (0.006, 0.04)])),
    "at one temperature": (
        "*PLASTIC,HARDENING=ISOTROPIC\n.02,0.,20.\n.04,.006,20.\n",
        sg.Plastic([(0, 0.02), (0.006, 0.04)]),
    ),
    "at two temperatures": (
        "*PLASTIC\n.02,0.,20.\n.04,.006,20.\n.01,,120.\n",
        sg.Plastic([(0, 0.02, 20), (0.006, 0.04, 20), (0, 0.01, 120)]),
    ),
    "a kinematic line": (
        "*PLASTIC,HARDENING=KINEMATIC\n.02,0.\n.04,.01\n",
        sg.Plastic(0.02, backstresses=[(2.0, 0.0)]),
    ),
    "a kinematic line that is flat": ("*PLASTIC,HARDENING=KINEMATIC\n.02,0.\n.02,.01\n", sg.Plastic(0.02)),
    "both": (
        "*PLASTIC,HARDENING=COMBINED\n.02,0.\n.03,.01\n*CYCLIC HARDENING\n.02,0.\n.06,.01\n",
        sg.Plastic([(0, 0.02), (0.01, 0.06)], backstresses=[(1.0, 0.0)]),
    ),
    "no cyclic hardening": (
        "*PLASTIC,HARDENING=COMBINED\n.02,0.\n.03,.01\n",
        sg.Plastic(0.02, backstresses=[(1.0, 0.0)]),
    ),
    "parameters": (
        "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS\n.02,50.,25.\n",
        sg.Plastic(0.02, backstresses=[(50.0, 25.0)]),
    ),
    "parameters in lines": (
        "*Plastic, hardening=combined, datatype=parameters, number backstresses=2\n.02,50.,25.,4.\n0.,293.\n"
        "*Cyclic Hardening, parameters\n.02,0.,7.\n",
        sg.Plastic(0.02, backstresses=[(50.0, 25.0), (4.0, 0.0)]),
    ),
}


@pytest.mark.parametrize("case", MEANINGS)
def test_a_material_yields_as_it_says(case: str, tmp_path: Path) -> None:
    law, expected = MEANINGS[case]
    found = read_law(tmp_path, law)
    assert found.yield_stress == expected.yield_stress
    np.testing.assert_allclose(found.backstresses, expected.backstresses, rtol=1e-12)


@pytest.mark.parametrize(("rise", "rate"), [(0.02, 10.0), (0.5, 300.0), (3e-6, 1.0), (1e-6, 1.0)])
def test_voces_law_is_a_fine_table(rise: float, rate: float, tmp_path: Path) -> None:
    backstress = "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS\n.02,50.,25.\n"
    law = f"{backstress}*CYCLIC HARDENING,PARAMETERS\n.02,{rise},{rate}\n"
    found = read_law(tmp_path, law)
    p = np.linspace(0.0, 30.0 / rate, 100001)
    exact = 0.02 - rise * np.expm1(-rate * p)
    assert np.abs(found.at(p)[0] - exact).max() <= 1e-4 * 0.02
    assert len(found.curve) < 80 * max(1.0, np.sqrt(rise / 0.02))
    notes = load_deck(tmp_path / "deck.inp").notes
    assert any("its parameters become a table of" in note for note in notes) == (rise > 2e-6)


WRONG = {  # the law, how the line that is named begins, what is said
    "softens": ("*PLASTIC\n.02,0.\n.01,.1\n", ".01", "*PLASTIC: the yield stress is 0.01 after 0.02: the material"),
    "jumps": (
        "*PLASTIC\n.02,0.\n.03,0.\n",
        ".03",
        "the plastic strain is 0 after 0; expected increasing plastic strains",
    ),
    "goes back": ("*PLASTIC\n.02,0.\n.03,.2\n.04,.1\n", ".04", "the plastic strain is 0.1 after 0.2"),
    "begins late": ("*PLASTIC\n.02,.1\n", ".02", "the plastic strain is 0.1; expected 0, the plastic strain at first"),
    "nothing": ("*PLASTIC\n0.,0.\n", "0.,", "the yield stress is 0.0; expected a number > 0"),
    "no data": ("*PLASTIC\n", "*PLASTIC", "has no data line; expected yield stress and plastic strain"),
    "colder": (
        "*PLASTIC\n.02,0.,20.\n.01,0.,10.\n",
        ".01",
        "the temperature is 10 after 20; expected increasing temperatures, the rows of each together",
    ),
    "crosses": (
        "*PLASTIC\n.02,0.,20.\n.03,.1,20.\n.022,0.,90.\n.025,.1,90.\n",
        ".025",
        "the yield stress is 0.025: the curve of temperature 90 crosses that of 20 before a plastic strain of 0.1",
    ),
    "warm from a strain on": ("*PLASTIC\n.02,0.,20.\n.01,0.1,30.\n", ".01", "the plastic strain is 0.1; expected 0"),
    "warm and kinematic": (
        "*PLASTIC,HARDENING=KINEMATIC\n.02,0.,20.\n.01,0.,100.\n",
        "*PLASTIC",
        "HARDENING=KINEMATIC depends on temperature, which is not supported",
    ),
    "warm and cyclic": (
        "*PLASTIC,HARDENING=COMBINED\n.02,0.\n*CYCLIC HARDENING\n.02,0.,20.\n.02,0.,30.\n.03,1.,30.\n",
        "*CYCLIC HARDENING",
        "depends on temperature, which is not supported; expected one",
    ),
    "kinematic": (
        "*PLASTIC,HARDENING=KINEMATIC\n.02,0.\n.03,.1\n.04,.3\n",
        ".04",
        "has 3 rows, and no backstress follows",
    ),
    "combined": ("*PLASTIC,HARDENING=COMBINED\n.02,0.\n.03,.1\n.04,.3\n", ".04", "HARDENING=COMBINED has 3 rows"),
    "user": ("*PLASTIC,HARDENING=USER\n.02,0.\n", "*PLASTIC", "HARDENING: unknown value 'USER'"),
    "rate": ("*PLASTIC,RATE=1.\n.02,0.\n", "*PLASTIC", "parameter RATE is not supported"),
    "scale": ("*PLASTIC,SCALESTRESS=2.\n.02,0.\n", "*PLASTIC", "parameter SCALESTRESS is not supported"),
    "extrapolation": (
        "*PLASTIC,EXTRAPOLATION=LINEAR\n.02,0.\n",
        "*PLASTIC",
        "parameter EXTRAPOLATION is not supported",
    ),
    "half cycle": (
        "*PLASTIC,HARDENING=COMBINED,DATA TYPE=HALF CYCLE\n.02,0.\n",
        "*PLASTIC",
        "DATA TYPE: unknown value",
    ),
    "not combined": (
        "*PLASTIC,DATA TYPE=PARAMETERS\n.02,1.,1.\n",
        "*PLASTIC",
        "DATA TYPE goes with HARDENING=COMBINED",
    ),
    "fitted": ("*PLASTIC,HARDENING=COMBINED,NUMBER BACKSTRESSES=2\n.02,0.\n", "*PLASTIC", "BACKSTRESSES goes with"),
    "too few": (
        "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS,NUMBER BACKSTRESSES=2\n.02,1.,1.\n",
        "*PLASTIC",
        "has 3 numbers; expected 5: the yield stress, then C and gamma of every backstress, at one temperature",
    ),
    "how many": (
        "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS,NUMBER BACKSTRESSES=0\n.02\n",
        "*PLASTIC",
        "NUMBER BACKSTRESSES is '0'; expected a whole number from 1 to 10",
    ),
    "negative": (
        "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS\n.02,1.,-1.\n",
        "*PLASTIC",
        "gamma of backstress 1 is -1",
    ),
    "no stress": (
        "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS\n0.,1.,1.\n",
        "*PLASTIC",
        "the yield stress is 0.0",
    ),
    "twice": (f"{TABLE}*PLASTIC,\n.03,0.\n", "*PLASTIC,", "'M' has another one in line 17; expected one"),
    "cyclic alone": ("*CYCLIC HARDENING\n.02,0.\n", "*CYCLIC", "stands before any *PLASTIC of its material"),
    "cyclic, isotropic": (f"{TABLE}*CYCLIC HARDENING\n.02,0.\n", "*CYCLIC", "belongs to *PLASTIC, HARDENING=COMBINED"),
    "two beginnings": (
        "*PLASTIC,HARDENING=COMBINED\n.02,0.\n.03,.01\n*CYCLIC HARDENING\n.05,0.\n",
        ".05",
        "begins at the yield stress 0.05, *PLASTIC at 0.02; expected the same",
    ),
    "cyclic softening": (
        "*PLASTIC,HARDENING=COMBINED\n.02,0.\n*CYCLIC HARDENING,PARAMETERS\n.02,-.01,3.\n",
        "*CYCLIC",
        "Q is -0.01 and b 3: the material softens",
    ),
    "cyclic properties": (
        "*PLASTIC,HARDENING=COMBINED\n.02\n*CYCLIC HARDENING,RANGE=1.\n",
        "*CYCLIC",
        "parameter RANGE is not",
    ),
    "creep": (f"{TABLE}*CREEP\n1.,2.,0.\n", "*CREEP", "is not supported, and it may change the answer"),
    "strained before": (
        f"{TABLE}*INITIAL CONDITIONS,TYPE=PLASTIC STRAIN\nE,0.,0.,0.,0.,0.,0.\n",
        "*INITIAL",
        "TYPE: unknown value 'PLASTIC STRAIN'",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_meant_stops_with_its_line(case: str, tmp_path: Path) -> None:
    law, begins, said = WRONG[case]
    path = deck(tmp_path, law)
    with pytest.raises(DeckError) as caught:
        load_deck(path)
    assert said in str(caught.value)
    assert caught.value.line is not None
    assert path.read_text().splitlines()[caught.value.line - 1].startswith(begins)


def test_orthotropic_materials_do_not_yield(tmp_path: Path) -> None:
    path = deck(tmp_path, TABLE)
    wood = path.read_text().replace("*ELASTIC\n200.0,0.3", "*ELASTIC,TYPE=ENGINEERING CONSTANTS\n9,7,4,.2,.2,.3,3,2\n2")
    path.write_text(wood)
    with pytest.raises(DeckError, match="'M' is orthotropic; only isotropic materials yield here"):
        load_deck(path)


def test_elements_of_bodies_that_yield_keep_their_volume(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = deck(tmp_path, TABLE)
    assert "elements of bodies that yield have a mean dilatation, so that they do not lock" in load_deck(path).notes
    assert main(["check", str(path)]) == 0
    assert "yields at 0.02, 0.04 at 0.006" in capsys.readouterr().out
    path.write_text(path.read_text().replace("C3D8", "C3D8I"))
    assert not any("do not lock" in note for note in load_deck(path).notes)
    assert sg.read(path).bodies[0].formulation == "incompatible"
    path.write_text(path.read_text().replace("C3D8I,ELSET=E\n1,1,2,3,4,5,6,7,8", "C3D4,ELSET=E\n1,1,2,4,5"))
    with pytest.raises(DeckError, match=r"\*SOLID SECTION: 'E' yields: its cells \(tetra\) would lock where it flows"):
        load_deck(path)


def test_quadratic_wedges_yield_as_they_are(tmp_path: Path) -> None:
    text = (Path(__file__).parent / "decks" / "wedges.inp").read_text()
    path = tmp_path / "deck.inp"
    i = text.index("\n", text.index("\n", text.upper().index("*ELASTIC")) + 1) + 1
    path.write_text(text[:i] + TABLE + text[i:])
    families = {body.name: sg.read(path).mesh.families(body.name) for body in sg.read(path).bodies}
    for body in sg.read(path).bodies:
        if body.material.yields and "wedge15" in families[body.name]:
            assert body.formulation == "standard"
            break
    else:
        pytest.fail("the deck has no quadratic wedges that yield")


@needs_ccx
def test_a_table_is_that_of_calculix_and_constant_beyond_its_last_row(tmp_path: Path) -> None:
    """Solved here, by CalculiX, and uniaxially: ``sigma = Y(p)`` with ``p = eps - sigma / E``."""
    strains = (0.0008, 0.0011, 0.004, 0.02)
    law = read_law(tmp_path, TABLE)
    path = deck(tmp_path, TABLE, strains)
    pulled = [step.reactions["PULL u1"][0] for step in sg.solve(sg.read(path)).steps]
    for strain, stress, force in zip(strains, ccx_stresses(path), pulled, strict=True):
        excess = lambda p: float(law.at(np.array(p))[0]) - E * (strain - p)  # noqa: B023, E731
        exact = E * (strain - brentq(excess, 0.0, strain))
        np.testing.assert_allclose(stress[:, 0], exact, rtol=2e-5)
        assert force == pytest.approx(exact, rel=1e-8)
    assert exact == pytest.approx(0.04, rel=1e-9)


@needs_ccx
def test_a_kinematic_line_is_that_of_calculix(tmp_path: Path) -> None:
    """Pulled, then pushed, within the table: CalculiX is right with NLGEOM only (2.20), so strains are tiny."""
    law, strains = "*PLASTIC,HARDENING=KINEMATIC\n.02,0.\n.03,.005\n", (0.001, -0.001)
    ((modulus, recall),) = read_law(tmp_path, law).backstresses
    bar = CyclicBar(E=E, yield_stress=0.02, hardening=modulus, recall=recall)
    found = ccx_stresses(deck(tmp_path, law, strains, increments=20, nlgeom=",NLGEOM"))
    for (exact, _), stress in zip(bar.follow(strains), found, strict=True):
        np.testing.assert_allclose(stress[:, 0], exact, rtol=3e-3)  # true stress of a strain of 0.1 %


def test_backstresses_of_a_deck_follow_their_closed_form(tmp_path: Path) -> None:
    """Armstrong and Frederick's, pulled and pushed: backward Euler tends to it in first order."""
    law = "*PLASTIC,HARDENING=COMBINED,DATA TYPE=PARAMETERS\n1.,50.,25.\n"
    strains = (0.05, -0.05)
    model = sg.read(deck(tmp_path, law, strains))
    exact = [stress for stress, _ in CyclicBar(E=E, yield_stress=1.0, hardening=50.0, recall=25.0).follow(strains)]
    errors = []
    for count in (16, 32):
        steps = [replace(step, increments=count) for step in model.steps]
        found = [step.reactions["PULL u1"][0] for step in sg.solve(replace(model, steps=steps)).steps]
        errors.append(np.abs(np.subtract(found, exact)).max())
    assert errors[0] < 0.06
    assert errors[1] == pytest.approx(0.5 * errors[0], rel=0.1)


HOT = "*PLASTIC\n.02,0.,20.\n.01,0.,220.\n"


def warm(folder: Path, initial: str) -> Path:
    """One brick that is pulled to 0.8 of the yield stress, then held and heated to 170."""
    path = deck(folder, HOT, (0.00008, 0.00008))
    text = path.read_text().replace("*STEP", f"*INITIAL CONDITIONS,TYPE=TEMPERATURE\n{initial}*STEP", 1)
    before, last = text.rsplit("*EL PRINT", 1)
    path.write_text(f"{before}*TEMPERATURE\nALL,170.\n*EL PRINT{last}")
    return path


def test_temperatures_of_a_table_are_those_of_the_deck(tmp_path: Path) -> None:
    """From 20 to 170 the yield stress falls from 0.02 to 0.0125; it is the stress of 0.016 at 100."""
    model = sg.read(warm(tmp_path, "ALL,20.\n"))
    assert model.bodies[0].material.plastic.temperatures.tolist() == [0.0, 200.0]
    solution = sg.solve(model)
    assert solution.last.yielding.first == pytest.approx(1.0 + 80.0 / 150.0, rel=1e-9)
    assert solution.stress("E").stress[:, 0] == pytest.approx(0.0125, rel=1e-8)


@needs_ccx
def test_calculix_takes_a_table_of_temperatures_alike(tmp_path: Path) -> None:
    found = ccx_stresses(warm(tmp_path, "ALL,20.\n"))
    assert found[-1, :, 0] == pytest.approx(0.0125, rel=1e-4)


def test_a_body_whose_temperatures_differ_at_the_beginning_has_no_one_law(tmp_path: Path) -> None:
    with pytest.raises(DeckError, match="the body begins at temperatures from 0 to 20; expected one in") as caught:
        load_deck(warm(tmp_path, "PULL,20.\n"))
    assert caught.value.line == warm(tmp_path, "PULL,20.\n").read_text().splitlines().index("*PLASTIC") + 1


@needs_ccx
def test_bricks_with_incompatible_modes_yield_as_those_of_calculix(tmp_path: Path) -> None:
    """A cantilever of C3D8I, bent far beyond first yield in 20 increments: displacements to 1e-5 of the largest."""
    mesh = sg.box(x=np.linspace(0.0, 6.0, 7), y=np.linspace(0.0, 1.0, 3), z=[0.0, 1.0])
    nodes = "".join(f"{i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(mesh.points, start=1))
    bricks = "".join(
        f"{i},{','.join(str(node + 1) for node in cell)}\n" for i, cell in enumerate(mesh.cells["hexahedron"], start=1)
    )
    left, right = ("".join(f"{node + 1}\n" for node in np.flatnonzero(mesh.points[:, 0] == at)) for at in (0.0, 6.0))
    path = tmp_path / "deck.inp"
    path.write_text(
        f"*NODE,NSET=ALL\n{nodes}*ELEMENT,TYPE=C3D8I,ELSET=E\n{bricks}*NSET,NSET=LEFT\n{left}*NSET,NSET=RIGHT\n{right}"
        f"*MATERIAL,NAME=M\n*ELASTIC\n{E},{NU}\n*PLASTIC\n.2,0.\n.3,.1\n*SOLID SECTION,ELSET=E,MATERIAL=M\n"
        "*BOUNDARY\nLEFT,1,3\n*STEP,INC=1000\n*STATIC,DIRECT\n.05,1.\n*BOUNDARY\nRIGHT,2,2,-.2\n"
        "*NODE PRINT,NSET=ALL,FREQUENCY=20\nU\n*END STEP\n"
    )
    model = sg.read(path)
    assert model.bodies[0].formulation == "incompatible"
    (step,) = model.steps
    solution = sg.solve(replace(model, steps=[replace(step, increments=20)]))
    assert solution.last.yielding.largest > 0.005
    np.testing.assert_allclose(solution.last.displacement, ccx_displacements(path)[-1], rtol=0, atol=1e-5 * 0.2)
