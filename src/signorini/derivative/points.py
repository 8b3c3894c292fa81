# SPDX-License-Identifier: BSD-3-Clause
"""A history as the points at which its pieces end: everything that the derivatives of its answers go through.

Between two points no pair changes its state. A point is an event of some pair, whose load moves with what is varied, or
the end of a straight part of the loads or of an increment, whose load is given.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, pairwise

import numpy as np
import scipy.linalg

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
from signorini.derivative.locked_bolts import LockedBolts
from signorini.derivative.quiet_ends import QuietEnd, quiet_end
from signorini.derivative.space_conditions import (
    acting_pairs,
    events_of,
    space_conditions,
    space_slips,
    states_of_piece,
)
from signorini.derivative.step_friction import in_force
from signorini.engine.tape import Leg, Tape
from signorini.errors import InputError
from signorini.friction.history import PathState
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.friction.history.segment import Breakpoint
from signorini.law.states import OPEN, SLIP_PLUS
from signorini.solution.state import LoadPoint

GRAZES = 1e-9
"""Of the fastest condition of a piece: one that hardly moves."""

_VANISHES = 1e-10  # of the data: a condition that vanishes with another
_STANDSTILL = 1e-13  # of a segment: a piece that is no longer
_TOUCHES = 1e-9  # of the largest gap, and of what rigid motions open most: none
_NOBODY: IntArray = np.zeros(0, dtype=np.int64)  # acts at a given load


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
    displacement: Array | None = None

    @property
    def at_event(self) -> bool:
        """Whether the load here moves with what is varied."""
        return len(self.acting) > 0

    @property
    def on_linear_path(self) -> bool:
        """Whether it is on a path that is linear from one event to the next: in the plane, and on polygons."""
        law = self.system.law
        cones = self.states.codes is None and bool((law.law.rubs & (law.section.sides == 0)).any())
        return self.rates is not None and not self.passes and not cones

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
        found = [event for event in self._events() if event.rate < 0.0]
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

    def _events(self) -> Iterator[PieceEvent]:
        """The conditions of the acting pairs."""
        if self.states.codes is None:
            return events_of(self.conditions, self.acting)
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
        vanish = falls & in_space & (np.abs(known.value) <= _VANISHES * (self.system.law.scale or 1.0))
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


def tape_points(tape: Tape) -> list[TapePoint]:
    """The points of a history, in order."""
    systems: dict[int, InterfaceSystem] = {}
    points: list[TapePoint] = []
    friction: dict[str, str] = {}
    locked = LockedBolts()
    for number, leg in enumerate(tape.legs):
        friction = in_force(leg, friction)
        if id(leg.prepared) not in systems:
            systems[id(leg.prepared)] = InterfaceSystem(locked.posed(leg.prepared), friction, dict(locked.lengths))
        system = systems[id(leg.prepared)]
        if leg.segment is None:
            points += _in_increments(number, leg, system)
        else:
            points += (_on_path if system.directions == 2 else _in_space)(number, leg, system)
    return points


def with_trials(points: Sequence[TapePoint]) -> Sequence[TapePoint]:
    """The points of a history, and behind them the ends of the trials that told lengths of its increments."""
    tried = [trial for point in points for trial in point.trials]
    return [*points, *tried] if tried else points


def _on_path(number: int, leg: Leg, system: InterfaceSystem) -> Iterator[TapePoint]:
    """The points of a leg that was followed exactly; overlaps that press at its beginning are an increment."""
    assert leg.segment is not None
    point = leg.before.point
    yield from _pressed(number, leg, system)
    # a leg whose end wakes a body that rests ends at an event, and is the part of the segment up to there
    pieces, reach, whole = leg.segment.pieces, leg.segment.pieces[-1].factor, leg.segment.followed
    before = 0.0
    for piece in pieces[1:]:
        assert piece.state is not None
        assert piece.rates is not None
        assert piece.acting is not None
        if piece.factor - before >= _STANDSTILL:
            part = piece.factor / reach
            moves = piece.factor < 1.0 or not whole
            yield TapePoint(
                leg=number,
                system=system,
                load=system.posed(point.towards(leg.end, part)),
                load_factor=leg.low + part * (leg.high - leg.low),
                part=part,
                states=system.states_of_codes(piece.state.state),
                h=piece.h,
                r=piece.r,
                h_rate=reach * piece.rates.h,
                r_rate=reach * piece.rates.r,
                acting=piece.acting if moves else _NOBODY,
                increment=False,
            )
        before = piece.factor


def _pressed(number: int, leg: Leg, system: InterfaceSystem) -> Iterator[TapePoint]:
    """What overlaps at the beginning of a leg that was followed, and presses: an increment."""
    start, space = leg.start, system.directions == 3
    assert start is not None
    if start.r.any() and not leg.before.forces.any():
        none = np.zeros_like(start.h)
        yield TapePoint(
            leg=number,
            system=system,
            load=system.posed(leg.before.point),
            load_factor=leg.low,
            part=0.0,
            states=states_of_piece(system.law, start.state, (none, none), (start.h, start.r))
            if space
            else system.states_of_codes(start.state),
            h=start.h,
            r=start.r,
            h_rate=None,
            r_rate=None,
            acting=_NOBODY,
            increment=True,
        )


def _in_space(number: int, leg: Leg, system: InterfaceSystem) -> Iterator[TapePoint]:
    """The points of a leg in space that was followed to events: some of its pieces end where nothing happens."""
    assert leg.segment is not None
    assert leg.start is not None
    yield from _pressed(number, leg, system)
    pieces, whole = leg.segment.pieces, leg.segment.followed
    load_rate = system.free(leg.segment.end.b - leg.start.b)
    for k, (before, piece) in enumerate(pairwise(pieces), start=1):
        found = _increment(number, leg, system, (before, piece), load_rate)
        if piece.factor < 1.0 or not whole:
            acting = acting_pairs(found.conditions, (before.h, before.r), found.piece_end)
            if len(acting):
                found = replace(found, acting=acting)
            else:
                trials = tuple(_increment(number, leg, system, (before, one), load_rate) for one in piece.search)
                rates = [trial.rates[1] for trial in trials if trial.rates is not None]
                found = replace(found, quiet=quiet_end(system.law, pieces, k, rates), trials=trials)
        yield found


def _increment(
    number: int, leg: Leg, system: InterfaceSystem, ends: tuple[Breakpoint, Breakpoint], load_rate: Array
) -> TapePoint:
    """The end of a piece in space, or of one that was tried, at a load that is given.

    Parameters
    ----------
    number, leg, system : the leg and the interface in it
    ends : of the piece
    load_rate : see `TapePoint`
    """
    before, piece = ends
    assert leg.segment is not None
    assert piece.state is not None
    part = piece.factor / leg.segment.pieces[-1].factor
    return TapePoint(
        leg=number,
        system=system,
        load=system.posed(leg.before.point.towards(leg.end, part)),
        load_factor=leg.low + part * (leg.high - leg.low),
        part=part,
        states=states_of_piece(system.law, piece.state.state, (before.h, before.r), (piece.h, piece.r)),
        h=piece.h,
        r=piece.r,
        h_rate=None,
        r_rate=None,
        acting=_NOBODY,
        increment=_late(before.state, piece.state),
        load_rate=load_rate,
        passes=piece.passes,
    )


def _late(before: PathState | None, after: PathState) -> BoolArray:
    """(n,) Pairs that friction took work from as if they had slipped under that of the end of the piece."""
    assert before is not None
    moved, taken = after.h[1:] - before.h[1:], after.dissipation - before.dissipation
    at_end, in_mean = (-(r[1:] * moved).sum(axis=0) for r in (after.r, 0.5 * (before.r + after.r)))
    return np.asarray(np.abs(taken - at_end) < np.abs(taken - in_mean), dtype=np.bool_)


def _touching(system: InterfaceSystem, h: Array, where: str) -> PairStates:
    """The states at the end of a rigid motion: as many pairs touch, without a force, as tell where the bodies are.

    Raises
    ------
    InputError
        Where so many do not touch.
    """
    touches = np.flatnonzero(h[0] <= _TOUCHES * np.abs(h[0]).max())
    rigid = system.law.image.R[touches]
    factor, order = scipy.linalg.qr(rigid.T, mode="r", pivoting=True)
    pivots = np.abs(np.diag(factor[0] if isinstance(factor, tuple) else factor))
    if len(pivots) < system.motions or pivots.min() <= _TOUCHES * pivots.max():
        raise InputError(f"{where}: derivatives do not know bodies that a load carries along the side that they touch")
    codes = np.full(system.pairs, OPEN)
    codes[touches[order[: system.motions]]] = SLIP_PLUS
    return system.states_without_friction(codes)


def _in_increments(number: int, leg: Leg, system: InterfaceSystem) -> Iterator[TapePoint]:
    """The ends of the increments of a leg."""
    active, root = system.active, system.root
    for k, state in enumerate(leg.states, start=1):
        part = k / len(leg.states)
        h, r = root * state.motion[:, active], state.forces[:, active] / root
        slipped = np.concatenate([h[:1], root * state.increment[:, active]])
        yield TapePoint(
            leg=number,
            system=system,
            load=system.posed(state.point),
            load_factor=leg.low + part * (leg.high - leg.low),
            part=part,
            states=_touching(system, h, leg.where)
            if leg.carried
            else system.states_of_increment(state.status[active], slipped, r),
            h=h,
            r=r,
            h_rate=None,
            r_rate=None,
            acting=_NOBODY,
            increment=leg.low < leg.high,  # at once friction does the work of its mean
            displacement=None if leg.carried else state.displacement,
        )
