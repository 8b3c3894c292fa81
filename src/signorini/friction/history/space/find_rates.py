# SPDX-License-Identifier: BSD-3-Clause
"""The rates of motions and forces behind a state in space, or the proof that there are none."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import islice, product
from typing import Literal

import numpy as np

from signorini import lcp
from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import Spent
from signorini.friction.history.rates import RATE_TOL, NoRates, Rates, evidence, refused
from signorini.friction.history.space.no_rates_proof import Exhausted, search_regions
from signorini.friction.history.space.rate_problem import CONE, FACET, GAP, KINK, RateProblem
from signorini.friction.history.space.smooth_cones import ConeProblem
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, SLIP, STICK

ENUMERATED = 16
"""Most complementary numbers of which every combination is tried."""

DEPARTURES = 64
"""Most combinations of next states of the acting pairs."""

Departure = tuple[tuple[int, bool], ...] | Literal["opens", "closes", "stays"]
"""How a pair leaves its state: some of its complementary numbers move, or do not; or it opens, closes, or stays."""

_OPENS: Literal["opens"] = "opens"
_CLOSES: Literal["closes"] = "closes"
_STAYS: Literal["stays"] = "stays"


def find_rates(problem: ContactProblem, now: PathState, width: float) -> Rates | NoRates:
    """Rates behind a state that obey the law, or why there are none.

    Lemke's method, then every combination of what pairs may do (see `RateProblem`), up to 2^16 of them; linear programs
    decide singular ones. With more of them a ray of Lemke's method is strong evidence, no proof, and the words say so.
    Where pairs touch a smooth section without pressure, Newton's method, sectors of directions (`no_rates_proof`).

    Parameters
    ----------
    problem : its b is the rate of the load
    now : the state
    width : of zero for a gap, a force or the friction to spare

    References
    ----------
    Klarbring (1986), A mathematical programming approach to three-dimensional contact problems with friction.

    Examples
    --------
    One pair that sticks with its friction used up: it slips if the pull grows, and sticks on if it falls.

    >>> from dataclasses import replace
    >>> from signorini.friction.history import follow, initial_state
    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.zeros(3), friction=[0.5], motions=np.zeros((3, 0)), scale=1.0, facets=8
    ... )
    >>> now = follow(problem, initial_state(problem, np.zeros(3)), np.array([-0.5, 0.25, 0.0])).end
    >>> loads = (np.array([0.0, 1.0, 0.0]), np.array([0.0, -1.0, 0.0]))
    >>> rates = [find_rates(replace(problem, b=load), now, 1e-10) for load in loads]
    >>> [(each.state.tolist(), (each.h.round(12) + 0.0).tolist()) for each in rates]
    [([2], [[0.0], [2.0], [0.0]]), ([1], [[0.0], [0.0], [0.0]])]
    """
    choice = RateProblem.at(problem, now, width)
    return NoRates(proof=choice, proved=False) if isinstance(choice, str) else _solved(choice)


def departures(problem: ContactProblem, now: PathState, width: float) -> Iterator[Rates | Spent]:
    """Rates in which acting pairs leave their state, all of them first, then only some; others slip on, or may stick.

    Where no pair acts, in the middle of a curve, those in which every pair stays in its state. For problem, now and
    width see `find_rates`. Where there are more combinations than are tried, that is said last.
    """
    whole = RateProblem.at(problem, now, width)
    if isinstance(whole, str):
        return
    slide = np.isin(np.arange(problem.pairs), whole.acting, invert=True) & (now.state == SLIP)
    ways = [_ways(whole, k, int(now.state[k])) for k in whole.acting]
    for taken in islice(product(*ways), DEPARTURES):
        opened = np.zeros(problem.pairs, dtype=np.bool_)
        opened[[k for k, way in zip(whole.acting, taken, strict=True) if way == _OPENS]] = True
        choice = RateProblem.at(problem, now, width, opened=opened) if opened.any() else whole
        if isinstance(choice, str):
            continue
        moves = {
            int(choice.numbers(k)[place]): moving
            for k, way in zip(whole.acting, taken, strict=True)
            for place, moving in (way if isinstance(way, tuple) else ())
        }
        closed = np.zeros(problem.pairs, dtype=np.bool_)
        closed[[k for k, way in zip(whole.acting, taken, strict=True) if way == _CLOSES]] = True
        slip_on = dict.fromkeys(np.flatnonzero(slide[choice.pair]).tolist(), True)
        leaves = any(way != _STAYS for way in taken)
        for chosen in ([moves | slip_on] if slip_on else []) + ([moves] if leaves else []):
            found = _solved(choice, chosen, closed)
            if isinstance(found, Rates):
                yield found
    if (count := math.prod(map(len, ways))) > DEPARTURES:
        yield Spent(most=DEPARTURES, of=f"of {count} combinations of next states of acting pairs")


def acting_pairs(problem: ContactProblem, now: PathState, width: float) -> IntArray:
    """Pairs of a problem that may not go on as they are now, to a width, see `RateProblem`; none where not known."""
    choice = RateProblem.at(problem, now, width)
    return np.array([] if isinstance(choice, str) else choice.acting, dtype=np.int64)


def _ways(choice: RateProblem, k: int, state: int) -> list[Departure]:
    """How an acting pair may leave its state; the last: not at all."""
    numbers = choice.numbers(k)
    kind = choice.kind[numbers]
    facets, kinks = np.flatnonzero(kind == FACET).tolist(), np.flatnonzero(kind == KINK).tolist()
    if choice.standing.smooth[k]:
        return [_CLOSES if state == OPEN else _OPENS, _STAYS]
    if choice.standing.corner[k]:
        meets = ((int(np.flatnonzero(kind == GAP)[0]), False),)
        return [meets if state == OPEN else _OPENS, _STAYS]
    turns = [((place, moving),) for place in kinks for moving in (True, False)] if state == SLIP and kinks else [()]
    sliding = [facets, *([facet] for facet in facets if len(facets) > 1)]  # all that it touches, two at most, or one
    slips = [tuple((facet, facet in some) for facet in facets) for some in sliding]
    return [*((*turn, *slip) for turn in turns for slip in slips), _STAYS]


def _solved(
    choice: RateProblem, moves: Mapping[int, bool] | None = None, closed: BoolArray | None = None
) -> Rates | NoRates:
    """Rates of a choice in which some numbers move and some do not, whatever they would do; ``closed`` pairs stay."""
    moves, M, q = moves or {}, choice.M, choice.q
    free = np.setdiff1d(np.arange(len(q)), list(moves))
    given = np.array([number for number, moving in moves.items() if moving], dtype=np.int64)
    z = np.zeros(len(q))
    try:
        answer = np.linalg.solve(M[np.ix_(given, given)], np.column_stack([M[np.ix_(given, free)], q[given]]))
    except np.linalg.LinAlgError:
        return NoRates(proof="the state asked for is singular", proved=False)
    reduced = M[np.ix_(free, free)] - M[np.ix_(free, given)] @ answer[:, :-1]
    rest = q[free] - M[np.ix_(free, given)] @ answer[:, -1]
    if choice.friction.size:
        cones = choice.pair[choice.kind == CONE][: choice.friction.shape[1]]
        stay = np.zeros(len(cones), dtype=np.bool_) if closed is None else closed[cones]
        found = _with_cones(ConeProblem(M=reduced, q=rest, friction=choice.friction, closed=stay), choice.size)
    else:
        found = _complementary(reduced, rest, choice.size)
    if isinstance(found, NoRates):
        return found
    z[free], z[given] = found, -(answer[:, :-1] @ found + answer[:, -1])
    one = choice.kind != CONE
    w = M @ z + q
    rounding = RATE_TOL * np.maximum(np.abs(M) @ np.abs(z) + np.abs(q), np.abs(q).max(initial=0.0))
    h, r = choice.rates(z)
    size = max(np.abs(h).max(initial=0.0), np.abs(r).max(initial=0.0))
    off = np.abs(choice.held.problem.misfit(h, r)).max(initial=0.0)
    none = RATE_TOL * np.abs(z).max(initial=0.0)
    if (w < -rounding)[one].any() or z[one].min(initial=0.0) < -none or off > RATE_TOL * size:
        return NoRates(proof="the rates found do not obey the law", proved=False)
    return Rates(state=_states(choice, h, r, RATE_TOL * size), h=h, r=r)


def _with_cones(problem: ConeProblem, size: float) -> Array | NoRates:
    """Numbers, and motions of pairs in Coulomb's law, or why there are none; ``size`` of the terms of q."""
    found = problem.found()
    answer = search_regions(problem) if found is None else found
    if not isinstance(answer, Exhausted):
        return answer
    if answer.undecided:
        words = f"{answer.programmes} linear programmes of states and directions of slip, as many as are tried"
        return NoRates(proof=f"{words}, did not tell", proved=False)
    words = f"{answer.programmes} linear programmes show that no states and directions of slip have rates"
    return refused(f"{words} that obey the law", _margin(answer, problem.unit, size))


