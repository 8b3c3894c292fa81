# SPDX-License-Identifier: BSD-3-Clause
"""Materials that yield: their law, what is refused, and how decks and archives say it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck.write import write_deck
from signorini.output.dataclasses_json import from_plain, to_plain

ROWS = [(0.0, 235.0), (0.02, 235.0), (0.3, 400.0)]
STEEL = sg.Elastic(E=210e3, nu=0.3, plastic=sg.Plastic(235.0))


def model(material=STEEL, formulation=None, kind="", cells="quad", **parts):
    return sg.Model(
        sg.rectangle(width=1.0, height=1.0, nx=1, ny=1, cells=cells),
        kind=kind,
        bodies=[sg.Body("block", material, formulation)],
        **parts,
    )


def test_the_curve_is_linear_between_rows_and_hardens_beyond_the_last():
    law = sg.Plastic(ROWS, hardening=50.0)
    p = np.array([[0.0, 0.01, 0.02], [0.16, 0.3, 0.5]])
    stress, slope = law.at(p)
    rise = 165.0 / 0.28
    np.testing.assert_allclose(stress, [[235.0, 235.0, 235.0], [317.5, 400.0, 410.0]])
    np.testing.assert_allclose(slope, [[0.0, 0.0, rise], [rise, 50.0, 50.0]])
    assert sg.Plastic(ROWS).at(np.array([7.0]))[0] == 400.0


def test_what_hardens_is_not_perfect():
    assert sg.Plastic(1.0).perfect
    assert sg.Plastic([(0.0, 1.0), (1.0, 1.0)]).perfect
    for law in (sg.Plastic(1.0, hardening=0.1), sg.Plastic(ROWS), sg.Plastic(1.0, backstresses=[(1.0, 0.0)])):
        assert not law.perfect


def test_a_law_is_plain_data():
    law = sg.Plastic(235, backstresses=np.array([[20e3, 100.0]]))
    assert law == sg.Plastic([[0, 235]], backstresses=((20e3, 100),))
    assert law.yield_stress == ((0.0, 235.0),)
    assert law.backstresses == ((20e3, 100.0),)
    assert len({law, sg.Plastic(235.0)}) == 2


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"yield_stress": 0.0}, "yield_stress: is 0.0; expected a number > 0"),
        ({"yield_stress": "low"}, "yield_stress: is 'low'; expected a number > 0"),
        ({"yield_stress": []}, "yield_stress: has shape (0,); expected (n, 2)"),
        ({"yield_stress": [1.0, 2.0]}, "yield_stress: has shape (2,); expected (n, 2)"),
        ({"yield_stress": [(0.1, 1.0)]}, "yield_stress[0][0]: is 0.1; expected 0, the plastic strain at first yield"),
        ({"yield_stress": [(0.0, 0.0)]}, "yield_stress[0][1]: is 0.0; expected a number > 0"),
        (
            {"yield_stress": [(0.0, 1.0), (0.0, 2.0)]},
            "yield_stress[1][0]: is 0 after 0; expected increasing plastic strains",
        ),
        (
            {"yield_stress": [(0.0, 2.0), (0.1, 3.0), (0.2, 1.0)]},
            "yield_stress[2][1]: is 1 after 3: the material softens; expected stresses that do not decrease",
        ),
        ({"yield_stress": 1.0, "hardening": -1.0}, "hardening: is -1.0; expected a number >= 0"),
        ({"yield_stress": 1.0, "backstresses": 3.0}, "backstresses: has shape (); expected (n, 2)"),
        ({"yield_stress": 1.0, "backstresses": [(1.0,)]}, "backstresses: has shape (1, 1); expected (n, 2)"),
        ({"yield_stress": 1.0, "backstresses": [(0.0, 1.0)]}, "backstresses[0][0]: is 0.0; expected a number > 0"),
        ({"yield_stress": 1.0, "backstresses": [(1.0, -1.0)]}, "backstresses[0][1]: is -1.0; expected a number >= 0"),
    ],
)
def test_wrong_laws(parts, words):
    with pytest.raises(sg.InputError) as caught:
        sg.Plastic(**parts)
    assert str(caught.value) == words


def test_cells_of_bodies_that_yield_keep_their_volume():
    assert model().bodies[0].formulation == "mean dilatation"
    assert model(replace(STEEL, plastic=None)).bodies[0].formulation == "standard"
    assert model().yields
    assert not model(replace(STEEL, plastic=None)).yields
    for cells in ("triangle6", "quad8", "quad9"):
        assert model(formulation="standard", cells=cells).yields
    assert model(formulation="incompatible").bodies[0].formulation == "incompatible"


def test_in_plane_stress_the_thickness_gives_way_and_no_cell_locks():
    for cells in ("triangle", "quad", "triangle6", "quad8"):
        assert model(kind="plane stress", cells=cells).bodies[0].formulation == "standard"
    assert model(kind="plane stress", formulation="incompatible").yields


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        (
            {"formulation": "standard"},
            "body[0].formulation: is 'standard', but 'block' yields: its cells (quad) would lock where it flows. "
            "Expected 'mean dilatation'",
        ),
        (
            {"cells": "triangle"},
            "body[0].formulation: 'block' yields: its cells (triangle) would lock where it flows. Expected "
            "quadrilaterals, hexahedra or quadratic cells",
        ),
        (
            {"formulation": "incompatible", "cells": "triangle"},
            "body[0].formulation: 'block' yields: its cells (triangle) would lock where it flows. Expected "
            "quadrilaterals, hexahedra or quadratic cells",
        ),
    ],
)
def test_bodies_that_cannot_yield(parts, words):
    with pytest.raises(sg.InputError) as caught:
        model(**parts)
    assert str(caught.value) == words
    rigid = sg.RigidBody("rigid", on="block", point=(0.0, 0.0))
    model(**parts, rigid_bodies=[rigid])  # it never yields


def test_quadratic_wedges_yield_as_they_are():
    wedges = {"wedge15": 1}
    assert sg.Body("block", STEEL).in_kind("3d", wedges) == sg.Body("block", STEEL, "standard")
    assert sg.Body("block", STEEL, "standard").check_flow((), "3d", wedges) is None
    with pytest.raises(sg.InputError, match="has wedge15 cells, which have no mean dilatation; expected 'standard'"):
        sg.Body("block", STEEL, "mean dilatation").check_flow((), "3d", wedges)


LAWS = [
    sg.Plastic(235.0),
    sg.Plastic(ROWS, hardening=1e3),
    sg.Plastic(0.1, backstresses=[(20e3, 100.0), (1e3, 0.0)]),
]


@pytest.mark.parametrize("law", LAWS)
def test_a_law_survives_its_deck_and_its_archive(law, tmp_path: Path):
    given = model(replace(STEEL, plastic=law))
    write_deck(given, tmp_path / "deck.toml")
    assert "formulation" not in (tmp_path / "deck.toml").read_text()
    assert sg.read(tmp_path / "deck.toml").bodies == given.bodies
    assert from_plain(to_plain(given.bodies, "", str), len) == given.bodies


def test_what_differs_from_the_default_is_written(tmp_path: Path):
    given = model(formulation="standard", cells="quad8")
    write_deck(given, tmp_path / "deck.toml")
    assert sg.read(tmp_path / "deck.toml").bodies == given.bodies


def test_archives_from_before_materials_could_yield_are_read():
    written = {"E": 1.0, "nu": 0.3, "density": 0.0, "expansion": 0.0}
    found = from_plain({"$": "class", "name": "Elastic", "of": written}, len)
    assert found == sg.Elastic(E=1.0, nu=0.3)
    for wrong in (written | {"colour": "blue"}, {key: value for key, value in written.items() if key != "E"}):
        with pytest.raises(sg.InputError, match="another version"):
            from_plain({"$": "class", "name": "Elastic", "of": wrong}, len)


DECK = """
[mesh]
generator = "rectangle"
width = 1.0
height = 1.0
nx = 1
ny = 1

