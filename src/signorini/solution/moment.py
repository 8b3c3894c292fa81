# SPDX-License-Identifier: BSD-3-Clause
"""Any moment of a history: which one is meant, and its contacts, between two events of an exact path too.

Between two events forces, gaps and slips are linear in the load, dissipation is the integral of the one over the other.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, frozen
from signorini.errors import InputError, one_of
from signorini.solution.history import History
from signorini.solution.obstacle_result import ObstacleMotion
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult, Instant, StepResult

NOTHING_HAPPENS = "between"
"""What happens at a moment between two instants: nothing."""

_SAME_LOAD = 1e-9  # of a step: loads that are closer are one
_STILL = 1e-12  # of the largest slip or pressure: less is rounding
_TOUCHING = 1e-9  # of the largest gap: closer pairs touch
_SPARE = 1e-9  # of what is dissipated: more than friction says is taken by bonds and closures
_LISTED = 8  # loads that a message names
_WORN_ON_THE_WAY = "sides wear on the way; expected the load of an instant, "


@dataclass(frozen=True, kw_only=True, eq=False)
class MomentPlace:
    """Where a moment is in a history.

    Attributes
    ----------
    number : of its step, from 1
    before, after : instants around it; before is None where it is an instant itself, which is ``after``
    part : of the way from the one to the other, 0 .. 1
    """

    number: int
    before: Instant | None
    after: Instant
    part: float


def step_number(history: History, step: int | str | None) -> int:
    """The number of a step, from 1, by its name or number; the last one for None.

    Raises
    ------
    InputError
        If there is no such step.
    """
    count = len(history.steps)
    if not count:
        raise InputError("nothing was solved; there is no result")
    if step is None:
        return count
    names = [found.name for found in history.steps]
    if isinstance(step, str):
        if step not in names:
            raise InputError(one_of(step, names, "step"), where=("step",))
        return names.index(step) + 1
    if not 1 <= step <= count:
        raise InputError(f"is {step}; expected the number of a step, 1 to {count}, or its name", where=("step",))
    return int(step)


def event_load(history: History, number: int, event: int) -> float:
    """The part of a step at which one of its events is.

    Parameters
    ----------
    history, number : with that step, which counts from 1
    event : its number in the step, from 1

    Raises
    ------
    InputError
        If there is none of that number.
    """
    events = history.steps[number - 1].events
    if not 1 <= event <= len(events):
        raise InputError(f"is {event}; step {number} has {_numbers(len(events), 'event')}", where=("event",))
    return events[event - 1].load_factor - (number - 1)


def increment_end(history: History, number: int, increment: int | None) -> MomentPlace:
    """The end of an increment of a step; of the step where none is named.

    Parameters
    ----------
    history, number : with that step, which counts from 1
    increment : its number in the step, from 1

    Raises
    ------
    InputError
        If there is none of that number.
    """
    result = history.steps[number - 1]
    ends = [result.instants[-1]]
    if increment is not None:
        ends = [instant for instant in result.instants if instant.what in ("increment", "asked", "segment")]
        if result.path == "exact" or not 1 <= increment <= len(ends):
            words = "an exact path, without increments" if result.path == "exact" else _numbers(len(ends), "increment")
            raise InputError(f"is {increment}; step {number} has {words}", where=("increment",))
    return MomentPlace(number=number, before=None, after=ends[(increment or 0) - 1], part=1.0)


def _numbers(count: int, what: str) -> str:
    return f"{count} {what}{'s' if count != 1 else ''}"


def at_load(history: History, number: int, load: float, rest: Callable[[], Instant]) -> MomentPlace:
    """The moment at a part of a step; where two states are at one load, the later one.

    Parameters
    ----------
    history, number : with that step, which counts from 1
    load : part of the step, 0 .. 1
    rest : the bodies before any load, asked for where a history begins with them

    Raises
    ------
    InputError
        If the step was not followed so far, or is not linear there: the loads that are known are named.
    """
    result = history.steps[number - 1]
    reached = result.load_factor - (number - 1)
    if not 0.0 <= load <= reached + _SAME_LOAD:
        limit = "" if result.finished else f", which ended at {reached:.6g}"
        raise InputError(f"is {load:g}; expected a part of step {number} between 0 and 1{limit}", where=("load",))
    factors = [instant.load_factor for instant in result.instants]
    at = number - 1 + load
    later = bisect_right(factors, at + _SAME_LOAD)
    if later and at - factors[later - 1] <= _SAME_LOAD:
        return MomentPlace(number=number, before=None, after=result.instants[later - 1], part=1.0)
    after = result.instants[later]
    before = result.instants[later - 1] if later else _before(history, number, rest)
    if load <= _SAME_LOAD:
        return MomentPlace(number=number, before=None, after=before, part=1.0)
    begin = factors[later - 1] if later else number - 1.0
    why = _not_linear(history, number, (begin, after.load_factor), before, after)
    if why:
        raise InputError(f"is {load:g}; {why}{_known(result, number)}", where=("load",))
    return MomentPlace(number=number, before=before, after=after, part=(at - begin) / (after.load_factor - begin))


def _before(history: History, number: int, rest: Callable[[], Instant]) -> Instant:
    """The state that a step begins in; what a step counts is counted anew."""
    first = history.steps[number - 1].instants[0]
    state: Instant | StepResult
    if number > 1:
        state = history.steps[number - 2]
        end = state.instants[-1]
    else:
        state = end = rest() if history.begin is None else history.begin
    contacts = tuple(_counting_anew(contact) for contact in end.contacts)
    factors = {name: end.factors.get(name, 0.0) for name in first.factors}
    end = replace(end, displacement=state.displacement, motions=state.motions)
    return replace(end, contacts=contacts, work=0.0, factors=factors)


def _counting_anew(contact: ContactResult) -> ContactResult:
    """A contact at the beginning of a step."""
    none = np.zeros_like(contact.gap)
    return replace(contact, sliding=none, slip_range=none, worn=none, dissipation=0.0)


def _not_linear(history: History, number: int, ends: tuple[float, float], before: Instant, after: Instant) -> str:
    """Why a step is not linear between two of its loads; empty where it is."""
    model, result = history.model, history.steps[number - 1]
    if model.contacts and result.path != "exact":
        return "the step was solved in increments, between which nothing is known; expected "
    if model.yields:
        return "bodies yield on the way; expected "
    if model.slides:
        return "pairs follow the bodies on the way; expected "
    step = model.steps[number - 1]
    kinks = np.arange(1, step.segments * step.repeat) / (step.segments * step.repeat) + number - 1.0
    if ((kinks > ends[0] + _SAME_LOAD) & (kinks < ends[1] - _SAME_LOAD)).any():
        return "no cycle was followed there; expected "
    worn = [
        contact.wear is not None and then.wear is not None and not np.array_equal(contact.wear.depth, then.wear.depth)
        for contact, then in zip(before.contacts, after.contacts, strict=True)
    ]
    return _WORN_ON_THE_WAY if any(worn) else ""


def _known(result: StepResult, number: int) -> str:
    """Loads at which a step is known, in words."""
    loads = list(dict.fromkeys(f"{instant.load_factor - (number - 1):.6g}" for instant in result.instants))
    more = f" or {len(loads) - _LISTED} more up to {loads[-1]}" if len(loads) > _LISTED else ""
    return f"{', '.join(loads[:_LISTED])}{more}, or 'at = [...]' in the step"


def instant_at(history: History, place: MomentPlace) -> Instant:
    """The contacts at a moment, and the displacement of the bodies where it is kept around it."""
    before, after, t = place.before, place.after, place.part
    if before is None:
        return after
    load = before.load_factor + t * (after.load_factor - before.load_factor)
    slips = _cycle_slips(history, place, load)
    known = before.displacement is not None and after.displacement is not None
    return Instant(
        load_factor=load,
        what=NOTHING_HAPPENS,
        contacts=tuple(
            _contact_between(one, two, t, slip)
            for one, two, slip in zip(before.contacts, after.contacts, slips, strict=True)
        ),
        work=np.nan,
        displacement=frozen(_mean(before.displacement, after.displacement, t)) if known else None,
        factors={name: (1.0 - t) * before.factors.get(name, 0.0) + t * end for name, end in after.factors.items()},
        plastic=None,
        places=after.places,
        nodal_forces=before.nodal_forces.towards(after.nodal_forces, t)
        if known and before.nodal_forces is not None and after.nodal_forces is not None
        else None,
        motions=_motions_between(before.motions, after.motions, t) if known else None,
    )


def _motions_between(
    before: Mapping[str, ObstacleMotion] | None, after: Mapping[str, ObstacleMotion] | None, t: float
) -> Mapping[str, ObstacleMotion] | None:
    """Of obstacles and rigid bodies at a part of the way; None where they are not known at both ends."""
    if before is None or after is None:
        return None
    return {
        name: ObstacleMotion(
            displacement=frozen(_mean(before[name].displacement, end.displacement, t)),
            rotation=(1.0 - t) * before[name].rotation + t * end.rotation,
        )
        for name, end in after.items()
    }


def _cycle_slips(history: History, place: MomentPlace, load: float) -> list[list[Array]]:
    """Of every contact its slips at the instants before a load, back to where its cycle begins."""
    first, repeat = place.number - 1, history.model.steps[place.number - 1].repeat
    begin = first + np.ceil((load - first) * repeat - _SAME_LOAD - 1.0) / repeat
    instants = history.steps[first].instants
    behind = [instant for instant in instants if begin - _SAME_LOAD <= instant.load_factor < load]
    if begin <= first + _SAME_LOAD:
        end = history.steps[first - 1].instants[-1] if first else history.begin
        behind = ([] if end is None else [end]) + behind
    rest = [] if first or history.begin is not None or begin > _SAME_LOAD else [0.0]
    return [
        [*(zero * contact.slip for zero in rest), *(instant.contacts[i].slip for instant in behind)]
        for i, contact in enumerate(place.after.contacts)
    ]


def _mean(before: Array | None, after: Array | None, t: float) -> Array:
    """Between two arrays at a part of the way."""
    assert before is not None
    assert after is not None
    return np.asarray((1.0 - t) * before + t * after)


def _contact_between(before: ContactResult, after: ContactResult, t: float, slips: Sequence[Array]) -> ContactResult:
    """A contact on a linear piece.

    Parameters
    ----------
    before, after : at its ends
    t : part of the way
    slips : at the instants of the cycle so far
    """
    moved = after.slip - before.slip
    slip = before.slip + t * moved
    pairs = len(before.gap)
    every = np.stack([*slips, slip]).reshape(len(slips) + 1, pairs, -1)
    way = np.linalg.norm(moved.reshape(pairs, -1), axis=1)
    # friction is linear, too: what it dissipates is a parabola
    start, change = ((-tau * moved).reshape(pairs, -1).sum(axis=1) for tau in (before.traction, after.traction))
    whole, spent = 0.5 * (start + change), t * start + 0.5 * t**2 * (change - start)
    share = np.divide(spent, whole, out=np.zeros(pairs), where=whole != 0.0)
    worn = before.worn + share * (after.worn - before.worn)
    rubbed = float((after.area * (after.worn - before.worn)).sum())
    beside = after.dissipation - before.dissipation - rubbed  # what bonds and closures take, which is not known between
    unknown = abs(beside) > _SPARE * abs(after.dissipation)
    damage = after.damage if before.damage is None or after.damage is None else _mean(before.damage, after.damage, t)
    return replace(
        after,
        gap=frozen(_mean(before.gap, after.gap, t)),
        pressure=frozen(_mean(before.pressure, after.pressure, t)),
        traction=frozen(_mean(before.traction, after.traction, t)),
        slip=frozen(slip),
        sliding=frozen(before.sliding + t * way),
        slip_range=frozen(np.linalg.norm(every.max(axis=0) - every.min(axis=0), axis=1)),
        status=_status_between(before, after, way),
        worn=frozen(worn),
        dissipation=np.nan if unknown else before.dissipation + float((after.area * (worn - before.worn)).sum()),
        damage=damage,
    )


def _status_between(before: ContactResult, after: ContactResult, way: Array) -> NDArray[np.str_]:
    """(n,) What pairs do between two instants, from how far they slip on the way, (n,).

    An event has the states that hold from it on, the end of a segment those that held up to it.
    """
    opens, opened = before.status == OPEN, after.status == OPEN
    loose, far = (np.abs(end.pressure) <= _STILL * np.abs(end.pressure).max(initial=0.0) for end in (before, after))
    apart = ~(after.gap <= _TOUCHING * np.nanmax(np.abs(after.gap), initial=0.0))
    parted = (opens & (opened | far)) | (opened & (loose | apart))
    still = way <= _STILL * max(float(np.abs(after.slipped).max(initial=0.0)), float(way.max(initial=0.0)))
    slipping = (before.status == SLIP) & (after.status == SLIP)
    rubs = (before.traction != 0.0) | (after.traction != 0.0)
    rubs = rubs if rubs.ndim == 1 else rubs.any(axis=1)
    moves = ~still | (slipping & ~rubs) | (~rubs & np.where(opens, after.status == SLIP, before.status == SLIP))
    return np.where(parted, OPEN, np.where(moves, SLIP, STICK))
