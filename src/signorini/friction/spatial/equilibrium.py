# SPDX-License-Identifier: BSD-3-Clause
"""Equilibrium in forces, and its solution where the law of every pair is linear: one system in what is unknown.

In the force form (see `condense.image`) with an optional proximal layer of compliance alpha around r_0, and springs
of stiffness beta that pull the rigid motions to a_0::

    h = A r + c + R a + alpha (r - r_0),    R'(r + b) = beta (a - a_0)

Unknown are the normal force p of every closed pair, the tangential forces left by the law, q, and the motion a. With Z
the forces of a unit of each, Y the motions that the law prescribes (gap 0; slip 0 where it sticks; ``tau . h = -kappa
q`` where it slips) and r_f the known forces::

    [ Y'(A + alpha) Z + diag   Y'R    ] [ p, q ]     [ Y'((A + alpha) r_f + c - alpha r_0) ]
    [ Z'R                     -beta   ] [ a    ] = - [ R'(r_f + b) + beta a_0               ]

Open pairs take no part. With alpha, beta > 0 the system is regular for small friction whatever A and R are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack, lstsq

from signorini.arrays import Array, IntArray
from signorini.condense.operator import symmetric_product
from signorini.friction.spatial.law import SpatialTangent
from signorini.friction.spatial.problem import SpatialProblem

SINGULAR = 1e-13
"""Reciprocal condition below which a system counts as singular."""

REFINE = 1e-13
"""Misfit, relative to scale, above which a solution is refined."""

_FEW = 200  # rows of the pairs up to which arrays of zeros cost less than sparse ones


@dataclass(frozen=True, kw_only=True)
class Equilibrium:
    """Forces and motions in balance, with or without a proximal layer and springs.

    Attributes
    ----------
    problem : the problem
    alpha : compliance of the layer, in units of 1 / D; 0 for the problem as posed
    beta : stiffness of the springs, in units of D; 0 for the problem as posed
    force, motion : (3n,) r_0 and (k,) a_0 that the layer and the springs are relaxed at
    """

    problem: SpatialProblem
    alpha: float
    beta: float
    force: Array
    motion: Array

    @classmethod
    def of(cls, problem: SpatialProblem) -> Equilibrium:
        """The problem as posed."""
        k = problem.motions.shape[1]
        return cls(problem=problem, alpha=0.0, beta=0.0, force=np.zeros(3 * problem.pairs), motion=np.zeros(k))

    @property
    def as_posed(self) -> bool:
        """Whether there is neither layer nor spring."""
        return self.alpha == 0.0 and self.beta == 0.0

    @cached_property
    def offset(self) -> Array:
        """(3n,) ``c - alpha r_0``."""
        return self.problem.free_motion - self.alpha * self.force

    @cached_property
    def resultant(self) -> Array:
        """(k,) ``R'b + beta a_0``."""
        return self.problem.image.R.T @ self.problem.b + self.beta * self.motion

    def moved(self, r: Array, a: Array) -> Array:
        """(3n,) Motion h of the pairs under forces r and rigid motion a."""
        A, R = self.problem.image.A, self.problem.image.R
        return symmetric_product(A, r) + self.alpha * r + self.offset + R @ a

    def lacking(self, r: Array, a: Array) -> Array:
        """(k,) What the forces lack to balance the resultants."""
        return self.problem.image.R.T @ r + self.resultant - self.beta * a


@dataclass(frozen=True, kw_only=True)
class LinearSystem:
    """The factorised system of one linearised law; build it with `linear_system`."""

    equilibrium: Equilibrium
    law: SpatialTangent
    matrix: Array
    lu: Array
    pivots: IntArray
    singular: bool
    forces: Array | sp.csc_array
    motions: Array | sp.csc_array

    def solve(self, r: Array, a: Array) -> tuple[Array, Array, Array] | None:
        """Forces r (3n,), rigid motion a (k,) and motions h (3n,) that balance under the linearised law.

        Where the system is singular, those of least change from the given r and a; None where nothing balances the
        resultants or the numbers fail.
        """
        form, problem = self.equilibrium, self.equilibrium.problem
        fixed = np.concatenate([np.zeros(problem.pairs), self.law.fixed.T.ravel()])
        motion = form.moved(fixed, np.zeros_like(a))
        rhs = -np.concatenate([self.motions.T @ motion, form.lacking(fixed, np.zeros_like(a))])
        x = self._least_change(rhs, r, a) if self.singular else self._back(rhs)
        if not np.isfinite(x).all():
            return None
        r, a, h = self._expand(x, fixed)
        if self.singular:
            unbalanced = np.abs(form.lacking(r, a)).max(initial=0.0) > 1e-9 * max(problem.scale, np.abs(r).max())
            return None if unbalanced else (r, a, h)
        for _ in range(2 if form.as_posed else 0):
            error = problem.misfit(h, r)
            if np.abs(error).max(initial=0.0) <= REFINE * problem.scale:
                break
            response, push = problem.image.free_motion(error), problem.image.R.T @ error
            dx = self._back(-np.concatenate([self.motions.T @ response, push]))
            dr, da = self.forces @ dx[: len(dx) - len(a)], dx[len(dx) - len(a) :]
            A, R = problem.image.A, problem.image.R
            r, a, h = r + dr, a + da, prescribed(self.law, h + A @ dr + response + R @ da)
        return r, a, h

    def _back(self, rhs: Array) -> Array:
        if not len(rhs):
            return rhs
        x, _ = lapack.dgetrs(self.lu, self.pivots, rhs)
        return np.asarray(x, dtype=np.float64)

    def _least_change(self, rhs: Array, r: Array, a: Array) -> Array:
        """A solution in the least-squares sense, near the forces given."""
        Z = self.forces
        weight = np.asarray((Z**2).sum(axis=0)).ravel()
        x = np.concatenate([(Z.T @ r) / np.where(weight > 0, weight, 1.0), a])
        for _ in range(2):
            x = x + lstsq(self.matrix, rhs - self.matrix @ x, cond=1e-12, lapack_driver="gelsy")[0]
        return np.asarray(x, dtype=np.float64)

    def _expand(self, x: Array, fixed: Array) -> tuple[Array, Array, Array]:
        size = self.forces.shape[1]
        r, a = self.forces @ x[:size] + fixed, x[size:]
        h = self.equilibrium.moved(r, a)
        return r, a, h if self.singular else prescribed(self.law, h)


