# SPDX-License-Identifier: BSD-3-Clause
"""Equilibrium in forces, and its solution where the law of every pair is linear: one system in what is unknown.

In the force form (see `condense.operator`) with an optional proximal layer of compliance alpha around r_0, and springs
of stiffness beta that pull the rigid motions to a_0::

    h = A r + c + R a + alpha (r - r_0),    R'(r + b) = beta (a - a_0)

Unknown are the normal force p of every closed pair, the tangential forces left by the law, q, and the motion a. With Z
the forces of a unit of each, Y the motions that the law prescribes (gap 0; slip 0 where it sticks; ``tau . h = -kappa
q`` where it slips) and r_f the known forces::

    [ Y'(A + alpha) Z + diag   Y'R    ] [ p, q ]     [ Y'((A + alpha) r_f + c - alpha r_0) ]
    [ R'Z                     -beta   ] [ a    ] = - [ R'(r_f + b) + beta a_0              ]

Open pairs take no part. In the plane, with ``r_t = s mu p`` and s = +-1 where pairs slip, that is::

    [ A_nn + A_nt s mu   A_ns   R_n ] [ p   ]     [ c_n ]      gap = 0
    [ A_sn + A_st s mu   A_ss   R_s ] [ r_s ] = - [ c_s ]      slip = 0 where it sticks
    [ R_n' + R_t' s mu   R_s'   0   ] [ a   ]     [ R'b ]      resultants

With alpha, beta > 0 the system is regular for small friction whatever A and R are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import lapack, lstsq

from signorini.arrays import Array, IntArray
from signorini.condense.operator import symmetric_product
from signorini.friction.problem import ContactProblem
from signorini.law.pair import Tangent
from signorini.linalg.shared_dense import factorise_with_pivots

Balance = tuple[Array, Array, Array]
"""Forces r (d, n), rigid motion a (k,) and motions h (d, n)."""

SINGULAR = 1e-13
"""Reciprocal condition below which a system counts as singular."""

REFINE = 1e-13
"""Misfit, relative to scale, above which a solution is refined."""

_RESULTANT_TOL = 1e-9  # of the forces: what those of least change may lack to balance the resultants
_RANK_TOL = 1e-12  # of the largest pivot: rank of a singular system
_COLUMNS = 512  # of a system that are copied at once


@dataclass(frozen=True, kw_only=True)
class Equilibrium:
    """Forces and motions in balance, with or without a proximal layer and springs.

    Attributes
    ----------
    problem : the problem
    alpha : compliance of the layer, in units of 1 / D; 0 for the problem as posed
    beta : stiffness of the springs, in units of D; 0 for the problem as posed
    force, motion : (d, n) r_0 and (k,) a_0 that the layer and the springs are relaxed at; None for 0
    """

    problem: ContactProblem
    alpha: float = 0.0
    beta: float = 0.0
    force: Array | None = None
    motion: Array | None = None

    @property
    def as_posed(self) -> bool:
        """Whether there is neither layer nor spring."""
        return self.alpha == 0.0 and self.beta == 0.0

    @cached_property
    def offset(self) -> Array:
        """(d n,) ``c - alpha r_0``."""
        free = self.problem.free_motion()
        return free if self.force is None else free - self.alpha * self.force.ravel()

    @cached_property
    def resultant(self) -> Array:
        """(k,) ``R'b + beta a_0``."""
        resultant: Array = self.problem.image.R.T @ self.problem.b
        return resultant if self.motion is None else resultant + self.beta * self.motion

    def moved(self, r: Array, a: Array) -> Array:
        """(d, n) Motion h of the pairs under forces r, (d, n), and rigid motion a, (k,)."""
        image, flat = self.problem.image, r.ravel()
        h = symmetric_product(image.A, flat) + self.offset + image.R @ a
        return (h + self.alpha * flat if self.alpha else h).reshape(r.shape)

    def lacking(self, r: Array, a: Array) -> Array:
        """(k,) What forces r, (d, n), lack to balance the resultants under rigid motion a, (k,)."""
        return self.problem.image.R.T @ r.ravel() + self.resultant - self.beta * a


