# SPDX-License-Identifier: BSD-3-Clause
"""Both ways through contact in space, case by case, and which one is chosen by itself; a table of docs/performance.md.

python -m benchmarks.ways [--dry] [--kept FILE]

CPU seconds after assembly, one thread, code warm, every case in a process of its own. What is measured is added to a
file, a line each, and not measured again; the choice is that of the code as it is.
"""

from __future__ import annotations

import json
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import command, page
from benchmarks.size import model_of
from signorini.clock import Clock
from signorini.engine.memory_check import condensing
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.engine.way_costs import Condensing, cheaper_way
from signorini.gallery.cubes import cubes
from signorini.interface.active import FreeBodies
from signorini.linalg.registry import factorise
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model

CASES = (
    ("cubes", 12_000, 1),
    ("cubes", 30_000, 1),
    ("cubes", 30_000, 4),
    ("cubes, not matching", 30_000, 1),
    ("14", 30_000, 1),
    ("29", 30_000, 1),
    ("cubes without friction", 30_000, 1),
    ("cubes, flat cells", 30_000, 1),
    ("cubes", 60_000, 1),
    ("cubes, not matching", 60_000, 1),
    ("14", 100_000, 1),
    ("29", 100_000, 1),
    ("29", 100_000, 4),
    ("49", 100_000, 1),
    ("cubes", 100_000, 1),
    ("cubes", 100_000, 4),
    ("cubes, not matching", 100_000, 1),
    ("cubes without friction", 100_000, 1),
    ("cubes, flat cells", 100_000, 1),
    ("block on a plate", 100_000, 1),
    ("cubes", 180_000, 1),
    ("cubes, not matching", 180_000, 1),
    ("cubes", 300_000, 1),
    ("cubes, not matching", 300_000, 4),
)
"""Problem, unknowns and increments."""
NEAR = 1.1
"""Times the cheaper way: what is as good."""
HEAD = (
    "problem",
    "unknowns",
    "pairs",
    "increments",
    "Gflop",
    "condensed s",
    "iterated s",
    "one linear solve s",
    "chosen",
    "chosen / cheaper",
    "chosen / linear",
)


def flat_cells(dofs: int) -> Model:
    """A cube on another with cells that are four times as wide as high where they touch and far from it."""
    model = cubes(max(2, round(np.cbrt(dofs / 6.0 / 4.0)) - 1))
    across = model.mesh.points[:, 0]
    x = np.unique(across.round(12))
    z = np.linspace(0.0, 1.0, 4 * (len(x) - 1) + 1)
    parts = {name: box(x=x, y=x, z=z - (name == "lower")) for name in ("lower", "upper")}
    return replace(model, mesh=join(parts))


