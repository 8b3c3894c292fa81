# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on the ranks of MPI: what conjugate gradients grow by, how work and memory are shared, and the same answers.

Two cubes whose meshes do not match, solved in one process and by the back end 'petsc' on 1, 2 and 4 ranks. Counts and
operations say how work grows and is shared whatever else the machine does; times on two cores would not. Needs
petsc4py, mpi4py and mpiexec.

usage: python -m benchmarks.distributed [--small]
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

import numpy as np

import signorini as sg
from benchmarks import command, page
from signorini.distributed.ranks import Team, the_team
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.memory import peak_memory

RANKS = (1, 2, 4)
PAGE = page.PAGE.parent / "distributed.md"
ROOT_AND_FEW_CORES = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
}


def usage(team: Team) -> tuple[float, float]:
    """Operations of PETSc so far, and the most memory, bytes."""
    del team
    from petsc4py import PETSc

    if not PETSc.Log.isActive():
        PETSc.Log.begin()
    return float(PETSc.Log.getFlops()), float(peak_memory())


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
    pairs = np.bincount(bodies.owner, minlength=team.size)
    return {
        "unknowns": model.number_of_dofs,
        "pairs": history.pairs,
        "rounds": history.last.trace[0][-1].iterations,
        "gradients": history.last.trace[0][-1].end.split()[0],
        "alone": alone.last.trace[0][-1].end.split()[0],
        "most pairs": int(pairs.max()),
        "work": float(flops[1].sum() / 1e9),
        "balance": float(flops[1].max() / flops[1].mean()),
        "memory": max(each[1] for each in after) / 1e9,
        "least memory": min(each[1] for each in after) / 1e9,
        "apart": float(
            max(np.abs(one.pressure - other.pressure).max(), np.abs(one.traction - other.traction).max()) / size
        ),
        "states": int((one.status != other.status).sum()),
    }


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
        f"{found['least memory']:.2f} - {found['memory']:.2f}",
        found["states"],
        f"{found['apart']:.0e}",
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
    "GB a rank",
    "other states",
    "largest difference",
]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--one", nargs=2, type=int, metavar="N", help="measure cubes of so many cells on these ranks")
    options = parser.parse_args()
    if options.one:
        with sg.ranks() as first:
            if first:
                print(json.dumps(measured(*options.one)))
        return
    rows = []
    for lower, upper in ((5, 4), (8, 7)) if options.small else ((7, 6), (10, 9), (14, 12)):
        for ranks in RANKS:
            words = ["mpiexec", "-n", str(ranks), sys.executable, "-m", "benchmarks.distributed", "--one"]
            environment = {**os.environ, **page.ONE_THREAD, **ROOT_AND_FEW_CORES}
            done = subprocess.run(
                [*words, str(lower), str(upper)], check=True, stdout=subprocess.PIPE, text=True, env=environment
            )
            rows.append(row(ranks, json.loads(done.stdout)))
    text = page.table(HEAD, rows)
    command.publish(options, "distributed", text, PAGE)


if __name__ == "__main__":
    main()
