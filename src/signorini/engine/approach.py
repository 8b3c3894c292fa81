# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that nothing holds yet: loads carry them through the air until they touch, before anything else happens."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, extent
from signorini.engine.increments import applied, certified, moving_away
from signorini.engine.leg import Leg, Snapshot
from signorini.engine.prepare import Prepared
from signorini.engine.stretch import Stretch
from signorini.errors import SolveFailed
from signorini.fem.loads import nodal_volumes
from signorini.fem.rigid import describe_approach
from signorini.friction.answer import PULLED_AWAY
from signorini.friction.approach import approach
from signorini.friction.law import OPEN
from signorini.solution.state import State, next_state

DRIVES = 1e-11
"""Of all forces that change: their work along a rigid motion that they drive."""

_TOUCHES = 1e-10  # of the size of displacements: a gap
_ROUNDING = 1e-4  # of the largest gap: what counts as the size of displacements where gaps are far larger
_PRESSES = 1e-9  # of the size of forces: a force
_STIFF = 1e-9  # of the largest motion of pairs that press: one that they do not feel
_LIGHT = 1e-3  # of the volume of all bodies: what resists the motion of an obstacle or a node of no cell
_SEEN = 1e-9  # of the size of the model: a motion that anyone would want to know of


def approached(stretch: Stretch) -> Leg | None:
    """What happens before the loads of a stretch can press: bodies move rigidly until contact can bear the loads.

    Only motions that no contact feels that presses already, and along which the loads work, however small: nothing
    resists them, and they take no energy. None where there is no such motion.

    Raises
    ------
    SolveFailed
        Where such a motion has no end, and it is proved that the loads pull a body away, which is named.
    """
    prepared, state = stretch.prepared, stretch.before
    interface, n = prepared.interface, len(prepared.interface)
    floating, motions = prepared.floating, prepared.motions
    if not floating.shape[1] or not n:
        return None
    change = change_of_loads(stretch)
    work, enough = floating.T @ (motions.T @ change), DRIVES * float(np.abs(change).sum())
    if np.abs(work).max() <= enough:
        return None
    presses, apart, width = standing(prepared, state)
    if (state.gap[apart] < -width).any():  # overlaps press first
        return None
    moved = np.asarray((interface.B @ motions) @ floating)
    basis = unfelt(moved[np.concatenate([presses, np.tile(presses & interface.rubs, interface.directions - 1)])])
    basis = basis @ _alike(prepared, floating @ basis)
    if np.abs(basis.T @ work).max(initial=0.0) <= enough:
        return None
    grips = interface.adhesion[apart, None] > 0.0
    found = approach(
        moved[interface.rows(apart)] @ basis,
        np.maximum(state.gap[apart], 0.0),
        np.where(grips, np.inf, interface.coefficients[apart]),
        basis.T @ work,
        width=width,
    )
    if found is not None and found.escape is not None:
        share = float(work @ basis @ found.escape / np.linalg.norm(basis.T @ work) / np.linalg.norm(found.escape))
        raise _pulled_away(stretch, floating @ basis @ found.escape, share)
    if found is None or not found.motion.any():
        return None
    relative = moved @ (basis @ found.motion)
    relative[interface.rows(presses)] = 0.0
    relative[np.flatnonzero(apart)] = found.gap - state.gap[apart]
    return _leg(stretch, apart, floating @ basis @ found.motion, floating @ basis @ found.loose, relative)


def _pulled_away(stretch: Stretch, motion: Array, share: float) -> SolveFailed:
    """Loads pull bodies away along a motion of the parts, with a share of what they do on rigid motions."""
    said, moved = moving_away(stretch.prepared, motion)
    words = f"{stretch.where} at {100.0 * stretch.span.low:.6g}%: {said}: {PULLED_AWAY.format(margin=share)}"
    return SolveFailed(words, status="no_equilibrium", motion=moved)


def change_of_loads(stretch: Stretch) -> Array:
    """(dofs,) By how much nodal forces change in a stretch, those of contacts that are switched off with them."""
    prepared, begin, end = stretch.prepared, stretch.before.point, stretch.end
    loads = applied(prepared, end)[0] - applied(prepared, begin)[0]
    return np.asarray(loads + prepared.interface.B.T @ (end.given - begin.given))


def standing(prepared: Prepared, state: State) -> tuple[BoolArray, BoolArray, float]:
    """(n,) Pairs that press, (n,) those of the law that do not, and the largest gap of pairs that touch."""
    n = len(state.gap)
    there = ~prepared.absent & ~prepared.interface.tied & ~prepared.bodies.held
    presses = there & (state.forces[:n] > _PRESSES * prepared.scale.force)
    apart = there & ~presses
    size = max(prepared.scale.length, _ROUNDING * float(np.abs(state.gap[apart]).max(initial=0.0)))
    return presses, apart, _TOUCHES * size


def unfelt(felt: Array) -> Array:
    """(k, m) Orthonormal combinations of k motions that nothing feels; ``felt`` (rows, k) is what is felt of each."""
    k = felt.shape[1]
    _, values, vectors = np.linalg.svd(np.concatenate([felt, np.zeros((k, k))]), full_matrices=False)
    rank = int((values > _STIFF * values[0]).sum())
    return np.asarray(vectors[rank:].T)


def _alike(prepared: Prepared, motions: Array) -> Array:
    """(m, m) Combinations of motions (all parts, m) that bodies of one density resist alike, each on its own."""
    space, volumes = prepared.space, nodal_volumes(prepared.space, prepared.model)
    everything = float(volumes.sum())
    weights = np.full(space.number_of_dofs, _LIGHT * everything)
    weights[: space.mesh.points.size] = np.where(
        np.repeat(space.used, space.dimension),
        np.repeat(volumes, space.dimension),
        _LIGHT * everything,
    )
    resisted = motions.T @ (prepared.motions.T @ (weights[:, None] * (prepared.motions @ motions)))
    factor = np.linalg.cholesky(resisted / everything)
    return np.linalg.inv(factor).T


def _leg(stretch: Stretch, apart: BoolArray, motion: Array, loose: Array, relative: Array) -> Leg:
    """A rigid motion of the parts, with what of it the loads did not fix, as something that happens at once.

    Parameters
    ----------
    apart : (n,) pairs that do not press
    relative : (d n,) motions of the pairs
    """
    prepared, state, n = stretch.prepared, stretch.before, len(apart)
    interface = prepared.interface
    after = next_state(
        state,
        prepared.K,
        prepared.constraints,
        interface,
        point=state.point,
        loads=applied(prepared, state.point)[0],
        displacement=state.displacement + prepared.motions @ motion,
        forces=np.where(interface.rows(apart), 0.0, state.forces),
        moved=np.concatenate([state.gap + relative[:n], relative[n:]]),
        status=np.where(apart, OPEN, state.status),
    )
    notes = []
    if np.abs(motion).max() > _SEEN * float(extent(prepared.space.mesh.points).max()):
        where = f"{stretch.where} at {100.0 * stretch.span.low:.6g}%" if stretch.span.low else stretch.where
        notes = [f"{where}: {words}" for words in describe_approach(prepared.parts, motion, loose)]
    return Leg(
        path="exact",
        before=state,
        after=after,
        certificates=(certified(prepared, after, after.tangential, stretch.where),),
        trace=(),
        snapshots=(Snapshot(load_factor=stretch.span.factor(0.0), what="approach", state=after),),
        notes=tuple(notes),
    )
