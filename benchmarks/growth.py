# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory against unknowns and against contact pairs; a large run from the deck to the files.

    python -m benchmarks.growth [unknowns] [pairs] [large] [--small] [--dry]

Writes the tables of docs/performance.md. CPU seconds, one thread, code warm, every run in a process of its own; the
large run is the command line's, with its own choice of threads and seconds on the wall.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import command, page
from signorini.clock import Clock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Circle, Plane
from signorini.model.step import Step

PHASES = ("assembly", "factorisation", "condensation", "complementarity", "recovery")
REPEATS, LONG = 3, 20.0
DECK = """title = "A million unknowns"
kind = "plane strain"

[mesh]
generator = "quarter_disk"
radius = 8.0
contact_length = 4.0
contact_spacing = 0.25
refine = {refine}

[material.soft]
E = 200.0
nu = 0.3

[[body]]
name = "disk"
material = "soft"

[[support]]
on = "axis"
u = [0.0, "free"]

[[load]]
on = "cut"
force = [0.0, -78.0]

[[contact]]
name = "foundation"
nonmortar = "arc"
plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}
friction = 0.4
"""


FLOOR = Plane(point=(0.0, 0.0), normal=(0.0, 1.0))


def dragged_block(
    pairs: int, unknowns: int, *, steps: Sequence[Step] | None = None, floor: Plane | Circle = FLOOR
) -> Model:
    """A block 2 x 1, all pairs of its base candidates, pressed and dragged by its top: some stick, some slip."""
    rows = max(1, round(unknowns / (2 * pairs)) - 1)
    return Model(
        rectangle(width=2.0, height=1.0, nx=pairs - 1, ny=rows),
        bodies=[Body("block", Elastic(E=1.0, nu=0.3))],
        supports=[Support("top", u=(None, -1e-2), name="press"), Support("top", u=(1.2e-2, None), name="drag")],
        contacts=[Contact("bottom", floor, friction=0.4)],
        steps=steps or [Step()],
    )


def measure(model: Model) -> dict[str, Any]:
    """Medians of CPU seconds by phase, the whole, peak memory and what the process held before."""
    solve_prepared(prepare(zhu_cylinder(refine=2)))
    before = page.peak_memory()
    runs: list[dict[str, float]] = []
    history = None
    while len(runs) < REPEATS and sum(run["whole"] for run in runs) < LONG:
        history = None  # the next repeat finds the memory as this one found it
        clock, began = Clock(timer=time.process_time), time.process_time()
        history = solve_prepared(prepare(model, clock=clock))
        runs.append({**clock.seconds, "whole": time.process_time() - began})
    assert history is not None
    contact = history.last.contacts[0]
    return {
        "unknowns": 2 * len(model.mesh.points),
        "pairs": history.pairs,
        "states": [contact.count(state) for state in ("open", "stick", "slip")],
        "iterations": sum(history.last.iterations),
        "memory": page.peak_memory(),
        "before": before,
        **{name: float(np.median([run[name] for run in runs])) for name in runs[0]},
    }


def in_process(which: str, *sizes: int) -> dict[str, Any]:
    """Measure in a process of its own, on one thread."""
    (found,) = page.measured("benchmarks.growth", which, *sizes, keep=False)
    print(f"{found['unknowns']} unknowns, {found['pairs']} pairs: {found['whole']:.2f} s", flush=True)
    return found


def unknowns(small: bool) -> str:
    """The cylinder, mu = 0.4, from 5e3 to 1e6 unknowns."""
    found = [in_process("cylinder", refine) for refine in ((3, 4, 6) if small else (6, 12, 18, 36, 57, 81))]
    large = [each for each in found if each["unknowns"] > 2e4] or found
    sizes = [each["unknowns"] for each in large]
    fits = {
        "whole": command.exponent(sizes, [each["whole"] for each in large]),
        **{name: command.exponent(sizes, [each[name] for each in large]) for name in PHASES},
        "memory": command.exponent(sizes, [each["memory"] - each["before"] for each in large]),
    }
    rows = [_row([each["unknowns"], each["pairs"]], each) for each in found]
    rows.append(["exponent from 2e4 on", "", *(f"{fits[name]:.2f}" for name in ("whole", *PHASES, "memory")), ""])
    head = ("unknowns", "contact pairs", "all s", *(f"{name} s" for name in PHASES), "memory GB", "iterations")
    return page.table(head, rows) + f"\n\nThe exponent of memory is that of what the solve adds. {_machine()}"


