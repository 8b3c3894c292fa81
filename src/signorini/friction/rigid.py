# SPDX-License-Identifier: BSD-3-Clause
"""Proof that loads pull bodies away: a rigid motion along which they work more than contact can resist."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog, nnls

from signorini.arrays import Array
from signorini.bound import Bound
from signorini.friction.problem import CoulombProblem

GAIN = 1e-9
"""Size of the unresisted load, relative to scale, above which it counts."""


def pulled_away(problem: CoulombProblem, bound: Bound | None = None) -> Array | None:
    """A rigid motion rho along which the load works more than forces can resist, or None where there is none.

    Equilibrium needs forces of the pairs with ``R'(r + b) = 0``, and forces that friction allows, p >= 0 and ``|r_t| <=
    F(p)``, do at least ``-sum max_p (F(p) |rho_t| - p rho_n)`` of work along rho. Where ``b.rho`` is larger, no state
    of the pairs whatever is in equilibrium. In Coulomb's law that maximum is 0 for ``rho_n >= mu |rho_t|``, and
    infinite for other rho.

    Parameters
    ----------
    bound : another bound of the friction than the problem's

    Returns
    -------
    rho : (2n,) largest entry 1

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.eye(2), b=np.array([1.0, 0.0]), friction=[0.3], motions=np.eye(2), scale=1.0
    ... )
    >>> pulled_away(problem).tolist()
    [1.0, 0.0]
    """
    R = problem.image.R
    if not R.shape[1]:
        return None
    load = R.T @ problem.b / (problem.scale or 1.0)
    if bound is None and problem.bound.branches == 1:
        a = _least(problem, load)
    else:
        a = _by_program(problem, load, bound or problem.bound)
    if a is None:
        return None
    rho = R @ a
    return np.asarray(rho / np.abs(rho).max(), dtype=np.float64)


def _least(problem: CoulombProblem, load: Array) -> Array | None:
    """The motion of the unresisted cone that the load favours, in Coulomb's law.

    ``a`` is the projection of ``R'b`` on the cone ``C a >= 0`` of unresisted motions; it vanishes exactly where there
    is none (Moreau). By duality a nonnegative least squares problem, ``a = R'b + C'x, x >= 0``.
    """
    R, n, mu = problem.image.R, problem.pairs, problem.mu
    normal, bound = R[:n], mu[:, None] * R[n:]
    C = np.concatenate([normal - bound, normal + bound]) / np.sqrt(1.0 + np.tile(mu, 2) ** 2)[:, None]
    try:
        multipliers, _ = nnls(C.T, -load)
    except RuntimeError:  # its iteration limit: nothing proved
        return None
    a: Array = load + C.T @ multipliers
    size = float(np.linalg.norm(a))
    if size <= GAIN * np.sqrt(n) or (C @ a).min() < -GAIN * size or load @ a <= 0.5 * size**2:
        return None
    return a


def _by_program(problem: CoulombProblem, load: Array, bound: Bound) -> Array | None:
    """The motion, entries up to 1, along which the load works most beyond what forces resist: a linear program.

    Its dual: of all admissible forces those that balance the load best. What they cannot balance is the work.
    """
    R, n, unit = problem.image.R, problem.pairs, problem.scale or 1.0
    k = R.shape[1]
    edges, room = [], []
    for j in range(bound.branches):
        has = np.flatnonzero(np.isfinite(bound.kinks[j]))
        for sign in (1.0, -1.0):
            edge = np.zeros((len(has), 2 * n + 2 * k))
            edge[np.arange(len(has)), has], edge[np.arange(len(has)), n + has] = -bound.slopes[j, has], sign
            edges.append(edge)
            room.append(bound.starts[j, has] / unit)
    answer = linprog(
        np.concatenate([np.zeros(2 * n), np.ones(2 * k)]),
        A_ub=np.concatenate(edges),
        b_ub=np.concatenate(room),
        A_eq=np.concatenate([R.T, np.eye(k), -np.eye(k)], axis=1),
        b_eq=-load,
        bounds=[(0.0, None)] * n + [(None, None)] * n + [(0.0, None)] * (2 * k),
        method="highs",
    )
    if answer.status != 0 or answer.fun <= GAIN * np.sqrt(n):
        return None
    a = -np.asarray(answer.eqlin.marginals)
    resisted = _resisted(bound, R[:n] @ a, R[n:] @ a, unit)
    return a if load @ a > resisted + 0.5 * answer.fun else None


def _resisted(bound: Bound, normal: Array, tangential: Array, unit: float) -> float:
    """``sum max_p (F(p) |rho_t| - p rho_n)``, of forces over unit; infinite where that is."""
    n, across = len(normal), np.abs(tangential)
    lasts = np.isfinite(bound.kinks).sum(axis=0) - 1
    small = GAIN * max(np.abs(normal).max(initial=0.0), across.max(initial=0.0))
    if (bound.slopes[lasts, np.arange(n)] * across > normal + small).any():
        return float(np.inf)
    corners = np.where(np.isfinite(bound.kinks[:-1]), bound.kinks[:-1], 0.0)
    work = np.array([bound.at(p) * across - p * normal for p in corners])
    return float(work.max(axis=0).sum()) / unit
