# SPDX-License-Identifier: BSD-3-Clause
"""What threads give: seconds on the wall with one and more of them, and what Amdahl's law makes of that for 16.

A large model is prepared and solved with every number of threads in turn; medians of three. The numbers that come out
are the same to the last bit, which is asserted. The part that threads share follows from the two times; on paper more
threads shorten it in proportion, as far as branches of the tree and tiles of fronts go round.

usage: python -m benchmarks.threads [--small]
"""

from __future__ import annotations

import json
import os
import statistics
import time
from typing import Any

import numpy as np

from benchmarks import command, page
from signorini.clock import Clock
from signorini.cores import physical_cores, threads
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.model import Model

REPEATS = 3  # whose median is told
MANY = 16  # threads of the machine on paper


def models(small: bool) -> dict[str, Model]:
    """What is solved: name to model."""
    plane, space = ((24,), 8) if small else ((36, 80), 27)
    found = {f"cylinder / {refine}": zhu_cylinder(refine=refine) for refine in plane}
    return found | {f"two cubes, {space} cells an edge": cubes(space)}


def measure(model: Model) -> dict[int, dict[str, float]]:
    """Medians of seconds on the wall, by number of threads: of the factorisation, and of everything."""
    taken: dict[int, list[dict[str, float]]] = {}
    first = None
    solve_prepared(prepare(model))
    for _ in range(REPEATS):
        for number in (1, max(2, physical_cores())):
            clock, begin = Clock(timer=time.perf_counter), time.perf_counter()
            with threads(number):
                history = solve_prepared(prepare(model, clock=clock))
            whole = time.perf_counter() - begin
            taken.setdefault(number, []).append({"factorisation": clock.seconds["factorisation"], "whole": whole})
            first = history.last.displacement if first is None else first
            assert np.array_equal(first, history.last.displacement)
    return {
        number: {name: statistics.median(run[name] for run in runs) for name in runs[0]}
        for number, runs in taken.items()
    }


def row(name: str, dofs: int, found: dict[int, dict[str, float]]) -> list[object]:
    """Times of one and several threads, their ratio, the part that they share and the ratio on paper for `MANY`."""
    one, many = min(found), max(found)
    cells: list[object] = [name, dofs]
    for what in ("factorisation", "whole"):
        ratio = found[one][what] / found[many][what]
        shared = min(1.0, (1.0 - 1.0 / ratio) / (1.0 - 1.0 / many))
        paper = 1.0 / (1.0 - shared + shared / MANY)
        cells += [*(page.seconds(found[number][what]) for number in (one, many)), f"{ratio:.2f}", f"{paper:.1f}"]
    return cells


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        rows: list[dict[str, Any]] = []
        for name, model in models(options.small).items():
            rows.append({"row": row(name, model.number_of_dofs, measure(model))})
        print(json.dumps(rows))
        return
    load = os.getloadavg()[0]
    found = page.measured("benchmarks.threads", *(["--small"] if options.small else []))
    many = max(2, physical_cores())
    head = ["model", "unknowns"]
    for what in ("factorisation", "all"):
        head += [f"{what} s: 1 thread", f"{many} threads", "ratio", f"{MANY} threads, on paper"]
    note = f"Seconds on the wall, medians of {REPEATS}, {page.machine()}, load {load:.1f} before."
    command.publish(options, "threads", f"{page.table(head, [each['row'] for each in found])}\n\n{note}")


if __name__ == "__main__":
    main()
