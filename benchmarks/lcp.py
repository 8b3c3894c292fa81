# SPDX-License-Identifier: BSD-3-Clause
"""LCP solvers against each other in one run: times, ratios, success over the bank, and a large obstacle problem.

    python benchmarks/lcp.py                 # n = 30, 300, bank
    python benchmarks/lcp.py --large         # n = 3000 too, and the obstacle problem with 10^6 unknowns

QuantEcon, lemkelcp and Siconos are measured where they can be imported. Every answer is judged by the natural residual
of the problem as posed, whoever gives it.
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

from signorini import lcp
from signorini.arrays import Array
from signorini.lcp import problems

Solver = Callable[[problems.PosedLCP], Array | None]

FAMILIES: dict[str, Callable[[int, np.random.Generator], problems.PosedLCP]] = {
    "random P": problems.random_p,
    "random PSD": lambda n, rng: problems.random_psd(n, n, rng, skew=0.3),
    "frictional contact": lambda n, rng: problems.frictional_contact(n // 3, rng),
}


@dataclass(frozen=True, kw_only=True)
class Contender:
    name: str
    solve: Solver
    largest: int = 10_000


def contenders() -> list[Contender]:
    found = [
        Contender(name="ours: lemke", solve=lambda p: lcp.solve(p.M, p.q, method=lcp.Lemke(covering=p.covering)).z),
        Contender(name="ours: auto", solve=lambda p: lcp.solve(p.M, p.q).z),
    ]
    makers = {"quantecon.optimize": _quantecon, "lemkelcp.lemkelcp": _lemkelcp, "siconos.numerics": _siconos}
    for module, maker in makers.items():
        try:
            found.append(maker(importlib.import_module(module)))
        except ImportError as missing:
            print(f"not measured: {missing}")
    return found


def _quantecon(module) -> Contender:
    return Contender(name="quantecon", solve=lambda p: module.lcp_lemke(_dense(p), p.q, max_iter=10**6).z)


def _lemkelcp(module) -> Contender:
    module.range = lambda *bounds: list(range(*bounds))  # release 0.1 assigns to ranges, which Python 2 allowed
    return Contender(name="lemkelcp", solve=lambda p: module.lemkelcp(_dense(p), p.q, maxIter=10_000)[0], largest=300)


def _siconos(module) -> Contender:
    def solve(p: problems.PosedLCP) -> Array:
        z, w = np.zeros(p.n), np.zeros(p.n)
        options = module.SolverOptions(module.SICONOS_LCP_LEMKE)
        options.iparam[0] = 10**6
        module.linearComplementarity_driver(module.LCP(_dense(p), p.q), z, w, options)
        return z

    return Contender(name="siconos lemke", solve=solve)


def _dense(posed: problems.PosedLCP) -> Array:
    return posed.M.toarray() if sp.issparse(posed.M) else np.ascontiguousarray(posed.M)


def is_right(posed: problems.PosedLCP, z: Array | None) -> bool:
    """Solved to 1e-7, looser than our own tolerance so that nobody is refused for rounding."""
    if z is None or np.shape(z) != posed.q.shape or not np.isfinite(z).all():
        return False
    return lcp.natural_residual(posed.M, posed.q, np.asarray(z, dtype=float)).worst <= 1e-7


def timed(solve: Solver, posed: problems.PosedLCP) -> tuple[float, Array | None]:
    start = time.perf_counter()
    z = solve(posed)
    return time.perf_counter() - start, z


def compare(sizes: list[int], field: list[Contender]) -> None:
    print("\n| problem | n | solver | right | median seconds | time / ours: lemke | time / ours: auto |")
    print("|---|---|---|---|---|---|---|")
    for n in sizes:
        for family, make in FAMILIES.items():
            cases = [make(n, np.random.default_rng(seed)) for seed in range(1 if n > 1000 else 5)]
            running = [c for c in field if n <= c.largest]
            times: dict[str, list[float]] = {c.name: [] for c in running}
            right = dict.fromkeys(times, 0)
            for posed in cases:
                answers: dict[str, Array | None] = {}
                for _ in range(1 if n > 1000 else 3):
                    for c in running:
                        seconds, answers[c.name] = timed(c.solve, posed)
                        times[c.name].append(seconds)
                for name, z in answers.items():
                    right[name] += is_right(posed, z)
            middle = {name: statistics.median(seconds) for name, seconds in times.items()}
            for name, seconds in middle.items():
                ratios = f"{seconds / middle['ours: lemke']:.2f} | {seconds / middle['ours: auto']:.2f}"
                print(
                    f"| {family} | {n} | {name} | {right[name]}/{len(cases)} | {seconds:.4g} | {ratios} |", flush=True
                )


def bank_success(field: list[Contender]) -> None:
    bank = problems.bank()
    solvable = [p for p in bank if p.solvable]
    print("\n| solver | solvable problems of the bank solved | unsolvable ones claimed solved |")
    print("|---|---|---|")
    for c in field:
        good = [p.name for p in solvable if is_right(p, c.solve(p))]
        false = [p.name for p in bank if not p.solvable and is_right(p, c.solve(p))]
        print(f"| {c.name} | {len(good)}/{len(solvable)} | {len(false)}/{len(bank) - len(solvable)} |", flush=True)
    named = {p.name: lcp.solve(p.M, p.q).status.name for p in bank if not p.solvable}
    print("\nThe unsolvable ones, as ours: auto names them:", "; ".join(f"{k}: {v}" for k, v in named.items()))


def large_obstacle() -> None:
    posed = problems.obstacle(1000)
    start = time.perf_counter()
    solution = lcp.solve(posed.M, posed.q)
    seconds = time.perf_counter() - start
    print(f"\nobstacle, n = {posed.n}: {solution.status.name} by {solution.method} in {seconds:.1f} s, ", end="")
    print(f"natural residual {solution.residual.worst:.1e}, {(solution.z == 0).mean():.1%} in contact")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="also n = 3000 and the obstacle problem (minutes)")
    parser.add_argument("--sizes", type=int, nargs="*", default=[30, 300])
    options = parser.parse_args()
    field = contenders()
    warm = problems.random_p(5, np.random.default_rng(0))
    for c in field:
        c.solve(warm)
    bank_success(field)
    if options.large:
        large_obstacle()
    compare([*options.sizes, 3000] if options.large else options.sizes, field)


if __name__ == "__main__":
    main()
