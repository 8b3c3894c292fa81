# SPDX-License-Identifier: BSD-3-Clause
"""The law of the rates: which pairs may change their state now, and what the rates of each must obey.

At a given load most pairs are inside their state and stay there for a while. The others are

- at a corner (gap and normal force vanish): open, sticking or slipping either way, as their rates decide;
- on an edge (friction used up, sticking or slipping): sticking, or slipping against it;
- on an edge at a kink of the bound F (see `law.bound`): sticking, or slipping on the branch of F below or
  above it.

In a state the rates are linear; these inequalities make them those of the law, with mu the slope of the branch of F, in
Coulomb's law the friction::

    open  gap' >= 0        closed  p' >= 0
    stick mu p' - s r_t' >= 0  (s = both signs at a corner, the sign of the friction on an edge; at a kink for both mu)
    slip under friction s F(p):  -s h_t' >= 0, at a kink p' <= 0 below it and p' >= 0 above
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.history.rates import Rates
from signorini.law.bound import SIGN, FrictionBound, plain
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

INSIDE, CORNER = -1, 0
"""Kinds of pairs; on an edge the kind is the code of the slip that it allows, at a kink that of the branch below."""

RATE = 1e-10
"""Sign of a rate, relative to the largest rate."""


@dataclass(frozen=True, kw_only=True)
class RateLaw:
    """The law of the rates at one load.

    Parameters
    ----------
    bound : of the friction
    forced : (n,) the state that a pair takes wherever it is closed, or UNDECIDED
    kind : (n,) INSIDE, CORNER or, on an edge, the code of the slip
    kink : (n,) on an edge that ends here, going on as the edge of the next branch

    Examples
    --------
    >>> law = RateLaw.at(
    ...     bound=FrictionBound.of([0.5]), forced=np.array([UNDECIDED]), state=np.array([STICK]),
    ...     h=np.zeros((2, 1)), r=np.array([[1.0], [0.5]]), width=np.array([1e-10]),
    ... )
    >>> law.kind.tolist()
    [2]
    >>> law.proposal(Rates(state=np.array([STICK]), h=np.zeros((2, 1)), r=np.array([[0.0], [1.0]]))).tolist()
    [2]
    """

    bound: FrictionBound
    forced: IntArray
    kind: IntArray
    kink: BoolArray

    @classmethod
    def at(
        cls,
        *,
        bound: FrictionBound,
        forced: IntArray,
        state: IntArray,
        h: Array,
        r: Array,
        width: Array,
        closing: Array | None = None,
    ) -> RateLaw:
        """The law at motions h and forces r, (2, n) each.

        Parameters
        ----------
        bound : of the friction
        forced, state : (n,) codes: of each pair where it is closed, UNDECIDED where it decides, and at present
        h, r : (2, n) motions and forces
        width : (n,) of zero
        closing : (n,) pairs that are at a corner anyway
        """
        n = len(state)
        gap, (p, q) = h[0], r
        corner = np.where(state == OPEN, gap <= width, p <= width)
        if closing is not None:
            corner[closing] = True
        kind = np.where(corner, CORNER, INSIDE)
        free = ~corner & (state != OPEN) & (forced == UNDECIDED)
        kind[free & (state > STICK)] = state[free & (state > STICK)]
        for j in range(bound.branches - 1, -1, -1):
            spare = bound.starts[j] + bound.slopes[j] * p - np.abs(q)
            spent = free & (state == STICK) & (spare / weight(bound.slopes[j]) <= width)
            kind[spent] = np.where(q[spent] > 0, SLIP_PLUS, SLIP_MINUS) + 2 * j
        kink = np.zeros(n, dtype=np.bool_)
        for j in range(1, bound.branches):
            near = ~corner & (np.abs(p - bound.kinks[j]) <= width) & ((state > STICK) | (kind > CORNER))
            kink |= near
            signs = np.where(state > STICK, state, kind) % 2
            kind[near] = SLIP_PLUS + 2 * (j - 1) + signs[near]
        return cls(bound=bound, forced=forced, kind=kind, kink=kink)

    def onto(self, upper: BoolArray) -> RateLaw:
        """The law without kinks: every pair at one keeps to the branch above it (``upper``, (n,)) or below."""
        kind = np.where(self.kink & upper, self.kind + 2, self.kind)
        kind = np.where(self.kink & (self.forced != UNDECIDED), INSIDE, kind)
        return replace(self, kind=kind, kink=np.zeros_like(self.kink))

    def across(self, state: IntArray) -> IntArray:
        """(n,) The other branch of pairs that slip at a kink."""
        return np.where(state == self.kind, self.kind + 2, self.kind)

    @cached_property
    def mu(self) -> Array:
        """(n,) Slope of the bound: of the branch of the edge, at a kink of that below it, otherwise of the first."""
        if self.bound.branches == 1:
            return self.bound.slopes[0]
        return np.abs(self.bound.slope(np.where(self.kind > CORNER, self.kind, SLIP_PLUS)))

    def conditions(self, state: IntArray, h: Array, r: Array) -> Array:
        """(3, n) What must not be negative in a state at rates h, r (2, n); linear in them, inf where nothing is."""
        n, (corner, plus, minus, rubs, weights) = len(state), self._asked
        (gap, t), (p, q) = h, r
        stick, slips, most = state == STICK, state > STICK, self.mu * p
        values = np.full((3, n), np.inf)
        np.copyto(values[0], np.where(state == OPEN, gap, p), where=corner)
        np.copyto(values[1], (most - q) / weights, where=plus & stick)
        np.copyto(values[2], (most + q) / weights, where=minus & stick)
        np.copyto(values[2], -SIGN[state] * t, where=rubs & slips)
        if self.kink.any():
            above = self.onto(self.kink).mu
            spare = (above * p - SIGN[self.kind] * q) / weight(above)
            np.copyto(values[0], spare, where=self.kink & stick & (self.forced == UNDECIDED))
            np.copyto(values[1], np.where(state == self.kind, -p, p), where=self.kink & slips)
        return values

    @cached_property
    def _asked(self) -> tuple[BoolArray, BoolArray, BoolArray, BoolArray, Array]:
        """Pairs at a corner, on the edge of friction + and -, those that may slip, and the weight of friction."""
        corner, unforced = self.kind == CORNER, self.forced == UNDECIDED
        edge = plain(self.kind)
        plus, minus = ((corner | (edge == code)) & unforced for code in (SLIP_PLUS, SLIP_MINUS))
        return corner, plus, minus, self.undecided & unforced, weight(self.mu)

    def following(self, state: IntArray, t: Array) -> IntArray:
        """(3, n) The states that take over where conditions are violated, at tangential rates t."""
        following = np.stack(
            [
                np.where(state == OPEN, self.touching(t), OPEN),
                np.maximum(self.kind, SLIP_PLUS),
                np.where(state == STICK, np.maximum(self.kind, SLIP_MINUS), STICK),
            ]
        )
        if self.kink.any():
            stick, slips = self.kink & (state == STICK), self.kink & (state > STICK)
            following[0, stick], following[1, slips] = self.kind[stick] + 2, self.across(state)[slips]
        return following

    def touching(self, t: Array) -> IntArray:
        """(n,) The state of a pair that closes while it moves with tangential rate t: slipping."""
        slips = np.where(t >= 0, SLIP_MINUS, SLIP_PLUS)
        return np.where(self.forced == UNDECIDED, slips, self.forced)

    def violation(self, rates: Rates) -> float:
        """The worst violation relative to the size of the rates."""
        values = self.conditions(rates.state, rates.h, rates.r)
        return float(max(-values.min(initial=np.inf), 0.0)) / rates.size

    def proposal(self, rates: Rates) -> IntArray:
        """(n,) Every pair in the state that its worst violation asks for."""
        values = self.conditions(rates.state, rates.h, rates.r)
        worst, pairs = values.argmin(axis=0), np.arange(len(self.kind))
        following = self.following(rates.state, rates.h[1])
        return np.where(values[worst, pairs] < -RATE * rates.size, following[worst, pairs], rates.state)

    @property
    def undecided(self) -> BoolArray:
        """(n,) Pairs that may change."""
        return np.asarray(self.kind != INSIDE)


def weight(mu: Array) -> Array:
    """(n,) Size of the friction condition: that of a force for any mu."""
    return np.maximum(mu, 1.0)
