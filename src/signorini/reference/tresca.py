# SPDX-License-Identifier: BSD-3-Clause
"""Tresca's law on a line contact: pressed half-planes of equal materials, then pulled sideways."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array


@dataclass(frozen=True, kw_only=True)
class LimitedShear:
    """Contact in ``|x| < a`` whose friction is at most tau whatever the pressure, under a force ``|Q| < 2 tau a``.

    Equal materials, half-planes. What slips carries tau, and where it sticks, ``|x| < c``, no strain is left::

        int q(s) / (x - s) ds = 0:    q = (2 tau / pi) arctan sqrt((a^2 - c^2) / (c^2 - x^2)),
                                      Q = 2 tau sqrt(a^2 - c^2)

    Parameters
    ----------
    half_width : a, length
    limit : tau, force per area

    References
    ----------
    The integral equation of strips that yield: Dugdale (1960), J. Mech. Phys. Solids 8:100-104; Bilby, Cottrell,
    Swinden (1963), Proc. R. Soc. A 272:304-314.

    Examples
    --------
    >>> law = LimitedShear(half_width=1.0, limit=3.0)
    >>> law.traction([0.0, 0.9], 3.0).round(12).tolist(), round(law.stick_half_width(3.0), 6)
    ([1.0, 3.0], 0.866025)
    """

    half_width: float
    limit: float

    def stick_half_width(self, Q: float) -> float:
        """``c``, length, for a force that has grown from 0."""
        reach = Q / (2.0 * self.limit)
        return float(np.sqrt(max(self.half_width**2 - reach**2, 0.0)))

    def traction(self, x: ArrayLike, Q: float) -> Array:
        """q at x for a force that has grown from 0, force per area."""
        x, c = np.abs(np.asarray(x, dtype=np.float64)), self.stick_half_width(Q)
        inside = np.sqrt(np.maximum(c**2 - x**2, 0.0))
        q = np.where(x < self.half_width, 2.0 / np.pi * np.arctan2(np.sqrt(self.half_width**2 - c**2), inside), 0.0)
        return np.asarray(np.sign(Q) * self.limit * q, dtype=np.float64)