def pairs(small: bool) -> str:
    """A block with 2e5 unknowns and from 100 to 1600 pairs, all of them candidates."""
    many, size = ((50, 100, 200), 5_000) if small else ((100, 200, 400, 800, 1600), 200_000)
    found = [in_process("block", each, size) for each in many]
    counts = [each["pairs"] for each in found]
    names = ("whole", *PHASES)
    fits = [command.exponent(counts, [each[name] for each in found]) for name in names]
    rows = [_row([each["pairs"], *each["states"]], each) for each in found]
    rows.append(["exponent", "", "", "", *(f"{fit:.2f}" for fit in fits), "", ""])
    head = ("contact pairs", "open", "stick", "slip", "all s", *(f"{name} s" for name in PHASES), "memory GB")
    return page.table((*head, "iterations"), rows) + f"\n\nAbout {size} unknowns, mu = 0.4. {_machine()}"


def large(small: bool) -> str:
    """From the deck to the files by the command line, on all cores."""
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        deck, out = Path(folder) / "deck.toml", Path(folder) / "out"
        deck.write_text(DECK.format(refine=2 if small else 54))
        command = [sys.executable, "-m", "signorini", "run", str(deck), "-o", str(out), "--quiet"]
        walls: list[float] = []
        while len(walls) < REPEATS and sum(walls) < 2 * LONG:
            began = time.perf_counter()
            subprocess.run(command, check=True)
            walls.append(time.perf_counter() - began)
        summary = json.loads((out / "summary.json").read_text())
        files = {file.name: file.stat().st_size for file in sorted(out.iterdir())}
    size, step = summary["size"], summary["steps"][0]
    contact = step["contacts"][0]
    timings = {name: seconds for name, seconds in summary["timings"].items() if name != "total"}
    phases = [[name, page.seconds(seconds)] for name, seconds in timings.items()]
    phases.append(["all, with the start of Python", page.seconds(float(np.median(walls)))])
    states = ", ".join(f"{contact[state]} {state}" for state in ("open", "stick", "slip"))
    written = ", ".join(f"{name} {length / 1e6:.1f} MB" for name, length in files.items())
    return "\n\n".join(
        [
            page.table(("phase", "seconds on the wall"), phases),
            f"{size['dofs']} unknowns, {size['contact_pairs']} contact pairs ({states}), mu = 0.4; certificate passed: "
            f"{step['certificate']['passed']}; peak memory {page.gigabytes(summary['peak_memory_bytes'])} GB; "
            f"{written}. {page.machine()}, median of {len(walls)} runs, load {load:.1f} before.",
        ]
    )


def _row(first: list[object], found: dict[str, Any]) -> list[object]:
    times = [page.seconds(found[name]) for name in ("whole", *PHASES)]
    return [*first, *times, page.gigabytes(found["memory"]), found["iterations"]]


def _machine() -> str:
    return f"CPU seconds, one thread, medians of up to {REPEATS}, {page.machine()}."


TABLES: dict[str, Callable[[bool], str]] = {"unknowns": unknowns, "pairs": pairs, "large": large}


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("tables", nargs="*", help=", ".join(TABLES))
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        which, *sizes = options.tables
        cylinder = which == "cylinder"
        model = zhu_cylinder(refine=int(sizes[0])) if cylinder else dragged_block(*map(int, sizes))
        print(json.dumps([measure(model)]))
        return
    for name in options.tables or TABLES:
        text = TABLES[name](options.small)
        command.publish(options, f"growth, {name}", text)


if __name__ == "__main__":
    main()
