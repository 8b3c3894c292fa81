# SPDX-License-Identifier: BSD-3-Clause
"""Motions and forces of the pairs under a load, with every pair's state given: the linear map behind the path.

In the force form (see `friction.linear`) a state leaves these unknowns: the normal force of every closed pair,
the tangential force of those that stick, and the rigid motion. Slipping pairs carry ``r_t = s mu p``, mu the slope of
their bound; open pairs take no part. Friction that does not depend on p is a load, for the caller.

Loads come as what the equations see of them where no pair pushes, (2n + k,): the motion c and the resultants R'b.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.friction.history.plane.state_inverse import StateInverse
from signorini.friction.history.rates import Rates
from signorini.friction.problem import ContactProblem

DRIFT = 1e-12
"""What equations may lack, relative to what they see of a load, before they are solved once more.

Changes of an inverse add up from state to state; what is left stays far below the 1e-8 that a certificate allows.
"""

_MISFIT_ROUNDING = 2e-15  # of the largest entry of a response: an error that is not refined, of a few pairs
_FEW_PAIRS = 50  # pairs up to which it is that; of more in proportion, as sums of so many terms are rounded


class Responses:
    """Responses of an interface in changing states; the inverse of the last state is kept and changed.

    Parameters
    ----------
    problem : its bound of friction holds, its b does not matter

    Attributes
    ----------
    inverse : of the last state
    pivots : states tried so far
    rounding : error of a response, relative to its largest entry, that is not refined

    Examples
    --------
    >>> from signorini.friction import STICK
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.zeros(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> responses = Responses(problem)
    >>> h, r = responses.respond(np.array([STICK]), responses.free(np.array([-1.0, 0.2])))
    >>> h.round(12).tolist(), r.round(12).tolist()
    ([[0.0], [0.0]], [[2.0], [-0.4]])
    """

    def __init__(self, problem: ContactProblem) -> None:
        self.problem = problem
        self.inverse = StateInverse(problem)
        self.pivots = 0
        self.rounding = _MISFIT_ROUNDING * max(1.0, problem.pairs / _FEW_PAIRS)
        self._state: IntArray | None = None

    def free(self, b: Array) -> Array:
        """(2n + k,) Motion and resultants of a load b, (2n,)."""
        return np.concatenate([self.problem.free_motion(b), self.problem.image.R.T @ b])

    def imposed(self, h: Array, r: Array) -> Array:
        """(2n + k,) What motions and forces, (2, n), are worth that come on top of what a state allows."""
        interface, flat = self.problem.image, r.ravel()
        acting = np.flatnonzero(flat)
        given = flat[acting]
        return np.concatenate([given @ interface.A[acting] - h.ravel(), given @ interface.R[acting]])

    def respond(self, state: IntArray, free: Array) -> tuple[Array, Array]:
        """Motion h and force r, (2, n), with ``G h - W r = b``, h = 0 where a state holds and r = 0 where it is open.

        Parameters
        ----------
        state : (n,)
        free : (2n + k,) of the load

        Raises
        ------
        SingularState
            Where the state has no unique response.
        """
        self._move_to(state)
        n, unknowns = self.problem.pairs, self.inverse.unknowns
        x, seen = self.inverse.solve(free)
        if np.abs(seen[unknowns]).max(initial=0.0) > DRIFT * np.abs(free).max(initial=0.0):
            more, seen = self.inverse.solve(seen)
            x += more
        full = np.zeros(len(free))
        full[unknowns] = x
        r = full[: 2 * n].reshape(2, n)
        r[1] += self.inverse.slope * r[0]
        seen[unknowns] = 0.0
        return seen[: 2 * n].reshape(2, n), r

    def _move_to(self, state: IntArray) -> None:
        """Make it the responses of another state."""
        if self._state is None or not np.array_equal(state, self._state):
            self.pivots += 1
            self._state = None
            self.inverse.move_to(state)
            self._state = state.copy()

    def rates(self, state: IntArray, load: Array) -> Rates:
        """The rates of a state, (n,), under a load rate, (2n,); raises SingularState."""
        h, r = self.respond(state, self.free(load))
        return Rates(state=state, h=h, r=r)

    def balanced(self, state: IntArray, b: Array, h: Array, r: Array) -> tuple[Array, Array]:
        """A response to b with one step of refinement, where equilibrium lacks more than rounding.

        Parameters
        ----------
        state : (n,) codes
        b : (2n,) load
        h, r : (2, n) motions and forces that respond to it
        """
        error = self.problem.misfit(h, r, b)
        size = max(np.abs(part).max(initial=0.0) for part in (b, h, r))
        if np.abs(error).max(initial=0.0) > self.rounding * size:
            dh, dr = self.respond(state, self.free(error))
            return h + dh, r + dr
        return h, r
