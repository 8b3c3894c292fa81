# SPDX-License-Identifier: BSD-3-Clause
"""Strides in which every pair that touches slips on: a linear complementarity problem in the normal forces alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.engine.recurring_strides import Link, StridePairs, closed_of
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS

_EVENTS = 100  # of a stride in which all pairs slip, at most: one or two are usual
_LACKS = 1e-10  # of the length that loads press bodies together by: what closed pairs may be apart by rounding
_BACK = 1e-9  # of a stride: what a pair may go against the others by rounding
_TOLERANCE = 1e-8  # of the same: what the end of a stride may lack


@dataclass(frozen=True, kw_only=True, eq=False)
class Gone:
    """What a stride leaves behind.

    Attributes
    ----------
    pairs : at its end
    gap : (a,) between which they are then
    rubs, distance, travel : (a,) as of `Rubbing`, but normal force times distance, or energy
    spent, freed : taken by friction, and set free by the change of pairs
    pivots, residual : states that were tried, and the largest of the certificates
    """

    pairs: StridePairs
    gap: Array
    rubs: Array
    distance: Array
    travel: Array
    spent: float
    freed: float
    pivots: int
    residual: float

    def and_then(self, other: Gone) -> Gone:
        """One after the other."""
        return Gone(
            pairs=other.pairs,
            gap=other.gap,
            rubs=self.rubs + other.rubs,
            distance=self.distance + other.distance,
            travel=self.travel + other.travel,
            spent=self.spent + other.spent,
            freed=self.freed + other.freed,
            pivots=self.pivots + other.pivots,
            residual=max(self.residual, other.residual),
        )


def slide(link: Link, now: StridePairs, depth: Array, limit: float) -> Gone | None:
    """A stride in which all pairs that touch slip on, friction along one way; None where it is none.

    With f the friction over the pressure, p the normal forces and R the rigid motions

        0 <= p  _|_  (A_n + A_t f) p + g(t) + R_n w >= 0,    R^T (p, f p) = - load(t),

    from t = 0, where it begins, to 1, where gaps g are those of the sides there.

    Parameters
    ----------
    link : from the last stride
    now : the pairs at its end
    depth : (m,) worn
    limit : the longest stride, length
    """
    closed = closed_of(now)
    if len(now.r) > 2:
        return None
    code = int(now.status[closed[0]]) if len(closed) else OPEN
    if code not in (SLIP_PLUS, SLIP_MINUS) or not (now.status[closed] == code).all():
        return None
    if not (link.next.friction[closed] > 0.0).all():
        return None
    return _Slip(link, now, depth, limit, code).gone()


class _Slip:
    """The stride on its way; parameters as of `slide`, and the code of all pairs that touch."""

    def __init__(self, link: Link, now: StridePairs, depth: Array, limit: float, code: int) -> None:
        track, a = link.next, len(now.gap)
        self.link, self.now, self.track, self.limit, self.code, self.a = link, now, track, limit, code, a
        self.sign = 1.0 if code == SLIP_PLUS else -1.0
        self.moves, _ = track.sliding(self.sign)
        self.begin, first, _ = link.begun(now)
        self.gap = track.gaps[1] + track.seen @ depth
        self.opened = self.gap - first
        self.ends, self.resultants = track.free.copy(), track.resultants.copy()
        self.ends[1, :a] += self.gap
        # whatever fades away, and rigid motions from there on, are in what the beginning is
        p = now.r[0]
        self.ends[0] = np.concatenate([now.gap, self.begin.tangential[0]]) - self.moves @ p
        self.resultants[0] = -(track.sliding(self.sign)[1] @ p)
        self.small = _LACKS * track.prepared.scale.compressed

    def solved(self, closed: IntArray, at: int) -> tuple[Array, Array, Array]:
        """Normal forces, motions (2 a,) and rigid motions at an end, 0 or 1, of a set of pairs that touch.

        Parameters
        ----------
        closed : their numbers
        at : which end
        """
        right = -np.concatenate([self.ends[at, closed], self.resultants[at]])
        y = self.track.inverse(self.sign, closed) @ right
        p = np.zeros(self.a)
        p[closed] = y[: len(closed)]
        ways = y[len(closed) :]
        return p, self.moves @ p + self.ends[at] + self.track.N @ ways, ways

    def gone(self) -> Gone | None:
        """From event to event, through pairs that open and close."""
        a, closed = self.a, closed_of(self.now)
        gone = Gone(
            pairs=self.begin,
            gap=self.gap,
            rubs=np.zeros(a),
            distance=np.zeros(a),
            travel=np.zeros(a),
            spent=0.0,
            freed=0.0,
            pivots=1,
            residual=0.0,
        )
        t, p, h = 0.0, self.now.r[0], np.concatenate([self.now.gap, self.begin.tangential[0]])
        begin, pressing = (p, h), np.zeros(a)
        for events in range(_EVENTS):
            p0, h0 = begin if not events else self.solved(closed, 0)[:2]
            p1, h1, ways = self.solved(closed, 1)
            touches = np.zeros(a, dtype=np.bool_)
            touches[closed] = True
            low, high = np.where(touches, p0, h0[:a]), np.where(touches, p1, h1[:a])
            falls = (high < np.where(touches, 0.0, -self.small)) & (high < low)
            times = np.divide(low, low - high, out=np.full(a, np.inf), where=falls)
            k, last = int(times.argmin()), t
            t = max(t, float(times[k])) if times[k] < 1.0 else 1.0
            new_p, new_h = np.maximum((1.0 - t) * p0 + t * p1, 0.0), (1.0 - t) * h0 + t * h1
            step = (new_h - h)[a:]
            if (step[closed] * self.sign > _BACK * self.limit).any():
                return None
            gone = self.farther(gone, touches, 0.5 * (p + new_p), step)
            pressing += 0.5 * (t - last) * (p + new_p)
            p, h = new_p, new_h
            if times[k] >= 1.0:
                ended = self.ended(gone, closed, p, h, ways)
                if ended is None:
                    return None
                return replace(ended, freed=self.link.freed(self.now, ended.pairs, self.opened, pressing))
            closed = np.setdiff1d(closed, [k]) if touches[k] else np.union1d(closed, [k])
            if not len(closed):
                return None
        return None

    def farther(self, gone: Gone, touches: BoolArray, pressed: Array, step: Array) -> Gone:
        """A linear piece on.

        Parameters
        ----------
        gone : so far
        touches : (a,) pairs that do
        pressed : (a,) their mean normal forces
        step : (a,) tangential, length
        """
        slid = np.where(touches, np.abs(step), 0.0)
        piece, pairs = pressed * slid, gone.pairs
        taken = self.track.friction * piece
        slip = pairs.slip + np.where(touches, step, 0.0)
        return replace(
            gone,
            pairs=replace(pairs, slip=slip, dissipation=pairs.dissipation + taken),
            rubs=gone.rubs + self.track.wearing(piece, taken),
            distance=gone.distance + slid,
            travel=gone.travel + np.abs(step),
            spent=gone.spent + float(taken.sum()),
            pivots=gone.pivots + 1,
        )

    def ended(self, gone: Gone, closed: IntArray, p: Array, h: Array, ways: Array) -> Gone | None:
        """The end of the stride; None where closed pairs are apart.

        Parameters
        ----------
        gone : the way to it
        closed : numbers of the pairs that touch
        p, h, ways : the solution there
        """
        residual = float(np.abs(h[closed]).max(initial=0.0)) / self.track.prepared.scale.compressed
        if residual > _TOLERANCE:
            return None
        status = np.where(p > 0.0, self.code, OPEN)
        pairs = replace(
            gone.pairs,
            r=np.array([p, self.sign * self.track.friction * p]),
            ways=ways,
            gap=np.where(status == OPEN, np.maximum(h[: self.a], 0.0), 0.0),
            tangential=h[None, self.a :],
            status=status,
        )
        return replace(gone, pairs=pairs, residual=residual)
