# SPDX-License-Identifier: BSD-3-Clause
"""Driven pivoting: the rates after an event from those before it.

The acting pairs are given their next state; what the old rates lack there is imposed in the proportion theta. So the
old rates solve the problem at theta = 1, and theta falls to 0, pair after pair changing its state where a condition
would be violated (the method of Keller and Lemke with the event as covering vector; one to three pivots are usual).
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.attempt import Spent
from signorini.friction.history.plane.rate_law import CORNER, INSIDE, RATE, RateLaw
from signorini.friction.history.plane.responses import Responses
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.friction.history.rates import RATE_TOL, Rates
from signorini.law.states import OPEN, STICK

PIVOTS = 10
"""Most pivots of a drive, per pair and for two more: one to three are usual."""


def drive(responses: Responses, law: RateLaw, load: Array, before: Rates, acting: IntArray) -> Rates | Spent | None:
    """Rates under the load rate, followed from those before the event; None where the way ends in a ray
    or the rates do not obey the law, and that the budget is spent, where it is.

    Parameters
    ----------
    responses : of the interface
    law : of the rates at the event
    load : (2n,) rate of b
    before : rates up to the event
    acting : pairs whose event it is
    """
    n = responses.problem.pairs
    state, imposed_h, imposed_r = _imposed(law, before, acting)
    free, extra = responses.free(load), np.zeros(0)
    theta, way, last, row = 1.0, -1.0, -1, 0
    pivots = PIVOTS * (n + 2)
    for _ in range(pivots):
        try:
            h0, r0 = responses.respond(state, free)
            target = law.conditions(state, h0, r0)
            found = Rates(state=state, h=h0, r=r0)
            if last < 0 and target.min() >= -RATE * found.size:  # and so are all on the straight way there
                return found
            extra = extra if len(extra) else responses.imposed(imposed_h, imposed_r)
            h1, r1 = responses.respond(state, extra)
        except SingularState:
            return None
        h1, r1 = h1 + imposed_h, r1 + imposed_r
        change = np.where(np.isfinite(target), law.conditions(state, h1, r1), 0.0)
        now, values = Rates(state=state, h=h0 + theta * h1, r=r0 + theta * r1), target + theta * change
        if last >= 0:  # the condition of the state just left vanishes here: go where it grows
            row = int(np.argmin(np.abs(values[:, last])))
            way = 1.0 if change[row, last] > 0 else -1.0
        falling = way * change < -RATE * now.size
        if last >= 0:
            falling[row, last] = False
        steps = np.divide(np.maximum(values, 0.0), -way * change, out=np.full(values.shape, np.inf), where=falling)
        which, pair = divmod(int(np.argmin(steps)), n)
        step = float(steps[which, pair])
        if way < 0 and step >= theta:
            return found if target.min() >= -RATE_TOL * found.size else None
        if not np.isfinite(step):
            return None
        theta, last, state = theta + way * step, pair, state.copy()
        state[last] = law.following(state, now.h[1])[which, last]
    return Spent(most=pivots, of="driven pivots")


def _imposed(law: RateLaw, before: Rates, acting: IntArray) -> tuple[IntArray, Array, Array]:
    """The next state of the acting pairs, and what of the old motions and forces it does not allow."""
    n = len(law.kind)
    state, h, r = before.state.copy(), np.zeros((2, n)), np.zeros((2, n))
    touching, other = law.touching(before.h[1]), law.across(state)
    for k in acting:
        if before.state[k] == OPEN:
            state[k], h[0, k] = touching[k], before.h[0, k]
        elif law.kind[k] == CORNER and before.r[0, k] < 0:
            state[k], r[:, k] = OPEN, before.r[:, k]
        elif law.kind[k] not in (CORNER, INSIDE) and (before.state[k] == STICK or law.kink[k]):
            state[k] = law.kind[k] if before.state[k] == STICK else other[k]
            r[1, k] = before.r[1, k] - law.bound.slope(state)[k] * before.r[0, k]
    return state, h, r
