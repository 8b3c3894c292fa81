# SPDX-License-Identifier: BSD-3-Clause
"""The inverse of a state's system, changed by one rank for each unknown where pairs change their states.

Unknown j < n is the normal force of pair j, n + j its tangential force, 2 n + i the rigid motion i; the system holds
those alone that a state leaves unknown, in any order, equations in the order of the unknowns (see `responses`).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray
from signorini.friction.linear import SINGULAR
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, STICK
from signorini.linalg.changed_inverse import ChangedInverse
from signorini.linalg.shared_dense import inverse_of_factors, product

PIVOT_TOL = 1e-9
"""Pivot, relative to what cancels in it, below which the system is factorised afresh."""

REFRESH = 400
"""Changes of state after which the system is factorised afresh."""

_SCATTERED = 3
"""Forces of all to one that acts up to which a product reads all of the compliance: gathered rows are written, too."""


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
    factorisations, updates : factorisations afresh and changes by one unknown so far

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.zeros(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> inverse = StateInverse(problem)
    >>> inverse.move_to(np.array([STICK]))
    >>> inverse.move_to(np.array([OPEN]))
    >>> inverse.unknowns.tolist(), inverse.factorisations, inverse.updates
    ([], 1, 2)
    """

    def __init__(self, problem: ContactProblem) -> None:
        self._A, self._motions = problem.image.A, problem.image.R
        equations = sum(self._motions.shape)
        self._bound, self._n = problem.pieces, problem.pairs
        self._state: IntArray | None = None
        self._inverse = ChangedInverse(np.empty((0, 0), order="F"))
        self._place = np.full(equations, -1)  # of an unknown among those of the state
        self._list = np.empty(equations, dtype=np.int64)
        self._count = 0
        self.slope = np.zeros(problem.pairs)
        self.factorisations = self.updates = self._age = 0

    @property
    def rows(self) -> int:
        """Equations in all, 2n + k."""
        return len(self._list)

    @property
    def unknowns(self) -> IntArray:
        """(m,) Those of the present state."""
        return self._list[: self._count]

    @property
    def matrix(self) -> Array:
        """(m, m) The inverse of the present state: a view, rows and columns by the places of the unknowns."""
        return self._inverse.whole

    @property
    def place(self) -> IntArray:
        """(2n + k,) Of each unknown among those of the present state, -1 of others."""
        return self._place

    def seen(self, x: Array) -> Array:
        """(2n + k,) What all equations see of unknowns, (m,)."""
        n, full = self._n, np.zeros(self.rows)
        full[self.unknowns] = x
        full[n : 2 * n] += self.slope * full[:n]
        forces, motion = full[: 2 * n], full[2 * n :]
        acting = np.flatnonzero(forces)
        scattered = _SCATTERED * len(acting) < 2 * n
        moved = forces[acting] @ self._A[acting] if scattered else product(self._A, forces)
        return np.concatenate([moved + self._motions @ motion, self._motions.T @ forces])

    def move_to(self, state: IntArray) -> None:
        """Make it the inverse of another state.

        Raises
        ------
        SingularState
            Where that has none; the inverse is lost.
        """
        if self._state is not None:
            changes = np.flatnonzero(state != self._state)
            few = len(changes) <= max(4, self._count // 4) and self._age < REFRESH
            if few and self._change(state):
                self._state = state.copy()
                return
        self._factorise(state)

    def solve(self, free: Array) -> tuple[Array, Array]:
        """The (m,) unknowns x that bring their equations to zero, and ``free + columns x``, what all equations see.

        Parameters
        ----------
        free : (2n + k,) what the equations see of a load alone
        """
        x = -self._inverse.times(free[self.unknowns])
        return x, free + self.seen(x)

    def _factorise(self, state: IntArray) -> None:
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
        matrix = np.zeros((m, m), order="F")
        matrix.T[: len(forces), : len(forces)] = self._A[np.ix_(forces, forces)]
        slips = np.flatnonzero(self.slope[closed])
        pairs, share = closed[slips], self.slope[closed[slips]]
        matrix.T[slips, : len(forces)] += share[:, None] * self._A[np.ix_(n + pairs, forces)]
        matrix[: len(forces), len(forces) :] = self._motions[forces]
        matrix[len(forces) :, : len(forces)] = self._motions[forces].T
        matrix[len(forces) :, slips] += share * self._motions[n + pairs].T
        self._inverse = ChangedInverse(matrix, symmetric=not len(slips) and m == len(forces))
        if self._inverse.condition < SINGULAR:
            raise SingularState
        self._state = state.copy()

    def _change(self, state: IntArray) -> bool:
        """Some pairs enter other states, all at once; False where the way there is (nearly) singular.

        Tangential forces are added before, and removed after, the slopes of normal forces change: in their presence
        that only shares the same forces otherwise.
        """
        assert self._state is not None
        old, n, slope = self._state, self._n, self._bound.slope(state)
        which = np.flatnonzero(state != old)
        self._age += 1
        before, after = old[which], state[which]
        closes, opens = which[before == OPEN], which[after == OPEN]
        self.slope[closes] = slope[closes]
        sticks, lets_go = which[after == STICK], which[before == STICK]
        stays = which[(before != OPEN) & (after != OPEN)]
        if not (self._add(np.concatenate([n + sticks, closes])) and self._tilt(stays, slope[stays])):
            return False
        self.slope[opens] = 0.0
        return self._remove(np.concatenate([n + lets_go, opens]))

    def _add(self, new: IntArray) -> bool:
        """Border the system by unknowns and their equations."""
        if not len(new):
            return True
        m, n, known, k = self._count, self._n, self.unknowns, len(new)
        felt = self._felt(new)  # and what their forces move: the system is symmetric but for slopes
        columns, rows = felt.copy(), felt[:, known]
        normal = np.flatnonzero(new < n)
        normal = normal[self.slope[new[normal]] != 0.0]
        columns[normal] += self.slope[new[normal], None] * self._felt(n + new[normal])
        normal = np.flatnonzero(known < n)
        rows[:, normal] += felt[:, n + known[normal]] * self.slope[known[normal]]
        u = self._inverse.times(columns[:, known].T)
        v = self._inverse.transposed_times(rows.T).T
        size = max(np.abs(columns[:, new]).max(), (np.abs(rows) @ np.abs(u)).max(initial=0.0))
        pivot = _inverted(columns[:, new].T - rows @ u, size)
        if pivot is None:
            return False
        self._inverse.border(k)
        self._add_product(np.vstack([u @ pivot, -pivot]), np.hstack([v, -np.eye(k)]))
        self._list[m : m + k], self._place[new], self._count = new, np.arange(m, m + k), m + k
        return True

    def _remove(self, old: IntArray) -> bool:
        """Take unknowns and their equations out; the last ones take their places."""
        if not len(old):
            return True
        places, left = self._place[old], self._count - len(old)
        out = np.zeros(self._count, dtype=np.bool_)
        out[places] = True
        free, last = np.flatnonzero(out[:left]), left + np.flatnonzero(~out[left:])
        order = np.arange(left)
        order[free] = last
        u, v = self._inverse.columns(places), self._inverse.rows(places)
        block, u, v = u[places], u[order], v[:, order]
        self._inverse.keep(order)
        self._list[free] = self._list[last]
        self._place[old] = -1
        self._place[self._list[free]], self._count = free, left
        pivot = _inverted(block, max(np.abs(u).max(initial=0.0), np.abs(v).max(initial=0.0)))
        if pivot is None:
            return False
        self._add_product(u @ -pivot, v)
        return True

    def _tilt(self, pairs: IntArray, slope: Array) -> bool:
        """Give normal forces of pairs other shares of friction."""
        share = slope - self.slope[pairs]
        pairs, share = pairs[share != 0.0], share[share != 0.0]
        if not len(pairs):
            return True
        n, inverse = self._n, self._inverse
        i, t = self._place[pairs], self._place[n + pairs]
        self.slope[pairs] += share
        held = t >= 0  # what is left of the tangential force is an unknown
        if held.any():
            moved = np.zeros((self._count, np.count_nonzero(held)))
            moved[t[held], np.arange(moved.shape[1])] = -share[held]
            self._add_product(moved, inverse.rows(i[held]))
        if held.all():
            return True
        i = i[~held]
        u = inverse.times((self._felt(n + pairs[~held])[:, self.unknowns] * share[~held, None]).T)
        pivot = _inverted(np.eye(len(i)) + u[i], max(1.0, float(np.abs(u).max())))
        if pivot is None:
            return False
        self._add_product(u @ -pivot, inverse.rows(i))
        return True

    def _felt(self, rows: IntArray) -> Array:
        """(k, 2n + motions) What the equations of some forces see of all forces, and of the rigid motions."""
        return np.hstack([self._A[rows], self._motions[rows]])

    def _add_product(self, u: Array, v: Array) -> None:
        """Change the inverse by ``u v``."""
        self.updates += u.shape[1]
        self._inverse.add(u, v)


def _inverted(block: Array, size: float) -> Array | None:
    """Inverse of a block that pivots, None where it is next to singular beside what cancels in it, of a size."""
    if len(block) == 1:
        return None if abs(block[0, 0]) < PIVOT_TOL * size else 1.0 / block
    lu, order, failed = lapack.dgetrf(block)
    if failed or np.abs(np.diag(lu)).min() < PIVOT_TOL * size:
        return None
    found = np.empty_like(lu)
    inverse_of_factors(lu, order, found)
    return found
