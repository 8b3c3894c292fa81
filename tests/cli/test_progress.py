# SPDX-License-Identifier: BSD-3-Clause
"""What a terminal shows while something is solved."""

import re
import sys
from pathlib import Path

import pytest

import signorini as sg
from signorini.api import tell_first_solve
from signorini.cli.main import main
from signorini.deck import load_deck
from signorini.engine.first_run import FIRST_SOLVE, compiled

DECK = Path(__file__).parents[2] / "examples" / "zhu_cylinder_frictionless.toml"


@pytest.mark.parametrize("known", [True, False])
def test_the_first_solve_says_once_that_it_compiles(known, monkeypatch, capsys, tmp_path):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.setattr("signorini.cli.run_deck.compiles_first", lambda _: not known)
    assert main(["run", str(DECK), "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().err.count("compiling takes half a minute, once") == (not known)


@pytest.mark.parametrize("door", [sg.solve, sg.prepare])
@pytest.mark.parametrize(
    ("known", "terminal", "notebook", "worker", "lines"),
    [
        (False, True, False, False, 1),
        (False, False, True, False, 1),
        (False, False, False, False, 0),
        (False, True, False, True, 0),
        (True, True, True, False, 0),
    ],
)
def test_python_says_it_where_somebody_reads_it(door, known, terminal, notebook, worker, lines, monkeypatch, capsys):
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal, raising=False)
    monkeypatch.setattr("signorini.api.compiled", lambda: known)
    monkeypatch.setattr("signorini.api.parent_process", lambda: "main" if worker else None)
    if notebook:
        monkeypatch.setitem(sys.modules, "ipykernel", sys)
    tell_first_solve.cache_clear()
    model = load_deck(DECK).model
    try:
        for _ in range(2):
            door(model)
    finally:
        tell_first_solve.cache_clear()
    assert capsys.readouterr().err == f"{FIRST_SOLVE}\n" * lines


def test_a_solution_leaves_compiled_loops_behind():
    sg.solve(load_deck(DECK).model)
    assert compiled()


def test_a_pipe_is_told_every_few_seconds_what_is_done(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr("signorini.cli.progress.LINE_PERIOD", 0.001)
    assert main(["run", str(DECK), "-o", str(tmp_path / "out")]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) > 3
    assert all(re.fullmatch(r"signorini: \d+ s, +\d+%: .+", line) for line in lines)
    assert main(["run", str(DECK), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    assert capsys.readouterr().err == ""


def test_a_log_says_what_was_done_and_how_it_ended(capsys, tmp_path):
    log = tmp_path / "run.log"
    assert main(["run", str(DECK), "-o", str(tmp_path / "out"), "--quiet", "--log", str(log)]) == 0
    first, *lines = log.read_text().splitlines()
    assert first.endswith(f"run {DECK}")
    assert all(re.match(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d +[\d.]+ s  ", line) for line in lines)
    kinds = [line.split("%  ")[1] for line in lines]
    assert kinds.index("read") < kinds.index("assembly") < kinds.index("factorisation") < kinds.index("output")
    assert kinds[-1] == "solved"
    (tmp_path / "wrong.toml").write_text("kind = 3\n")
    assert main(["run", str(tmp_path / "wrong.toml"), "--quiet", "--log", str(log)]) == 2
    assert "there is no mesh" in log.read_text()
    capsys.readouterr()
    assert main(["run", str(DECK), "--log", str(tmp_path / "no" / "run.log")]) == 2
    assert "--log: cannot write" in capsys.readouterr().err
