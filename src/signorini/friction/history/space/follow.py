# SPDX-License-Identifier: BSD-3-Clause
"""Follow a straight segment of the load history in space, from rest or from where the last one ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, frozen
from signorini.errors import InputError
from signorini.friction.history.segment import Segment
from signorini.friction.history.space.follower import SpaceFollower
from signorini.friction.history.space.increment import StopSettings
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN
from signorini.outcome import Outcome


def follow_stopping(
    problem: ContactProblem,
    start: PathState,
    b_end: Array,
    *,
    settings: StopSettings | None = None,
    tell: Callable[[float], None] | None = None,
) -> Segment:
    """Follow the load from ``start.b`` straight to ``b_end``, as `history.plane.follow` does in the plane.

    Parameters
    ----------
    problem : the problem; its own b is not used
    start : where the history stands
    b_end : (3n,) load at the end of the segment
    settings : how increments are chosen
    tell : called with the part of the segment that is behind, increment by increment

    Returns
    -------
    Segment
        Exact where every section is a polygon and ``shortest`` is 0. ``pivots`` counts the increments tried.

    Raises
    ------
    InputError
        Where shapes do not fit.

    Examples
    --------
    One pair, pressed by 1 and pulled sideways by up to 1 across an octagon of friction: slips at 0.5.

    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.zeros(3), friction=[0.5], motions=np.zeros((3, 0)), scale=1.0, facets=8
    ... )
    >>> pressed = follow_stopping(problem, at_rest(problem, np.zeros(3)), np.array([-0.5, 0.0, 0.0]))
    >>> pulled = follow_stopping(problem, pressed.end, np.array([-0.5, 0.5, 0.0]))
    >>> [(round(event.factor, 12), event.what) for event in pulled.events], (pulled.end.h.round(12) + 0.0).tolist()
    ([(0.5, 'slips')], [0.0, 0.5, 0.0])
    """
    walk = SpaceFollower(problem, start, np.asarray(b_end, dtype=np.float64), settings or StopSettings())
    while True:
        lost = None
        while walk.factor < 1.0 and lost is None:
            lost = walk.go_on()
            if tell is not None:
                tell(walk.factor)
        if walk.limited or not walk.again():  # close to a limit of the load increments miss energy however short
            break
    if lost is not None:
        return walk.ended(lost)
    return walk.segment(Outcome.FOLLOWED, None, f"followed through {len(walk.events)} events")


def at_rest(problem: ContactProblem, b: Array, *, motion: Array | None = None) -> PathState:
    """The start of a history: forces zero, or, where the load presses already, one increment from zero slip.

    Parameters
    ----------
    problem : the problem; its own b is not used
    b : (3n,) load at the start
    motion : (3n,) motions without forces; where not given those of the load, of bodies that supports hold
    """
    n = problem.pairs
    posed = replace(problem, b=frozen(b))
    h = posed.free_motion() if motion is None else motion
    if (motion is None and problem.floating) or h[:n].min(initial=0.0) < -1e-10 * (problem.scale or 1.0):
        result = solve_contact(posed)
        if not result.solved:
            raise InputError(f"presses at the start, and no equilibrium was found: {result.message}", where=("b",))
        slip = np.where(result.state == OPEN, 0.0, result.h[1:])
        return PathState(
            b=b,
            h=result.h.ravel(),
            r=result.r.ravel(),
            state=result.state,
            anchor=result.h[1:].ravel(),
            slip=slip.ravel(),
            dissipation=np.maximum(-(result.r[1:] * slip).sum(axis=0), 0.0),
        )
    h = np.concatenate([np.maximum(h[:n], 0.0), h[n:]])
    none = np.zeros(2 * n)
    return PathState(b=b, h=h, r=np.zeros(3 * n), state=np.full(n, OPEN), anchor=h[n:], slip=none, dissipation=none[:n])
