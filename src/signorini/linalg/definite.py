# SPDX-License-Identifier: BSD-3-Clause
"""Is a motion without resistance hidden in the round-off?

The last pivot of a free body is not 0 but round-off of either sign, so a factorisation may well run through. Rigid
motions of large bodies sum up much round-off, slender bodies have small honest pivots: no bound on a pivot tells the
two apart. The energy of the softest motion does: one solve with an arbitrary load gives a motion x that a vanishing
eigenvalue dominates, and x counts as free where, body by body,

    x . K x  <=  c eps  |x| . |K| |x|:

its energy is then the round-off of the products it is summed from.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import connected_components

from signorini.linalg.protocol import Factorisation, NotPositiveDefinite
from signorini.linalg.system import System

SUSPICIOUS_PIVOT = 1e-5
"""A pivot this small against its diagonal entry calls for the test of the energy."""

ROUNDOFF = 16 * float(np.finfo(np.float64).eps)
"""Of the size of the terms that an energy is the sum of: what rounding may leave where it is 0."""


def check_energy(system: System, factor: Factorisation) -> None:
    """Refuse a factorised interior that has a motion without resistance.

    Raises
    ------
    NotPositiveDefinite
        With the unknown that moves most in the first free body found.
    """
    if system.m == system.n:
        return
    rng = np.random.default_rng(0)
    scale = np.sqrt(np.abs(system.matrix.diagonal()))
    load = np.where(system.inside, scale * rng.uniform(0.5, 1.5, system.n) * rng.choice([-1.0, 1.0], system.n), 0.0)
    x = factor.reduce(load).expand(np.zeros(system.m))
    if not np.isfinite(x).all():
        raise NotPositiveDefinite(int(np.argmin(np.isfinite(x))))
    inside = np.flatnonzero(system.inside)
    K, y = system.matrix[inside][:, inside], x[inside]
    _, body = connected_components(K, connection="strong")  # of a symmetric pattern: connected, and K is not transposed
    size = np.bincount(body, weights=np.abs(y) * (abs(K) @ np.abs(y)))
    energy = np.bincount(body, weights=y * load[inside])
    free = (energy <= ROUNDOFF * size) & (size > 0)
    if free.any():
        raise NotPositiveDefinite(int(inside[np.argmax(np.where(free[body], np.abs(y), -1.0))]))
