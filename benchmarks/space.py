# SPDX-License-Identifier: BSD-3-Clause
"""The price of contact in space: a cube on a cube, matching and not, over sizes; a table of docs/performance.md.

python -m benchmarks.space [--dofs 30000 100000 300000] [--dry]
"""

from __future__ import annotations

import json
import time
from typing import Any

from benchmarks import command, page
from signorini.bench.models import cube_ratios

LARGE = 200_000
"""Unknowns from which one run has to do."""
REPEATS = 31
"""Of shorter runs, as many as fit into some forty seconds: one differs from the next by a tenth."""
PHASES = ("factorisation", "condensation", "complementarity", "recovery")
HEAD = (
    "problem",
    "way",
    "unknowns",
    "contact pairs",
    "iterations",
    "assembly s",
    *(f"{name} s" for name in PHASES),
    "contact s",
    "linear s",
    "contact / linear",
    "memory GB",
)


def measure(dofs: int) -> list[dict[str, Any]]:
    """The rows of one size, from a process of its own."""
    rows = page.measured("benchmarks.space", "--dofs", dofs)
    for row in rows:
        print(f"{row['name']}, {row['backend']}, {row['dofs']} unknowns: {row['ratio']:.2f}", flush=True)
    return rows


def row(found: dict[str, Any]) -> list[object]:
    """A line of the table."""
    phases = [page.seconds(found["phases"][name]) if found["phases"] else "" for name in PHASES]
    memory = found["peak_memory_bytes"]
    return [
        found["name"],
        found["backend"],
        found["dofs"],
        found["contact_pairs"],
        found["iterations"],
        page.seconds(found["assembly_seconds"]),
        *phases,
        *(page.seconds(found[f"{name}_seconds"]) for name in ("contact", "linear")),
        f"{found['ratio']:.2f}",
        "" if memory is None else page.gigabytes(memory),
    ]


def growth(found: list[dict[str, Any]]) -> str:
    """Exponents of the power laws in the unknowns that fit best."""
    said = []
    condensed = [each for each in found if each["default"]]
    for name in dict.fromkeys(each["name"] for each in condensed):
        own = [each for each in condensed if each["name"] == name]
        sizes = [each["dofs"] for each in own]
        fits = [command.exponent(sizes, [each[f"{key}_seconds"] for each in own]) for key in ("contact", "linear")]
        said.append(f"{name} {fits[0]:.2f} and {fits[1]:.2f}")
    return f"Exponents of contact and linear in the unknowns, condensed: {'; '.join(said)}."


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--dofs", type=int, nargs="+", default=[30_000, 100_000, 300_000])
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        (dofs,) = options.dofs
        print(json.dumps(list(cube_ratios(dofs, timer=time.process_time, repeats=1 if dofs > LARGE else REPEATS))))
        return
    found = [row for dofs in options.dofs for row in measure(dofs)]
    lines = [page.table(HEAD, [row(each) for each in found])]
    if len(options.dofs) > 1:
        lines.append(growth(found))
    lines.append(f"mu = 0.3, one increment; CPU seconds, one thread, {page.machine()}; iterated: one run.")
    text = "\n\n".join(lines)
    command.publish(options, "space", text)


if __name__ == "__main__":
    main()
