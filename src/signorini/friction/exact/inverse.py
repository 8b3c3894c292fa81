# SPDX-License-Identifier: BSD-3-Clause
"""The inverse of a state's system, changed by rank one where a pair changes its state.

Unknown j < n is the normal force of pair j, n + j its tangential force, 2 n + i the rigid motion i; the system holds
those alone that a state leaves unknown, in any order, equations in the order of the unknowns (see `responses`).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray
from signorini.friction.law import OPEN, STICK
from signorini.friction.problem import CoulombProblem

SINGULAR = 1e-13
"""Reciprocal condition below which a state counts as singular."""

SMALL = 1e-9
"""Pivot, relative to what cancels in it, below which the system is inverted afresh."""

REFRESH = 400
"""Changes after which the system is inverted afresh."""


class SingularState(Exception):
    """Some load leaves the motions or the forces of a state undetermined."""


class StateInverse:
    """Inverse of the system of one state at a time.

    Parameters
    ----------
    problem : its bound of friction holds, its b does not matter

    Attributes
    ----------
    unknowns : (m,) those of the present state
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
        A, R = problem.interface.A, problem.interface.R
        k = R.shape[1]
        self._full = np.block([[A, R], [R.T, np.zeros((k, k))]])
        self._n, self._motions, self._bound = problem.pairs, len(A) + np.arange(k), problem.bound
        self._state: IntArray | None = None
        self._buffer = np.zeros_like(self._full)
        self.unknowns = self._motions
        self.slope = np.zeros(problem.pairs)
        self.factorisations = self.updates = self._age = 0

    def move_to(self, state: IntArray) -> None:
        """Make it the inverse of another state.

        Raises
        ------
        SingularState
            Where that has none; the inverse is lost.
        """
        if self._state is not None:
            changes = np.flatnonzero(state != self._state)
            few = len(changes) <= max(4, len(self.unknowns) // 8) and self._age + len(changes) <= REFRESH
            slope = self._bound.slope(state)
            if few and all(self._change(int(k), int(state[k]), float(slope[k])) for k in changes):
                self._state = state.copy()
                return
        self._invert(state)

    def apply(self, rhs: Array) -> Array:
        """(m,) Unknowns of a right-hand side given over all equations, (2n + k,)."""
        m = len(self.unknowns)
        return self._buffer[:m, :m] @ rhs[self.unknowns]

    def _invert(self, state: IntArray) -> None:
        self._state, self._age = None, 0
        self.factorisations += 1
        closed, stick = np.flatnonzero(state != OPEN), self._n + np.flatnonzero(state == STICK)
        self.unknowns = np.concatenate([closed, stick, self._motions])
        self.slope = self._bound.slope(state)
        matrix = np.asfortranarray(self._columns(self.unknowns)[self.unknowns])
        m = len(matrix)
        if m:
            norm = float(np.abs(matrix).sum(axis=0).max())
            lu, order, failed = lapack.dgetrf(matrix, overwrite_a=1)
            if failed or lapack.dgecon(lu, norm)[0] < SINGULAR:
                raise SingularState
            self._buffer[:m, :m] = lapack.dgetri(lu, order, overwrite_lu=1)[0]
        self._state = state.copy()

    def _columns(self, unknowns: IntArray) -> Array:
        """(2n + k, m) What all equations see of some unknowns."""
        columns = self._full[:, unknowns]
        normal = np.flatnonzero(unknowns < self._n)
        columns[:, normal] += self._full[:, self._n + unknowns[normal]] * self.slope[unknowns[normal]]
        return columns

    def _change(self, k: int, new: int, slope: float) -> bool:
        """One pair enters another state; False where the way there is (nearly) singular.

        A tangential force is added before, and removed after, the slope of its normal force changes: in its presence
        that is a change of columns alone, and the determinant stays.
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
        m, known, H = len(self.unknowns), self.unknowns, self._buffer
        column = self._columns(np.array([j]))[:, 0]
        row = self._full[j, known]
        normal = np.flatnonzero(known < self._n)
        row[normal] += self._full[j, self._n + known[normal]] * self.slope[known[normal]]
        u, v = H[:m, :m] @ column[known], row @ H[:m, :m]
        pivot = column[j] - row @ u
        self.updates += 1
        if abs(pivot) < SMALL * max(abs(column[j]), float(np.abs(row) @ np.abs(u))):
            return False
        H[:m, :m] += np.multiply.outer(u / pivot, v)
        H[:m, m], H[m, :m], H[m, m] = -u / pivot, -v / pivot, 1.0 / pivot
        self.unknowns = np.append(known, j)
        return True

    def _remove(self, j: int) -> bool:
        """Take an unknown and its equation out."""
        H, known, last = self._buffer, self.unknowns, len(self.unknowns) - 1
        i = int(np.flatnonzero(known == j)[0])
        H[[i, last], : last + 1] = H[[last, i], : last + 1]
        H[: last + 1, [i, last]] = H[: last + 1, [last, i]]
        known[[i, last]] = known[[last, i]]
        self.unknowns = known[:last]
        u, v, pivot = H[:last, last].copy(), H[last, :last].copy(), H[last, last]
        self.updates += 1
        if abs(pivot) < SMALL * max(np.abs(u).max(initial=0.0), np.abs(v).max(initial=0.0)):
            return False
        H[:last, :last] -= np.multiply.outer(u / pivot, v)
        return True

    def _tilt(self, k: int, slope: float) -> bool:
        """Give the normal force of a pair another share of friction."""
        m, known, H = len(self.unknowns), self.unknowns, self._buffer
        change = (slope - self.slope[k]) * self._full[known, self._n + k]
        self.slope[k] = slope
        if not change.any():
            return True
        i = int(np.flatnonzero(known == k)[0])
        u = H[:m, :m] @ change
        pivot = 1.0 + u[i]
        self.updates += 1
        if abs(pivot) < SMALL * max(1.0, float(np.abs(u).max())):
            return False
        H[:m, :m] -= np.multiply.outer(u / pivot, H[i, :m].copy())
        return True
