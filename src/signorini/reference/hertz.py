# SPDX-License-Identifier: BSD-3-Clause
"""Hertz: cylinders or spheres, or one of them and a plane, pressed together without friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array


@dataclass(frozen=True, kw_only=True)
class HertzLine:
    """Line contact: ``a = sqrt(4 P R / (pi E*))``, ``p_0 = sqrt(P E* / (pi R))``, ``p = p_0 sqrt(1 - x^2 / a^2)``.

    Valid for plane strain, half-planes, a << R.

    Parameters
    ----------
    force : P, on the whole contact per thickness
    radius : R, ``1/R = 1/R_1 + 1/R_2``
    modulus : E*, ``1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2``

    References
    ----------
    Johnson (1985), Contact Mechanics, section 4.2(c).

    Examples
    --------
    >>> paper = HertzLine(force=156.0, radius=8.0, modulus=200.0 / (1 - 0.3**2))
    >>> round(paper.half_width, 5), round(paper.peak_pressure, 5)
    (2.68886, 36.93488)
    """

    force: float
    radius: float
    modulus: float

    @property
    def half_width(self) -> float:
        """``a``, length."""
        return float(np.sqrt(4.0 * self.force * self.radius / (np.pi * self.modulus)))

    @property
    def peak_pressure(self) -> float:
        """``p_0``, force per area."""
        return float(np.sqrt(self.force * self.modulus / (np.pi * self.radius)))

    def pressure(self, x: ArrayLike) -> Array:
        """p at the distance x from the centre, force per area."""
        inside = 1.0 - (np.asarray(x, float) / self.half_width) ** 2
        pressure: Array = self.peak_pressure * np.sqrt(np.maximum(inside, 0.0))
        return pressure

    def axis_stress(self, z: ArrayLike) -> tuple[Array, Array]:
        """Stresses along and across the surface, (sigma_x, sigma_z), at the depth z >= 0 below the centre; tension > 0.

        ``sigma_x = -p_0 [(1 + 2 s^2) / sqrt(1 + s^2) - 2 s]``, ``sigma_z = -p_0 / sqrt(1 + s^2)``, ``s = z / a``.
        """
        s = np.asarray(z, float) / self.half_width
        root = np.sqrt(1.0 + s**2)
        return -self.peak_pressure * ((1.0 + 2.0 * s**2) / root - 2.0 * s), -self.peak_pressure / root


def contact_modulus(*bodies: tuple[float, float]) -> float:
    """``1/E* = sum (1 - nu^2)/E`` over the elastic bodies (E, nu).

    >>> round(contact_modulus((210e3, 0.3), (210e3, 0.3)), 6)
    115384.615385
    """
    return 1.0 / sum((1.0 - nu**2) / E for E, nu in bodies)
