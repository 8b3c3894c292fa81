# SPDX-License-Identifier: BSD-3-Clause
"""Gasket elements between two bodies, as Abaqus writes them: contacts that close by their loading curve."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.deck import DeckError, load_deck

CURVE = "*GASKET THICKNESS BEHAVIOR, DIRECTION=LOADING\n0., 0.\n2., 0.01\n4., 0.04\n"
BACK = """*GASKET THICKNESS BEHAVIOR, DIRECTION=UNLOADING
0., 0.005, 0.005
3., 0.02, 0.005
0., 0.02, 0.02
4., 0.04, 0.02
"""

PLANE = """*NODE
1, 1., 0.
2, 2., 0.
3, 3., 0.
4, 1., 1.
5, 2., 1.
6, 3., 1.
11, 1., 1.1
12, 2., 1.1
13, 3., 1.1
14, 1., 2.1
15, 2., 2.1
16, 3., 2.1
*ELEMENT, TYPE=CPE4, ELSET=LOWER
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*ELEMENT, TYPE=CPE4, ELSET=UPPER
3, 11, 12, 15, 14
4, 12, 13, 16, 15
*ELEMENT, TYPE=GKPE4, ELSET=SHEET
11, 4, 5, 12, 11
12, 5, 6, 13, 12
*NSET, NSET=BASE
1, 2, 3
*NSET, NSET=SIDE
11, 14
*SURFACE, NAME=TOP
UPPER, S3
*BOUNDARY
BASE, 1, 2
SIDE, 1, 1
"""

SPACE = """*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
11, 0., 0., 1.
12, 1., 0., 1.
13, 1., 1., 1.
14, 0., 1., 1.
15, 0., 0., 2.
16, 1., 0., 2.
17, 1., 1., 2.
18, 0., 1., 2.
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2, 11, 12, 13, 14, 15, 16, 17, 18
*ELEMENT, TYPE=GK3D8N, ELSET=SHEET
11, 5, 6, 7, 8, 11, 12, 13, 14
*NSET, NSET=BASE
1, 2, 3, 4
*NSET, NSET=SIDE
11, 12, 13, 14, 15, 16, 17, 18
*SURFACE, NAME=TOP
UPPER, S2
*BOUNDARY
BASE, 1, 3
SIDE, 1, 2
"""


def deck(folder: Path, mesh: str = PLANE, *, curves: str = CURVE, section: str = "0.1,\n", pressures=(3.0,)) -> Path:
    """Two blocks, E 1000 and nu 0, with a gasket, under pressures step by step."""
    steps = [f"*STEP\n*STATIC\n*DSLOAD\nTOP, P, {pressure}\n*END STEP\n" for pressure in pressures]
    path = folder / "deck.inp"
    path.write_text(
        mesh
        + "*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.\n"
        + "".join(f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL\n" for name in ("LOWER", "UPPER"))
        + f"*GASKET SECTION, ELSET=SHEET, BEHAVIOR=FIBRE\n{section}*GASKET BEHAVIOR, NAME=FIBRE\n{curves}"
        + "".join(steps)
    )
    return path


@pytest.mark.parametrize(
    ("mesh", "area"),
    [
        (PLANE, 2.0),
        (PLANE.replace("CPE4", "CPS4").replace("GKPE4", "GKPS4N"), 2.0),
        (PLANE.replace("CPE4", "CAX4").replace("GKPE4", "GKAX4"), 8.0 * np.pi),
        (SPACE, 1.0),
    ],
    ids=["GKPE4", "GKPS4N", "GKAX4", "GK3D8N"],
)
def test_a_gasket_closes_by_its_table_and_stores_its_integral(tmp_path, mesh, area):
    elastic = CURVE.replace("LOADING", "LOADING, TYPE=DAMAGE")
    solution = sg.solve(sg.read(deck(tmp_path, mesh, curves=elastic)))
    (step,) = solution.steps
    (contact,) = step.contacts
    assert contact.name == "SHEET"
    assert_allclose(contact.pressure, 3.0, rtol=1e-12)
    assert_allclose(contact.gap, -0.025, rtol=1e-12)
    energy = np.trapezoid([0.0, 2.0, 3.0], [0.0, 0.01, 0.025])
    assert step.interface_energy == pytest.approx(area * energy, rel=1e-12)


def test_wedges_of_gasket_are_faces_of_wedges(tmp_path):
    """Two halves of a square."""
    nodes = SPACE[: SPACE.index("*ELEMENT")]
    wedges = "".join(
        f"*ELEMENT, TYPE={kind}, ELSET={name}\n"
        + "".join(f"{first + i}, {', '.join(map(str, face))}\n" for i, face in enumerate(faces))
        for kind, name, first, faces in (
            ("C3D6", "LOWER", 1, [(1, 2, 3, 5, 6, 7), (1, 3, 4, 5, 7, 8)]),
            ("C3D6", "UPPER", 3, [(11, 12, 13, 15, 16, 17), (11, 13, 14, 15, 17, 18)]),
            ("GK3D6", "SHEET", 11, [(5, 6, 7, 11, 12, 13), (5, 7, 8, 11, 13, 14)]),
        )
    )
    step = sg.solve(sg.read(deck(tmp_path, nodes + wedges + SPACE[SPACE.index("*NSET") :]))).steps[0]
    assert_allclose(step.contacts[0].pressure, 3.0, rtol=1e-12)


def test_it_springs_back_along_its_unloading_lines(tmp_path):
    solution = sg.solve(sg.read(deck(tmp_path, curves=CURVE + BACK, pressures=(3.0, 1.0))))
    assert [float(step.contacts[0].gap.mean()) for step in solution.steps] == pytest.approx([-0.025, -0.015], rel=1e-12)
    taken = 2.0 * (np.trapezoid([0.0, 2.0, 3.0], [0.0, 0.01, 0.025]) - 3.0**2 / 400.0)
    assert solution.steps[0].dissipation == pytest.approx(taken, rel=1e-12)
    assert abs(solution.steps[1].energy_defect) < 1e-14


@pytest.mark.parametrize(
    ("curves", "unloading"),
    [
        (CURVE, 200.0),
        (CURVE.replace("LOADING", "LOADING, TYPE=DAMAGE"), None),
        (CURVE.replace("LOADING", "LOADING, SLOPE DROP=0.7"), None),
        (CURVE.replace("LOADING", "LOADING, YIELD ONSET=0.01"), 200.0),
        (CURVE.replace("4., 0.04", "8., 0.04"), None),
        (CURVE + BACK, 200.0),
    ],
    ids=["yields", "damage", "no drop", "onset", "stiffens", "lines"],
)
def test_how_it_springs_back(tmp_path, curves, unloading):
    (contact,) = load_deck(deck(tmp_path, curves=curves)).model.contacts
    assert contact.closure.unloading == (None if unloading is None else pytest.approx(unloading, rel=1e-12))
    assert contact.friction == 0.0


def test_transverse_shear_sticks_and_an_initial_gap_closes_first(tmp_path):
    curves = CURVE + "*GASKET ELASTICITY, COMPONENT=TRANSVERSE SHEAR\n50.\n"
    found = load_deck(deck(tmp_path, curves=curves, section="0.1, 0.002\n"))
    (contact,) = found.model.contacts
    assert (contact.friction, contact.tangential_compliance, contact.gap) == ("stick", 0.02, 0.002)
    assert any(note.startswith("gasket elements are contacts of the faces") for note in found.notes)
    assert_allclose(sg.solve(found.model).steps[0].contacts[0].gap, -0.025, rtol=1e-12)


def test_general_contact_leaves_gaskets_to_their_sections(tmp_path):
    given = PLANE + "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n"
    (contact,) = load_deck(deck(tmp_path, given)).model.contacts
    assert contact.name == "SHEET"


def line_of(path: Path, start: str) -> int:
    return next(i for i, line in enumerate(path.read_text().split("\n"), 1) if line.startswith(start))


@pytest.mark.parametrize(
    ("given", "place", "said"),
    [
        (
            {"mesh": PLANE.replace("GKPE4", "GK2D2")},
            "*ELEMENT, TYPE=GK2D2",
            "TYPE=GK2D2 is not supported; expected GK3D6",
        ),
        ({"mesh": PLANE.replace("GKPE4", "GKAX4")}, "*ELEMENT, TYPE=GKAX4", "GKAX4 is axisymmetric, but CPE4 of line"),
        (
            {"mesh": PLANE.replace("11, 4, 5, 12, 11", "11, 4, 12, 5, 11")},
            "11, 4, 12",
            "the first nodes of element 11 are no face of a solid element",
        ),
        ({"mesh": PLANE + "*ELEMENT, TYPE=GKPE4\n13, 1, 2, 15, 14\n"}, "13, 1", "element 13 has no section"),
        ({"section": "0.1, 0., 0.01\n"}, "0.1, 0., 0.01", "an initial void is not supported"),
        ({"section": "0.1, 0., 0., 2.\n"}, "0.1, 0., 0., 2.", "is 2 wide, bodies are 1 thick"),
        ({"curves": ""}, "*GASKET BEHAVIOR", "has no *GASKET THICKNESS BEHAVIOR, DIRECTION=LOADING"),
        ({"curves": CURVE.replace("4., 0.04", "1., 0.04")}, "1., 0.04", "is 1 after 2; expected pressures that grow"),
        ({"curves": CURVE.replace("4., 0.04", "4., 0.04, 20.")}, "4., 0.04, 20.", "depends on temperature"),
        (
            {"curves": CURVE.replace("LOADING", "LOADING, VARIABLE=FORCE")},
            "*GASKET THICK",
            "VARIABLE=FORCE is of links",
        ),
        ({"curves": CURVE.replace("LOADING", "LOADING, YIELD ONSET=0.02")}, "*GASKET THICK", "YIELD ONSET=0.02 is no"),
        ({"curves": CURVE + BACK.replace("4., 0.04", "4., 0.03")}, "4., 0.03", "springs back by 400, others by 200"),
        (
            {"curves": CURVE + BACK.replace("3., 0.02", "1., 0.015, 0.005\n3., 0.02")},
            "1., 0.015",
            "the curve to the plastic closure 0.005 bends",
        ),
        (
            {"curves": (CURVE + BACK).replace("=LOADING", "=LOADING, TYPE=DAMAGE")},
            "*GASKET THICKNESS BEHAVIOR, DIRECTION=UNLOADING",
            "springs back to no closure (TYPE=DAMAGE)",
        ),
        (
            {"curves": CURVE + "*GASKET ELASTICITY, COMPONENT=MEMBRANE\n100., 0.3\n"},
            "*GASKET ELASTICITY",
            "COMPONENT=MEMBRANE is not supported",
        ),
        (
            {"mesh": PLANE + "*SURFACE, NAME=SIDE\nSHEET, S1\n"},
            "SHEET, S1",
            "gasket elements have no faces here; expected those of the bodies beside them",
        ),
        (
            {"mesh": PLANE + "*SOLID SECTION, ELSET=SHEET, MATERIAL=STEEL\n"},
            "*SOLID SECTION, ELSET=SHEET",
            "'SHEET' holds GKPE4 beside CPE4 of the model; expected *GASKET SECTION for these",
        ),
        ({"curves": CURVE + "*EXPANSION\n1.E-5\n"}, "*EXPANSION", "of a *GASKET BEHAVIOR is not supported"),
    ],
)
def test_what_is_refused_is_told_with_its_line(tmp_path, given, place, said):
    path = deck(tmp_path, **given)
    with pytest.raises(DeckError) as caught:
        load_deck(path)
    assert said in str(caught.value)
    assert caught.value.line == line_of(path, place)
