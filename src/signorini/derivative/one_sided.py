# SPDX-License-Identifier: BSD-3-Clause
"""What a history does to each side of what is varied, where pairs share an event or come to one at the very end.

Events on the way come one after the other, see `event_order`, and on paths that are linear from event to event also
those at the very end. On smooth cones the last piece ends at that event there, and one of no length follows in the
states in which the path would go on under more load: other pairs may change theirs with it, and friction keeps its
direction, or takes that of the rates where a pair closes. In an increment, also in one on the way that goes on over
events, the pair alone obeys another part of its law.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, frozen
from signorini.derivative.interface_system import PairStates
from signorini.derivative.points import TapePoint
from signorini.derivative.space_conditions import states_of_piece
from signorini.derivative.validity import PathEdge
from signorini.derivative.view import HistoryView
from signorini.engine.tape import Leg
from signorini.errors import InputError
from signorini.friction.history.rates import NoRates
from signorini.friction.history.space.find_rates import find_rates

_NUDGE = 1e-9  # of the data: how far beyond its event a pair is looked at
_WIDTH = 1e-8  # of the data: of zero at an event on a smooth cone


def beside(
    view: HistoryView,
    legs: Sequence[Leg],
    found: Sequence[PathEdge],
    what: str,
    in_order: Callable[[float], Sequence[TapePoint]],
) -> tuple[Sequence[TapePoint], Sequence[TapePoint]]:
    """The points of a history below and above what is varied.

    Parameters
    ----------
    view : the history, up to where it is asked for
    legs : straight parts of the history
    found : its edges
    what : is varied, in words
    in_order : gives its points with events in order, to the lower side (-1) and to the upper one (1)

    Raises
    ------
    InputError
        Where one of both is not known.
    """
    points, last = view.points, len(view.points) - 1
    words = f"{found[0].words}: what {what} does on the other side is not known"
    if any(points[edge.point].system.locked != points[-1].system.locked for edge in found):  # bolts lock behind it
        raise InputError(words)
    at_end = [edge for edge in found if not _in_order(points[edge.point])]
    on_way = [edge for edge in found if edge not in at_end]
    unknown = [edge for edge in at_end if edge.point != last or len(at_end) > 1]
    if unknown:
        raise InputError(f"{unknown[0].words}: what {what} does on the other side is not known")
    sides = [points, points]
    if on_way:
        try:
            sides = [in_order(-1.0), in_order(1.0)]
        except InputError as error:
            raise InputError(f"{words}; {error}") from error
    for edge in at_end:
        across = 0 if edge.change > 0.0 else 1
        beyond = _beyond(replace(view, points=sides[across]), edge.condition, legs)
        if beyond is None:
            raise InputError(words)
        sides[across] = beyond
    below, above = sides
    return below, above


def _in_order(point: TapePoint) -> bool:
    """Whether what comes to its edge at a point does so one after the other, see `event_order`."""
    return not len(point.stays) and (point.ends_at_events or point.tied or point.at_event)


def _beyond(view: HistoryView, condition: int, legs: Sequence[Leg]) -> list[TapePoint] | None:
    """The points of a history on the other side of an event at their end; None where that is not known.

    Parameters
    ----------
    view : the history
    condition : number of that which vanishes at the last point
    legs : straight parts of the history
    """
    *before, point = view.points
    if point.rates is None or point.passes:
        states = _nudged(point, view.motions(len(before) - 1)[1:] if before else None, condition)
        return [*before, replace(point, states=states)]
    on = _gone_on(point, legs[point.leg])
    if on is None:
        return None
    event = replace(point, acting=point.conditions.pair[[condition]], acts=condition, quiet=None)
    return [*before, event, replace(point, states=on, h_rate=None, r_rate=None, load_rate=None)]


def _gone_on(point: TapePoint, leg: Leg) -> PairStates | None:
    """The states in which the path of a leg on smooth cones would go on; None where it does not."""
    assert leg.start is not None
    assert leg.segment is not None
    law, end = point.system.law, leg.segment.end
    rates = find_rates(replace(law, b=frozen(end.b - leg.start.b)), end, _WIDTH * (law.scale or 1.0))
    if isinstance(rates, NoRates):
        return None
    part = _NUDGE * (law.scale or 1.0) / max(np.abs(rates.h).max(), np.abs(rates.r).max())
    return states_of_piece(law, rates.state, (end.h, end.r), (end.h + part * rates.h, end.r + part * rates.r))


def _nudged(point: TapePoint, before: Array | None, condition: int) -> PairStates:
    """The states of an increment with that of one pair a little beyond a condition.

    Parameters
    ----------
    point : its end
    before : (d - 1, n) tangential motions of all pairs at its beginning, length; None: nothing has moved
    condition : number of that which vanishes
    """
    system, known, states = point.system, point.conditions, point.states
    pair, law = int(known.pair[condition]), system.law
    tiny = _NUDGE * (law.scale or 1.0)
    y = point.r - point.h
    if before is not None:
        y[1:] += system.root * before[:, system.active]
    y[0, pair] += tiny * (known.gap[condition] - known.pressure[condition] * (not known.friction[:, condition].any()))
    y[1:, pair] -= tiny * known.friction[:, condition]
    if states.codes is not None:
        codes = states.codes.copy()
        codes[pair] = law.law.states(y)[pair]
        return system.states_of_codes(codes)
    found = system.states_of_law(y, point.r)
    assert states.tangent is not None
    assert found.tangent is not None
    mine = np.arange(system.pairs) == pair
    tangent, others = (
        {name: np.where(mine, getattr(new, name), getattr(old, name)) for name in names}
        for new, old, names in (
            (found.tangent, states.tangent, ("closed", "left", "share", "fixed", "tau", "kappa")),
            (found, states, ("held", "unit", "branch")),
        )
    )
    return replace(states, tangent=replace(states.tangent, **tangent), **others)
