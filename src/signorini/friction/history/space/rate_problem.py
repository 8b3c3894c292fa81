# SPDX-License-Identifier: BSD-3-Clause
"""What pairs may do next in space, as a linear complementarity problem among those that are not inside their state.

Most pairs are inside their state and stay there for a while. The others are at a corner (gap and normal force vanish),
or have used up their friction, on one facet of their section or on two, at a corner of it. With nu_j the normals of
those facets, c_j their distance from the origin in a section of size 1 and F the bound of friction (see
`law.bound`) the law of the rates is::

    h_t' = - sum_j lambda_j nu_j,   0 <= lambda_j  _|_  c_j F' - nu_j . r_t' >= 0      on every facet
    0 <= gap'  _|_  p' >= 0                                                            at a corner

F' is the slope of F times p'; at a kink of F, where the slope falls from s to s', ``F' = s' p' - (s - s') k`` with
``0 <= k  _|_  p' + k >= 0``. A pair at a corner touches all facets. On a smooth section the one facet is its tangent:
to first order friction turns freely along it; at a corner the rates of a pair obey Coulomb's law itself, see
`smooth_cones`. The forces are linear in these motions, from those while all pairs hold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.history.rates import widths_of_zero
from signorini.friction.history.space.sticking_response import StickingResponse
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.states import SLIP

FACET, GAP, KINK, CONE = 0, 1, 2, 3
"""Kinds of complementary numbers; CONE: one of three rows of a pair in Coulomb's law."""

_CANCELLED = 1e-12  # of the terms of a coefficient: what is left of them is rounding


