# SPDX-License-Identifier: BSD-3-Clause
"""Where bodies may touch, and the law there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from signorini.arrays import Array, frozen
from signorini.checks import number, text, vector
from signorini.errors import InputError


@dataclass(frozen=True)
class Plane:
    """A rigid plane (in 2D a line) that bodies cannot enter.

    Parameters
    ----------
    point : any point of it, length
    normal : pointing from the obstacle towards the body; any size but zero

    Examples
    --------
    >>> Plane(point=(0, 0), normal=(0, 2)).gap([[1.0, 0.5]])
    array([0.5])
    """

    point: tuple[float, ...]
    normal: tuple[float, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", vector(self.point, ("point",)))
        normal = vector(self.normal, ("normal",), dimension=len(self.point))
        size = math.hypot(*normal)
        if size == 0.0:
            raise InputError("is zero; expected a direction", where=("normal",))
        object.__setattr__(self, "normal", tuple(part / size for part in normal))

    def gap(self, points: Array) -> Array:
        """Signed distance of points (n, d), length, positive outside the obstacle."""
        distance: Array = (frozen(points) - frozen(self.point)) @ frozen(self.normal)
        return distance


@dataclass(frozen=True)
class Contact:
    """Two surfaces that may touch, or a surface and a rigid obstacle.

    ``gap >= 0``, ``pressure >= 0``, ``gap * pressure = 0`` and ``|traction| <= friction * pressure``, opposed to the
    slip increment where it is equal.

    Parameters
    ----------
    nonmortar : boundary whose nodes carry the pairs, the pressures and the results
    mortar : boundary of the other body, or a rigid :class:`Plane`
    friction : Coulomb's coefficient, >= 0, or "stick": never slips (it may still open)
    gap : "geometry", or one initial gap for every pair, length (negative: overlap)
    interference : overlap that is added to it, length, positive presses the bodies together
    normal_compliance, tangential_compliance : of the interface, length per pressure; 0 (default) is the exact law,
        ``1 / E_n`` and ``1 / E_tau`` the paper's penalties or a physical contact stiffness
    name : what results call it; the nonmortar side by default

    Examples
    --------
    >>> Contact("arc", Plane((0, 0), (0, 1)), friction=0.4).label
    'arc'
    """

    nonmortar: str
    mortar: str | Plane
    friction: float | Literal["stick"] = 0.0
    gap: float | Literal["geometry"] = "geometry"
    interference: float = 0.0
    normal_compliance: float = 0.0
    tangential_compliance: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        text(self.nonmortar, ("nonmortar",))
        if not isinstance(self.mortar, Plane):
            text(self.mortar, ("mortar",))
        if self.friction != "stick":
            if isinstance(self.friction, str):
                raise InputError(f"is '{self.friction}'; expected a number >= 0 or 'stick'", where=("friction",))
            object.__setattr__(self, "friction", number(self.friction, ("friction",), least=0.0))
        if self.gap != "geometry":
            if isinstance(self.gap, str):
                raise InputError(f"is '{self.gap}'; expected 'geometry' or a number", where=("gap",))
            object.__setattr__(self, "gap", number(self.gap, ("gap",)))
        for key in ("normal_compliance", "tangential_compliance"):
            object.__setattr__(self, key, number(getattr(self, key), (key,), least=0.0))
        object.__setattr__(self, "interference", number(self.interference, ("interference",)))

    @property
    def label(self) -> str:
        """The name in results."""
        return self.name or self.nonmortar

    @property
    def coefficient(self) -> float:
        """Coulomb's coefficient as a number; infinite where the contact sticks."""
        return math.inf if self.friction == "stick" else float(self.friction)
