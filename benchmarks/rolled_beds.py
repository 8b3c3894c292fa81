# SPDX-License-Identifier: BSD-3-Clause
"""A wheel that rolls over a bed that yields, below and above its shakedown limit; writes a table and a picture.

    python -m benchmarks.rolled_beds [--cells 3] [--strokes 6] [--dry]

By contact: the wheel is rigid, rolls to and fro without friction, and pairs follow it (`sliding="finite"`). Told is
what a stroke adds to the plastic work in the middle of the way, to where the contact at either end does not reach.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks import command, page
from signorini.api import solve
from signorini.arrays import Array
from signorini.engine.prepare import prepare
from signorini.gallery.rolled_beds import rolled_bed
from signorini.gallery.yielding import SHEAR_STRENGTH

DOCS = Path(__file__).parent.parent / "docs"
PARTS = (3.6, 4.0, 4.2, 4.4)
"""p_0 over k."""
RUN = 3.0
"""Half a stroke, over the half-width of the elastic contact."""
MIDDLE = RUN - 1.5


def added(part: float, n: int, strokes: int) -> tuple[Array, float]:
    """(strokes,) Plastic work that every stroke adds in the middle, and the largest equivalent plastic strain.

    Parameters
    ----------
    part : p_0 over k
    n : cells in a half-width
    strokes : how many
    """
    model = rolled_bed(part * SHEAR_STRENGTH, n=n, run=RUN, strokes=strokes)
    steps = solve(model).steps[1:]
    points = prepare(model).yielding
    middle = points.weights * (np.abs(points.places()[:, 0]) < MIDDLE) * np.sqrt(3.0) * SHEAR_STRENGTH
    strains = np.array([step.plastic.state.equivalent for step in steps])
    return np.diff(strains, axis=0) @ middle, float(steps[-1].yielding.largest)


def main() -> None:
    """Print the table, and write it and the picture unless the page is to stay."""
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--cells", type=int, default=3, help="in a half-width")
    parser.add_argument("--strokes", type=int, default=6)
    options = parser.parse_args()
    figure = Figure(figsize=(6.0, 3.6), layout="constrained")
    axes = figure.subplots()
    rows = []
    for part in PARTS:
        work, strain = added(part, options.cells, options.strokes)
        rows.append([f"{part:g}", *(f"{one:.2e}" for one in work), f"{strain:.4f}"])
        print(*rows[-1], flush=True)
        axes.semilogy(np.arange(1, len(work) + 1), work, "o-", label=f"$p_0$ = {part:g} k")
    axes.set_xlabel("stroke")
    axes.set_ylabel("plastic work that it adds in the middle")
    axes.legend()
    head = ["p_0 / k", *(f"stroke {k + 1}" for k in range(options.strokes)), "largest peeq"]
    command.publish(options, "plasticity rolling", page.table(head, rows), DOCS / "plasticity.md")
    if not options.dry:
        figure.savefig(DOCS / "figures" / "rolled_bed.png", dpi=120)


if __name__ == "__main__":
    main()