def _complementary(M: Array, q: Array, size: float) -> Array | NoRates:
    """z of ``0 <= z  _|_  M z + q >= 0``, or why there is none; ``size`` of the terms of q.

    That no combination of states is a solution is enumeration's word; how sure that is linear programmes tell.
    """
    if not len(q) or (q >= 0).all():
        return np.zeros(len(q))
    unit = float(np.abs(q).max())
    found = lcp.solve(M, q / unit, method="lemke")
    ending = f"Lemke's method: {found.status.name.lower().replace('_', ' ')}"
    if found.z is None:
        found = lcp.solve(M, q / unit, method="enumeration" if len(q) <= ENUMERATED else "auto")
    if found.z is not None:
        return np.asarray(found.z * unit)
    combinations = f"2^{len(q)} combinations of states"
    if found.status is not lcp.Status.NO_SOLUTION:
        return evidence(ending, combinations)
    answer = search_regions(ConeProblem(M=M, q=q, friction=np.zeros((2, 0)), closed=np.zeros(0, dtype=np.bool_)))
    if not isinstance(answer, Exhausted):
        return answer
    if answer.undecided:
        return evidence(ending, combinations)
    words = f"{ending}; none of the {combinations} has rates that obey the law"
    return refused(words, _margin(answer, unit, size))


def _margin(answer: Exhausted, unit: float, size: float) -> float:
    """What is lacking of the terms that the right-hand side is the sum of."""
    return answer.margin * min(1.0, unit / (size or unit))


def _states(choice: RateProblem, h: Array, r: Array, none: float) -> IntArray:
    """(n,) States in which pairs have these rates."""
    standing = choice.standing
    moves = (np.abs(h[1:]) > none).any(axis=0) | ~standing.rubs
    closed = standing.closed & ~(standing.corner & (r[0] <= none))
    return np.where(closed, np.where(moves, SLIP, STICK), OPEN).astype(np.int64)
