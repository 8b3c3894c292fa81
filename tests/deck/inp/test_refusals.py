# SPDX-License-Identifier: BSD-3-Clause
"""A deck is refused once, with everything that is wrong in it as far as one does not follow from another."""

from pathlib import Path

import pytest

from signorini.cli.main import main
from signorini.deck import load_deck
from signorini.deck.error import DeckError
from signorini.deck.inp.refusals import ADVICE, MOST_TOLD, Refusals

BLOCK = """*NODE, NSET=ALL
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*ELEMENT, TYPE=CPE4, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=S
*MATERIAL, NAME=S
*ELASTIC
210000, .3
*STEP
*STATIC
*BOUNDARY
1, 1, 2
*END STEP
"""


def _told(tmp_path: Path, *changes: tuple[str, str]) -> list[str]:
    """What is said of the block with changes: lines, without the name of the file."""
    text = BLOCK
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    deck = tmp_path / "deck.inp"
    deck.write_text(text)
    with pytest.raises(DeckError) as caught:
        load_deck(deck)
    return [line.removeprefix(f"{deck}:") for line in str(caught.value).splitlines()]


def test_unsupported_keywords_are_told_together_with_advice(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each once, in the order of their lines, one to a line, with what to write instead."""
    told = _told(
        tmp_path,
        ("*STEP", "*MPC\nBEAM, 1, 2\n*MPC\nBEAM, 2, 3\n*SHELL SECTION, ELSET=E, MATERIAL=S\n*STEP"),
        ("*STATIC", "*DYNAMIC"),
        ("TYPE=CPE4", "TYPE=CPE5"),
    )
    assert [line.partition(":")[0] for line in told] == ["6", "12", "16", "18"]
    assert "TYPE=CPE5 is not supported" in told[0]
    assert told[1].endswith(f"*MPC: is not supported, and it may change the answer; {ADVICE['MPC']} (line 14 too)")
    assert told[2].endswith(ADVICE["SHELL SECTION"])
    assert told[3].endswith(ADVICE["DYNAMIC"])
    assert main(["check", str(tmp_path / "deck.inp")]) == 2
    assert len(capsys.readouterr().err.splitlines()) == len(told)


def test_values_are_told_together(tmp_path: Path) -> None:
    """Of materials, laws of contact, supports and loads."""
    told = _told(tmp_path, ("210000", "x"), ("*STEP", "*SURFACE INTERACTION, NAME=A\n*FRICTION\n-1\n*STEP"))
    assert [line.partition(":")[0] for line in told] == ["11", "14"]
    told = _told(tmp_path, ("1, 1, 2\n*END", "7, 1, 2\n*CLOAD\nQ, 1, 3.\n*DSLOAD\nU, P, 2.\n*END"))
    assert [line.partition(":")[0] for line in told] == ["15", "17", "19"]


def test_what_follows_from_a_refusal_is_not_told(tmp_path: Path) -> None:
    """A material that is refused has no elasticity, and its section no material: nothing is said of these."""
    assert len(_told(tmp_path, ("*ELASTIC\n210000, .3", "*ELASTIC, TYPE=ANISO\n1, 2"))) == 1
    assert len(_told(tmp_path, ("NAME=S", "NAME=S, SPEED=1"))) == 1


def test_no_more_are_told_than_fit_a_screen() -> None:
    refusals = Refusals()
    for line in range(3 * MOST_TOLD):
        with refusals.gather():
            raise DeckError(f"refusal {line}", path="deck.inp", line=line + 1)
    with pytest.raises(DeckError) as caught:
        refusals.stop()
    told = str(caught.value).splitlines()
    assert len(told) == MOST_TOLD
    assert told[-1].endswith(f"{2 * MOST_TOLD} more behind it are not told")
