# SPDX-License-Identifier: BSD-3-Clause
"""A result folder holds one whole run or nothing half-written, whatever happens in between."""

import errno
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import meshio
import pytest

import signorini as sg
from signorini.cli import main
from signorini.gallery.cylinder import zhu_cylinder
from signorini.output import folder as module
from signorini.output import vtu
from tests.helpers.block_deck import block_deck

FILES = {"summary.json", "contact.csv", "history.csv", "state.npz", "solution.vtu", "contact.vtu", "solution.h5"}
UNLOADED = block_deck(steps=({"scale": {"top": 1.0}}, {"scale": {"top": 0.5}}))


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    path = tmp_path / "block.toml"
    path.write_text(block_deck())
    return path


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


def test_a_body_pulled_away_leaves_its_motion(deck: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert main(["plot", str(out)]) == 0
    assert "contact.png" in names(out)
    deck.write_text(block_deck({"force": [0.0, 3.0]}))
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
    deck.write_text(block_deck(steps=({"scale": {"top": 1.0}}, {"name": "pull", "scale": {"top": -1.0}})))
    out = tmp_path / "out"
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 3
    assert names(out) == FILES
    summary = json.loads((out / "summary.json").read_text())
    assert len(summary["steps"]) == 1
    assert "'pull'" in summary["message"]
    assert len((out / "contact.csv").read_text().splitlines()) == 1 + 3


def test_a_shorter_series_replaces_a_longer_one_and_nothing_else(deck: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    deck.write_text(UNLOADED)
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert {"solution.pvd", "solution_0001.vtu", "solution_0002.vtu"} <= names(out)
    (out / "notes.txt").write_text("mine")
    (out / "solution_best.vtu").write_text("mine too")
    deck.write_text(block_deck())
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    assert names(out) == {
        "summary.json",
        "contact.csv",
        "history.csv",
        "state.npz",
        "solution.h5",
        "solution.vtu",
        "contact.vtu",
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

    def broken(_fields: object, path: Path, **_: object) -> None:
        path.write_text("<VTK")
        raise interruption

    monkeypatch.setattr(module, "write_bodies", broken)
    deck.write_text(block_deck({"force": [0.0, -4.0]}))
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == (130 if interruption is KeyboardInterrupt else 1)
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before


def test_a_full_disk_is_told_and_the_run_goes_on(
    deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out, write = tmp_path / "out", module.write_contacts
    room = iter([False, True])

    def full(history: object, path: Path) -> None:
        if not next(room, True):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write(history, path)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "write_contacts", full)
    deck.write_text(UNLOADED)
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    full_disk = f"cannot write results into '{out}': No space left on device; what it held before is still there"
    assert capsys.readouterr().err == f"signorini: {full_disk}; the run goes on\n"
    before = {file.name: file.read_bytes() for file in out.rglob("*.*")}
    room = iter([False, False])
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 1
    said = capsys.readouterr().err
    assert said == f"signorini: {full_disk}; the run goes on\nsignorini: {full_disk}\n"
    assert {file.name: file.read_bytes() for file in out.rglob("*.*")} == before


def test_a_folder_is_for_one_run_of_one_deck(deck: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, other = tmp_path / "out", tmp_path / "other.toml"
    other.write_text(block_deck())
    with module.own_folder(out, deck.name):
        assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 2
    assert capsys.readouterr().err.startswith(f"signorini: another run writes into the folder '{out}'; expected")
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    before = {file.name: file.read_bytes() for file in out.iterdir()}
    assert main(["run", str(other), "-o", str(out), "--quiet", "--from", str(out)]) == 2
    words = f"the folder '{out}' holds the results of another deck, 'block.toml'; expected a folder of its own (-o)"
    assert capsys.readouterr().err == f"signorini: {words}\n"
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before


def test_what_is_finished_is_on_disk_while_later_steps_run(
    deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each time a whole result folder, from which the steps that are left go on to the same end."""
    steps = [{"scale": {"top": factor}} for factor in (1.0, 0.5, 0.8, 0.2)]
    deck.write_text(block_deck(steps=steps))
    out, publish = tmp_path / "out", module.Publisher.publish
    monkeypatch.setattr(module, "_MAX_KEEP_SHARE", 1e9)  # of the time: every step

    def copied(self: module.Publisher, history: sg.Solution) -> list[Path]:
        files = publish(self, history)
        shutil.copytree(out, tmp_path / f"after{len(history.steps)}")
        return files

    monkeypatch.setattr(module.Publisher, "publish", copied)
    assert main(["run", str(deck), "-o", str(out), "--quiet"]) == 0
    monkeypatch.undo()
    end = sg.load(out)
    for number in (1, 2, 3):
        folder = tmp_path / f"after{number}"
        assert json.loads((folder / "summary.json").read_text())["status"] == "running"
        assert names(folder) - names(out) == set()
        (tmp_path / "rest.toml").write_text(block_deck(steps=steps[number:]))
        for start in (folder, folder / "solution.h5"):
            rest = tmp_path / f"rest{number}"
            assert main(["run", str(tmp_path / "rest.toml"), "-o", str(rest), "--quiet", "--from", str(start)]) == 0
            found = sg.load(rest)
            assert (found.last.displacement == end.last.displacement).all()
            assert (found.contact("bottom").pressure == end.contact("bottom").pressure).all()


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_runs_that_are_killed_leave_whole_files_and_can_be_gone_on_from() -> None:
    command = [sys.executable, "-m", "benchmarks.killed", "--number", "2", "--seed", "3"]
    found = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    assert "every file whole, every run gone on from" in found.stdout


def test_a_single_file_that_cannot_be_finished_does_not_appear(
    deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solution = sg.solve(sg.read(deck))
    solution.write(tmp_path / "good.vtu")
    monkeypatch.setattr(vtu, "_write_arrays", lambda *_: 1 / 0)
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


def test_compressed_files_are_smaller_and_say_the_same(tmp_path: Path) -> None:
    solution = sg.solve(zhu_cylinder(refine=12))
    solution.save_results(tmp_path / "plain")
    solution.save_results(tmp_path / "small", compress=True)
    for name in ("solution.vtu", "solution.h5", "state.npz"):
        assert (tmp_path / "small" / name).stat().st_size < 0.8 * (tmp_path / "plain" / name).stat().st_size
    plain, small = (meshio.read(tmp_path / which / "solution.vtu") for which in ("plain", "small"))
    assert all((small.point_data[name] == values).all() for name, values in plain.point_data.items())
    again = sg.load(tmp_path / "small" / "solution.h5")
    assert (again.last.displacement == solution.last.displacement).all()
