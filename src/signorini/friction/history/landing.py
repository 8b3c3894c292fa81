# SPDX-License-Identifier: BSD-3-Clause
"""Where a history goes on after a jump: along the curve of equilibria through the states that follow the limit load.

At a jump the acting pairs have no gradual continuation under more load. The equilibria that they lead to, each in its
next state, are continued with the load going *back*; where the law allows it the load turns forward again, and the
first state at the load of the jump is the landing. Friction obeys Coulomb's law in the parameter of the curve, in space
on polygons exactly, on smooth sections in increments. Which equilibrium a real, dynamic jump finds, and what friction
takes on the way, depends on inertia: the landing is a candidate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.attempt import Spent
from signorini.friction.history.follow import follower
from signorini.friction.history.follower import PathSettings
from signorini.friction.history.segment import Segment
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem

TURNS = 100
"""Most times that the load turns, per pair and once more."""


@dataclass(frozen=True, kw_only=True)
class Landing:
    """The next equilibrium at the load of a jump.

    Attributes
    ----------
    state : there; slip and dissipation are those of the curve that leads there
    events : of the curve
    """

    state: PathState
    events: int


def land(
    problem: ContactProblem, start: PathState, segment: Segment, *, settings: PathSettings | None = None
) -> Landing | Spent | None:
    """Follow a segment beyond its jump to the next equilibrium at the same load; where none was found, why if known.

    Parameters
    ----------
    problem : the problem; its own b is not used
    start : of the segment; the curve does not go back farther
    segment : one that ended in a jump. Gross sliding has no landing
    settings : how the curve is followed

    References
    ----------
    Klarbring (1990), Examples of non-uniqueness and non-existence of solutions to quasistatic contact problems with
    friction, Ing.-Archiv 60.

    Examples
    --------
    One node with much friction, pressed by 1 and pulled: sticks up to 3, then has left the wall. In space as well.

    >>> from signorini.friction.history import follow, initial_state
    >>> def landed(K, **law):
    ...     W, none = np.linalg.inv(np.array(K)), np.zeros(len(K))
    ...     problem = ContactProblem.of(W=W, b=none, friction=[3.0], motions=np.zeros((len(K), 0)), scale=1.0, **law)
    ...     pressed = follow(problem, initial_state(problem, none), -W[:, 0]).end
    ...     landing = land(problem, pressed, follow(problem, pressed, -W[:, 0] + 4.0 * W[:, 1]))
    ...     return (landing.state.h.ravel().round(9) + 0.0).tolist(), round(float(landing.state.dissipation[0]), 9)
    >>> landed([[3.0, -1.0], [-1.0, 3.0]])
    ([0.333333333, 1.666666667], 1.5)
    >>> landed([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 3.0]], facets=8)
    ([0.333333333, 1.666666667, 0.0], 1.5)
    """
    jump = segment.jump
    if jump is None or jump.gross_sliding or jump.factor <= 0.0:
        return None
    settings = settings or PathSettings()
    limit = now = before = segment.end
    acting = np.array(jump.pairs, dtype=np.int64)
    events = 0
    turns = TURNS * (problem.pairs + 1)
    for _ in range(turns):
        back = follower(problem, now, start.b, settings)
        back.acting = acting
        departed = back.departs()
        if departed:
            if back.factor >= 1.0:
                return None
            events, before = events + 1, now
        ahead = follower(problem, back.now, limit.b, settings)
        ahead.acting = back.acting
        if not departed and not ahead.crosses(before):
            return next(iter(back.spent), None)
        while ahead.factor < 1.0 and not ahead.stuck() and ahead.go_on() is None:
            pass
        events += len(ahead.events)
        if ahead.factor >= 1.0:
            return Landing(state=ahead.now, events=events)
        now, acting = ahead.now, ahead.acting
    return Spent(most=turns, of="turns of the load behind the jump")