[material.steel]
E = 210e3
nu = 0.3

[material.steel.plastic]
yield_stress = [[0.0, 235.0], [0.02, 250.0]]
backstresses = [[20e3, 100.0]]

[[body]]
name = "block"
material = "steel"
"""


@pytest.mark.parametrize(
    ("before", "after", "line", "words"),
    [
        (
            "backstresses",
            "backstress",
            15,
            "material.steel.plastic.backstress: unknown key; did you mean 'backstresses'?",
        ),
        ("[0.02, 250.0]", "[0.02, 200.0]", 14, "material.steel.plastic.yield_stress[1][1]: is 200 after 235"),
        (
            "[20e3, 100.0]",
            "[20e3, -1.0]",
            15,
            "material.steel.plastic.backstresses[0][1]: is -1.0; expected a number >= 0",
        ),
        ("yield_stress", "# yield_stress", 13, "material.steel.plastic: has no 'yield_stress'; expected it"),
        (
            'material = "steel"',
            'material = "steel"\nformulation = "standard"',
            20,
            "body[0].formulation: is 'standard'",
        ),
    ],
)
def test_decks_with_a_wrong_law(before, after, line, words, tmp_path: Path):
    path = tmp_path / "deck.toml"
    path.write_text(DECK)
    law = sg.Plastic([(0.0, 235.0), (0.02, 250.0)], backstresses=[(20e3, 100.0)])
    assert sg.read(path).bodies[0].material.plastic == law
    path.write_text(DECK.replace(before, after, 1))
    with pytest.raises(sg.InputError) as caught:
        sg.read(path)
    assert words in str(caught.value)
    assert f"deck.toml:{line}: " in str(caught.value)
