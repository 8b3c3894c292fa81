# SPDX-License-Identifier: BSD-3-Clause
"""Damaged decks are read or refused: nothing else happens."""

import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

fuzz = pytest.importorskip("benchmarks.fuzz_decks", reason="the benchmarks are beside the tests in a checkout only")

DECKS = [path.read_text() for path in sorted((Path(__file__).parent / "decks").glob("*.inp"))]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@settings(max_examples=150, deadline=5000)
@given(seed=st.integers(0, 2**32))
def test_damaged_decks(tmp_path_factory: pytest.TempPathFactory, seed: int) -> None:
    deck = tmp_path_factory.getbasetemp() / "damaged.inp"
    deck.write_text(fuzz.damaged(DECKS, random.Random(seed)), errors="surrogateescape")
    assert fuzz.outcome(deck) in ("read", "refused")


def test_sound_decks_are_read(tmp_path: Path) -> None:
    for number, text in enumerate(DECKS):
        deck = tmp_path / f"{number}.inp"
        deck.write_text(text)
        assert fuzz.outcome(deck) == "read"
