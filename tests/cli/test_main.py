# SPDX-License-Identifier: BSD-3-Clause
"""The command line as a user meets it: exit codes, one-line failures, start-up time."""

import json
import os
import subprocess
import sys
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import signorini as sg
from signorini.cli import main
from signorini.verify.rows import ALL

EXAMPLES = Path(__file__).parents[2] / "examples"
CYLINDER = str(EXAMPLES / "zhu_cylinder.toml")


def test_help_answers_within_half_a_second() -> None:
    """Of the processor, so that what else the machine does is not counted."""
    command = [sys.executable, "-m", "signorini", "--help"]
    seconds = []
    for _ in range(5):
        start = os.times()
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        now = os.times()
        seconds.append(now.children_user + now.children_system - start.children_user - start.children_system)
    assert "run" in done.stdout
    assert min(seconds) < 0.5


@pytest.mark.parametrize("arguments", [["--help"], ["run", "nowhere.toml"], ["--version"]])
def test_nothing_heavy_is_imported_before_it_is_needed(arguments: list[str]) -> None:
    code = (
        "import sys; from signorini.cli import main\n"
        "try: main(sys.argv[1:])\nexcept SystemExit: pass\n"
        "print(sorted({'skfem', 'scipy', 'matplotlib', 'numba', 'meshio'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_every_public_name_is_there() -> None:
    assert all(getattr(sg, name) is not None for name in sg.__all__)
    with pytest.raises(AttributeError, match="nothing_of_ours"):
        sg.nothing_of_ours  # noqa: B018


def test_run_prints_forces_and_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("signorini.cli.progress.LINE_PERIOD", 1e6)  # compiling may take longer than one
    assert main(["run", CYLINDER, "-o", str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert "(0, 78)" in said.out
    assert "certificate passed" in said.out
    assert "one increment: assumes" in said.out
    assert (
        f"contact.csv, contact.vtu, solution.vtu, history.csv, state.npz, solution.h5, summary.json in {tmp_path}"
        in said.out
    )
    assert said.err == ""  # no progress where nobody watches


def test_quiet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", CYLINDER, "-o", str(tmp_path), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def test_without_a_folder_results_go_to_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", CYLINDER, "--quiet"]) == 0
    assert (tmp_path / "out" / "zhu_cylinder" / "summary.json").is_file()


def test_unknown_back_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for command in (["run"], ["sweep", "--set", "friction.foundation=0.1"]):
        assert main([*command, CYLINDER, "-o", str(tmp_path), "--backend", "superlou"]) == 2
        words = "--backend: unknown back end 'superlou'; did you mean 'superlu'? Known: auto, iterative, "
        assert words in capsys.readouterr().err


def test_check_says_what_would_be_solved(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(EXAMPLES / "block_drag.toml")]) == 0
    said = capsys.readouterr().out
    assert "650 nodes, 576 elements (576 quads), 1300 dofs" in said
    assert "block.bottom on foundation.top  nodes  friction 0.3  25 pairs  initial gap 0 to 0" in said
    assert "total force (0, -40) at factor 1" in said
    assert "ends at press 0.7, drag 0" in said
    assert "body 'block' can move along y, and rotate about (0, 2): only contact can hold that" in said


