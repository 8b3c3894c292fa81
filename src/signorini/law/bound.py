# SPDX-License-Identifier: BSD-3-Clause
"""The largest friction that a pair can carry under a normal force: known to the law of contact and to its results.

Friction mu, adhesion c and shear limit L, all of them forces but mu, bound the tangential force of a closed pair by

    F(p) = min(mu p + min(S p, c), L)

with the steep slope S = 1e3 of adhesion: the whole of it acts from a normal force of 1e-3 of it on, and nothing is left
where the pair opens. Without that F would drop from c to nothing, and a pair on the verge of opening could be in
equilibrium neither closed nor open; with it F is continuous, and held bodies have an equilibrium under every load.

F is concave and piecewise linear, ``min_j (start_j + slope_j p)``, of one branch (Coulomb), two or three. Other laws
are other kinds of `Bound`: what they need is their value, their tangent and their steepest slope. The methods of the
plane that follow pieces (covering paths, the tree of states, exact histories) take a `FrictionBound` alone.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray
from signorini.law.states import SLIP_MINUS, SLIP_PLUS, STICK

STICKING_FRICTION = 1e6
"""Friction that stands for ``inf``: without bound the law is not continuous, and need not have a solution."""

ADHESION_SLOPE = 1e3
"""Slope with which adhesion begins; also that of a pair that sticks up to a shear limit."""

MOST_BRANCHES = 8
"""Straight branches that a bound may have: codes of more are not known."""

SIGN = np.array([0.0, 0.0, *[1.0, -1.0] * MOST_BRANCHES])
"""Of the friction of a slipping pair, by code."""


class Bound(ABC):
    """The largest friction F of n pairs as a function of their normal forces p >= 0: not negative, concave."""

    @abstractmethod
    def at(self, p: Array) -> Array:
        """(n,) F at normal forces p >= 0."""

    @abstractmethod
    def tangent(self, p: Array) -> tuple[Array, Array]:
        """Slope and start, each (n,), of the line ``start + slope p`` that F is near normal forces p."""

    @property
    @abstractmethod
    def steepest(self) -> Array:
        """(n,) The largest slope, at p = 0: Coulomb's coefficient where there is no other law."""

    @abstractmethod
    def among(self, kept: BoolArray) -> Self:
        """The bound of the kept pairs, (n,)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FrictionBound(Bound):
    """Branches of F for n pairs, the first through zero; those that a pair does not have begin at infinity.

    A pair that slips on branch j has the code ``SLIP_PLUS + 2 j`` or ``SLIP_MINUS + 2 j``.

    Attributes
    ----------
    slopes, starts : (branches, n) of ``start + slope p``
    kinks : (branches + 1, n) normal forces at which the branches begin, 0 and so on, at last infinity

    Examples
    --------
    >>> bound = FrictionBound.of(0.5, limit=2.0)
    >>> bound.at(np.array([3.0])).tolist(), bound.at(np.array([5.0])).tolist(), bound.kinks[1].tolist()
    ([1.5], [2.0], [4.0])
    """

    slopes: Array
    starts: Array
    kinks: Array

    @classmethod
    def of(cls, friction: ArrayLike, *, adhesion: ArrayLike = 0.0, limit: ArrayLike = np.inf) -> FrictionBound:
        """The bound of friction, adhesion and shear limit, (n,) each or one number.

        Parameters
        ----------
        friction : mu >= 0; ``inf`` sticks up to the limit where there is one, and always where there is none
        adhesion, limit : forces, >= 0; ``inf`` is no limit
        """
        mu, c, L = np.broadcast_arrays(
            *(np.atleast_1d(np.asarray(part, float)) for part in (friction, adhesion, limit))
        )
        capped = np.isfinite(L)
        if not capped.any() and not c.any():
            return cls.coulomb(mu)
        stick = np.isinf(mu)
        m = np.where(stick, np.where(capped, 0.0, STICKING_FRICTION), mu)
        c = np.where(stick, np.where(capped, L, 0.0), np.minimum(c, L))
        first = m + np.where(c > 0, ADHESION_SLOPE, 0.0)
        ends = c + m * (c / ADHESION_SLOPE) >= L  # the first branch reaches the limit
        limited = capped & (m > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            second = np.where(ends | (c == 0), L / first, c / ADHESION_SLOPE)
            third = np.where(limited & ~ends & (c > 0), (L - c) / m, np.inf)
        second = np.where((c > 0) | limited, second, np.inf)
        flat = ends | (c == 0)
        slopes = np.stack([first, np.where(np.isinf(second), first, np.where(flat, 0.0, m)), np.zeros_like(m)])
        starts = np.stack([np.zeros_like(m), np.where(np.isinf(second), 0.0, np.where(flat, L, c)), L])
        slopes[2], starts[2] = np.where(np.isinf(third), (slopes[1], starts[1]), (slopes[2], starts[2]))
        count = 1 + int(np.isfinite(second).any()) + int(np.isfinite(third).any())
        kinks = _between(np.stack([np.zeros_like(m), second, third])[:count])
        return cls(slopes=slopes[:count], starts=starts[:count], kinks=kinks)

    @classmethod
    def coulomb(cls, friction: Array) -> FrictionBound:
        """The bound of friction (n,) alone."""
        zero = np.zeros((1, len(friction)))
        return cls(slopes=np.minimum(friction, STICKING_FRICTION)[None], starts=zero, kinks=_between(zero))

    @classmethod
    def constant(cls, size: Array) -> FrictionBound:
        """The bound that does not depend on the normal force, (n,)."""
        return cls(slopes=np.zeros((1, len(size))), starts=size[None], kinks=_between(np.zeros((1, len(size)))))

    @classmethod
    def through(cls, p: Array, F: Array) -> FrictionBound:
        """The bound of straight lines from zero through forces F at normal forces p, (branches, n), and on as it ends.

        >>> bound = FrictionBound.through(np.array([[1.0], [3.0]]), np.array([[0.5], [0.9]]))
        >>> bound.at(np.array([2.0])).round(12).tolist()
        [0.7]
        """
        zero = np.zeros((1, p.shape[1]))
        slopes = np.diff(np.concatenate([zero, F]), axis=0) / np.diff(np.concatenate([zero, p]), axis=0)
        return cls(slopes=slopes, starts=F - slopes * p, kinks=_between(np.concatenate([zero, p[:-1]])))

    @classmethod
    def joined(cls, bounds: Sequence[FrictionBound]) -> FrictionBound:
        """The bound of the pairs of several, one after the other; branches that pairs do not have repeat their last."""
        most = max(bound.branches for bound in bounds)

        def padded(bound: FrictionBound, name: str) -> Array:
            rows: Array = getattr(bound, name)
            return np.concatenate([rows, np.repeat(rows[-1:], most - bound.branches, axis=0)])

        parts = {
            name: np.concatenate([padded(bound, name) for bound in bounds], axis=1)
            for name in ("slopes", "starts", "kinks")
        }
        return cls(**parts)

    def fixed(self, which: BoolArray, size: Array) -> FrictionBound:
        """The bound that for some pairs, (n,), is a size, (n,), whatever the normal force."""
        kinks = self.kinks.copy()
        kinks[1:, which] = np.inf
        return FrictionBound(
            slopes=np.where(which, 0.0, self.slopes), starts=np.where(which, size, self.starts), kinks=kinks
        )

    @property
    def branches(self) -> int:
        """The most that a pair has."""
        return len(self.slopes)

    @cached_property
    def branch_counts(self) -> IntArray:
        """(n,) Number of branches that every pair has."""
        return np.asarray(np.isfinite(self.kinks).sum(axis=0), dtype=np.int64)

    def at(self, p: Array) -> Array:
        """(n,) F at normal forces p >= 0."""
        if self.branches == 1:
            return self.starts[0] + self.slopes[0] * p
        return np.asarray((self.starts + self.slopes * p).min(axis=0))

    def tangent(self, p: Array) -> tuple[Array, Array]:
        """Slope and start, each (n,), of the branch that normal forces p lie on."""
        if self.branches == 1:
            return self.slopes[0], self.starts[0]
        branch, pairs = self.branch(p), np.arange(len(p))
        return self.slopes[branch, pairs], self.starts[branch, pairs]

    @property
    def steepest(self) -> Array:
        """(n,) Slope of the first branch."""
        return self.slopes[0]

    def among(self, kept: BoolArray) -> FrictionBound:
        """The bound of the kept pairs, (n,)."""
        return FrictionBound(slopes=self.slopes[:, kept], starts=self.starts[:, kept], kinks=self.kinks[:, kept])

    def branch(self, p: Array) -> IntArray:
        """(n,) Number of the branch at normal forces p."""
        return np.asarray((p > self.kinks[1:-1]).sum(axis=0), dtype=np.int64)

    def coded(self, state: IntArray, p: Array) -> IntArray:
        """(n,) Codes with the branch that p lies on, of states with or without one."""
        if self.branches == 1:
            return state
        return np.where(state > STICK, plain(state) + 2 * self.branch(p), state)

    def slope(self, state: IntArray) -> Array:
        """(..., n) Tangential force per normal force that slipping pairs gain, with its sign; 0 of others."""
        return np.asarray(SIGN[state] * self._of(self.slopes, state), dtype=np.float64)

    def start(self, state: IntArray) -> Array:
        """(n,) Tangential force of slipping pairs that does not depend on the normal force, with its sign."""
        return np.asarray(SIGN[state] * self._of(self.starts, state), dtype=np.float64)

    def _of(self, table: Array, state: IntArray) -> Array:
        if self.branches == 1:
            return table[0]
        branch = np.where(state > STICK, (state - SLIP_PLUS) // 2, 0)
        return np.asarray(table[branch, np.arange(state.shape[-1])], dtype=np.float64)


@dataclass(frozen=True, kw_only=True, eq=False)
class JoinedBound(Bound):
    """Bounds of several laws, each of the pairs behind those of the one before."""

    parts: tuple[Bound, ...]

    def _split(self, values: Array | BoolArray) -> list[tuple[Bound, Any]]:
        """Every part with its own of n values."""
        ends = np.cumsum([len(part.steepest) for part in self.parts])[:-1]
        return list(zip(self.parts, np.split(values, ends), strict=True))

    def at(self, p: Array) -> Array:
        """(n,) F at normal forces p >= 0."""
        return np.concatenate([part.at(own) for part, own in self._split(p)])

    def tangent(self, p: Array) -> tuple[Array, Array]:
        """Slope and start, each (n,), of the line that F is near normal forces p."""
        slopes, starts = zip(*(part.tangent(own) for part, own in self._split(p)), strict=True)
        return np.concatenate(slopes), np.concatenate(starts)

    @property
    def steepest(self) -> Array:
        """(n,) The largest slope, at p = 0."""
        return np.concatenate([part.steepest for part in self.parts])

    def among(self, kept: BoolArray) -> JoinedBound:
        """The bound of the kept pairs, (n,)."""
        return JoinedBound(parts=tuple(part.among(own) for part, own in self._split(kept)))


def plain(state: IntArray) -> IntArray:
    """Codes of :mod:`signorini.law.states`, whatever the branch.

    Examples
    --------
    >>> plain(np.array([0, 1, 2, 3, 4, 7])).tolist()
    [0, 1, 2, 3, 2, 3]
    """
    if state.max(initial=0) <= SLIP_MINUS:
        return state
    return np.where(state > STICK, SLIP_PLUS + state % 2, state)


def _between(kinks: Array) -> Array:
    """Where branches begin, and where the last ends: nowhere."""
    return np.concatenate([kinks, np.full((1, kinks.shape[1]), np.inf)])
