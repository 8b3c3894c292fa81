# SPDX-License-Identifier: BSD-3-Clause
"""Contacts whose sides slide far: a part of a step in strides, and between two strides pairs are made anew.

Bodies strain little, so that their compliance does not change while they slide: what changes is B, what is opposite
what, and from the nodes of both sides, which are kept, the condensed interface follows with no factorisation. Within a
stride pairs are those of its middle, where the stride before lets expect it, and gaps go linearly from what they are to
those of the bodies at its end; so a side may be curved, and gaps never jump. Between two strides the sides "hand over":
stick and slip go on from the displacement of the bodies, and the forces balance with other neighbours. What that moves
at once is the error of the mesh, and is told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.engine.energy import set_free
from signorini.engine.increments import advance
from signorini.engine.prepare import Prepared
from signorini.engine.solver import CondensedSolver
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart, joined, keep
from signorini.errors import InputError, SolveFailed
from signorini.fem.boundary import boundary
from signorini.interface.interface import Interface
from signorini.interface.sliding import facing, paired_at, sliding_pairs
from signorini.law.states import OPEN, STICK
from signorini.outcome import Outcome
from signorini.solution.state import State

_STRIDE = 0.25  # of the shortest facet: how far sides slide before pairs are made anew
_AHEAD = 0.1  # of a stride: more than what handing over moves
_BENT = 2e-3  # of forces over the stiffness of the bodies: what gaps may differ in the middle of a stride
_OVER = 1.5  # strides: one that turns out longer is gone again
_GROWTH = 2.0  # of a stride over the one before it, in load
_SHORTER = 8.0  # times: a stride that is lost is tried again
_SHORTEST = 1e-6  # of what is left of a part: a shorter stride is not tried
_SAID_FROM = 1e-12  # of the largest force: what handing over may change and no one need know

Follow = Callable[[StepPart], FollowedPart]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Pairing:
    """Pairs of bodies at a displacement.

    Attributes
    ----------
    interface : gaps are those of the bodies where they are
    displacement : (dofs,) length
    seen : (d n,) what the pairs see of it, length
    """

    interface: Interface
    displacement: Array
    seen: Array

    @staticmethod
    def at(part: StepPart, displacement: Array) -> _Pairing:
        """The pairs of bodies that have moved."""
        prepared = part.prepared
        model, space, constraints = prepared.model, prepared.space, prepared.constraints
        try:
            interface = paired_at(prepared.interface, space, model, constraints, displacement)
        except InputError as error:
            words = f"{part.where} at {part.interval.low:.6%}: {error}"
            raise SolveFailed(words, status=Outcome.NOT_FOUND) from error
        return _Pairing(interface=interface, displacement=displacement, seen=interface.B @ displacement)

    def gap_before(self) -> Array:
        """(n,) Gaps before anything moved, as this pairing sees them."""
        return np.asarray(self.interface.gap - self.seen[: len(self.interface)])


@dataclass(frozen=True, kw_only=True, eq=False)
class _Stride:
    """A stride as it was followed.

    Attributes
    ----------
    followed : from the handing over to the end
    interface : its pairs
    moved : (dofs,) displacement in it
    slid : the longest way of a pair that touches, in strides
    changed : by how much handing over changed the forces, of the largest
    """

    followed: FollowedPart
    interface: Interface
    moved: Array
    slid: float
    changed: float


@dataclass(frozen=True, kw_only=True, eq=False)
class _Walk:
    """A straight part of a step that is followed in strides.

    Attributes
    ----------
    part : with the pairs before anything moved
    follow : the way through a stride
    limit : a stride, length
    """

    part: StepPart
    follow: Follow
    limit: float

    def beyond(self, fraction: float) -> Array:
        """(n,) Gaps beyond those of the geometry at a fraction of the step, of interferences that it changes."""
        part, t = self.part, self.part.interval.within(fraction)
        nominal = (1.0 - t) * part.before.point.gap + t * part.end.gap
        return np.asarray(nominal - part.prepared.interface.gap)

    def stride(self, now: StepPart, last: Interface, expected: Array) -> _Stride:
        """One stride, with the pairs of its middle as it is expected.

        Parameters
        ----------
        now : from where the last one ended
        last : its pairs
        expected : (dofs,) displacement in it
        """
        u, interval = now.before.displacement, now.interval
        middle = _Pairing.at(now, u + 0.5 * expected)
        end = middle if not expected.any() else _Pairing.at(now, u + expected)
        prepared = paired(now.prepared, middle.interface)
        own = sliding_pairs(prepared.model, prepared.interface)
        behind, changed = [], 0.0
        before = posed(prepared, now.before, last, middle.gap_before() + self.beyond(interval.low))
        if before.forces.any():
            handed = hand_over(prepared, before, now, _AHEAD * self.limit)
            changed = float(np.abs(handed.after.forces - before.forces).max() / np.abs(before.forces).max())
            behind.append(handed)
            before = handed.after
        there = end.interface.gap - middle.interface.B[: len(own)] @ end.displacement
        faces = facing(middle.interface) & facing(end.interface)
        gap = np.where(faces, there, middle.gap_before()) + self.beyond(interval.high)
        point = replace(now.end, gap=np.where(own, gap, now.end.gap))
        stride = replace(now, prepared=prepared, before=before, end=point)
        try:
            followed = _on(self.follow(stride), prepared)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, behind) from None
        after = followed.after
        slid = _slid(prepared, before, after, own) / self.limit
        if expected.any():
            off = middle.gap_before() + 0.5 * (self.beyond(interval.low) + self.beyond(interval.high))
            off -= 0.5 * (before.point.gap + gap)
        else:
            now_at = _Pairing.at(now, after.displacement)
            off = 0.25 * (
                now_at.gap_before() + now_at.seen[: len(own)] + self.beyond(interval.high) - _law_gap(prepared, after)
            )
        touch = own & facing(prepared.interface) & ((before.status != OPEN) | (after.status != OPEN))
        pressed = max(float(state.forces[: len(own)].sum()) for state in (before, after)) / prepared.scale.stiffness
        if touch.any() and pressed > 0.0:
            slid = max(slid, (float(np.abs(off[touch]).max()) / (_BENT * pressed)) ** 0.5)
        return _Stride(
            followed=joined([*behind, followed]),
            interface=prepared.interface,
            moved=after.displacement - u,
            slid=slid,
            changed=changed,
        )


def follow_sliding(part: StepPart, follow: Follow) -> FollowedPart:
    """Follow a straight part of a step in strides.

    Parameters
    ----------
    part : with the pairs before anything moved; gaps of its points are those of these pairs
    follow : the way through a stride

    Raises
    ------
    SolveFailed
        What ended a stride, with all strides before it.
    """
    walk = _Walk(part=part, follow=follow, limit=_STRIDE * shortest_facet(part.prepared))
    behind: list[_Stride] = []
    rest, share, rate = part, 1.0, np.zeros(len(part.before.displacement))
    while True:
        now = rest if share >= 1.0 else rest.cut(share, "handover")
        length = now.interval.high - now.interval.low
        try:
            last = behind[-1].interface if behind else part.prepared.interface
            stride = walk.stride(now, last, length * rate)
        except (SolveFailed, KeyboardInterrupt) as stop:
            lost = isinstance(stop, SolveFailed) and stop.status in (Outcome.NOT_FOUND, Outcome.JUMP)
            if not lost or share < _SHORTEST:
                raise keep(stop, [done.followed for done in behind]) from None
            share /= _SHORTER
            continue
        rate = stride.moved / length
        if stride.slid > _OVER and share >= _SHORTEST:
            share /= ceil(stride.slid)
            continue
        behind.append(stride)
        if now is rest:
            return _finished(part, behind)
        rest = rest.rest(now, stride.followed.after)
        wanted = length * (min(_GROWTH, 1.0 / stride.slid) if stride.slid > 0.0 else _GROWTH)
        share = 1.0 / max(1, ceil((rest.interval.high - rest.interval.low) / wanted - 1e-9))


def _finished(part: StepPart, strides: list[_Stride]) -> FollowedPart:
    """All strides as one; the state at the end refers to the pairs before anything moved, as that before does."""
    followed, changed = joined([stride.followed for stride in strides]), max(stride.changed for stride in strides)
    nominal = part.prepared.interface
    own = nominal.rows(sliding_pairs(part.prepared.model, nominal))
    forces = np.where(own, turned(followed.after.forces, strides[-1].interface, nominal), followed.after.forces)
    after = replace(followed.after, point=replace(followed.after.point, gap=part.end.gap), forces=forces)
    notes = followed.notes
    if changed > _SAID_FROM:
        words = f"pairs followed the bodies in {len(strides)} strides; handing over changed forces by {changed:.1e}"
        notes = (*notes, f"{words} of the largest at most")
    return replace(followed, after=after, notes=notes)


def turned(forces: Array, old: Interface, new: Interface) -> Array:
    """Forces of pairs (d n,) in other frames.

    Parameters
    ----------
    forces : in the old frames
    old, new : interfaces with as many pairs
    """
    one, other = (np.concatenate([of.normals[:, None], of.tangents], axis=1) for of in (old, new))
    return np.asarray(np.einsum("kij,klj,lk->ik", other, one, forces.reshape(old.directions, -1)).ravel())


def paired(prepared: Prepared, interface: Interface) -> Prepared:
    """The model with other pairs; nothing sparse is factorised again.

    Parameters
    ----------
    prepared : under the law of the moment
    interface : with as many pairs, in the same order
    """
    B = sp.csr_array(interface.B @ prepared.constraints.transform)
    condensed = prepared.paths.condensed.paired(B, interface, prepared.scale.stiffness)
    if prepared.absent.any():
        condensed = condensed.among(~prepared.absent)
    solver = CondensedSolver.of(condensed, interface, prepared.scale, prepared.settings)
    return replace(prepared, interface=interface, solver=solver)


def posed(prepared: Prepared, state: State, last: Interface, gap: Array) -> State:
    """A state as other pairs see it: slips go on from where the bodies are, and forces keep their directions.

    Parameters
    ----------
    prepared : with the pairs
    state : of the last ones
    last : the last ones
    gap : (n,) before anything moved, of pairs that do not touch, length
    """
    interface, n, d = prepared.interface, len(gap), prepared.interface.directions
    own, faces = sliding_pairs(prepared.model, interface), facing(interface)
    there = np.where(interface.rows(faces), turned(state.forces, last, interface), 0.0)
    forces = np.where(interface.rows(own), there, state.forces)
    moved = interface.B @ state.displacement + interface.compliance / interface.areas * forces
    touches = faces & (state.status != OPEN)
    point_gap = np.where(touches, state.gap - moved[:n], gap)
    return replace(
        state,
        point=replace(state.point, gap=np.where(own, point_gap, state.point.gap)),
        forces=forces,
        gap=np.where(own, point_gap + moved[:n], state.gap),
        tangential=np.where(np.tile(own, d - 1), moved[n:], state.tangential),
        status=np.where(own & ~faces, OPEN, state.status),
    )


def hand_over(prepared: Prepared, state: State, part: StepPart, ahead: float) -> FollowedPart:
    """Equilibrium of a state with the pairs that it has now, at the same loads; what friction does not take is set free.

    Pairs that slip go on slipping, as if they had slipped a little on from where they are, for otherwise all of them
    would stick for a moment, and slip again one after the other.

    Parameters
    ----------
    prepared : with the pairs
    state : as they see it, not in equilibrium by the error of the mesh
    part : that begins there
    ahead : how far that is, length
    """
    where, n = f"{part.where} at {part.interval.low:.6%}, handing over", len(state.gap)
    drags = sliding_pairs(prepared.model, prepared.interface) & (state.status > STICK)
    forces = state.forces.reshape(-1, n)[1:]
    way = np.where(drags, -ahead * forces / np.maximum(np.linalg.norm(forces, axis=0), np.finfo(float).tiny), 0.0)
    led = replace(state, tangential=state.tangential - way.ravel())
    after, certificate, trace = advance(prepared, led, state.point, where)
    after = replace(after, slip=after.slip - np.where(after.status == OPEN, 0.0, way).ravel())
    moved = after.tangential - state.tangential
    taken = -(0.5 * (state.forces + after.forces)[n:] * moved).reshape(-1, n).sum(axis=0)
    after = set_free(prepared, state, after, taken=np.where(drags, taken, 0.0))
    shot = Snapshot(number=part.interval.number, fraction=part.interval.low, what="handover", state=after)
    handed = FollowedPart(
        path="single",
        before=state,
        after=after,
        certificates=(certificate,),
        trace=(trace,),
        snapshots=(shot,),
    )
    return _on(handed, prepared)


def _on(followed: FollowedPart, prepared: Prepared) -> FollowedPart:
    """What was followed, with the pairs that it was followed with."""
    shots = tuple(replace(shot, interface=prepared.interface) for shot in followed.snapshots)
    return replace(followed, snapshots=shots)


def _law_gap(prepared: Prepared, state: State) -> Array:
    """(n,) Gaps of a state between the sides, without what a compliant interface yields, length."""
    interface, n = prepared.interface, len(state.gap)
    return np.asarray(state.gap - interface.normal_compliance / interface.area * state.forces[:n])


def _slid(prepared: Prepared, begin: State, end: State, own: BoolArray) -> float:
    """The longest way, length, of sliding pairs that touch at the beginning or the end; of all where none does."""
    interface, n = prepared.interface, len(own)
    way = interface.across((interface.B @ (end.displacement - begin.displacement))[n:])
    touch = own & ((begin.status != OPEN) | (end.status != OPEN))
    return float(way[touch if touch.any() else own].max(initial=0.0))


def shortest_facet(prepared: Prepared) -> float:
    """Of all contacts that slide far, length."""
    lengths = []
    for i, contact in enumerate(prepared.model.contacts):
        if contact.slides:
            sides = [contact.nonmortar]
            if isinstance(contact.mortar, str) and contact.mortar in prepared.model.mesh.boundaries:
                sides.append(contact.mortar)
            lengths += [float(boundary(prepared.space, side, ("contact", i)).lengths.min()) for side in sides]
    return min(lengths)
