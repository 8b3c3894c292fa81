# SPDX-License-Identifier: BSD-3-Clause
"""The inverse of a state's system, changed by rank one where a pair changes its state.

Unknown j < n is the normal force of pair j, n + j its tangential force, 2 n + i the rigid motion i; the system holds
those alone that a state leaves unknown, in any order, equations in the order of the unknowns (see `responses`).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import blas, lapack

from signorini.arrays import Array, IntArray
from signorini.friction.law import OPEN, STICK
from signorini.friction.problem import CoulombProblem

SINGULAR = 1e-13
"""Reciprocal condition below which a state counts as singular."""

SMALL = 1e-9
"""Pivot, relative to what cancels in it, below which the system is inverted afresh."""

REFRESH = 400
"""Changes after which the system is inverted afresh."""


ROOM = 64
"""Unknowns that an inverse may grow by before it is moved to larger memory."""


class SingularState(Exception):
    """Some load leaves the motions or the forces of a state undetermined."""


class StateInverse:
    """Inverse of the system of one state at a time.

    Parameters
    ----------
    problem : its bound of friction holds, its b does not matter

    Attributes
    ----------
    slope : (n,) tangential per normal force of slipping pairs, 0 of others
    factorisations, updates : inversions afresh and changes by one unknown so far

    Examples
    --------
    >>> problem = CoulombProblem(
    ...     W=np.diag([0.5, 0.5]), b=np.zeros(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> inverse = StateInverse(problem)
    >>> inverse.move_to(np.array([STICK]))
    >>> inverse.move_to(np.array([OPEN]))
    >>> inverse.unknowns.tolist(), inverse.factorisations, inverse.updates
    ([], 1, 2)
    """

    def __init__(self, problem: CoulombProblem) -> None:
        A, self._motions = problem.interface.A, problem.interface.R
        self._forces = np.hstack([A, self._motions])  # what all equations see of each, in rows
        equations = self._forces.shape[1]
        self._bound, self._n = problem.bound, problem.pairs
        self._state: IntArray | None = None
        self._columns = np.empty((equations, equations), order="F")  # of the unknowns, as all equations see them
        self._inverse = np.empty((0, 0), order="F")  # with room to grow
        self._place = np.full(equations, -1)  # of an unknown among those of the state
        self._list = np.empty(equations, dtype=np.int64)
        self._count = 0
        self.slope = np.zeros(problem.pairs)
        self.factorisations = self.updates = self._age = 0

    @property
    def unknowns(self) -> IntArray:
        """(m,) Those of the present state."""
        return self._list[: self._count]

    def move_to(self, state: IntArray) -> None:
        """Make it the inverse of another state.

        Raises
        ------
        SingularState
            Where that has none; the inverse is lost.
        """
        if self._state is not None:
            changes = np.flatnonzero(state != self._state)
            few = len(changes) <= max(4, self._count // 8) and self._age + len(changes) <= REFRESH
            slope = self._bound.slope(state)
            if few and all(self._change(int(k), int(state[k]), float(slope[k])) for k in changes):
                self._state = state.copy()
                return
        self._invert(state)

    def solve(self, free: Array) -> tuple[Array, Array]:
        """The (m,) unknowns x that bring their equations to zero, and ``free + columns x``, what all equations see.

        Parameters
        ----------
        free : (2n + k,) what the equations see of a load alone
        """
        m = self._count
        x = -(self._inverse[:m, :m] @ free[self.unknowns])
        return x, free + self._columns[:, :m] @ x

    def _invert(self, state: IntArray) -> None:
        self._state, self._age = None, 0
        self.factorisations += 1
        n = self._n
        closed, stick = np.flatnonzero(state != OPEN), np.flatnonzero(state == STICK)
        self.slope = self._bound.slope(state)
        forces = np.concatenate([closed, n + stick])
        m = self._count = len(forces) + self._motions.shape[1]
        self._list[:m] = np.concatenate([forces, np.arange(2 * n, len(self._list))])
        self._place[:] = -1
        self._place[self.unknowns] = np.arange(m)
        columns = self._columns[:, :m]
        columns[:, : len(forces)] = self._forces[forces].T
        columns[: 2 * n, len(forces) :], columns[2 * n :, len(forces) :] = self._motions, 0.0
        slips = np.flatnonzero(self.slope[closed])
        columns[:, slips] += (self._forces[n + closed[slips]] * self.slope[closed[slips], None]).T
        self._inverse = np.zeros((m + ROOM, m + ROOM), order="F")
        if m:
            matrix = np.asfortranarray(columns[self.unknowns])
            norm = float(np.abs(matrix).sum(axis=0).max())
            lu, order, failed = lapack.dgetrf(matrix, overwrite_a=1)
            if failed or lapack.dgecon(lu, norm)[0] < SINGULAR:
                raise SingularState
            self._inverse[:m, :m] = lapack.dgetri(lu, order, overwrite_lu=1)[0]
        self._state = state.copy()

    def _change(self, k: int, new: int, slope: float) -> bool:
        """One pair enters another state; False where the way there is (nearly) singular.

        A tangential force is added before, and removed after, the slope of its normal force changes: in its presence
        that only shares the same force otherwise.
        """
        assert self._state is not None
        old, n = int(self._state[k]), self._n
        self._age += 1
        if new == OPEN:
            steps = self._remove(k) and (old != STICK or self._remove(n + k))
            self.slope[k] = 0.0
            return steps
        if new == STICK and not self._add(n + k):
            return False
        if old == OPEN:
            self.slope[k] = slope
            return self._add(k)
        return self._tilt(k, slope) and (old != STICK or self._remove(n + k))

    def _add(self, j: int) -> bool:
        """Border the system by an unknown and its equation."""
        m, n, known = self._count, self._n, self.unknowns
        self._grow()
        column = self._columns[:, m]
        column[:] = self._forces[j]
        if j < n and self.slope[j]:
            column += self.slope[j] * self._forces[n + j]
        H, row = self._inverse[:m, :m], self._columns[j, :m]
        u, v = H @ column[known], row @ H
        pivot = column[j] - row @ u
        if abs(pivot) < SMALL * max(abs(column[j]), float(np.abs(row) @ np.abs(u))):
            return False
        self._add_product(1.0 / pivot, u, v)
        H = self._inverse
        H[:m, m], H[m, :m], H[m, m] = u / -pivot, v / -pivot, 1.0 / pivot
        self._list[m], self._place[j], self._count = j, m, m + 1
        return True

    def _remove(self, j: int) -> bool:
        """Take an unknown and its equation out; the last one takes its place."""
        H, i, last = self._inverse, self._place[j], self._count - 1
        u, v = H[: last + 1, i].copy(), H[i, : last + 1].copy()
        pivot = u[i]
        u[i], v[i] = u[last], v[last]
        H[: last + 1, i] = H[: last + 1, last]
        H[i, : last + 1] = H[last, : last + 1]
        self._columns[:, i] = self._columns[:, last]
        moved = self._list[last]
        self._list[i], self._place[moved], self._place[j], self._count = moved, i, -1, last
        u, v = u[:last], v[:last]
        if abs(pivot) < SMALL * max(np.abs(u).max(initial=0.0), np.abs(v).max(initial=0.0)):
            return False
        self._add_product(-1.0 / pivot, u, v)
        return True

    def _tilt(self, k: int, slope: float) -> bool:
        """Give the normal force of a pair another share of friction."""
        m, n, H = self._count, self._n, self._inverse
        share, i, t = slope - self.slope[k], self._place[k], self._place[n + k]
        if share == 0.0:
            return True
        self.slope[k] = slope
        change = share * self._forces[n + k]
        if t >= 0:  # what is left of the tangential force is an unknown
            H[t, :m] -= share * H[i, :m]
        elif change.any():
            u = H[:m, :m] @ change[self.unknowns]
            pivot = 1.0 + u[i]
            if abs(pivot) < SMALL * max(1.0, float(np.abs(u).max())):
                return False
            self._add_product(-1.0 / pivot, u, H[i, :m].copy())
        self._columns[:, i] += change
        return True

    def _add_product(self, factor: float, u: Array, v: Array) -> None:
        """Change the inverse by ``factor u v^T``, in place."""
        self.updates += 1
        m = len(u)
        if m:
            padded = np.zeros(len(self._inverse))
            padded[:m] = u
            blas.dger(factor, padded, v, a=self._inverse[:, :m], overwrite_x=0, overwrite_y=0, overwrite_a=1)

    def _grow(self) -> None:
        """Room for one more unknown."""
        m = self._count
        if m == len(self._inverse):
            larger = np.zeros((m + ROOM, m + ROOM), order="F")
            larger[:m, :m] = self._inverse
            self._inverse = larger
