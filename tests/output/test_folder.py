# SPDX-License-Identifier: BSD-3-Clause
"""A result folder holds one whole run or nothing half-written, whatever happens in between."""

import json
from pathlib import Path

import pytest

import signorini as sg
from signorini.cli import main
from signorini.output import folder as module

BLOCK = """\
[mesh]
generator = "rectangle"
nx = 2

[material.m]
E = 100.0
nu = 0.0

[[body]]
name = "block"
material = "m"

[[support]]
on = "left"
u = [0.0, "free"]

[[load]]
on = "top"
force = [0.0, -3.0]

[[contact]]
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
"""
FILES = {"summary.json", "contact.csv", "history.csv", "state.npz", "solution.vtu", "solution.h5"}
PULL = "\n[[step]]\nscale = { top = 1.0 }\n\n[[step]]\nname = 'pull'\nscale = { top = -1.0 }\n"


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    path = tmp_path / "block.toml"
    path.write_text(BLOCK)
    return path


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


def test_a_body_pulled_away_leaves_its_motion(deck: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert main(["plot", str(out)]) == 0
    assert "contact.png" in names(out)
    deck.write_text(BLOCK.replace("-3.0", "3.0"))
    capsys.readouterr()
    assert main(["run", str(deck), "-o", str(out)]) == 3
    assert names(out) == {"summary.json", "solution.h5"}
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "no_equilibrium"
    assert "body 'block' can move along y" in summary["message"]
    assert summary["steps"] == []
    said = capsys.readouterr().err
    assert said.startswith(f"signorini: {deck}: no certified solution (no_equilibrium): ")
    assert summary["message"] in said


def test_what_was_finished_before_the_failure_stays(deck: Path, tmp_path: Path) -> None:
    deck.write_text(BLOCK + PULL)
    out = tmp_path / "out"
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 3
    assert names(out) == FILES
    summary = json.loads((out / "summary.json").read_text())
    assert len(summary["steps"]) == 1
    assert "'pull'" in summary["message"]
    assert len((out / "contact.csv").read_text().splitlines()) == 1 + 3


def test_a_shorter_series_replaces_a_longer_one_and_nothing_else(deck: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    deck.write_text(BLOCK + PULL.replace("-1.0", "0.5"))
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert {"solution.pvd", "solution_0001.vtu", "solution_0002.vtu"} <= names(out)
    (out / "notes.txt").write_text("mine")
    (out / "solution_best.vtu").write_text("mine too")
    deck.write_text(BLOCK)
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert names(out) == {
        "summary.json",
        "contact.csv",
        "history.csv",
        "state.npz",
        "solution.h5",
        "solution.vtu",
        "notes.txt",
        "solution_best.vtu",
    }


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, OSError("no space left on device")])
def test_an_interrupted_write_leaves_the_earlier_run_whole(
    deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, interruption: BaseException
) -> None:
    out = tmp_path / "out"
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    before = {file.name: file.read_bytes() for file in out.iterdir()}

    def broken(_model: object, _step: object, path: Path) -> None:
        path.write_text("<VTK")
        raise interruption

    monkeypatch.setattr(module, "write_step", broken)
    deck.write_text(BLOCK.replace("-3.0", "-4.0"))
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == (130 if interruption is KeyboardInterrupt else 1)
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before


def test_a_single_file_that_cannot_be_finished_does_not_appear(
    deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import meshio

    solution = sg.solve(sg.read(deck))
    solution.write(tmp_path / "good.vtu")
    monkeypatch.setattr(meshio, "write", lambda path, *_, **__: (path.write_text("<VTK"), 1 / 0))
    for name in ("good.vtu", "new.vtu"):
        with pytest.raises(ZeroDivisionError):
            solution.write(tmp_path / name)
    assert names(tmp_path) == {"block.toml", "good.vtu"}
    assert (tmp_path / "good.vtu").stat().st_size > 500


def test_a_folder_that_cannot_be_is_told_before_the_solve(
    deck: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert main(["run", str(deck), "-o", str(tmp_path / "file")]) == 2
    assert f"cannot write to the folder '{tmp_path / 'file'}'" in capsys.readouterr().err
