# SPDX-License-Identifier: BSD-3-Clause
"""Ends of increments at which pairs come to the edge of another part of the law: which of them a change has beyond it.

The law of an increment is one of its end, linear in its parts. A change along which conditions g that vanish there fall
has their pairs in other parts, to one side; which ones tells the change itself, that follows from the parts: those in
which nothing that vanishes falls any more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.derivative.forward import ForwardWalk, PointChange, change_of_conditions
from signorini.derivative.interface_system import PairStates
from signorini.derivative.points import ZERO, TapePoint
from signorini.derivative.validity import SHARED_EVENT, on_edge

_NUDGE = 1e-9  # of the data: how far beyond its condition a pair is looked at
_MOST_PARTS = 20  # combinations of pairs beyond their conditions that are tried


def to_side(walk: ForwardWalk, way: float, rounding: float) -> TapePoint | None:
    """The next point, the end of an increment, with pairs in the parts of the law that hold to one side of a change.

    None where no combination is found.

    Parameters
    ----------
    walk : forwards along the history with the change
    way : 1 upwards, -1 downwards
    rounding : of the data of the law, per unit: what a change of a condition is as good as none below
    """
    point, beyond = walk.next, list[int]()
    edges, none = on_edge(point), rounding * (point.system.law.scale or 1.0)
    for _ in range(_MOST_PARTS):
        there = replace(point, states=_beyond(walk, beyond)) if beyond else point
        change = walk.at_load(there)
        grown = way * change_of_conditions(point, change)
        least = -max(none, SHARED_EVENT * float(np.abs(grown).max()))
        back = _falls_back(walk, there, change, way, least) if beyond else set()
        now = [k for k in edges if (int(point.conditions.pair[k]) not in back if k in beyond else grown[k] < least)]
        if now == beyond:
            return there
        beyond = now
    return None


def _falls_back(walk: ForwardWalk, there: TapePoint, change: PointChange, way: float, least: float) -> set[int]:
    """Pairs that a change has on the former side of their condition, as they are beyond it.

    Parameters
    ----------
    walk, way : as of `to_side`
    there, change : the point with pairs beyond their conditions, and what the change makes of it
    least : what a condition grows by at least
    """
    known, system = there.conditions, there.system
    falls = (np.abs(known.value) <= ZERO * (system.law.scale or 1.0)) & (
        way * change_of_conditions(there, change) < least
    )
    slips, ways = there.slips
    before = _before(walk)
    slipped = system.root * (change.h[1:] - (walk.found[-1].h[1:] if walk.found else 0.0))[:, system.active]
    still = np.linalg.norm(there.h[1:] - before, axis=0)[slips] <= _NUDGE * (system.law.scale or 1.0)
    against = still & (way * (ways * slipped[:, slips]).sum(axis=0) < least)
    return {int(k) for k in [*known.pair[falls], *slips[against]]}


def _before(walk: ForwardWalk) -> Array:
    """(d - 1, n) Tangential motions of the active pairs at the beginning of the next point's increment, scaled."""
    i, system = len(walk.found), walk.next.system
    whole = np.zeros((system.directions - 1, len(system.condensed.active)))
    if i:
        last = walk.points[i - 1]
        whole[:, last.system.active] = last.h[1:] / last.system.root
    return np.asarray(system.root * whole[:, system.active])


def _beyond(walk: ForwardWalk, conditions: Sequence[int]) -> PairStates:
    """The states of the next point's increment with some pairs a little beyond conditions, by their numbers."""
    point = walk.next
    system, known, states, law = point.system, point.conditions, point.states, point.system.law
    tiny, y = _NUDGE * (law.scale or 1.0), point.r - point.h
    y[1:] += _before(walk)
    pairs = known.pair[list(conditions)]
    for k, pair in zip(conditions, pairs, strict=True):
        y[0, pair] += tiny * (known.gap[k] - known.pressure[k] * (not known.friction[:, k].any()))
        y[1:, pair] -= tiny * known.friction[:, k]
    mine = np.isin(np.arange(system.pairs), pairs)
    if states.codes is not None:
        return system.states_of_codes(np.where(mine, law.law.states(y), states.codes))
    found = system.states_of_law(y, point.r)
    assert states.tangent is not None
    assert found.tangent is not None
    tangent, others = (
        {name: np.where(mine, getattr(new, name), getattr(old, name)) for name in names}
        for new, old, names in (
            (found.tangent, states.tangent, ("closed", "left", "share", "fixed", "tau", "kappa")),
            (found, states, ("held", "unit", "branch")),
        )
    )
    return replace(states, tangent=replace(states.tangent, **tangent), **others)
