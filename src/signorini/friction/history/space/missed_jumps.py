# SPDX-License-Identifier: BSD-3-Clause
"""The energy balance of increments in space: one that misses too much for its length has passed over a jump.

Between two equilibria the work of the loads by trapezoids is what bodies store less ``1/2 (r_0 + r_1) . (h_1 - h_0)``.
Where the law holds all along a straight piece friction takes as much, the most that its sections allow at both ends.
Where something happens on the way, a pair opens or friction turns, some is missing: no more than ``1/2 |r_1 - r_0|
|h_1 - h_0|`` of the pairs that act, of second order in the length of the increment where the way is smooth. Across a
jump both differences have a limit, and so has what is missing, however short the increment.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from signorini.arrays import Array
from signorini.friction.history.segment import Breakpoint
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN

_MISSED_ENERGY = 1.0  # of what increments would miss whose every pair acts; smooth ways of few pairs come up to it
_ENERGY_ROUNDING = 1e-12  # of the energies compared


def first_missed_jump(
    problem: ContactProblem, start: PathState, pieces: Sequence[Breakpoint], since: float, width: float
) -> int | None:
    """The first increment that misses more energy than smooth ones of its length do, if any.

    Parameters
    ----------
    problem : its b is not used
    start : of the way
    pieces : the ends of its increments, the first its start
    since : part of the way from which increments are looked at
    width : of zero for a motion: less of it, under the forces that press, is no energy that is missed

    Examples
    --------
    One pair that rubs under a pressure of 1, and then leaves at once for a gap of 1, in a tenth of the way:

    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.zeros(3), friction=[1.0], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> def at(h, r, lost):
    ...     h, r, state = np.array([h]).T, np.array([r]).T, np.array([2 if r[0] else 0])
    ...     return PathState(b=h[:, 0], h=h, r=r, state=state, anchor=0 * h[1:], slip=h[1:], dissipation=[lost])
    >>> states = [at([0, 0, 0], [1, -1, 0], 0), at([0, 1, 0], [1, -1, 0], 1), at([1, 2, 0], [0, 0, 0], 1)]
    >>> pieces = [Breakpoint(factor=s, h=now.h, r=now.r, state=now) for s, now in zip([0, 0.9, 1], states)]
    >>> [first_missed_jump(problem, states[0], pieces, since, 1e-10) for since in (0.0, 1.0)]
    [2, None]
    """
    states = [start, *(piece.state or start for piece in pieces[1:])]
    factors = np.array([piece.factor for piece in pieces])
    end, reached = states[-1], float(factors[-1])
    if not reached:
        return None
    change = 0.5 * float((_sizes(end.r - start.r) * _sizes(end.h - start.h)).sum()) / reached**2
    for k, (one, two) in enumerate(pairwise(states), start=1):
        moved, missing = two.h - one.h, _missing(problem, one, two)
        rounding = _ENERGY_ROUNDING * float(np.abs(one.r * moved).sum() + two.dissipation.sum())
        rounding += width * float(np.maximum(np.abs(one.r), np.abs(two.r)).sum())
        allowed = _MISSED_ENERGY * change * max(float(factors[k] - factors[k - 1]) ** 2, _ENERGY_ROUNDING) + rounding
        if factors[k] > since and missing > allowed:
            return k
    return None


def _missing(problem: ContactProblem, one: PathState, two: PathState) -> float:
    """The energy that an increment misses, pair by pair; of one that slips what its first force lacks of the most."""
    moved = two.h - one.h
    normal, *along = 0.5 * (one.r + two.r) * moved
    slip, force = moved[1:], one.r[1:]
    most = problem.bound.at(np.maximum(one.r[0], 0.0)) * problem.section.farthest(slip)
    rubs = (one.state != OPEN) & (two.state != OPEN)
    lacking = 0.5 * ((most + force) * slip).sum(axis=0)
    friction = np.where(rubs, lacking, along[0] + along[1] + two.dissipation - one.dissipation)
    return float((np.abs(normal) + np.abs(friction)).sum())


def _sizes(rows: Array) -> Array:
    """(n,) Of the numbers of every pair, (d, n)."""
    return np.asarray(np.linalg.norm(rows, axis=0))
