# SPDX-License-Identifier: BSD-3-Clause
"""Where a straight part of a step first makes a point yield, followed up to there as elastic bodies are.

On a straight piece of an elastic path stresses are linear, and where a point yields on it is known (`crossing`). Over
several pieces they leave the straight way between the ends of all by no more than the energy allows that is stored off
it: few events of a path need a look at the bodies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array
from signorini.engine.chord import LOOKS_TOGETHER, Chord
from signorini.engine.increments import glimpse
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, StepPart, joined, keep, reached
from signorini.errors import SolveFailed
from signorini.outcome import Outcome
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.bracket import Bracket, narrowed, secant
from signorini.plasticity.crossing import crossing
from signorini.plasticity.measure import FlowViolation, fullness, relative_stress, violation, yield_stress
from signorini.plasticity.radial_return import ROOT32
from signorini.plasticity.state import PlasticState
from signorini.solution.state import State

ELASTIC = "nothing yields: bodies answer as elastic ones"
"""What a part says in which no point yields."""

AT_ONCE = 1e-9
"""Of a part: first yield before that is at its start."""

_YIELD_TOL = 1e-9  # of the yield stress: rounding of a point that is about to flow
_SOON = 1e-3  # of a part: a point that flows by then flows from the start
_YIELD_ROUNDS = 30  # of regula falsi: a few where contact grows, as pressures do with a power of the load
_NEAR_YIELD = 1e-6  # of the yield stress: how near it the fullest point is where first yield is found
_INSIDE = 1e-3  # of the bracket: how near its ends the next try may be
_LINE, _POINT = 2.0, 3.0  # powers of the stress that the loads of Hertz's contacts grow with
_AHEAD = 1.5  # times the load at which Hertz's line contact yields: so far ahead first yield is looked for
_MOST_AHEAD = 0.5  # of a part: where that is more, all of it


def _frozen(part: StepPart) -> StepPart:
    """The part with bodies that answer as elastic ones whatever their stresses are."""
    plastic = points_of(part.prepared, part.before)[1]

    def elastic(prepared: Prepared) -> Prepared:
        return replace(prepared, solver=prepared.solver.elastic, flowed=plastic.forces)

    awake = None if part.awake is None else elastic(part.awake)
    exact = part.prepared.interface.directions == 2 and part.prepared.solver.paths is not None
    varies = points_of(part.prepared, part.before)[0].laws.varies
    # else displacements at events are found as they are needed
    whole = part.whole or awake is not None or not exact or varies
    return replace(part, prepared=elastic(part.prepared), awake=awake, whole=whole)


def flows_at_once(part: StepPart) -> bool:
    """Whether points that are about to flow do, as soon as the load of a part changes."""
    if fullest(part.prepared, part.before) < 1.0 - _YIELD_TOL:
        return False
    calm = _frozen(part)
    point = part.before.point.towards(part.end, _SOON)
    u = glimpse(calm.prepared, part.before, point, part.where)
    return u is None or fullest(part.prepared, replace(part.before, point=point, displacement=u)) > 1.0 + _YIELD_TOL


def elastic_part(
    part: StepPart, elastically: Callable[[StepPart], FollowedPart]
) -> tuple[FollowedPart | None, StepPart | None]:
    """What is followed until a point yields, and what is left of the part; None where nothing is.

    Parameters
    ----------
    part : of a model with bodies that yield
    elastically : follows a part in which nothing yields
    """
    prepared, behind = part.prepared, list[FollowedPart]()
    while True:
        ahead, lost = _ahead(part, len(behind)), None
        try:
            followed: FollowedPart | None = elastically(_frozen(ahead))
        except SolveFailed as failure:
            followed, lost = reached(failure), failure
        found = None if followed is None else _first_yield(ahead, followed)
        if found is not None:
            break
        if lost is not None:
            raise keep(lost, behind)
        assert followed is not None
        behind.append(followed)
        if ahead is part:
            return _below_yield(prepared, joined(behind), ELASTIC), None
        part = part.rest(ahead, followed.after)
    exactly = None if followed is None or lost is not None else followed.until

    def again(cut: StepPart, factor: float) -> FollowedPart:
        return elastically(_frozen(cut)) if exactly is None else exactly(factor)

    reached_yield = _up_to_yield(ahead, found, again)
    if reached_yield is None:
        return (joined(behind) if behind else None), part
    cut, begun = reached_yield
    words = f"{part.where} at {cut.interval.high:.6%}: first yield, {_place(prepared, begun.after)}"
    return _below_yield(prepared, joined([*behind, begun]), words), part.rest(cut, begun.after)


def _ahead(part: StepPart, tried: int) -> StepPart:
    """As much of a part as first yield may be in, more the more was tried: under a contact stresses grow as roots."""
    u = glimpse(_frozen(part).prepared, part.before, part.end, part.where)
    if u is None:
        return part
    end = replace(part.before, point=part.end, displacement=u)
    share = 4.0**tried * _AHEAD / max(fullest(part.prepared, end), 1.0) ** _hertz(part.prepared)
    return part if share > _MOST_AHEAD else part.cut(share, "event")


def _hertz(prepared: Prepared) -> float:
    """Power of the stress that the load of a contact grows with."""
    return _LINE if prepared.interface.directions == 2 and not prepared.model.axisymmetric else _POINT


def _up_to_yield(
    part: StepPart, found: _Crossing, elastically: Callable[[StepPart, float], FollowedPart]
) -> tuple[StepPart, FollowedPart] | None:
    """The part up to where its first point yields, and how it was followed; None where that is at its beginning.

    On a straight way the first try is it; else stresses grow with a power of the load as contact does, and where that
    law no longer halves what is lacking regula falsi goes on, from the side that does not yield.
    """
    bracket, factor = found
    last = bracket.high, bracket.above
    best: tuple[StepPart, FollowedPart] | None = None
    for tried in range(_YIELD_ROUNDS):
        if factor <= AT_ONCE:
            break
        cut = part.cut(factor, "event")
        begun = elastically(cut, factor)
        states = [begun.after, *(shot.state for shot in begun.snapshots[:-1] if shot.whole)]
        excess = max(fullest(part.prepared, state) for state in states) - 1.0  # a point may be fuller on the way
        if excess <= _YIELD_TOL:
            best = cut, begun
            if excess >= -_NEAR_YIELD:
                break
        bracket = narrowed(bracket, factor, excess, excess > _YIELD_TOL)
        aim = -0.5 * _NEAR_YIELD
        grows = not tried or abs(excess) < 0.5 * abs(last[1])
        guess = _by_power(last, (factor, excess), aim) if grows else None
        last = factor, excess
        factor = secant(bracket, aim, _INSIDE)
        if guess is not None and bracket.low < guess < bracket.high:
            factor = guess
    return best


def _by_power(one: tuple[float, float], two: tuple[float, float], aim: float) -> float | None:
    """The load factor at which a power of it, through two of them with what exceeds 1 there, exceeds 1 by an aim.

    Where one of them is nothing it is that of Hertz's line contact.
    """
    exponent = _LINE
    if min(one[0], 1.0 + one[1]) > 0.0:
        grown, stretched = (1.0 + two[1]) / (1.0 + one[1]), two[0] / one[0]
        if min(grown, stretched) <= 0.0 or grown == 1.0:
            return None
        exponent = np.log(stretched) / np.log(grown)
    with np.errstate(over="ignore"):  # where stress hardly changes: beyond every bracket
        return float(two[0] * np.float64((1.0 + aim) / (1.0 + two[1])) ** exponent)


def _below_yield(prepared: Prepared, followed: FollowedPart, note: str) -> FollowedPart:
    """What was followed elastically with a note, certified to leave no point beyond its yield stress."""
    states = [shot.state for shot in followed.snapshots if shot.whole]
    fullest = max((_still(prepared, state) for state in states), key=lambda found: found.excess)
    *others, last = followed.certificates
    certificates = (*others, replace(last, plastic=fullest))
    if not certificates[-1].passed:
        raise SolveFailed(f"{note}: but a point is beyond it, {certificates[-1]}", status=Outcome.NOT_FOUND)
    return replace(followed, certificates=certificates, notes=(*followed.notes, note))


def _still(prepared: Prepared, state: State) -> FlowViolation:
    """What a state in which nothing flows lacks of the flow rule."""
    bodies, plastic = points_of(prepared, state)
    return violation(bodies, state.displacement, plastic, plastic, bodies.heat(state.point.factors))


def points_of(prepared: Prepared, state: State) -> tuple[YieldingBodies, PlasticState]:
    """The points of bodies that yield, and what they remember in a state."""
    assert prepared.yielding is not None
    assert state.plastic is not None
    return prepared.yielding, state.plastic


def fullest(prepared: Prepared, state: State) -> float:
    """The largest relative stress of any point over its yield stress."""
    bodies, plastic = points_of(prepared, state)
    return float(fullness(bodies, state.displacement, plastic, bodies.heat(state.point.factors)).max())


class _Crossing(NamedTuple):
    """Where on an elastic path the first point yields, as fractions of a part.

    Attributes
    ----------
    bracket : of states before and behind, with what the fullest point has beyond its yield stress, of that
    factor : where it does if stresses are straight between them
    """

    bracket: Bracket
    factor: float


class _Look(NamedTuple):
    """A state of a path that was looked at.

    Attributes
    ----------
    factor : fraction of the part
    state : with the displacement of the bodies
    full : (p,) relative stresses over the yield stress
    """

    factor: float
    state: State
    full: Array

    @staticmethod
    def at(prepared: Prepared, factor: float, state: State, limit: Array | None = None) -> _Look:
        """A whole state at a fraction of the part; ``limit``: (p,) yield stresses, where they are known."""
        bodies, plastic = points_of(prepared, state)
        heat = bodies.heat(state.point.factors)
        return _Look(factor, state, fullness(bodies, state.displacement, plastic, heat, limit))

    @property
    def excess(self) -> float:
        """What the fullest point has beyond its yield stress, of that."""
        return float(self.full.max()) - 1.0


def _first_yield(part: StepPart, followed: FollowedPart) -> _Crossing | None:
    """Where the first point yields on an elastic path; None where none does."""
    prepared, between = part.prepared, list[tuple[float, State]]()
    bodies, plastic = points_of(prepared, followed.before)
    varies = bodies.laws.varies  # then all states are whole
    heat = bodies.heat(followed.before.point.factors)
    limit = None if varies else yield_stress(bodies, plastic.equivalent, heat)
    one = _Look.at(prepared, 0.0, followed.before, limit)
    for shot in followed.snapshots:
        here = part.interval.within(shot.fraction), shot.state
        if not shot.whole:
            between.append(here)
            continue
        two = _Look.at(prepared, *here, limit)
        ends = (one, two) if limit is None else _between(prepared, one, two, between, limit)
        found = None if ends is None else _crossed(prepared, *ends)
        if found is not None:
            return found
        one, between = two, []
    return None


def _between(
    prepared: Prepared, one: _Look, two: _Look, between: list[tuple[float, State]], limit: Array
) -> tuple[_Look, _Look] | None:
    """The first state of a path with a point beyond its yield stress, after the one before it; None where none has.

    Parameters
    ----------
    prepared : the model
    one, two : whole states; only the second may have such a point
    between : states of the path between them, and where they are
    limit : (p,) yield stresses
    """
    known = {-1: one, len(between): two}
    if between:
        parts = (np.array([factor for factor, _ in between]) - one.factor) / (two.factor - one.factor)
        chord = Chord.of(prepared, (one.state, two.state), parts, [state for _, state in between])
        reach = _full_by_energy(prepared, limit)
    while True:
        beyond = next((i for i in sorted(known) if known[i].excess > _YIELD_TOL), None)
        unsure = [
            (i, j)
            for i, j in pairwise(i for i in sorted(known) if beyond is None or i <= beyond)
            if j > i + 1
            and (np.maximum(known[i].full, known[j].full) + reach * chord.energy(i, j) ** 0.5).max() > 1.0 + _YIELD_TOL
        ]
        if not unsure:
            break
        looks = []
        if unsure[-1][1] == beyond:
            i, _ = unsure.pop()
            first = _behind_yield(known[i], known[beyond], [factor for factor, _ in between[i + 1 : beyond]])
            looks = [k for k in (i + first, i + 1 + first) if i < k < beyond]
            unsure.append((i, looks[0]))
        looks = _spread(unsure, looks)
        for i, u in zip(looks, chord.displacements(np.array(looks)), strict=True):
            factor, state = between[i]
            known[i] = _Look.at(prepared, factor, replace(state, displacement=u), limit)
    return None if beyond is None else (known[beyond - 1], known[beyond])


def _behind_yield(below: _Look, beyond: _Look, factors: list[float]) -> int:
    """How many events come before first yield, where stresses grow with a power of the load.

    Parameters
    ----------
    below, beyond : states between which a point begins to yield
    factors : of the events between them, fractions of the part
    """
    guess = _by_power((below.factor, below.excess), (beyond.factor, beyond.excess), 0.0)
    return len(factors) // 2 if guess is None else int(np.searchsorted(factors, guess))


def _spread(between: list[tuple[int, int]], looks: list[int]) -> list[int]:
    """As many events as are looked at together, in order: halves of intervals, and halves of these.

    Parameters
    ----------
    between : the events on either side of each interval
    looks : events that are looked at anyway
    """
    halved, chosen = list(between), set(looks)
    for i, j in halved:  # grows meanwhile
        if len(chosen) >= LOOKS_TOGETHER:
            break
        if j > i + 1:
            k = (i + j) // 2
            chosen.add(k)
            halved += [(i, k), (k, j)]
    return sorted(chosen)


def _full_by_energy(prepared: Prepared, limit: Array) -> Array:
    """(p,) The most that energy E in the bodies adds to relative stresses over the yield stress, over the root of E.

    The deviator s at a point of volume w stores ``w s : s / 4 G``, which is no more than all of it.

    Parameters
    ----------
    prepared : the model
    limit : (p,) yield stresses
    """
    bodies = prepared.yielding
    assert bodies is not None
    return np.asarray(ROOT32 * np.sqrt(4.0 * bodies.laws.shear[bodies.body] / bodies.weights) / limit)


def _crossed(prepared: Prepared, one: _Look, two: _Look) -> _Crossing | None:
    """Where a point yields on the straight way from one state to another; None where none does."""
    ends = one.state, two.state
    bodies, plastic = points_of(prepared, one.state)
    heat = bodies.heat(ends[0].point.factors), bodies.heat(ends[1].point.factors)
    stresses = [relative_stress(bodies, ends[k].displacement, plastic, heat[k]) for k in (0, 1)]
    found = crossing(bodies, (stresses[0], stresses[1]), plastic.equivalent, heat)
    if found is None:
        return None
    low, length = one.factor, two.factor - one.factor
    above = max(found.excess, two.excess) if found.beyond == 1.0 else found.excess
    bracket = Bracket(low, low + found.beyond * length, min(one.excess, 0.0), above, 0)
    return _Crossing(bracket=bracket, factor=low + found.part * length)


def _place(prepared: Prepared, state: State) -> str:
    """Where the fullest point is, in words."""
    bodies, plastic = points_of(prepared, state)
    full = fullness(bodies, state.displacement, plastic, bodies.heat(state.point.factors))
    i = int(np.argmax(full))
    at = ", ".join(f"{x:.4g}" for x in bodies.places()[i])
    return f"in '{prepared.model.bodies[int(bodies.body[i])].name}' at ({at})"
