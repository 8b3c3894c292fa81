# SPDX-License-Identifier: BSD-3-Clause
"""A run whose first step has no equilibrium leaves what its picture needs."""

from pathlib import Path

import pytest

from signorini.cli import main
from tests.helpers.lifted_block import DECK


def test_the_motion_of_a_body_that_is_lifted_is_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck, out = tmp_path / "lift.toml", tmp_path / "out"
    deck.write_text(DECK)
    assert main(["run", str(deck), "-o", str(out)]) == 3
    assert f"signorini plot {out} --what escape" in capsys.readouterr().out
    assert {file.name for file in out.iterdir()} == {"summary.json", "solution.h5"}
    assert main(["plot", str(out), "--what", "escape"]) == 0
    assert (out / "escape.png").stat().st_size > 5000


def test_where_nothing_runs_away_there_is_nothing_to_draw(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck, out = tmp_path / "press.toml", tmp_path / "out"
    deck.write_text(DECK.replace("[0.0, 1.0]}]\ncontact", "[0.0, -1.0]}]\ncontact"))
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert main(["plot", str(out), "--what", "escape"]) == 2
    assert "no body runs away in this history" in capsys.readouterr().err
