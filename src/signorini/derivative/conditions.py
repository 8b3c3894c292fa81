# SPDX-License-Identifier: BSD-3-Clause
"""What must hold in a piece of a history in the plane, and what ends it: numbers, linear in motions and forces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.derivative.interface_system import PairStates
from signorini.friction.problem import ContactProblem
from signorini.law.bound import SIGN
from signorini.law.states import OPEN, STICK, UNDECIDED


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceConditions:
    """What must not be negative in a piece: numbers g of one pair each, linear in its motions and forces.

    Attributes
    ----------
    pair : (m,) numbers of active pairs
    gap, pressure : (m,) how g changes with the gap and the normal force
    friction : (d - 1, m) how it changes with the tangential force
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
        of_friction = (self.friction * r[1:, self.pair]).sum(axis=0)
        return np.asarray(self.gap * h[0, self.pair] + self.pressure * r[0, self.pair] + of_friction)

    def event(self, number: int) -> PieceEvent:
        """The condition of a number, as what ends the piece."""
        names = ("gap", "pressure", "start", "slope", "kink", "value", "rate")
        parts = {name: float(getattr(self, name)[number]) for name in names}
        along = self.friction[:, number]
        friction = float(along[0]) if len(along) == 1 else along.copy()
        return PieceEvent(pair=int(self.pair[number]), branch=int(self.branch[number]), friction=friction, **parts)

    def number(self, event: PieceEvent) -> int:
        """Of an event among the conditions."""
        alike = (self.friction == np.reshape(event.friction, (-1, 1))).all(axis=0)
        same = (self.pair == event.pair) & (self.gap == event.gap) & alike
        return int(np.flatnonzero(same & (self.kink == event.kink) & (self.branch == event.branch))[0])


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceEvent:
    """The condition that ends a piece, see `PieceConditions`: of one pair.

    Attributes
    ----------
    pair, branch : its number, and of the branch of its bound
    gap, pressure, start, slope, kink : how g changes with these
    friction : how it changes with the tangential force, in space (2,) along both tangents
    value, rate : of g at the end of the piece, and per unit of the part of the leg
    """

    pair: int
    gap: float
    pressure: float
    friction: float | Array
    branch: int
    start: float
    slope: float
    kink: float
    value: float
    rate: float

    def change(self, h: Array, r: Array) -> float:
        """What motions and forces, (d, n), change of g."""
        k = self.pair
        return float(self.gap * h[0, k] + self.pressure * r[0, k] + (self.friction * r[1:, k]).sum())


@dataclass(frozen=True, kw_only=True, eq=False)
class PieceEnd:
    """The end of a piece; motions and forces are scaled, of the active pairs.

    Attributes
    ----------
    law : of the pairs
    states : in the piece
    h, r : (d, n) motions and forces
    rates : (d, n) of both per unit of the part of the leg; None where the load is given
    """

    law: ContactProblem
    states: PairStates
    h: Array
    r: Array
    rates: tuple[Array, Array] | None


def options(end: PieceEnd, pair: int) -> Iterator[PieceEvent]:
    """What may happen to a pair in a piece, as `plane_conditions` has it of all pairs, in the plane."""
    law, states = end.law, end.states
    assert states.codes is not None
    assert end.rates is not None
    code, bound, at = int(states.codes[pair]), law.pieces, (0, pair)
    (h, r), (h_rate, r_rate) = (end.h, end.r), end.rates
    gap, p, q = float(h[at]), float(r[at]), float(r[1, pair])
    gap_rate, p_rate, q_rate = float(h_rate[at]), float(r_rate[at]), float(r_rate[1, pair])

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


def plane_conditions(end: PieceEnd) -> PieceConditions:
    """Gaps of open pairs, pressures of closed ones, friction to spare, and kinks of the bounds of those that slip."""
    law, states, gap = end.law, end.states, end.h[0]
    p, q = end.r
    codes, bound = states.codes, law.pieces
    assert codes is not None
    zero, one = np.zeros(len(codes)), np.ones(len(codes))
    none, along = zero[None], one[None]
    opened, stick = codes == OPEN, (codes == STICK) & (law.law.closed == UNDECIDED) & ~law.unbounded
    slips = codes > STICK
    rows: list[ConditionRow] = [
        (opened, one, zero, none, 0, zero, zero, zero, gap),
        (~opened, zero, one, none, 0, zero, zero, zero, p),
    ]
    for j in range(bound.branches):
        has = stick & np.isfinite(bound.kinks[j])
        spare = bound.starts[j] + bound.slopes[j] * p
        rows += [(has, zero, bound.slopes[j], -s * along, j, one, p, zero, spare - s * q) for s in (1.0, -1.0)]
    return gathered([*rows, *kink_rows(end, slips)], end)


ConditionRow = tuple[BoolArray, Array, Array, Array, int, Array, Array, Array, Array]
"""The pairs (n,) that have a condition, and of all pairs gap, pressure, friction (d - 1, n), branch, and so on."""


def kink_rows(end: PieceEnd, slips: BoolArray) -> Iterator[ConditionRow]:
    """Kinks of the bounds of pairs that slip, (n,), at both ends of their branches."""
    bound, branch, p = end.law.pieces, end.states.branch, end.r[0]
    zero, one, none = np.zeros(len(p)), np.ones(len(p)), np.zeros((len(end.r) - 1, len(p)))
    for j in range(1, bound.branches):
        there, below = slips & (branch == j), slips & (branch == j - 1)
        yield there, zero, one, none, j, zero, zero, -one, p - bound.kinks[j]
        yield below & np.isfinite(bound.kinks[j]), zero, -one, none, j, zero, zero, one, bound.kinks[j] - p


def gathered(rows: Sequence[ConditionRow], end: PieceEnd) -> PieceConditions:
    """The conditions of all rows, with their rates."""
    pairs = np.concatenate([np.flatnonzero(which) for which, *_ in rows])
    counts = [int(np.count_nonzero(which)) for which, *_ in rows]

    def column(k: int) -> Array:
        return np.concatenate([np.asarray(row[k])[..., row[0]] for row in rows], axis=-1)

    found = PieceConditions(
        pair=pairs,
        gap=column(1),
        pressure=column(2),
        friction=column(3),
        branch=np.repeat([row[4] for row in rows], counts),
        start=column(5),
        slope=column(6),
        kink=column(7),
        value=column(8),
        rate=np.zeros(len(pairs)),
    )
    return found if end.rates is None else replace(found, rate=found.change(*end.rates))


def plane_slips(states: PairStates, law: ContactProblem) -> tuple[IntArray, Array]:
    """Pairs that slip in the plane and would stick, (m,), and (1, m) the way that friction lets them slip."""
    assert states.codes is not None
    slips = np.flatnonzero((states.codes > STICK) & (law.law.closed == UNDECIDED))
    return slips, -SIGN[states.codes[slips]][None]
