# SPDX-License-Identifier: BSD-3-Clause
"""Driven pivoting: the rates after an event from those before it.

The acting pairs are given their next state; what the old rates lack there is imposed in the proportion theta. So the
old rates solve the problem at theta = 1, and theta falls to 0, pair after pair changing its state where a condition
would be violated (the method of Keller and Lemke with the event as covering vector; one to three pivots are usual).
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.friction.exact.inverse import SingularState
from signorini.friction.exact.rates import CORNER, INSIDE, RATE, RateLaw, Rates
from signorini.friction.exact.responses import Responses
from signorini.friction.law import OPEN, STICK
from signorini.friction.problem import CoulombProblem


def drive(responses: Responses, law: RateLaw, load: Array, before: Rates, acting: IntArray) -> Rates | None:
    """Rates under the load rate, followed from those before the event; None where the way ends in a ray.

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
    extra = _load_of(responses.problem, imposed_h, imposed_r)
    theta, way, last, row = 1.0, -1.0, -1, 0
    for _ in range(10 * n + 20):
        try:
            h0, r0 = responses.respond(state, load, refine=False)
            h1, r1 = responses.respond(state, extra, refine=False)
        except SingularState:
            return None
        slope = Rates(state=state, h=h1 + imposed_h, r=r1 + imposed_r)
        now = Rates(state=state, h=h0 + theta * slope.h, r=r0 + theta * slope.r)
        values, following = law.conditions(now)
        change, _ = law.conditions(slope)
        if last >= 0:  # the condition of the state just left vanishes here: go where it grows
            row = int(np.argmin(np.abs(values[:, last])))
            way = 1.0 if change[row, last] > 0 else -1.0
        falling = np.isfinite(values) & (way * change < -RATE * now.size)
        steps = np.full(values.shape, np.inf)
        steps[falling] = np.maximum(values[falling], 0.0) / -(way * change[falling])
        if last >= 0:
            steps[row, last] = np.inf
        step = float(steps.min())
        if way < 0 and step >= theta:
            return Rates(state=state, **dict(zip("hr", responses.respond(state, load), strict=True)))
        if not np.isfinite(step):
            return None
        theta += way * step
        which, last = divmod(int(np.argmin(steps)), n)
        state = state.copy()
        state[last] = following[which, last]
    return None


def _imposed(law: RateLaw, before: Rates, acting: IntArray) -> tuple[IntArray, Array, Array]:
    """The next state of the acting pairs, and what of the old motions and forces it does not allow."""
    n = len(law.kind)
    state, h, r = before.state.copy(), np.zeros(2 * n), np.zeros(2 * n)
    touching, other = law.touching(before.h[n:]), law.following(state)
    for k in acting:
        if before.state[k] == OPEN:
            state[k], h[k] = touching[k], before.h[k]
        elif law.kind[k] == CORNER and before.r[k] < 0:
            state[k], r[k], r[n + k] = OPEN, before.r[k], before.r[n + k]
        elif law.kind[k] not in (CORNER, INSIDE) and (before.state[k] == STICK or law.kink[k]):
            state[k] = law.kind[k] if before.state[k] == STICK else other[k]
            r[n + k] = before.r[n + k] - law.bound.slope(state)[k] * before.r[k]
    return state, h, r


def _load_of(problem: CoulombProblem, h: Array, r: Array) -> Array:
    """The load that imposed motions and forces are worth: ``W r - G h``."""
    return problem.W @ (r + h) - h
