# SPDX-License-Identifier: BSD-3-Clause
"""What an interface answers while its closed pairs hold: the forces that a load, and motions of the pairs, call up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.problem import ContactProblem


@dataclass(frozen=True, kw_only=True, eq=False)
class StickingResponse:
    """The interface with rows that hold; all others are free of force, and move as they must.

    With x = h + r the held rows c and the free ones o obey::

        h_c = b_c' + W_c' x_c,    W_c' = W_cc + W_co G_oo^-1 W_oc,    b_c' = b_c + W_co G_oo^-1 b_o

    Attributes
    ----------
    problem : the problem, its b included
    rows : (c,) of h and r that hold
    place : (3 n,) where a row stands in ``rows``, -1 where it does not
    force : (c,) forces under the load while nothing held moves

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.5, 0.0]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> held = StickingResponse.of(problem, np.array([True]), np.array([True]))
    >>> (held.force.round(12) + 0.0).tolist(), held.forces(np.array([0.0, 0.1, 0.0])).round(12).tolist()
    ([2.0, -1.0, 0.0], [0.0, 0.1, 0.0])
    """

    problem: ContactProblem
    rows: IntArray
    place: IntArray
    force: Array
    _free: IntArray
    _coupling: Array
    _drift: Array
    _factor: tuple[Array, bool]

    @classmethod
    def of(cls, problem: ContactProblem, closed: BoolArray, rubs: BoolArray) -> StickingResponse | None:
        """The interface of a problem whose closed pairs, (n,), hold; None where that leaves forces undetermined.

        Parameters
        ----------
        problem : the problem, its b included
        closed, rubs : (n,) pairs that are closed, and those of them with friction
        """
        W, b, n = problem.W, problem.b, problem.pairs
        tangents = (rubs & ~problem.locked & (problem.section.axes > 0)).ravel()
        holds = np.concatenate([closed, tangents])
        still = np.concatenate([np.zeros(n, dtype=np.bool_), problem.locked.ravel()])
        c, o = np.flatnonzero(holds), np.flatnonzero(~holds & ~still)
        place = np.full(3 * n, -1)
        place[c] = np.arange(len(c))
        try:
            G = cho_factor(np.eye(len(o)) - W[np.ix_(o, o)], lower=True)
            answer = cho_solve(G, np.column_stack([W[np.ix_(o, c)], b[o]]))
            factor = cho_factor(W[np.ix_(c, c)] + W[np.ix_(c, o)] @ answer[:, :-1], lower=True)
        except np.linalg.LinAlgError:
            return None
        drift = b[c] + W[np.ix_(c, o)] @ answer[:, -1]
        return cls(
            problem=problem,
            rows=c,
            place=place,
            force=-cho_solve(factor, drift),
            _free=o,
            _coupling=answer[:, :-1],
            _drift=answer[:, -1],
            _factor=factor,
        )

    def forces(self, motion: Array) -> Array:
        """(c,) or (c, m) Forces of motions of the held rows, without the load."""
        return np.asarray(cho_solve(self._factor, motion) - motion, dtype=np.float64)

    def whole(self, motion: Array) -> tuple[Array, Array]:
        """Motions h and forces r of all pairs, each (3, n), under the load and motions (c,) of the held rows."""
        h, r = self.problem.b.copy(), np.zeros(3 * self.problem.pairs)
        r[self.rows] = self.force + self.forces(motion)
        h[self.rows] = motion
        h[self._free] = self._drift + self._coupling @ (motion + r[self.rows])
        return self.problem.by_pair(h), self.problem.by_pair(r)
