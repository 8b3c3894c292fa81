# SPDX-License-Identifier: BSD-3-Clause
"""An arm of a double cantilever beam on an elastic layer that breaks."""

from __future__ import annotations

import math
from typing import NamedTuple

_SHEAR_FACTOR = 5.0 / 6.0  # part of a rectangular section that bears shear


class Peel(NamedTuple):
    """What tears the layer at the end of a crack.

    Attributes
    ----------
    force : per width, at the end of the arm
    lift : of that end, length
    """

    force: float
    lift: float


def peel(*, strength: float, compliance: float, crack: float, modulus: float, height: float) -> Peel:
    """Force and lift of the end of a beam, with shear, on a long Winkler bed ``k = 1 / compliance`` that tears.

    With ``r = sqrt(k / EI)`` and ``p = sqrt((r + k / 2 S) / 2)``, S the stiffness in shear of a beam that does not
    contract, the bed opens by ``w = (r a + 2 p) P / k`` at the end of a crack a, and tears where ``k w`` is the
    strength. It gives back ``G = k w^2 / 2`` per area, so that the compliance of the arm is ``C(a) = 2 p / k +
    ((r a + 2 p)^3 - (2 p)^3) / 3 r k``. Without shear this is Griffith's load with the root corrected, ``P = sqrt(2 E I
    G) / (a + 1 / lambda)``, ``lambda = sqrt(r / 2)``.

    Parameters
    ----------
    strength : tension that the layer bears, force per area
    compliance : of the layer, length per pressure
    crack : length a of the arm that is free
    modulus, height : of the arm, force per area and length

    References
    ----------
    Kanninen (1973), An augmented double cantilever beam model for studying crack propagation and arrest, Int. J.
    Fract. 9:83.

    Examples
    --------
    >>> found = peel(strength=1.0, compliance=1e-3, crack=100.0, modulus=1e4, height=1.0)
    >>> griffith = (2.0 * 1e4 / 12.0 * 0.5e-3) ** 0.5 / (100.0 + (4.0 * 1e4 / 12.0 * 1e-3) ** 0.25)
    >>> round(found.force / griffith, 2)
    1.0
    """
    bending, shear, k = modulus * height**3 / 12.0, _SHEAR_FACTOR * 0.5 * modulus * height, 1.0 / compliance
    r = math.sqrt(k / bending)
    p = math.sqrt(0.5 * (r + 0.5 * k / shear))
    arm = r * crack + 2.0 * p
    force = strength / arm
    return Peel(force, force * (2.0 * p / k + (arm**3 - (2.0 * p) ** 3) / (3.0 * r * k)))
