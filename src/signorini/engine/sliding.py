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
from signorini.engine.handing_over import hand_over, posed, turned, with_pairs
from signorini.engine.plastic_solver import PlasticSolver
from signorini.engine.prepare import Prepared
from signorini.engine.rubbing import rubbed, rubbing_of_states, set_loose
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.engine.step_parts import FollowedPart, StepPart, ending, joined, keep
from signorini.engine.turning import first_share, refuse_turned, with_turned_loads
from signorini.errors import InputError, SolveFailed
from signorini.fem.boundary import boundary
from signorini.interface.interface import Interface
from signorini.interface.sliding import facing, paired_at, sliding_pairs, spun
from signorini.interface.worn_sides import worn_sides
from signorini.law.states import OPEN
from signorini.outcome import Outcome
from signorini.solution.state import State, wear_of

_STRIDE = 0.25  # of the shortest facet: how far sides slide before pairs are made anew
_BENT = 2e-3  # of forces over the stiffness of the bodies: what gaps may differ in the middle of a stride
_SHORTEST_MOVE = 0.125  # of a stride: what bodies move at least, however gaps bend
_TURN = 0.1  # radians: what a body turns by in a stride at most, for loads keep their direction as it sees them
_OVER = 1.5  # strides: one that turns out longer is gone again
_GROWTH = 2.0  # of a stride over the one before it, in load
_SHORTER = 8.0  # times: a stride that is lost is tried again
_SHORTEST_SHARE = 1e-6  # of the rest of a part: below it no stride that is lost is tried again
_SAID_FROM = 1e-12  # of the largest force: what handing over may change and no one need know

AHEAD = 0.1
"""Of a stride: how far pairs that slip are led on while they hand over, more than that moves them."""

Follow = Callable[[StepPart], FollowedPart]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Pairing:
    """Pairs of bodies at a displacement.

    Attributes
    ----------
    interface : gaps are those of the bodies where they are
    displacement : (dofs,) length
    """

    interface: Interface
    displacement: Array

    @staticmethod
    def at(part: StepPart, displacement: Array) -> _Pairing:
        """The pairs of bodies that have moved."""
        prepared = part.prepared
        model, space, constraints = prepared.model, prepared.space, prepared.constraints
        try:
            interface = paired_at(prepared.interface, space, model, constraints, prepared.frames, displacement)
        except InputError as error:
            words = f"{part.where} at {part.interval.low:.6%}: {error}"
            raise SolveFailed(words, status=Outcome.NOT_FOUND) from error
        return _Pairing(interface=interface, displacement=displacement)

    def gap_before(self, seen: Interface | None = None) -> Array:
        """(n,) Gaps before anything moved, as these pairs, or others, see the motion since then."""
        B = (seen or self.interface).B[: len(self.interface)]
        return np.asarray(self.interface.gap - B @ self.displacement)


