# SPDX-License-Identifier: BSD-3-Clause
"""The paper's cylinder in other codes on the same mesh, beside signorini; writes a table of docs/performance.md.

    python -m benchmarks.peers [--refine 18 36] [--dry]

CalculiX (program ccx) and GetFEM (Python module of the system's python3) are left out where they are missing.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks import command, page
from benchmarks.peers import run_calculix, run_getfem, run_signorini
from benchmarks.peers.case import Case, cylinder_case
from benchmarks.peers.result import Result, middle
from signorini.arrays import Array
from signorini.linalg.pardiso import available

FRICTION = (0.0, 0.4)
FINE = 2
"""The refined values are those of signorini on a mesh with every edge of the finest one divided by it."""
HEAD = (
    "code",
    "unknowns",
    "mu",
    "input s",
    "assembly s",
    "solve s",
    "iterations",
    "memory GB",
    "p(0)",
    "error of p(0) %",
    "error of pressures %",
)


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--refine", type=int, nargs="+", default=[18, 36], help="5e4 and 2e5 unknowns")
    options = parser.parse_args()
    fine = cylinder_case(FINE * max(options.refine))
    refined = {mu: run_signorini.run(fine, FINE * max(options.refine), mu, "auto").pressure for mu in FRICTION}
    rows: list[list[object]] = []
    verdicts: list[str] = []
    for refine in options.refine:
        case = cylinder_case(refine)
        for mu in FRICTION:
            results = list(_all(case, refine, mu))
            rows += [_row(result, case, mu, fine, refined[mu]) for result in results]
            verdicts += _verdict(results, case, mu)
    text = "\n\n".join([page.table(HEAD, rows), "\n".join(verdicts), _cold(max(options.refine)), *_said()])
    command.publish(options, "peers", text)


def _all(case: Case, refine: int, mu: float) -> list[Result]:
    results = []
    codes: list[tuple[Callable[[], str | None], Callable[[Case, float], Result]]] = [
        (run_calculix.missing, run_calculix.run),
        (run_getfem.missing, run_getfem.run),
    ]
    for missing, run in codes:
        reason = missing()
        if reason is None:
            results.append(middle(partial(run, case, mu)))
    for backend in ("multifrontal", *(["pardiso"] if available() else [])):
        results.append(run_signorini.run(case, refine, mu, backend))
    for result in results:
        print(f"{result.code}, {2 * len(case.points)} unknowns, mu {mu}: {result.solve_seconds:.2f} s", flush=True)
    return results


def _row(result: Result, case: Case, mu: float, fine: Case, refined: Array) -> list[object]:
    exact = np.interp(case.points[case.arc_nodes, 0], fine.points[fine.arc_nodes, 0], refined)
    weight = case.arc_lengths
    error = np.sqrt(weight @ (result.pressure - exact) ** 2 / (weight @ exact**2))
    return [
        result.code,
        2 * len(case.points),
        mu,
        page.seconds(result.input_seconds),
        page.seconds(result.assembly_seconds),
        page.seconds(result.solve_seconds),
        result.iterations,
        page.gigabytes(result.memory),
        f"{result.pressure[0]:.3f}",
        f"{100 * abs(result.pressure[0] / refined[0] - 1):.3f}",
        f"{100 * error:.2f}",
    ]


def _verdict(results: list[Result], case: Case, mu: float) -> list[str]:
    """How many times less than the better of the others."""
    others = [result for result in results if not result.code.startswith("signorini")]
    if not others:
        return []
    best = min(others, key=lambda result: result.solve_seconds)
    times = ", ".join(
        f"{best.solve_seconds / result.solve_seconds:.1f} times less with {result.code.removeprefix('signorini, ')}"
        for result in results
        if result not in others
    )
    return [f"- {2 * len(case.points)} unknowns, mu = {mu}: against {best.code} {times}."]


def _cold(refine: int) -> str:
    case = cylinder_case(refine)
    cold = run_signorini.run(case, refine, 0.4, "multifrontal", cold=True)
    phases = ("input", cold.input_seconds), ("assembly", cold.assembly_seconds), ("solve", cold.solve_seconds)
    return (
        f"Cold start of signorini, {2 * len(case.points)} unknowns, mu = 0.4, first process after installation: "
        f"{', '.join(f'{name} {page.seconds(value)}' for name, value in phases)} CPU seconds with all compilation; "
        "later processes load what it compiled."
    )


def _said() -> list[str]:
    missing = [reason for reason in (run_calculix.missing(), run_getfem.missing()) if reason is not None]
    return [*missing, f"CPU seconds, one thread, {page.machine()}."]


if __name__ == "__main__":
    main()
