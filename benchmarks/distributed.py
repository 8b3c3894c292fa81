# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on the ranks of MPI: what conjugate gradients grow by, how work and memory are shared, and the same answers.

Two cubes whose meshes do not match, solved in one process and by the back end 'petsc' on 1, 2 and 4 ranks. Counts and
operations say how work grows and is shared whatever else the machine does; times on two cores would not. With
``--memory`` what ranks hold of bodies and results, in kB a node; with ``--history`` what each increment adds whose
displacements are kept. Needs petsc4py, mpi4py and mpiexec.

usage: python -m benchmarks.distributed [--small] [--memory | --history]
"""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
import tempfile
import tracemalloc
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import signorini as sg
from benchmarks import command, page
from signorini.distributed.ranks import Team, lend, the_team
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.memory import peak_memory
from signorini.output.folder import write_folder

RANKS = (1, 2, 4)
INCREMENTS = 4, 12  # between which the growth of a history is measured
MANY = 12  # ranks on which what the first one holds of the whole mesh outweighs its own share
LARGE = 24, 21  # cells of cubes whose size parts that are made some cells at a time do not depend on
PAGE = page.PAGE.parent / "distributed.md"
ROOT_AND_FEW_CORES = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
}


def usage(team: Team) -> tuple[float, float, float]:
    """Operations of PETSc so far, the most memory, bytes, and what this rank has sent and received, bytes."""
    del team
    from petsc4py import PETSc

    so_far = PETSc.Log.Event("so far")
    if PETSc.Log.isActive():
        so_far.end()
    else:
        PETSc.Log.begin()
    exchanged = so_far.getPerfInfo()["messageLength"]
    so_far.begin()
    return float(PETSc.Log.getFlops()), float(peak_memory()), float(exchanged)


def measured(lower: int, upper: int) -> dict[str, Any]:
    """Counts of a solve on all ranks, and how far its answer is from that of one process without any."""
    model = cubes(lower, upper)
    team = the_team()
    before = team.everywhere(usage)
    prepared = prepare(model, backend="petsc")
    made = team.everywhere(usage)
    history = solve_prepared(prepared)
    after = team.everywhere(usage)
    alone = solve_prepared(prepare(model, backend="iterative"))
    one, other = alone.last.contacts[0], history.last.contacts[0]
    size = float(np.abs(one.pressure).max())
    flops = np.array([[b[0] - a[0] for a, b in zip(*times, strict=True)] for times in ((before, made), (made, after))])
    bodies: Any = prepared.solver.bodies  # type: ignore[attr-defined]
    exchanged = sum(a[2] - m[2] for m, a in zip(made, after, strict=True))
    pairs = np.bincount(bodies.on_ranks.owner, minlength=team.size)
    return {
        "unknowns": model.number_of_dofs,
        "pairs": history.pairs,
        "rounds": history.last.trace[0][-1].iterations,
        "gradients": history.last.trace[0][-1].end.split()[0],
        "alone": alone.last.trace[0][-1].end.split()[0],
        "most pairs": int(pairs.max()),
        "work": float(flops[1].sum() / 1e9),
        "balance": float(flops[1].max() / flops[1].mean()),
        "sent": float(exchanged / 2e6),  # every message is counted where it starts and where it ends
        "memory": max(each[1] for each in after) / 1e9,
        "least memory": min(each[1] for each in after) / 1e9,
        "apart": float(
            max(np.abs(one.pressure - other.pressure).max(), np.abs(one.traction - other.traction).max()) / size
        ),
        "states": int((one.status != other.status).sum()),
    }


def traced(team: Team) -> tuple[int, int]:
    """Bytes of Python's and NumPy's objects now, and the most since the last call; not those of PETSc."""
    del team
    gc.collect()
    if not tracemalloc.is_tracing():
        tracemalloc.start()
    found = tracemalloc.get_traced_memory()
    tracemalloc.reset_peak()
    return found


def held(lower: int, upper: int) -> dict[str, Any]:
    """What the first rank and the others hold of a model and its results, bytes a node; the mesh is lent to them."""
    team = the_team()
    with tempfile.TemporaryDirectory() as folder:
        solve_prepared(prepare(cubes(2, 2), backend="petsc"))  # what is loaded and compiled once
        write_folder(solve_prepared(prepare(cubes(2, 2), backend="petsc")), Path(folder, "small"))
        before = team.everywhere(traced)
        model = cubes(lower, upper)
        nodes = model.mesh.number_of_nodes
        lend(model.mesh)
        prepared = prepare(model, backend="petsc")
        made = team.everywhere(traced)
        history = solve_prepared(prepared)
        del prepared
        solved = team.everywhere(traced)
        write_folder(history, Path(folder, "large"))
        written = team.everywhere(traced)

    def first_and_others(now: list[tuple[int, int]], what: int, beside: list[tuple[int, int]]) -> list[float]:
        found = [(one[what] - other[0]) / nodes for one, other in zip(now, beside, strict=True)]
        return [found[0], max(found[1:], default=0.0)]

    return {
        "nodes": nodes,
        "mesh and pieces": first_and_others(made, 0, before),
        "to cut": first_and_others(made, 1, before),
        "to solve": first_and_others(solved, 1, before),
        "history": first_and_others(solved, 0, before),
        "to write": first_and_others(written, 1, solved),
    }


def grown(lower: int, upper: int) -> dict[str, Any]:
    """Bytes a node that each increment adds to a history that keeps its displacements, of the first rank and others."""
    team, model, sizes = the_team(), cubes(lower, upper), []
    for increments in (1, *INCREMENTS):  # the first one loads and compiles
        before = [now for now, _ in team.everywhere(traced)]
        posed = replace(model, steps=[sg.Step(increments=increments, at="events")])
        history = solve_prepared(prepare(posed, backend="petsc"))
        sizes.append(np.array([now for now, _ in team.everywhere(traced)]) - before)
        pairs = history.pairs
        del history
    nodes = len(model.mesh.points)
    more = (sizes[2] - sizes[1]) / (INCREMENTS[1] - INCREMENTS[0]) / nodes
    return {"nodes": nodes, "pairs": pairs, "first": float(more[0]), "others": float(more[1:].max(initial=0.0))}


def memory_row(ranks: int, found: dict[str, Any]) -> list[object]:
    """A line of the table of memory, kB a node."""
    parts = [found[name] for name in ("mesh and pieces", "to cut", "to solve", "history", "to write")]
    shown = [f"{first / 1e3:.2f}, {others / 1e3:.2f}" if ranks > 1 else f"{first / 1e3:.2f}" for first, others in parts]
    return [f"{found['nodes']}", ranks, *shown]


def row(ranks: int, found: dict[str, Any]) -> list[object]:
    """A line of the table."""
    return [
        f"{found['unknowns']}",
        found["pairs"],
        ranks,
        found["rounds"],
        found["gradients"],
        found["alone"],
        found["most pairs"],
        f"{found['work']:.2f}",
        f"{found['balance']:.2f}",
        f"{found['sent']:.1f}",
        f"{found['least memory']:.2f} - {found['memory']:.2f}",
        found["states"],
        f"{found['apart']:.0e}",
    ]


HISTORY_HEAD = ["nodes", "pairs", "ranks", "the first rank", "the most of the others"]
MEMORY_HEAD = [
    "nodes",
    "ranks",
    "bodies and pieces",
    "most up to there",
    "most while it is solved",
    "the history",
    "most beside it for the files",
]

HEAD = [
    "unknowns",
    "pairs",
    "ranks",
    "rounds",
    "conjugate gradients",
    "in one process",
    "pairs, most",
    "Gflop of PETSc",
    "of a rank, most / mean",
    "MB sent",
    "GB a rank",
    "other states",
    "largest difference",
]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--memory", action="store_true", help="what ranks hold, in place of counts and work")
    parser.add_argument("--history", action="store_true", help="how a history grows, in place of counts and work")
    parser.add_argument("--one", nargs=2, type=int, metavar="N", help="measure cubes of so many cells on these ranks")
    options = parser.parse_args()
    if options.one:
        with sg.ranks() as first:
            if first:
                what = held if options.memory else grown if options.history else measured
                print(json.dumps(what(*options.one)))
        return
    if options.history:
        size = (5, 4) if options.small else (8, 7)
        found = [(ranks, on_ranks(ranks, size, "--history")) for ranks in RANKS]
        rows = [
            [str(one["nodes"]), one["pairs"], number, f"{one['first']:.0f}", f"{one['others']:.0f}"]
            for number, one in found
        ]
        command.publish(options, "history on ranks", page.table(HISTORY_HEAD, rows), PAGE)
        return
    if options.memory:
        sizes = ((5, 4),) if options.small else ((8, 7), (14, 12))
        runs = [*((ranks, size) for size in sizes for ranks in RANKS), (MANY, sizes[-1])]
        runs += [] if options.small else [(RANKS[-1], LARGE), (MANY, LARGE)]
        rows = [memory_row(ranks, on_ranks(ranks, size, "--memory")) for ranks, size in runs]
        command.publish(options, "memory of ranks", page.table(MEMORY_HEAD, rows), PAGE)
        return
    sizes = ((5, 4), (8, 7)) if options.small else ((7, 6), (10, 9), (14, 12))
    rows = [row(ranks, on_ranks(ranks, size)) for size in sizes for ranks in RANKS]
    command.publish(options, "distributed", page.table(HEAD, rows), PAGE)


def on_ranks(ranks: int, size: Sequence[int], *further: str, module: str = "benchmarks.distributed") -> dict[str, Any]:
    """What ranks print that measure cubes of so many cells, by a module."""
    words = ["mpiexec", "-n", str(ranks), sys.executable, "-m", module, *further, "--one"]
    environment = {**os.environ, **page.ONE_THREAD, **ROOT_AND_FEW_CORES}
    done = subprocess.run([*words, *map(str, size)], check=True, stdout=subprocess.PIPE, text=True, env=environment)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


if __name__ == "__main__":
    main()
