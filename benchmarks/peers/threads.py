# SPDX-License-Identifier: BSD-3-Clause
"""The paper's cylinder on one and more threads in other codes, beside signorini and a plain linear solve by PARDISO.

All on the same mesh, with friction; a table of docs/performance.md. CalculiX has its threaded SPOOLES and assembly,
GetFEM the threads that its MUMPS and its BLAS have. CalculiX is left out of meshes on which it would take minutes.

    python -m benchmarks.peers.threads [--refine 18 36] [--dry]
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import partial

from benchmarks import command, page
from benchmarks.peers import run_calculix, run_getfem, run_signorini
from benchmarks.peers.case import cylinder_case
from benchmarks.peers.result import Result, middle
from signorini.cores import physical_cores
from signorini.linalg.pardiso import available

FRICTION = 0.4
MINUTES = 100_000  # unknowns from which CalculiX takes them
HEAD = ("code", "unknowns", "threads", "CPU s", "wall s", "one thread over it", "over signorini")


def measured(refine: int, threads: int) -> Iterator[tuple[str, float, float]]:
    """Codes, with the seconds that they take of the CPU and on the wall from the assembly on."""
    case = cylinder_case(refine)
    yield _times(run_signorini.run(case, refine, FRICTION, "multifrontal", threads=threads))
    if run_calculix.missing() is None and 2 * len(case.points) < MINUTES:
        yield _times(middle(partial(run_calculix.run, case, FRICTION, threads)))
    if run_getfem.missing() is None:
        yield _times(middle(partial(run_getfem.run, case, FRICTION, threads)))
    if available():
        yield _times(run_signorini.run(case, refine, FRICTION, "pardiso", threads=threads))
        yield "PARDISO, one linear solve", *run_signorini.plain(refine, "pardiso", threads)


def _times(result: Result) -> tuple[str, float, float]:
    return result.code, result.assembly_seconds + result.solve_seconds, result.wall_seconds


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--refine", type=int, nargs="+", default=[18, 36], help="5e4 and 2e5 unknowns")
    options = parser.parse_args()
    load, many = os.getloadavg()[0], max(2, physical_cores())
    rows: list[list[object]] = []
    for refine in options.refine:
        unknowns, alone = 2 * len(cylinder_case(refine).points), dict[str, float]()
        for threads in (1, many):
            ours = 0.0
            for code, cpu, wall in measured(refine, threads):
                alone.setdefault(code, wall)
                ours = ours or wall
                times = [page.seconds(cpu), page.seconds(wall), f"{alone[code] / wall:.2f}", f"{wall / ours:.2f}"]
                rows.append([code, unknowns, threads, *times])
                print(*rows[-1], flush=True)
    missing = [reason for reason in (run_calculix.missing(), run_getfem.missing()) if reason is not None]
    note = f"mu = {FRICTION}, ratios of seconds on the wall, {page.machine()}, load {load:.1f} before."
    command.publish(options, "thread-peers", "\n\n".join([page.table(HEAD, rows), *missing, note]))


if __name__ == "__main__":
    main()
