# SPDX-License-Identifier: BSD-3-Clause
"""Proof that loads pull bodies away: a rigid motion along which they work more than contact can resist."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from signorini.arrays import Array
from signorini.attempt import Spent
from signorini.friction.problem import ContactProblem
from signorini.law.bound import FrictionBound
from signorini.law.section import FrictionSection

ROUNDS = 60
"""Least squares problems, each with the edges that resist the answer of the last most: some ten are usual."""

EXCHANGES = 3
"""Most exchanges of one least squares problem, per edge."""

ITERATION_LIMIT = 1
"""Status of a linear programme of SciPy that ended at its limit."""

PROGRAM_TOL = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
"""Of the data: what linear programs may lack, as HiGHS is told."""

GAIN = 1e-9
"""Size of the unresisted load, relative to scale, above which it counts."""


STRONGEST_FORCES = 1e6
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


def pulled_away(problem: ContactProblem, bound: FrictionBound | None = None) -> Pull | Spent | None:
    """A rigid motion rho along which the load works more than forces can resist, or None where there is none.

    Equilibrium needs forces of the pairs with ``R'(r + b) = 0``. Those in the friction cones do no work against a rho
    with ``rho_n >= |(mu_1 rho_1, mu_2 rho_2)|`` at every pair, mu the largest slope of the bound. Where ``b.rho > 0``
    for such a rho no state of the pairs whatever is in equilibrium.

    In the plane bounds of several branches tell more: p >= 0 and ``|r_t| <= F(p)`` do at least ``-sum max_p (F(p)
    |rho_t| - p rho_n)`` of work along rho. In Coulomb's law that maximum is 0 for ``rho_n >= mu |rho_t|``, and infinite
    for other rho. What rounding leaves of ``mu |rho_t| - rho_n`` counts with forces up to `STRONGEST_FORCES`.

    None where nothing is proved, which includes pairs in Tresca's law: their friction knows no cone; that the budget is
    spent, where it is.

    Parameters
    ----------
    problem : the problem
    bound : another bound of the friction than the problem's, in the plane

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.eye(2), b=np.array([1.0, 0.0]), friction=[0.3], motions=np.eye(2), scale=1.0
    ... )
    >>> pull = pulled_away(problem)
    >>> pull.motion.tolist(), pull.share
    ([1.0, 0.0], 1.0)
    """
    R = problem.image.R
    if not R.shape[1] or problem.bounded.any():
        return None
    load = R.T @ problem.b / (problem.scale or 1.0)
    a: Array | Spent | None
    if bound is not None or (problem.piecewise_linear and problem.pieces.branches > 1):
        a = _by_program(problem, load, bound or problem.pieces)
    else:
        a = unresisted(R, FrictionSection(axes=problem.half_axes, sides=problem.section.sides), load)
    if a is None or isinstance(a, Spent):
        return a
    rho, along = R @ a, float(load @ a)
    share = along / float(np.linalg.norm(load) * np.linalg.norm(a))
    return Pull(motion=np.asarray(rho / np.abs(rho).max(), dtype=np.float64), share=share)


def unresisted(R: Array, cones: FrictionSection, load: Array) -> Array | Spent | None:
    """The motion of the unresisted cone that a load favours, in Coulomb's law; None where friction can bear the load.

    The motion sought is what of the load forces in the friction cones cannot take, ``a = load + R'r`` of least length:
    the projection of the load on the cone of unresisted motions, which vanishes exactly where there is none (Moreau).
    It is a nonnegative least squares problem in the edges of the cones, of which each round adds those that resist the
    present motion most; those of an interval are known at once.

    Parameters
    ----------
    R : (d n, k) motions of the pairs
    cones : their sections at a normal force of 1, finite
    load : (k,) its work along each motion, relative to the data

    Examples
    --------
    >>> floor = FrictionSection(axes=np.array([[0.5]]), sides=np.array([0]))
    >>> unresisted(np.eye(2), floor, np.array([-1.0, 0.4])) is None
    True
    """
    (m, n), most = cones.axes.shape, size_of(load)
    if not n:
        return load
    rows = R.reshape(m + 1, n, -1)
    starts = (cones.axes, -cones.axes) if m == 1 else (np.zeros((m, n)),)
    edges = np.concatenate([work_of(unit_edges(share), rows) for share in starts])
    for _ in range(ROUNDS):
        try:
            multipliers, _ = scipy.optimize.nnls(edges.T, -load, maxiter=EXCHANGES * len(edges))
        except RuntimeError:
            return Spent(most=EXCHANGES * len(edges), of="exchanges of edges in a proof by a rigid motion")
        a: Array = load + edges.T @ multipliers
        size = float(np.linalg.norm(a))
        if size <= GAIN * np.sqrt(n) * most:
            return None
        strongest = work_of(strongest_edges(cones, R @ a), rows)
        resisted = STRONGEST_FORCES * most * (strongest @ a) < -0.25 * size**2
        if not resisted.any():
            return a if load @ a > 0.75 * size**2 else None
        if m == 1:
            return None
        edges = np.concatenate([edges[multipliers > 0], strongest[resisted]])
    return Spent(most=ROUNDS, of="rounds of a proof by a rigid motion")


def strongest_edges(cones: FrictionSection, rho: Array) -> Array:
    """(d, n) Edge of each pair's cone that works most against a motion (d n,), scaled to length 1."""
    return unit_edges(cones.farthest(-rho.reshape(-1, len(cones.sides))[1:]))


