# SPDX-License-Identifier: BSD-3-Clause
"""Press fits against Lame."""

from __future__ import annotations

from collections.abc import Iterator

from signorini.gallery.press_fit import press_fit
from signorini.model.model import Kind
from signorini.reference.lame import press_fit_pressure
from signorini.solve import solve
from signorini.verify.check import Check


def press_fit_plane_stress() -> Iterator[Check]:
    """Two rings in plane stress."""
    return _press_fit("plane stress")


def press_fit_plane_strain() -> Iterator[Check]:
    """Two rings in plane strain."""
    return _press_fit("plane strain")


def _press_fit(kind: Kind) -> Iterator[Check]:
    pressure = solve(press_fit(kind=kind, n_radial=16, n_angular=48, friction=0.2)).contact("fit").pressure
    exact = press_fit_pressure(
        inner=1.0,
        interface=2.0,
        outer=3.0,
        interference=0.01,
        inner_body=(2000.0, 0.3),
        outer_body=(1000.0, 0.3),
        plane_strain=kind == "plane strain",
    )
    worst = pressure[abs(pressure - exact).argmax()]
    yield Check(
        case=f"press fit of two rings, {kind}",
        quantity="interface pressure",
        computed=float(worst),
        reference=exact,
        tolerance=1e-3,
        source="Lame; Timoshenko, Goodier section 28",
    )