class Unknowns:
    """What a linear law leaves unknown: normals of closed pairs, tangents of sticking ones, a direction of others.

    Rows across a slip are divided by 1 + kappa: far from sticking they say q = 0, and not that kappa is huge.

    Parameters
    ----------
    law : of every pair, linear
    """

    def __init__(self, law: Tangent) -> None:
        self.law, d = law, 1 + len(law.share)
        n = len(law.left)
        self.closed, self.stick = np.flatnonzero(law.closed), np.flatnonzero(law.left == d - 1)
        self.one = np.flatnonzero(law.left == 1) if d == 3 else self.stick[:0]
        sticks = self.stick + n if d == 2 else np.concatenate([self.stick + n, self.stick + 2 * n])
        self.rows = np.concatenate([self.closed, sticks])
        share = law.share[:, self.closed]
        self.slips = np.flatnonzero(share[0] if d == 2 else share.any(axis=0))
        self.given = bool(law.fixed.any())
        self.size = len(self.rows) + len(self.one)
        self.tau = law.tau[:, self.one]
        self.soft = 1.0 / (1.0 + law.kappa[self.one])

    def matrix(self, A: Array, R: Array, alpha: float, beta: float) -> Array:
        """(size + k, size + k) The system, by columns.

        Parameters
        ----------
        A, R : (d n, d n) compliance, (d n, k) rigid motions
        alpha, beta : compliance of a layer, stiffness of springs
        """
        n, u, size, k = len(self.law.left), len(self.rows), self.size, R.shape[1]
        across = [self.one + n, self.one + 2 * n] if len(self.one) else []
        rows = np.concatenate([self.rows, *across]) if across else self.rows
        pairs = self.closed[self.slips]
        share = self.law.share[:, pairs]
        matrix = np.zeros((size + k, size + k), order="F")
        whole = matrix if not across else np.zeros((len(rows), size), order="F")
        for some in _some(u):
            whole[: len(rows), some] = _entries(A, rows, self.rows[some])
        for axis, along in enumerate(share, start=1):
            for some in _some(len(pairs)):
                whole[: len(rows), self.slips[some]] += _entries(A, rows, axis * n + pairs[some]) * along[some]
        for tau, places in zip(self.tau, across, strict=False):
            for some in _some(len(places)):
                whole[:, u:][:, some] += _entries(A, rows, places[some]) * tau[some]
        if across:
            matrix[:u, :size] = whole[:u]
            one, two = whole[u : u + len(self.one)], whole[u + len(self.one) :]
            matrix[u:size, :size] = self.soft[:, None] * (self.tau[0][:, None] * one + self.tau[1][:, None] * two)
            ahead = np.arange(u, size)
            matrix[ahead, ahead] += self.law.kappa[self.one] * self.soft + alpha * self.soft
        if alpha:
            matrix[np.arange(u), np.arange(u)] += alpha
            column = np.searchsorted(self.closed, self.one)
            has = np.flatnonzero(self.law.closed[self.one])
            along = (self.tau * self.law.share[:, self.one]).sum(axis=0)
            matrix[u + has, column[has]] += alpha * (self.soft * along)[has]
        if k:
            matrix[:size, size:] = self.seen(R.reshape(-1, n, k))
            matrix[size:, :u] = R[self.rows].T
            for axis, along in enumerate(share, start=1):
                matrix[size:, self.slips] += R[axis * n + pairs].T * along
            for tau, places in zip(self.tau, across, strict=False):
                matrix[size:, u:size] += R[places].T * tau
            matrix[size + np.arange(k), size + np.arange(k)] -= beta
        return matrix

    def seen(self, h: Array) -> Array:
        """(size, ...) What the law prescribes of motions h, (d, n, ...)."""
        rows = h.reshape(-1, *h.shape[2:])[self.rows]
        if not len(self.one):
            return rows
        each = (..., *(None,) * (h.ndim - 2))
        return np.concatenate([rows, self.soft[each] * (self.tau[each] * h[1:, self.one]).sum(axis=0)])

    def seen_by(self, x: Array) -> Array:
        """(d, n) The transpose of `seen`, of numbers (size,)."""
        return self._placed(x, self.soft)

    def forces(self, x: Array) -> Array:
        """(d, n) Forces Z x of the unknowns, (size,)."""
        r = self._placed(x, 1.0)
        if len(self.slips):
            r[1:] += self.law.share * r[0]
        return r

    def _placed(self, x: Array, across: Array | float) -> Array:
        """(d, n) Numbers (size,) in their rows, those of directions times ``across``."""
        rows = np.zeros((1 + len(self.law.share), len(self.law.left)))
        rows.ravel()[self.rows] = x[: len(self.rows)]
        if len(self.one):
            rows[1:, self.one] += self.tau * (across * x[len(self.rows) :])
        return rows

    def coordinates(self, r: Array) -> Array:
        """(size,) The unknowns whose forces come nearest to forces r, (d, n), each pair by itself."""
        flat, c = r.ravel(), len(self.closed)
        x = flat[self.rows]
        slips, tau = self.closed[self.slips], self.law.tau[:, self.closed[self.slips]]
        share = self.law.share[:, slips]
        across = share - tau * (tau * share).sum(axis=0)  # what no force along the free direction makes up for
        x[:c][self.slips] = (r[0, slips] + (across * r[1:, slips]).sum(axis=0)) / (1.0 + (across**2).sum(axis=0))
        if not len(self.one):
            return x
        normal = np.zeros_like(r[0])
        normal[self.closed] = x[:c]
        left = r[1:, self.one] - self.law.share[:, self.one] * normal[self.one]
        return np.concatenate([x, (self.tau * left).sum(axis=0)])

    def prescribed(self, h: Array) -> Array:
        """Motions, (d, n), with the zeros that the law prescribes, free of rounding."""
        h = h.copy()
        h.ravel()[self.rows] = 0.0
        return h


