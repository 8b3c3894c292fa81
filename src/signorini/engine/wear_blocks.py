# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of cycles, implicit in what a cycle rubs: the last of N cycles, on the sides as they are worn at its end.

With x(d) what a cycle rubs on sides worn by d, a block of N cycles ends at ``d = d_0 + N k x(d)``: backward Euler, of
first order in N. Explicit blocks ``d = d_0 + N k x(d_0)`` oscillate as soon as N k times the distance slid is more
than twice what the bodies give under a pressure that alternates from node to node; implicit ones never do.

The equation is solved by a few cycles. The pressures of one are corrected by those that its end has on sides worn as
they say: with p the normal forces there, s the distance slid in a cycle and friction as it was, that is a linear
complementarity problem with N k s added to the diagonal of the normal compliance,

    0 <= p  _|_  (A + N k s) p + q >= 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.rubbing import Rubbing, worn
from signorini.engine.wear_paths import PathCycle, WornPaths
from signorini.interface.worn_sides import WornSides

_SETTLED = 1e-5  # of what the most worn pair loses in a block: how well the equation of a block is solved
_CYCLES = 40  # tried for one block: three to six are usual
_LEAST_SHARE = 0.1  # of a correction: halved where the last one has brought nothing
_SET_CHANGES = 100  # of the pairs that press, in one correction
_GIVES = 1e-12  # of the compliance: what keeps rigid motions that no normal force feels out of the equations


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleBlock:
    """A block of cycles that was solved.

    Attributes
    ----------
    count : of cycles
    moved : before its last cycle, sides worn as at its end
    done : at its end
    rubs : (n,) what every cycle is worn by, see `Rubbing`
    tries : cycles that were followed to find it
    last : cycles that its last one stands for, of a block that was solved in parts
    """

    count: int
    last: int
    moved: PathCycle
    done: PathCycle
    rubs: Array
    tries: int


def implicit_block(paths: WornPaths, at: PathCycle, last: int, count: int, guess: Array) -> CycleBlock | None:
    """A block of cycles that ends with a cycle; None where it is not found.

    Parameters
    ----------
    paths, at : the cycles, and where the step stands before the block
    last : number of its last cycle
    count : of cycles
    guess : (n,) what a cycle rubs
    """
    sides, rubs, error, share = paths.sides, guess, np.inf, 1.0
    for tries in range(1, _CYCLES + 1):
        wear = worn(sides, replace(at.wear, loose=at.wear.loose + count * (sides.volume @ rubs)), cycles=count)
        moved = paths.worn(at, wear)
        found = None if moved is None else paths.cycle(moved, last)
        if moved is None or found is None:
            return None
        done, rubbing = found
        grown = sides.rate * rubbing.wearing
        last_error, error = error, float(np.abs(grown - sides.rate * rubs).max())
        if error <= _SETTLED * grown.max():
            done = _repeated(sides, moved, done, rubbing, rubs, count)
            return CycleBlock(count=count, last=count, moved=moved, done=done, rubs=rubbing.wearing, tries=tries)
        share = 0.5 * share if error > last_error and share > _LEAST_SHARE else share
        rubs = rubs + share * (_corrected(paths, done, rubbing, rubs, count) - rubs)
    return None


def _repeated(
    sides: WornSides, moved: PathCycle, done: PathCycle, rubbing: Rubbing, rubs: Array, count: int
) -> PathCycle:
    """The end of a block whose last cycle stands for all of them."""
    others = count - 1
    dissipation = done.now.dissipation + others * (done.now.dissipation - moved.now.dissipation)
    wear = replace(
        done.wear,
        distance=done.wear.distance + others * rubbing.distance,
        loose=done.wear.loose + others * rubbing.volume - count * (sides.volume @ rubs),
    )
    return replace(
        done,
        now=replace(done.now, dissipation=dissipation),
        wear=wear,
        spent=done.spent + others * (done.spent - moved.spent),
    )


def _corrected(paths: WornPaths, done: PathCycle, rubbing: Rubbing, rubs: Array, count: int) -> Array:
    """(n,) What a cycle rubs on sides that are worn by it, from a cycle on sides worn by ``rubs``."""
    law, condensed, sides = paths.prepared.paths.law, paths.prepared.paths.condensed, paths.sides
    a, active = law.pairs, condensed.active
    root, area = condensed.root, paths.prepared.interface.area[active]
    h, p = done.now.h[0], done.now.r[0]
    slope = np.where(sides.by_energy[active], law.mu, 1.0) * rubbing.travel[active] * root / area
    grows = count * sides.rate[active] * root
    A = law.image.A[:a, :a]
    softer = np.array(A)
    softer[np.diag_indices(a)] += grows * slope
    q = h - softer @ p + grows * (rubbing.wearing - rubs)[active]
    pressed = _pressed(softer, q, law.image.R[:a], p)
    found = np.array(rubbing.wearing)
    found[active] = np.maximum(found[active] + slope * (pressed - p), 0.0)
    return found


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
