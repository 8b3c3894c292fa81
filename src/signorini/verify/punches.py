# SPDX-License-Identifier: BSD-3-Clause
"""B06: flat rigid punches without friction, and B07: the singularities at the corners of a square block."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from scipy.optimize import minimize_scalar

from signorini.arrays import Array
from signorini.engine.solve import solve
from signorini.gallery.half_planes import punch, square_on_half_plane
from signorini.model.kind import Kind
from signorini.reference.corners import bonded_corner, frictionless_corner
from signorini.solution.results import ContactResult
from signorini.verify.check import Check, checks_of


def flat_punches() -> Iterator[Check]:
    """What part of the load the inner half of the punch carries."""
    kinds: tuple[tuple[Kind, float, str], ...] = (
        ("plane strain", 1.0 / 3.0, "int P / (pi sqrt(a^2 - x^2)); Johnson (1985), section 2.8"),
        ("axisymmetric", 1.0 - float(np.sqrt(0.75)), "int F / (2 pi a sqrt(a^2 - r^2)); Johnson (1985), section 3.4"),
    )
    for kind, share, source in kinds:
        for cells in ("quad", "quad8"):
            model = punch(curved=False, friction=0.0, spacing=0.01, kind=kind, cells=cells)
            found = _share(solve(model).contact("punch"), revolved=kind == "axisymmetric")
            yield from checks_of(
                f"B06 flat punch, {kind}, {cells}", ("share of the load within a/2", found, share, 0.01, source)
            )


def _share(contact: ContactResult, *, revolved: bool) -> float:
    """Part of the force on |x| <= 1/2, from the pressures linear between nodes."""
    order = np.argsort(contact.points[:, 0])
    x, p = contact.points[order, 0], contact.pressure[order]
    fine = np.linspace(0.0, 0.5, 2001)
    weight = 2.0 * np.pi * fine if revolved else np.ones_like(fine)
    return float(np.trapezoid(np.interp(fine, x, p) * weight, fine) / contact.normal_force[1])


def corner_exponents() -> Iterator[Check]:
    """How the pressure grows towards the corner: a fit over 3e-5 < r < 1e-3 of the half-width, cells of 1e-6 there."""
    bonded, weaker = bonded_corner(np.pi / 2)
    cases: tuple[tuple[str, float | Literal["stick"], float, float | None], ...] = (
        ("bonded", "stick", bonded, weaker),
        ("frictionless", 0.0, frictionless_corner(np.pi / 2), None),
    )
    for words, friction, exponent, second in cases:
        contact = solve(square_on_half_plane(friction=friction, finest=1e-6)).contact("contact")
        r = 1.0 - contact.points[:, 0]
        near = (r > 3e-5) & (r < 1e-3)
        yield from checks_of(
            "B07 square block on a half-plane, cells 1e-6 at the corner",
            (f"exponent of the pressure, {words}", _exponent(r[near], contact.pressure[near], second), exponent, 0.02),
            source="Williams (1952)" if friction else "Dundurs, Lee (1972)",
        )


def _exponent(r: Array, pressure: Array, second: float | None) -> float:
    """The strongest exponent in ``p = K_1 r^e + K_2 r^second``, by least squares of relative errors."""

    def defect(exponent: float) -> float:
        powers = [exponent] if second is None else [exponent, second]
        terms = np.column_stack([r**power / pressure for power in powers])
        return float(np.linalg.norm(terms @ np.linalg.lstsq(terms, np.ones(len(r)))[0] - 1.0))

    return float(minimize_scalar(defect, bounds=(-0.8, -0.15), method="bounded", options={"xatol": 1e-8}).x)
