# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that MUMPS factorises on ranks for a thousand pairs and more: time by phases, memory, and the same answers.

Two square plates, 30 by 30 by 3 cells and more, whose meshes do not match: nearly all is the interface. They are solved
in one process, and by the back end 'mumps' on ranks. With ``--plane`` a strip on a rigid plane, whose contact nodes are
the pairs, on one rank alone. What is known is published after every size. Needs petsc4py, mpi4py and mpiexec.

usage: python -m benchmarks.factorised_on_ranks [--small] [--plane] [--dry]
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
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.mesh import join
from signorini.model.obstacle import Plane

MODULE = "benchmarks.factorised_on_ranks"
SIZES = {63: (1,), 31: (1, 2), 54: (1, 2)}  # cells along an edge, the largest first, with numbers of ranks
SMALL = {12: (1, 2)}
LONG, SHORT = (9999, 5999), (99,)  # cells along a strip, the largest first
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


def strip(cells: int) -> sg.Model:
    """A strip on a rigid plane, its top moved down and aside in one increment, less at the middle than at the ends."""
    side = np.linspace(0.0, 1.0, cells + 1)
    mesh = rectangle(x=side, y=np.linspace(0.0, LAYERS * side[1], LAYERS + 1))
    deep = 0.01 * side[1]
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
        supports=[sg.Support("top", u=(deep, sg.Formula(f"-{deep} * (2.0 + cos(6.283185307 * x))")))],
        contacts=[sg.Contact("bottom", Plane((0, 0), (0, 1)), friction=0.3)],
        steps=[sg.Step(increments=1)],
    )


def held(team: Team | None = None) -> int:
    """Bytes that this process has held at most."""
    del team
    return page.peak_memory()


def measured(model: sg.Model, backend: str) -> dict[str, Any]:
    """A solve: seconds of this process by phases, and what every rank has held; one process leaves its answer."""
    clock = Clock(timer=time.process_time)
    prepared = prepare(model, backend=backend, clock=clock)
    history = solve_prepared(prepared)
    found, kept = history.last.contacts[0], Path(os.environ[KEPT])
    result = {
        "pairs": history.pairs,
        "unknowns": model.number_of_dofs,
        "dense": 8.0 * (model.components * history.pairs) ** 2,
        "seconds": dict(clock.seconds),
        "passed": history.last.certificate.passed,
    }
    if backend != MUMPS:
        np.savez(kept, pressure=found.pressure, traction=found.traction, status=found.status)
        factors: Any = prepared.solver.condensed.factorisation  # type: ignore[union-attr]
        return result | {"memory": [held()], "flops": factors.plan.flops}
    team = the_team()
    result |= {"memory": team.everywhere(held), "flops": operations()}
    if not kept.exists():
        return result
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
        page.gigabytes(found["dense"]),
        memory,
        *same,
    ]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="a size that takes seconds")
    parser.add_argument("--plane", action="store_true", help="the strip in the plane, in place of the plates")
    parser.add_argument("--one", type=int, metavar="N", help="measure in this process, by ranks where it is one")
    parser.add_argument("--backend", default=MUMPS)
    options = parser.parse_args()
    if options.one:
        model = (strip if options.plane else plates)(options.one)
        if options.backend != MUMPS:
            print(json.dumps([measured(model, options.backend)]))
            return
        with sg.ranks() as first:
            if first:
                print(json.dumps(measured(model, MUMPS)))
        return
    if options.plane:
        with tempfile.TemporaryDirectory() as folder:
            os.environ[KEPT] = str(Path(folder, "answer.npz"))  # of one process, which is not asked
            lines: list[list[object]] = []
            for cells in SHORT if options.small else LONG:
                lines.insert(0, row("1", on_ranks(1, (cells,), "--plane", module=MODULE))[:-2])
                command.publish(options, "factorised in the plane", page.table(HEAD[:-2], lines), PAGE)
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
