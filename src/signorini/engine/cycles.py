# SPDX-License-Identifier: BSD-3-Clause
"""What cycle after cycle does: energy, slip, and whether it settles (shakes down, repeats, ratchets)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.step_parts import FollowedPart
from signorini.law.states import OPEN
from signorini.solution.results import Cycle
from signorini.solution.scale import Scale
from signorini.solution.state import State

REPEAT_TOL = 1e-8
"""Forces of the largest, and slips of the size of the data, that count as equal."""

STEADY_TOL = 0.02
"""Of the plastic strain that grows in a cycle: less tells no steady cycle from one that settles slowly."""

_DECAYING_CYCLES = 4  # the first, in which flow begins, and three that a decay is seen by
_DEAD = 0.1  # of what the last cycle adds: where no more is left in the limit it is nothing


def make_cycles(followed: FollowedPart, ends: Sequence[float]) -> tuple[Cycle, ...]:
    """The cycles of a step.

    Parameters
    ----------
    followed : all of the step
    ends : load factors at which cycles end
    """
    found: list[Cycle] = []
    begin, last = followed.before, followed.before.slip
    n = len(begin.status)
    sliding = np.zeros(n)
    for snapshot in followed.snapshots:
        state = snapshot.state
        sliding, last = sliding + np.linalg.norm(state.slip - last, axis=0), state.slip
        if snapshot.load_factor != ends[len(found)]:
            continue
        found.append(
            replace(cycle_between(begin, state, sliding), number=len(found) + 1, load_factor=snapshot.load_factor)
        )
        begin, sliding = state, np.zeros(n)
    return tuple(found)


def cycle_between(begin: State, end: State, sliding: Array) -> Cycle:
    """A cycle from one state to another; its number and load factor are left open.

    Parameters
    ----------
    begin, end : the states
    sliding : (n,) distance slid in it
    """
    size = float(np.abs(end.forces).max(initial=0.0)) or 1.0
    return Cycle(
        number=0,
        load_factor=0.0,
        work=end.work - begin.work,
        dissipation=float((end.dissipated - begin.dissipated).sum()),
        released=end.released - begin.released,
        sliding=float(sliding.max(initial=0.0)),
        change=float(np.abs(end.forces - begin.forces).max(initial=0.0)) / size,
        drift=_drift(begin, end),
        **_flow(begin, end),
    )


def _drift(begin: State, end: State) -> float:
    """Largest change of the tangential displacement of pairs that touch at both ends; what opens may slide unseen."""
    touching = (begin.status != OPEN) & (end.status != OPEN)
    return float(np.linalg.norm((end.tangential - begin.tangential)[:, touching], axis=0).max(initial=0.0))


def _flow(begin: State, end: State) -> dict[str, float]:
    """Growth of the equivalent plastic strain from one state to another, and what the plastic strain changes."""
    one, two = begin.plastic, end.plastic
    if one is None or two is None or not len(two.equivalent):
        return {}
    change = two.strain - one.strain
    squares = (change[:, :3] ** 2).sum(axis=1) + 0.5 * (change[:, 3:] ** 2).sum(axis=1)
    grown = two.equivalent - one.equivalent
    return {"flow": float(grown.max()), "plastic_drift": float(np.sqrt(2.0 / 3.0 * squares.max()))}


def judge(cycles: Sequence[Cycle], scale: Scale) -> tuple[str, str]:
    """One of "shakes down", "steady", "ratchets" and "not yet", and the same in a sentence."""
    last, most = cycles[-1], max(cycle.flow for cycle in cycles)
    if last.flow > REPEAT_TOL * most:
        return _judge_flow(cycles)
    resting = [cycle.sliding <= REPEAT_TOL * scale.length and cycle.flow <= REPEAT_TOL * most for cycle in cycles]
    still = _since(cycles, resting)
    if still is not None:
        words = "no pair slips" if most == 0.0 else "nothing slips or yields"
        return "shakes down", f"shakes down: {words} from cycle {still} on"
    repeats = [cycle.change <= REPEAT_TOL for cycle in cycles]
    closed = _since(
        cycles, [same and cycle.drift <= REPEAT_TOL * scale.length for same, cycle in zip(repeats, cycles, strict=True)]
    )
    if closed is not None:
        words = f"steady from cycle {closed} on: it ends as it begins, and dissipates {last.dissipation:.6g}"
        return "steady", words
    drifts = _since(cycles, repeats)
    if drifts is not None:
        return (
            "ratchets",
            f"ratchets from cycle {drifts} on: forces repeat, the contact moves on by {last.drift:.6g} a cycle",
        )
    words = f"not steady after {last.number} cycles: the last changes forces by {last.change:.2g} of the largest"
    return "not yet", words


def _judge_flow(cycles: Sequence[Cycle]) -> tuple[str, str]:
    """The verdict, and its sentence, where points still flow plastically in the last cycle."""
    last = cycles[-1]
    ratio = last.flow / cycles[-2].flow if len(cycles) > 1 and cycles[-2].flow > 0.0 else np.inf
    if abs(ratio - 1.0) > STEADY_TOL:
        words = (
            f"not steady after {last.number} cycles: the equivalent plastic strain grows by {last.flow:.3g} in the last"
        )
        if np.isfinite(ratio):
            words += f", {ratio:.3g} times as much as in the one before"
        if ratio < 1.0:
            dies = _dies_out([cycle.flow for cycle in cycles])
            words += ": flow dies out, bodies tend to shake down" if dies else ", not decided whether flow dies out"
        return "not yet", words
    if last.plastic_drift <= STEADY_TOL * last.flow:
        words = f"plastic flow alternates: {last.flow:.3g} of equivalent strain a cycle, and ends where it began"
        return "steady", words
    before = cycles[-2].plastic_drift
    if abs(last.plastic_drift - before) > STEADY_TOL * before:
        words = (
            f"not steady after {len(cycles)} cycles: plastic strain grows by {last.plastic_drift:.3g} in the last, "
            f"{last.plastic_drift / before:.3g} times as much as in the one before"
        )
        return "not yet", words
    return "ratchets", f"ratchets: plastic strain grows by {last.plastic_drift:.3g} a cycle, steadily"


def _dies_out(flows: Sequence[float]) -> bool:
    """Whether what the last three of four cycles or more add falls as a geometric sequence to nothing.

    With ``f_k = f + c q^k`` what is left is ``f = f_3 - (f_3 - f_2)^2 / (f_3 - 2 f_2 + f_1)`` (Aitken).

    >>> _dies_out([9.0, 4.0, 2.0, 1.0]), _dies_out([9.0, 4.0, 2.5, 1.75]), _dies_out([4.0, 2.0, 1.0])
    (True, False, False)
    """
    if len(flows) < _DECAYING_CYCLES:
        return False
    first, second, third = flows[-3:]
    before, now = second - first, third - second
    return before < now < 0.0 and third + now**2 / (before - now) <= _DEAD * third


def _since(cycles: Sequence[Cycle], holds: Sequence[bool]) -> int | None:
    """The first cycle from which on something holds up to the end."""
    if not holds[-1]:
        return None
    broken = [cycle.number for cycle, held in zip(cycles, holds, strict=True) if not held]
    return (broken[-1] if broken else 0) + 1


def is_round(number: int) -> bool:
    """Whether a number is 1, 2 or 5 times a power of ten.

    >>> [number for number in range(1, 101) if is_round(number)]
    [1, 2, 5, 10, 20, 50, 100]
    """
    return str(number).rstrip("0") in ("1", "2", "5")
