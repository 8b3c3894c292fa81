# SPDX-License-Identifier: BSD-3-Clause
"""Follow a step exactly, from event to event, on the condensed interface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from signorini.arrays import Array
from signorini.engine.increments import applied, certified, refuse_overlap
from signorini.engine.leg import Leg
from signorini.engine.prepare import Prepared
from signorini.errors import SolveFailed
from signorini.friction.exact import PathState, Segment, follow, initial_state
from signorini.friction.law import OPEN
from signorini.linalg.protocol import Reduced
from signorini.solution.results import PairEvent
from signorini.solution.state import State, next_state
from signorini.trace import Attempt


def follow_exactly(prepared: Prepared, number: int, name: str, state: State, end: Mapping[str, float]) -> Leg:
    """Follow step ``number`` (1, 2, ...) from a state to the load factors at its end.

    Raises
    ------
    SolveFailed
        With status "jump" where the history cannot go on gradually; "not_found" where the path was lost.
    """
    prepared.clock.increment(f"{name}, event by event")
    offset, reduced, b = _right_hand_side(prepared, end)
    refuse_overlap(prepared, offset[: len(prepared.interface)], name)
    with prepared.clock.phase("complementarity"):
        start = _start(prepared, state)
        segment = follow(prepared.law, start, b)
    if not segment.followed:
        raise _lost(prepared, name, segment)
    with prepared.clock.phase("recovery"):
        after = _end(prepared, state, start, segment, end, offset, reduced)
    last = max(0, len(segment.pieces) - 2)
    before = state.tangential.copy()
    before[prepared.condensed.active] = _tangential(prepared, segment.pieces[last].h)
    # the law of the rate, on the last piece, is the law of the increment from where the piece began
    certificate = certified(prepared, applied(prepared, end)[0], after, before, name)
    attempt = Attempt(method="exact path", iterations=segment.pivots, end=segment.message)
    return Leg(
        path="exact",
        before=state,
        after=after,
        certificates=(certificate,),
        trace=((attempt,),),
        events=_events(prepared, number, segment),
    )


def _right_hand_side(prepared: Prepared, factors: Mapping[str, float]) -> tuple[Array, Reduced, Array]:
    """Offsets of all pairs (2 n,), reduced load and b at load factors, with no slip of the past in it."""
    condensed, interface, n = prepared.condensed, prepared.interface, len(prepared.interface)
    loads, imposed = applied(prepared, factors)
    offset = np.concatenate([interface.gap, np.zeros(n)]) + interface.B @ imposed
    reduced = condensed.reduce(prepared.constraints.transform.T @ (loads - prepared.K @ imposed))
    return offset, reduced, condensed.right_hand_side(reduced.load, offset[condensed.active_rows], prepared.law.motions)


def _start(prepared: Prepared, state: State) -> PathState:
    """The state in the scaled units of the law; at the very beginning overlaps press first."""
    condensed, rows, active = prepared.condensed, prepared.condensed.active_rows, prepared.condensed.active
    _, _, b = _right_hand_side(prepared, state.factors)
    half = len(rows) // 2
    h = condensed.root * np.concatenate([state.gap, state.tangential])[rows]
    if not state.forces.any() and not state.displacement.any():
        touching = bool((h[:half] >= 0.0).all())
        return initial_state(prepared.law, b, motion=h if touching else None)
    return PathState(
        b=b,
        h=h,
        r=state.forces[rows] / condensed.root,
        state=state.status[active],
        anchor=h[half:],
        slip=condensed.root[half:] * state.slip[active],
        dissipation=state.dissipation[active],
    )


def _end(
    prepared: Prepared,
    state: State,
    start: PathState,
    segment: Segment,
    end: Mapping[str, float],
    offset: Array,
    reduced: Reduced,
) -> State:
    """The state at the end of a segment, with the work of its linear pieces."""
    condensed, interface, T = prepared.condensed, prepared.interface, prepared.constraints.transform
    n, rows, active = len(interface), condensed.active_rows, condensed.active
    loads, imposed = applied(prepared, end)
    forces, moved = np.zeros(2 * n), np.zeros(2 * n)
    forces[rows] = condensed.root * segment.end.r
    moved[rows] = segment.end.h / condensed.root
    displacement = T @ condensed.displacement(reduced, moved[rows], forces[rows], offset[rows]) + imposed
    outside = np.setdiff1d(np.arange(2 * n), rows)
    moved[outside] = (offset + interface.B @ (displacement - imposed))[outside]
    moved[n:] -= state.tangential
    status = np.full(n, OPEN)
    status[active] = segment.end.state
    after = next_state(
        state,
        prepared.K,
        prepared.constraints,
        interface,
        factors=end,
        loads=loads,
        displacement=displacement,
        forces=forces,
        moved=moved,
        status=status,
    )
    slip, dissipation = state.slip.copy(), state.dissipation.copy()
    slip[active] = segment.end.slip / condensed.root[len(rows) // 2 :]
    dissipation[active] = segment.end.dissipation
    strain = 0.5 * (displacement @ (prepared.K @ displacement) - state.displacement @ (prepared.K @ state.displacement))
    work = state.work + float(strain) - _contact_work(prepared, state, start, segment)
    return replace(after, slip=slip, dissipation=dissipation, work=work)


def _contact_work(prepared: Prepared, state: State, start: PathState, segment: Segment) -> float:
    """``int r . d(B u)`` over the pieces, on each of which both are linear; ``B u = h - C r - h_0``.

    With ``K u = f + B^T r`` the work of all external forces is the change of strain energy less this. What overlaps
    press out before anything moves is no work of the loads: it counts from the first state of the path.
    """
    root = prepared.condensed.root
    softness = root**2 * prepared.condensed.compliance
    pieces = segment.pieces
    total = sum(
        float(0.5 * (one.r + two.r) @ (two.h - one.h - softness * (two.r - one.r))) for one, two in pairwise(pieces)
    )
    if state.forces.any() or not start.r.any():
        return total
    gap = (
        root
        * np.concatenate([prepared.interface.gap, np.zeros(len(prepared.interface))])[prepared.condensed.active_rows]
    )
    return total + float(0.5 * start.r @ (start.h - gap - softness * start.r))


def _tangential(prepared: Prepared, h: Array) -> Array:
    half = len(h) // 2
    return h[half:] / prepared.condensed.root[half:]


def _events(prepared: Prepared, number: int, segment: Segment) -> tuple[PairEvent, ...]:
    """The events by contact and node."""
    interface, labels = prepared.interface, [contact.label for contact in prepared.model.contacts]
    pairs = np.nonzero(prepared.condensed.active)[0]
    found = []
    for event in segment.events:
        own = pairs[list(event.pairs)]
        for contact in np.unique(interface.contact[own]):
            nodes = interface.node[own[interface.contact[own] == contact]]
            found.append(
                PairEvent(
                    load_factor=number - 1 + event.factor,
                    contact=labels[contact],
                    nodes=tuple(int(node) for node in nodes),
                    what=event.what,
                )
            )
    return tuple(found)


def _lost(prepared: Prepared, name: str, segment: Segment) -> SolveFailed:
    """Why the path does not go on, with the load and the acting nodes."""
    if segment.jump is None:
        return SolveFailed(
            f"{name}: the exact path was lost: {segment.message}; follow the step in increments", status="not_found"
        )
    pairs = np.nonzero(prepared.condensed.active)[0][list(segment.jump.pairs)]
    nodes = ", ".join(str(node + 1) for node in prepared.interface.node[pairs])
    what = "gross sliding" if segment.jump.gross_sliding else "a jump"
    return SolveFailed(
        f"{name} at {segment.jump.factor:.6%}: {what}: no equilibrium continues the history gradually (acting nodes "
        f"{nodes}; {segment.jump.proof})",
        status="jump",
    )
