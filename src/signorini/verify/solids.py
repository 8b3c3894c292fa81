# SPDX-License-Identifier: BSD-3-Clause
"""Whole spheres in space: B02 and B03, whose finite size is part of the problem, and a hollow one in two parts, B09."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from signorini.engine.solve import solve
from signorini.gallery.spheres import MATERIAL, RADIUS, WALL, equal_spheres, hollow_spheres
from signorini.meshing.plane import Cells
from signorini.reference.hertz import contact_modulus
from signorini.reference.hertz_point import HertzPoint
from signorini.reference.lame import hollow_sphere
from signorini.verify.check import Check, checks_of, farthest

_MODULUS = contact_modulus(*[(MATERIAL.E, MATERIAL.nu)] * 2)


def spheres() -> Iterator[Check]:
    """B03, and B02 by spheres that hardly feel their size: 8 cells to the contact radius."""
    yield from _equal("hexahedra, one on its plane of symmetry", approach=4.0, tolerance=0.05)
    yield from _equal("hexahedra, one on its plane of symmetry", approach=0.25, tolerance=0.02)
    yield from _equal("hexahedra, two that do not match", approach=4.0, other=5, tolerance=0.05)


def spheres_refined() -> Iterator[Check]:
    """Finer and quadratic."""
    yield from _equal("hexahedra, two that do not match", approach=0.25, other=5, tolerance=0.02)
    yield from _equal("hexahedra, finer, one on its plane of symmetry", approach=4.0, n=8, tolerance=0.05)
    for nodes, cells in _QUADRATIC:
        words = f"hexahedra of {nodes} nodes, one on its plane of symmetry"
        yield from _equal(words, approach=4.0, cells=cells, tolerance=0.05)
    yield from _equal(
        "hexahedra of 20 nodes, two that do not match", approach=4.0, other=5, cells="quad8", tolerance=0.05
    )


_QUADRATIC: tuple[tuple[str, Cells], ...] = (("20", "quad8"), ("27", "quad9"))


def _equal(
    words: str, *, approach: float, tolerance: float, n: int = 4, other: int | None = None, cells: Cells = "quad"
) -> Iterator[Check]:
    """Stress at the centre for the approach and for the force, and all pressures off the edge."""
    contact = solve(equal_spheres(approach=approach, n=n, other=other, cells=cells)).contact("contact")
    r = np.hypot(*contact.points.T[:2])
    radius = float(np.sqrt(0.5 * RADIUS * approach))
    exact = HertzPoint(force=4.0 * abs(float(contact.normal_force[2])), radius=0.5 * RADIUS, modulus=_MODULUS)
    error = np.abs(contact.pressure - exact.pressure(r)) / exact.peak_pressure
    centre = -float(contact.pressure[np.argmin(r)])
    source = "Hertz; Johnson (1985), section 4.2"
    yield from checks_of(
        f"equal spheres in space, approach {approach:g}, a/R {radius / RADIUS:.2g}, {words}",
        (
            "sigma_zz at the centre, for the approach",
            centre,
            -2.0 * _MODULUS * radius / (np.pi * 0.5 * RADIUS),
            tolerance,
            "Hertz; Code_Aster SSNV104 for 4; a finite body is stiffer",
        ),
        ("sigma_zz at the centre, for the force it takes", centre, -exact.peak_pressure, 0.01, source),
        ("largest error of p / p_0, r < 0.9 a", error[r < 0.9 * exact.contact_radius].max(), 0.0, 0.03, source),
    )


def hollow() -> Iterator[Check]:
    """B09 in space: a hollow sphere of two parts whose curved sides do not match, as if it were one."""
    middle = np.array([0.5 * (WALL["inner"] + WALL["outer"])])
    exact = -float(hollow_sphere(middle, **WALL)[1][0])
    families: tuple[tuple[str, Cells | Literal["tetra10"]], ...] = (
        ("hexahedra of 20 nodes", "quad8"),
        ("hexahedra of 27 nodes", "quad9"),
        ("tetrahedra of 10 nodes", "tetra10"),
    )
    for words, cells in families:
        contact = solve(hollow_spheres(n=(3, 4), cells=cells)).contact("interface")
        yield from checks_of(
            f"B09 hollow spheres 20/30/40 in space, {words}, 3 : 4 cells",
            ("interface pressure, mean", contact.pressure @ contact.area / contact.area.sum(), exact, 1e-3),
            ("interface pressure, worst node", farthest(contact.pressure, exact), exact, 5e-3),
            source="Lame; Timoshenko, Goodier section 136",
        )
