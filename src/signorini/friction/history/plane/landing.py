# SPDX-License-Identifier: BSD-3-Clause
"""Where a history goes on after a jump: along the curve of equilibria through the states that follow the limit load.

At a jump the acting pairs have no gradual continuation under more load. The equilibria that they lead to, each in its
next state, are continued with the load going *back*; where the law allows it the load turns forward again, and the
first state at the load of the jump is the landing. Friction obeys Coulomb's law in the parameter of the curve. Which
equilibrium a real, dynamic jump finds, and what friction takes on the way, depends on inertia: the landing is a
candidate.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import BoolArray, IntArray
from signorini.friction.history.plane.find_rates import find_rates
from signorini.friction.history.plane.follow import PathSettings, PlaneFollower
from signorini.friction.history.plane.rate_law import CORNER, INSIDE, RateLaw, Rates
from signorini.friction.history.segment import Segment
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

TURNS = 100
"""Most times that the load turns."""


@dataclass(frozen=True, kw_only=True)
class Landing:
    """The next equilibrium at the load of a jump.

    Attributes
    ----------
    state : there; slip and dissipation are those of the curve that leads there
    lowest : part of the segment to which the load went back on the way
    events : of the curve
    """

    state: PathState
    lowest: float
    events: int


def land(
    problem: ContactProblem, start: PathState, segment: Segment, *, settings: PathSettings | None = None
) -> Landing | None:
    """Follow a segment beyond its jump to the next equilibrium at the same load; None where none was found.

    Parameters
    ----------
    problem : the problem; its own b is not used
    start : of the segment; the curve does not go back farther
    segment : one that ended in a jump. Gross sliding has no landing
    settings : tolerances

    References
    ----------
    Klarbring (1990), Examples of non-uniqueness and non-existence of solutions to quasistatic contact problems with
    friction, Ing.-Archiv 60.

    Examples
    --------
    One node with much friction, pressed by 1 and pulled: sticks up to 3, then has left the wall.

    >>> from signorini.friction.history.plane import follow, initial_state
    >>> W = np.linalg.inv(np.array([[3.0, -1.0], [-1.0, 3.0]]))
    >>> problem = ContactProblem.of(W=W, b=np.zeros(2), friction=[3.0], motions=np.zeros((2, 0)), scale=1.0)
    >>> pressed = follow(problem, initial_state(problem, np.zeros(2)), W @ [-1.0, 0.0]).end
    >>> landing = land(problem, pressed, follow(problem, pressed, W @ [-1.0, 4.0]))
    >>> landing.state.h.round(9).tolist(), round(float(landing.state.dissipation[0]), 9)
    ([0.333333333, 1.666666667], 1.5)
    """
    jump = segment.departure
    if jump is None:
        return None
    settings = settings or PathSettings()
    limit = segment.end
    back = PlaneFollower(problem, limit, start.b, settings)
    back.acting = np.array(jump.pairs, dtype=np.int64)
    lowest, events = jump.factor, 0
    for _ in range(TURNS * (problem.pairs + 1)):
        if not _depart(back) or back.advance() is not None or back.factor >= 1.0:
            return None
        lowest, events = min(lowest, jump.factor * left(back.now, limit, start)), events + 1
        ahead = PlaneFollower(problem, back.now, limit.b, settings)
        ahead.acting = back.acting
        while ahead.factor < 1.0 and (ahead.turn() or ahead.advance()) is None:
            pass
        events += len(ahead.events)
        if ahead.factor >= 1.0:
            return Landing(state=ahead.now, lowest=lowest, events=events)
        back = PlaneFollower(problem, ahead.now, start.b, settings)
        back.acting = ahead.acting
    return None


def left(now: PathState, limit: PathState, start: PathState) -> float:
    """Part of the way from the start of the segment to the limit load that is left now: three states of a history."""
    way = limit.b - start.b
    return float(way @ (now.b - start.b)) / (float(way @ way) or 1.0)


def _depart(walk: PlaneFollower) -> bool:
    """Take the rates in which the acting pairs are in a next state, not those of the way that led here."""
    law = walk.law()
    acts = np.zeros(len(law.kind), dtype=np.bool_)
    acts[walk.acting] = True
    held = replace(law, kind=np.where(acts, INSIDE, law.kind), kink=law.kink & ~acts)
    for state in _next(law, walk.now.state, acts):
        found = find_rates(walk.responses, held, walk.load, state, [state])
        if isinstance(found, Rates) and law.violation(found) <= 1e-9:
            walk.enter(found)
            return True
    return False


def _next(law: RateLaw, state: IntArray, acts: BoolArray) -> Iterator[IntArray]:
    """The states that acting pairs may enter: slip for stick, open for closed, and any closed one for open.

    At a kink of the bound also slip on its other branch.
    """
    spent = acts & (law.kind > CORNER) & (state == STICK)
    leaves = acts & (law.kind == CORNER) & (state != OPEN)
    meets = acts & (law.kind == CORNER) & (state == OPEN)
    turns = acts & law.kink & (state > STICK)
    moved = np.where(spent, law.kind, np.where(leaves, OPEN, np.where(turns, law.across(state), state)))
    for closed in (STICK, SLIP_PLUS, SLIP_MINUS) if meets.any() else (STICK,):
        forced = np.where(law.forced == UNDECIDED, closed, law.forced)
        yield np.where(meets, forced, moved).astype(np.int64)
