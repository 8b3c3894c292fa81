# SPDX-License-Identifier: BSD-3-Clause
"""What it costs to pair sides anew where they have slid to, over a factorisation of the bodies: plane, two bodies.

    python -m benchmarks.sliding [--spacing 0.02 0.01 ...] [--page]     (--page writes docs/sliding.md)

Medians of CPU seconds on one thread; a stride pairs once and condenses once.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np

import signorini as sg
from benchmarks import page
from signorini.blas_threads import one_thread
from signorini.engine.prepare import prepare
from signorini.engine.stride_pairs import paired
from signorini.gallery.sliding import dragged_cylinder
from signorini.interface.interface import Interface
from signorini.interface.mean_pairs import MeanPairs
from signorini.interface.sliding import paired_at
from signorini.linalg.registry import factorise

_PAGE = Path(__file__).parent.parent / "docs" / "sliding.md"
_HEAD = (
    "model",
    "unknowns",
    "pairs",
    "kept",
    "factorisation, s",
    "pairing, s",
    "condensing, s",
    "stride / factorisation",
)
_FACETS = 360  # of the block: 2e5 unknowns
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


def block(facets: int) -> sg.Model:
    """A block on a bed, meshed evenly, of which the contact is a small part."""
    cell = 2.0 / facets
    top = sg.rectangle(width=2.0, height=1.0, nx=facets, ny=facets // 6)
    bed = sg.rectangle(width=3.5, height=1.0, nx=4 * facets // 3, ny=4 * facets // 9, origin=(-0.75 + 0.3 * cell, -1.0))
    steel = sg.Elastic(E=200.0, nu=0.3)
    return sg.Model(
        sg.join({"pad": top, "flat": bed}),
        bodies=[sg.Body("pad", steel), sg.Body("flat", steel)],
        supports=[sg.Support("flat.bottom", u=(0.0, 0.0)), sg.Support("pad.top", u=(0.1, None), name="drag")],
        loads=[sg.Load("pad.top", force=(None, -1.0), spread="displacement", name="press")],
        contacts=[sg.Contact("pad.bottom", "flat.top", friction=0.3, sliding="finite")],
    )


@one_thread()
def row(name: str, given: sg.Model, away_by: float) -> list[object]:
    """A line of the table: a model whose first contact slides by a distance."""
    prepared = prepare(given)
    model, space, constraints = prepared.model, prepared.space, prepared.constraints
    T = constraints.transform
    reduced, condensed = (T.T @ prepared.K @ T).tocsr(), prepared.paths.condensed
    away = np.zeros(space.number_of_dofs)
    away[space.dofs(model.mesh.nodes_of(model.contacts[0].nonmortar))[:, 0]] = away_by

    def solved() -> object:
        return factorise(reduced, condensed.dofs, nodes=constraints.nodes, points=space.places)

    def pairing() -> Interface:
        there = paired_at(prepared.interface, space, model, constraints, prepared.frames, away)
        return MeanPairs.between(prepared.interface, there, away, np.zeros(len(there)), least=0.0).interface

    interface = pairing()
    whole, pairs, condensing = seconds(solved), seconds(pairing), seconds(lambda: paired(prepared, interface))
    stride = pairs + condensing
    sizes = [T.shape[1], len(interface), len(condensed.dofs)]
    return [name, *sizes, f"{whole:.3f}", f"{pairs:.4f}", f"{condensing:.4f}", f"{stride / whole:.2f}"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--spacing", type=float, nargs="+", default=[0.04, 0.02, 0.01, 0.005])
    parser.add_argument("--page", action="store_true", help="write the table into docs/sliding.md")
    given = parser.parse_args()
    rows = [
        row("cylinder", dragged_cylinder(stroke=_STROKE, spacing=spacing), 0.3 * spacing) for spacing in given.spacing
    ]
    rows.append(row("block", block(_FACETS), 0.6 / _FACETS))
    text = f"{page.table(_HEAD, rows)}\n\nCPU seconds, {page.machine()}."
    print(text)
    if given.page:
        page.write("sliding", text, _PAGE)


if __name__ == "__main__":
    main()