def _entries(A: Array, rows: IntArray, columns: IntArray) -> Array:
    """Where rows and columns of a matrix meet, in half the time that an index of both takes."""
    return A.take(columns, axis=1).take(rows, axis=0)


def _some(columns: int) -> Iterator[slice]:
    """A few columns of a system after the other: a copy of all would be as large as it."""
    return (slice(first, min(first + _COLUMNS, columns)) for first in range(0, columns, _COLUMNS))


@dataclass(frozen=True, kw_only=True)
class LinearSystem:
    """The factorised system of one linear law; build it with `linear_system`."""

    equilibrium: Equilibrium
    unknowns: Unknowns
    lu: Array
    pivots: IntArray
    singular: bool

    @property
    def index(self) -> int:
        """Sign of the determinant, +1 or -1, relative to that of all pairs sticking; 0 where singular.

        For held bodies the indices of all solutions in the plane sum to +1 (none of them on a wall between states). So
        a solution of index -1 proves at least two more; +1 proves nothing. The path method always ends at +1.
        """
        if self.singular:
            return 0
        k = self.equilibrium.problem.motions.shape[1]
        swapped = np.count_nonzero(self.pivots != np.arange(len(self.pivots)))
        return -1 if (swapped + np.count_nonzero(np.diag(self.lu) < 0) + k * bool(len(self.lu))) % 2 else 1

    def solve(self, r: Array, a: Array) -> Balance | None:
        """Forces (d, n), rigid motion (k,) and motions (d, n) that balance under the linear law.

        Where the system is singular, those of least change from the given r and a, whose motions may not be what the
        law prescribes; None where nothing balances the resultants or the numbers fail.

        Parameters
        ----------
        r, a : (d, n) and (k,) of the last iterate
        """
        form, problem, unknowns = self.equilibrium, self.equilibrium.problem, self.unknowns
        size = unknowns.size
        if unknowns.given:
            known = np.concatenate([np.zeros((1, problem.pairs)), unknowns.law.fixed])
            rhs = -np.concatenate([unknowns.seen(form.moved(known, np.zeros_like(a))), form.lacking(known, a * 0.0)])
        else:
            rhs = -np.concatenate([unknowns.seen(problem.by_pair(form.offset)), form.resultant])
        x = self._least_change(rhs, r, a) if self.singular else self._back(rhs)
        if not np.isfinite(x.sum()):
            return None
        r, a = unknowns.forces(x[:size]), x[size:]
        if unknowns.given:
            r[1:] += unknowns.law.fixed
        h = form.moved(r, a)
        if self.singular:
            unbalanced = np.abs(form.lacking(r, a)).max(initial=0.0)
            return None if unbalanced > _RESULTANT_TOL * max(problem.scale, np.abs(r).max()) else (r, a, h)
        h = unknowns.prescribed(h)
        for _ in range(2 if form.as_posed else 0):
            error = problem.misfit(h, r)
            if np.abs(error).max(initial=0.0) <= REFINE * problem.scale:
                break
            image = problem.image
            response, push = image.free_motion(error), image.R.T @ error
            dx = self._back(-np.concatenate([unknowns.seen(problem.by_pair(response)), push]))
            dr, da = unknowns.forces(dx[:size]), dx[size:]
            dh = symmetric_product(image.A, dr.ravel()) + response + image.R @ da
            r, a, h = r + dr, a + da, unknowns.prescribed(h + problem.by_pair(dh))
        return r, a, h

    def _back(self, rhs: Array) -> Array:
        if not len(rhs):
            return rhs
        x, _ = lapack.dgetrs(self.lu, self.pivots, rhs)
        return np.asarray(x, dtype=np.float64)

    def _least_change(self, rhs: Array, r: Array, a: Array) -> Array:
        """A solution in the least-squares sense, near the forces given."""
        x, matrix = np.concatenate([self.unknowns.coordinates(r), a]), _matrix(self.equilibrium, self.unknowns)
        for _ in range(2):
            x = x + lstsq(matrix, rhs - matrix @ x, cond=_RANK_TOL, lapack_driver="gelsy")[0]
        return np.asarray(x, dtype=np.float64)


