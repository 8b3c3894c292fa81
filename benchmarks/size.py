# SPDX-License-Identifier: BSD-3-Clause
"""Large contacts in space, condensed and iterated: growth with unknowns and with pairs; tables of docs/performance.md.

python -m benchmarks.size [unknowns] [pairs] [--small] [--most N] [--dry] [--kept FILE]

CPU seconds, one thread, of everything from the model to the certified solution; code warm, every run in a process of
its own. What is measured is added to a file, a line each, and not measured again: so the tables can be made
in pieces, whenever the machine is quiet.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import command, page
from signorini.clock import Clock
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.iterative.springs import PairSprings
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step

WAYS = ("multifrontal", "iterative")
CONDENSED_UP_TO = 310_000
SIZES, SMALL_SIZES = (30_000, 100_000, 300_000, 1_000_000, 3_000_000), (3_000, 10_000)
SIDES, SMALL_SIDES = (14, 19, 29, 39, 49), (4, 8)
FIXED, SMALL_FIXED = 100_000, 3_000
Case = tuple[str, str, int]
WIDEST: Case = ("99", "iterative", 300_000)
"""Columns of 10,000 pairs; condensed, their compliance alone would take 7.2 GB."""
TOLERANCE = 1e-10
"""Of the forces: what a plain multigrid solve leaves of equilibrium, as much as contact may."""
HEAD = (
    "problem",
    "way",
    "unknowns",
    "contact pairs",
    "open",
    "stick",
    "slip",
    "iterations",
    "seconds",
    "contact / plain multigrid",
    "memory GB",
)


def columns(side: int, dofs: int) -> Model:
    """Two equal columns of cubic cells end on end, ``side`` cells across, one pressed and pushed on the other."""
    layers = max(1, round(dofs / (6.0 * (side + 1) ** 2)) - 1)
    height, x = layers / side, np.linspace(0.0, 1.0, side + 1)
    z = np.linspace(0.0, height, layers + 1)
    parts = {"lower": box(x=x, y=x, z=z - height), "upper": box(x=x, y=x, z=z)}
    return Model(
        join(parts),
        bodies=[Body(name, Elastic(E=1.0, nu=0.3)) for name in parts],
        supports=[
            Support("lower.bottom", u=(0.0, 0.0, 0.0)),
            Support("upper.top", u=(0.018 * height, 0.006 * height, -0.01 * height)),
        ],
        contacts=[Contact("upper.bottom", "lower.top", friction=0.3, name="contact")],
        steps=[Step(increments=1)],
    )


def model_of(problem: str, dofs: int) -> Model:
    """Cubes of about so many unknowns, matching or not; columns of "side" cells across."""
    if problem.isdigit():
        return columns(int(problem), dofs)
    n = max(2, round(np.cbrt(dofs / 6.0)) - 1)
    if problem == "cubes":
        return cubes(n)
    upper = max(1, round(0.92 * n))
    return cubes(max(2, round(np.cbrt(dofs / 3.0 - (upper + 1) ** 3)) - 1), upper)


def plain(prepared: Prepared) -> tuple[float, int]:
    """Seconds and conjugate gradients of one linear solve by the same multigrid, its coarse grids included.

    The bodies are joined by springs in all pairs, and supports move as the step says.
    """
    bodies = prepared.solver.bodies  # type: ignore[attr-defined]
    joined = PairSprings(normal=bodies.stiffness, tangent=np.eye(2)[:, :, None] * bodies.stiffness)
    moved = np.sum(list(prepared.constraints.prescribed.values()), axis=0)
    f = bodies.blocks.spread(prepared.constraints.on_free(-(prepared.K @ moved)))
    began = time.process_time()
    _, count = bodies.solved(joined, bodies.preconditioner_under(joined), f, TOLERANCE)
    return time.process_time() - began, count


def measure(problem: str, way: str, dofs: int) -> dict[str, Any]:
    """One solve in this process, and where contact is iterated a plain one beside it."""
    solve_prepared(prepare(cubes(5, 4), backend=way))
    model = model_of(problem, dofs)
    linear = plain(prepare(model, backend=way)) if way == "iterative" else None
    clock, began = Clock(timer=time.process_time), time.process_time()
    history = solve_prepared(prepare(model, backend=way, clock=clock))
    seconds = time.process_time() - began
    contact, last = history.last.contacts[0], history.last
    return {
        "plain": linear,
        "contact": seconds - clock.seconds["assembly"],
        "unknowns": 3 * len(model.mesh.points),
        "pairs": history.pairs,
        "states": [contact.count(state) for state in ("open", "stick", "slip")],
        "iterations": sum(last.iterations),
        "end": last.trace[0][-1].end,
        "seconds": seconds,
        "memory": page.peak_memory(),
        "worst": last.certificate.worst,
    }


def in_process(problem: str, way: str, dofs: int, kept: Path | None) -> dict[str, Any]:
    """Measure in a process of its own, unless that was done before."""
    case = [problem, way, dofs]
    for line in kept.read_text().splitlines() if kept and kept.exists() else []:
        before, found = json.loads(line)
        if before == case:
            return dict(found)
    (found,) = page.measured("benchmarks.size", *case, keep=False)
    if kept:
        with kept.open("a") as file:
            file.write(json.dumps([case, found]) + "\n")
    print(
        f"{problem}, {way}: {found['unknowns']} unknowns, {found['pairs']} pairs: {found['seconds']:.1f} s", flush=True
    )
    return found


def row(problem: str, way: str, found: dict[str, Any]) -> list[object]:
    """A line of a table."""
    steps, beside = str(found["iterations"]), ""
    if way == "iterative":  # rounds of the multipliers, and all conjugate gradients
        steps += f" / {found['end'].split()[0]}"
        alone, count = found["plain"]
        beside = f"{found['contact'] / alone:.2f} ({count})"
    return [
        f"{problem} cells across" if problem.isdigit() else problem,
        way,
        found["unknowns"],
        found["pairs"],
        *found["states"],
        steps,
        page.seconds(found["seconds"]),
        beside,
        page.gigabytes(found["memory"]),
    ]


def growth(rows: list[tuple[str, dict[str, Any]]], key: str) -> str:
    """Exponents of the power laws in unknowns or pairs that fit best, way by way."""
    said = []
    for way in WAYS:
        own = [found for name, found in rows if name == way]
        if len({found[key] for found in own}) > 1:
            fit = command.exponent([found[key] for found in own], [found["seconds"] for found in own])
            said.append(f"{way} {fit:.2f}")
    return f"Exponents of the seconds in the {key}: {', '.join(said)}."


def table(cases: list[Case], key: str, kept: Path | None, beside: Sequence[Case] = ()) -> str:
    """Measure cases of (problem, way, dofs); of those ``beside`` there is a line, and none is in the exponents."""
    found = [(problem, way, in_process(problem, way, dofs, kept)) for problem, way, dofs in (*cases, *beside)]
    lines = [row(problem, way, each) for problem, way, each in found]
    worst = max(each["worst"] for _, _, each in found)
    words = (
        "mu = 0.3, one increment. Iterations: Newton's systems, or rounds / conjugate gradients. Contact, all after "
        "assembly, beside one plain solve by the same multigrid, with the bodies joined and its coarse grids made; in "
        f"brackets its conjugate gradients to a residual of {TOLERANCE:.0e}. The worst certificate is {worst:.0e}. CPU "
        f"seconds, one thread, one run each, {page.machine()}."
    )
    return "\n\n".join(
        [page.table(HEAD, lines), growth([(way, each) for _, way, each in found[: len(cases)]], key), words]
    )


def unknowns(small: bool, kept: Path | None, most: int) -> str:
    """Cubes that do not match, condensed and iterated, up to so many unknowns."""
    sizes = [size for size in (SMALL_SIZES if small else SIZES) if size <= most]
    cases = [
        ("cubes, not matching", way, dofs)
        for way in WAYS
        for dofs in sizes
        if way == "iterative" or dofs <= CONDENSED_UP_TO
    ]
    return table(cases, "unknowns", kept)


def pairs(small: bool, kept: Path | None, _: int) -> str:
    """Columns of a fixed number of unknowns, ever wider, and one of three times as many that can only be iterated."""
    sides, dofs = (SMALL_SIDES, SMALL_FIXED) if small else (SIDES, FIXED)
    cases = [(str(side), way, dofs) for way in WAYS for side in sides]
    return table(cases, "pairs", kept, beside=[] if small else [WIDEST])


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("tables", nargs="*", help="unknowns, pairs")
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--kept", type=Path, help="what was measured before, and is added to")
    parser.add_argument("--most", type=int, default=10**9, help="unknowns of the largest case")
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        problem, way, dofs = options.tables
        print(json.dumps([measure(problem, way, int(dofs))]))
        return
    for name in options.tables or ("unknowns", "pairs"):
        text = {"unknowns": unknowns, "pairs": pairs}[name](options.small, options.kept, options.most)
        command.publish(options, f"size, {name}", text)


if __name__ == "__main__":
    main()
