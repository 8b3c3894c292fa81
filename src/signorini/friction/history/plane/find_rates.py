# SPDX-License-Identifier: BSD-3-Clause
"""The rates without those before: Newton on the states, Lemke on the pairs that may change, every combination."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from signorini import lcp
from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.history.plane.edge_strides import EdgeStrides
from signorini.friction.history.plane.joined_pairs import WIDTH, joined, may_be_joined
from signorini.friction.history.plane.rate_law import CORNER, RATE, RateLaw
from signorini.friction.history.plane.responses import Responses
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.friction.history.rates import (
    MARGIN,
    RAY,
    RUNAWAY_RATE,
    NoRates,
    Rates,
    evidence,
    least_lacking,
    refused,
)
from signorini.law.bound import SIGN
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

COMBINATIONS = 4096
"""Most combinations of states that are tried one by one."""

_BOUNDED = 16  # combinations that one linear program is asked to rule out at once; fewer are solved as fast

KINKS = 4
"""Most pairs at kinks of their bound whose branches are chosen in all ways before Lemke's method."""

_SETTLES = 3  # steps of Newton's method after which edges may creep; most settle before

_JOINED_FROM = 200  # pairs from which states are sought on runs of pairs first: fewer settle in as many steps

NEWTON_STEPS = 200
"""Of one run from a guess of the states; where it does not settle Lemke's method follows."""


def find_rates(
    responses: Responses, law: RateLaw, load: Array, state: IntArray, guesses: list[IntArray]
) -> Rates | NoRates:
    """Rates under a load rate that obey the law.

    Parameters
    ----------
    responses : of the interface
    law : of the rates at this load
    load : (2n,) rate of b
    state : (n,) states so far, which pairs that cannot change keep
    guesses : states to start Newton's method from, in order
    """
    for guess in [*_far_seen(responses, law, load), *guesses]:
        found = _newton(responses, law, load, guess)
        if found is not None:
            return found
    kinks, endings = np.flatnonzero(law.kink), [""]
    if len(kinks) > KINKS:
        endings = [f"Lemke's method is asked of {KINKS} pairs at kinks at most, these are {len(kinks)}"]
    for ways in itertools.product((False, True), repeat=len(kinks)) if len(kinks) <= KINKS else ():
        upper = np.zeros(len(state), dtype=np.bool_)
        upper[kinks] = ways
        found, ending = _lemke(responses, law, law.onto(upper), load, np.where(upper, law.kind + 2, state))
        if found is not None:
            return found
        endings.append(ending)
    ending = max(endings, key=lambda words: (words.endswith(RAY), len(words)))
    return _enumerate(responses, law, load, state, ending)


def _far_seen(responses: Responses, law: RateLaw, load: Array) -> Iterator[IntArray]:
    """States of many pairs that may all change at once: those of runs of them, found in the same way.

    So edges of long zones are a few pairs from where they will be, and no step of Newton's method has to move them far.
    """
    n, problem = len(law.kind), responses.problem
    if n < _JOINED_FROM or (law.kind != CORNER).any() or (law.forced != UNDECIDED).any() or not may_be_joined(problem):
        return
    first = np.arange(0, n, WIDTH)
    few = joined(replace(problem, b=load), first)
    if few is None:
        return
    bound, open_ = few.pieces, np.zeros(len(first), dtype=np.bool_)
    own = RateLaw(bound=bound, forced=law.forced[first], kind=law.kind[first], kink=open_)
    small = Responses(few)
    for guess in (*_far_seen(small, own, few.b), np.full(len(first), STICK)):
        found = _newton(small, own, few.b, guess)
        if found is not None:
            yield np.repeat(found.state, np.diff(first, append=n))
            return


def _newton(responses: Responses, law: RateLaw, load: Array, guess: IntArray) -> Rates | None:
    state, seen = guess, set[bytes]()
    strides: EdgeStrides | None = None
    for step in range(NEWTON_STEPS):
        seen.add(state.tobytes())
        try:
            rates = responses.rates(state, load)
        except SingularState:
            return None
        state = law.proposal(rates)
        if np.array_equal(state, rates.state):
            return rates
        if step >= _SETTLES:
            strides = strides or EdgeStrides()
            lacking = -law.conditions(rates.state, rates.h, rates.r).min(axis=0)
            ahead = strides.ahead(rates.state, state, lacking)
            state = state if ahead.tobytes() in seen else ahead
        if state.tobytes() in seen:
            return None
    return None


