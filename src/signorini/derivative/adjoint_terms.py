# SPDX-License-Identifier: BSD-3-Clause
"""How an output changes with what drives the points of a history: what the way back through them leaves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from signorini.arrays import Array
from signorini.derivative.conditions import PieceEvent
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.points import TapePoint
from signorini.law.bound import FrictionBound


@dataclass(kw_only=True, eq=False)
class BoundTerm:
    """Numbers for the friction bound of the active pairs of one system, scaled, (branches, a) each.

    What a parameter changes of them, or how an output changes with them.

    Attributes
    ----------
    slopes, starts, kinks : of the branches, and of where they begin
    """

    slopes: Array
    starts: Array
    kinks: Array

    @classmethod
    def of(cls, bound: FrictionBound) -> BoundTerm:
        """Zero, for a bound."""
        return cls(**{name: np.zeros_like(bound.slopes) for name in ("slopes", "starts", "kinks")})

    def along(self, change: BoundTerm) -> float:
        """What a change of the bound changes of the output whose term this is."""
        return sum(float(np.vdot(getattr(self, name), getattr(change, name))) for name in ("slopes", "starts", "kinks"))


@dataclass(kw_only=True, eq=False)
class Weights:
    """How a number changes with motions and forces of all pairs, (d, n), at a point."""

    h: Array
    r: Array

    def any(self) -> bool:
        """Whether it does."""
        return bool(self.h.any() or self.r.any())


@dataclass(frozen=True, kw_only=True, eq=False)
class PointTerm:
    """How an output changes with what drives a point where no pair moves.

    Attributes
    ----------
    motion : (d, a) per length, with motions of the active pairs
    resultant : (k,) per force, with resultants of loads
    """

    motion: Array
    resultant: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class TermStack:
    """The terms of some points of one system.

    Attributes
    ----------
    system : the interface
    numbers : of the points
    motion, resultant : (p, d, a) and (p, k), as of `PointTerm`
    """

    system: InterfaceSystem
    numbers: list[int]
    motion: Array
    resultant: Array

    def of(self, motion: Array, resultant: Array, factors: Array) -> float:
        """What the same motions and resultants at every point, times a factor each, change of the output.

        Parameters
        ----------
        motion, resultant : (d, a) length and (k,) force
        factors : (p,)
        """
        of_motion, of_resultant = np.tensordot(factors, self.motion, axes=1), factors @ self.resultant
        return float(np.vdot(of_motion, motion) + of_resultant @ resultant)


class ByPlaces(Protocol):
    """A part of a sum over a history of products of adjoint and actual displacements, ``sum w . K u``."""

    def by_places(self) -> Any:
        """(nodes d,) How it changes with the place of every node, where vectors of all displacements are."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Adjoint:
    """An output by everything that drives the points.

    Attributes
    ----------
    stacks : of the points that matter, one a system
    bounds : by system
    remembered : (d - 1, n) per length, with tangential motions that are remembered before the first point
    behind : (d - 1, n) the same behind some points, by number
    weights : how the output changes with motions and forces directly, by number of the point
    by_places : (nodes d,) by numbers of points, how the output changes with places of nodes by stresses there, kept
        where vectors of all displacements are
    pulled : (z,) by number of the point, of outputs of bodies: free displacements where what the output changes with
        pulls on them
    """

    stacks: tuple[TermStack, ...]
    bounds: dict[InterfaceSystem, BoundTerm]
    remembered: Array
    behind: dict[int, Array] = field(default_factory=dict)
    weights: dict[int, Weights] = field(default_factory=dict)
    by_places: dict[tuple[int, ...], Any] = field(default_factory=dict)
    pulled: dict[int, Array] = field(default_factory=dict)

    def work_by_places(self, own: Sequence[int], parts: Iterable[ByPlaces]) -> Any:
        """(nodes d,) How ``sum w . K u`` changes with the place of every node, kept.

        Parameters
        ----------
        own : numbers of the points that it is over
        parts : of the sum, which are not asked for again
        """
        if tuple(own) not in self.by_places:
            self.by_places[tuple(own)] = sum(part.by_places() for part in parts)
        return self.by_places[tuple(own)]

    @cached_property
    def by_gaps(self) -> Array:
        """(n,) How the output changes with the gap of every pair, per length."""
        found = np.zeros(self.remembered.shape[1])
        for stack in self.stacks:
            found[stack.system.active] += stack.motion[:, 0].sum(axis=0)
        return found

    @cached_property
    def terms(self) -> dict[int, PointTerm]:
        """By number of the point, those that matter alone."""
        return {
            i: PointTerm(motion=motion, resultant=resultant)
            for stack in self.stacks
            for i, motion, resultant in zip(stack.numbers, stack.motion, stack.resultant, strict=True)
        }


class PassedPoints:
    """Points of one system that were passed backwards: what of their responses is looked at all at once.

    Parameters
    ----------
    system : the interface

    Attributes
    ----------
    numbers : of the points
    bound : how the output changes with the friction of the pairs
    """

    def __init__(self, system: InterfaceSystem) -> None:
        self.system, self.bound = system, BoundTerm.of(system.law.pieces)
        self.numbers: list[int] = []
        self._points: list[TapePoint] = []
        self._free: list[Array] = []
        self._pushed: list[Array] = []

    def take(self, numbers: Sequence[int], points: Sequence[TapePoint], free: Array, pushed: Array) -> None:
        """Take points.

        Parameters
        ----------
        numbers, points : of the points, and the points
        free, pushed : (p, d n + k), (p, d - 1, n) how the output changes with their loads, and directly with friction
        """
        self.numbers += numbers
        self._points += points
        self._free.append(free)
        self._pushed.append(pushed)

    def take_event(self, event: PieceEvent, share: float) -> None:
        """What the condition of an event asks of the friction, as far as the output changes with the condition.

        Parameters
        ----------
        event, share : the event, and how the output changes with its condition
        """
        at = event.branch, event.pair
        self.bound.starts[at] += share * event.start
        self.bound.slopes[at] += share * event.slope
        self.bound.kinks[at] += share * event.kink

    def stack(self, direct: Mapping[int, Array]) -> TermStack:
        """The terms of the points, with what is known directly of some; what they ask of friction goes to the bound."""
        free = np.concatenate(self._free)
        motion, resultant = self.system.condensed.free_transposed(free)
        for k, i in enumerate(self.numbers):
            if i in direct:
                motion[k] += direct[i]
        self._add_friction(free)
        return TermStack(system=self.system, numbers=self.numbers, motion=motion, resultant=resultant)

    def _add_friction(self, free: Array) -> None:
        """How the output changes with the bound of pairs that slip: forces of that size beside all that is imposed."""
        states = [point.states for point in self._points]
        units = np.stack([known.unit for known in states])
        n = units.shape[-1]
        rubs = np.flatnonzero(units.any(axis=0).ravel())  # of tangents and pairs
        if not len(rubs):
            return
        image, last = self.system.law.image, units[0].size + n
        moved = free[:, :last] @ image.A[:, n + rubs] + free[:, last:] @ image.R[n + rubs].T
        pushed = np.concatenate(self._pushed).reshape(len(free), -1)
        pushed[:, rubs] += moved
        size = (units * pushed.reshape(units.shape)).sum(axis=1)
        pressing = size * np.maximum(np.stack([point.r[0] for point in self._points]), 0.0)
        branch = np.stack([known.branch for known in states])
        for j in range(len(self.bound.starts)):
            on = branch == j
            self.bound.starts[j] += np.where(on, size, 0.0).sum(axis=0)
            self.bound.slopes[j] += np.where(on, pressing, 0.0).sum(axis=0)
