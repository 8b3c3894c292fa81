# SPDX-License-Identifier: BSD-3-Clause
"""Events that pairs share, one after the other: in the order in which a change brings them about, to one of its sides.

Where several conditions g vanish at one load a change e of what is given takes them apart, by parts of the load in
proportion to it. In between, the history has pieces that are no longer than that: to first order, points at the same
place. In each of them the equations of its states hold; it ends where the first of the conditions vanishes, of all
that fall, at ``-e g' / (dg/dl)``; and the states behind are those in which the law lets the rates go on while the
other conditions do not vanish yet. With these points the history has events of single pairs, and its derivative is
that of any other.

On smooth cones the first of these events ends an increment, and the next one goes over the others, where it is as
short as increments may be that do. Where pairs turn alike that tell a length, one of them turns most to each side.
At the end of an increment that goes on over events pairs obey other parts of the law, see `increment_ends`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.forward import ForwardWalk, change_of_conditions
from signorini.derivative.increment_ends import to_side
from signorini.derivative.interface_system import PairStates
from signorini.derivative.points import GRAZES, ZERO, TapePoint
from signorini.derivative.space_conditions import states_of_piece
from signorini.derivative.validity import SHARED_EVENT, on_edge
from signorini.engine.tape import Leg
from signorini.errors import InputError
from signorini.friction.history import PathSettings, PathState
from signorini.friction.history.follow import follower
from signorini.friction.history.follower import PathFollower
from signorini.friction.history.rates import NoRates
from signorini.law.states import OPEN, SLIP, STICK

_ASIDE = 1e-3  # of the data, or of what presses a pair: how far conditions are put from zero that do not vanish yet
_MOST_EVENTS = 100  # at one point, after which its order is given up
_AHEAD = 1e-3  # of the data: how far rates are followed at most to see which way pairs slip
_NEXT = 1e-9  # of the data: the same on smooth cones, where friction turns with the slip


@dataclass(frozen=True, kw_only=True, eq=False)
class EventOrder:
    """The order of the events of a history that pairs share, to one side of a change.

    Attributes
    ----------
    walk : forwards along the history with the change, from its beginning
    legs : straight parts of the history
    way : 1 upwards, -1 downwards
    moves : part of a leg that the change moves events on the way by at most, per unit
    rounding : of the data of the law, per unit: what a change of a condition is as good as none below
    """

    walk: ForwardWalk
    legs: Sequence[Leg]
    way: float
    moves: float
    rounding: float
    _ways: dict[int, PathFollower] = field(default_factory=dict, init=False)

    def points(self) -> list[TapePoint]:
        """The points of the history, with those between events that the change takes apart.

        Raises
        ------
        InputError
            Where the order, or what pairs do in it, is not known.
        """
        walk = self.walk
        while walk.ahead:
            point = walk.next
            if point.at_event and not point.on_linear_path and point.shared:
                self._first()
            elif point.ends_at_events and on_edge(point):
                self._one_by_one()
            elif not point.at_event and on_edge(point):
                there = to_side(walk, self.way, self.rounding)
                if there is None:
                    raise _not_known(point)
                walk.put([there], like=point)
                walk.go_on()
            else:
                if point.tied:
                    walk.put([replace(point, quiet=walk.quiet_move(self.way).end)], like=point)
                walk.go_on()
        return walk.points

    def _first(self) -> None:
        """To the first of the events at the next point, on smooth cones, in place of all; others are behind it."""
        walk, point = self.walk, self.walk.next
        known = point.conditions
        numbers = np.array([known.number(point.event), *point.shared])
        parts = -change_of_conditions(point, walk.at_load(point))[numbers] / known.rate[numbers]
        later = self.way * parts - float(np.min(self.way * parts))
        least = self.rounding * (point.system.law.scale or 1.0) / np.abs(known.rate[numbers])
        apart = later > np.maximum(SHARED_EVENT * self.moves, least)
        if not apart.any():
            walk.go_on()
            return
        acts = int(numbers[np.argmin(later)])
        walk.put([replace(point, acting=known.pair[[acts]], acts=acts)], like=point)
        walk.go_on()
        if not (walk.ahead and walk.next.leg == point.leg and walk.next.passes):
            raise _other_lengths(point)
        self._slip_behind(point, known.pair[numbers[apart]])

    def _slip_behind(self, point: TapePoint, pairs: IntArray) -> None:
        """What the next increment, on smooth cones, knows of pairs at their limit that begin to slip in it."""
        walk = self.walk
        if not walk.ahead:
            return
        behind = walk.next
        if not behind.system.alike(point.system):
            raise _not_known(point)
        begin = np.isin(np.arange(point.system.pairs), pairs) & (point.states.held & ~behind.states.held).all(axis=0)
        if not begin.any():
            return
        # how far they turn in it tells no length, and they slip under the friction at its end
        if not behind.passes or any(begin[trial.pair] for trial in (behind.quiet.trials if behind.quiet else ())):
            raise _other_lengths(point)
        walk.put([replace(behind, increment=behind.increment | begin)], like=behind)

    def _one_by_one(self) -> None:
        """Through the events at the next point."""
        walk, point = self.walk, self.walk.next
        states = self._through(point, point.states, np.inf if point.at_event else 0.0)
        if not point.at_event:
            walk.put([replace(point, states=states, load_rate=None, h_rate=None, r_rate=None)], like=point)
            walk.go_on()
            if not (walk.ahead and walk.next.on_linear_path):
                if not point.on_linear_path:
                    end = replace(point, states=states)
                    self._slip_behind(end, end.conditions.pair[on_edge(end)])
                return
            if not walk.next.system.alike(point.system):
                raise _not_known(point)
            turn = replace(point, leg=walk.next.leg, system=walk.next.system, part=0.0)  # loads go on otherwise
            walk.put([turn, walk.next], like=point)
            states = self._through(turn, self._behind(self._piece(turn, states), 0.0), np.inf)
        walk.put([], like=point)
        if not (walk.ahead and states.same(walk.next.states)):
            raise _not_known(point)

    def _through(self, point: TapePoint, states: PairStates, end: float) -> PairStates:
        """The states behind all events at the next point, which is passed as often as it has some.

        Parameters
        ----------
        point : the next one
        states : of the pairs before these events
        end : part of the leg, from the point and per unit of the change, that its events come before
        """
        for _ in range(_MOST_EVENTS):
            piece = self._piece(point, states)
            parts = piece.parts(end)
            if not np.isfinite(parts).any():
                return states
            first = float(parts.min())
            acting = np.isfinite(parts) & (piece.at(first) <= piece.none)
            pairs = np.unique(piece.point.conditions.pair[piece.numbers[acting]])
            event = replace(piece.point, acting=pairs, acts=int(piece.numbers[parts.argmin()]))
            self.walk.put([event, point], like=point)
            self.walk.go_on()
            before, states = states, self._behind(piece, first)
            if states.same(before):
                break
        raise _not_known(point)

    def _piece(self, point: TapePoint, states: PairStates) -> _Piece:
        """The piece at the next point in which pairs have some states."""
        system, (start, end) = point.system, self._ends(point)
        here = replace(point, states=states, acting=np.zeros(0, dtype=np.int64), quiet=None)
        with here.determined():
            h_rate, r_rate = system.respond(states, system.free(end - start.b))
        here = replace(here, h_rate=h_rate, r_rate=r_rate)
        scale, known = system.law.scale or 1.0, here.conditions
        numbers = np.flatnonzero(np.abs(known.value) <= ZERO * scale)
        grows = self.way * change_of_conditions(here, self.walk.at_load(here))[numbers]
        rates = known.rate[numbers]
        # with the events that it takes apart here, where no others move
        moves = max(self.moves, float(np.abs(grows).max(initial=0.0)) / (here.fastest or np.inf))
        none = np.maximum(SHARED_EVENT * moves * np.abs(rates), scale * max(ZERO * moves, self.rounding))
        return _Piece(point=here, numbers=numbers, grows=grows, rates=rates, none=none)

    def _behind(self, piece: _Piece, part: float) -> PairStates:
        """The states behind a part of the leg in a piece, while conditions that do not vanish there are aside."""
        point = piece.point
        law, states, (start, end) = point.system.law, point.states, self._ends(point)
        h, r = piece.aside(part)
        if point.leg not in self._ways:
            self._ways[point.leg] = follower(law, start, end, PathSettings())
        rates = self._ways[point.leg].rates_at(replace(start, h=h, r=r, state=_codes(states), anchor=h[1:]))
        if isinstance(rates, NoRates):
            raise _not_known(point)
        if states.codes is not None:
            return point.system.states_of_codes(rates.state)
        known, moved = point.conditions, (h - point.h, r - point.r)
        left, falls = known.value + known.change(*moved), -known.change(rates.h, rates.r)
        on_way = (left > ZERO * (law.scale or 1.0)) & (falls > 0.0)
        most = _AHEAD if point.on_linear_path else _NEXT
        ahead = 0.5 * float(np.min(left[on_way] / falls[on_way], initial=most * (law.scale or 1.0) / rates.size))
        found = states_of_piece(law, rates.state, (0.0 * h, r), (ahead * rates.h, r + ahead * rates.r))
        size = law.bound.at(np.maximum(point.r[0], 0.0))
        slips = found.unit.any(axis=0) & (size > 0.0)
        return replace(found, unit=np.divide(point.r[1:], size, out=found.unit.copy(), where=slips))

    def _ends(self, point: TapePoint) -> tuple[PathState, Array]:
        """The state of the path at the beginning of the leg of a point, and the load at its end."""
        leg = self.legs[point.leg]
        assert leg.start is not None
        assert leg.segment is not None
        return leg.start, leg.segment.end.b


@dataclass(frozen=True, kw_only=True, eq=False)
class _Piece:
    """A piece of no length at a point.

    Attributes
    ----------
    point : with the states of the piece, and nobody acting
    numbers : (m,) of its conditions that vanish at the load
    grows, rates : (m,) what the change makes of these there, and per unit of the part of the leg
    none : (m,) how much of them is as good as nothing
    """

    point: TapePoint
    numbers: IntArray
    grows: Array
    rates: Array
    none: Array

    def at(self, part: float) -> Array:
        """(m,) What the change makes of the conditions a part of the leg away, per unit."""
        return np.asarray(self.grows + part * self.rates)

    def parts(self, end: float) -> Array:
        """(m,) Parts of the leg at which conditions vanish that do before an end, 0 or inf; inf of others."""
        falls = (self.rates < -GRAZES * self.point.fastest) & ((end > 0.0) | (self.grows < -self.none))
        return np.divide(-self.grows, self.rates, out=np.full(len(self.rates), np.inf), where=falls)

    def aside(self, part: float) -> tuple[Array, Array]:
        """(d, n) Motions and forces with conditions as a part of the leg away has them, but for their size."""
        point, known, values = self.point, self.point.conditions, self.at(part)
        law, h, r = point.system.law, point.h.copy(), point.r.copy()
        scale = law.scale or 1.0
        none = ZERO * scale
        pairs, values = known.pair[self.numbers], np.where(values > self.none, values, 0.0)
        for pair in np.unique(pairs[values > 0.0]).tolist():
            own = np.flatnonzero(pairs == pair)
            at = self.numbers[own]
            rows = np.column_stack([known.gap[at], known.pressure[at], known.friction[:, at].T])
            size = _ASIDE * (float(point.r[0, pair]) if point.r[0, pair] > none else scale)
            moved = np.linalg.lstsq(rows, size * values[own] / values[own].max(), rcond=None)[0]
            h[0, pair] += moved[0]
            r[:, pair] += moved[1:]
        slips = point.states.unit.any(axis=0) & (point.r[0] <= none) & (r[0] > none)
        r[1:] = np.where(slips, point.states.unit * law.bound.at(np.maximum(r[0], 0.0)), r[1:])
        return h, r


def _codes(states: PairStates) -> IntArray:
    """(n,) The states as a path has them."""
    if states.codes is not None:
        return states.codes
    assert states.tangent is not None
    closed = np.where(states.held.all(axis=0), STICK, SLIP)
    return np.where(states.tangent.closed, closed, OPEN).astype(np.int64)


def _other_lengths(point: TapePoint) -> InputError:
    words = (
        f"increments behind load factor {point.load_factor:.9g} have another length where pairs come to their events"
    )
    return InputError(f"{words} one after the other, with which answers jump a little")


def _not_known(point: TapePoint) -> InputError:
    return InputError(f"what pairs do one after the other at load factor {point.load_factor:.9g} is not known")
