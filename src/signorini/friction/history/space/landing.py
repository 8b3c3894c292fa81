# SPDX-License-Identifier: BSD-3-Clause
"""Where a history in space goes on after a jump: along the curve of equilibria that follow the limit load.

As in the plane (see `history.plane.landing`): the acting pairs take a next state, the equilibria are continued with
the load going *back*, and forward again as soon as rates allow it; the first one at the load of the jump is the
landing, a candidate. On polygons the curve is exact; on smooth sections friction turns along it in increments.
"""

from __future__ import annotations

from signorini.friction.history.plane.find_rates import NoRates
from signorini.friction.history.plane.landing import TURNS, Landing, left
from signorini.friction.history.segment import Segment
from signorini.friction.history.space.find_rates import departures, find_rates
from signorini.friction.history.space.follower import SpaceFollower
from signorini.friction.history.space.increment import StopSettings
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem


def land_spatial(
    problem: ContactProblem, start: PathState, segment: Segment, *, settings: StopSettings | None = None
) -> Landing | None:
    """Follow a segment beyond its jump to the next equilibrium at the same load; None where none was found.

    Parameters
    ----------
    problem : the problem; its own b is not used
    start : of the segment; the curve does not go back farther
    segment : one that ended in a jump. Gross sliding has no landing
    settings : how increments are chosen

    References
    ----------
    Klarbring (1990), Examples of non-uniqueness and non-existence of solutions to quasistatic contact problems with
    friction, Ing.-Archiv 60.

    Examples
    --------
    One node with much friction, pressed by 1 and pulled: sticks up to 3, then has left the wall.

    >>> import numpy as np
    >>> from signorini.friction.history.space.follow import at_rest, follow_stopping
    >>> W = np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 3.0]]))
    >>> problem = ContactProblem.of(
    ...     W=W, b=np.zeros(3), friction=[3.0], motions=np.zeros((3, 0)), scale=1.0, facets=8
    ... )
    >>> pressed = follow_stopping(problem, at_rest(problem, np.zeros(3)), W @ [-1.0, 0.0, 0.0]).end
    >>> landing = land_spatial(problem, pressed, follow_stopping(problem, pressed, W @ [-1.0, 4.0, 0.0]))
    >>> (landing.state.h.round(9) + 0.0).tolist(), round(float(landing.state.dissipation[0]), 9)
    ([0.333333333, 1.666666667, 0.0], 1.5)
    """
    jump = segment.departure
    if jump is None:
        return None
    settings = settings or StopSettings()
    limit = now = before = segment.end
    lowest, events = jump.factor, 0
    for _ in range(TURNS * (problem.pairs + 1)):
        back = SpaceFollower(problem, now, start.b, settings)
        if _departed(back):
            if back.factor >= 1.0:
                return None
            lowest, events, before = min(lowest, jump.factor * left(back.now, limit, start)), events + 1, now
            ahead = SpaceFollower(problem, back.now, limit.b, settings)
        else:
            ahead = SpaceFollower(problem, now, limit.b, settings)
            if not ahead.cross(before):
                return None
        while ahead.factor < 1.0 and not _stuck(ahead):
            if ahead.go_on() is not None:
                break
        events += len(ahead.events)
        if ahead.factor >= 1.0:
            return Landing(state=ahead.now, lowest=lowest, events=events)
        now = ahead.now
    return None


def _departed(walk: SpaceFollower) -> bool:
    """Go on in rates in which acting pairs are in a next state, not in those of the way that led here."""
    return any(walk.along(rates) for rates in departures(walk.rate_problem, walk.now, walk.near))


def _stuck(walk: SpaceFollower) -> bool:
    """Whether it is known that no rates lead on."""
    found = find_rates(walk.rate_problem, walk.now, walk.near)
    return isinstance(found, NoRates) and found.proved