def unit_edges(share: Array) -> Array:
    """(d, n) Forces of length 1 with tangential parts (d - 1, n) per normal force."""
    edge = np.concatenate([np.ones((1, share.shape[1])), share])
    return np.asarray(edge / np.linalg.norm(edge, axis=0))


def work_of(forces: Array, rows: Array) -> Array:
    """(n, k) Work of the forces of every pair, (d, n), along k motions, (d, n, k)."""
    return np.asarray(np.einsum("in,ink->nk", forces, rows))


def size_of(load: Array) -> float:
    """Of a load (k,) on rigid motions, relative to the data, at least theirs."""
    return max(1.0, float(np.linalg.norm(load)))


def _by_program(problem: ContactProblem, load: Array, bound: FrictionBound) -> Array | None:
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
    answer = scipy.optimize.linprog(
        np.concatenate([np.zeros(2 * n), np.ones(2 * k)]),
        A_ub=np.concatenate(edges),
        b_ub=np.concatenate(room),
        A_eq=np.concatenate([R.T, np.eye(k), -np.eye(k)], axis=1),
        b_eq=-load,
        bounds=[(0.0, None)] * n + [(None, None)] * n + [(0.0, None)] * (2 * k),
        method="highs",
        options=PROGRAM_TOL,
    )
    if answer.status != 0 or answer.fun <= GAIN * np.sqrt(n) * size_of(load):
        return None
    a = -np.asarray(answer.eqlin.marginals)
    resisted = _resisted(bound, R[:n] @ a, R[n:] @ a, unit, STRONGEST_FORCES * size_of(load))
    return a if load @ a > resisted + 0.5 * answer.fun else None


def _resisted(bound: FrictionBound, normal: Array, tangential: Array, unit: float, strongest: float) -> float:
    """``sum max_p (F(p) |rho_t| - p rho_n)``, of forces over unit that sum up to the strongest."""
    n, across = len(normal), np.abs(tangential)
    lasts = bound.branch_counts - 1
    endless = float(np.maximum(bound.slopes[lasts, np.arange(n)] * across - normal, 0.0).max(initial=0.0))
    corners = np.where(np.isfinite(bound.kinks[:-1]), bound.kinks[:-1], 0.0)
    work = np.array([bound.at(p) * across - p * normal for p in corners])
    return float(work.max(axis=0).sum()) / unit + strongest * endless
