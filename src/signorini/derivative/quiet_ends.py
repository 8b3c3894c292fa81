# SPDX-License-Identifier: BSD-3-Clause
"""Ends of increments in space at which nothing happens: how they move with what is before them.

An increment begins with a length that is fixed, or grows with what is behind. On smooth cones a trial of it, in which
friction turns by an angle a, tells the next length from its own by ``s_next = s c / a``: so lengths move by

    s_next' = (s_next / s) (s' - s a' / a),    a' = a_0 . r_0' + a_1 . r_1',

with the friction r_0 and r_1 of the pair that turns most where the increment begins and where the trial ends. Where
several turn alike, as where a model is symmetric, that is to each side of a change the one which then turns most.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.friction.history.follower import ZERO_WIDTH
from signorini.friction.history.segment import Breakpoint
from signorini.friction.history.space.lengths import EARLY_GROWTH, PROBE
from signorini.friction.history.space.straight import friction_turns
from signorini.friction.problem import ContactProblem

_SAME_LENGTH = 1e-9  # of a length: one that was chosen so
_SAME_TURN = 1e-9  # of an angle: one that is the same


@dataclass(frozen=True, kw_only=True, eq=False)
class TriedLength:
    """An increment that was tried, and told the next length by how far friction turns in it.

    Attributes
    ----------
    pair : that turns most
    angle : (n,) how far each pair turns, 0 or more
    before, after : (2, n) how the angles change with friction at the beginning and at the end
    rate : (n,) of the angles per unit of the part of the leg
    length : of the increment, part of the leg
    ratio : of the next length to this one
    """

    pair: int
    angle: Array
    before: Array
    after: Array
    rate: Array
    length: float
    ratio: float

    @property
    def alike(self) -> IntArray:
        """Pairs that turn as far as the one that turns most."""
        return np.flatnonzero(self.angle >= (1.0 - _SAME_TURN) * self.angle[self.pair])

    def turned(self, length: float, begins: float, before: Array, after: Array) -> Array:
        """(n,) How the angles move.

        Parameters
        ----------
        length, begins : how this length and the beginning of the increment do, part of the leg
        before, after : (2, n) how friction changes at the beginning and, at its load, at the end
        """
        along = (self.before * before).sum(axis=0) + (self.after * after).sum(axis=0)
        return np.asarray(along + self.rate * (begins + length))

    def to_side(self, turned: Array, way: float) -> TriedLength:
        """With the pair that turns most to one side, 1 or -1, of what moves the angles by ``turned``."""
        alike = self.alike
        return replace(self, pair=int(alike[np.argmax(way * turned[alike])])) if len(alike) > 1 else self

    def next_length(self, length: float, turned: Array) -> float:
        """How the next length moves, part of the leg, as this one and the angles do."""
        return self.ratio * (length - self.length * float(turned[self.pair] / self.angle[self.pair]))

    def back(self, ahead: float) -> tuple[float, float]:
        """How an output changes with the angle and with the length, of how it does with the next length."""
        of_angle = -ahead * self.ratio * self.length / float(self.angle[self.pair])
        return of_angle, ahead * self.ratio + of_angle * float(self.rate[self.pair])


@dataclass(frozen=True, kw_only=True, eq=False)
class QuietMove:
    """How the end of an increment moves at which nothing happens.

    Attributes
    ----------
    end : with the pairs that turn most as it moves
    part : how it moves, part of the leg
    turned : (n,) how far friction turns otherwise in each of its trials
    """

    end: QuietEnd
    part: float
    turned: tuple[Array, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class QuietEnd:
    """What the end of an increment moves with at which nothing happens.

    Attributes
    ----------
    leads : how its first length moves with the end of the piece before and with the beginning of that
    trials : that told one length after the other, the last that of the increment
    """

    leads: tuple[float, float]
    trials: tuple[TriedLength, ...]

    @property
    def tied(self) -> bool:
        """Whether several pairs turn alike in some trial, and farthest."""
        return any(len(trial.alike) > 1 for trial in self.trials)

    def move(
        self, begins: float, before: float, friction: Array, tried: Sequence[Array], way: float | None = None
    ) -> QuietMove:
        """How it moves.

        Parameters
        ----------
        begins, before : how the beginning does, and that of the piece before, part of the leg
        friction : (2, n) how friction changes at the beginning
        tried : (3, n) how forces change at the ends of the trials, at their loads
        way : 1 or -1, to this side; None: as it is
        """
        length = self.leads[0] * begins + self.leads[1] * before
        trials, turned = list[TriedLength](), list[Array]()
        for trial, forces in zip(self.trials, tried, strict=True):
            turned.append(trial.turned(length, begins, friction, forces[1:]))
            trials.append(trial if way is None else trial.to_side(turned[-1], way))
            length = trials[-1].next_length(length, turned[-1])
        return QuietMove(end=replace(self, trials=tuple(trials)), part=begins + length, turned=tuple(turned))

    def back(self, moves: float, pairs: int, ask: Callable[[int, Array], Array]) -> tuple[Array, Array, float, float]:
        """How an output changes with what the end moves with, of how it does with the part of the leg there.

        With what is remembered and with friction where the increment begins, (2, n) scaled; and with the part of the
        leg where it begins, and where the piece before it does.

        Parameters
        ----------
        moves : how the output changes with the part of the leg at the end
        pairs : n
        ask : (3 n + k,) how it changes with the load of a trial, of its number and how it does with its forces, (3, n)
        """
        memory, friction = np.zeros((2, 2, pairs))
        begins = length = moves
        for number in reversed(range(len(self.trials))):
            trial = self.trials[number]
            k = trial.pair
            of_angle, length = trial.back(length)
            begins += of_angle * float(trial.rate[k])
            friction[:, k] += of_angle * trial.before[:, k]
            r = np.zeros((3, pairs))
            r[1:, k] = of_angle * trial.after[:, k]
            memory -= ask(number, r)[: r.size].reshape(r.shape)[1:]
        return memory, friction, begins + self.leads[0] * length, self.leads[1] * length


def quiet_end(law: ContactProblem, leg: Sequence[Breakpoint], number: int, rates: Sequence[Array]) -> QuietEnd:
    """How the end of a piece of a leg moves at which nothing happens.

    Parameters
    ----------
    law : of the pairs
    leg : the pieces of a leg, from its beginning
    number : of the piece
    rates : (3, n) of forces at the ends of the trials that told its length, per unit of the part of the leg
    """
    before, after = leg[number - 1], leg[number]
    ends = [*after.search, after]
    found = [
        _trial(law, (before, one, two), rate[1:], leg[-1].factor)
        for rate, (one, two) in zip(rates, pairwise(ends), strict=True)
    ]
    length, last = ends[0].factor - before.factor, before.factor - leg[max(number - 2, 0)].factor
    grows = before.factor > 0.0 and abs(length - EARLY_GROWTH * before.factor) <= _SAME_LENGTH * length
    probes = last > 0.0 and abs(length - PROBE * last) <= _SAME_LENGTH * length
    leads = (EARLY_GROWTH, 0.0) if grows else (PROBE, -PROBE) if probes else (0.0, 0.0)
    return QuietEnd(leads=leads, trials=tuple(found))


def _trial(
    law: ContactProblem, ends: tuple[Breakpoint, Breakpoint, Breakpoint], rate: Array, reach: float
) -> TriedLength:
    """A trial from where its increment begins.

    Parameters
    ----------
    law : of the pairs
    ends : its beginning, its end, and that of the increment whose length it told
    rate : (2, n) of friction at its end, per unit of the part of the leg
    reach : part of the segment that the leg is
    """
    before, end, after = ends
    assert before.state is not None
    angles = friction_turns(law, before.state, end.r, end.h[1:] - before.h[1:], ZERO_WIDTH * (law.scale or 1.0))
    one, two = (np.sign(angles) * _of_direction(force[1:]) for force in (before.r, end.r))
    return TriedLength(
        pair=int(np.argmax(np.abs(angles))),
        angle=np.abs(angles),
        before=-one,
        after=two,
        rate=(two * rate).sum(axis=0),
        length=(end.factor - before.factor) / reach,
        ratio=(after.factor - before.factor) / (end.factor - before.factor),
    )


def _of_direction(force: Array) -> Array:
    """(2, n) How the angles of forces, (2, n), change with them; 0 of those that are none."""
    size = (force**2).sum(axis=0)
    return np.divide(np.stack([-force[1], force[0]]), size, out=np.zeros_like(force), where=size > 0.0)
