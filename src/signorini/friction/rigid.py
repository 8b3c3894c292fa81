# SPDX-License-Identifier: BSD-3-Clause
"""Proof that loads pull bodies away: a rigid motion that contact cannot resist and along which the loads work."""

from __future__ import annotations

import numpy as np
from scipy.optimize import nnls

from signorini.arrays import Array
from signorini.friction.problem import CoulombProblem

GAIN = 1e-9
"""Size of the unresisted load, relative to scale, above which it counts."""


def pulled_away(problem: CoulombProblem) -> Array | None:
    """A rigid motion rho with ``rho_n >= mu |rho_t|`` at every pair and ``b.rho > 0``, or None where there is none.

    Equilibrium needs forces in the friction cones with ``R'(r + b) = 0``; but r.rho >= 0 for such a rho, so that
    ``rho.(r + b) > 0``: no state of the pairs whatever is in equilibrium. Of all such motions the one that the load
    favours, ``rho = R a`` with a the projection of ``R'b`` on the cone ``C a >= 0`` of unresisted motions; it vanishes
    exactly where there is none (Moreau). By duality a nonnegative least squares problem, ``a = R'b + C'x, x >= 0``.

    Returns
    -------
    rho : (2n,) largest entry 1

    Examples
    --------
    >>> problem = CoulombProblem(
    ...     W=np.eye(2), b=np.array([1.0, 0.0]), friction=[0.3], motions=np.eye(2), scale=1.0
    ... )
    >>> pulled_away(problem).tolist()
    [1.0, 0.0]
    """
    R, n, mu = problem.interface.R, problem.pairs, problem.mu
    if not R.shape[1]:
        return None
    normal, bound = R[:n], mu[:, None] * R[n:]
    C = np.concatenate([normal - bound, normal + bound]) / np.sqrt(1.0 + np.tile(mu, 2) ** 2)[:, None]
    load = R.T @ problem.b / (problem.scale or 1.0)
    try:
        multipliers, _ = nnls(C.T, -load)
    except RuntimeError:  # its iteration limit: nothing proved
        return None
    a = load + C.T @ multipliers
    size = float(np.linalg.norm(a))
    if size <= GAIN * np.sqrt(n) or (C @ a).min() < -GAIN * size or load @ a <= 0.5 * size**2:
        return None
    rho = R @ a
    return np.asarray(rho / np.abs(rho).max(), dtype=np.float64)
