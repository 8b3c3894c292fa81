# SPDX-License-Identifier: BSD-3-Clause
"""B17: a sector for the whole."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.api import solve
from signorini.gallery.sectors import SECTORS, ring_on_pads
from signorini.verify.check import Check, checks_of


def ring_and_sector() -> Iterator[Check]:
    """A ring on six pads with friction, and one sixth of it with cyclic symmetry."""
    whole, sector = (solve(ring_on_pads(whole=every)).steps[-1] for every in (True, False))
    one, own = whole.contacts[0], sector.contacts[0]
    drag = np.abs(one.traction).max()
    yield from checks_of(
        "B17 a sixth of a ring on pads",
        ("pressures, of the largest", np.abs(own.pressure - one.pressure).max() / one.pressure.max(), 0.0, 1e-9),
        (
            "tractions, of the largest",
            np.abs(own.traction - one.traction).max() / drag,
            0.0,
            1e-9,
        ),
        ("strain energy, of that of the ring", SECTORS * sector.strain_energy / whole.strain_energy, 1.0, 1e-9),
        ("dissipation, of that of the ring", SECTORS * sector.dissipation / whole.dissipation, 1.0, 1e-9),
        source="the whole ring",
    )
