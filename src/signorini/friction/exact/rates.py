# SPDX-License-Identifier: BSD-3-Clause
"""The law of the rates: which pairs may change their state now, and what the rates of each must obey.

At a given load most pairs are inside their state and stay there for a while. The others are

- at a corner (gap and normal force vanish): open, sticking or slipping either way, as their rates decide;
- on an edge (friction used up, sticking or slipping): sticking, or slipping against it.

In a state the rates are linear; these inequalities make them those of Coulomb's law::

    open  gap' >= 0        closed  p' >= 0
    stick mu p' - s r_t' >= 0  (s = both signs at a corner, the sign of the friction on an edge)
    slip under friction s mu p:  -s h_t' >= 0
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

INSIDE, CORNER = -1, 0
"""Kinds of pairs; on an edge the kind is the code of the slip that it allows."""

RATE = 1e-10
"""Sign of a rate, relative to the largest rate."""

SIGN = np.array([0.0, 0.0, 1.0, -1.0])
"""Of the friction of a slipping pair, by code."""


@dataclass(frozen=True, kw_only=True)
class Rates:
    """Rates in one state of the pairs, per unit of the load parameter.

    Attributes
    ----------
    state : (n,)
    h, r : (2n,)
    """

    state: IntArray
    h: Array
    r: Array

    @property
    def size(self) -> float:
        """The largest of them, which tolerances refer to."""
        return float(max(np.abs(self.h).max(initial=0.0), np.abs(self.r).max(initial=0.0))) or 1.0


@dataclass(frozen=True, kw_only=True)
class RateLaw:
    """Coulomb's law of the rates at one load.

    Parameters
    ----------
    mu : (n,) friction
    forced : (n,) the state that a pair takes wherever it is closed, or UNDECIDED
    kind : (n,) INSIDE, CORNER or, on an edge, SLIP_PLUS or SLIP_MINUS

    Examples
    --------
    >>> law = RateLaw.at(
    ...     mu=np.array([0.5]), forced=np.array([UNDECIDED]), state=np.array([STICK]),
    ...     h=np.zeros(2), r=np.array([1.0, 0.5]), width=1e-10,
    ... )
    >>> law.kind.tolist()
    [2]
    >>> law.proposal(Rates(state=np.array([STICK]), h=np.zeros(2), r=np.array([0.0, 1.0]))).tolist()
    [2]
    """

    mu: Array
    forced: IntArray
    kind: IntArray

    @classmethod
    def at(
        cls,
        *,
        mu: Array,
        forced: IntArray,
        state: IntArray,
        h: Array,
        r: Array,
        width: float,
        closing: Array | None = None,
    ) -> RateLaw:
        """The law at given motions and forces; ``width`` tells zero, ``closing`` (pairs) are at a corner anyway."""
        n = len(mu)
        gap, p, q = h[:n], r[:n], r[n:]
        corner = np.where(state == OPEN, gap <= width, p <= width)
        if closing is not None:
            corner[closing] = True
        kind = np.where(corner, CORNER, INSIDE)
        free = ~corner & (state != OPEN) & (forced == UNDECIDED)
        kind[free & (state > STICK)] = state[free & (state > STICK)]
        spent = free & (state == STICK) & ((mu * p - np.abs(q)) / weight(mu) <= width)
        kind[spent] = np.where(q[spent] > 0, SLIP_PLUS, SLIP_MINUS)
        return cls(mu=mu, forced=forced, kind=kind)

    def conditions(self, rates: Rates) -> tuple[Array, IntArray]:
        """What must not be negative, and the state that takes over where it is.

        Returns
        -------
        values : (3, n) inf where nothing is asked
        following : (3, n) states
        """
        n, mu, kind, state = len(self.mu), self.mu, self.kind, rates.state
        gap, t, p, q = rates.h[:n], rates.h[n:], rates.r[:n], rates.r[n:]
        values, following = np.full((3, n), np.inf), np.full((3, n), OPEN)
        corner, unforced, slips = kind == CORNER, self.forced == UNDECIDED, state > STICK
        k = corner & (state == OPEN)
        values[0, k], following[0, k] = gap[k], self.touching(t)[k]
        k = corner & (state != OPEN)
        values[0, k] = p[k]
        for row, code in ((1, SLIP_PLUS), (2, SLIP_MINUS)):
            k = (corner | (kind == code)) & (state == STICK) & unforced
            values[row, k], following[row, k] = ((mu * p - SIGN[code] * q) / weight(mu))[k], code
        k = (kind != INSIDE) & slips & unforced
        values[2, k], following[2, k] = (-SIGN[state] * t)[k], STICK
        return values, following

    def touching(self, t: Array) -> IntArray:
        """(n,) The state of a pair that closes while it moves with tangential rate t: slipping."""
        slips = np.where(t >= 0, SLIP_MINUS, SLIP_PLUS)
        return np.where(self.forced == UNDECIDED, slips, self.forced)

    def violation(self, rates: Rates) -> float:
        """The worst violation relative to the size of the rates."""
        return float(max(-self.conditions(rates)[0].min(initial=np.inf), 0.0)) / rates.size

    def proposal(self, rates: Rates) -> IntArray:
        """(n,) Every pair in the state that its worst violation asks for."""
        values, following = self.conditions(rates)
        worst, pairs = values.argmin(axis=0), np.arange(len(self.mu))
        return np.where(values[worst, pairs] < -RATE * rates.size, following[worst, pairs], rates.state)

    @property
    def undecided(self) -> BoolArray:
        """(n,) Pairs that may change."""
        return np.asarray(self.kind != INSIDE)


def weight(mu: Array) -> Array:
    """(n,) Size of the friction condition: that of a force for any mu."""
    return np.maximum(mu, 1.0)
