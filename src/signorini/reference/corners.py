# SPDX-License-Identifier: BSD-3-Clause
"""Singular stress at the corner of a body that stands on a half-plane of its own material."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq


def bonded_corner(angle: float) -> tuple[float, float]:
    """Exponents ``lambda - 1`` of the stress ``r^(lambda - 1)`` at the corner of a bonded wedge, stronger one first.

    Wedge and half-plane are one wedge of ``alpha = angle + pi``: ``sin(lambda alpha) = -+ lambda sin(alpha)`` for its
    symmetric and antisymmetric fields.

    Parameters
    ----------
    angle : of the wedge, radians, 0 < angle < 0.8 pi

    References
    ----------
    Williams (1952), J. Appl. Mech. 19.

    Examples
    --------
    >>> [round(exponent, 5) for exponent in bonded_corner(np.pi / 2)]
    [-0.45552, -0.09147]
    """
    alpha = angle + np.pi
    least = 0.45
    symmetric = brentq(lambda x: np.sin(x * alpha) + x * np.sin(alpha), least, 1.0 - 1e-9)
    other = brentq(lambda x: np.sin(x * alpha) - x * np.sin(alpha), symmetric + 1e-6, 1.0 - 1e-9)
    return float(symmetric) - 1.0, float(other) - 1.0


def frictionless_corner(angle: float) -> float:
    """Exponent ``lambda - 1`` of the pressure ``r^(lambda - 1)`` at the corner of a wedge without friction.

    The displacements of wedge and half-plane under ``p = r^(lambda - 1)`` fit together where ``f(angle) + f(pi) = 0``,
    ``f(a) = (sin 2 lambda a + lambda sin 2 a) / (sin^2 lambda a - lambda^2 sin^2 a)``.

    Parameters
    ----------
    angle : of the wedge, radians

    References
    ----------
    Dundurs, Lee (1972), J. Elasticity 2.

    Examples
    --------
    >>> round(frictionless_corner(np.pi / 2), 5)
    -0.22599
    """

    def compliance(x: float, a: float) -> float:
        return float((np.sin(2 * x * a) + x * np.sin(2 * a)) / (np.sin(x * a) ** 2 - (x * np.sin(a)) ** 2))

    return float(brentq(lambda x: compliance(x, angle) + compliance(x, np.pi), 0.55, 0.98)) - 1.0
