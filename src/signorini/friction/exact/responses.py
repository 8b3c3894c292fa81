# SPDX-License-Identifier: BSD-3-Clause
"""Motions and forces of the pairs under a load, with every pair's state given: the linear map behind the path.

In the force form (see `signorini.friction.cone`) a state leaves these unknowns: the normal force of every closed pair,
the tangential force of those that stick, and the rigid motion. Slipping pairs carry ``r_t = s mu p``; open pairs take
no part.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray
from signorini.friction.exact.rates import SIGN
from signorini.friction.law import OPEN, STICK
from signorini.friction.problem import CoulombProblem

SINGULAR = 1e-13
"""Reciprocal condition below which a state counts as singular."""


class SingularState(Exception):
    """Some load leaves the motions or the forces of a state undetermined."""


class Responses:
    """Responses of an interface in changing states; keeps the factorisation of the last one.

    Parameters
    ----------
    problem : its mu holds, its b does not matter

    Attributes
    ----------
    pivots, factorisations, updates : what it has done so far

    Examples
    --------
    >>> problem = CoulombProblem(
    ...     W=np.diag([0.5, 0.5]), b=np.zeros(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> h, r = Responses(problem).respond(np.array([STICK]), np.array([-1.0, 0.2]))
    >>> h.round(12).tolist(), r.round(12).tolist()
    ([0.0, 0.0], [2.0, -0.4])
    """

    def __init__(self, problem: CoulombProblem) -> None:
        self.problem = problem
        self.pivots = self.factorisations = self.updates = 0
        self._state: IntArray | None = None

    def respond(self, state: IntArray, b: Array, *, refine: bool = True) -> tuple[Array, Array]:
        """Motion h and force r, (2n,), with ``G h - W r = b``, h = 0 where a state holds and r = 0 where it is open.

        Raises
        ------
        SingularState
            Where the state has no unique response.
        """
        self._move_to(state)
        h, r = self._once(b)
        if refine:
            dh, dr = self._once(b + self.problem.W @ (h + r) - h)
            h, r = h + dh, r + dr
        return h, r

    def _once(self, b: Array) -> tuple[Array, Array]:
        m, n = self.problem.interface, self.problem.pairs
        c = m.free_motion(b)
        rhs = -np.concatenate([c[self._rows], m.R.T @ b])
        x = self._solve(rhs)
        forces = x[: len(self._rows)]
        r = np.zeros(2 * n)
        r[self._rows] = forces
        r[n:] += self._slope * r[:n]
        acting = np.flatnonzero(r)
        h = r[acting] @ m.A[acting] + c + m.R @ x[len(self._rows) :]
        h[self._rows] = 0.0
        return h, r

    def _move_to(self, state: IntArray) -> None:
        if self._state is not None and np.array_equal(state, self._state):
            return
        self.pivots += 1
        self._factorise(state)
        self._state = state.copy()

    def _factorise(self, state: IntArray) -> None:
        m, n = self.problem.interface, self.problem.pairs
        self._state = None
        self.factorisations += 1
        self._rows = np.concatenate([np.flatnonzero(state != OPEN), n + np.flatnonzero(state == STICK)])
        self._slope = SIGN[state] * self.problem.mu
        rows, R = self._rows, m.R
        tangents, slope = n + rows % n, np.where(rows < n, self._slope[rows % n], 0.0)
        size, k = len(rows), R.shape[1]
        matrix = np.zeros((size + k, size + k), order="F")
        matrix[:size, :size] = m.A[np.ix_(rows, rows)] + m.A[np.ix_(rows, tangents)] * slope
        matrix[:size, size:] = R[rows]
        matrix[size:, :size] = (R[rows] + R[tangents] * slope[:, None]).T
        if not len(matrix):
            self._lu, self._order = matrix, np.zeros(0, dtype=np.int64)
            return
        norm = float(np.abs(matrix).sum(axis=0).max())
        self._lu, self._order, failed = lapack.dgetrf(matrix, overwrite_a=1)
        if failed or lapack.dgecon(self._lu, norm)[0] < SINGULAR:
            raise SingularState

    def _solve(self, rhs: Array) -> Array:
        if not len(rhs):
            return rhs
        x, _ = lapack.dgetrs(self._lu, self._order, rhs)
        return np.asarray(x, dtype=np.float64)
