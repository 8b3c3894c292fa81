# SPDX-License-Identifier: BSD-3-Clause
"""B17: a sector for the whole."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from signorini.api import solve
from signorini.gallery.sectors import SECTORS, ring_on_pads, ring_on_shaft
from signorini.model.model import Model
from signorini.verify.check import Check, checks_of


def ring_and_sector() -> Iterator[Check]:
    """A ring on six pads with friction, and one sixth of it with cyclic symmetry."""
    yield from _beside_the_whole("B17 a sixth of a ring on pads", ring_on_pads)


def contact_that_sectors_cut() -> Iterator[Check]:
    """A ring that is shrunk on a shaft and slips on it where sectors are cut, and one sixth of it."""
    yield from _beside_the_whole("B17 a sixth of a ring on a shaft", ring_on_shaft)


def _beside_the_whole(name: str, made: Callable[..., Model]) -> Iterator[Check]:
    whole, sector = (solve(made(whole=every)).steps[-1] for every in (True, False))
    one, own = whole.contacts[0], sector.contacts[0]
    at = [int(np.argmin(np.linalg.norm(one.points - point, axis=1))) for point in own.points]
    pressure, traction = one.pressure[at], one.traction[at]
    drag = np.abs(one.traction).max()
    yield from checks_of(
        name,
        ("pressures, of the largest", np.abs(own.pressure - pressure).max() / one.pressure.max(), 0.0, 1e-9),
        ("tractions, of the largest", np.abs(own.traction - traction).max() / drag, 0.0, 1e-9),
        ("strain energy, of that of the ring", SECTORS * sector.strain_energy / whole.strain_energy, 1.0, 1e-9),
        ("dissipation, of that of the ring", SECTORS * sector.dissipation / whole.dissipation, 1.0, 1e-9),
        source="the whole ring",
    )
