# SPDX-License-Identifier: BSD-3-Clause
"""What a segment followed event by event costs, in sparse factorisations of the same bodies.

    python -m benchmarks.paths [--dry]

Writes the table of docs/exact_paths.md. CPU seconds, one thread; medians of three runs after one to warm up.
"""

from __future__ import annotations

import argparse
import os
import time

import numpy as np

from benchmarks import page
from benchmarks.increments import PAGE
from benchmarks.peers.run_signorini import CpuClock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.model import Model
from signorini.model.step import Step

REPEATS = 3


def models() -> list[tuple[str, Model]]:
    """About 2e5 unknowns and 200 pairs, and a smaller one."""
    steps = [Step(name="press", path="exact"), Step(name="off", scale={"cut": 0.05}, path="exact")]
    return [
        (f"cylinder / {refine}, mu {friction:g}", zhu_cylinder(friction=friction, refine=refine, steps=steps))
        for refine, friction in ((12, 0.4), (36, 0.1), (36, 0.4))
    ]


def measure(model: Model) -> list[str]:
    """Sizes, seconds of one factorisation and of each segment, and their ratios."""
    runs = []
    for _ in range(REPEATS + 1):
        clock = CpuClock()
        prepared = prepare(model, clock=clock)
        factorisation = clock.seconds["factorisation"]
        began = time.process_time()
        history = solve_prepared(prepared)
        whole = time.process_time() - began
        runs.append((factorisation, clock.seconds["complementarity"], whole))
    factorisation, path, whole = np.median(np.array(runs[1:]), axis=0)
    events = sum(len({event.load_factor for event in step.events}) for step in history.steps)
    segments = len(history.steps)
    pairs = int(prepared.condensed.active.sum())
    return [
        str(model.mesh.points.size),
        f"{history.pairs} ({pairs})",
        str(events),
        page.seconds(factorisation),
        page.seconds(path / segments),
        f"{path / segments / factorisation:.2f}",
        f"{whole / segments / factorisation:.2f}",
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dry", action="store_true", help="print, but leave the page as it is")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    rows = [[words, *measure(model)] for words, model in models()]
    head = ("problem", "unknowns", "pairs (candidates)", "loads with events", "one factorisation, s", "a segment, s")
    text = page.table((*head, "ratio", "ratio with displacements, energy, certificate"), rows)
    text += f"\n\nTwo segments: press and nearly let go. {page.machine()}, one thread, load average {load:.1f} before."
    print(text)
    if not options.dry:
        page.write("cost of a path", text, PAGE)


if __name__ == "__main__":
    main()