def _lemke(
    responses: Responses, whole: RateLaw, law: RateLaw, load: Array, state: IntArray
) -> tuple[Rates | None, str]:
    """Rates that obey the whole law, sought in one without kinks.

    A complementarity problem in the motions that the pairs may make, from the state in which they all hold.

    At a corner z = (slip rate +, slip rate -, gap rate) meets w = (mu p' + r_t', mu p' - r_t', p'); on an edge the slip
    rate against the friction meets the friction to spare.
    """
    n, mu = len(law.kind), law.mu
    undecided = np.flatnonzero(law.undecided).tolist()
    base = state.copy()
    base[undecided] = np.where(law.forced[undecided] == UNDECIDED, STICK, law.forced[undecided])
    held = base.copy()
    columns = [(k, *moving) for k in undecided for moving in _moves(law, k)]
    if not columns:
        return None, "no pair can change its state"
    M, q = np.zeros((len(columns), len(columns))), np.zeros(len(columns))

    def forces(r: Array) -> Array:
        return np.array([r[0, k] if not s else mu[k] * r[0, k] + s * r[1, k] for k, _, s in columns])

    try:
        q[:] = forces(responses.rates(base, load).r)
        for j, (k, row, sign) in enumerate(columns):
            motion = np.zeros((2, n))
            motion[row, k] = sign or 1.0
            M[:, j] = forces(responses.respond(base, responses.imposed(motion, np.zeros((2, n))))[1])
    except SingularState:
        return None, "the state in which all of them hold is singular"
    answer = lcp.solve(M, q / (np.abs(q).max() or 1.0), method="lemke")
    if answer.z is None or answer.w is None:
        return None, f"Lemke's method: {answer.status.name.lower().replace('_', ' ')}"
    for (k, row, sign), z, w in zip(columns, answer.z, answer.w, strict=True):
        if z > w and base[k] != OPEN:
            slips = law.kind[k] if law.kind[k] > CORNER else SLIP_MINUS if sign > 0 else SLIP_PLUS
            base[k] = OPEN if not row else slips if law.forced[k] == UNDECIDED else law.forced[k]
    try:
        found = responses.rates(base, load)
    except SingularState:
        found = None
    if found is None or whole.violation(found) > 10.0 * RATE:
        motion = np.zeros((2, n))
        for (k, row, sign), rate in zip(columns, answer.z * (np.abs(q).max() or 1.0), strict=True):
            motion[row, k] += (sign or 1.0) * rate
        slips = (law.kind == CORNER) & (base > STICK)  # without pressure both ways may be in the answer
        found = _moving(responses, held, np.where(slips, law.touching(motion[1]), base), load, motion)
        if found.size > RUNAWAY_RATE * np.abs(load).max(initial=0.0):  # a body that the load carries away
            found = None
    lawful = found is not None and whole.violation(found) <= 10.0 * RATE
    return found if lawful else None, "Lemke's method: its answer does not obey the law"


def _moving(responses: Responses, held: IntArray, state: IntArray, load: Array, motion: Array) -> Rates:
    """Rates with given motions of the pairs, in a state that leaves a body free which nothing presses.

    Parameters
    ----------
    held, state : (n,) the state in which the pairs hold, and that in which they move
    load : (2n,) rate of b
    motion : (2, n) rates of the motions that the pairs make from the first
    """
    h, r = responses.respond(held, responses.free(load) + responses.imposed(motion, np.zeros_like(motion)))
    h, r = responses.balanced(held, load, h + motion, r)
    return Rates(state=state, h=h, r=r)


def _moves(law: RateLaw, k: int) -> list[tuple[int, float]]:
    """The motions that a pair may make: the row of h, and the sign of a tangential one (0 for the gap).

    A pair of infinite friction is free to slip where it opens.
    """
    if law.kind[k] != CORNER:
        return [(1, -SIGN[law.kind[k]])]
    gap = [(0, 0.0)]
    return gap if law.forced[k] > STICK else [(1, 1.0), (1, -1.0), *gap]


