# SPDX-License-Identifier: BSD-3-Clause
"""Responses of many states in the plane, one after the other: from the inverse of one state that holds all they hold.

Of a few neighbouring states, between which few pairs change, one holds more than each: every pair that changes sticks
in it. With X the inverse of its system, x the unknown forces and f what their equations see of a load, each of the
states has relations ``G x = 0`` (no force of an open pair, ``r_t = s mu p`` of one that slips) in place of as many
equations, E, whose motions mu are free::

    x = -X f + X E mu,    (G X E) mu = G X f

So there is one small system a state; the inverse is changed for all of them at once, with products of matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.history.plane.state_inverse import SingularState, StateInverse
from signorini.friction.linear import SINGULAR
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, STICK

_CHANGES = 16  # pairs that may change in a block: more cost more in each of its states than another block

LONGEST_BLOCK = 64
"""States that are looked at ahead."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Relations:
    """What one state has in place of equations of the state that holds all.

    Attributes
    ----------
    freed : (q,) places of the equations among the unknowns
    rows : (q, m) of ``G X``
    lu, pivots : factors of ``G X E``, (q, q)
    """

    freed: IntArray
    rows: Array
    lu: Array
    pivots: IntArray


class StateBlocks:
    """Responses in states that come one after the other.

    Parameters
    ----------
    problem : its bound of friction holds, its b does not matter
    """

    def __init__(self, problem: ContactProblem) -> None:
        self._inverse = StateInverse(problem)
        self._A, self._R, self._bound, self._n = problem.image.A, problem.image.R, problem.pieces, problem.pairs
        self._all: IntArray | None = None  # the state that holds all
        self._changed: IntArray = np.zeros(0, dtype=np.int64)  # pairs that may be in other states,
        self._may = np.zeros(problem.pairs, dtype=np.bool_)  # which these are
        self._rows = np.zeros((2, 0, 0))  # of X, of their tangential and of their normal forces
        self._relations: dict[bytes, _Relations] = {}

    def covers(self, state: IntArray) -> bool:
        """Whether a state is one of those that are prepared for."""
        return self._all is not None and bool(((state == self._all) | self._may).all())

    def ahead(self, states: Sequence[IntArray]) -> None:
        """Prepare for as many of the states (n,) that come next, in order, as have few changes among them."""
        first, codes = states[0], np.stack(states)
        changed = np.logical_or.accumulate(codes != first, axis=0)
        last = int(np.searchsorted(changed.sum(axis=1), _CHANGES, side="right")) - 1
        try:
            self._move_to(np.where(changed[last], STICK, first), changed[last])
        except SingularState:
            self._move_to(first, np.zeros_like(self._may))

    def respond(self, state: IntArray, free: Array) -> tuple[Array, Array]:
        """Motion and force, (2, n), of a load as the equations see it, see `Responses.respond`.

        Parameters
        ----------
        state : (n,) codes
        free : (2n + k,) of the load

        Raises
        ------
        SingularState
            Where the state has no unique response.
        """
        known, inverse, n = self._of(state), self._inverse, self._n
        unknowns, X = inverse.unknowns, inverse.matrix
        x = -(X @ free[unknowns])
        moved = np.zeros(0)
        if len(known.freed):
            moved = _back(known, known.rows @ free[unknowns], 0)
            x += X[:, known.freed] @ moved
        full = np.zeros(len(free))
        full[unknowns] = x
        r = full[: 2 * n].reshape(2, n)
        r[1] += inverse.slope * r[0]
        seen = free + inverse.seen(x)
        seen[unknowns] = 0.0
        seen[unknowns[known.freed]] = moved
        return seen[: 2 * n].reshape(2, n), r

    def respond_transposed(self, state: IntArray, h: Array, r: Array) -> Array:
        """(2n + k,) The transpose of `respond`: what a functional of motions and forces is of the load.

        Parameters
        ----------
        state : (n,) codes
        h, r : (2, n) the functional

        Raises
        ------
        SingularState
            Where the state has no unique response.
        """
        known, inverse, n = self._of(state), self._inverse, self._n
        unknowns, X = inverse.unknowns, inverse.matrix
        seen = np.zeros(inverse.rows)
        seen[: h.size] = h.ravel()
        of_freed = seen[unknowns[known.freed]]
        seen[unknowns] = 0.0
        pushed = np.zeros(inverse.rows)
        pushed[:n], pushed[n : 2 * n] = r[0], r[1]
        there = np.flatnonzero(seen)
        if len(there):  # what forces move of it: rows of the compliance, which is symmetric
            given = seen[there]
            pushed[: 2 * n] += given @ self._A[there]
            pushed[2 * n :] = given @ self._R[there]
        pushed[:n] += inverse.slope * pushed[n : 2 * n]
        w = X.T @ pushed[unknowns]
        if len(known.freed):
            w[known.freed] += of_freed
            w -= _back(known, w[known.freed], 1) @ known.rows
        seen[unknowns] = -w
        seen[unknowns[known.freed]] = of_freed
        return seen

    def _move_to(self, state: IntArray, may: BoolArray) -> None:
        """Prepare for a state and those in which some pairs, (n,), that stick in it are in others."""
        self._all, self._relations = None, {}
        self._inverse.move_to(state)
        self._all, self._may, self._changed = state, may, np.flatnonzero(may)
        place = self._inverse.place
        self._rows = self._inverse.matrix[np.stack([place[self._n + self._changed], place[self._changed]])]

    def _of(self, state: IntArray) -> _Relations:
        """The relations of a state, kept; the inverse moves where that is not one it is for."""
        key = state.tobytes()
        if self._all is not None and key in self._relations:
            return self._relations[key]
        if not self.covers(state):
            self._move_to(state, np.zeros_like(self._may))
        among = np.flatnonzero(state[self._changed] != STICK)  # of the pairs that may change
        pairs, place = self._changed[among], self._inverse.place
        opens = state[pairs] == OPEN
        slope = np.where(opens, 0.0, self._bound.slope(state)[pairs])
        freed = np.concatenate([place[self._n + pairs], place[pairs[opens]]])
        tangents, normals = self._rows[:, among]
        rows = np.concatenate([tangents - slope[:, None] * normals, normals[opens]])
        found = _Relations(freed=freed, rows=rows, lu=np.zeros((0, 0)), pivots=freed[:0])
        if len(freed):
            lu, pivots, failed = lapack.dgetrf(rows[:, freed])
            if failed or np.abs(np.diag(lu)).min() <= SINGULAR * np.abs(lu).max():
                raise SingularState
            found = _Relations(freed=freed, rows=rows, lu=lu, pivots=pivots)
        self._relations[key] = found
        return found


def _back(known: _Relations, rhs: Array, transposed: int) -> Array:
    """The solution of the small system of a state, or of its transpose."""
    return np.asarray(lapack.dgetrs(known.lu, known.pivots, rhs, trans=transposed)[0], dtype=np.float64)