def on_a_plate(dofs: int) -> Model:
    """A block of a few cells' height on a plate that is four times as wide and held at its edge."""
    n = max(4, round(np.cbrt(dofs / 3.0 / 4.0)))
    x, h = np.linspace(-2.0, 2.0, 4 * n + 1), np.linspace(0.0, 0.25, max(2, n // 4) + 1)
    top = np.linspace(-0.5, 0.5, max(2, round(0.9 * n)) + 1)
    parts = {"plate": box(x=x, y=x, z=h - 0.25), "block": box(x=top, y=top, z=np.linspace(0.0, 1.0, n + 1))}
    return Model(
        join(parts),
        bodies=[Body(name, Elastic(E=1.0, nu=0.3)) for name in parts],
        supports=[
            Support("plate.left", u=(0.0, 0.0, 0.0)),
            Support("plate.right", u=(0.0, 0.0, 0.0)),
            Support("block.top", u=(0.004, 0.002, -0.02)),
        ],
        contacts=[Contact("block.bottom", "plate.top", friction=0.3, name="contact")],
        steps=cubes(2).steps,
    )


def case_of(problem: str, dofs: int, increments: int) -> Model:
    """A model of about so many unknowns."""
    made = {"cubes, flat cells": flat_cells, "block on a plate": on_a_plate}.get(problem)
    model = made(dofs) if made else model_of(problem.removesuffix(" without friction"), dofs)
    if problem.endswith("without friction"):
        model = replace(model, contacts=[replace(contact, friction=0.0) for contact in model.contacts])
    return replace(model, steps=[replace(step, increments=increments) for step in model.steps])


def linear(model: Model) -> tuple[float, dict[str, float]]:
    """Seconds of a plain solve of the bodies with their contact nodes held, and what the choice is told."""
    prepared = prepare(model, backend="iterative")
    T, interface = prepared.constraints.transform, prepared.interface
    K, B = T.T @ prepared.K @ T, interface.B @ T
    bodies = FreeBodies(K.tocsr(), B.tocsr(), prepared.constraints.nodes, prepared.space.places)
    told = condensing(bodies, interface, candidates=prepared.candidates, plenty=0.0)
    keep = np.setdiff1d(np.arange(K.shape[0]), bodies.B.indices)
    fixed, nodes = bodies.K[keep][:, keep], prepared.constraints.nodes[keep]
    began = time.process_time()
    factor = factorise(fixed, [], nodes=nodes, points=prepared.space.places)
    factor.reduce(np.ones(len(keep))).expand(np.empty(0))
    seconds, v = time.process_time() - began, np.ones(K.shape[0])
    rows = fixed @ v[keep]
    began = time.process_time()
    for _ in range(10):
        rows = fixed @ rows
    product = (time.process_time() - began) / 10 / fixed.nnz
    return seconds, {**told._asdict(), "entries": K.nnz, "product": product, "unknowns": K.shape[0]}


def measure(problem: str, dofs: int, increments: int) -> dict[str, Any]:
    """Both ways in this process."""
    for way in ("multifrontal", "iterative"):
        solve_prepared(prepare(cubes(5, 4), backend=way))
    model = case_of(problem, dofs, increments)
    found: dict[str, Any] = {}
    for way in ("multifrontal", "iterative"):
        clock, began = Clock(timer=time.process_time), time.process_time()
        history = solve_prepared(prepare(model, backend=way, clock=clock))
        found[way] = time.process_time() - began - clock.seconds["assembly"]
        found[f"{way} phases"] = dict(clock.seconds)
        found["pairs"], found[f"{way} end"] = history.pairs, history.last.trace[0][-1].end
        found[f"{way} iterations"] = sum(history.last.iterations)
        del history
    found["linear"], told = linear(model)
    return found | told


def in_process(case: tuple[str, int, int], kept: Path | None) -> dict[str, Any]:
    """Measure in a process of its own, unless that was done before."""
    for line in kept.read_text().splitlines() if kept and kept.exists() else []:
        before, found = json.loads(line)
        if tuple(before) == case:
            return dict(found)
    (found,) = page.measured("benchmarks.ways", *case)
    if kept:
        with kept.open("a") as file:
            file.write(json.dumps([case, found]) + "\n")
    print(case, f"{found['multifrontal']:.1f} s, {found['iterative']:.1f} s", flush=True)
    return found


def row(case: tuple[str, int, int], found: dict[str, Any]) -> tuple[list[object], float]:
    """A line of the table, and how many times the cheaper way the chosen one takes."""
    told = Condensing(found["bytes"], found["operations"], found["rows"])
    spared = cheaper_way(told, found["entries"], case[2]).worth > 0.0
    condensed, iterated, plain = (found[name] for name in ("multifrontal", "iterative", "linear"))
    chosen = iterated if spared else condensed
    lost = chosen / min(condensed, iterated)
    problem = f"columns, {case[0]} cells across" if case[0].isdigit() else case[0]
    seconds = [page.seconds(each) for each in (condensed, iterated, plain)]
    words = ["iterated" if spared else "condensed", f"{lost:.2f}", f"{chosen / plain:.2f}"]
    size = [found["unknowns"], found["pairs"], case[2], round(found["operations"] / 1e9)]
    return [problem, *size, *seconds, *words], lost


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("case", nargs="*", help="problem, unknowns, increments")
    parser.add_argument("--kept", type=Path, help="what was measured before, and is added to")
    parser.add_argument("--most", type=int, default=10**9, help="unknowns of the largest case")
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        print(json.dumps([measure(options.case[0], int(options.case[1]), int(options.case[2]))]))
        return
    found = [(case, in_process(case, options.kept)) for case in CASES if case[1] <= options.most]
    rows, lost = zip(*(row(case, each) for case, each in found), strict=True)
    words = (
        f"The cheaper way, or one that is as good to a tenth, was chosen in {sum(each <= NEAR for each in lost)} of "
        f"{len(lost)} cases. mu = 0.3 unless it is said; CPU seconds after assembly, one thread, one run each, "
        f"{page.machine()}."
    )
    command.publish(options, "ways", f"{page.table(HEAD, rows)}\n\n{words}")


if __name__ == "__main__":
    main()
