# SPDX-License-Identifier: BSD-3-Clause
"""Laws of closure: how far the sides of a contact close on what lies between them under a pressure.

A closure is straight between its points, so that a pair is always on a line ``closure = rest + compliance pressure``.
On its line it is a pair of an interface with a compliance, and what is left to find is the line of every pair.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.checks import number
from signorini.errors import InputError
from signorini.short import Short

_END = 7.0  # of the clearance, beyond where pressure begins: 4460 times the pressure at no gap; the last slope goes on
_MOST_POINTS = 200  # of a curve: 0.001 of the pressure takes some 140
_SLOPE_ROUNDING = 1e-12  # of a slope
_FLOOR = 0.01  # of the pressure where sides touch: errors are told of the pressure and that


@dataclass(frozen=True, repr=False)
class Closure(Short):
    """Pressure over closure of what lies between two sides: a gasket, a coating, roughness.

    The closure is how far the sides have moved towards each other from where they touch, length. Between its points
    the pressure is straight, beyond the last one it goes on as between the last two.

    Parameters
    ----------
    points : two or more of (closure, pressure): the first pressure is 0, the others grow; closures do not fall. A first
        closure below 0 is that of sides that press before they touch, across a clearance
    unloading : pressure per closure with which a side springs back from the largest pressure that it has borne, and is
        pressed to it again; no less than of any line of the points, which are the way there. What it does not spring
        back it keeps. None: it springs back along its points

    Examples
    --------
    >>> Closure([(0.0, 0.0), (0.1, 2.0), (0.15, 10.0)], unloading=400.0).points[-1]
    (0.15, 10.0)
    """

    points: Sequence[tuple[float, float]]
    unloading: float | None = None

    def __post_init__(self) -> None:
        if isinstance(self.points, str) or not isinstance(self.points, Sequence | np.ndarray) or len(self.points) < 2:
            raise InputError("expected two points or more, each [closure, pressure]", where=("points",))
        found: list[tuple[float, float]] = []
        for i, point in enumerate(self.points):
            if isinstance(point, str) or not isinstance(point, Sequence | np.ndarray) or len(point) != 2:
                raise InputError(f"is {point!r}; expected [closure, pressure]", where=("points", i))
            closure, pressure = (number(value, ("points", i, k)) for k, value in enumerate(point))
            if not found and pressure != 0.0:
                words = f"is {pressure:g}; expected 0, the pressure where closure begins"
                raise InputError(words, where=("points", 0, 1))
            if found and not pressure > found[-1][1]:
                raise InputError(
                    f"is {pressure:g} after {found[-1][1]:g}; expected pressures that grow", where=("points", i, 1)
                )
            if found and closure < found[-1][0]:
                raise InputError(
                    f"is {closure:g} after {found[-1][0]:g}; expected closures that do not fall", where=("points", i, 0)
                )
            found.append((closure, pressure))
        if found[-1][0] == found[0][0]:
            raise InputError("do not close; expected a last closure beyond the first one", where=("points",))
        object.__setattr__(self, "points", tuple(found))
        if self.unloading is not None:
            object.__setattr__(self, "unloading", number(self.unloading, ("unloading",), above=0.0))
            closed, pressed = np.diff(np.array(found), axis=0).T
            steepest = float(np.divide(pressed, closed, out=np.full(len(closed), np.inf), where=closed > 0).max())
            if self.unloading < (1.0 - _SLOPE_ROUNDING) * steepest:
                words = f"is {self.unloading:g}, less than {steepest:g}, the steepest line of the points; expected more"
                raise InputError(words, where=("unloading",))

    @classmethod
    def exponential(cls, clearance: float, pressure: float, *, tolerance: float = 0.01) -> Self:
        """The law ``p = p_0 x (exp(x) - 1) / (e - 1)``, ``x = 1 + closure / c_0``, by secants.

        Parameters
        ----------
        clearance : c_0 > 0, the gap at which pressure begins, length
        pressure : p_0 > 0, where the sides touch
        tolerance : the most by which a secant lies above the law, of the pressure there and a hundredth of p_0. Six
            clearances beyond touching, where the pressure is 4460 p_0, the last secant goes on

        Examples
        --------
        >>> law = Closure.exponential(0.01, 2.0, tolerance=0.001)
        >>> round(float(np.interp(0.0, *np.transpose(law.points))), 2), law.points[0]
        (2.0, (-0.01, 0.0))
        """
        c = number(clearance, ("clearance",), above=0.0)
        p_0 = number(pressure, ("pressure",), above=0.0)
        law = cls.secants(lambda x: x * math.expm1(x) / math.expm1(1.0), 0.0, _END, tolerance)
        return cls([(c * (x - 1.0), p_0 * p) for x, p in law.points])

    @classmethod
    def secants(cls, pressure: Callable[[float], float], first: float, last: float, tolerance: float) -> Self:
        """Secants of a pressure that grows with the closure ever faster, between two closures.

        Parameters
        ----------
        pressure : of a closure, 0 at the first one; in units of the pressure where sides touch, or what else counts
        first, last : closures, beyond the last of which the last secant goes on
        tolerance : the most by which a secant lies above it, of the pressure there and a hundredth of the unit

        Raises
        ------
        InputError
            For a tolerance that is no number > 0, or takes more than 200 secants.

        Examples
        --------
        >>> Closure.secants(lambda closure: closure**2, 0.0, 1.0, 0.3).points[-1]
        (1.0, 1.0)
        """
        tol = number(tolerance, ("tolerance",), above=0.0)
        ends = [first]
        while ends[-1] < last and len(ends) <= _MOST_POINTS:
            low, high = ends[-1], last
            if _lies_above(pressure, low, high) > tol:
                for _ in range(60):  # halvings: an interval of numbers has no more
                    middle = 0.5 * (low + high)
                    if _lies_above(pressure, ends[-1], middle) <= tol:
                        low = middle
                    else:
                        high = middle
            ends.append(high)
        if ends[-1] < last:
            words = f"is {tol:g}, for which {_MOST_POINTS} secants are not enough; expected more"
            raise InputError(words, where=("tolerance",))
        return cls([(at, pressure(at)) for at in ends])

    @property
    def mean_compliance(self) -> float:
        """Closure per pressure up to the last point, length per pressure."""
        return (self.points[-1][0] - self.points[0][0]) / self.points[-1][1]

    def stored(self, pressure: Array) -> Array:
        """(n,) Energy per area that sides at pressures (n,) give back as they are let go.

        >>> Closure([(0.0, 0.0), (0.1, 2.0)]).stored(np.array([2.0])).round(12).tolist()
        [0.1]
        """
        if self.unloading is not None:
            return np.asarray(pressure**2 / (2.0 * self.unloading))
        lines = PairClosure.of([self], [0.0], [len(pressure)])
        assert lines is not None
        return lines.energy(pressure)

    @property
    def table(self) -> dict[str, Any]:
        """What a deck says of it."""
        return {"points": self.points} | ({} if self.unloading is None else {"unloading": self.unloading})

    @property
    def words(self) -> str:
        """What `check` says of it."""
        (first, _), (last, pressure) = self.points[0], self.points[-1]
        begins = "" if first == 0.0 else f" from {first:g}"
        back = "" if self.unloading is None else f", springs back by {self.unloading:g}"
        return f"closes{begins} to {last:g} under {pressure:g}, {len(self.points) - 1} lines{back}"


def _lies_above(pressure: Callable[[float], float], one: float, two: float) -> float:
    """How far a secant lies above a curve at most, of the pressure there and a hundredth of its unit."""
    at = np.linspace(one, two, 33)[1:-1]
    curve = np.array([pressure(x) for x in at])
    secant = np.interp(at, [one, two], [pressure(one), pressure(two)])
    return float(((secant - curve) / (curve + _FLOOR)).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class Borne:
    """What pairs that do not spring back along their lines remember.

    Attributes
    ----------
    pressure : (n,) the largest so far
    taken : (n,) energy that they have taken for good
    """

    pressure: Array
    taken: Array

    def half_way(self, other: Borne | None) -> Borne:
        """What is remembered half-way to another, where both are on one line of the way there."""
        if other is None:
            return self
        return Borne(pressure=0.5 * (self.pressure + other.pressure), taken=0.5 * (self.taken + other.taken))


@dataclass(frozen=True, kw_only=True, eq=False)
class PairClosure:
    """The closures of n pairs by their lines; arrays are (lines, n), with lines that a pair does not have at infinity.

    Closures are counted from where pressure begins.

    Attributes
    ----------
    begins : pressure from which a pair is on a line, 0 and so on
    compliance : closure per pressure on it
    rest : closure that the line has without pressure, length
    clearance : (n,) gap of the sides at which pressure begins, length
    springs : (n,) closure per pressure with which pairs spring back from the largest pressure; 0 of those that do so
        along their lines; None where all do

    Examples
    --------
    >>> pairs = PairClosure.of([Closure([(0.0, 0.0), (0.1, 2.0), (0.15, 10.0)]), None], [0.0, 0.5], [1, 1])
    >>> pairs.at(np.array([6.0, 6.0])).tolist(), pairs.energy(np.array([6.0, 6.0])).round(12).tolist()
    ([0.125, 3.0], [0.2, 9.0])
    """

    begins: Array
    compliance: Array
    rest: Array
    clearance: Array
    springs: Array | None = None

    @classmethod
    def of(
        cls, closures: Sequence[Closure | None], compliances: Sequence[float], counts: Sequence[int]
    ) -> PairClosure | None:
        """The closures of the pairs of contacts, which lie one after the other; None where no contact has one.

        Parameters
        ----------
        closures : of every contact; where there is none it has one line
        compliances : of every contact, length per pressure; of those without a closure
        counts : number of pairs of every contact
        """
        if not any(closures):
            return None
        size = max(len(closure.points) - 1 for closure in closures if closure is not None)
        parts = []
        for closure, compliance, count in zip(closures, compliances, counts, strict=True):
            lines = np.zeros((4, size))
            lines[0] = np.inf
            lines[:3, 0] = 0.0, compliance, 0.0
            if closure is not None:
                points = np.array(closure.points)
                lines[3] = -points[0, 0]
                begins, (closed, pressed) = points[:-1, 1], np.diff(points, axis=0).T
                slope = closed / pressed
                own = slice(len(slope))
                lines[0, own], lines[1, own] = begins, slope
                lines[2, own] = points[:-1, 0] - points[0, 0] - slope * begins
            parts.append(np.repeat(lines[:, :, None], count, axis=2))
        begins, compliance, rest, clearance = np.concatenate(parts, axis=2)
        springs = [1.0 / closure.unloading if closure and closure.unloading else 0.0 for closure in closures]
        return cls(
            begins=begins,
            compliance=compliance,
            rest=rest,
            clearance=clearance[0],
            springs=np.repeat(springs, counts) if any(springs) else None,
        )

    def after(self, borne: Borne | None) -> PairClosure:
        """The closures of pairs with a past: where they do not spring back along it, with a line of that before.

        Examples
        --------
        >>> pairs = PairClosure.of([Closure([(0.0, 0.0), (0.1, 2.0)], unloading=40.0)], [0.0], [1])
        >>> past = pairs.borne(None, np.array([2.0]), np.ones(1))
        >>> pairs.after(past).at(np.array([1.0])).round(12).tolist(), past.taken.round(12).tolist()
        ([0.075], [0.05])
        """
        if self.springs is None:
            return self
        peak = np.zeros(len(self.springs)) if borne is None else np.where(self.springs > 0.0, borne.pressure, 0.0)
        back = np.where(peak > 0.0, self.springs, self.compliance[0])
        kept = np.where(peak > 0.0, self.at(peak) - back * peak, 0.0)
        return replace(
            self,
            begins=np.concatenate([np.zeros((1, len(peak))), np.maximum(self.begins, peak)]),
            compliance=np.concatenate([back[None], self.compliance]),
            rest=np.concatenate([kept[None], self.rest]),
        )

    def borne(self, before: Borne | None, pressure: Array, area: Array) -> Borne | None:
        """What pairs remember; None where they need no past.

        Parameters
        ----------
        before : what they remembered; None for nothing
        pressure, area : (n,) of the moment, and forces per pressure
        """
        if self.springs is None:
            return None
        if before is None:
            before = Borne(pressure=np.zeros_like(pressure), taken=np.zeros_like(pressure))
        peak = np.maximum(before.pressure, pressure)
        lost = np.where(peak > before.pressure, self._lost(peak) - self._lost(before.pressure), 0.0)
        return Borne(pressure=frozen(peak), taken=frozen(before.taken + area * lost))

    def _lost(self, peak: Array) -> Array:
        """(n,) Energy per area that pairs keep of what took them to their largest pressures (n,)."""
        assert self.springs is not None
        return np.where(self.springs > 0.0, self.energy(peak) - self.springs * peak**2 / 2.0, 0.0)

    def among(self, kept: BoolArray) -> PairClosure:
        """The closures of the kept pairs, (n,)."""
        return replace(
            self,
            begins=self.begins[:, kept],
            compliance=self.compliance[:, kept],
            rest=self.rest[:, kept],
            clearance=self.clearance[kept],
            springs=None if self.springs is None else self.springs[kept],
        )

    def line(self, pressure: Array) -> IntArray:
        """(n,) Number of the line at pressures (n,); where two meet the one of higher pressures."""
        return np.asarray((self.begins[1:] <= pressure).sum(axis=0), dtype=np.int64)

    def of_lines(self, line: IntArray) -> tuple[Array, Array]:
        """Compliance and rest, each (n,), of lines (n,)."""
        pairs = np.arange(len(line))
        return self.compliance[line, pairs], self.rest[line, pairs]

    def ends(self, line: IntArray) -> tuple[Array, Array]:
        """Pressures, each (n,), at which lines (n,) begin and end; the last one ends nowhere."""
        pairs = np.arange(len(line))
        ends = np.concatenate([self.begins, np.full((1, len(pairs)), np.inf)])
        return ends[line, pairs], ends[line + 1, pairs]

    def beside(self, line: IntArray, below: BoolArray, above: BoolArray) -> IntArray:
        """(n,) The lines that follow on others.

        Parameters
        ----------
        line : (n,) numbers of those
        below, above : (n,) pairs that go on to lower and to higher pressures
        """
        low, high = self.ends(line)
        lower, upper = (self.begins < low).sum(axis=0) - 1, (self.begins <= high).sum(axis=0) - 1
        return np.where(below, np.maximum(lower, 0), np.where(above, upper, line)).astype(np.int64)

    def at(self, pressure: Array) -> Array:
        """(n,) Closure, length, at pressures (n,) >= 0."""
        compliance, rest = self.of_lines(self.line(pressure))
        return rest + compliance * pressure

    def distance(self, gap: Array, pressure: Array) -> Array:
        """(n,) Gaps of the sides themselves, of those in the law of contact, length.

        Parameters
        ----------
        gap, pressure : (n,) where a pair has a gap pressure does not begin, and where it has pressure it has no gap
        """
        return gap - self.at(pressure) + self.clearance

    def energy(self, pressure: Array) -> Array:
        """(n,) Energy per area that is stored at pressures (n,), ``int p dg``."""
        pairs, line = np.arange(len(pressure)), self.line(pressure)
        own = self.compliance[line, pairs] * (pressure**2 - self.begins[line, pairs] ** 2) / 2.0
        return np.asarray(self._stored[line, pairs] + own)

    @cached_property
    def _stored(self) -> Array:
        """(lines, n) Energy per area where every line begins."""
        squares = np.where(np.isfinite(self.begins), self.begins, 0.0) ** 2
        each = self.compliance[:-1] * np.maximum(np.diff(squares, axis=0), 0.0) / 2.0
        return np.concatenate([np.zeros((1, squares.shape[1])), np.cumsum(each, axis=0)])

    @property
    def parameters(self) -> dict[str, Array]:
        """(n,) What there is of every pair by name; NaN where there is none."""
        found = {"clearance of the closure": self.clearance}
        if self.springs is not None:
            found["compliance of unloading"] = self.springs
        for k in range(len(self.begins)):
            has = np.isfinite(self.begins[k])
            found |= {
                f"begin of line {k + 1} of the closure": np.where(has, self.begins[k], np.nan),
                f"compliance of line {k + 1} of the closure": np.where(has, self.compliance[k], np.nan),
            }
        return found
