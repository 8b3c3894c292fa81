# SPDX-License-Identifier: BSD-3-Clause
"""Runs killed (SIGKILL) at random moments: what was finished is readable, and another run goes on from it.

    python -m benchmarks.killed [--number 200] [--seed 0]

A block is pressed on a floor and dragged to and fro in many steps. A third of the kills comes at any moment, a third
while files are written aside, a third while they get their final names. After each kill every file under its final name
must be whole and of this run, and a run of the steps that are left, which goes on from the folder, must end in the same
bytes of ``contact.csv`` as the run that nobody killed.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import meshio

from signorini.cli import main as main_of_runs
from signorini.output.archive import read_archive
from signorini.output.checkpoint import read_checkpoint
from signorini.solution.history import History

STEPS = 24
DECK = """\
[mesh]
generator = "rectangle"
width = 4.0
nx = 40
ny = 10

[material.m]
E = 100.0
nu = 0.3

[[body]]
name = "block"
material = "m"

[[support]]
on = "left"
u = [0.02, "free"]
name = "pull"

[[load]]
on = "top"
pressure = 1.0
name = "press"

[[contact]]
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction = 0.4
"""


def deck(first: int) -> str:
    """The deck from a step on, counted from 0."""
    steps = ["\n[[step]]\nscale = { press = 1.0, pull = 0.0 }\nat = [0.5]\n"]
    steps += [f"\n[[step]]\nscale = {{ pull = {(-1) ** k * (1.0 - k / STEPS):.3f} }}\n" for k in range(1, STEPS)]
    return DECK + "".join(steps[first:])


def start(path: Path, folder: Path, *more: str) -> int:
    """A run in a process of its own, which finds all code loaded; its id."""
    process = os.fork()
    if process == 0:
        os._exit(main_of_runs(["run", str(path), "-o", str(folder), "--quiet", *more]))
    return process


def end(process: int) -> int:
    """Wait for a run; its exit code, of one that was killed the signal, negative."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def wait(folder: Path, kind: int, chance: random.Random, seconds: float) -> None:
    """Until any moment, until one while files are written aside, or one while they get their names."""
    last = time.perf_counter() + 1.2 * seconds
    if kind == 0:
        time.sleep(chance.uniform(0.3, 1.2) * seconds)
        return
    times = chance.choice((1, 2, 2, 3))  # a folder beside the results is seen to come so often
    pattern = ".writing-*" if kind == 1 else ".writing-*/summary.json"
    seen: set[Path] = set()
    while len(seen) < times and time.perf_counter() < last:
        seen |= set(folder.glob(pattern))
        time.sleep(0.0002)
    time.sleep(chance.uniform(0.0, 0.1 if kind == 1 else 0.004))


def last_rows(folder: Path) -> list[list[str]]:
    """The rows of the last step in ``contact.csv``, without its number."""
    with (folder / "contact.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert all(len(row) == len(rows[0]) for row in rows), "a row is not whole"
    return [row[1:] for row in rows[1:] if row[0] == rows[-1][0]]


def examined(folder: Path) -> History | None:
    """What a killed run has left, after every file in its folder was read; None where that is nothing."""
    files = [file for file in folder.rglob("*") if file.is_file() and ".writing-" not in str(file)]
    assert not any(file.name.startswith(".") for file in files), f"left aside: {files}"
    for file in files:
        if file.suffix == ".vtu":
            meshio.read(file)
    if not (folder / "solution.h5").exists():
        assert not (folder / "summary.json").exists(), "a summary of nothing"  # the first files may be there
        return None
    history = read_archive(folder / "solution.h5")
    read_checkpoint(folder / "state.npz")
    last_rows(folder)
    if (folder / "summary.json").exists():
        summary = json.loads((folder / "summary.json").read_text())
        # the archive of the next steps may already be there
        assert len(summary["steps"]) <= len(history.steps), "the summary speaks of steps that are not there"
    return history


def main() -> int:
    """Kill and go on; print what was kept, in steps, and how often."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--number", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    chance, kept = random.Random(options.seed), Counter[str]()
    with tempfile.TemporaryDirectory() as name:
        home = Path(name)
        whole = home / "whole.toml"
        whole.write_text(deck(0))
        main_of_runs(["run", str(whole), "-o", str(home / "first"), "--quiet"])  # loads all code
        began = time.perf_counter()
        assert end(start(whole, home / "whole")) == 0
        seconds = time.perf_counter() - began
        expected = last_rows(home / "whole")
        for k in range(options.number):
            folder = home / f"run{k}"
            process = start(whole, folder)
            wait(folder, k % 3, chance, seconds)
            os.kill(process, signal.SIGKILL)
            end(process)
            history = examined(folder) if folder.exists() else None
            if history is None:
                kept["nothing"] += 1
                continue
            done = len(history.steps)
            kept[f"{done} steps"] += 1
            if done < STEPS:
                assert history.end is not None
                rest, state = home / f"rest{k}.toml", read_checkpoint(folder / "state.npz").state
                rest.write_text(deck(done))
                # a kill between two files leaves the state of one more publication beside the archive
                source = folder if state.work == history.end.state.work else folder / "solution.h5"
                assert end(start(rest, home / f"on{k}", "--from", str(source))) == 0
                assert last_rows(home / f"on{k}") == expected, f"kill {k}: goes on to other numbers"
    print(
        f"{options.number} kills within {seconds:.1f} s, seed {options.seed}: every file whole, every run gone on from"
    )
    for what, count in sorted(kept.items()):
        print(f"{count:5d} times {what} kept")
    return 0


if __name__ == "__main__":
    sys.exit(main())