@dataclass(frozen=True, kw_only=True, eq=False)
class PairSituation:
    """Where pairs stand at a state.

    Attributes
    ----------
    corner : (n,) gap and normal force vanish
    closed : (n,) pressed, or at a corner
    rubs : (n,) closed, with friction
    kink : (n,) pressed, with a bound on friction that has a kink here
    below, above : (n,) slope of the bound for falling and growing normal forces
    smooth : (n,) at a corner, with a smooth section: rates obey Coulomb's law
    lawless : (n,) no law of the rates is known: at a corner with a smooth section and dragged by supports, or dragged
        along one tangent, or in Tresca's law
    widths : (n,) of zero for a gap, a force or the friction to spare
    """

    corner: BoolArray
    closed: BoolArray
    rubs: BoolArray
    kink: BoolArray
    below: Array
    above: Array
    smooth: BoolArray
    lawless: BoolArray
    widths: Array

    @classmethod
    def at(cls, problem: ContactProblem, now: PathState, width: float, opened: BoolArray) -> PairSituation:
        """Pairs of a problem at a state now, with a width of zero; those ``opened`` (n,) are taken to open."""
        n, bound, law = problem.pairs, problem.pieces, problem.law
        widths = widths_of_zero(problem, width)
        gap, p = now.h[0], now.r[0]
        corner = (gap <= widths) & (p <= widths) & ~opened
        closed = (corner | (p > widths)) & ~opened
        rubs = closed & ((bound.slopes[0] > 0) | (bound.starts[0] > 0))
        smooth = corner & rubs & (problem.section.sides == 0) & (problem.section.axes > 0).all(axis=0)
        dragged = (problem.locked & ~problem.still).any(axis=0) & ~law.dragged
        branch = bound.branch(np.where(corner, 0.0, p))
        slope = bound.slopes[branch, np.arange(n)]
        below, above, kink = slope, slope, np.zeros(n, dtype=np.bool_)
        for j in range(1, bound.branches):
            near = closed & ~corner & (np.abs(p - bound.kinks[j]) <= widths)
            below, above = np.where(near, bound.slopes[j - 1], below), np.where(near, bound.slopes[j], above)
            kink |= near
        return cls(
            corner=corner,
            closed=closed,
            rubs=rubs,
            kink=kink,
            below=below,
            above=above,
            smooth=smooth & ~law.dragged,
            lawless=(smooth & law.dragged) | (rubs & dragged) | problem.bounded,
            widths=widths,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class RateProblem:
    """``0 <= z  _|_  M z + q >= 0`` for the motions z of pairs that are not inside their state, Coulomb's law for some.

    Attributes
    ----------
    held : the interface while all of them hold
    standing : where the pairs stand
    kind, pair : (N,) FACET (z is a slip rate), GAP (an opening rate), KINK or CONE (at last; z is an opening rate, or
        one along a tangent), and the pair
    normal : (2, N) of facets
    friction : (2, m) half-axes of the sections of the m pairs in Coulomb's law, for a normal force of 1
    motion : (c, N) of the held rows
    M, q : (N, N) and (N,)
    size : of the terms that q is the sum of: what is left where they cancel is as sure as they are
    acting : pairs that may not go on as they are: at a corner, sticking without friction to spare, slipping at a corner
        of their section or into a kink
    """

    held: StickingResponse
    standing: PairSituation
    kind: IntArray
    pair: IntArray
    normal: Array
    friction: Array
    motion: Array
    M: Array
    q: Array
    size: float
    acting: tuple[int, ...]

    @classmethod
    def at(
        cls, problem: ContactProblem, now: PathState, width: float, *, opened: BoolArray | None = None
    ) -> RateProblem | str:
        """The choice at a state under a load rate, the b of the problem; why there is none, in words.

        Parameters
        ----------
        problem : its b is the rate of the load
        now : the state
        width : of zero for a gap, a force or the friction to spare
        opened : (n,) pairs at a corner that open, whatever they would do; none where not given
        """
        n = problem.pairs
        standing = PairSituation.at(problem, now, width, np.zeros(n, dtype=np.bool_) if opened is None else opened)
        if standing.lawless.any():
            return f"the rates of pairs {np.flatnonzero(standing.lawless).tolist()} obey no law that is known here"
        held = StickingResponse.of(problem, standing.closed, standing.rubs)
        if held is None:
            return "the state in which all pairs hold is singular"
        pair, normal, reach = _facets(problem, standing, now)
        kinks = np.flatnonzero(standing.kink & np.isin(np.arange(n), pair))
        meets, cones = np.flatnonzero(standing.corner & ~standing.smooth), np.flatnonzero(standing.smooth)
        everyone = np.concatenate([pair, meets, kinks, cones, cones, cones])
        kind = np.repeat([FACET, GAP, KINK, CONE], [len(pair), len(meets), len(kinks), 3 * len(cones)])
        normals = np.concatenate([normal, np.zeros((2, len(everyone) - len(pair)))], axis=1)
        motion, asked = _rows(held, kind, everyone, normals, reach * standing.above[pair])
        answers = held.forces(motion)
        M, terms = asked @ answers, np.abs(asked) @ np.abs(answers)
        f, k = np.flatnonzero(kind == FACET), np.flatnonzero(kind == KINK)
        M[np.abs(M) <= _CANCELLED * terms] = 0.0
        drop = reach * (standing.below - standing.above)[pair]
        M[np.ix_(f, k)] -= np.where(pair[:, None] == kinks, drop[:, None], 0.0)
        M[k, k] += 1.0
        q, terms = asked @ held.force, np.abs(asked) @ np.abs(held.force)
        q[np.abs(q) <= _CANCELLED * terms] = 0.0
        count = np.bincount(pair, minlength=n)
        slips = now.state == SLIP
        acting = standing.corner | np.where(slips, (count > 1) | standing.kink, count > 0)
        return cls(
            held=held,
            standing=standing,
            kind=kind,
            pair=everyone,
            normal=normals,
            friction=problem.section.axes[:, cones] * standing.above[cones],
            motion=motion,
            M=M,
            q=q,
            size=float(terms.max(initial=0.0)),
            acting=tuple(int(k) for k in np.flatnonzero(acting)),
        )

    def numbers(self, k: int) -> IntArray:
        """The numbers of a pair."""
        return np.flatnonzero(self.pair == k)

    def rates(self, z: Array) -> tuple[Array, Array]:
        """Rates of motions and forces, each (3, n), of a z."""
        problem = self.held.problem
        dragged = np.flatnonzero(problem.law.dragged & self.standing.closed)
        h, r = self.held.whole(self.motion @ z)
        if len(dragged):
            most = problem.section.among(dragged).farthest(-problem.by_pair(problem.b)[1:, dragged])
            r[1:, dragged] = most * (self.standing.above * r[0])[dragged]
        return h, r


def _facets(problem: ContactProblem, standing: PairSituation, now: PathState) -> tuple[IntArray, Array, Array]:
    """Pairs, normals (2, m) and reaches (m,) of the facets that they may slip on."""
    force = now.r[1:]
    normals, reach = problem.section.facets(force)
    most = problem.bound.at(np.maximum(now.r[0], 0.0))
    spare = np.where(np.isfinite(reach), reach, 0.0) * most - (normals * force).sum(axis=1)
    spare = np.where(np.isfinite(reach), spare, np.inf)
    nearest = np.where(now.state == SLIP, spare.min(axis=0, initial=np.inf), 0.0)
    touched = standing.corner | (spare <= np.maximum(standing.widths, nearest * (1.0 + 1e-12)))
    touched &= standing.rubs & ~problem.law.dragged & ~standing.smooth
    side, pair = np.nonzero(touched & np.isfinite(reach))
    return pair, normals[side, :, pair].T, reach[side, pair]


def _rows(held: StickingResponse, kind: IntArray, pair: IntArray, normals: Array, share: Array) -> tuple[Array, Array]:
    """Motions of the held rows (c, N) of a unit of each number, and what its complement asks of their forces (N, c)."""
    n, rows = held.problem.pairs, len(held.rows)
    motion, asked = np.zeros((rows, len(kind))), np.zeros((len(kind), rows))
    f, g, k, c = (np.flatnonzero(kind == which) for which in (FACET, GAP, KINK, CONE))
    for axis in (1, 2):
        at = held.place[axis * n + pair[f]]
        has = at >= 0
        motion[at[has], f[has]] = asked[f[has], at[has]] = -normals[axis - 1, f[has]]
    asked[f, held.place[pair[f]]] = share
    motion[held.place[pair[g]], g] = asked[g, held.place[pair[g]]] = 1.0
    asked[k, held.place[pair[k]]] = 1.0
    of_cones = held.place[pair[c] + n * np.repeat(np.arange(3), len(c) // 3)]
    motion[of_cones, c] = asked[c, of_cones] = 1.0
    return motion, asked