def prescribed(law: SpatialTangent, h: Array) -> Array:
    """Motions (3n,) with the zeros that the law prescribes, free of rounding."""
    n = len(law.closed)
    stick = law.left == 2
    h = h.copy()
    h[:n][law.closed] = 0.0
    h[n : 2 * n][stick], h[2 * n :][stick] = 0.0, 0.0
    return h


def linear_system(equilibrium: Equilibrium, law: SpatialTangent) -> LinearSystem:
    """Set up and factorise the system of one linearised law.

    Parameters
    ----------
    equilibrium : what balances
    law : the law of every pair, linear

    Examples
    --------
    >>> from signorini.friction.spatial.law import sticking
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.2, 0.1]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> r, a, h = linear_system(Equilibrium.of(problem), sticking(problem)).solve(np.zeros(3), np.zeros(0))
    >>> r.round(12).tolist(), h.tolist()
    ([2.0, -0.4, -0.2], [0.0, 0.0, 0.0])
    """
    problem, alpha = equilibrium.problem, equilibrium.alpha
    forces, motions, resisting = directions(problem.pairs, law)
    taking = np.flatnonzero(np.asarray(abs(forces).sum(axis=1)).ravel() + np.asarray(abs(motions).sum(axis=1)).ravel())
    A, R = problem.image.A[np.ix_(taking, taking)], problem.image.R[taking]
    if alpha:
        A[np.diag_indices_from(A)] += alpha
    Y, Z = motions[taking].T, forces[taking]
    size, k = forces.shape[1], R.shape[1]
    matrix = np.zeros((size + k, size + k), order="F")
    matrix[:size, :size] = (Z.T @ (Y @ A).T).T
    matrix[:size, :size][np.diag_indices(size)] += resisting
    matrix[:size, size:] = Y @ R
    matrix[size:, :size] = (Z.T @ R).T
    matrix[size:, size:] = -equilibrium.beta * np.eye(k)
    lu, pivots, singular = matrix, np.zeros(0, dtype=np.int64), False
    if size + k:
        norm = float(np.abs(matrix).sum(axis=0).max())
        lu, pivots, failed = lapack.dgetrf(matrix)
        singular = bool(failed) or float(lapack.dgecon(lu, norm)[0]) < SINGULAR
    return LinearSystem(
        equilibrium=equilibrium,
        law=law,
        matrix=matrix,
        lu=lu,
        pivots=pivots,
        singular=singular,
        forces=forces,
        motions=motions,
    )


def directions(n: int, law: SpatialTangent) -> tuple[Array | sp.csc_array, Array | sp.csc_array, Array]:
    """Forces Z and motions Y (3n, size) of the unknowns, sparse where they are many, and kappa on the diagonal.

    Rows across a slip are divided by 1 + kappa: far from sticking they say q = 0, and not that kappa is huge.
    """
    closed, stick, one = np.flatnonzero(law.closed), np.flatnonzero(law.left == 2), np.flatnonzero(law.left == 1)
    c, s, m = len(closed), len(stick), len(one)
    size = c + 2 * s + m
    column = np.arange(c)
    across = c + 2 * s + np.arange(m)
    soft = 1.0 / (1.0 + law.kappa[one])

    def assembled(along: Array, weight: Array) -> Array | sp.csc_array:
        rows = [closed, n + closed, 2 * n + closed, n + stick, 2 * n + stick, n + one, 2 * n + one]
        columns = [column, column, column, c + np.arange(s), c + s + np.arange(s), across, across]
        values = [np.ones(c), along[:, 0], along[:, 1], np.ones(s), np.ones(s)]
        values += [weight * law.tau[one, 0], weight * law.tau[one, 1]]
        places = np.concatenate(rows), np.concatenate(columns)
        if 3 * n <= _FEW:
            dense = np.zeros((3 * n, size))
            dense[places] = np.concatenate(values)
            return dense
        matrix = sp.csc_array((np.concatenate(values), places), shape=(3 * n, size))
        matrix.eliminate_zeros()
        return matrix

    resisting = np.concatenate([np.zeros(c + 2 * s), law.kappa[one] * soft])
    return assembled(law.share[closed], np.ones(m)), assembled(np.zeros((c, 2)), soft), resisting
