# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that nothing holds: loads carry them until they touch; what nothing touches and no load drives, rests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.attempt import Spent
from signorini.engine.increments import applied, certified, moving_away
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart
from signorini.engine.tape import Leg
from signorini.errors import SolveFailed
from signorini.fem.loads import nodal_volumes
from signorini.fem.rigid import describe_approach
from signorini.friction.answer import PULLED_AWAY
from signorini.friction.approach import Approach, approach, relieved
from signorini.friction.history import Segment
from signorini.law.bound import ADHESION_SLOPE
from signorini.law.states import OPEN
from signorini.outcome import Outcome
from signorini.solution.state import State, next_state

DRIVES = 1e-11
"""Of all forces that change: their work along a rigid motion that they drive."""

_TOUCHES = 1e-10  # of the size of displacements: a gap
_LENGTH_PER_GAP = 1e-4  # of the largest gap: what counts as the size of displacements where gaps are far larger
_PRESSES = 1e-9  # of the size of forces: a force
_UNFELT = 1e-9  # of the largest motion of pairs that press: one that they do not feel
_BARE_VOLUME = 1e-3  # of the volume of all bodies: what resists the motion of an obstacle or a node of no cell
_FEELS = 1e-9  # of the largest motion of pairs: one that they feel
_SEEN = 1e-9  # of the size of the model: a motion that anyone would want to know of


def approached(part: StepPart, *, relieving: bool = False) -> FollowedPart | None:
    """What happens before the loads of a part can press: bodies move rigidly until contact can bear the loads.

    Only motions that no contact feels that presses already, and along which the loads work, however small, or out of
    overlaps: nothing resists them, and they take no energy. None where there is no such motion; a note without a
    snapshot where the search for it ended at its budget.

    Parameters
    ----------
    part : of a step
    relieving : whether bodies rise out of overlaps, too, which increments press from where they are

    Raises
    ------
    SolveFailed
        Where such a motion has no end, and it is proved that the loads pull a body away, which is named.
    """
    prepared, state = part.prepared, part.before
    interface = prepared.interface
    floating, rigid = prepared.floating, prepared.rigid
    if not floating.shape[1] or not len(interface):
        return None
    change = change_of_loads(part)
    work = floating.T @ prepared.constraints.resultants(rigid, change)
    enough = DRIVES * float(np.abs(change).sum())
    presses, apart, width = standing(prepared, state)
    overlaps = bool((state.gap[apart] < -width).any())
    if not (relieving if overlaps else np.abs(work).max() > enough):
        return None
    moved = np.asarray(interface.felt(rigid) @ floating)
    rubs = presses & interface.friction.rubs
    basis = unfelt(moved[np.concatenate([presses, *[rubs] * (interface.directions - 1)])])
    if basis.shape[1] > 1:  # of one motion alone nothing depends on what resists it
        basis = basis @ _alike(prepared, floating @ basis)
    P, gap = moved[interface.rows(apart)] @ basis, state.gap[apart]
    out = relieved(P[: len(gap)], gap, width=width) if overlaps else np.zeros(basis.shape[1])
    if out is None:  # overlaps press first
        return None
    gap = np.maximum(gap + P[: len(gap)] @ out, 0.0)
    found: Approach | Spent | None = Approach(motion=np.zeros_like(out), loose=np.zeros_like(out), gap=gap)
    if np.abs(basis.T @ work).max(initial=0.0) > enough:
        slope = interface.friction.steepest[apart]
        bound = np.where(slope >= ADHESION_SLOPE, np.inf, slope * interface.anisotropy[apart].T)
        found = approach(P, gap, bound, basis.T @ work, width=width)
    if isinstance(found, Spent):
        words = f"{part.where} at {100.0 * part.interval.low:.6g}%: {found}; bodies stay where they are"
        return FollowedPart(
            path="exact", before=state, after=state, certificates=(), trace=(), snapshots=(), notes=(words,)
        )
    if found is not None and found.escape is not None:
        share = float(work @ basis @ found.escape / np.linalg.norm(basis.T @ work) / np.linalg.norm(found.escape))
        raise _pulled_away(part, floating @ basis @ found.escape, share)
    if found is None or not (out + found.motion).any():
        return None
    motion = basis @ (out + found.motion)
    relative = np.where(presses, 0.0, (moved @ motion).reshape(state.forces.shape))
    relative[0, apart] = found.gap - state.gap[apart]
    return _approach(part, apart, floating @ motion, floating @ basis @ found.loose, relative)


def _pulled_away(part: StepPart, motion: Array, share: float) -> SolveFailed:
    """Loads pull bodies away along a motion of the parts, with a share of what they do on rigid motions."""
    said, moved = moving_away(part.prepared, motion)
    words = f"{part.where} at {100.0 * part.interval.low:.6g}%: {said}: {PULLED_AWAY.format(margin=share)}"
    return SolveFailed(words, status=Outcome.NO_EQUILIBRIUM, motion=moved)


def change_of_loads(part: StepPart) -> Array:
    """(dofs,) Change of the nodal forces in a part of a step, with those of contacts that are switched off."""
    prepared, begin, end = part.prepared, part.before.point, part.end
    change: Array = applied(prepared, end)[0] - applied(prepared, begin)[0] + prepared.pushed(end.given - begin.given)
    return change


def standing(prepared: Prepared, state: State) -> tuple[BoolArray, BoolArray, float]:
    """(n,) Pairs that press, (n,) those of the law that do not, and the largest gap of pairs that touch."""
    there = ~prepared.absent & ~prepared.interface.tied & ~prepared.solver.held
    presses = there & (state.forces[0] > _PRESSES * prepared.scale.force)
    apart = there & ~presses
    size = max(prepared.scale.length, _LENGTH_PER_GAP * float(np.abs(state.gap[apart]).max(initial=0.0)))
    return presses, apart, _TOUCHES * size


