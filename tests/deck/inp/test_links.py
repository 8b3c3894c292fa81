# SPDX-License-Identifier: BSD-3-Clause
"""``*EQUATION`` and ``*RIGID BODY``."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from signorini.deck.write import write_deck
from tests.helpers.two_cells import two_cells

BLOCK = two_cells("99,1.,2.", "100,5,5")
LOADS = "*CLOAD\n99,2,-1.\n99,1,0.3\n"


def deck(folder: Path, before: str, inside: str) -> Path:
    path = folder / "deck.inp"
    path.write_text(f"{BLOCK}{before}*STEP\n*STATIC\n{inside}*END STEP\n")
    return path


def test_a_rigid_body_is_calculix(tmp_path: Path) -> None:
    """CalculiX 2.20 prints these displacements of this deck (CPE4 are integrated like ours)."""
    path = deck(tmp_path, "*RIGIDBODY,NSET=TOP,REF NODE=99,ROT NODE=100\n", LOADS + "100,3,0.5\n")
    step = sg.solve(sg.read(path)).last
    printed = [[3.64e-3, -4.234286e-3], [3.64e-3, -3.714286e-3], [3.64e-3, -3.194286e-3], [3.12e-3, -3.714286e-3]]
    np.testing.assert_allclose(step.displacement[3:7], printed, atol=1e-9)
    assert step.rigid_bodies["rigid TOP"].rotation == pytest.approx(5.2e-4, abs=1e-10)
    # no directions at all; rotations out of the plane, none of them; a node has no third
    for node, direction in ((99, 0), (99, -1), (99, 7), (99, 12), (99, 4), (100, 1), (4, 3)):
        path = deck(tmp_path, "*RIGIDBODY,NSET=TOP,REF NODE=99,ROT NODE=100\n", f"*CLOAD\n{node},{direction},1.\n")
        with pytest.raises(DeckError, match=rf"\*CLOAD: direction {direction}; expected 1 to 2"):
            load_deck(path)


def test_a_reference_node_is_held_and_moved(tmp_path: Path) -> None:
    """Directions 4 to 6 of the reference node are the body's rotations; ENCASTRE holds them too."""
    body = "*RIGID BODY, ELSET=E, REF NODE=99\n"
    with pytest.raises(DeckError, match=r"deck.inp:\d+: \*RIGID BODY.*"):
        load_deck(deck(tmp_path, "*RIGID BODY, ELSET=E, REF NODE=TOP\n", ""))
    turned = sg.solve(
        sg.read(deck(tmp_path, "*RIGID BODY, TIE NSET=TOP, REF NODE=99\n", "*BOUNDARY\n99,1,5\n99,6,6,0.001\n"))
    ).last
    top = turned.displacement[3:6]
    np.testing.assert_allclose(top, 0.001 * np.array([[1.0, -1.0], [1.0, 0.0], [1.0, 1.0]]), atol=1e-15)
    moments = turned.reactions["rigid TOP rotation"]
    np.testing.assert_allclose(moments[2] * 0.001 / 2, turned.strain_energy)
    model = load_deck(deck(tmp_path, body, "*BOUNDARY\n99, ENCASTRE\n")).model
    assert {support.u for support in model.supports if support.on == "rigid E"} == {
        (0.0, None, None),
        (None, 0.0, None),
        (None, None, 0.0),
    }


def test_equations_tie_nodes_and_sets(tmp_path: Path) -> None:
    """The upper nodes hang on a node of their own: a load on it is spread so that they move alike."""
    pairs = "*EQUATION\n2\nTOP,1,1.,99,1,-1.\n2\nTOP,2,2.,99,2,-2.\n"
    model = sg.read(deck(tmp_path, pairs, LOADS))
    assert len(model.equations) == 6
    step = sg.solve(model).last
    assert np.ptp(step.displacement[3:7], axis=0).max() < 1e-15
    np.testing.assert_allclose(step.reactions["BOT"], [-0.3, 1.0])
    write_deck(model, tmp_path / "out.toml")
    again = sg.read(tmp_path / "out.toml")
    assert again.equations == model.equations
    np.testing.assert_array_equal(sg.solve(again).last.displacement, step.displacement)


@pytest.mark.parametrize(
    ("before", "words"),
    [
        ("*EQUATION\n2\n4,1,1.\n", r"deck.inp:24: \*EQUATION: has 1 terms; expected 2"),
        ("*EQUATION\n0\n", "has 0 terms"),
        ("*EQUATION\n1\n4,3,1.\n", r"deck.inp:25: \*EQUATION: direction 3; expected 1 to 2"),
        ("*EQUATION\n1\n4,1,0.\n", "has the coefficient 0"),
        ("*EQUATION\n2\nTOP,1,1.,BOT,1\n", "has 5 fields; expected a coefficient"),
        ("*NSET,NSET=TWO\n1,2\n*EQUATION\n2\nTOP,1,1.,TWO,1,-1.\n", "one set has 2 nodes, another 3"),
        ("*EQUATION\n2\n4,1,1.,77,1,1.\n", "there is no node 77"),
        ("*RIGID BODY, REF NODE=99\n", "names no nodes"),
        ("*RIGID BODY, NSET=TOP\n", "has no REF NODE"),
        ("*RIGID BODY, NSET=TOP, REF NODE=99\n*RIGID BODY, NSET=BOT, REF NODE=99\n", "has a node in common"),
        ("*RIGID BODY, NSET=TOP, REF NODE=99, POSITION=CENTER OF MASS\n", "POSITION"),
    ],
)
def test_mistakes_are_told_with_their_line(tmp_path: Path, before: str, words: str) -> None:
    with pytest.raises(DeckError, match=words):
        load_deck(deck(tmp_path, before, LOADS))


def test_a_contradiction_is_told_with_the_line_of_its_equation(tmp_path: Path) -> None:
    moved = "*BOUNDARY\nTOP,2,2,-0.1\n"
    found = load_deck(deck(tmp_path, "*EQUATION\n2\n4,2,1.,1,2,1.\n2\n5,1,1.,6,1,-1.\n", moved))
    with pytest.raises(sg.InputError) as caught:
        sg.solve(found.model)
    assert str(found.locate(caught.value)).startswith(f"{tmp_path}/deck.inp:24: *EQUATION: contradicts the supports")
