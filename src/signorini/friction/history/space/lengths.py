# SPDX-License-Identifier: BSD-3-Clause
"""How long increments in space are where no event ends them: as far as friction on smooth sections may turn.

An increment takes the direction of friction at its end for all of it, so that answers depend a little on lengths. A
trial tells that of the next one by how much friction turns in it, and derivatives go through those trials, too.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from signorini.arrays import Array
from signorini.friction.history.follower import ZERO_WIDTH
from signorini.friction.history.space.straight import SolvedIncrement
from signorini.friction.problem import ContactProblem

SHORT = 0.9
"""Of the estimated part up to an event, or of what friction may turn: short of it."""

PROBE = 2.0**-4
"""Of the last increment: what is tried first, to show the rates behind an event."""

EARLY_GROWTH = 0.5
"""Of what is behind: what increments at the beginning need not undercut."""

_MOST_MOVED = 0.9  # of what an increment grows by: how far it moves where an event is expected, that it is believed
_EARLY_SHARE = 2.0**-4  # and of the shortest elsewhere


def early(shortest: float, behind: float) -> float:
    """What an increment need not undercut: less at the beginning, where contact grows and friction turns.

    Parameters
    ----------
    shortest : elsewhere
    behind : part of the segment where it begins

    Examples
    --------
    >>> early(0.25, 0.0), early(0.25, 0.125), early(0.25, 0.75)
    (0.015625, 0.0625, 0.25)
    """
    return min(shortest, max(EARLY_GROWTH * behind, _EARLY_SHARE * shortest))


def turned_length(trial: SolvedIncrement, turn: float) -> float:
    """The length in which friction turns by a little less than it may, as a trial tells it; infinite where none turns.

    Parameters
    ----------
    trial : the increment
    turn : angle by which friction may turn

    Examples
    --------
    >>> from types import SimpleNamespace as Trial
    >>> turned_length(Trial(step=0.5, turn=0.1), 0.2)
    0.9
    """
    return trial.step * (SHORT * turn / trial.turn) if trial.turn > 0.0 else math.inf


def aimed(
    trial: SolvedIncrement,
    last: SolvedIncrement | None,
    event: Callable[[SolvedIncrement], float],
    turn: float,
    least: float,
) -> float:
    """The length to try after one in which nothing has happened: up to the next event, and to the turn allowed.

    Parameters
    ----------
    trial, last : the increment, and the one before in which nothing has happened; None where there is none
    event : the length at whose end an increment expects the next event
    turn : angle by which friction may turn
    least : length that it need not undercut
    """
    aim = event(trial) if last is None else up_to_event(trial.step, event(trial), last.step, event(last))
    if trial.turn > 0.0:
        aim = min(aim, turned_length(trial, turn))
    return max(aim, trial.step, least)


def up_to_event(length: float, ahead: float, before: float, ahead_before: float) -> float:
    """The length up to an event that two increments expect elsewhere, as friction turns on other pairs: by a secant.

    Parameters
    ----------
    length, ahead : of an increment in which nothing has happened, and where it expects the event
    before, ahead_before : of a shorter one

    Examples
    --------
    >>> up_to_event(0.5, 0.75, 0.25, 0.625), up_to_event(0.5, 0.75, 0.25, 0.75)
    (1.0, 0.75)
    """
    if not before < length < ahead < math.inf:
        return ahead
    moves = (ahead - ahead_before) / (length - before)
    return length + (ahead - length) / (1.0 - min(max(moves, 0.0), _MOST_MOVED))


def shortened(
    trial: SolvedIncrement, turn: float, least: float, best: SolvedIncrement | None, beyond: SolvedIncrement | None
) -> float:
    """The length to try after one in which something has happened, or friction has turned too far.

    Parameters
    ----------
    trial : the increment
    turn : angle by which friction may turn
    least : length that it need not undercut
    best : the longest so far in which nothing has; None where there is none
    beyond : the last one before in which something has; None where there is none
    """
    aim = SHORT * turn / trial.turn if trial.turn > turn else 1.0
    if trial.until < 1.0:
        aim = min(aim, SHORT * trial.until if best is None else _part_up_to_event(trial, beyond))
    return max(aim * trial.step, least if best is None else best.step)


def _part_up_to_event(trial: SolvedIncrement, beyond: SolvedIncrement | None) -> float:
    """Part of an increment at which the first of its events is: by how late it is in that and in one before, a secant.

    Parameters
    ----------
    trial : the increment
    beyond : see `shortened`
    """
    if beyond is None:
        return trial.until
    pair = int(np.argmin(trial.each))
    late, later = (one.step * (1.0 - float(one.each[pair])) for one in (trial, beyond))
    if (later - late) * (beyond.step - trial.step) <= 0.0:
        return trial.until
    part = 1.0 - late / trial.step * ((beyond.step - trial.step) / (later - late))
    return part if part > 0.0 else trial.until


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
