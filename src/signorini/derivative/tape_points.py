# SPDX-License-Identifier: BSD-3-Clause
"""The points of a history, from the straight parts of it that were kept as they were followed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
import scipy.linalg

from signorini.arrays import Array, BoolArray, IntArray, stored
from signorini.derivative.interface_system import InterfaceSystem, PairStates
from signorini.derivative.locked_bolts import LockedBolts
from signorini.derivative.points import TapePoint
from signorini.derivative.quiet_ends import quiet_end
from signorini.derivative.space_conditions import acting_pairs, states_between, states_of_piece
from signorini.derivative.step_friction import in_force
from signorini.engine.tape import Leg, Tape
from signorini.errors import InputError
from signorini.friction.history import PathState
from signorini.friction.history.segment import Breakpoint
from signorini.law.states import OPEN, SLIP_PLUS

_STANDSTILL = 1e-13  # of a segment: a piece that is no longer
_TOUCHES = 1e-9  # of the largest gap, and of what rigid motions open most: none
_NOBODY: IntArray = np.zeros(0, dtype=np.int64)  # acts at a given load


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
    start = leg.start
    assert start is not None
    if start.r.any() and not leg.before.forces.any():
        none = np.zeros_like(start.h)
        yield TapePoint(
            leg=number,
            system=system,
            load=system.posed(leg.before.point),
            load_factor=leg.low,
            part=0.0,
            states=states_between(system, start.state, (none, none), (start.h, start.r)),
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
            elif not piece.told:
                words = "has a length that was told by what others met which were tried"
                raise InputError(f"the increment up to load factor {found.load_factor:.9g} {words}: it is not followed")
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
            displacement=None if leg.carried else stored(state, "displacement"),
        )
