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

from signorini.arrays import Array, IntArray
from signorini.derivative.conditions import PieceConditions, PieceEnd, PieceEvent, options, plane_conditions
from signorini.derivative.interface_system import InterfaceSystem, PairStates
from signorini.engine.tape import Leg, Tape
from signorini.errors import InputError
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS
from signorini.solution.state import LoadPoint

_GRAZES = 1e-9  # of the fastest condition of a piece: one that hardly moves
_STANDSTILL = 1e-13  # of a segment: a piece that is no longer


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
    def piece_end(self) -> PieceEnd:
        """Where the piece is left, as its conditions see it."""
        rates = None if self.h_rate is None or self.r_rate is None else (self.h_rate, self.r_rate)
        return PieceEnd(law=self.system.law, states=self.states, h=self.h, r=self.r, rates=rates)

    @cached_property
    def conditions(self) -> PieceConditions:
        """What holds in the piece, in the plane."""
        return plane_conditions(self.piece_end)

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
        found = [event for pair in self.acting for event in options(self.piece_end, int(pair)) if event.rate < 0.0]
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
    friction = known.friction[0, condition]
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
