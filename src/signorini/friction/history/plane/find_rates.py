# SPDX-License-Identifier: BSD-3-Clause
"""The rates without those before: Newton on the states, Lemke on the pairs that may change, every combination."""

from __future__ import annotations

import itertools

import numpy as np

from signorini import lcp
from signorini.arrays import Array, IntArray
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

KINKS = 4
"""Most pairs at kinks of their bound whose branches are chosen in all ways before Lemke's method."""


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
    for guess in guesses:
        found = _newton(responses, law, load, guess)
        if found is not None:
            return found
    kinks, endings = np.flatnonzero(law.kink), [""]
    for ways in itertools.product((False, True), repeat=len(kinks)) if len(kinks) <= KINKS else ():
        upper = np.zeros(len(state), dtype=np.bool_)
        upper[kinks] = ways
        found, ending = _lemke(responses, law, law.onto(upper), load, np.where(upper, law.kind + 2, state))
        if found is not None:
            return found
        endings.append(ending)
    ending = max(endings, key=lambda words: (words.endswith(RAY), len(words)))
    return _enumerate(responses, law, load, state, ending)


def _newton(responses: Responses, law: RateLaw, load: Array, guess: IntArray, limit: int = 200) -> Rates | None:
    state, seen = guess, set()
    for _ in range(limit):
        seen.add(state.tobytes())
        try:
            rates = responses.rates(state, load)
        except SingularState:
            return None
        state = law.proposal(rates)
        if np.array_equal(state, rates.state):
            return rates
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
    columns = [(k, *moving) for k in undecided for moving in _moves(law, k)]
    if not columns:
        return None, "no pair can change its state"
    M, q = np.zeros((len(columns), len(columns))), np.zeros(len(columns))

    def forces(r: Array) -> Array:
        return np.array([r[k] if not s else mu[k] * r[k] + s * r[n + k] for k, _, s in columns])

    try:
        q[:] = forces(responses.rates(base, load).r)
        for j, (_, dof, sign) in enumerate(columns):
            motion = np.zeros(2 * n)
            motion[dof] = sign or 1.0
            M[:, j] = forces(responses.respond(base, responses.imposed(motion, np.zeros(2 * n)))[1])
    except SingularState:
        return None, "the state in which all of them hold is singular"
    answer = lcp.solve(M, q / (np.abs(q).max() or 1.0), method="lemke")
    if answer.z is None or answer.w is None:
        return None, f"Lemke's method: {answer.status.name.lower().replace('_', ' ')}"
    for (k, dof, sign), z, w in zip(columns, answer.z, answer.w, strict=True):
        if z > w and base[k] != OPEN:
            slips = law.kind[k] if law.kind[k] > CORNER else SLIP_MINUS if sign > 0 else SLIP_PLUS
            base[k] = OPEN if dof < n else slips if law.forced[k] == UNDECIDED else law.forced[k]
    try:
        found = responses.rates(base, load)
    except SingularState:
        found = None
    lawful = found is not None and whole.violation(found) <= 10.0 * RATE
    return found if lawful else None, "Lemke's method: its answer does not obey the law"


def _moves(law: RateLaw, k: int) -> list[tuple[int, float]]:
    """The motions that a pair may make: the row of h, and the sign of a tangential one (0 for the gap).

    A pair of infinite friction is free to slip where it opens.
    """
    n = len(law.kind)
    if law.kind[k] != CORNER:
        return [(n + k, -SIGN[law.kind[k]])]
    gap = [(k, 0.0)]
    return gap if law.forced[k] > STICK else [(n + k, 1.0), (n + k, -1.0), *gap]


def _enumerate(responses: Responses, law: RateLaw, load: Array, state: IntArray, ending: str) -> Rates | NoRates:
    undecided = np.flatnonzero(law.undecided).tolist()
    choices = [_choices(law, k) for k in undecided]
    count = int(np.prod([float(len(choice)) for choice in choices]).clip(max=1e9))
    if count > COMBINATIONS:
        return evidence(ending, f"{count} combinations of states")
    margin = np.inf
    for combination in itertools.product(*choices):
        tried = state.copy()
        tried[undecided] = combination
        lacking = _lacking(responses, law, load, tried, margin)
        if isinstance(lacking, Rates):
            return lacking
        margin = min(margin, lacking)
    return refused(f"{ending}; none of the {count} combinations of states has rates that obey the law", margin)


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
    return _by_program(responses, law, load, state) if least > MARGIN else 0.0


def _by_program(responses: Responses, law: RateLaw, load: Array, state: IntArray) -> float:
    """The least t for which rates of a state are within t of equilibrium and of the law, relative to the load."""
    problem, n = responses.problem, len(state)
    closed, sticks, slips = state != OPEN, state == STICK, state > STICK
    free, presses = np.concatenate([~closed, ~sticks]), np.flatnonzero(closed)
    unit = float(np.abs(load).max(initial=0.0)) or 1.0
    forces = np.zeros((2 * n, 2 * n))  # of the normal ones, and of the tangential ones that are free
    forces[presses, presses] = 1.0
    forces[n + presses, presses] = np.where(slips, problem.pieces.slope(state), 0.0)[presses]
    forces[n + np.flatnonzero(sticks), n + np.flatnonzero(sticks)] = 1.0
    motions = np.diag(free.astype(np.float64))
    at_rest, nothing = law.conditions(state, np.zeros(2 * n), np.zeros(2 * n)), np.zeros(2 * n)
    asked = np.isfinite(at_rest)
    columns = [law.conditions(state, motion, nothing)[asked] for motion in motions.T]
    columns += [law.conditions(state, nothing, force)[asked] for force in forces.T]
    needs = -np.array(columns).T
    balance = np.hstack([motions - problem.W @ motions, -problem.W @ forces])
    rows = np.concatenate([balance, -balance, needs])
    right = np.concatenate([load, -load, np.zeros(len(needs))]) / unit
    most = np.full(4 * n, RUNAWAY_RATE)
    lacking = least_lacking(rows, right, -most, most)[0]
    return 0.0 if np.isnan(lacking) else lacking


def _choices(law: RateLaw, k: int) -> tuple[int, ...]:
    if law.kind[k] != CORNER:
        slips = (int(law.kind[k]), int(law.kind[k]) + 2) if law.kink[k] else (int(law.kind[k]),)
        return (STICK, *slips) if law.forced[k] == UNDECIDED else slips
    return (OPEN, STICK, SLIP_PLUS, SLIP_MINUS) if law.forced[k] == UNDECIDED else (OPEN, int(law.forced[k]))
