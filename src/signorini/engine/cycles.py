# SPDX-License-Identifier: BSD-3-Clause
"""What cycle after cycle does: energy, slip, and whether it settles (shakes down, repeats, ratchets)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.arrays import Array
from signorini.engine.step_parts import FollowedPart
from signorini.law.states import OPEN
from signorini.solution.results import Cycle
from signorini.solution.scale import Scale
from signorini.solution.state import State

REPEAT_TOL = 1e-8
"""Forces of the largest, and slips of the size of the data, that count as equal."""


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
        sliding, last = sliding + _across(state.slip - last, n), state.slip
        if snapshot.load_factor != ends[len(found)]:
            continue
        size = float(np.abs(state.forces).max(initial=0.0)) or 1.0
        found.append(
            Cycle(
                number=len(found) + 1,
                load_factor=snapshot.load_factor,
                work=state.work - begin.work,
                dissipation=float((state.dissipation - begin.dissipation).sum()),
                released=state.released - begin.released,
                sliding=float(sliding.max(initial=0.0)),
                change=float(np.abs(state.forces - begin.forces).max(initial=0.0)) / size,
                drift=_drift(begin, state),
            )
        )
        begin, sliding = state, np.zeros(n)
    return tuple(found)


def _drift(begin: State, end: State) -> float:
    """Largest change of the tangential displacement of pairs that touch at both ends; what opens may slide unseen."""
    touching = (begin.status != OPEN) & (end.status != OPEN)
    return float(_across(end.tangential - begin.tangential, len(touching))[touching].max(initial=0.0))


def _across(tangential: Array, n: int) -> Array:
    """(n,) length of tangential vectors that are given row by row, ((d - 1) n,)."""
    return np.linalg.norm(tangential.reshape(-1, n), axis=0) if n else np.zeros(0)


def judge(cycles: Sequence[Cycle], scale: Scale) -> tuple[str, str]:
    """One of "shakes down", "steady", "ratchets" and "not yet", and the same in a sentence."""
    still = _since(cycles, [cycle.sliding <= REPEAT_TOL * scale.length for cycle in cycles])
    if still is not None:
        return "shakes down", f"shakes down: no pair slips from cycle {still} on"
    repeats = [cycle.change <= REPEAT_TOL for cycle in cycles]
    closed = _since(
        cycles, [same and cycle.drift <= REPEAT_TOL * scale.length for same, cycle in zip(repeats, cycles, strict=True)]
    )
    last = cycles[-1]
    if closed is not None:
        words = f"steady from cycle {closed} on: it ends as it begins, and dissipates {last.dissipation:.6g}"
        return "steady", words
    drifts = _since(cycles, repeats)
    if drifts is not None:
        return (
            "ratchets",
            f"ratchets from cycle {drifts} on: forces repeat, the contact moves on by {last.drift:.6g} a cycle",
        )
    words = f"not steady after {len(cycles)} cycles: the last changes forces by {last.change:.2g} of the largest"
    return "not yet", words


def _since(cycles: Sequence[Cycle], holds: Sequence[bool]) -> int | None:
    """The first cycle from which on something holds up to the end."""
    if not holds[-1]:
        return None
    broken = [cycle.number for cycle, held in zip(cycles, holds, strict=True) if not held]
    return (broken[-1] if broken else 0) + 1
