# SPDX-License-Identifier: BSD-3-Clause
"""A history as the points at which its pieces end: everything that the derivatives of its answers go through.

Between two points no pair changes its state. A point is an event of some pair, whose load moves with what is varied, or
the end of a straight part of the loads or of an increment, whose load is given.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.derivative.conditions import (
    PieceConditions,
    PieceEnd,
    PieceEvent,
    options,
    plane_conditions,
    plane_slips,
)
from signorini.derivative.interface_system import InterfaceSystem, PairStates
from signorini.derivative.quiet_ends import QuietEnd
from signorini.derivative.space_conditions import (
    space_conditions,
    space_slips,
)
from signorini.errors import InputError
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.solution.state import LoadPoint

GRAZES = 1e-9
"""Of the fastest condition of a piece: one that hardly moves."""

ZERO = 1e-10
"""Of the data of the law: a gap, a force or another condition that is none."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TapePoint:
    """The end of a piece; motions and forces are scaled, of the active pairs.

    Attributes
    ----------
    leg : number of the straight part
    system : the interface in it
    load : everything that is imposed here
    load_factor : of the history, k at the end of step k
    part : of the leg that is behind, 0 .. 1
    states : of the pairs in the piece
    h, r : (d, n) motions and forces here
    h_rate, r_rate : (d, n) per unit of the part of the leg, on a path in the plane; None elsewhere
    load_rate : (d n + k,) in space, of what the equations see of the load on a path; None elsewhere
    quiet : in space, how it moves in the middle of a leg where nothing happens; None elsewhere
    trials : ends of the increments that told the length of that
    passes : in space, whether an event in the piece would not end it
    at_rest : whether it is where the history begins, in the states that pairs are in from there on
    displacement : (dofs,) at the end of an increment, where the history has found them; None elsewhere
    acting : (m,) pairs whose event it is; empty where the load is given
    acts : number of the condition that vanishes there, where it is known; None: that which does so most closely
    increment : (n,) or all: whether the friction of a pair in the piece is that of its end, as in an increment
    """

    leg: int
    system: InterfaceSystem
    load: LoadPoint
    load_factor: float
    part: float
    states: PairStates
    h: Array
    r: Array
    h_rate: Array | None
    r_rate: Array | None
    acting: IntArray
    increment: bool | BoolArray
    load_rate: Array | None = None
    quiet: QuietEnd | None = None
    trials: tuple[TapePoint, ...] = ()
    passes: bool = False
    at_rest: bool = False
    acts: int | None = None
    displacement: Array | None = None

    @property
    def at_event(self) -> bool:
        """Whether the load here moves with what is varied."""
        return len(self.acting) > 0

    @property
    def tied(self) -> bool:
        """Whether the load here is that up to which several pairs turn alike, and farthest."""
        return self.quiet is not None and self.quiet.tied

    @cached_property
    def stays(self) -> IntArray:
        """Numbers of the conditions of pairs that stick at their limit in an increment, which rounding tells apart."""
        if self.quiet is None:
            return np.zeros(0, dtype=np.int64)
        known, sticks = self.conditions, np.asarray(self.states.held.all(axis=0))
        none = np.abs(known.value) <= ZERO * (self.system.law.scale or 1.0)
        return np.flatnonzero(none & sticks[known.pair] & known.friction.any(axis=0))

    @property
    def ends_at_events(self) -> bool:
        """Whether any event in the piece would end it."""
        return self.rates is not None and not self.passes

    @property
    def on_linear_path(self) -> bool:
        """Whether it is on a path that is linear from one event to the next: in the plane, and on polygons."""
        law = self.system.law
        cones = self.states.codes is None and bool((law.law.rubs & (law.section.sides == 0)).any())
        return self.ends_at_events and not cones

    @cached_property
    def rates(self) -> tuple[Array, Array] | None:
        """(d, n) Of motions and forces per unit of the part of the leg; None in equal increments."""
        if self.h_rate is not None and self.r_rate is not None:
            return self.h_rate, self.r_rate
        if self.load_rate is None:
            return None
        with self.determined():
            return self.system.respond(self.states, self.load_rate)

    @contextmanager
    def determined(self) -> Iterator[None]:
        """Refuse states, of this point or of those that go with it, that leave motions or forces undetermined."""
        try:
            yield
        except SingularState:
            raise InputError(
                f"at load factor {self.load_factor:.9g} a body moves freely, or contacts share what they carry as they "
                "like: derivatives are not unique; expected a history in which supports or sticking contacts hold it"
            ) from None

    @cached_property
    def piece_end(self) -> PieceEnd:
        """Where the piece is left, as its conditions see it."""
        rates = self.rates if self.at_event or self.h_rate is not None else None
        return PieceEnd(law=self.system.law, states=self.states, h=self.h, r=self.r, rates=rates)

    @cached_property
    def conditions(self) -> PieceConditions:
        """What holds in the piece."""
        return (space_conditions if self.states.codes is None else plane_conditions)(self.piece_end)

    @property
    def slips(self) -> tuple[IntArray, Array]:
        """Pairs that slip, (m,), and w (d - 1, m): numbers ``w . slip`` of the piece that friction keeps positive."""
        return (space_slips if self.states.codes is None else plane_slips)(self.states, self.system.law)

    @cached_property
    def event(self) -> PieceEvent:
        """The condition that ends the piece: of all acting pairs that which vanishes most closely here.

        Raises
        ------
        InputError
            Where it comes to zero without speed.
        """
        assert self.rates is not None
        found = [event for event in self._events if event.rate < 0.0]
        if not found:
            raise InputError(f"the event at load factor {self.load_factor:.9g} has no pair that goes through it")
        first = min(found, key=lambda event: abs(event.value / event.rate))
        if -first.rate <= GRAZES * self.fastest:
            words = f"a pair grazes its event at load factor {self.load_factor:.9g}, which it comes to without speed"
            raise InputError(f"{words}: derivatives are infinite there")
        return first

    @property
    def fastest(self) -> float:
        """Rate of the gap or force that moves fastest."""
        assert self.rates is not None
        return max(float(np.abs(self.rates[0][0]).max()), float(np.abs(self.rates[1]).max()))

    @property
    def _events(self) -> Iterable[PieceEvent]:
        """The conditions of the acting pairs, or that which is known to be the event."""
        if self.acts is not None:
            return [self.conditions.event(self.acts)]
        if self.states.codes is None:
            return map(self.conditions.event, np.flatnonzero(np.isin(self.conditions.pair, self.acting)).tolist())
        return chain.from_iterable(options(self.piece_end, int(pair)) for pair in self.acting)

    @cached_property
    def shared(self) -> list[int]:
        """Numbers of the conditions of acting pairs that vanish with that of the event; in space also of the same pair.

        One that sticks may come to both facets that meet in a corner of its polygon.
        """
        in_space = self.states.codes is None
        if len(self.acting) == 1 and not in_space:
            return []
        known, found = self.conditions, list[int]()
        falls = known.rate < -GRAZES * self.fastest
        vanish = falls & in_space & (np.abs(known.value) <= ZERO * (self.system.law.scale or 1.0))
        for pair in self.acting:
            own = np.flatnonzero((known.pair == pair) & falls)
            if pair != self.event.pair and len(own):
                vanish[own[np.argmin(np.abs(known.value[own] / known.rate[own]))]] = True
            found += own[vanish[own]].tolist()
        number = known.number(self.event)
        return [k for k in found if k != number]


