# SPDX-License-Identifier: BSD-3-Clause
"""Proof that loads pull bodies away: a rigid motion along which they work more than contact can resist."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog, nnls

from signorini.arrays import Array
from signorini.friction.problem import CoulombProblem
from signorini.law.bound import FrictionBound

GAIN = 1e-9
"""Size of the unresisted load, relative to scale, above which it counts."""


STRONGEST = 1e6
"""Sum of the normal forces, of the size of the data, that a proof has to withstand: a motion that friction resists but
for a rounding of 1e-16 would be resisted by forces without bound, and equilibria under larger ones are none that the
solver would find."""


@dataclass(frozen=True, kw_only=True)
class Pull:
    """A proof that there is no equilibrium.

    Attributes
    ----------
    motion : (d n,) rigid motion of the pairs along which the load works more than forces resist; largest entry 1
    share : of the load on rigid motions what no force of the pairs takes, in (0, 1]
    """

    motion: Array
    share: float


def pulled_away(problem: CoulombProblem, bound: FrictionBound | None = None) -> Pull | None:
    """A rigid motion rho along which the load works more than forces can resist, or None where there is none.

    Equilibrium needs forces of the pairs with ``R'(r + b) = 0``, and forces that friction allows, p >= 0 and ``|r_t| <=
    F(p)``, do at least ``-sum max_p (F(p) |rho_t| - p rho_n)`` of work along rho. Where ``b.rho`` is larger, no state
    of the pairs whatever is in equilibrium. In Coulomb's law that maximum is 0 for ``rho_n >= mu |rho_t|``, and
    infinite for other rho. What rounding leaves of ``mu |rho_t| - rho_n`` counts with forces up to `STRONGEST`.

    Parameters
    ----------
    bound : another bound of the friction than the problem's

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.eye(2), b=np.array([1.0, 0.0]), friction=[0.3], motions=np.eye(2), scale=1.0
    ... )
    >>> pull = pulled_away(problem)
    >>> pull.motion.tolist(), pull.share
    ([1.0, 0.0], 1.0)
    """
    R = problem.image.R
    if not R.shape[1]:
        return None
    load = R.T @ problem.b / (problem.scale or 1.0)
    if bound is None and problem.bound.branches == 1:
        a = unresisted(R, problem.mu, load)
    else:
        a = _by_program(problem, load, bound or problem.bound)
    return None if a is None else pull_along(R, a, load)


def pull_along(R: Array, a: Array, load: Array) -> Pull:
    """The proof that coefficients a, (k,), of the motions R are, of a load (k,) on them."""
    rho, along = R @ a, float(load @ a)
    share = along / float(np.linalg.norm(load) * np.linalg.norm(a))
    return Pull(motion=np.asarray(rho / np.abs(rho).max(), dtype=np.float64), share=share)


def unresisted(R: Array, mu: Array, load: Array) -> Array | None:
    """The motion of the unresisted cone that a load favours, in Coulomb's law; None where friction can bear the load.

    ``a`` is the projection of the load on the cone ``C a >= 0`` of unresisted motions; it vanishes exactly where there
    is none (Moreau). By duality a nonnegative least squares problem, ``a = load + C'x, x >= 0``.

    Parameters
    ----------
    R : (2n, k) motions of the pairs
    mu : (n,) finite
    load : (k,) its work along each motion, relative to the data

    Examples
    --------
    >>> unresisted(np.eye(2), np.array([0.5]), np.array([-1.0, 0.4])) is None
    True
    """
    n = len(mu)
    if not n:
        return load
    normal, bound = R[:n], mu[:, None] * R[n:]
    C = np.concatenate([normal - bound, normal + bound]) / np.sqrt(1.0 + np.tile(mu, 2) ** 2)[:, None]
    try:
        multipliers, _ = nnls(C.T, -load)
    except RuntimeError:  # its iteration limit: nothing proved
        return None
    a: Array = load + C.T @ multipliers
    size, most = float(np.linalg.norm(a)), size_of(load)
    if size <= GAIN * np.sqrt(n) * most:
        return None
    resisted = -STRONGEST * most * float((C @ a).min(initial=0.0))
    return a if load @ a > resisted + 0.5 * size**2 else None


def size_of(load: Array) -> float:
    """Of a load (k,) on rigid motions, relative to the data, at least theirs."""
    return max(1.0, float(np.linalg.norm(load)))


def _by_program(problem: CoulombProblem, load: Array, bound: FrictionBound) -> Array | None:
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
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    if answer.status != 0 or answer.fun <= GAIN * np.sqrt(n) * size_of(load):
        return None
    a = -np.asarray(answer.eqlin.marginals)
    resisted = _resisted(bound, R[:n] @ a, R[n:] @ a, unit, STRONGEST * size_of(load))
    return a if load @ a > resisted + 0.5 * answer.fun else None


def _resisted(bound: FrictionBound, normal: Array, tangential: Array, unit: float, strongest: float) -> float:
    """``sum max_p (F(p) |rho_t| - p rho_n)``, of forces over unit that sum up to the strongest."""
    n, across = len(normal), np.abs(tangential)
    lasts = np.isfinite(bound.kinks).sum(axis=0) - 1
    endless = float(np.maximum(bound.slopes[lasts, np.arange(n)] * across - normal, 0.0).max(initial=0.0))
    corners = np.where(np.isfinite(bound.kinks[:-1]), bound.kinks[:-1], 0.0)
    work = np.array([bound.at(p) * across - p * normal for p in corners])
    return float(work.max(axis=0).sum()) / unit + strongest * endless
