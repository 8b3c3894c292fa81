# SPDX-License-Identifier: BSD-3-Clause
"""What following a segment of the load history gives."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.attempt import Spent
from signorini.friction.history.rates import Rates
from signorini.friction.history.state import PathState
from signorini.outcome import Outcome

What = Literal["closes", "opens", "slips", "sticks", "kinks", "stiffens", "softens", "breaks"]


@dataclass(frozen=True, kw_only=True)
class Event:
    """Pairs that change their state at one load.

    Attributes
    ----------
    factor : part of the segment behind, 0 .. 1
    pairs : their numbers
    what : "closes" (sticking or slipping), "opens", "slips" (from stick, or the other way round), "sticks" (from slip),
        "kinks" (slips on, on another branch of its bound: it reaches the shear limit or leaves it), "stiffens",
        "softens" (comes to a kink of its closure, or to the strength of its bond), "breaks" (its bond is gone)
    state : the state at this load, with the codes that hold from here on
    """

    factor: float
    pairs: tuple[int, ...]
    what: What
    state: PathState


@dataclass(frozen=True, kw_only=True)
class Breakpoint:
    """Motions and forces at one end of a linear piece; in between they are interpolated linearly, exactly.

    Attributes
    ----------
    factor : part of the segment behind
    h, r : (d, n) as in `PathState`
    state : the whole state
    tried : increments tried to find where it ends, in space
    rates : in the plane, of the piece that ends here
    acting : (m,) in the plane, pairs whose event ends it; empty at the end of the segment unless one is there
    passes : in space, whether it is short enough to go on over an event
    search : in space, ends of increments tried before: how far friction turns in one told the length of the next, and
        in the last that of this one; empty where anything else did
    told : in space, on smooth sections, whether the first of them, or this one, has a length that is known beforehand
    """

    factor: float
    h: Array
    r: Array
    state: PathState | None = None
    tried: int = 0
    rates: Rates | None = None
    acting: IntArray | None = None
    passes: bool = False
    search: tuple[Breakpoint, ...] = ()
    told: bool = True


@dataclass(frozen=True, kw_only=True)
class Jump:
    """A load beyond which equilibrium cannot change gradually.

    Attributes
    ----------
    factor : where on the segment
    pairs : those whose event has no continuation
    proof : what shows it: that no combination of states has rates, or a rigid motion; a ray of Lemke's method alone
        (too many combinations to try) is strong evidence, no proof
    margin : what rates lack at least, of the data; where a rigid motion shows it, what nothing takes of the load, at
        the end of the segment in space; 0 where there is strong evidence alone
    gross_sliding : whether bodies slide as a whole: every closed pair has used up its friction and the loads go on
    escape : rows of pairs, rigid motion along which bodies leave, largest entry 1, where it is known
    hopeless : part of the segment beyond which it is proved that no load has any equilibrium, where it is known
    """

    factor: float
    pairs: tuple[int, ...]
    proof: str
    gross_sliding: bool
    escape: Array | None = None
    hopeless: float | None = None
    margin: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Segment:
    """A straight segment of the load history, followed.

    Attributes
    ----------
    end : the last state reached; at the end of the segment where ``outcome`` is FOLLOWED
    events : in order
    pieces : the ends of the linear pieces in order, the start first
    outcome : FOLLOWED, JUMP (no gradual continuation), NOT_FOUND (neither rates nor proof of a jump), or DISTURBED: cut
        short because another problem goes on from there
    jump : where, who and why, or None
    pivots : states tried
    factorisations, updates : dense factorisations, and changes of a factorised state by one unknown
    residual : largest of the certificates, relative to the data, see `signorini.friction.certify`
    message : the same in words
    spent : searches on the way that ended at their budgets
    shortest : see `PathSettings`
    """

    end: PathState
    events: tuple[Event, ...]
    pieces: tuple[Breakpoint, ...]
    outcome: Outcome
    jump: Jump | None
    pivots: int
    factorisations: int
    updates: int
    residual: float
    message: str
    spent: tuple[Spent, ...] = ()
    shortest: float = 0.0

    @property
    def followed(self) -> bool:
        """Whether the end of the segment was reached."""
        return self.outcome == Outcome.FOLLOWED

    def until(self, factor: float) -> Segment:
        """The segment up to a part of it, 0 < factor <= that of its end, where all is linear inside a piece."""
        i = max(1, bisect_left([piece.factor for piece in self.pieces], factor))
        one, two = self.pieces[i - 1], self.pieces[i]
        before, after = one.state, two.state
        assert before is not None
        assert after is not None
        part = (factor - one.factor) / (two.factor - one.factor)

        def between(start: Array, end: Array) -> Array:
            return (1.0 - part) * start + part * end

        r, moved = between(one.r, two.r), two.h[1:] - one.h[1:]
        # friction grows linearly with the slip that it works on
        worked, whole = (((one.r + then)[1:] * moved).sum(axis=0) for then in (r, two.r))
        spent = part * np.divide(worked, whole, out=np.zeros_like(whole), where=whole != 0.0)
        end = replace(
            after,
            b=between(before.b, after.b),
            h=between(one.h, two.h),
            r=r,
            slip=between(before.slip, after.slip),
            dissipation=before.dissipation + spent * (after.dissipation - before.dissipation),
        )
        last = Breakpoint(factor=factor, h=end.h, r=end.r, state=end)
        events = tuple(event for event in self.events if event.factor < factor)
        return replace(self, end=end, events=events, pieces=(*self.pieces[:i], last))
