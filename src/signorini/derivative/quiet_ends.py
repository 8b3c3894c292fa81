# SPDX-License-Identifier: BSD-3-Clause
"""Ends of increments in space at which nothing happens: how they move with what is before them.

An increment begins with a length that is fixed, or grows with what is behind. On smooth cones a trial of it, in which
friction turns by an angle a, tells the next length from its own by ``s_next = s c / a``: so lengths move by

    s_next' = (s_next / s) (s' - s a' / a),    a' = a_0 . r_0' + a_1 . r_1',

with the friction r_0 and r_1 of the pair that turns most where the increment begins and where the trial ends.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from signorini.arrays import Array
from signorini.friction.history.follower import ZERO_WIDTH
from signorini.friction.history.segment import Breakpoint
from signorini.friction.history.space.lengths import EARLY_GROWTH, PROBE
from signorini.friction.history.space.straight import friction_turns
from signorini.friction.problem import ContactProblem

_SAME_LENGTH = 1e-9  # of a length: one that was chosen so


@dataclass(frozen=True, kw_only=True, eq=False)
class TriedLength:
    """An increment that was tried, and told the next length by how far friction turns in it.

    Attributes
    ----------
    pair : that turns most
    before, after : (2,) how its angle changes with its friction at the beginning and at the end
    rate : of the angle per unit of the part of the leg
    angle, length : how far it turns, and the length of the increment, part of the leg
    ratio : of the next length to this one
    """

    pair: int
    before: Array
    after: Array
    rate: float
    angle: float
    length: float
    ratio: float

    def next_length(self, length: float, begins: float, before: Array, after: Array) -> float:
        """How the next length moves, part of the leg.

        Parameters
        ----------
        length, begins : how this one and its beginning do
        before, after : (2, n) how friction changes at the beginning and, at its load, at the end
        """
        turned = self.before @ before[:, self.pair] + self.after @ after[:, self.pair] + self.rate * (begins + length)
        return self.ratio * (length - self.length * float(turned) / self.angle)

    def back(self, ahead: float) -> tuple[float, float]:
        """How an output changes with the angle and with the length, of how it does with the next length."""
        of_angle = -ahead * self.ratio * self.length / self.angle
        return of_angle, ahead * self.ratio + of_angle * self.rate


@dataclass(frozen=True, kw_only=True, eq=False)
class QuietEnd:
    """How the end of an increment moves at which nothing happens.

    Attributes
    ----------
    leads : how its first length moves with the end of the piece before and with the beginning of that
    trials : that told one length after the other, the last that of the increment
    """

    leads: tuple[float, float]
    trials: tuple[TriedLength, ...]

    def part(self, begins: float, before: float, friction: Array, tried: Sequence[Array]) -> float:
        """How the end moves, part of the leg.

        Parameters
        ----------
        begins, before : how the beginning does, and that of the piece before
        friction : (2, n) how friction changes at the beginning
        tried : (3, n) how forces change at the ends of the trials, at their loads
        """
        length = self.leads[0] * begins + self.leads[1] * before
        for trial, forces in zip(self.trials, tried, strict=True):
            length = trial.next_length(length, begins, friction, forces[1:])
        return begins + length

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
            of_angle, length = trial.back(length)
            begins += of_angle * trial.rate
            friction[:, trial.pair] += of_angle * trial.before
            r = np.zeros((3, pairs))
            r[1:, trial.pair] = of_angle * trial.after
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
    pair = int(np.argmax(np.abs(angles)))
    sign = np.sign(angles[pair])
    one, two = (sign * _of_direction(force[1:, pair]) for force in (before.r, end.r))
    return TriedLength(
        pair=pair,
        before=-one,
        after=two,
        rate=float(two @ rate[:, pair]),
        angle=abs(float(angles[pair])),
        length=(end.factor - before.factor) / reach,
        ratio=(after.factor - before.factor) / (end.factor - before.factor),
    )


def _of_direction(force: Array) -> Array:
    """(2,) How the angle of a force, (2,), changes with it."""
    return np.array([-force[1], force[0]]) / float(force @ force)
