# SPDX-License-Identifier: BSD-3-Clause
"""Sides hand over to other pairs: what a state is to them, and the work of what fades away as they take over.

At the end of a stride forces f of the pairs are in equilibrium through B, what is opposite what; the next stride has
the pairs B' of its own end. What equilibrium would miss at once, ``(B - B')^T f``, is a load that goes to zero linearly
in that stride, and gaps go linearly from what they are to those of the bodies at its end. So nothing jumps, and
pressures work through the change of the gap by the trapezoidal rule: with u the motion and g the gap in a stride

    p . (B + B') u / 2  =  p . dg  +  O(stride^3),

which is 0 where pairs stay closed. What is left counts as set free; what tangential forces do in the same way, along
the slip that the last pairs see beyond what these do, counts as friction's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Snapshot, ending
from signorini.interface.sliding import facing, sliding_pairs
from signorini.law.states import OPEN, STICK
from signorini.solution.state import LoadPoint, State

_NOT_MISSED = 1e-13  # of the largest force in the bodies: what rounding may take from equilibrium


@dataclass(frozen=True, kw_only=True, eq=False)
class Handover:
    """A state between two strides.

    Attributes
    ----------
    before : as the pairs of the next stride see it; what fades away in that is in its point
    fading : (dofs,) forces that equilibrium would miss
    """

    before: State
    fading: Array

    @staticmethod
    def to(prepared: Prepared, state: State, loads: Array, known: BoolArray, gap: Array) -> Handover:
        """A state as other pairs see it: slips go on from where the bodies are, and forces turn with their pairs.

        Parameters
        ----------
        prepared : with the pairs, and the loads as bodies see them then
        state : of the last ones
        loads : (dofs,) as bodies have seen them so far
        known : (n,) pairs whose gap the state knows
        gap : (n,) of the others before anything moved, length
        """
        interface, point = prepared.interface, state.point
        own, faces = sliding_pairs(prepared.model, interface), facing(interface)
        forces = np.where(own, _bearable(prepared, np.where(faces, state.forces, 0.0)), state.forces)
        moved = interface.motion(state.displacement) + interface.give(forces, state.borne)
        first = np.where(faces, np.where(known, state.gap, np.maximum(gap + moved[0], 0.0)) - moved[0], gap)
        inner = prepared.K @ state.displacement - interface.on_bodies(forces)
        if state.plastic is not None:
            inner -= state.plastic.forces
        fading = inner - state.external + loads - applied(prepared, point)[0]
        fading[np.abs(fading) <= _NOT_MISSED * np.abs(inner).max(initial=0.0)] = 0.0
        before = replace(
            state,
            point=replace(
                supported(point, len(fading)),
                gap=np.where(own, first, point.gap),
                reaction=point.reaction + fading if len(point.reaction) else fading,
            ),
            external=state.external + fading,
            forces=forces,
            gap=np.where(own, first + moved[0], state.gap),
            tangential=np.where(own, moved[1:], state.tangential),
            status=np.where(own & ~faces, OPEN, state.status),
        )
        return Handover(before=before, fading=fading)

    @property
    def share(self) -> float:
        """Of the largest force of a pair, what fades away at a node."""
        largest = float(np.abs(self.before.forces).max(initial=0.0))
        return float(np.abs(self.fading).max(initial=0.0)) / largest if largest > 0.0 else 0.0

    def friction(self, parted: Array) -> Array:
        """(n,) Energy that friction of slipping pairs takes along the slip that the last pairs alone see.

        Parameters
        ----------
        parted : (d n,) motion that the last pairs see beyond what these do, in the stride
        """
        q = self.before.forces[1:]
        beyond = parted.reshape(self.before.forces.shape)[1:]
        return np.where(self.before.status > STICK, -0.5 * (q * beyond).sum(axis=0), 0.0)

    def booked(self, followed: FollowedPart, opened: Array, taken: Array) -> FollowedPart:
        """The stride without the work of the change of its pairs, which no load does: friction's share, and set free.

        Parameters
        ----------
        followed : the stride
        opened : (n,) what the gap of a pair has grown by in it that is geometry, length
        taken : (n,) friction's share
        """
        begin, end = self.before, followed.after
        last, whole, passed, seen, energy = begin, begin, 0.0, 0.0, 0.0
        shots: list[Snapshot] = []
        for shot in followed.snapshots:
            now = shot.state
            t = _passed(begin.point, now.point, end.point)
            energy -= (t - passed) * float(0.5 * (last.forces + now.forces)[0] @ opened)
            if shot.whole:
                mean = 1.0 - 0.5 * (seen + t)
                energy += mean * float(self.fading @ (now.displacement - whole.displacement))
                whole, seen = now, t
            last, passed = now, t
            shots.append(replace(shot, state=replace(now, work=now.work - energy, released=now.released - energy)))
        after = shots[-1].state
        spent = float(taken.sum())
        after = replace(after, dissipation=after.dissipation + taken, released=after.released - spent)
        return ending(replace(followed, snapshots=tuple(shots)), after)


def supported(point: LoadPoint, dofs: int) -> LoadPoint:
    """A point of the load history with room for what supports let go, and for what they hold beyond."""
    if len(point.reaction):
        return point
    return replace(point, reaction=np.zeros(dofs), offset=np.zeros(dofs))


def _bearable(prepared: Prepared, forces: Array) -> Array:
    """Forces of pairs (d, n) whose friction is no more than it can be; it may have been lowered."""
    interface = prepared.interface
    effort, most = interface.effort(forces[1:]), interface.most(forces[0])
    beyond = (effort > most) & ~interface.friction.sticks & ~prepared.absent
    share = np.divide(most, effort, out=np.ones_like(effort), where=beyond)
    return np.concatenate([forces[:1], share * forces[1:]])


def _passed(begin: LoadPoint, now: LoadPoint, end: LoadPoint) -> float:
    """How much of the way between two points is behind, 0 .. 1; 1 where they are one."""
    way, left = (np.concatenate([end.reaction - of.reaction, end.gap - of.gap]) for of in (begin, now))
    size = float(way @ way)
    return 1.0 - float(left @ way) / size if size > 0.0 else 1.0


def with_pairs(followed: FollowedPart, prepared: Prepared) -> FollowedPart:
    """What was followed, with the pairs that it was followed with."""
    shots = tuple(replace(shot, interface=prepared.interface) for shot in followed.snapshots)
    return replace(followed, snapshots=shots)