@dataclass(frozen=True, kw_only=True, eq=False)
class Stride:
    """A stride as it was followed.

    Attributes
    ----------
    part : from where the last one ended, as far as it goes
    prepared : with its pairs
    gaps : (2, n) at its ends between sides that are not worn, before anything moved as its pairs see the motion since
    followed : from the handing over to the end
    middle : (dofs,) displacement in the middle of it, where it was expected
    end : pairs at its end, or where that was expected
    moved : (dofs,) displacement in it
    slid : the longest way of a pair that touches, in strides
    changed : by how much handing over changed the forces, of the largest
    """

    part: StepPart
    prepared: Prepared
    gaps: Array
    followed: FollowedPart
    middle: Array
    end: _Pairing
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
    lost : (m,) depth that the sides lose in it, see `WornSides`; empty where none does
    """

    part: StepPart
    follow: Follow
    limit: float
    lost: Array

    def beyond(self, prepared: Prepared, t: float) -> Array:
        """(n,) Gaps of pairs beyond those of the geometry: of interferences that the step changes, and of wear.

        Parameters
        ----------
        prepared : with the pairs
        t : the fraction of the part
        """
        part, seen, nominal = self.part, prepared.wearing, self.part.prepared.wearing
        gap = (1.0 - t) * part.before.point.gap + t * part.end.gap - part.prepared.interface.gap
        if seen is None or nominal is None:
            return np.asarray(gap)
        return np.asarray(gap + self.worn_gap(prepared, t) - nominal.gap @ self.depth(t))

    def depth(self, t: float) -> Array:
        """(m,) Worn depth at a fraction of the part; empty where no side wears."""
        wear = self.part.before.wear
        return np.zeros(0) if wear is None else wear.depth - (1.0 - t) * self.lost

    def worn_gap(self, prepared: Prepared, t: float) -> Array | float:
        """(n,) What pairs feel of it there."""
        return 0.0 if prepared.wearing is None else np.asarray(prepared.wearing.gap @ self.depth(t))

    def stride(self, now: StepPart, last: Stride | None, expected: Array) -> Stride:
        """One stride, with the pairs of its middle as it is expected.

        Parameters
        ----------
        now : from where the last one ended
        last : that one; None at the beginning of the part
        expected : (dofs,) displacement in it
        """
        u, interval = now.before.displacement, now.interval
        middle = _Pairing.at(now, u + 0.5 * expected)
        end = _Pairing.at(now, u + expected) if expected.any() else middle
        prepared = with_turned_loads(paired(now.prepared, middle.interface), middle.displacement)
        seen = self.seen_last(last, middle.displacement)
        behind, changed = list[FollowedPart](), 0.0
        begun = self.part.interval.within(interval.low) if interval.high > interval.low else 0.0
        done = self.part.interval.within(interval.high)
        first = middle.gap_before() + self.beyond(prepared, begun)
        before = posed(prepared, now.before, seen, first)
        if before.forces.any():
            passed = hand_over(prepared, before, now, AHEAD * self.limit)
            changed = float(np.abs(passed.after.forces - before.forces).max() / np.abs(before.forces).max())
            behind.append(passed)
            before = passed.after
        faces = facing(middle.interface) & facing(end.interface)
        gap = np.where(faces, end.gap_before(middle.interface), middle.gap_before())
        gap += self.beyond(prepared, done)
        own = sliding_pairs(prepared.model, prepared.interface)
        point = replace(now.end, gap=np.where(own, gap, now.end.gap))
        try:
            followed = with_pairs(self.follow(replace(now, prepared=prepared, before=before, end=point)), prepared)
            followed = self.worn(prepared, before, followed)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, behind) from None
        after = followed.after
        if not expected.any():
            end = _Pairing.at(now, after.displacement)
        touch = facing(end.interface) & own & ((before.status != OPEN) | (after.status != OPEN))
        begin = middle if last is None or not expected.any() else last.end
        pressed = max(float(state.forces[0].sum()) for state in (before, after)) / prepared.scale.stiffness
        bent = np.abs(_bent(begin, middle, end)[touch]).max(initial=0.0) / (_BENT * pressed) if pressed > 0.0 else 0.0
        moved = after.displacement - u
        turned_by = prepared.frames.turned(u, after.displacement) / _TURN
        # gaps of sides with corners jump, and no stride is short enough for that
        shortened = min(float(bent) ** 0.5, prepared.space.farthest(moved) / (_SHORTEST_MOVE * self.limit))
        return Stride(
            part=replace(now, prepared=prepared),
            prepared=prepared,
            gaps=np.array([first - self.worn_gap(prepared, begun), gap - self.worn_gap(prepared, done)]),
            followed=joined([*behind, followed]),
            middle=middle.displacement,
            end=end,
            moved=moved,
            slid=max(_slid(prepared, before, after, own) / self.limit, shortened, turned_by),
            changed=changed,
        )

    def seen_last(self, last: Stride | None, displacement: Array) -> Interface:
        """Pairs of the last stride, or of the beginning, turned as bodies have turned to a displacement since then."""
        frames = self.part.prepared.frames
        if last is None:
            return spun(self.part.prepared.interface, frames, displacement)
        return spun(last.prepared.interface, frames, displacement, last.middle)

    def arrived(self, last: Stride) -> Stride:
        """The end of the part with the pairs, and the loads, of where bodies are that have turned."""
        part, state = self.part, last.followed.after
        at_end = replace(part, interval=replace(part.interval, low=part.interval.high), before=state)
        place = _Pairing.at(at_end, state.displacement)
        prepared = with_turned_loads(paired(part.prepared, place.interface), state.displacement)
        gap = place.gap_before() + self.beyond(prepared, 1.0)
        before = posed(prepared, state, self.seen_last(last, state.displacement), gap)
        followed = hand_over(prepared, before, at_end, AHEAD * self.limit)
        return replace(last, followed=followed, prepared=prepared, middle=state.displacement)

    def worn(self, prepared: Prepared, before: State, followed: FollowedPart) -> FollowedPart:
        """A stride with what it has rubbed off the sides, and what gaps that grow by wear alone have set free."""
        if prepared.wearing is None:
            return followed
        if self.lost.any():
            followed = set_loose(before, followed)
        states = [before, *(shot.state for shot in followed.snapshots)]
        rubbing = rubbing_of_states(prepared.wearing, prepared.interface, states)
        return ending(followed, replace(followed.after, wear=rubbed(wear_of(followed.after), rubbing)))


def _bent(begin: _Pairing, middle: _Pairing, end: _Pairing) -> Array:
    """(n,) What gaps in the middle of a stride are beside the mean of those at its ends, length; 0 where not all face.

    Where pairs of the beginning were taken, as ``middle`` too, it is a quarter of what gaps at the end are beside them.
    """
    seen, known = middle.interface, facing(begin.interface) & facing(middle.interface) & facing(end.interface)
    if begin is middle:
        bent = 0.25 * (end.gap_before(seen) - middle.gap_before())
    else:
        bent = middle.gap_before() - 0.5 * (begin.gap_before(seen) + end.gap_before(seen))
    return np.where(known, bent, 0.0)


def follow_sliding(
    part: StepPart, follow: Follow, lost: Array | None = None, strides: list[Stride] | None = None
) -> FollowedPart:
    """Follow a straight part of a step in strides; what they rub off sides that wear is in the states.

    Parameters
    ----------
    part : with the pairs before anything moved; gaps of its points are those of these pairs
    follow : the way through a stride
    lost : (m,) depth that sides lose in a part at constant loads, the state before it has it already; None: nothing
    strides : are added to it where given

    Raises
    ------
    SolveFailed
        What ended a stride, with all strides before it.
    """
    none = np.zeros(0 if part.before.wear is None else len(part.before.wear.depth))
    limit = stride_of(part.prepared)
    walk = _Walk(part=part, follow=follow, limit=limit, lost=none if lost is None else lost)
    behind: list[Stride] = [] if strides is None else strides
    first = len(behind)
    rest, share = part, first_share(part.prepared, part.before.point, part.end, walk.limit)
    rate = np.zeros(len(part.before.displacement))
    while True:
        now = rest if share >= 1.0 else rest.cut(share, "handover")
        length = now.interval.high - now.interval.low
        try:
            stride = walk.stride(now, behind[-1] if behind[first:] else None, length * rate)
        except (SolveFailed, KeyboardInterrupt) as stop:
            again = isinstance(stop, SolveFailed) and stop.status in (Outcome.NOT_FOUND, Outcome.JUMP)
            if not again or share < _SHORTEST_SHARE:
                raise keep(stop, [done.followed for done in behind[first:]]) from None
            share /= _SHORTER
            continue
        rate = stride.moved / (length or 1.0)
        if stride.slid > _OVER:
            share /= ceil(stride.slid)
            continue
        behind.append(stride)
        if not part.prepared.model.axisymmetric:
            _refuse_turned(part, behind[first:])
        if now is rest:
            end = [walk.arrived(stride)] if part.prepared.frames else []
            return _finished(part, [*behind[first:], *end])
        rest = rest.rest(now, stride.followed.after)
        wanted = length * min(_GROWTH, 1.0 / max(stride.slid, 1.0 / _GROWTH))
        share = 1.0 / max(1, ceil((rest.interval.high - rest.interval.low) / wanted - 1e-9))


def _refuse_turned(part: StepPart, strides: list[Stride]) -> None:
    """A body that may not turn has not turned far in the last of the strides."""
    try:
        refuse_turned(part.prepared, strides[-1].followed.after, part.where)
    except SolveFailed as stop:
        raise keep(stop, [done.followed for done in strides]) from None


def _finished(part: StepPart, strides: list[Stride]) -> FollowedPart:
    """All strides as one; the state at the end refers to the pairs before anything moved, as that before does."""
    followed, changed = joined([stride.followed for stride in strides]), max(stride.changed for stride in strides)
    nominal, frames, last = part.prepared.interface, part.prepared.frames, strides[-1]
    own = sliding_pairs(part.prepared.model, nominal)
    back = spun(last.prepared.interface, frames, np.zeros_like(last.middle), last.middle)
    forces = np.where(own, turned(followed.after.forces, back, nominal), followed.after.forces)
    after = replace(followed.after, point=replace(followed.after.point, gap=part.end.gap), forces=forces)
    notes = followed.notes
    if changed > _SAID_FROM:
        words = f"pairs followed the bodies in {len(strides)} strides; handing over changed forces by {changed:.1e}"
        notes = (*notes, f"{words} of the largest at most")
    return replace(followed, after=after, notes=notes, turned_at=last.middle if frames else np.zeros(0))


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
    solver: ContactSolver = CondensedSolver.of(condensed, interface, prepared.scale, prepared.settings)
    if isinstance(prepared.solver, PlasticSolver):
        solver = prepared.solver.paired(solver, interface)
    wearing = None if prepared.wearing is None else worn_sides(prepared.space, prepared.model, interface)
    return replace(prepared, interface=interface, solver=solver, wearing=wearing)


def _slid(prepared: Prepared, begin: State, end: State, own: BoolArray) -> float:
    """The longest way, length, of sliding pairs that touch at the beginning or the end; of all where none does."""
    way = np.linalg.norm(prepared.interface.motion(end.displacement - begin.displacement)[1:], axis=0)
    touch = own & ((begin.status != OPEN) | (end.status != OPEN))
    return float(way[touch if touch.any() else own].max(initial=0.0))


def stride_of(prepared: Prepared) -> float:
    """How far sides slide at most before pairs are made anew, length."""
    return _STRIDE * shortest_facet(prepared)


def shortest_facet(prepared: Prepared) -> float:
    """Of all contacts that slide far, length."""
    lengths = []
    for i, contact in enumerate(prepared.model.contacts):
        if contact.slides:
            sides = contact.meshed_sides(prepared.model.mesh)
            lengths += [float(boundary(prepared.space, side, ("contact", i)).lengths.min()) for side in sides]
    return min(lengths)
