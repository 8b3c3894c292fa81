# SPDX-License-Identifier: BSD-3-Clause
"""How wrong increments are where contact grows under friction: the paper's cylinder against its exact path.

    python -m benchmarks.increments [--dry]

Writes the table of docs/exact_paths.md. Loads grow in proportion, or as (i/n)^2.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks import command, page
from signorini.engine.solve import solve
from signorini.errors import SolveFailed
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.step import Step
from signorini.solution.results import ContactResult

FRICTION = 0.4
NUMBERS = (1, 10, 30, 100, 300)
MESHES = (1, 4, 8)
PAGE = Path(__file__).parent.parent / "docs" / "exact_paths.md"


def exact(refine: int) -> ContactResult:
    """The end of the path."""
    return solve(zhu_cylinder(friction=FRICTION, refine=refine, steps=[Step(path="exact")])).contact("foundation")


def errors(refine: int, true: ContactResult, factors: list[float]) -> list[str]:
    """Largest error of the pressure over p(0) and of the friction over mu p(0); by increments that end at factors."""
    model = zhu_cylinder(friction=FRICTION, refine=refine, steps=[Step(scale={"cut": factors}, increments=1)])
    try:
        found = solve(model).contact("foundation")
    except SolveFailed as failure:
        return [failure.status, ""]
    most = float(true.pressure.max())
    wrong = np.abs(found.pressure - true.pressure).max() / most
    tangential = np.abs(found.traction - true.traction).max() / (FRICTION * most)
    return [f"{wrong:.1e}", f"{tangential:.1e}"]


def table() -> str:
    """The whole table."""
    true = {refine: exact(refine) for refine in MESHES}
    rows = []
    for number in NUMBERS:
        even = [i / number for i in range(1, number + 1)]
        row = [str(number)]
        for refine in MESHES:
            row += errors(refine, true[refine], even)
        rows.append(row + errors(MESHES[1], true[MESHES[1]], [s**2 for s in even]))
        print(*row, flush=True)
    head = ["increments", *(f"{len(true[r].node)} pairs: {what}" for r in MESHES for what in "pq")]
    head += [f"{len(true[MESHES[1]].node)} pairs, loads (i/n)^2: {what}" for what in "pq"]
    return page.table(head, rows)


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    options = parser.parse_args()
    text = table()
    command.publish(options, "increments", text, PAGE)


if __name__ == "__main__":
    main()
