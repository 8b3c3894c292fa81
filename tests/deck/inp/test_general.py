# SPDX-License-Identifier: BSD-3-Clause
"""General contact: pairs found by closeness are those that a user would write."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import load_deck
from signorini.deck.deck import Deck
from signorini.deck.error import DeckError


def _block(
    name: str, cells: tuple[int, int], corner: tuple[float, float], size: tuple[float, float], first: int
) -> str:
    """A block of quadrilaterals whose nodes and elements count from ``first``."""
    columns, rows = cells
    lines = [f"*NODE, NSET={name}"]
    for j in range(rows + 1):
        for i in range(columns + 1):
            x, y = corner[0] + size[0] * i / columns, corner[1] + size[1] * j / rows
            lines.append(f"{first + j * (columns + 1) + i}, {x}, {y}")
    lines.append(f"*ELEMENT, TYPE=CPE4, ELSET={name}")
    for j in range(rows):
        for i in range(columns):
            a = first + j * (columns + 1) + i
            lines.append(f"{first + j * columns + i}, {a}, {a + 1}, {a + columns + 2}, {a + columns + 1}")
    return "\n".join([*lines, f"*SOLID SECTION, ELSET={name}, MATERIAL=S", "1.", ""])


PARTS = "".join(
    (
        _block("Low", (8, 2), (0.0, 0.0), (4.0, 1.0), 1),
        _block("Mid", (5, 2), (1.0, 1.0), (2.0, 1.0), 101),
        _block("Top", (8, 2), (1.0, 2.0), (2.0, 1.0), 201),
    )
)
LAWS = """*NSET, NSET=BASE, GENERATE
1, 9
*NSET, NSET=CAP, GENERATE
219, 227
*SURFACE, NAME=SLow
Low
*SURFACE, NAME=SMid
Mid
*SURFACE, NAME=STop
Top
*MATERIAL, NAME=S
*ELASTIC
1000., .3
*SURFACE INTERACTION, NAME=Smooth
*SURFACE INTERACTION, NAME=Rough
*FRICTION
0.5
"""
STEP = """*STEP
*STATIC
*BOUNDARY
BASE, 1, 2
CAP, 1, 1, 0.001
CAP, 2, 2, -0.01
*END STEP
"""


def _read(tmp_path: Path, contact: str, step: str = STEP) -> Deck:
    deck = tmp_path / "deck.inp"
    deck.write_text(PARTS + LAWS + contact + step)
    return load_deck(deck)


def test_it_is_the_pairs_that_one_would_write(tmp_path: Path) -> None:
    """The last assignment of a law counts; without any there is no friction."""
    general = _read(
        tmp_path,
        "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n , , Smooth\nSMid, STop, Rough\n"
        "*CONTACT FORMULATION\n",
    )
    assert [(c.nonmortar, c.mortar, c.friction) for c in general.model.contacts] == [
        ("Low facing Mid", "Mid facing Low", 0.0),
        ("Mid facing Top", "Top facing Mid", 0.5),
    ]
    assert any("found by closeness (Low facing Mid on Mid facing Low, " in note for note in general.notes)
    faces = {"Lower": (range(9, 17), 3), "Under": (range(101, 106), 1), "Over": (range(106, 111), 3)}
    faces["Upper"] = range(201, 209), 1
    pairs = "".join(
        f"*SURFACE, NAME={name}\n" + "".join(f"{element}, S{face}\n" for element in elements)
        for name, (elements, face) in faces.items()
    )
    pairs += "*CONTACT PAIR, INTERACTION=Smooth\nLower, Under\n*CONTACT PAIR, INTERACTION=Rough\nOver, Upper\n"
    written = sg.solve(_read(tmp_path, pairs).model)
    found = sg.solve(general.model)
    np.testing.assert_allclose(found.last.displacement, written.last.displacement, atol=1e-12)
    assert np.abs(found.last.displacement).max() > 0.009


def test_surfaces_are_included_and_excluded(tmp_path: Path) -> None:
    def names(contact: str) -> list[str]:
        return [contact.nonmortar for contact in _read(tmp_path, contact).model.contacts]

    assert names("*CONTACT\n*CONTACT INCLUSIONS\nSTop, SMid\n") == ["Mid facing Top"]
    assert names("*CONTACT\n*CONTACT INCLUSIONS\nSMid,\n") == ["Low facing Mid", "Mid facing Top"]
    assert names("*CONTACT\n*CONTACT EXCLUSIONS\nSLow, SMid\n") == ["Mid facing Top"]
    with pytest.raises(DeckError, match="finds no faces of two parts"):
        names("*CONTACT\n*CONTACT INCLUSIONS\nSTop, SLow\n")
    with pytest.raises(DeckError, match=r"unknown surface interaction 'Slick'.*"):
        names("*CONTACT\n*CONTACT PROPERTY ASSIGNMENT\n , , Slick\n")
    with pytest.raises(DeckError, match="unknown surface 'SSide'"):
        names("*CONTACT\n*CONTACT EXCLUSIONS\nSSide, SMid\n")


def test_pairs_and_ties_that_are_written_stay(tmp_path: Path) -> None:
    contact = "*TIE, NAME=T\nSTop, SMid\n*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n"
    found = _read(tmp_path, contact).model.contacts
    assert [(contact.nonmortar, contact.tied) for contact in found] == [("STop", True), ("Low facing Mid", False)]


def test_overlaps_are_removed_and_sides_follow_large_motion(tmp_path: Path) -> None:
    """As Abaqus does in small sliding; with NLGEOM gaps are those of the geometry."""
    (small,) = {contact.adjust for contact in _read(tmp_path, "*CONTACT\n").model.contacts}
    assert small == 0.0
    large = _read(tmp_path, "*CONTACT\n", step=STEP.replace("*STEP", "*STEP, NLGEOM")).model.contacts
    assert {(contact.sliding, contact.adjust) for contact in large} == {("finite", None)}


def test_parts_in_space_face_each_other(tmp_path: Path) -> None:
    """The pair of a deck in space, found instead of written, gives the same answer."""
    text = Path(__file__).with_name("decks").joinpath("cubes.inp").read_text()
    written = tmp_path / "written.inp"
    written.write_text(text.replace("\nUNDER, OVER", "\nOVER, UNDER"))  # the larger faces are those of tetrahedra
    start = text.index("*CONTACT PAIR")
    end = text.index("*BOUNDARY")
    found = tmp_path / "found.inp"
    general = "*CONTACT\n*CONTACT PROPERTY ASSIGNMENT\n , , LAW\n"
    dat = text.index("*CONTACT PRINT")
    found.write_text(text[:start] + general + text[end:dat] + text[text.index("*END STEP", dat) :])
    a, b = sg.solve(load_deck(written).model), sg.solve(load_deck(found).model)
    np.testing.assert_allclose(b.last.displacement, a.last.displacement, atol=1e-9 * np.abs(a.last.displacement).max())
