# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that MUMPS factorises on ranks for a thousand pairs and more: time by phases, memory, and the same answers.

Two square plates, 30 by 30 by 3 cells and more, whose meshes do not match: nearly all is the interface. They are solved
in one process, and by the back end 'mumps' on ranks. What is known is published after every size. Needs petsc4py,
mpi4py and mpiexec.

usage: python -m benchmarks.factorised_on_ranks [--small] [--dry]
"""

from __future__ import annotations

import json
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import signorini as sg
from benchmarks import command, page
from benchmarks.distributed import PAGE, on_ranks
from signorini.clock import Clock
from signorini.distributed.ranks import MUMPS, Team, the_team
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.meshing.solid import box
from signorini.model.mesh import join

MODULE = "benchmarks.factorised_on_ranks"
SIZES = {63: (1,), 31: (1, 2), 54: (1, 2)}  # cells along an edge, the largest first, with numbers of ranks
SMALL = {12: (1, 2)}
LAYERS, THICKNESS = 3, 0.25  # of cells in a plate; of the sides of the plates
KEPT = "SIGNORINI_PLATES"  # environment variable: the file in which the answer of one process is
PHASES = ("factorisation", "condensation", "complementarity")
HEAD = [
    "pairs",
    "unknowns",
    "ranks",
    "assembly s",
    *(f"{name} s" for name in PHASES),
    "Gflop",
    "GB of a dense matrix",
    "GB a rank",
    "other states",
    "largest difference",
]


def plates(cells: int) -> sg.Model:
    """A plate on another, its top moved down and aside in one increment: some pairs stick, those at the edges slip."""

    def plate(number: int, low: float) -> sg.Mesh:
        side = np.linspace(0.0, 1.0, number + 1)
        return box(x=side, y=side, z=np.linspace(low, low + THICKNESS, LAYERS + 1))

    parts = {"lower": plate(cells + 2, -THICKNESS), "upper": plate(cells, 0.0)}
    return sg.Model(
        join(parts),
        bodies=[sg.Body(name, sg.Elastic(E=1.0, nu=0.3)) for name in parts],
        supports=[sg.Support("lower.bottom", u=(0, 0, 0)), sg.Support("upper.top", u=(0.0045, 0.0015, -0.0025))],
        contacts=[sg.Contact("upper.bottom", "lower.top", friction=0.3)],
        steps=[sg.Step(increments=1)],
    )


def held(team: Team | None = None) -> int:
    """Bytes that this process has held at most."""
    del team
    return page.peak_memory()


def measured(cells: int, backend: str) -> dict[str, Any]:
    """A solve: seconds of this process by phases, and what every rank has held; one process leaves its answer."""
    model, clock = plates(cells), Clock(timer=time.process_time)
    prepared = prepare(model, backend=backend, clock=clock)
    history = solve_prepared(prepared)
    found, kept = history.last.contacts[0], os.environ[KEPT]
    result = {
        "pairs": history.pairs,
        "unknowns": model.number_of_dofs,
        "seconds": dict(clock.seconds),
        "passed": history.last.certificate.passed,
    }
    if backend != MUMPS:
        np.savez(kept, pressure=found.pressure, traction=found.traction, status=found.status)
        factors: Any = prepared.solver.condensed.factorisation  # type: ignore[union-attr]
        return result | {"memory": [held()], "flops": factors.plan.flops}
    team = the_team()
    result |= {"memory": team.everywhere(held), "flops": operations()}
    with np.load(kept) as one:
        apart = [np.abs(getattr(found, name) - one[name]).max() for name in ("pressure", "traction")]
        size, states = np.abs(one["pressure"]).max(), int((found.status != one["status"]).sum())
    return result | {"apart": float(max(apart) / size), "states": states}


def operations() -> float:
    """Operations of the factorisation that the ranks have made together, as MUMPS has counted them."""
    from signorini.distributed.factors import OwnFactors

    (made,) = (kept for kept in the_team().held.values() if isinstance(kept, OwnFactors))
    return made.operations


def row(ranks: str, found: dict[str, Any]) -> list[object]:
    """A line of the table."""
    if not found["passed"]:
        raise SystemExit("an answer is not certified")
    memory = " and ".join(page.gigabytes(size) for size in found["memory"])
    same = [str(found["states"]), f"{found['apart']:.0e}"] if "apart" in found else ["", ""]
    return [
        str(found["pairs"]),
        found["unknowns"],
        ranks,
        *(page.seconds(found["seconds"][name]) for name in ("assembly", *PHASES)),
        f"{found['flops'] / 1e9:.3g}",
        page.gigabytes(8.0 * (3 * found["pairs"]) ** 2),
        memory,
        *same,
    ]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="a size that takes seconds")
    parser.add_argument("--one", type=int, metavar="N", help="measure in this process, by ranks where it is one")
    parser.add_argument("--backend", default=MUMPS)
    options = parser.parse_args()
    if options.one:
        if options.backend != MUMPS:
            print(json.dumps([measured(options.one, options.backend)]))
            return
        with sg.ranks() as first:
            if first:
                print(json.dumps(measured(options.one, MUMPS)))
        return
    rows: dict[int, list[list[object]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        os.environ[KEPT] = str(Path(folder, "answer.npz"))
        for cells, numbers in (SMALL if options.small else SIZES).items():
            (alone,) = page.measured(MODULE, cells, "--backend", "multifrontal", keep=False)
            rows[cells] = [row("in one process", alone)]
            for ranks in numbers:
                rows[cells].append(row(str(ranks), on_ranks(ranks, (cells,), "--backend", MUMPS, module=MODULE)))
            known = [line for size in sorted(rows) for line in rows[size]]
            command.publish(options, "factorised on ranks", page.table(HEAD, known), PAGE)


if __name__ == "__main__":
    main()
