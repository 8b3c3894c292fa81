# SPDX-License-Identifier: BSD-3-Clause
"""Follow a straight segment of the load history, in the plane from event to event, in space in increments."""

from __future__ import annotations

from collections.abc import Callable

from signorini.arrays import Array
from signorini.cores import number_of_threads
from signorini.crew import Crew
from signorini.friction.history.follower import PathFollower, PathSettings
from signorini.friction.history.plane.follower import PlaneFollower
from signorini.friction.history.segment import Breakpoint, Segment
from signorini.friction.history.space.follower import SpaceFollower
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.linalg.shared_dense import SHARED
from signorini.outcome import Outcome


def follow(
    problem: ContactProblem,
    start: PathState,
    b_end: Array,
    *,
    settings: PathSettings | None = None,
    tell: Callable[[float], None] | None = None,
    leaves: Callable[[Breakpoint], bool] | None = None,
) -> Segment:
    """Follow the load from ``start.b`` straight to ``b_end``.

    ``G h - W r = b(s)`` with h = (gap, total tangential displacement), Coulomb's law for the slip rate.

    Parameters
    ----------
    problem : the problem; its own b is not used
    start : where the history stands
    b_end : (d n,) load at the end of the segment
    settings : how the way is gone
    tell : called with the part of the segment that is behind, piece by piece
    leaves : whether the end of a piece is beyond what the problem holds for: the way ends there, as DISTURBED

    Returns
    -------
    Segment
        Also where the path ends in a jump or is not found: look at ``outcome``. Exact in the plane, and in space where
        every section is a polygon and ``settings.shortest`` is 0.

    Raises
    ------
    InputError
        Where shapes do not fit; in the plane also where the start is outside the friction cone, or supports drag a pair
        along that may never slip.

    References
    ----------
    Klarbring (1986), A mathematical programming approach to three-dimensional contact problems with friction;
    Klarbring (1990), Examples of non-uniqueness and non-existence of solutions to quasistatic contact problems.

    Examples
    --------
    One node, pressed by 1 and pulled sideways by up to 4: slips at 1, lifts off at 2.

    >>> import numpy as np
    >>> from signorini.friction.history import initial_state
    >>> W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    >>> problem = ContactProblem.of(W=W, b=np.zeros(2), friction=[1.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> pressed = follow(problem, initial_state(problem, np.zeros(2)), W @ [-1.0, 0.0])
    >>> pulled = follow(problem, pressed.end, W @ [-1.0, 4.0])
    >>> [(round(4.0 * event.factor, 9), event.what) for event in pulled.events], pulled.end.h.round(6).tolist()
    ([(1.0, 'slips'), (2.0, 'opens')], [[0.666667], [2.333333]])

    One pair in space, pressed by 1 and pulled sideways by up to 1 across an octagon of friction: slips at 0.5.

    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.zeros(3), friction=[0.5], motions=np.zeros((3, 0)), scale=1.0, facets=8
    ... )
    >>> pressed = follow(problem, initial_state(problem, np.zeros(3)), np.array([-0.5, 0.0, 0.0]))
    >>> pulled = follow(problem, pressed.end, np.array([-0.5, 0.5, 0.0]))
    >>> [(round(event.factor, 12), event.what) for event in pulled.events], (pulled.end.h.round(12) + 0.0).tolist()
    ([(0.5, 'slips')], [[0.0], [0.5], [0.0]])
    """
    with Crew(number_of_threads() if len(problem.b) >= SHARED else 1):  # products of every event go to the same threads
        walk = follower(problem, start, b_end, settings or PathSettings())
        while True:
            lost, left = None, False
            while walk.factor < 1.0 and lost is None and not left:
                lost = walk.go_on()
                left = leaves is not None and leaves(walk.pieces[-1])
                if tell is not None:
                    tell(walk.factor)
            if not walk.goes_back():
                break
    if left:
        return walk.segment(Outcome.DISTURBED, None, f"left at factor {walk.factor:.12g}")
    if lost is not None:
        return walk.ended(lost)
    return walk.segment(Outcome.FOLLOWED, None, f"followed through {len(walk.events)} events")


def follower(problem: ContactProblem, start: PathState, b_end: Array, settings: PathSettings) -> PathFollower:
    """What goes along the way of a problem from ``start`` to ``b_end``, with its settings: see `PathFollower`."""
    way = SpaceFollower if problem.directions == 3 else PlaneFollower
    return way(problem, start, b_end, settings)
