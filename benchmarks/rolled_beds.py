# SPDX-License-Identifier: BSD-3-Clause
"""A wheel that rolls over a bed that yields, below and above its shakedown limit; writes a table and a picture.

    python -m benchmarks.rolled_beds [--cells 3] [--strokes 6] [--dry]
    python -m benchmarks.rolled_beds --finer 2 3 4 [--dry]    # below and above the limit, on finer and finer cells

By contact: the wheel is rigid, rolls to and fro without friction, and pairs follow it (`sliding="finite"`). Told is
what a stroke adds to the plastic work in the middle of the way, to where the contact at either end does not reach.
"""

from __future__ import annotations

from collections.abc import Sequence
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
BELOW, ABOVE = 3.6, 4.4
"""p_0 over k, on either side of the limit."""
SURFACE = 1.0 / 3.0
"""Of a half-width: the depth down to which pressures of single pairs are felt, the largest shear is at 0.78."""


def added(part: float, n: int, strokes: int) -> tuple[Array, float, Array]:
    """(strokes,) Plastic work of strokes in the middle, the largest plastic strain, and (strokes,) work farther down.

    Parameters
    ----------
    part : p_0 over k
    n : cells in a half-width
    strokes : how many
    """
    model = rolled_bed(part * SHEAR_STRENGTH, n=n, run=RUN, strokes=strokes)
    steps = solve(model).steps[1:]
    points = prepare(model).yielding
    x, y = points.places().T
    middle = points.weights * (np.abs(x) < MIDDLE) * np.sqrt(3.0) * SHEAR_STRENGTH
    strains = np.array([step.plastic.state.equivalent for step in steps])
    grown = np.diff(strains, axis=0)
    return grown @ middle, float(steps[-1].yielding.largest), grown @ (middle * (y < -SURFACE))


def finer(cells: Sequence[int], strokes: int) -> str:
    """Of the document: what strokes add below and above the limit, by cells in a half-width."""
    rows = []
    for n in cells:
        (below, _, deep), (above, _, _) = (added(part, n, strokes) for part in (BELOW, ABOVE))
        rows.append(
            [str(n), *(f"{work:.1e}" for work in (below[1], below[-1], deep[1], deep[-1], above[1], above[-1]))]
        )
        print(*rows[-1], flush=True)
    head = ["cells", f"{BELOW:g} k: stroke 2", f"stroke {strokes}", "deeper: stroke 2", f"stroke {strokes}"]
    return page.table([*head, f"{ABOVE:g} k: stroke 2", f"stroke {strokes}"], rows)


def main() -> None:
    """Print the table, and write it and the picture unless the page is to stay."""
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--cells", type=int, default=3, help="in a half-width")
    parser.add_argument("--strokes", type=int, default=6)
    parser.add_argument("--finer", type=int, nargs="+", help="cells in a half-width, one after the other")
    options = parser.parse_args()
    if options.finer:
        command.publish(
            options, "plasticity rolling finer", finer(options.finer, options.strokes), DOCS / "plasticity.md"
        )
        return
    figure = Figure(figsize=(6.0, 3.6), layout="constrained")
    axes = figure.subplots()
    rows = []
    for part in PARTS:
        work, strain, _ = added(part, options.cells, options.strokes)
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
