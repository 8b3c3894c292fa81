# SPDX-License-Identifier: BSD-3-Clause
"""The first run after an installation: the README's deck with nothing compiled, then again with what that left on disk.

On the wall, and CPU seconds of the run itself and of the process that compiles beside it: on two quiet cores the wall
is about the run's own CPU. With ``--loops`` what every compiled loop costs, by itself and with what is compiled for it.

usage: python -m benchmarks.first_solve [--loops]
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from benchmarks import command, page

DECK = Path(__file__).parent.parent / "examples" / "hertz_two_bodies.toml"
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
own, beside = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
cpu = [used.ru_utime + used.ru_stime for used in (own, beside)]
print(json.dumps({"code": code, "cpu": cpu, "loops": spans}))
"""


def run(cache: Path) -> dict[str, Any]:
    """One run of the deck in a process of its own whose compiled loops lie in a folder."""
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run(
            [sys.executable, "-c", RUN, "run", str(DECK), "-o", out, "--quiet"],
            check=True, stdout=subprocess.PIPE, text=True, env={**os.environ, "NUMBA_CACHE_DIR": str(cache)},
        )  # fmt: skip
    row: dict[str, Any] = {**json.loads(done.stdout.splitlines()[-1]), "wall": time.perf_counter() - begin}
    if row["code"]:
        raise SystemExit(f"{DECK} ended with {row['code']}")
    return row


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--loops", action="store_true", help="CPU seconds of every loop that the run itself compiles")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = {"nothing compiled": run(Path(folder)), "again": run(Path(folder))}
    if options.loops:
        for name, alone, taken in sorted(rows["nothing compiled"]["loops"], key=lambda span: -span[1]):
            print(f"{alone:8.3f} {taken:8.3f}  {name}")
    head = ["run", "s on the wall", "CPU s of the run", "CPU s beside it", "loops compiled by the run"]
    cells = [[name, *map(page.seconds, (row["wall"], *row["cpu"])), len(row["loops"])] for name, row in rows.items()]
    load = f"{page.machine()}, load {os.getloadavg()[0]:.1f} after."
    command.publish(options, "first solve", f"{page.table(head, cells)}\n\n{load}")


if __name__ == "__main__":
    main()
