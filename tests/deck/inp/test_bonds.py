# SPDX-License-Identifier: BSD-3-Clause
"""Bonds of surface interactions, as Abaqus writes them."""

from pathlib import Path

import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck

TWO_BLOCKS = (Path(__file__).parent / "decks" / "two_blocks.inp").read_text()
FRICTION = "*FRICTION\n0.3\n"
assert FRICTION in TWO_BLOCKS
STRENGTH = "*DAMAGE INITIATION, CRITERION=MAXS\n5., 3., 3.\n"


def deck(folder: Path, bond: str) -> Path:
    path = folder / "deck.inp"
    path.write_text(TWO_BLOCKS.replace(FRICTION, FRICTION + bond))
    return path


@pytest.mark.parametrize(
    ("bond", "cohesion", "compliances"),
    [
        (
            f"*COHESIVE BEHAVIOR\n{STRENGTH}*DAMAGE EVOLUTION, TYPE=ENERGY\n0.05\n",
            sg.Cohesion(5.0, opening=0.02, shear_strength=3.0),
            (0.0, 0.0),
        ),
        (
            f"*COHESIVE BEHAVIOR, ELIGIBILITY=ORIGINAL CONTACTS\n1.E3, 5.E2, 5.E2\n{STRENGTH}"
            "*DAMAGE EVOLUTION, TYPE=DISPLACEMENT, SOFTENING=LINEAR\n0.01\n",
            sg.Cohesion(5.0, opening=0.015, shear_strength=3.0),
            (1e-3, 2e-3),
        ),
        (
            f"*COHESIVE BEHAVIOR\n1.E3\n{STRENGTH}*DAMAGE EVOLUTION, TYPE=DISPLACEMENT\n0.\n",
            sg.Cohesion(5.0, shear_strength=3.0),
            (1e-3, 1e-3),
        ),
    ],
)
def test_a_bond_is_read(tmp_path, bond, cohesion, compliances):
    found = load_deck(deck(tmp_path, bond))
    (contact,) = found.model.contacts
    assert contact.cohesion == cohesion
    assert (contact.normal_compliance, contact.tangential_compliance) == compliances
    assert contact.friction == 0.3
    assert any("are bonded and open by tension alone" in note for note in found.notes)


@pytest.mark.parametrize(
    ("bond", "told"),
    [
        ("*COHESIVE BEHAVIOR\n", "COHESIVE BEHAVIOR: has no \\*DAMAGE INITIATION, and never breaks"),
        (f"*COHESIVE BEHAVIOR\n{STRENGTH}", "has no \\*DAMAGE EVOLUTION, and never breaks"),
        (STRENGTH, "DAMAGE INITIATION: stands before any \\*COHESIVE BEHAVIOR"),
        ("*COHESIVE BEHAVIOR\n1., 2., 3.\n", "has 2 and 3 along the sides; expected the same in both directions"),
        (
            "*COHESIVE BEHAVIOR\n-1.\n",
            "has -1 in field 1; expected the stiffness, traction per separation, a number > 0",
        ),
        ("*COHESIVE BEHAVIOR, TYPE=COUPLED\n", "TYPE: unknown value 'COUPLED'"),
        ("*COHESIVE BEHAVIOR\n*DAMAGE INITIATION, CRITERION=QUADS\n5.\n", "CRITERION: unknown value 'QUADS'"),
        (
            f"*COHESIVE BEHAVIOR\n{STRENGTH}*DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE BEHAVIOR=BK\n1., 2.\n",
            "MIXED MODE BEHAVIOR: unknown value 'BK'",
        ),
        (
            f"*COHESIVE BEHAVIOR\n{STRENGTH}*DAMAGE EVOLUTION, TYPE=ENERGY\n0.\n",
            "has 0 in field 1; expected a number > 0",
        ),
        (
            f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E4\n*COHESIVE BEHAVIOR\n{STRENGTH}"
            "*DAMAGE EVOLUTION, TYPE=ENERGY\n0.1\n",
            "stands beside another stiffness",
        ),
    ],
)
def test_a_bond_that_is_none(tmp_path, bond, told):
    with pytest.raises(DeckError, match=told):
        load_deck(deck(tmp_path, bond))


def test_damage_of_a_material_is_refused_as_before(tmp_path):
    path = tmp_path / "deck.inp"
    path.write_text(TWO_BLOCKS.replace("*ELASTIC", f"{STRENGTH}*ELASTIC", 1))
    with pytest.raises(DeckError, match=r"\*DAMAGE INITIATION: is not supported, and it may change the answer"):
        load_deck(path)
