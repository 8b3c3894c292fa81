# SPDX-License-Identifier: BSD-3-Clause
"""Motions and forces of the pairs under a load, with every pair's state given: the linear map behind the path.

In the force form (see `signorini.friction.cone`) a state leaves these unknowns: the normal force of every closed pair,
the tangential force of those that stick, and the rigid motion. Slipping pairs carry ``r_t = s mu p``, mu the slope of
their bound; open pairs take no part. Friction that does not depend on p is a load, for the caller.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.friction.exact.inverse import StateInverse
from signorini.friction.problem import CoulombProblem

ROUNDING = 2e-15
"""Error of a response, relative to its largest entry, that is not refined."""


class Responses:
    """Responses of an interface in changing states; the inverse of the last state is kept and changed.

    Parameters
    ----------
    problem : its bound of friction holds, its b does not matter

    Attributes
    ----------
    inverse : of the last state
    pivots : states tried so far

    Examples
    --------
    >>> from signorini.friction import STICK
    >>> problem = CoulombProblem(
    ...     W=np.diag([0.5, 0.5]), b=np.zeros(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> h, r = Responses(problem).respond(np.array([STICK]), np.array([-1.0, 0.2]))
    >>> h.round(12).tolist(), r.round(12).tolist()
    ([0.0, 0.0], [2.0, -0.4])
    """

    def __init__(self, problem: CoulombProblem) -> None:
        self.problem = problem
        self.inverse = StateInverse(problem)
        self.pivots = 0
        self._state: IntArray | None = None

    def respond(self, state: IntArray, b: Array, *, refine: bool = True) -> tuple[Array, Array]:
        """Motion h and force r, (2n,), with ``G h - W r = b``, h = 0 where a state holds and r = 0 where it is open.

        Raises
        ------
        SingularState
            Where the state has no unique response.
        """
        if self._state is None or not np.array_equal(state, self._state):
            self.pivots += 1
            self._state = None
            self.inverse.move_to(state)
            self._state = state.copy()
        h, r = self._once(b)
        if refine:
            error = b + self.problem.W @ (h + r) - h
            size = max(np.abs(part).max(initial=0.0) for part in (b, h, r))
            if np.abs(error).max(initial=0.0) > ROUNDING * size:
                dh, dr = self._once(error)
                h, r = h + dh, r + dr
        return h, r

    def _once(self, b: Array) -> tuple[Array, Array]:
        m, n = self.problem.interface, self.problem.pairs
        c = self.problem.free_motion(b)
        x = self.inverse.apply(-np.concatenate([c, m.R.T @ b]))
        unknowns, full = self.inverse.unknowns, np.zeros(2 * n + m.R.shape[1])
        full[unknowns] = x
        r = full[: 2 * n]
        r[n:] += self.inverse.slope * r[:n]
        h = m.A @ r + c + m.R @ full[2 * n :]
        h[unknowns[unknowns < 2 * n]] = 0.0
        return h, r