def unfelt(felt: Array) -> Array:
    """(k, m) Orthonormal combinations of k motions that nothing feels; ``felt`` (rows, k) is what is felt of each."""
    k = felt.shape[1]
    _, values, vectors = np.linalg.svd(np.concatenate([felt, np.zeros((k, k))]), full_matrices=False)
    rank = int((values > _UNFELT * values[0]).sum())
    return np.asarray(vectors[rank:].T)


def _alike(prepared: Prepared, motions: Array) -> Array:
    """(m, m) Combinations of motions (all parts, m) that bodies of one density resist alike, each on its own."""
    space, constraints, rigid = prepared.space, prepared.constraints, prepared.rigid
    weights, cells, everything = constraints.zeros, constraints.zeros, 0.0
    for nodes, volumes in nodal_volumes(space, prepared.model):
        dofs = space.dofs(nodes).ravel()
        weights = weights + constraints.spread(dofs, np.repeat(volumes, space.components))
        cells = cells + constraints.spread(dofs, np.ones(len(dofs)))
        everything += float(volumes.sum())
    weights = np.where(cells > 0.0, weights, _BARE_VOLUME * everything)
    work = [constraints.resultants(rigid, weights * constraints.carried(rigid, motion)) for motion in motions.T]
    resisted = motions.T @ np.column_stack(work)
    factor = np.linalg.cholesky(resisted / everything)
    return np.linalg.inv(factor).T


def _approach(part: StepPart, apart: BoolArray, motion: Array, loose: Array, relative: Array) -> FollowedPart:
    """A rigid motion of the parts, with what of it the loads did not fix, as something that happens at once.

    Parameters
    ----------
    apart : (n,) pairs that do not press
    relative : (d, n) motions of the pairs
    """
    prepared, state = part.prepared, part.before
    after = next_state(
        prepared,
        state,
        point=state.point,
        loads=applied(prepared, state.point)[0],
        displacement=state.nodal[0] + prepared.constraints.carried(prepared.rigid, motion),
        forces=np.where(apart, 0.0, state.forces),
        moved=np.concatenate([state.gap + relative[:1], relative[1:]]),
        status=np.where(apart, OPEN, state.status),
    )
    notes = []
    if np.abs(motion).max() > _SEEN * float(prepared.space.mesh.extent.max()):
        where = f"{part.where} at {100.0 * part.interval.low:.6g}%" if part.interval.low else part.where
        notes = [f"{where}: {words}" for words in describe_approach(prepared.parts, motion, loose)]
    return FollowedPart(
        path="exact",
        before=state,
        after=after,
        certificates=(certified(prepared, after, after.tangential, part.where),),
        trace=(),
        snapshots=(Snapshot(number=part.interval.number, fraction=part.interval.low, what="approach", state=after),),
        notes=tuple(notes),
        # of bodies that press elsewhere meanwhile derivatives know nothing
        legs=()
        if state.forces.any()
        else (Leg.at_once(prepared, part.where, state, after, part.interval.factor(0.0), carried=True),),
    )


def resting(part: StepPart) -> StepPart:
    """A part of a step in which bodies that nothing touches and no load drives do not move rigidly.

    Up to where something touches one: what holds it until then is no part of the model, and is woken from then on. The
    part as given where there is no such body, and where bodies are not condensed.
    """
    prepared, state = part.prepared, part.before
    if not prepared.floating.shape[1] or prepared.solver.paths is None:
        return part
    presses, apart, width = standing(prepared, state)
    touches = presses | (apart & (state.gap <= width))
    moved = np.asarray(prepared.interface.felt(prepared.rigid) @ prepared.floating)
    loose = unfelt(moved[prepared.interface.rows(touches)])
    change = change_of_loads(part)
    work = prepared.floating.T @ prepared.constraints.resultants(prepared.rigid, change)
    if not loose.shape[1] or np.abs(loose.T @ work).max() > DRIVES * float(np.abs(change).sum()):
        return part
    seen = np.abs(moved @ loose).max(axis=1) > _FEELS * float(np.abs(moved).max())
    ways, resting = unfelt(loose.T), prepared.floating @ loose
    constraints, rigid = prepared.constraints, prepared.rigid
    # least squares: rigid motions of unit size are so far from parallel that products of theirs lose no digits
    products = [constraints.resultants(rigid, constraints.carried(rigid, way)) for way in resting.T]
    moved = constraints.resultants(rigid, state.nodal[0] - applied(prepared, state.point)[1])
    place = resting @ np.linalg.solve(resting.T @ np.column_stack(products), resting.T @ moved)
    return replace(
        part,
        prepared=replace(
            prepared,
            solver=prepared.solver.moving(ways, prepared.interface, prepared.scale),
            floating=prepared.floating @ ways,
            resting=constraints.carried(rigid, place),
        ),
        awake=prepared,
        waiting=seen.reshape(-1, len(touches)).any(axis=0),
    )


def undisturbed(part: StepPart, segment: Segment) -> Segment:
    """The segment as far as nothing touches a body that rests."""
    waits = part.waiting[part.prepared.paths.active] if part.awake else np.zeros(0, np.bool_)
    for event in segment.events if part.awake else ():
        if event.what == "closes" and waits[list(event.pairs)].any():
            return replace(
                segment,
                end=replace(event.state, state=np.where(waits, OPEN, event.state.state)),
                events=tuple(earlier for earlier in segment.events if earlier.factor < event.factor),
                pieces=tuple(piece for piece in segment.pieces if piece.factor <= event.factor),
                outcome=Outcome.DISTURBED,
                jump=None,
                message=f"something touches a body that rests at factor {event.factor:.12g}",
            )
    return segment
