# SPDX-License-Identifier: BSD-3-Clause
"""The price of contact over sizes: the benchmark "cylinder" in CPU seconds; writes a table of docs/performance.md.

python -m benchmarks.ratio [--dofs 5000 50000 200000 1000000] [--dry]

PARDISO is left out where pypardiso is missing.
"""

from __future__ import annotations

import itertools
import json
import time
from typing import Any

from benchmarks import command, page
from signorini.bench.models import cylinder_ratios
from signorini.linalg.pardiso import available

HEAD = (
    "unknowns",
    "mu",
    "contact pairs",
    "iterations",
    "assembly s",
    "contact s",
    "linear s",
    "contact / linear",
    "with assembly",
    "PARDISO's linear s",
    "with assembly / PARDISO's",
    "memory GB",
)


def row(found: dict[str, Any]) -> list[object]:
    """A line of the table; assembly is added to what is compared, not to what it is compared with."""
    whole = found["assembly_seconds"] + found["contact_seconds"]
    pardiso = found.get("other_seconds")
    return [
        found["dofs"],
        found["friction"],
        found["contact_pairs"],
        found["iterations"],
        *(page.seconds(found[f"{what}_seconds"]) for what in ("assembly", "contact", "linear")),
        f"{found['ratio']:.2f}",
        f"{whole / found['linear_seconds']:.2f}",
        *(["", ""] if pardiso is None else [page.seconds(pardiso), f"{whole / pardiso:.2f}"]),
        page.gigabytes(found["peak_memory_bytes"]),
    ]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--dofs", type=int, nargs="+", default=[5_000, 50_000, 200_000, 1_000_000])
    parser.add_argument("--friction", type=float, nargs="+", default=[0.0, 0.4])
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        case = {"frictions": options.friction, "other": "pardiso" if available() else None}
        print(json.dumps(list(cylinder_ratios(options.dofs[0], timer=time.process_time, **case))))
        return
    cases = itertools.product(options.dofs, options.friction)
    found = [page.measured("benchmarks.ratio", "--dofs", dofs, "--friction", mu)[0] for dofs, mu in cases]
    backends = ", ".join(dict.fromkeys(row["backend"] for row in found))
    text = (
        f"{page.table(HEAD, [row(each) for each in found])}\n\nCPU seconds, one thread, {backends}, {page.machine()}."
    )
    command.publish(options, "ratio", text)


if __name__ == "__main__":
    main()
