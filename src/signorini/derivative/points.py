# SPDX-License-Identifier: BSD-3-Clause
"""A history as the points at which its pieces end: everything that the derivatives of its answers go through.

Between two points no pair changes its state. A point is an event of some pair, whose load moves with what is varied, or
the end of a straight part of the loads or of an increment, whose load is given.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.derivative.interface_system import InterfaceSystem, PairStates
from signorini.engine.tape import Leg, Tape
from signorini.errors import InputError
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED
from signorini.solution.state import LoadPoint

_GRAZES = 1e-9  # of the fastest condition of a piece: one that hardly moves
_STANDSTILL = 1e-13  # of a segment: a piece that is no longer


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceConditions:
    """What must not be negative in a piece: numbers g of one pair each, linear in its motions and forces.

    Attributes
    ----------
    pair : (m,) numbers of active pairs
    gap, pressure, friction : (m,) how g changes with the gap, the normal and the tangential force
    branch : (m,) of the bound that it asks of
    start, slope, kink : (m,) how g changes with the start and the slope of that branch, and with where it begins
    value, rate : (m,) of g at the end of the piece, and per unit of the part of the leg; 0 in increments
    """

    pair: IntArray
    gap: Array
    pressure: Array
    friction: Array
    branch: IntArray
    start: Array
    slope: Array
    kink: Array
    value: Array
    rate: Array

    def change(self, h: Array, r: Array) -> Array:
        """(m,) What motions and forces, (d, n), change of g."""
        return self.gap * h[0, self.pair] + self.pressure * r[0, self.pair] + self.friction * r[1, self.pair]

    def number(self, event: PieceEvent) -> int:
        """Of an event among the conditions."""
        same = (self.pair == event.pair) & (self.gap == event.gap) & (self.friction == event.friction)
        return int(np.flatnonzero(same & (self.kink == event.kink) & (self.branch == event.branch))[0])


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceEvent:
    """The condition that ends a piece, see `PieceConditions`: of one pair.

    Attributes
    ----------
    pair, branch : its number, and of the branch of its bound
    gap, pressure, friction, start, slope, kink : how g changes with these
    value, rate : of g at the end of the piece, and per unit of the part of the leg
    """

    pair: int
    gap: float
    pressure: float
    friction: float
    branch: int
    start: float
    slope: float
    kink: float
    value: float
    rate: float

    def change(self, h: Array, r: Array) -> float:
        """What motions and forces, (d, n), change of g."""
        return float(self.gap * h[0, self.pair] + self.pressure * r[0, self.pair] + self.friction * r[1, self.pair])


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
    h_rate, r_rate : (d, n) per unit of the part of the leg; None where the load is given
    acting : (m,) pairs whose event it is; empty where the load is given
    increment : whether the piece is an increment, whose friction is that of its end
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
    increment: bool

    @property
    def at_event(self) -> bool:
        """Whether the load here moves with what is varied."""
        return self.h_rate is not None and len(self.acting) > 0

    @cached_property
    def conditions(self) -> PieceConditions:
        """What holds in the piece, in the plane."""
        return _conditions(self)

    @cached_property
    def event(self) -> PieceEvent:
        """The condition that ends the piece: of all acting pairs that which vanishes most closely here.

        Raises
        ------
        InputError
            Where it comes to zero without speed.
        """
        assert self.h_rate is not None
        assert self.r_rate is not None
        found = [event for pair in self.acting for event in _options(self, int(pair)) if event.rate < 0.0]
        if not found:
            raise InputError(f"the event at load factor {self.load_factor:.9g} has no pair that goes through it")
        first = min(found, key=lambda event: abs(event.value / event.rate))
        fastest = max(float(np.abs(self.h_rate[0]).max()), float(np.abs(self.r_rate).max()))
        if -first.rate <= _GRAZES * fastest:
            words = f"a pair grazes its event at load factor {self.load_factor:.9g}, which it comes to without speed"
            raise InputError(f"{words}: derivatives are infinite there")
        return first

    @cached_property
    def shared(self) -> list[int]:
        """Numbers of the conditions of other acting pairs that vanish with that of the event."""
        found, known = [], self.conditions
        for pair in self.acting[self.acting != self.event.pair]:
            own = np.flatnonzero((known.pair == pair) & (known.rate < 0.0))
            if len(own):
                found.append(int(own[np.argmin(np.abs(known.value[own] / known.rate[own]))]))
        return found


def tape_points(tape: Tape) -> list[TapePoint]:
    """The points of a history, in order."""
    systems: dict[int, InterfaceSystem] = {}
    points: list[TapePoint] = []
    for number, leg in enumerate(tape.legs):
        system = systems.setdefault(id(leg.prepared), InterfaceSystem(leg.prepared))
        points += _on_path(number, leg, system) if leg.segment is not None else _in_increments(number, leg, system)
    return points


def beyond(point: TapePoint, condition: int) -> TapePoint | None:
    """A point with the pair of a condition in the state that follows it; None where that is not one alone.

    A pair that closes may stick or slip, either way, as the parameter has it.
    """
    known, codes = point.conditions, point.states.codes
    if codes is None or known.gap[condition] or known.kink[condition]:
        return None
    pair, after = known.pair[condition], codes.copy()
    friction = known.friction[condition]
    slips = (SLIP_PLUS if friction < 0.0 else SLIP_MINUS) + 2 * known.branch[condition]
    after[pair] = slips if friction else OPEN
    return replace(point, states=point.system.states_of_codes(after))


def _on_path(number: int, leg: Leg, system: InterfaceSystem) -> Iterator[TapePoint]:
    """The points of a leg that was followed exactly; overlaps that press at its beginning are an increment."""
    assert leg.segment is not None
    assert leg.start is not None
    start, point = leg.start, leg.before.point
    nobody = np.zeros(0, dtype=np.int64)
    if start.r.any() and not leg.before.forces.any():
        states = system.states_of_codes(start.state)
        yield TapePoint(
            leg=number,
            system=system,
            load=point,
            load_factor=leg.low,
            part=0.0,
            states=states,
            h=start.h,
            r=start.r,
            h_rate=None,
            r_rate=None,
            acting=nobody,
            increment=True,
        )
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
                load=point.towards(leg.end, part),
                load_factor=leg.low + part * (leg.high - leg.low),
                part=part,
                states=system.states_of_codes(piece.state.state),
                h=piece.h,
                r=piece.r,
                h_rate=reach * piece.rates.h,
                r_rate=reach * piece.rates.r,
                acting=piece.acting if moves else nobody,
                increment=False,
            )
        before = piece.factor


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
            load=state.point,
            load_factor=leg.low + part * (leg.high - leg.low),
            part=part,
            states=system.states_of_increment(state.status[active], slipped, r),
            h=h,
            r=r,
            h_rate=None,
            r_rate=None,
            acting=np.zeros(0, dtype=np.int64),
            increment=True,
        )


def _options(point: TapePoint, pair: int) -> Iterator[PieceEvent]:
    """What may happen to a pair in a piece, as `_conditions` has it of all pairs."""
    law, states = point.system.law, point.states
    assert states.codes is not None
    assert point.h_rate is not None
    assert point.r_rate is not None
    code, bound, at = int(states.codes[pair]), law.pieces, (0, pair)
    gap, p, q = float(point.h[at]), float(point.r[at]), float(point.r[1, pair])
    gap_rate, p_rate, q_rate = float(point.h_rate[at]), float(point.r_rate[at]), float(point.r_rate[1, pair])

    def of(
        branch: int = 0, *, gap: float = 0.0, pressure: float = 0.0, friction: float = 0.0, **more: float
    ) -> PieceEvent:
        parts = {"start": 0.0, "slope": 0.0, "kink": 0.0} | more
        rate = gap * gap_rate + pressure * p_rate + friction * q_rate
        return PieceEvent(pair=pair, branch=branch, gap=gap, pressure=pressure, friction=friction, rate=rate, **parts)

    if code == OPEN:
        yield of(gap=1.0, value=gap)
        return
    yield of(pressure=1.0, value=p)
    if code == STICK and law.law.closed[pair] == UNDECIDED and not law.unbounded[pair]:
        for j in range(int(bound.branch_counts[pair])):
            slope, start = float(bound.slopes[j, pair]), float(bound.starts[j, pair])
            for s in (1.0, -1.0):
                value = start + slope * p - s * q
                yield of(j, pressure=slope, friction=-s, start=1.0, slope=p, value=value)
    if code > STICK:
        j, kinks = int(states.branch[pair]), bound.kinks[:, pair]
        if j:
            yield of(j, pressure=1.0, kink=-1.0, value=p - float(kinks[j]))
        if j + 1 < bound.branches and np.isfinite(kinks[j + 1]):
            yield of(j + 1, pressure=-1.0, kink=1.0, value=float(kinks[j + 1]) - p)


def _conditions(point: TapePoint) -> PieceConditions:
    """Gaps of open pairs, pressures of closed ones, friction to spare, and kinks of the bounds of those that slip."""
    law, states, gap = point.system.law, point.states, point.h[0]
    p, q = point.r
    codes, bound = states.codes, law.pieces
    assert codes is not None
    n, zero, one = len(codes), np.zeros(len(codes)), np.ones(len(codes))
    opened, stick = codes == OPEN, (codes == STICK) & (law.law.closed == UNDECIDED) & ~law.unbounded
    slips = codes > STICK
    rows: list[tuple[BoolArray, Array, Array, Array, int | IntArray, Array, Array, Array, Array]] = [
        (opened, one, zero, zero, 0, zero, zero, zero, gap),
        (~opened, zero, one, zero, 0, zero, zero, zero, p),
    ]
    for j in range(bound.branches):
        has = stick & np.isfinite(bound.kinks[j])
        spare = bound.starts[j] + bound.slopes[j] * p
        rows += [(has, zero, bound.slopes[j], -s * one, j, one, p, zero, spare - s * q) for s in (1.0, -1.0)]
    for j in range(1, bound.branches):
        there, below = slips & (states.branch == j), slips & (states.branch == j - 1)
        rows.append((there, zero, one, zero, j, zero, zero, -one, p - bound.kinks[j]))
        ends = below & np.isfinite(bound.kinks[j])
        rows.append((ends, zero, -one, zero, j, zero, zero, one, bound.kinks[j] - p))
    pairs, parts = np.arange(n), []
    for which, *columns in rows:
        parts.append([pairs[which], *(np.broadcast_to(np.asarray(column), n)[which] for column in columns)])
    pair, of_gap, of_p, of_q, branch, of_start, of_slope, of_kink, value = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    rate = np.zeros(len(pair))
    if point.h_rate is not None and point.r_rate is not None:
        rate += of_gap * point.h_rate[0, pair] + of_p * point.r_rate[0, pair] + of_q * point.r_rate[1, pair]
    return PieceConditions(
        pair=pair,
        gap=of_gap,
        pressure=of_p,
        friction=of_q,
        branch=branch,
        start=of_start,
        slope=of_slope,
        kink=of_kink,
        value=value,
        rate=rate,
    )
