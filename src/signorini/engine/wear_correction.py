# SPDX-License-Identifier: BSD-3-Clause
"""What a cycle would rub on sides that are worn further, from a cycle that was followed: Newton's step of a block.

What sides lose takes normal force from where they lose it, and there they slide farther: with a change dp of the
normal forces, the same throughout the cycle, what a pair rubs changes by ``s dp + p ds``, s the distance slid. The
first part is known from the cycle. For the second the tangential problem is gone through again from turn to turn of
the load: where pairs slip at a turn friction has changed with dp, where they stick they are where they were at the
turn before. With D the derivative of what is rubbed, N cycles and k depth over wear that is a linear complementarity
problem for the normal forces at the end of the cycle,

    0 <= p  _|_  (A + N k D) p + q >= 0.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.engine.wear_paths import FollowedCycle, WornPaths
from signorini.friction.history import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, STICK

_SET_CHANGES = 100  # of the pairs that press, in one correction
_HELD = 0.1  # of a rigid motion: how much of it is along tangents where these hold it
_GIVES = 1e-12  # of the compliance: what keeps rigid motions that no force feels out of the equations


def corrected(paths: WornPaths, cycle: FollowedCycle, worn: Array, count: int) -> Array:
    """(n,) What every one of N cycles rubs, on sides that all of them have worn.

    Parameters
    ----------
    paths, cycle : a cycle as it was followed
    worn : (n,) what has rubbed the sides that it was followed on since the first of them
    count : N
    """
    law, condensed, sides = paths.prepared.paths.law, paths.prepared.paths.condensed, paths.sides
    a, active = law.pairs, condensed.active
    root, area = condensed.root, paths.prepared.interface.area[active]
    h, p = cycle.after.now.h[0], cycle.after.now.r[0]
    travel, wearing = cycle.rubbing.travel[active], cycle.rubbing.wearing[active]
    grows = count * sides.rate[active] * root
    pressure = np.divide(wearing, travel, out=np.zeros(a), where=travel > 0.0)
    change = (pressure / root)[:, None] * _travel_change(law, cycle.turns)
    change[np.diag_indices(a)] += np.where(sides.by_energy[active], law.mu, 1.0) * travel * root / area
    softer = law.image.A[:a, :a] + grows[:, None] * change
    q = h - softer @ p + sides.rate[active] * root * (count * wearing - worn[active])
    pressed = _pressed(softer, q, law.image.R[:a], p)
    found = np.array(cycle.rubbing.wearing)
    found[active] = np.maximum(wearing + change @ (pressed - p), 0.0)
    return found


def _travel_change(law: ContactProblem, turns: tuple[PathState, ...]) -> Array:
    """(a, a) What a change of normal forces, the same throughout a cycle, adds to the distance slid in it, scaled."""
    a, last = law.pairs, turns[0]
    total, before = np.zeros((a, a)), _tangential_change(law, last, np.zeros((len(last.anchor) * a, a)))
    for turn in turns[1:]:
        after = _tangential_change(law, turn, before)
        slid = turn.h[1:] - last.h[1:]
        length = np.linalg.norm(slid, axis=0)
        touched = (last.state != OPEN) & (turn.state > STICK)
        way = np.divide(slid, length, out=np.zeros_like(slid), where=(length > 0.0) & touched)
        total += np.einsum("tk,tkl->kl", way, (after - before).reshape(-1, a, a))
        last, before = turn, after
    return total


def _tangential_change(law: ContactProblem, turn: PathState, held: Array) -> Array:
    """((d - 1) a, a) What a change of normal forces moves pairs by along each other, at a turn of the load.

    Parameters
    ----------
    law : of the a pairs
    turn : the state there
    held : ((d - 1) a, a) what pairs that stick have been moved by
    """
    a, t = law.pairs, len(turn.anchor)
    size = np.linalg.norm(turn.r[1:], axis=0)
    way = np.divide(turn.r[1:], size, out=np.zeros_like(turn.r[1:]), where=(size > 0.0) & (turn.state > STICK))
    slips = np.zeros((t, a, a))
    slips[:, np.arange(a), np.arange(a)] = way * law.bound.tangent(turn.r[0])[0]
    forces = slips.reshape(t * a, a)
    A, K = law.image.A[a:, a:], np.flatnonzero(np.tile(turn.state == STICK, t))
    R: Array = law.image.R[a:] @ _along(law.image.R, a + K)
    system = np.block([[A[np.ix_(K, K)], R[K]], [R[K].T, np.zeros((R.shape[1], R.shape[1]))]])
    found = np.linalg.solve(system, np.vstack([held[K] - A[K] @ forces, -R.T @ forces]))
    forces[K] += found[: len(K)]
    moved: Array = A @ forces + R @ found[len(K) :]
    return np.where(np.tile(turn.state == OPEN, t)[:, None], 0.0, moved)


def _along(R: Array, rows: IntArray) -> Array:
    """(k, j) Combinations of rigid motions R that rows of tangents hold; others are held along normals, or by none."""
    if not len(rows) or not R.shape[1]:
        return np.zeros((R.shape[1], 0))
    _, size, ways = np.linalg.svd(R[rows], full_matrices=False)
    held: Array = ways[size > _HELD * np.linalg.norm(R, axis=0).max()].T
    return held


def _pressed(M: Array, q: Array, R: Array, p: Array) -> Array:
    """(a,) Normal forces ``x >= 0`` with ``M x + q + R a >= 0``, complementary, and the resultants ``R^T x = R^T p``.

    By Newton's method on the set of pairs that press.

    Parameters
    ----------
    M, q : (a, a) and (a,)
    R : (a, k) rigid motions of the pairs along their normals
    p : (a,) forces with these resultants
    """
    k, closed = R.shape[1], p > 0.0
    for _ in range(_SET_CHANGES):
        S = np.flatnonzero(closed)
        system = np.block([[M[np.ix_(S, S)], R[S]], [R[S].T, -_GIVES * np.eye(k)]])
        found = np.linalg.solve(system, np.concatenate([-q[S], R.T @ p]))
        x = np.zeros_like(q)
        x[S] = found[: len(S)]
        gap = M @ x + q + R @ found[len(S) :]
        now = np.where(closed, x > 0.0, gap < 0.0)
        if np.array_equal(now, closed):
            break
        closed = now
    return np.maximum(x, 0.0)
