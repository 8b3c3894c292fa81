# SPDX-License-Identifier: BSD-3-Clause
"""Small problems, whose price is that of many small steps: whole solves, and a sweep of one that is prepared.

CPU seconds of the paper's cylinder, mu = 0.4, one increment; a solve is all from the model to the certified answer. The
sweep changes the friction from solve to solve. What contact costs over one linear solve at 5600 unknowns is a row of
``python -m benchmarks.ratio``.

usage: python -m benchmarks.small [--solves 1000]
"""

from __future__ import annotations

import itertools
import json
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks import command, page
from signorini.api import solve
from signorini.gallery.cylinder import zhu_cylinder
from signorini.prepared import prepare

SIZES: tuple[dict[str, Any], ...] = ({"refine": 4, "contact_spacing": 4.0 / 7.0}, {"refine": 4}, {"refine": 6})
"""Edges of the paper's mesh divided by, and first where they are: about 2000, 2500 and 5600 unknowns."""
SWEPT = 11  # likewise: about 19,000
REPEATS = 21  # solves whose median is told


def seconds(call: Callable[[], Any], repeats: int) -> list[float]:
    """CPU seconds of calls, after one that loads what they need."""
    call()
    taken = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        taken.append(time.process_time() - begin)
    return taken


def rows(solves: int) -> list[dict[str, Any]]:
    """What is told of every size."""
    found = []
    for size in SIZES:
        model = zhu_cylinder(**size)
        taken = seconds(lambda model=model: solve(model), REPEATS)  # type: ignore[misc]
        found.append({"what": "solve", "dofs": model.number_of_dofs, "seconds": statistics.median(taken)})
    model = zhu_cylinder(refine=SWEPT)
    prepared, frictions = prepare(model), itertools.cycle(np.linspace(0.05, 0.6, solves).tolist())
    taken = seconds(lambda: prepared.solve(friction=next(frictions)), solves)
    found.append({"what": f"solve of {solves}, prepared", "dofs": model.number_of_dofs, "seconds": sum(taken) / solves})
    return found


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--solves", type=int, default=1000, help="of the sweep")
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        print(json.dumps(rows(options.solves)))
        return
    found = page.measured("benchmarks.small", "--solves", options.solves)
    cells = [[row["what"], row["dofs"], f"{row['seconds']:.4f}", f"{1.0 / row['seconds']:.0f}"] for row in found]
    table = page.table(["what", "unknowns", "CPU s", "per CPU second"], cells)
    command.publish(options, "small", f"{table}\n\nCPU seconds, one thread, {page.machine()}.")


if __name__ == "__main__":
    main()
