# SPDX-License-Identifier: BSD-3-Clause
"""Straight pieces of a history in space: whether the law holds all the way from one state to another, and how far on.

Motions and forces between two states are taken to be linear. The law of contact holds all along such a piece where it
holds at its end, a slip increment s included, and at its beginning

    gap = 0    of pairs that press at the end
    p = 0      of pairs that are open at the end
    r_t . s = -p max (e . s : e in the section)    of pairs that slip: the old force was already the one that slip needs

because sections are convex and every condition is linear (a kink of a bound on friction must not be passed). What does
not hold is an event on the way.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.history.rates import RATE_TOL
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.bound import ADHESION_SLOPE
from signorini.law.result import ContactAnswer
from signorini.law.states import OPEN, STICK

END_ROUNDING = 1e-9  # part of an increment: what comes so late does not happen in it
_CHORD = 1e-3  # of the force that a pair lacks to slip: it slips by more where it does so all the way along an arc
_VALUE_ROUNDING = 1e-12  # of the values that a rate is the difference of


@dataclass(frozen=True, kw_only=True)
class SolvedIncrement:
    """An increment that was solved.

    Attributes
    ----------
    step : part of the segment
    after : the state at its end
    result : of the solver
    until : part of it up to which the law holds on a straight way
    each : (n,) that part of every pair
    turn : largest angle by which friction turns
    search, told : increments tried before that told its length, and whether they did, see `Breakpoint`
    """

    step: float
    after: PathState
    result: ContactAnswer
    until: float
    each: Array
    turn: float
    search: tuple[SolvedIncrement, ...] = ()
    told: bool = True


def held_until(problem: ContactProblem, start: PathState, h: Array, r: Array, width: float) -> Array:
    """(n,) Estimated part of a piece up to which the law holds, 1 where it holds all the way.

    Parameters
    ----------
    problem : at the load of its end
    start : at its beginning
    h, r : (3, n) gaps and slip increments, and forces at its end
    width : of zero for a gap and a force
    """
    gap, p, (opening, *_), (pressing, *_) = start.h[0], start.r[0], h, r
    slip, until = h[1:], np.ones(problem.pairs)
    closes, opens = (pressing > width) & (gap > width), (opening > width) & (p > width)
    until[closes] = gap[closes] / (gap + pressing)[closes]
    until[opens] = p[opens] / (p + opening)[opens]
    size = np.linalg.norm(slip, axis=0)
    slips = (pressing > 0) & (size > width) & ~closes
    lacking = _lacking(problem, start, slip)
    # on a smooth section the force turns with the slip; how far is another question, see `friction_turns`
    starts = slips & ~_turns(problem, start, size, lacking, width) & (lacking > width)
    until[starts] = lacking[starts] / (lacking + size)[starts]
    for kink in problem.pieces.kinks[1:-1]:
        low, high = np.minimum(p, pressing), np.maximum(p, pressing)
        passes = slips & (low < kink - width) & (kink + width < high)
        until[passes] = np.minimum(until, (kink - p) / np.where(passes, pressing - p, 1.0))[passes]
    return until


def friction_turns(problem: ContactProblem, start: PathState, r: Array, slip: Array, width: float) -> Array:
    """(n,) Angles by which friction turns on smooth sections, of pairs that slip on their limit all the way; 0 else.

    Parameters
    ----------
    problem, start, r, width : see `held_until`
    slip : (2, n) slip increments
    """
    one, two = start.r[1:], r[1:]
    long = np.minimum(np.linalg.norm(one, axis=0), np.linalg.norm(two, axis=0))
    size = np.linalg.norm(slip, axis=0)
    turns = _turns(problem, start, size, _lacking(problem, start, slip), width)
    which = (size > width) & (long > 1e3 * width) & turns
    cross, along = one[0] * two[1] - one[1] * two[0], (one * two).sum(axis=0)
    return np.where(which, np.arctan2(cross, along), 0.0)


def _lacking(problem: ContactProblem, start: PathState, slip: Array) -> Array:
    """(n,) The force along a slip that a pair lacks at the beginning of a piece to slip so; 0 without a slip.

    Parameters
    ----------
    problem, start, slip : see `friction_turns`
    """
    most = problem.bound.at(start.r[0]) * problem.section.farthest(slip)
    size = np.linalg.norm(slip, axis=0)
    along = ((most + start.r[1:]) * slip).sum(axis=0)
    return np.divide(along, size, out=np.zeros_like(along), where=size > 0.0)


def _turns(problem: ContactProblem, start: PathState, size: Array, lacking: Array, width: float) -> BoolArray:
    """(n,) Whether pairs that slip in a piece do so all the way, under a friction that turns with them.

    On smooth sections, from their limit on. A pair that leaves its limit, and has just come to it elsewhere, has
    slipped by next to nothing beside the force that it lacks at the beginning: it sticks up to there, on a chord. That
    an arc takes a slip is known of scaled motions and forces, as compliances of these are of the order of 1.

    Parameters
    ----------
    problem, start, width : see `friction_turns`
    size, lacking : (n,) of the slip, and see `_lacking`
    """
    spent = problem.law.reserve(start.r) <= width
    return np.asarray((problem.section.sides == 0) & spent & (_CHORD * lacking <= size))


def extrapolated_length(problem: ContactProblem, start: PathState, end: PathState, width: float) -> float:
    """At how many times its length a piece must end since a gap, a normal force or friction to spare vanishes.

    Parameters
    ----------
    problem : the problem; its b does not matter
    start, end : of the piece, in which the law holds; the states of the end are those inside it
    width : of zero for a force
    """
    h, r = end.h, end.r
    dh, dr = h - start.h, r - start.r
    size = max(np.abs(dh).max(initial=0.0), np.abs(dr).max(initial=0.0))
    least = RATE_TOL * size + _VALUE_ROUNDING * max(np.abs(h).max(initial=0.0), np.abs(r).max(initial=0.0))
    times = [np.inf]

    def vanish(which: BoolArray, value: Array, rate: Array) -> None:
        falls = which & (rate < -least)
        if falls.any():
            times.append(float((np.maximum(value[falls], 0.0) / -rate[falls]).min()))

    closed = end.state != OPEN
    p, dp = start.r[0], dr[0]
    vanish(~closed, start.h[0], dh[0])
    vanish(closed, p, dp)
    s = problem.bound.at(np.maximum(p, 0.0))
    ds = problem.bound.at(np.maximum(r[0], 0.0)) - s
    rubs = closed & (s + ds > 0)
    for kink in problem.pieces.kinks[1:-1]:
        vanish(rubs & (kink > p + width), kink - p, -dp)
        vanish(rubs & (kink < p - width), p - kink, dp)
    axes, sides = problem.section.axes, problem.section.sides
    f, df = _over(start.r[1:], axes), _over(dr[1:], axes)
    for j in range(int(sides.max(initial=0))):
        half = np.pi / np.maximum(sides, 1)
        normal = np.stack([np.cos((2 * j + 1) * half), np.sin((2 * j + 1) * half)])
        reach = np.cos(half)
        vanish(rubs & (sides > j), reach * s - (normal * f).sum(axis=0), reach * ds - (normal * df).sum(axis=0))
    sticks = rubs & (sides == 0) & (end.state == STICK)
    a = (df**2).sum(axis=0) - ds**2
    b = (f * df).sum(axis=0) - s * ds
    c = (f**2).sum(axis=0) - s**2
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    outward = sticks & (b > 0) & (b * b >= a * c)
    inward = sticks & (b <= 0) & (a > least**2)
    for which, above, below in ((outward, -c, b + root), (inward, root - b, a)):
        if which.any():
            times.append(float((above[which] / below[which]).min()))
    return min(times)


def settled(problem: ContactProblem, now: PathState, trial: SolvedIncrement, state: IntArray) -> PathState:
    """The end of a piece, where pairs may be on the verge of another state, in the states inside it.

    What slips from an event in the piece on does so under the friction at its end.

    Parameters
    ----------
    problem : the problem; its b does not matter
    now, trial : the beginning of the piece, and the increment that it is
    state : (n,) inside it
    """
    end, closed = trial.after, state != OPEN
    h, r = end.h.copy(), np.where(closed, end.r, 0.0)
    h[0, closed] = 0.0
    h[1:] = np.where(state == STICK, now.h[1:], h[1:])
    moved = np.where(closed & now.bears(r, problem.scale), h[1:] - now.h[1:], 0.0)
    late = (trial.each < 1.0 - END_ROUNDING) & (now.state != OPEN)
    lost = -(np.where(late, r[1:], 0.5 * (r[1:] + now.r[1:])) * moved).sum(axis=0)
    return replace(end, h=h, r=r, state=state, anchor=h[1:], slip=now.slip + moved, dissipation=now.dissipation + lost)


def grips(problem: ContactProblem, now: PathState, trial: SolvedIncrement, late: float) -> bool:
    """Whether a pair that holds friction without pressure closes in an increment, where it sticks, or opens.

    Parameters
    ----------
    problem : the problem; its b does not matter
    now, trial : the beginning of the increment, and the increment
    late : part of it at its end, in which that does not count
    """
    turns = (now.state == OPEN) != (trial.after.state == OPEN)
    return bool((turns & (problem.mu >= ADHESION_SLOPE) & (trial.each < 1.0 - late)).any())


def _over(force: Array, axes: Array) -> Array:
    """(2, n) Forces over the half-axes of sections of size 1; none along an axis of length 0."""
    return np.divide(force, axes, out=np.zeros_like(force), where=axes > 0)
