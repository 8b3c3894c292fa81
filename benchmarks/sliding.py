# SPDX-License-Identifier: BSD-3-Clause
"""What it costs to pair sides anew where they have slid to, over a factorisation of the bodies: plane, two bodies.

    python -m benchmarks.sliding [--spacing 0.02 0.01 ...] [--page]     (--page writes docs/sliding.md)

Medians of CPU seconds on one thread; a stride pairs in its middle and at its end and condenses once.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks import page
from signorini.engine.prepare import prepare
from signorini.engine.sliding import paired
from signorini.gallery.sliding import dragged_cylinder
from signorini.interface.sliding import paired_at
from signorini.linalg.registry import factorise
from signorini.linalg.threads import one_thread

_PAGE = Path(__file__).parent.parent / "docs" / "sliding.md"
_HEAD = ("unknowns", "pairs", "kept", "factorisation, s", "pairing, s", "condensing, s", "stride / factorisation")
_REPEATS = 7
_STROKE = 0.5  # mm, half of the half-width


def seconds(work: Callable[[], object]) -> float:
    """CPU seconds, the median of several runs."""
    taken = []
    for _ in range(_REPEATS):
        begin = time.process_time()
        work()
        taken.append(time.process_time() - begin)
    return median(taken)


@one_thread()
def row(spacing: float) -> list[object]:
    """A line of the table."""
    prepared = prepare(dragged_cylinder(stroke=_STROKE, spacing=spacing))
    model, space, constraints = prepared.model, prepared.space, prepared.constraints
    T = constraints.transform
    reduced, condensed = (T.T @ prepared.K @ T).tocsr(), prepared.paths.condensed
    away = np.zeros(space.number_of_dofs)
    away[space.dofs(model.mesh.nodes_of("pad.arc"))[:, 0]] = 0.3 * spacing

    def solved() -> object:
        return factorise(reduced, condensed.dofs, nodes=constraints.nodes, points=space.places)

    def pairing() -> object:
        return paired_at(prepared.interface, space, model, constraints, away)

    interface = paired_at(prepared.interface, space, model, constraints, away)
    whole, pairs, condensing = seconds(solved), seconds(pairing), seconds(lambda: paired(prepared, interface))
    stride = 2.0 * pairs + condensing
    sizes = [T.shape[1], len(interface), len(condensed.dofs)]
    return [*sizes, f"{whole:.3f}", f"{pairs:.4f}", f"{condensing:.4f}", f"{stride / whole:.2f}"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--spacing", type=float, nargs="+", default=[0.04, 0.02, 0.01, 0.005])
    parser.add_argument("--page", action="store_true", help="write the table into docs/sliding.md")
    given = parser.parse_args()
    text = f"{page.table(_HEAD, [row(spacing) for spacing in given.spacing])}\n\nCPU seconds, {page.machine()}."
    print(text)
    if given.page:
        page.write("sliding", text, _PAGE)


if __name__ == "__main__":
    main()
