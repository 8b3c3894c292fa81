# SPDX-License-Identifier: BSD-3-Clause
"""What a segment followed event by event costs, in sparse factorisations of the same bodies.

    python -m benchmarks.paths [--dry]

Writes the table of docs/exact_paths.md. CPU seconds, one thread, every problem in a process of its own that keeps freed
memory; medians of five runs after one to warm up.
"""

from __future__ import annotations

import json
import os
import time
from typing import Any

import numpy as np

from benchmarks import command, page
from benchmarks.growth import FLOOR, dragged_block
from benchmarks.increments import PAGE
from signorini.clock import Clock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.model import Model
from signorini.model.obstacle import Circle
from signorini.model.step import Step

REPEATS = 5
TO_AND_FRO = [
    Step(name="press", scale={"press": 1.0}, path="exact"),
    Step(name="drag", path="exact"),
    Step(name="back", scale={"drag": -1.0}, path="exact"),
]
PRESSED = [Step(name="press", path="exact"), Step(name="off", scale={"cut": 0.05}, path="exact")]
CYLINDERS = {
    f"cylinder / {refine}, mu {friction:g}": (refine, friction)
    for refine, friction in ((12, 0.4), (36, 0.1), (36, 0.4))
}
BLOCKS = {
    "block on a plane, mu 0.4": FLOOR,
    "block on a circle, mu 0.4": Circle(centre=(1.0, -60.0), radius=60.0),
}


def model(problem: str) -> Model:
    """A cylinder that is pressed and nearly let go; a block that is pressed and dragged there and back."""
    if problem in BLOCKS:
        return dragged_block(200, 200_000, steps=TO_AND_FRO, floor=BLOCKS[problem])
    refine, friction = CYLINDERS[problem]
    return zhu_cylinder(friction=friction, refine=refine, steps=PRESSED)


def measure(model: Model) -> dict[str, Any]:
    """Sizes, seconds of one factorisation and of each segment, and of all behind the factorisation."""
    runs = []
    for _ in range(REPEATS + 1):
        clock = Clock(timer=time.process_time)
        prepared = prepare(model, clock=clock)
        factorisation = clock.seconds["factorisation"]
        began = time.process_time()
        history = solve_prepared(prepared)
        whole = time.process_time() - began
        runs.append((factorisation, clock.seconds["complementarity"], whole))
        segments, pairs = len(history.steps), int(prepared.paths.condensed.active.sum())
        found = {
            "unknowns": model.mesh.points.size,
            "pairs": f"{history.pairs} ({pairs})",
            "events": sum(len({event.load_factor for event in step.events}) for step in history.steps),
            "segments": segments,
        }
        del prepared, history  # the next run finds the memory as this one found it
    factorisation, path, whole = np.median(np.array(runs[1:]), axis=0)
    return {**found, "factorisation": factorisation, "segment": path / segments, "whole": whole / segments}


def row(problem: str, found: dict[str, Any]) -> list[object]:
    """A line of the table."""
    times = [found[name] for name in ("factorisation", "segment")]
    ratios = [found[name] / found["factorisation"] for name in ("segment", "whole")]
    return [
        problem,
        *(found[name] for name in ("unknowns", "pairs", "segments", "events")),
        *map(page.seconds, times),
        *(f"{ratio:.2f}" for ratio in ratios),
    ]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--one", help="measure one problem in this process")
    options = parser.parse_args()
    if options.one:
        print(json.dumps([measure(model(options.one))]))
        return
    load = os.getloadavg()[0]
    rows = [row(each, *page.measured("benchmarks.paths", each)) for each in (*CYLINDERS, *BLOCKS)]
    head = ("problem", "unknowns", "pairs (candidates)", "segments", "loads with events", "one factorisation, s")
    text = page.table((*head, "a segment, s", "ratio", "ratio with displacements, energy, certificate"), rows)
    text += (
        "\n\nThe cylinder is pressed and nearly let go, the block pressed, dragged and dragged back. "
        f"{page.machine()}, one thread, load average {load:.1f} before."
    )
    command.publish(options, "cost of a path", text, PAGE)


if __name__ == "__main__":
    main()