def _enumerate(responses: Responses, law: RateLaw, load: Array, state: IntArray, ending: str) -> Rates | NoRates:
    """Every combination of states, but for those that a linear program of what they have in common rules out."""
    undecided = law.undecided
    choices = [_choices(law, k) if undecided[k] else (int(code),) for k, code in enumerate(state)]
    count = _number(choices)
    if count > COMBINATIONS:
        return evidence(ending, f"{count} combinations of states")
    margin, programs, nodes = np.inf, 0, [choices]
    while nodes:
        node = nodes.pop()
        several = next((k for k, states in enumerate(node) if len(states) > 1), None)
        if several is None:
            lacking = _lacking(responses, law, load, np.array([code for code, *_ in node], dtype=np.int64), margin)
            if isinstance(lacking, Rates):
                return lacking
            margin = min(margin, lacking)
            continue
        if _number(node) >= _BOUNDED:
            programs += 1
            lacking = _by_program(responses, law, load, node)
            if lacking > MARGIN:
                margin = min(margin, lacking)
                continue
        nodes += [[*node[:several], (code,), *node[several + 1 :]] for code in reversed(node[several])]
    by = f", by {programs} linear program{'s' if programs > 1 else ''} of many at once" if programs else ""
    return refused(f"{ending}; none of the {count} combinations of states has rates that obey the law{by}", margin)


def _number(choices: Sequence[tuple[int, ...]]) -> int:
    """Of combinations."""
    return int(np.prod([float(len(states)) for states in choices]).clip(max=1e9))


def _lacking(responses: Responses, law: RateLaw, load: Array, state: IntArray, least: float) -> Rates | float:
    """Rates of a state that obey the law, or what they lack of it, relative to them.

    Rates that are not unique, or so large that rounding has a part in them, are asked for by a linear program: the
    least that is lacking, of the load, up to `RUNAWAY_RATE` times the load. Not where nothing is left to prove.
    """
    try:
        rates = responses.rates(state, load)
    except SingularState:
        rates = None
    if rates is not None:
        lacking = law.violation(rates)
        if lacking <= 10.0 * RATE:
            return rates
        if rates.size <= RUNAWAY_RATE * np.abs(load).max(initial=0.0):
            return lacking
    return _by_program(responses, law, load, [(int(code),) for code in state]) if least > MARGIN else 0.0


def _by_program(responses: Responses, law: RateLaw, load: Array, choices: Sequence[tuple[int, ...]]) -> float:
    """The least t for which rates are within t of equilibrium and of the law, relative to the load.

    Of pairs that may be in several states only what all of these ask: no overlap, no tension, friction in its bound.
    """
    problem, n = responses.problem, len(choices)
    one = np.array([len(states) == 1 for states in choices])
    first, last = (np.array([f(states) for states in choices], dtype=np.int64) for f in (min, max))
    presses, slides = np.flatnonzero(last != OPEN), np.flatnonzero(one & (last > STICK))
    holds = np.setdiff1d(presses, slides)
    unit, nothing = float(np.abs(load).max(initial=0.0)) or 1.0, np.zeros((2, n))
    forces = np.zeros((2 * n, 2 * n))  # of the normal ones, and of the tangential ones that are free
    forces[presses, presses] = forces[n + holds, n + holds] = 1.0
    forces[n + slides, slides] = problem.pieces.slope(last)[slides]
    motions = np.diag(np.concatenate([first == OPEN, (first == OPEN) | (last > STICK)]).astype(np.float64))

    def needs(state: IntArray, which: BoolArray) -> Array:
        asked = np.isfinite(law.conditions(state, nothing, nothing)) & which
        columns = [law.conditions(state, motion, nothing)[asked] for motion in motions.T.reshape(-1, 2, n)]
        columns += [law.conditions(state, nothing, force)[asked] for force in forces.T.reshape(-1, 2, n)]
        return -np.array(columns).T

    balance = np.hstack([motions - problem.W @ motions, -problem.W @ forces])
    closed, open_ = (
        needs(np.where(one, last, STICK), np.ones(n, dtype=np.bool_)),
        needs(np.full(n, OPEN), ~one & (first == OPEN)),
    )
    rows = np.concatenate([balance, -balance, closed, open_])
    right = np.concatenate([load, -load, np.zeros(len(closed) + len(open_))]) / unit
    rows = rows[:, rows.any(axis=0)]
    most = np.full(rows.shape[1], RUNAWAY_RATE)
    lacking = least_lacking(rows, right, -most, most)[0]
    return 0.0 if np.isnan(lacking) else lacking


def _choices(law: RateLaw, k: int) -> tuple[int, ...]:
    if law.kind[k] != CORNER:
        slips = (int(law.kind[k]), int(law.kind[k]) + 2) if law.kink[k] else (int(law.kind[k]),)
        return (STICK, *slips) if law.forced[k] == UNDECIDED else slips
    return (OPEN, STICK, SLIP_PLUS, SLIP_MINUS) if law.forced[k] == UNDECIDED else (OPEN, int(law.forced[k]))
