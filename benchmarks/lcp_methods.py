# SPDX-License-Identifier: BSD-3-Clause
"""Run every method on every problem of the bank and write the table of docs/choosing_an_lcp_method.md.

python -m benchmarks.lcp_methods
"""

from __future__ import annotations

import time
from pathlib import Path

import scipy.sparse as sp

from benchmarks import lcp_problems as problems
from signorini import lcp

PAGE = Path(__file__).parent.parent / "docs" / "choosing_an_lcp_method.md"
BEGIN, END = "<!-- table written by benchmarks/lcp_methods.py -->\n", "<!-- end of table -->\n"
TRAITS = ("P", "monotone", "symmetric", "contact", "other")


def traits(problem: problems.PosedLCP) -> set[str]:
    return set(problem.traits & set(TRAITS)) or {"other"}


def row(name: str, bank: list[problems.PosedLCP]) -> str:
    tried, solved, false = dict.fromkeys(TRAITS, 0), dict.fromkeys(TRAITS, 0), 0
    start = time.perf_counter()
    for problem in bank:
        method = lcp.Lemke(covering=problem.covering) if name == "lemke" else name
        solution = lcp.solve(problem.M, problem.q, method=method)
        if not problem.solvable:
            false += solution.solved
            continue
        for trait in traits(problem):
            tried[trait] += 1
            solved[trait] += solution.solved
    seconds = time.perf_counter() - start
    meant_for = "what its chain allows" if name == "auto" else lcp.METHODS[name].matrices
    cells = " | ".join(f"{solved[trait]}/{tried[trait]}" for trait in TRAITS)
    return f"| {name} | {meant_for} | {cells} | {false} | {seconds:.1f} |"


def main() -> None:
    bank = problems.bank()
    head = f"| method | meant for | {' | '.join(TRAITS)} | false claims | seconds, whole bank |"
    lcp.solve(sp.eye_array(3).tocsr(), [-1.0] * 3, method="projected-sor")  # compiles
    lines = [head, "|" + "---|" * (len(TRAITS) + 4), *(row(name, bank) for name in ("auto", *lcp.METHODS))]
    unsolvable = sum(not problem.solvable for problem in bank)
    lines.append(f"\n{len(bank)} problems, {unsolvable} of them without a solution.")
    before, after = PAGE.read_text().split(BEGIN)[0], PAGE.read_text().split(END)[1]
    PAGE.write_text(before + BEGIN + "\n".join(lines) + "\n" + END + after)
    print("\n".join(lines))


if __name__ == "__main__":
    main()
