# SPDX-License-Identifier: BSD-3-Clause
"""Straight parts of a step in which bodies may yield: as elastic bodies until a point does, then in increments.

On a straight piece of an elastic path stresses are linear and the yield function is convex, so that its ends tell
whether anything yields on it, and the load of first yield is the root of a quadratic. Increments are backward Euler,
of first order: as many as it takes for their halves to change the answer less than a tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array
from signorini.engine.collapse import Collapse, collapse
from signorini.engine.increments import advance, follow_increments
from signorini.engine.plastic_solver import PlasticSolver
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, StepPart, joined, keep, reached
from signorini.errors import SolveFailed, told
from signorini.model.step import Step
from signorini.outcome import Outcome
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.measure import FlowViolation, deviator, fullness, inner, size, violation, yield_stress
from signorini.plasticity.state import PlasticState
from signorini.solution.state import State

TOLERANCE = 1e-2
"""Of ``increments = "auto"`` where bodies yield, if the step gives none: backward Euler is of first order."""

ELASTIC = "nothing yields: bodies answer as elastic ones"
"""What a part says in which no point yields."""

_YIELD_TOL = 1e-9  # of the yield stress: rounding of a point that is about to flow
_SOON = 1e-3  # of a part: a point that flows by then flows from the start
_YIELD_ROUNDS = 30  # of regula falsi: a few where contact grows, as pressures do with a power of the load
_NEAR_YIELD = 1e-6  # of the yield stress: how near it the fullest point is where first yield is found
_INSIDE = 1e-3  # of the bracket: how near its ends the next try may be
_AHEAD = 1.5  # times the load at which Hertz's line contact yields: so far ahead first yield is looked for
_MOST_AHEAD = 0.5  # of a part: where that is more, all of it
_AT_ONCE = 1e-9  # of a part: first yield before that is at its start
_INCREMENTS_BELOW = 8  # of what is followed below collapse: the load named is a bound, they may end before it
_BELOW_COLLAPSE = 0.98  # of the load at which bodies flow: up to there they are followed
_LITTLE_WORK = 1e-6  # of the plastic work so far: where a part takes less, its share decides nothing
_MAX_INCREMENTS = 256  # of a straight part: more of them are not tried by themselves


def follow_plastically(part: StepPart, step: Step, elastically: Callable[[StepPart], FollowedPart]) -> FollowedPart:
    """Follow a straight part of a step.

    Parameters
    ----------
    part : of a model with bodies that yield
    step : what was asked for
    elastically : follows a part in which nothing yields as the step asks for

    Raises
    ------
    SolveFailed
        Where bodies flow without end, with the load at most; or as increments and elastic paths do.
    """
    behind: list[FollowedPart] = []
    if not _flows_at_once(part):
        begun, rest = _elastic_part(part, elastically)
        behind = [] if begun is None else [begun]
        if rest is None:
            return joined(behind)
        part = rest
    if step.path == "exact":
        words = told(
            f"{part.where} at {part.interval.low:.6%}: a point yields, and plastic flow has no exact path",
            remedy="follow the step in increments, or leave path out",
        )
        raise keep(SolveFailed(words, status=Outcome.NOT_FOUND), behind)
    try:
        return joined([*behind, replace(_in_increments(part, step), path="increments")])
    except SolveFailed as failure:
        if (flowed := reached(failure)) is not None:
            failure.reached = replace(flowed, path="increments")
        raise keep(failure, behind) from None


def _frozen(part: StepPart) -> StepPart:
    """The part with bodies that answer as elastic ones whatever their stresses are."""
    plastic = _points(part.prepared, part.before)[1]

    def elastic(prepared: Prepared) -> Prepared:
        assert isinstance(prepared.solver, PlasticSolver)
        return replace(prepared, solver=prepared.solver.elastic, flowed=plastic.forces)

    awake = None if part.awake is None else elastic(part.awake)
    return replace(part, prepared=elastic(part.prepared), awake=awake, whole=True)


def _flows_at_once(part: StepPart) -> bool:
    """Whether points that are about to flow do, as soon as the load changes."""
    if fullest(part.prepared, part.before) < 1.0 - _YIELD_TOL:
        return False
    calm = _frozen(part)
    point = part.before.point.towards(part.end, _SOON)
    try:
        state, _, _ = advance(calm.prepared, part.before, point, part.where)
    except SolveFailed:
        return True
    return fullest(part.prepared, state) > 1.0 + _YIELD_TOL


def _elastic_part(
    part: StepPart, elastically: Callable[[StepPart], FollowedPart]
) -> tuple[FollowedPart | None, StepPart | None]:
    """What is followed until a point yields, and what is left of the part; None where nothing is."""
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
    reached_yield = _up_to_yield(ahead, found, elastically)
    if reached_yield is None:
        return (joined(behind) if behind else None), part
    cut, begun = reached_yield
    words = f"{part.where} at {cut.interval.high:.6%}: first yield, {_place(prepared, begun.after)}"
    return _below_yield(prepared, joined([*behind, begun]), words), part.rest(cut, begun.after)


def _ahead(part: StepPart, tried: int) -> StepPart:
    """As much of a part as first yield may be in, more the more was tried: under a contact stresses grow as roots."""
    try:
        end, _, _ = advance(_frozen(part).prepared, part.before, part.end, part.where)
    except SolveFailed:
        return part
    share = 4.0**tried * _AHEAD / max(fullest(part.prepared, end), 1.0) ** 2
    return part if share > _MOST_AHEAD else part.cut(share, "event")


def _up_to_yield(
    part: StepPart, bracket: _Bracket, elastically: Callable[[StepPart], FollowedPart]
) -> tuple[StepPart, FollowedPart] | None:
    """The part up to where its first point yields, and how it was followed; None where that is at its beginning.

    On a straight piece of an exact path the first try is it; between increments stresses bend, and it is found by
    regula falsi from the side that does not yield.
    """
    (low, below), (high, above), factor = bracket.low, bracket.high, bracket.factor
    best: tuple[StepPart, FollowedPart] | None = None
    side = 0
    for _ in range(_YIELD_ROUNDS):
        if factor <= _AT_ONCE:
            break
        cut = part.cut(factor, "event")
        begun = elastically(_frozen(cut))
        excess = fullest(part.prepared, begun.after) - 1.0
        if excess <= _YIELD_TOL:
            best = cut, begun
            if excess >= -_NEAR_YIELD:
                break
            low, below, above, side = factor, excess, above * (0.5 if side < 0 else 1.0), -1
        else:
            high, above, below, side = factor, excess, below * (0.5 if side > 0 else 1.0), 1
        aim = -0.5 * _NEAR_YIELD
        factor = low + (high - low) * min(max((aim - below) / (above - below), _INSIDE), 1.0 - _INSIDE)
    return best


def _below_yield(prepared: Prepared, followed: FollowedPart, note: str) -> FollowedPart:
    """What was followed elastically with a note, certified to leave no point beyond its yield stress."""
    states = [*(shot.state for shot in followed.snapshots if shot.whole), followed.after]
    fullest = max((_still(prepared, state) for state in states), key=lambda found: found.excess)
    *others, last = followed.certificates
    certificates = (*others, replace(last, plastic=fullest))
    if not certificates[-1].passed:
        raise SolveFailed(f"{note}: but a point is beyond it, {certificates[-1]}", status=Outcome.NOT_FOUND)
    return replace(followed, certificates=certificates, notes=(*followed.notes, note))


def _still(prepared: Prepared, state: State) -> FlowViolation:
    """What a state in which nothing flows lacks of the flow rule."""
    bodies, plastic = _points(prepared, state)
    return violation(bodies, state.displacement, plastic, plastic, bodies.swelling(state.point.factors))


def _points(prepared: Prepared, state: State) -> tuple[YieldingBodies, PlasticState]:
    """The points of bodies that yield, and what they remember in a state."""
    assert prepared.yielding is not None
    assert state.plastic is not None
    return prepared.yielding, state.plastic


def fullest(prepared: Prepared, state: State) -> float:
    """The largest relative stress of any point over its yield stress."""
    bodies, plastic = _points(prepared, state)
    return float(fullness(bodies, state.displacement, plastic, bodies.swelling(state.point.factors)).max())


class _Bracket(NamedTuple):
    """Where on an elastic path the first point yields, as fractions of a part.

    Attributes
    ----------
    low, high : of states before and behind, with what the fullest point has beyond its yield stress, of that
    factor : where it does if stresses are straight between them
    """

    low: tuple[float, float]
    high: tuple[float, float]
    factor: float


def _first_yield(part: StepPart, followed: FollowedPart) -> _Bracket | None:
    """Where the first point yields on an elastic path; None where none does."""
    prepared = part.prepared
    states = [(0.0, followed.before)]
    for shot in followed.snapshots:
        if shot.whole:
            states.append((part.interval.within(shot.fraction), shot.state))
    for (begin, one), (end, two) in pairwise(states):
        excess = fullest(prepared, two) - 1.0
        if excess > _YIELD_TOL:
            low = begin, min(fullest(prepared, one) - 1.0, 0.0)
            return _Bracket(low, (end, excess), begin + (end - begin) * _root(prepared, one, two))
    return None


def _root(prepared: Prepared, one: State, two: State) -> float:
    """How far from one state to another the first point yields, 0 .. 1."""
    first, last = _relative(prepared, one), _relative(prepared, two)
    bodies, plastic = _points(prepared, one)
    limit = np.sqrt(2.0 / 3.0) * yield_stress(bodies, plastic.equivalent)
    step = last - first
    a, c = size(step) ** 2, size(first) ** 2 - limit**2
    b = inner(first, step)
    yields = size(last) > limit * (1.0 + _YIELD_TOL)
    a, b, c = a[yields], b[yields], np.minimum(c[yields], 0.0)
    inside = np.sqrt(np.maximum(b * b - a * c, 0.0))
    tiny = np.finfo(np.float64).tiny
    # of the two forms of the positive root the one that adds numbers of one sign
    root = np.where(b > 0.0, -c / np.maximum(b + inside, tiny), (inside - b) / np.maximum(a, tiny))
    return float(np.clip(root.min(), 0.0, 1.0))


def _relative(prepared: Prepared, state: State) -> Array:
    """(p, n) Deviators of the stresses less the back stresses."""
    bodies, plastic = _points(prepared, state)
    stress = deviator(bodies, state.displacement, plastic.strain, bodies.swelling(state.point.factors))
    return stress - plastic.back.sum(axis=1)


def _place(prepared: Prepared, state: State) -> str:
    """Where the fullest point is, in words."""
    bodies, plastic = _points(prepared, state)
    full = fullness(bodies, state.displacement, plastic, bodies.swelling(state.point.factors))
    i = int(np.argmax(full))
    at = ", ".join(f"{x:.4g}" for x in bodies.places()[i])
    return f"in '{prepared.model.bodies[int(bodies.body[i])].name}' at ({at})"


def _in_increments(part: StepPart, step: Step) -> FollowedPart:
    """A part in which points yield: in the increments asked for, or more and more of them."""
    length = part.interval.high - part.interval.low
    if isinstance(step.increments, int):
        return _increments(part, max(1, ceil(step.increments * length - 1e-9)))
    tolerance = TOLERANCE if step.tolerance is None else step.tolerance
    number, coarse = 1, None
    while True:
        try:
            fine = _increments(part, number)
        except SolveFailed as failure:
            if failure.hopeless or 4 * number > _MAX_INCREMENTS:
                raise
            number, coarse = 4 * number, None
            continue
        if coarse is not None:
            change, words = _change(part.prepared, coarse, fine)
            note = f"{number} increments of plastic flow: half as many change {words}"
            if change <= tolerance:
                return replace(fine, notes=(*fine.notes, note))
            if 2 * number > _MAX_INCREMENTS:
                return replace(fine, notes=(*fine.notes, f"{note}, more than {tolerance:g}"))
        number, coarse = 2 * number, fine


def _increments(part: StepPart, number: int) -> FollowedPart:
    """A part in equal increments; where bodies flow without end the load at most is named.

    Raises
    ------
    SolveFailed
        If an increment has no certified solution.
    """
    try:
        return follow_increments(part, number)
    except SolveFailed as failure:
        if not failure.mechanisms:
            raise
        if part.prepared.limited:  # pairs that were left out may hold the bodies
            failure.hopeless = True
            raise
        behind = reached(failure)
        done = 0 if behind is None else len(behind.snapshots)
        start, end = (part.before.point.towards(part.end, k / number) for k in (done, done + 1))
        found = collapse(part.prepared, start, end, failure.mechanisms)
        if found is None:
            raise
        raise _collapsed(part, found, (done + found.part) / number, number) from failure


def _collapsed(part: StepPart, found: Collapse, fraction: float, number: int) -> SolveFailed:
    """The failure that names the load, with what can be followed below it."""
    limit = part.interval.fraction(fraction)
    proof = (
        "friction that slips is not associated: evidence, no proof"
        if found.rubs
        else "loads do more work on the mechanism than plastic flow can take: proved for this mesh"
    )
    beyond = "" if found.rubs else ": beyond there is no equilibrium"
    words = told(
        f"{part.where}: bodies flow plastically at {limit:.4%} of the step at most{beyond}",
        remedy="less load, a harder material, or a prescribed motion in place of the load",
        evidence=proof,
    )
    status = Outcome.NOT_FOUND if found.rubs else Outcome.NO_EQUILIBRIUM
    failure = SolveFailed(words, status=status, motion=found.motion)
    failure.hopeless = True
    if fraction > _AT_ONCE:
        try:
            count = max(_INCREMENTS_BELOW, ceil(number * fraction))
            behind = follow_increments(part.cut(_BELOW_COLLAPSE * fraction, "event"), count)
        except SolveFailed as stop:
            return keep(failure, [found for found in [reached(stop)] if found is not None])  # type: ignore[return-value]
        return keep(failure, [behind])  # type: ignore[return-value]
    return failure


def _change(prepared: Prepared, coarse: FollowedPart, fine: FollowedPart) -> tuple[float, str]:
    """By how much two ways between the same loads differ, tractions in the norm of areas, and in words."""
    interface, one, two = prepared.interface, coarse.after, fine.after
    area = np.sqrt(np.tile(interface.area, interface.directions))
    tractions = _ratio((two.forces - one.forces) / area, two.forces / area) if len(area) else 0.0
    spent = [_points(prepared, state)[1].dissipation for state in (fine.before, one, two)]
    taken = abs(spent[2] - spent[1]) / (max(abs(spent[2] - spent[0]), _LITTLE_WORK * spent[2]) or 1.0)
    return max(tractions, taken), f"tractions by {tractions:.1e} of their size and plastic work by {taken:.1e} of it"


def _ratio(change: Array, whole: Array) -> float:
    """Norm of a change over that of the whole."""
    largest = float(np.linalg.norm(whole))
    return float(np.linalg.norm(change)) / largest if largest else 0.0
