# SPDX-License-Identifier: BSD-3-Clause
"""Sides hand over to other pairs: what a state is to them, and the work of what fades away as they take over.

In a stride pairs have the mean B* of those at both its ends, through which gaps change by as much as they do, see
`interface.mean_pairs`: so forces of pairs that stay closed do no work, whatever they are. What bodies feel must not
jump between two strides: what equilibrium would miss with the pairs of the next, ``(B*_last - B*)^T f`` and what has
grown before, is a load that goes to zero linearly in it, and ``(B' - B*)^T f``, what its end lacks, one that grows.
With f the forces at its beginning these do work by

    - (B' - B)^T f u / 2  +  (B' - B)^T f u / 2  +  O(stride^3),

where forces, or lengths of strides, differ from the last to the next. What that adds up to is known before a stride is
followed, but for the change of the forces in it. A force along the way that is proportional to the pressures, grows
and fades in the next stride does as much work, so that nothing is left to be set free: it is of the order of 1e-5 of
the friction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Snapshot
from signorini.interface.interface import Interface
from signorini.interface.sliding import facing, sliding_pairs
from signorini.law.states import OPEN
from signorini.solution.state import LoadPoint, State

_NOT_MISSED = 1e-13  # of the largest force in the bodies: what rounding may take from equilibrium
_LARGEST_SHARE = 1e-3  # of friction: what a force along the way that balances energies may be


@dataclass(frozen=True, kw_only=True, eq=False)
class Way:
    """A stride as it is expected to be.

    Attributes
    ----------
    moved : (dofs,) displacement in it
    forces : (d, n) of the pairs, in the mean
    slides : (n,) pairs of contacts that slide far
    ahead : length of the next stride, of its own
    least : length that pairs slide in the mean where sides slide over each other
    """

    moved: Array
    forces: Array
    slides: BoolArray
    ahead: float
    least: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Handover:
    """A state between two strides.

    Attributes
    ----------
    before : as the pairs of the next stride see it; what fades away in that is in its point
    fading : (dofs,) forces that equilibrium would miss
    growing : (dofs,) forces that grow in that stride
    stored : energy that what lies between the sides stores beyond what it did with the last pairs
    """

    before: State
    fading: Array
    growing: Array
    stored: float = 0.0

    @staticmethod
    def to(prepared: Prepared, state: State, loads: Array, known: BoolArray, gap: Array) -> Handover:
        """A state as other pairs see it: slips go on from where the bodies are, and forces turn with their pairs.

        Parameters
        ----------
        prepared : with the pairs, and the loads as bodies see them then
        state : of the last ones
        loads : (dofs,) as bodies have seen them so far, with what has grown
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
        changed = applied(prepared, point)[0] - loads
        fading = inner - state.external - changed
        fading[np.abs(fading) <= _NOT_MISSED * np.abs(inner).max(initial=0.0)] = 0.0
        before = replace(
            state,
            point=replace(
                supported(point, len(fading)),
                gap=np.where(own, first, point.gap),
                reaction=point.reaction + fading if len(point.reaction) else fading,
            ),
            external=state.external + changed + fading,
            forces=forces,
            gap=np.where(own, first + moved[0], state.gap),
            tangential=np.where(own, moved[1:], state.tangential),
            status=np.where(own & ~faces, OPEN, state.status),
        )
        return Handover(before=before, fading=fading, growing=np.zeros_like(fading))

    @property
    def share(self) -> float:
        """Of the largest force of a pair, what fades away at a node."""
        largest = float(np.abs(self.before.forces).max(initial=0.0))
        return float(np.abs(self.fading).max(initial=0.0)) / largest if largest > 0.0 else 0.0

    def towards(self, rest: sp.csr_array, forces: Array) -> Handover:
        """With forces that grow: (d n, dofs) rows of B beyond those of the stride, under forces (d, n) of the pairs."""
        return replace(self, growing=rest.T @ forces.ravel())

    def balanced(self, interface: Interface, way: Way, opened: Array, owed: float) -> Handover:
        """With a force along the way that does the work that the change of pairs has set free, and will.

        It is in proportion to friction, without friction to the pressures; there is none where sides roll.

        Parameters
        ----------
        interface : of the stride, its pairs
        way : as it is expected
        opened : (n,) as of `booked`
        owed : energy that was set free before
        """
        along = (interface.B @ way.moved).reshape(way.forces.shape)
        along[:, ~way.slides] = along[0] = 0.0
        length = np.linalg.norm(along, axis=0)
        pressed = np.maximum(way.forces[0], 0.0)
        friction = np.minimum(interface.most(pressed), pressed)
        size = friction if friction.any() else pressed
        if size @ length <= way.least * size.sum():
            return self
        force = size * np.divide(along, length, out=np.zeros_like(along), where=length > 0.0)
        work = 0.5 * (1.0 + way.ahead) * float(size @ length)
        freed = float(way.forces[0] @ opened) - 0.5 * float((self.fading + self.growing) @ way.moved) - self.stored
        share = np.clip((owed + freed) / work, -_LARGEST_SHARE, _LARGEST_SHARE)
        return replace(self, growing=self.growing + share * interface.on_bodies(force))

    def booked(self, followed: FollowedPart, opened: Array) -> FollowedPart:
        """The stride without the work of the change of its pairs, which no load does and is set free.

        Parameters
        ----------
        followed : the stride
        opened : (n,) what the gap of a pair is made to grow by in it that is geometry, length
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
                moved = now.displacement - whole.displacement
                energy += float((mean * self.fading + (1.0 - mean) * self.growing) @ moved)
                whole, seen = now, t
            last, passed = now, t
            freed = energy + self.stored
            shots.append(replace(shot, state=replace(now, work=now.work - energy, released=now.released - freed)))
        return replace(followed, snapshots=tuple(shots), after=shots[-1].state)


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
