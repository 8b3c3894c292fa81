# SPDX-License-Identifier: BSD-3-Clause
"""Sides hand over to other pairs: what a state is to them, and the equilibrium of its forces with other neighbours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.energy import set_free
from signorini.engine.increments import advance
from signorini.engine.prepare import Prepared
from signorini.engine.rubbing import handed, rubbed
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart
from signorini.interface.interface import Interface
from signorini.interface.sliding import facing, sliding_pairs
from signorini.law.states import OPEN, STICK
from signorini.solution.state import State, wear_of


def turned(forces: Array, old: Interface, new: Interface) -> Array:
    """Forces of pairs (d, n) in other frames.

    Parameters
    ----------
    forces : in the old frames
    old, new : interfaces with as many pairs
    """
    one, other = (np.concatenate([of.normals[:, None], of.tangents], axis=1) for of in (old, new))
    return np.asarray(np.einsum("kij,klj,lk->ik", other, one, forces))


def posed(prepared: Prepared, state: State, last: Interface, gap: Array) -> State:
    """A state as other pairs see it: slips go on from where the bodies are, and forces keep their directions.

    Parameters
    ----------
    prepared : with the pairs
    state : of the last ones
    last : the last ones
    gap : (n,) before anything moved, of pairs that do not touch, length
    """
    interface = prepared.interface
    own, faces = sliding_pairs(prepared.model, interface), facing(interface)
    there = np.where(faces, turned(state.forces, last, interface), 0.0)
    forces = np.where(own, there, state.forces)
    moved = interface.motion(state.displacement) + interface.give(forces)
    touches = faces & (state.status != OPEN)
    point_gap = np.where(touches, state.gap - moved[0], gap)
    return replace(
        state,
        point=replace(state.point, gap=np.where(own, point_gap, state.point.gap)),
        forces=forces,
        gap=np.where(own, point_gap + moved[0], state.gap),
        tangential=np.where(own, moved[1:], state.tangential),
        status=np.where(own & ~faces, OPEN, state.status),
    )


def hand_over(prepared: Prepared, state: State, part: StepPart, ahead: float) -> FollowedPart:
    """Equilibrium of a state with the pairs that it has now, at the same loads; friction takes its part of the energy.

    Pairs that slip go on slipping, as if they had slipped a little on from where they are, for otherwise all of them
    would stick for a moment, and slip again one after the other.

    Parameters
    ----------
    prepared : with the pairs
    state : as they see it, not in equilibrium by the error of the mesh
    part : that begins there
    ahead : how far that is, length
    """
    where = f"{part.where} at {part.interval.low:.6%}, handing over"
    drags = sliding_pairs(prepared.model, prepared.interface) & (state.status > STICK)
    forces = state.forces[1:]
    way = np.where(drags, -ahead * forces / np.maximum(np.linalg.norm(forces, axis=0), np.finfo(float).tiny), 0.0)
    led = replace(state, tangential=state.tangential - way)
    after, certificate, trace = advance(prepared, led, state.point, where)
    after = replace(after, slip=after.slip - np.where(after.status == OPEN, 0.0, way))
    moved = after.tangential - state.tangential
    taken = -(0.5 * (state.forces + after.forces)[1:] * moved).sum(axis=0)
    taken = np.where(drags, taken, 0.0)
    after = set_free(prepared, state, after, taken=taken)
    if prepared.wearing is not None:
        normal = np.array([state.forces[0], after.forces[0]])
        after = replace(after, wear=rubbed(wear_of(state), handed(prepared, normal, moved, taken)))
    shot = Snapshot(number=part.interval.number, fraction=part.interval.low, what="handover", state=after)
    found = FollowedPart(
        path="single",
        before=state,
        after=after,
        certificates=(certificate,),
        trace=(trace,),
        snapshots=(shot,),
    )
    return with_pairs(found, prepared)


def with_pairs(followed: FollowedPart, prepared: Prepared) -> FollowedPart:
    """What was followed, with the pairs that it was followed with."""
    shots = tuple(replace(shot, interface=prepared.interface) for shot in followed.snapshots)
    return replace(followed, snapshots=shots)
