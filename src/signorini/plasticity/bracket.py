# SPDX-License-Identifier: BSD-3-Clause
"""Regula falsi between two ends of which one is short of what is looked for and one beyond; compiled loops use it too.

References
----------
Dowell, Jarratt (1971), A modified regula falsi method for computing the root of an equation, BIT 11:168 (Illinois).
"""

from __future__ import annotations

from typing import NamedTuple

from numba.extending import register_jitable


class Bracket(NamedTuple):
    """Two ends with the values of a function there.

    Attributes
    ----------
    low, high : the ends, one short of what is looked for and one beyond
    below, above : values at them; halved at an end that has stayed twice, so that both move
    side : which end moved last: -1 low, 1 high, 0 none
    """

    low: float
    high: float
    below: float
    above: float
    side: int


@register_jitable
def narrowed(bracket: Bracket, at: float, value: float, beyond: bool) -> Bracket:
    """The bracket with one of its ends moved.

    Parameters
    ----------
    bracket : around what is looked for
    at, value : a place inside, and the function there
    beyond : whether it is the high end that moves there
    """
    if beyond:
        return Bracket(bracket.low, at, bracket.below * (0.5 if bracket.side == 1 else 1.0), value, 1)
    return Bracket(at, bracket.high, value, bracket.above * (0.5 if bracket.side == -1 else 1.0), -1)


@register_jitable
def secant(bracket: Bracket, aim: float, inside: float) -> float:
    """Where a straight line between both ends has the value ``aim``.

    Parameters
    ----------
    bracket : around what is looked for
    aim : the value that is looked for
    inside : part of the bracket that is left at either end

    Examples
    --------
    >>> secant(Bracket(0.0, 2.0, -1.0, 3.0, 0), 0.0, 0.01), secant(Bracket(0.0, 2.0, -1e-9, 1.0, 0), 0.0, 0.01)
    (0.5, 0.02)
    """
    part = (aim - bracket.below) / (bracket.above - bracket.below)
    return bracket.low + (bracket.high - bracket.low) * min(max(part, inside), 1.0 - inside)
