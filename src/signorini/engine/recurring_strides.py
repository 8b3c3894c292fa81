# SPDX-License-Identifier: BSD-3-Clause
"""Strides that recur in every cycle: their pairs, the compliance that these see, and the way to the next.

Positions come back in every cycle, but for what bodies strain; so pairs, B, and the condensed compliance ``B C B^T`` of
a stride are those of the cycle before, and only gaps change, by what is worn. Between two strides a displacement of
the bodies is seen by other pairs: ``B u = B C B_last^T r + ...``, a product of matrices of the size of the interface,
and ``(B_last - B)^T r`` fades away, see `engine.handing_over`; forces that grow are those that were recorded.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.condense.response import ByNodes
from signorini.engine.handing_over import supported
from signorini.engine.increments import applied, free_load, moved_by_supports
from signorini.engine.prepare import Prepared
from signorini.engine.sliding import Stride
from signorini.friction.history import PathState
from signorini.interface.worn_sides import WornSides
from signorini.law.states import OPEN, STICK
from signorini.solution.state import LoadPoint


@dataclass(frozen=True, kw_only=True, eq=False)
class StridePairs:
    """The a active pairs between two strides, in units of the problem.

    Attributes
    ----------
    r : (d, a) forces, normal and tangential
    ways : (k,) of the bodies along rigid motions
    gap : (a,) length
    tangential, slip : (d - 1, a) length
    status : (a,) codes of the law
    dissipation : (a,) energy
    """

    r: Array
    ways: Array
    gap: Array
    tangential: Array
    slip: Array
    status: IntArray
    dissipation: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Track:
    """A stride that recurs.

    Attributes
    ----------
    prepared : with its pairs, and the sides as these see them
    points : of the loads at its ends, the last with what has grown; gaps without wear
    grown : (dofs,) forces that have
    tangential : (d - 1, a) tangential displacement of the bodies at its end, as it was recorded
    X : (d a, d a) motions of the pairs over forces, length per force
    N : (d a, k) over rigid motions
    free : (2, d a) motions under the loads at its ends, and what supports impose
    resultants : (2, k) of the loads
    """

    prepared: Prepared
    points: tuple[LoadPoint, LoadPoint]
    grown: Array
    tangential: Array
    X: Array
    N: Array
    free: Array
    resultants: Array
    inverses: dict[tuple[float, bytes], Array] = field(default_factory=dict)

    @staticmethod
    def of(stride: Stride) -> Track:
        """What a stride that was followed leaves to those after it."""
        prepared, before, end = stride.prepared, stride.part.before.point, stride.part.end
        condensed = prepared.paths.condensed
        own = np.where(np.isnan(stride.gaps), 0.0, stride.gaps)
        if stride.growing.any():
            end = supported(end, len(stride.growing))
            end = replace(end, reaction=end.reaction + stride.growing)
        points = replace(before, gap=own[0]), replace(end, gap=own[1])
        free, resultants = [], []
        for point in points:
            load = condensed.reduce(free_load(prepared, point)).load
            imposed = moved_by_supports(prepared, applied(prepared, point)[1])[:, condensed.active]
            free.append(condensed.response.moved(load) + imposed.ravel())
            resultants.append(condensed.response.resultant(load))
        X = condensed.response.compliance()
        X[np.diag_indices_from(X)] += condensed.compliance.ravel()
        return Track(
            prepared=prepared,
            points=points,
            grown=stride.growing,
            tangential=stride.followed.after.tangential[:, condensed.active],
            X=X,
            N=condensed.response.motions,
            free=np.array(free),
            resultants=np.array(resultants),
        )

    @property
    def sides(self) -> WornSides:
        """As its pairs see them."""
        assert self.prepared.wearing is not None
        return self.prepared.wearing

    @cached_property
    def gaps(self) -> Array:
        """(2, a) Between sides that are not worn, at its ends."""
        return np.array([point.gap[self.prepared.paths.active] for point in self.points])

    @cached_property
    def seen(self) -> Array:
        """(a, m) What pairs feel of worn depths."""
        return self.sides.gap.toarray()[self.prepared.paths.active]

    @cached_property
    def wears(self) -> Array:
        """(m, a) Volume at the corners over what pairs rub, of normal force times distance or of energy."""
        active = self.prepared.paths.active
        return self.sides.volume.toarray()[:, active] / self.prepared.interface.area[active]

    def wearing(self, pressed: Array, taken: Array) -> Array:
        """(a,) What wears pairs, of normal force times distance, and of energy that friction takes."""
        return np.where(self.sides.by_energy[self.prepared.paths.active], taken, pressed)

    @cached_property
    def friction(self) -> Array:
        """(a,) Coulomb's coefficient."""
        return self.prepared.paths.law.pieces.slopes[0]

    @cached_property
    def loads(self) -> Array:
        """(2, d a) b of the law at its ends, between sides that touch nowhere."""
        condensed, found = self.prepared.paths.condensed, []
        for point in self.points:
            load = condensed.reduce(free_load(self.prepared, point)).load
            offset = moved_by_supports(self.prepared, applied(self.prepared, point)[1])[:, condensed.active]
            found.append(condensed.right_hand_side(load, offset))
        return np.array(found)

    def sliding(self, sign: float) -> tuple[Array, Array]:
        """As of `_with_friction`, of pairs of the plane that slip, friction along ``sign``."""
        return self._sliding_plus if sign > 0.0 else self._sliding_minus

    @cached_property
    def _sliding_plus(self) -> tuple[Array, Array]:
        return self._with_friction(self.friction[None])

    @cached_property
    def _sliding_minus(self) -> tuple[Array, Array]:
        return self._with_friction(-self.friction[None])

    def _with_friction(self, f: Array) -> tuple[Array, Array]:
        """(d a, a) Motions, and (k, a) resultants, over normal forces of pairs with friction (d - 1, a) over these."""
        d, a = len(f) + 1, f.shape[1]
        moves = self.X[:, :a] + (self.X[:, a:].reshape(d * a, d - 1, a) * f).sum(axis=1)
        resists = self.N[:a] + (f[..., None] * self.N[a:].reshape(d - 1, a, -1)).sum(axis=0)
        return moves, resists.T

    def inverse(self, sign: float, closed: IntArray) -> Array:
        """Of the system of closed pairs of the plane that slip and rigid motions, kept for the cycles that come."""
        key = sign, closed.tobytes()
        found = self.inverses.get(key)
        if found is None:
            found = self.inverses[key] = self._inverse(self.sliding(sign), closed)
        return found

    def _inverse(self, sliding: tuple[Array, Array], closed: IntArray) -> Array:
        (moves, resists), c, k = sliding, len(closed), self.N.shape[1]
        system = np.zeros((c + k, c + k))
        system[:c, :c] = moves[np.ix_(closed, closed)]
        system[:c, c:], system[c:, :c] = self.N[closed], resists[:, closed]
        return np.linalg.inv(system)

    def stiffness(self, pairs: StridePairs, closed: IntArray) -> Array | None:
        """(c, c) Normal forces of closed pairs over their gaps where friction goes on as it is; None where none slips.

        Parameters
        ----------
        pairs : at the end of the stride
        closed : numbers of those that touch, all with friction
        """
        size = np.linalg.norm(pairs.r[1:], axis=0)
        slips = (pairs.status > STICK) & (size > 0.0)
        if not slips.any():
            return None
        ways = np.divide(pairs.r[1:], size, out=np.zeros_like(pairs.r[1:]), where=slips)
        if len(ways) == 1:
            found = self.inverse(1.0 if ways.sum() >= 0.0 else -1.0, closed)
        else:
            found = self._inverse(self._with_friction(self.friction * ways), closed)
        return found[: len(closed), : len(closed)]

    def pairs(self, now: PathState, gap: Array, at: int) -> StridePairs:
        """A state of the path in units of the problem.

        Parameters
        ----------
        now : the state
        gap : (a,) between which its pairs are
        at : whether it is at the beginning of the stride or its end, 0 or 1
        """
        root = self.prepared.paths.condensed.root
        h, r = now.h / root, now.r * root
        beyond = h.ravel() - self.X @ r.ravel() - self.free[at]
        beyond[: len(gap)] -= gap
        return StridePairs(
            r=r,
            ways=np.linalg.lstsq(self.N, beyond, rcond=None)[0] if self.N.shape[1] else np.zeros(0),
            gap=h[0],
            tangential=h[1:],
            slip=now.slip / root,
            status=now.state,
            dissipation=now.dissipation,
        )

    def state(self, pairs: StridePairs, gap: Array, at: int, fading: Array | None = None) -> PathState:
        """The state of the path that pairs are in, in the scaled units of the law.

        Parameters
        ----------
        pairs : the pairs
        gap, at : as of `pairs`
        fading : (m,) condensed forces that act beside the loads
        """
        condensed = self.prepared.paths.condensed
        b = self.loads[at] + condensed.of_gaps(gap)
        if fading is not None:
            b = b + condensed.right_hand_side(fading, np.zeros_like(pairs.r))
        h = condensed.root * np.concatenate([pairs.gap[None], pairs.tangential])
        return PathState(
            b=b,
            h=h,
            r=pairs.r / condensed.root,
            state=pairs.status,
            anchor=h[1:],
            slip=condensed.root * pairs.slip,
            dissipation=pairs.dissipation,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Link:
    """From the end of a stride to the beginning of the next.

    Attributes
    ----------
    last, next : the strides
    across : (d a, d a) motions of the next one's pairs over forces of the last one's
    free : (d a,) motions of the last one's pairs under the loads at the end of the next
    first : (d a,) motions of the next one's pairs under the loads at the end of the last
    left : (m,) condensed forces that have grown in the last one
    grown : the work of forces that fade and that grow in the next one
    """

    last: Track
    next: Track
    across: Array
    free: Array
    first: Array
    left: Array
    grown: _GrownWork

    @staticmethod
    def between(last: Track, track: Track) -> Link | None:
        """From one stride to the other; None where other pairs are active."""
        one, two = last.prepared.paths.condensed, track.prepared.paths.condensed
        if not np.array_equal(one.active, two.active) or not np.array_equal(one.dofs, two.dofs):
            return None
        assert isinstance(one.response, ByNodes)
        moved = one.response.parts.solve(one.B.T.toarray())
        begin, end = last.points[1], track.points[1]
        imposed = [applied(last.prepared, point)[1] for point in (begin, end)]
        loads = [one.reduce(free_load(last.prepared, point)).load for point in (begin, end)]
        by_supports = [
            moved_by_supports(of.prepared, at)[:, one.active] for of, at in zip((track, last), imposed, strict=True)
        ]
        transform = last.prepared.constraints.transform
        return Link(
            last=last,
            next=track,
            across=np.asarray(two.B @ moved),
            free=one.response.moved(loads[1]) + by_supports[1].ravel(),
            first=two.response.moved(loads[0]) + by_supports[0].ravel(),
            left=one.reduce(transform.T @ last.grown).load,
            grown=_GrownWork.of(last, track, loads[1] - loads[0], imposed[1] - imposed[0]),
        )

    def begun(self, now: StridePairs) -> tuple[StridePairs, Array, Array]:
        """The next one's pairs as the bodies are, (a,) between which gaps, and (m,) what fades away, condensed."""
        a, one, two = len(now.gap), self.last.prepared.paths.condensed, self.next.prepared.paths.condensed
        moved = self.across @ now.r.ravel() + self.first + self.next.N @ now.ways
        moved = moved + two.compliance.ravel() * now.r.ravel()
        fading = np.asarray((one.B - two.B).T @ now.r.ravel()) + self.left
        return replace(now, tangential=moved[a:].reshape(now.tangential.shape)), now.gap - moved[:a], fading

    def freed(self, old: StridePairs, new: StridePairs, opened: Array, pressing: Array) -> float:
        """What the change of pairs sets free in the next stride.

        Parameters
        ----------
        old, new : the pairs before, of the last stride, and behind, of the next
        opened : (a,) what gaps have grown by in it, length
        pressing : (a,) normal forces, in the mean of it
        """
        last, track, r0, r1 = self.last, self.next, old.r.ravel(), new.r.ravel()
        soft = [of.prepared.paths.condensed.compliance.ravel() for of in (last, track)]
        by_last = self.across.T @ r1 + self.free + last.N @ new.ways
        by_last -= last.X @ r0 - soft[0] * r0 + last.free[1] + last.N @ old.ways
        by_next = track.X @ r1 - soft[1] * r1 + track.free[1] + track.N @ new.ways
        by_next -= self.across @ r0 + self.first + track.N @ old.ways
        return float(pressing @ opened - 0.5 * r0 @ (by_last - by_next)) - self.grown.between(old, new)


@dataclass(frozen=True, kw_only=True, eq=False)
class _GrownWork:
    """The work of forces that grow in a stride, and of those that have grown in the last one and fade.

    Attributes
    ----------
    before, behind : (d a,) over forces of pairs before and behind it
    ways : (k,) over rigid motions
    loads : of what loads and supports move
    """

    before: Array
    behind: Array
    ways: Array
    loads: float

    @staticmethod
    def of(last: Track, track: Track, loads: Array, imposed: Array) -> _GrownWork:
        """In one stride after the other.

        Parameters
        ----------
        last, track : the strides
        loads : (m,) condensed, that are added
        imposed : (dofs,) displacements that are
        """
        one, two = last.prepared.paths.condensed, track.prepared.paths.condensed
        assert isinstance(one.response, ByNodes)
        mean = 0.5 * (last.grown + track.grown)
        forces = one.reduce(last.prepared.constraints.transform.T @ mean).load
        moved = one.response.parts.solve(forces)
        return _GrownWork(
            before=one.B @ moved,
            behind=two.B @ moved,
            ways=one.response.rigid.T @ forces,
            loads=float(moved @ loads + mean @ imposed),
        )

    def between(self, old: StridePairs, new: StridePairs) -> float:
        """From one state to another."""
        by_pairs = self.behind @ new.r.ravel() - self.before @ old.r.ravel()
        return float(by_pairs + self.ways @ (new.ways - old.ways)) + self.loads


def closed_of(pairs: StridePairs) -> IntArray:
    """Numbers of the pairs that touch."""
    return np.flatnonzero(pairs.status != OPEN)
