# SPDX-License-Identifier: BSD-3-Clause
"""Names may be any text in one line: every file that holds them gives them back, and none is broken by them."""

import csv
import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from signorini.cli import main
from signorini.output.archive import read_archive
from tests.helpers.block_deck import block_deck

NAME = "=1+1,\"<b>&amp;\\u0041\\t;|$(x)`'%s{0}"


def test_names_are_quoted(tmp_path: Path) -> None:
    deck, out = tmp_path / "deck.toml", tmp_path / "out"
    deck.write_text(block_deck(title=NAME, name=NAME, friction=0.1, steps=({"at": [0.5]},)))
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["title"], summary["steps"][0]["name"]) == (NAME, NAME)
    for file in ("contact.csv", "history.csv"):
        with (out / file).open(newline="") as table:
            assert {row["contact"] for row in csv.DictReader(table)} == {NAME}
    for file in out.glob("*.pvd"):
        listed = [item.get("file", "") for item in ElementTree.parse(file).iter("DataSet")]
        assert listed
        assert all((out / name).resolve().is_relative_to(out.resolve()) for name in listed)
    assert read_archive(out / "solution.h5").model.contacts[0].name == NAME
    for what in ("contact", "history"):
        assert main(["plot", str(out), "--what", what]) == 0
    assert main(["diff", str(out), str(out)]) == 0
    assert main(["convert", str(deck), "-o", str(tmp_path / "again.toml")]) == 0
    assert main(["check", str(tmp_path / "again.toml"), "--quiet"]) == 0


@pytest.mark.parametrize("name", ["a\nb", "\x1b[2J", "a\u202eb", "\u2028"])
@pytest.mark.parametrize("where", ["name", "title"])
def test_names_do_not_command_a_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, where: str
) -> None:
    deck = tmp_path / "deck.toml"
    deck.write_text(block_deck(**{"title": "a", "name": "a"} | {where: name}))
    assert main(["check", str(deck)]) == 2
    said = capsys.readouterr().err
    assert "expected a name without line ends and control characters" in said
    assert name not in said