def linear_system(equilibrium: Equilibrium, law: Tangent) -> LinearSystem:
    """Set up and factorise the system of one linear law.

    Parameters
    ----------
    equilibrium : what balances
    law : the law of every pair, linear

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.2, 0.1]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> system = linear_system(Equilibrium(problem=problem), problem.law.sticking)
    >>> r, a, h = system.solve(np.zeros((3, 1)), np.zeros(0))
    >>> r.round(12).tolist(), h.tolist(), system.index
    ([[2.0], [-0.4], [-0.2]], [[0.0], [0.0], [0.0]], 1)
    """
    unknowns = Unknowns(law)
    lu, singular = _matrix(equilibrium, unknowns), False
    pivots: IntArray = np.zeros(0, dtype=np.int64)
    if len(lu):
        norm = float(lapack.dlange("1", lu))
        pivots, failed = factorise_with_pivots(lu)
        singular = bool(failed) or float(lapack.dgecon(lu, norm)[0]) < SINGULAR
    return LinearSystem(equilibrium=equilibrium, unknowns=unknowns, lu=lu, pivots=pivots, singular=singular)


def _matrix(equilibrium: Equilibrium, unknowns: Unknowns) -> Array:
    """Of the system, by columns."""
    image = equilibrium.problem.image
    return unknowns.matrix(image.A, image.R, equilibrium.alpha, equilibrium.beta)
