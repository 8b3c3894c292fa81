# SPDX-License-Identifier: BSD-3-Clause
"""LCP solvers against each other in one run: times, ratios, success over the bank, and a large obstacle problem.

    OMP_NUM_THREADS=1 python -m benchmarks.lcp             # n = 30, 300, 1000, bank
    OMP_NUM_THREADS=1 python -m benchmarks.lcp --large     # n = 3000 too, and the obstacle problem with 10^6 unknowns

QuantEcon, lemkelcp (PyPI) and Siconos (Debian's python3-siconos) are measured where they are installed. Times are CPU
seconds, taken in turn, solver after solver, round after round. Every answer is judged by the natural residual of the
problem as posed, whoever gives it.
"""

from __future__ import annotations

import argparse
import importlib
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from benchmarks import lcp_problems as problems
from benchmarks.lcp_contact import cylinder, rough_block
from benchmarks.lcp_siconos import Siconos
from signorini import lcp
from signorini.arrays import Array

Solver = Callable[[problems.PosedLCP], Array | None]
Run = Callable[[problems.PosedLCP], tuple[float, Array | None]]

FAMILIES: dict[str, Callable[[int, np.random.Generator], problems.PosedLCP]] = {
    "random P": problems.random_p,
    "random PSD": lambda n, rng: problems.random_psd(n, n, rng, skew=0.3),
    "half-plane, force form": lambda n, rng: problems.frictional_contact(n // 3, rng),
    "FE block, force form": rough_block,
    "FE cylinder, gap-slip form": cylinder,
}


@dataclass(frozen=True, kw_only=True)
class Contender:
    """``run`` gives CPU seconds and z; ``largest`` n to try."""

    name: str
    run: Run
    largest: int = 10_000


def contenders() -> list[Contender]:
    found = [
        Contender(
            name="ours: lemke", run=timed(lambda p: lcp.solve(p.M, p.q, method=lcp.Lemke(covering=p.covering)).z)
        ),
        Contender(name="ours: auto", run=timed(lambda p: lcp.solve(p.M, p.q).z)),
    ]
    for maker in (_quantecon, _lemkelcp, _siconos):
        try:
            found.append(maker())
        except ImportError as missing:
            print(f"not measured: {missing}")
    return found


def timed(solve: Solver) -> Run:
    def run(posed: problems.PosedLCP) -> tuple[float, Array | None]:
        start = time.process_time()
        z = solve(posed)
        return time.process_time() - start, z

    return run


def _quantecon() -> Contender:
    """Given the covering vector of the problem where there is one, as ours is."""
    module = importlib.import_module("quantecon.optimize")

    def solve(p: problems.PosedLCP) -> Array:
        return module.lcp_lemke(_dense(p), p.q, d=p.covering, max_iter=10**6).z

    return Contender(name="quantecon", run=timed(solve))


def _lemkelcp() -> Contender:
    module = importlib.import_module("lemkelcp.lemkelcp")
    module.range = lambda *bounds: list(range(*bounds))  # release 0.1 assigns to ranges, which Python 2 allowed
    return Contender(
        name="lemkelcp", run=timed(lambda p: module.lemkelcp(_dense(p), p.q, maxIter=10_000)[0]), largest=300
    )


def _siconos() -> Contender:
    process = Siconos()
    return Contender(name="siconos lemke", run=lambda p: process.solve(_dense(p), p.q))


def _dense(posed: problems.PosedLCP) -> Array:
    return posed.M.toarray() if sp.issparse(posed.M) else np.ascontiguousarray(posed.M)


def is_right(posed: problems.PosedLCP, z: Array | None) -> bool:
    """Solved to 1e-7, looser than our own tolerance so that nobody is refused for rounding."""
    if z is None or np.shape(z) != posed.q.shape or not np.isfinite(z).all():
        return False
    return lcp.natural_residual(posed.M, posed.q, np.asarray(z, dtype=float)).worst <= 1e-7


def compare(sizes: list[int], families: list[str], field: list[Contender], seeds: int) -> None:
    """Ratios are medians over the problems of the ratios of the medians over the rounds."""
    print("\n| problem | n | solver | right | median seconds | time / ours: lemke | least, most | time / ours: auto |")
    print("|---|---|---|---|---|---|---|---|")
    for n in sizes:
        cases_of = 1 if n > 1000 else seeds
        for family in families:
            cases = [FAMILIES[family](n, np.random.default_rng(seed)) for seed in range(cases_of)]
            running = [c for c in field if n <= c.largest]
            right, middle = {c.name: 0 for c in running}, {c.name: [] for c in running}
            for posed in cases:
                rounds = [{c.name: c.run(posed) for c in running} for _ in range(1 if n > 1000 else 5)]
                for name in middle:
                    middle[name].append(statistics.median(each[name][0] for each in rounds))
                    right[name] += is_right(posed, rounds[-1][name][1])
            for name, seconds in middle.items():
                ratios = [mine / ours for mine, ours in zip(seconds, middle["ours: lemke"], strict=True)]
                auto = [mine / ours for mine, ours in zip(seconds, middle["ours: auto"], strict=True)]
                print(
                    f"| {family} | {n} | {name} | {right[name]}/{len(cases)} | {statistics.median(seconds):.3g} "
                    f"| {statistics.median(ratios):.2f} | {min(ratios):.2f}, {max(ratios):.2f} "
                    f"| {statistics.median(auto):.2f} |",
                    flush=True,
                )


def bank_success(field: list[Contender]) -> None:
    bank = problems.bank()
    solvable = [p for p in bank if p.solvable]
    print("\n| solver | solvable problems of the bank solved | unsolvable ones claimed solved |")
    print("|---|---|---|")
    for c in field:
        good = [p.name for p in solvable if is_right(p, c.run(p)[1])]
        false = [p.name for p in bank if not p.solvable and is_right(p, c.run(p)[1])]
        print(f"| {c.name} | {len(good)}/{len(solvable)} | {len(false)}/{len(bank) - len(solvable)} |", flush=True)
    named = {p.name: lcp.solve(p.M, p.q).status.name for p in bank if not p.solvable}
    print("\nThe unsolvable ones, as ours: auto names them:", "; ".join(f"{k}: {v}" for k, v in named.items()))


def large_obstacle() -> None:
    posed = problems.obstacle(1000)
    start = time.process_time()
    solution = lcp.solve(posed.M, posed.q)
    seconds = time.process_time() - start
    print(f"\nobstacle, n = {posed.n}: {solution.status.name} by {solution.method} in {seconds:.1f} CPU s, ", end="")
    print(f"natural residual {solution.residual.worst:.1e}, {(solution.z == 0).mean():.1%} in contact")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="also n = 3000 and the obstacle problem (minutes)")
    parser.add_argument("--sizes", type=int, nargs="*", default=[30, 300, 1000])
    parser.add_argument("--seeds", type=int, default=9, help="problems of each kind to n = 1000; 1 beyond")
    parser.add_argument("--no-bank", action="store_true", help="leave out the success over the bank")
    parser.add_argument("--families", nargs="*", default=list(FAMILIES), choices=list(FAMILIES))
    options = parser.parse_args()
    field = contenders()
    rng = np.random.default_rng(0)
    for c in field:  # machine code, with and without a covering vector
        c.run(problems.random_p(5, rng))
        c.run(problems.gap_slip_contact(2, rng))
    if not options.no_bank:
        bank_success(field)
    if options.large:
        large_obstacle()
    compare([*options.sizes, 3000] if options.large else options.sizes, options.families, field, options.seeds)


if __name__ == "__main__":
    main()