def factors_of(points: Sequence[TapePoint]) -> tuple[list[str], Array]:
    """Names of loads and moving supports, and their factors (names, p)."""
    names = sorted({name for point in points for name in point.load.factors})
    found = [[point.load.factors.get(name, 0.0) for point in points] for name in names]
    return names, np.array(found).reshape(len(names), len(points))


def forces_of(points: Sequence[TapePoint]) -> Array:
    """(d a, p) Forces of the active pairs of points of one system."""
    return np.stack([(point.system.root * point.r).ravel() for point in points], axis=-1)


def offsets_of(points: Sequence[TapePoint]) -> Array:
    """(p, d, a) Motions of the active pairs of points of one system by gaps and by what supports impose."""
    system = points[0].system
    found = np.zeros((len(points), system.directions, system.pairs))
    for name, factor in zip(*factors_of(points), strict=True):
        if name in system.prepared.constraints.prescribed and factor.any():
            found += factor[:, None, None] * system.unit(name).offset
    found[:, 0] += np.stack([point.load.gap[system.active] for point in points])
    return found


def with_trials(points: Sequence[TapePoint]) -> Sequence[TapePoint]:
    """The points of a history, and behind them the ends of the trials that told lengths of its increments."""
    tried = [trial for point in points for trial in point.trials]
    return [*points, *tried] if tried else points
