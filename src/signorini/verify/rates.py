# SPDX-License-Identifier: BSD-3-Clause
"""Rates of convergence in the energy norm, measured against a finer mesh: smooth contact, its edges, corners."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from signorini.api import solve
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness
from signorini.meshing.plane import Cells, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.reference.corners import bonded_corner, frictionless_corner
from signorini.solved import Solution
from signorini.verify.check import Check, checks_of

Make = Callable[[int, Cells], Model]

_SMOOTH: tuple[tuple[str, float], ...] = (("closed everywhere", 20.0), ("open on half of it", 1.0))
"""Pressures on top of the heated blocks: the second is less than the heat pulls."""

_FAMILIES: tuple[tuple[Cells, tuple[int, int, int], float], ...] = (
    ("triangle", (8, 16, 48), 1.0),
    ("quad", (16, 32, 96), 1.0),
    ("triangle6", (6, 12, 48), 1.5),
    ("quad8", (8, 16, 64), 1.5),
    ("quad9", (8, 16, 64), 1.5),
)
_CORNERS: tuple[tuple[Cells, tuple[int, int, int]], ...] = (("quad", (16, 32, 96)), ("triangle", (12, 24, 72)))
_LAWS: tuple[tuple[str, float | Literal["stick"], float], ...] = (
    ("bonded", "stick", bonded_corner(np.pi / 2)[0]),
    ("frictionless", 0.0, frictionless_corner(np.pi / 2)),
)


def smooth_contact() -> Iterator[Check]:
    """Two blocks on meshes 2 : 3, the lower one heated unevenly, so that they part on half of their sides."""
    words, pressure = _SMOOTH[1]
    yield from _rate(f"contact {words}", _heated(pressure), "quad", (8, 16, 48), 1.0)
    yield from _rate(f"contact {words}", _heated(pressure), "quad8", (6, 12, 48), 1.5)


def smooth_contact_refined() -> Iterator[Check]:
    """Two heated blocks with every family, and pressed so hard that they stay together."""
    for words, pressure in _SMOOTH:
        for cells, numbers, rate in _FAMILIES:
            yield from _rate(f"contact {words}", _heated(pressure), cells, numbers, rate)


def corners() -> Iterator[Check]:
    """Half a square block on a larger one, even meshes: what the corner leaves of the rate."""
    for words, friction, exponent in _LAWS:
        for cells, numbers in _CORNERS:
            yield from _rate(f"{words} corner", _square(friction), cells, numbers, 1.0 + exponent, exactly=True)


def _rate(
    words: str, make: Make, cells: Cells, numbers: tuple[int, int, int], rate: float, *, exactly: bool = False
) -> Iterator[Check]:
    """From the first to the second number of cells, against the third.

    Where errors are ``C n^-s`` the squared distances to the finest solution go as ``n^-2s - n_3^-2s`` (Galerkin).
    """
    coarse, fine, finest = (solve(make(n, cells)) for n in numbers)
    ratio = _distance(coarse, finest) / _distance(fine, finest)
    first, second, third = (float(n) for n in numbers)

    def defect(s: float) -> float:
        squares = [n ** (-2.0 * s) - third ** (-2.0 * s) for n in (first, second)]
        return float(np.sqrt(squares[0] / squares[1])) - ratio

    quantity = f"rate from n = {numbers[0]} to {numbers[1]}, against {numbers[2]}"
    yield from checks_of(
        f"energy norm, {words}, {cells}",
        (quantity, brentq(defect, 0.05, 6.0), rate, 0.1),
        source="1 + exponent of the corner's stress" if exactly else "order of the cells, at most 3/2 at a free edge",
        least=not exactly,
    )


def _distance(coarse: Solution, fine: Solution) -> float:
    """Energy norm of the difference, the coarse displacements read at the nodes of the fine mesh."""
    model, there = fine.model, np.zeros_like(fine.last.displacement)
    (cells,) = model.mesh.cells.values()
    for body in model.bodies:
        nodes = np.unique(cells[model.mesh.bodies[body.name]])
        there[nodes] = coarse.along(model.mesh.points[nodes], body=body.name).displacement
    difference = (there - fine.last.displacement).ravel()
    K = stiffness(make_space(model.mesh), model)
    return float(np.sqrt(difference @ (K @ difference)))


def _heated(pressure: float) -> Make:
    """Unit blocks held sideways, no friction; the heat is even at both sides, so that nothing is singular there."""

    def make(n: int, cells: Cells) -> Model:
        blocks = {
            "upper": rectangle(nx=n, ny=n, cells=cells),
            "lower": rectangle(nx=3 * n // 2, ny=3 * n // 2, origin=(0.0, -1.0), cells=cells),
        }
        hot = Elastic(E=1000.0, nu=0.2, expansion=1e-2)
        return Model(
            join(blocks),
            bodies=[Body("upper", Elastic(E=2000.0, nu=0.3)), Body("lower", hot)],
            supports=[
                *(Support(f"{name}.{side}", u=(0.0, None)) for name in blocks for side in ("left", "right")),
                Support("lower.bottom", u=(None, 0.0)),
            ],
            loads=[
                Load("upper.top", pressure=pressure),
                Load("lower", temperature=lambda points: np.cos(np.pi * points[:, 0]) * points[:, 1]),
            ],
            contacts=[Contact("upper.bottom", "lower.top", name="contact")],
        )

    return make


def _square(friction: float | Literal["stick"]) -> Make:
    """Half of a block 2 x 1 on half of one 4 x 2, n cells a unit; bonded as far as it can stick."""

    def make(n: int, cells: Cells) -> Model:
        base = rectangle(width=2.0, height=2.0, nx=2 * n, ny=2 * n, origin=(0.0, -2.0), cells=cells)
        soft = Elastic(E=200.0, nu=0.3)
        return Model(
            join({"block": rectangle(nx=n, ny=n, cells=cells), "base": base}),
            bodies=[Body("block", soft), Body("base", soft)],
            supports=[
                *(Support(f"{name}.left", u=(0.0, None)) for name in ("block", "base")),
                Support("base.bottom", u=(None, 0.0)),
            ],
            loads=[Load("block.top", pressure=1.0)],
            contacts=[Contact("block.bottom", "base.top", friction=friction, name="contact")],
        )

    return make