def test_check_notes_what_looks_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = Path(CYLINDER).read_text().replace("point = [0.0, 0.0]", "point = [0.0, -1.5]")
    deck = tmp_path / "deck.toml"
    deck.write_text(text + "\n[material.spare]\nE = 1.0\nnu = 0.0\n")
    assert main(["check", str(deck)]) == 0
    said = capsys.readouterr().out
    assert "material 'spare' is not used" in said
    assert "contact 'foundation' is open everywhere at the start, by at least 1.5" in said
    assert main(["check", CYLINDER]) == 0
    assert "not used" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (KeyboardInterrupt(), 130, "signorini: interrupted\n"),
        (
            ZeroDivisionError("by\nzero"),
            1,
            "signorini: internal error: ZeroDivisionError: by zero; please report it (--debug shows where)\n",
        ),
        (MemoryError("an array"), 1, "signorini: out of memory (an array): "),
        (OSError(28, "No space left on device", "a.h5"), 1, "signorini: 'a.h5': No space left on device\n"),
        (sg.SolveFailed("no way", status="jump"), 3, "signorini: no certified solution (jump): no way\n"),
        (sg.InputError("is 1", where=("a",)), 2, "signorini: a: is 1\n"),
    ],
)
def test_every_failure_is_one_line(
    error: BaseException, code: int, said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(_options: object) -> int:
        raise error

    monkeypatch.setattr("signorini.cli.deck_commands.check", fail)
    assert main(["check", CYLINDER]) == code
    told = capsys.readouterr().err
    assert told.startswith(said)
    assert told.count("\n") == 1


def test_debug_shows_where(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("signorini.cli.deck_commands.check", lambda _options: 1 / 0)
    assert main(["check", CYLINDER, "--debug"]) == 1
    assert "Traceback" in capsys.readouterr().err


def test_wrong_options_leave_with_2() -> None:
    for arguments in (["walk"], ["run"], ["plot", "out", "--what", "weather"], []):
        with pytest.raises(SystemExit) as left:
            main(arguments)
        assert left.value.code == 2


CASE = {
    "case": "disk [a]",
    "quantity": "p",
    "computed": 1.0,
    "reference": 1.0,
    "error": 0.0,
    "tolerance": 1e-9,
    "source": "Hertz",
    "passed": True,
}


@pytest.mark.parametrize(("passed", "code"), [([True], 0), ([True, False], 1), ([], 1)])
def test_verify(
    passed: list[bool],
    code: int,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = []

    def run(where: str, begin: Any, processes: int) -> Iterator[dict[str, Any]]:
        assert processes >= 1
        asked.append(where)
        for done, one in enumerate(passed):
            begin("disk", done, len(passed))
            assert capsys.readouterr().out.count("Hertz") == min(done, 1)  # the row before is there already
            yield CASE | {"passed": one}

    monkeypatch.setattr("signorini.verify.rows.shared_rows", run)
    file = tmp_path / "cases.json"
    assert main(["verify", "--all", "--json", str(file)]) == code
    assert asked == [ALL]
    assert [case["passed"] for case in json.loads(file.read_text())] == passed
    said = capsys.readouterr().out
    assert ("NO" in said) == (passed[-1:] == [False])
    assert said.endswith(f", {passed.count(False)} failed\n" if False in passed else " quantities, all passed\n")


def test_bench(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = []

    def run(names: list[str], dofs: int | None, sample: int | None, _begin: Any) -> list[dict[str, Any]]:
        asked.append((names, dofs, sample))
        return [{"name": "cylinder", "dofs": 186, "ratio": 1.25}]

    monkeypatch.setitem(sys.modules, "signorini.bench.suite", types.SimpleNamespace(benchmark_rows=run))
    file = tmp_path / "bench.json"
    assert main(["bench", "cylinder", "--dofs", "200", "--json", str(file)]) == 0
    assert asked == [(["cylinder"], 200, None)]
    assert json.loads(file.read_text())[0]["ratio"] == 1.25
    assert "1.25" in capsys.readouterr().out


def test_a_sample_of_the_hard_set(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("signorini.cli.progress.LINE_PERIOD", 1e6)  # compiling may take longer than one
    file = tmp_path / "bench.json"
    assert main(["bench", "hard", "--sample", "2", "--json", str(file)]) == 0
    said = capsys.readouterr()
    assert "hard, held bodies: steps" in said.out
    assert said.err == ""
    assert {row["problems"] for row in json.loads(file.read_text()) if "problems" in row} == {2}
    assert main(["bench", "hard", "--sample", "0"]) == 2
    assert capsys.readouterr().err == "signorini: --sample: is 0; expected a positive number\n"


def test_a_json_file_that_cannot_be_is_told_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--json", "no/such/folder/a.json"]) == 2
    assert "--json: cannot write 'no/such/folder/a.json'" in capsys.readouterr().err
