# SPDX-License-Identifier: BSD-3-Clause
"""How smooth pressures are on surfaces whose meshes do not match: the table of docs/contact_surfaces.md.

python -m benchmarks.contact_surfaces
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.page import table, write
from signorini.engine.solve import solve
from signorini.gallery.press_fit import press_fit
from signorini.meshing.plane import Cells
from signorini.model.contact import Contact
from signorini.reference.lame import press_fit_pressure

PAGE = Path(__file__).parent.parent / "docs" / "contact_surfaces.md"
HEAD = ("facets on the shaft (nonmortar) : hub", "cells", "coupling", "mean pressure, error", "largest error")
EXACT = press_fit_pressure(
    inner=1.0, interface=2.0, outer=3.0, interference=0.01, inner_body=(2000.0, 0.3), outer_body=(1000.0, 0.3),
    plane_strain=False,
)  # fmt: skip


def row(along: tuple[int, int], cells: Cells, coupling: str) -> tuple[str, ...]:
    """One fit: errors of the pressure against Lame's."""
    model = press_fit(n_radial=8, n_angular=along, cells=cells)
    fit: Contact = replace(model.contacts[0], coupling=coupling)  # type: ignore[arg-type]
    contact = solve(replace(model, contacts=[fit])).contact("fit")
    mean = float(contact.pressure @ contact.area / contact.area.sum()) / EXACT - 1.0
    worst = float(np.abs(contact.pressure / EXACT - 1.0).max())
    return f"{along[0]} : {along[1]}", cells, contact.coupling, f"{100 * mean:.2f} %", f"{100 * worst:.2f} %"


def main() -> None:
    """Measure and write."""
    cases = ((24, 24), (24, 36), (36, 24), (16, 48), (48, 16))
    rows = [row(along, cells, "mortar") for cells in ("quad", "quad8") for along in cases]
    rows += [row(along, "quad", "node-to-segment") for along in ((24, 36), (36, 24))]
    text = table(HEAD, rows)
    print(text)
    write("press fit", text, PAGE)


if __name__ == "__main__":
    main()
