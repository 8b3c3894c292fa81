# SPDX-License-Identifier: BSD-3-Clause
"""Spence: how far an elastic half-plane sticks to a rigid punch that is pressed into it with growing force."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipk, ellipkm1

_NARROWEST_RING = 1e-12  # 1 - (c/a)^2 of the slip ring: narrower ones are lost in rounding


def stick_ratio(friction: float, nu: float) -> float:
    """``c/a`` of the stick zone to the contact, the same for a flat and for any power-law punch, under any load.

    ``K(c/a) / K(sqrt(1 - (c/a)^2)) = mu / beta`` with K of the modulus and ``beta = (1 - 2 nu) / (2 (1 - nu))``.

    Parameters
    ----------
    friction : mu > 0
    nu : Poisson's ratio of the half-plane, plane strain, less than 1/2

    References
    ----------
    Spence (1973), Proc. Camb. Phil. Soc. 73; Spence (1975), J. Elasticity 5.

    Examples
    --------
    >>> [round(stick_ratio(mu, 0.3), 4) for mu in (0.2, 0.4, 0.8)]
    [0.4058, 0.9063, 0.9988]
    """
    ratio = friction * 2.0 * (1.0 - nu) / (1.0 - 2.0 * nu)

    def lacking(log_gap: float) -> float:
        """As a function of log(1 - (c/a)^2): c/a crowds at 1."""
        gap = float(np.exp(log_gap))
        return float(ellipkm1(gap) / ellipk(gap)) - ratio

    return float(np.sqrt(1.0 - np.exp(brentq(lacking, -700.0, np.log(1.0 - _NARROWEST_RING)))))
