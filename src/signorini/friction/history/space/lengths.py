# SPDX-License-Identifier: BSD-3-Clause
"""How long increments in space are where no event ends them: their ends stand still while data change a little.

What friction turns in an increment says how long it may be, and so would every small change of data: an answer would
waver by what increments leave, and differences of two answers with it.
"""

from __future__ import annotations

import math

import numpy as np

from signorini.arrays import Array
from signorini.friction.history.follower import ZERO_WIDTH
from signorini.friction.history.space.straight import SolvedIncrement
from signorini.friction.problem import ContactProblem

SHORT = 0.9
"""Of the estimated part up to an event, or up to what friction may turn: short of it."""

_EARLY_GROWTH = 0.5  # of what is behind: what increments at the beginning may be,
_EARLY_SHARE = 2.0**-4  # and of the shortest
_DIGITS = 7  # binary ones of a length: by a 128th of it, or less, it may become shorter
_PLACE_ROUNDING = 1e-9  # of a place: what is so little short of the next one is there


def placed(length: float, behind: float, unit: float) -> float:
    """At most a length, and such that what it ends at is one of the places that lengths of this size may end at.

    Parameters
    ----------
    length : of an increment, part of the segment
    behind : part of the segment where it begins
    unit : part of the segment of which places are binary fractions

    Examples
    --------
    >>> placed(0.25, 0.5, 0.25), round(placed(0.24, 0.501, 1.0), 12), round(placed(0.24, 0.502, 1.0), 12)
    (0.25, 0.239234375, 0.2392109375)
    """
    if length <= 0.0:
        return length
    cell = unit * 2.0 ** (math.floor(math.log2(length / unit) + _PLACE_ROUNDING) - _DIGITS)
    return cell * math.floor((behind + length) / cell + _PLACE_ROUNDING) - behind


def early(shortest: float, behind: float) -> float:
    """What an increment need not undercut: less at the beginning, where contact grows and friction turns.

    Parameters
    ----------
    shortest : elsewhere
    behind : part of the segment where it begins
    """
    return min(shortest, max(_EARLY_GROWTH * behind, _EARLY_SHARE * shortest))


def shortened(trial: SolvedIncrement, turn: float, least: float, best: SolvedIncrement | None) -> float:
    """The length to try after one in which something has happened, or friction has turned too far.

    Parameters
    ----------
    trial : the increment
    turn : angle by which friction may turn
    least : length that it need not undercut
    best : the longest so far in which nothing has; None where there is none
    """
    aim = SHORT * turn / trial.turn if trial.turn > turn else 1.0
    if trial.until < 1.0:
        aim = min(aim, trial.until * (SHORT if best is None else 1.0))
    return max(aim * trial.step, least if best is None else best.step)


def pressed_for(problem: ContactProblem, r: Array, rate: Array, longest: float) -> float:
    """How long no normal force vanishes or comes to a kink of the bound on friction.

    Parameters
    ----------
    problem : the problem; its b does not matter
    r, rate : (3, n) forces, and their rates per part of the segment
    longest : what is left of the segment
    """
    times = [longest]
    for kink in problem.pieces.kinks[:-1]:
        away = np.where(np.isfinite(kink), kink, np.inf) - r[0]
        comes = (away * rate[0] > 0.0) & (np.abs(away) > ZERO_WIDTH * (problem.scale or 1.0))
        times.append(float((away[comes] / rate[0][comes]).min(initial=np.inf)))
    return min(times)
