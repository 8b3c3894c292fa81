# SPDX-License-Identifier: BSD-3-Clause
"""The first run after an installation: the README's deck with nothing compiled, then again with what that left on disk.

On the wall, and CPU seconds of the run itself: another process compiles beside it, and how long that takes is told too;
then ``signorini verify``, likewise. Modules are compiled to bytecode before, as an installation leaves them. With
``--loops`` what every loop costs that the run itself compiles, alone and with what is compiled for it.

usage: python -m benchmarks.first_solve [--loops]
"""

from __future__ import annotations

import compileall
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import signorini
from benchmarks import command, page

LAST = ("_fronts.factorise_fronts-*.nbi", "_kernels.node_pattern-*.nbi")
"""Files that are there once all loops of the deck are compiled."""
LONGEST = 300.0
"""Seconds after which something hinders the other process."""
DECK = Path(__file__).parent.parent / "examples" / "hertz_two_bodies.toml"
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
RUN = """
import json, resource, sys, time
from numba.core import event

spans, open_spans = [], []

class Listener(event.Listener):
    def on_start(self, event):
        open_spans.append([time.process_time(), 0.0, event.data["dispatcher"]])

    def on_end(self, event):
        start, inner, loop = open_spans.pop()
        taken = time.process_time() - start
        if open_spans:
            open_spans[-1][1] += taken
        spans.append((f"{loop.py_func.__module__}.{loop.py_func.__name__}", taken - inner, taken))

event.register("numba:compile", Listener())
from signorini.cli.main import main
code = main(sys.argv[1:])
own = resource.getrusage(resource.RUSAGE_SELF)
print(json.dumps({"code": code, "cpu": own.ru_utime + own.ru_stime, "loops": spans}))
"""


def run(cache: Path) -> dict[str, Any]:
    """One run of the deck in a process of its own whose compiled loops lie in a folder."""
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run(
            [sys.executable, "-c", RUN, "run", str(DECK), "-o", out, "--quiet"],
            check=True, stdout=subprocess.PIPE, text=True, env={**ENVIRONMENT, "NUMBA_CACHE_DIR": str(cache)},
        )  # fmt: skip
    row: dict[str, Any] = {**json.loads(done.stdout.splitlines()[-1]), "wall": time.perf_counter() - begin}
    if row["code"]:
        raise SystemExit(f"{DECK} ended with {row['code']}")
    return row


def verified(cache: Path) -> float:
    """Seconds on the wall of ``signorini verify``, in which every case passes."""
    begin = time.perf_counter()
    command = [sys.executable, "-m", "signorini", "verify"]
    subprocess.run(command, check=True, capture_output=True, env={**ENVIRONMENT, "NUMBA_CACHE_DIR": str(cache)})
    return time.perf_counter() - begin


def waited(cache: Path) -> float:
    """Seconds until the other process has left all loops in a folder."""
    begin = time.perf_counter()
    while not all(any(cache.rglob(name)) for name in LAST):
        time.sleep(0.1)
        if time.perf_counter() - begin > LONGEST:
            raise SystemExit(f"no loops in {cache} after {LONGEST:g} s")
    return time.perf_counter() - begin


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--loops", action="store_true", help="CPU seconds of every loop that the run itself compiles")
    options = parser.parse_args()
    compileall.compile_dir(Path(signorini.__file__).parent, quiet=2)
    with tempfile.TemporaryDirectory() as folder:
        first = run(Path(folder))
        beside = first["wall"] + waited(Path(folder))
        rows = {"nothing compiled": first, "again": run(Path(folder))}
    with tempfile.TemporaryDirectory() as folder:
        suite = {name: verified(Path(folder)) for name in rows}
    if options.loops:
        for name, alone, taken in sorted(first["loops"], key=lambda span: -span[1]):
            print(f"{alone:8.3f} {taken:8.3f}  {name}")
    head = [
        "run",
        "s on the wall",
        "CPU s of the run",
        "loops compiled by the run",
        "`signorini verify`, s on the wall",
    ]
    cells = [
        [name, page.seconds(row["wall"]), page.seconds(row["cpu"]), len(row["loops"]), page.seconds(suite[name])]
        for name, row in rows.items()
    ]
    words = f"The other process has compiled all {beside:.0f} s after the beginning of the first run."
    load = f"{page.machine()}, load {os.getloadavg()[0]:.1f} after."
    command.publish(options, "first solve", f"{page.table(head, cells)}\n\n{words} {load}")


if __name__ == "__main__":
    main()
