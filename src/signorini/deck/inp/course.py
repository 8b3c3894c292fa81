# SPDX-License-Identifier: BSD-3-Clause
"""How values on nodes, edges or bodies change from step to step."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.deck.inp.amplitudes import Amplitude
from signorini.deck.inp.card import Card
from signorini.deck.inp.steps import DeckStep

_SAME = 1e-9  # of a factor: a smaller jump is none

Hold = Literal["", "value", "place"]
"""What a slot is held at in a step: nothing, a value, or the place where the step finds it."""
_NOTHING: tuple[float, int, Hold] = (0.0, 0, "")  # magnitude, amplitude, hold of a slot without a value
_UNSET: tuple[float, int, int, Hold] = (0.0, 0, -1, "")  # the same with the source


@dataclass(frozen=True, kw_only=True, eq=False)
class Pattern:
    """Slots that change alike: slot i has ``values[i] * factor(k, time)`` in step k.

    Attributes
    ----------
    label : what the deck calls the place
    card : the keyword that first set a value there
    slots : (m,)
    values : (m,) the largest of each slot, with its sign
    shares : (steps,) magnitudes in the steps, as parts of the largest
    amplitudes : (steps,) the amplitude in each step, or None
    holds : (steps,) what the slots are held at
    """

    label: str
    card: Card
    slots: IntArray
    values: Array
    shares: tuple[float, ...]
    amplitudes: tuple[Amplitude | None, ...]
    holds: tuple[Hold, ...]

    def at_end(self, k: int, steps: Sequence[DeckStep]) -> float:
        """The factor at the end of step k; before the first, 0."""
        return self.factor(k, steps, steps[k].end) if k >= 0 else 0.0

    def factor(self, k: int, steps: Sequence[DeckStep], time: float) -> float:
        """The factor at a time in step k: of the amplitude, or on the straight line to the end of the step."""
        step, amplitude = steps[k], self.amplitudes[k]
        if amplitude is not None:
            return self.shares[k] * amplitude.at(time if amplitude.total else time - step.start)
        if step.held:
            return self.shares[k]
        before = self.at_end(k - 1, steps)
        return before + (time - step.start) / step.period * (self.shares[k] - before)

    def turns(self, k: int, steps: Sequence[DeckStep]) -> list[float]:
        """Times in step k at which the factor leaves a straight line: its start, if it jumps there, and breaks."""
        step, amplitude = steps[k], self.amplitudes[k]
        jumps = abs(self.factor(k, steps, step.start) - self.at_end(k - 1, steps)) > _SAME
        found = [step.start] if jumps else []
        if amplitude is not None:
            shift = 0.0 if amplitude.total else step.start
            found += [shift + float(t) for t in amplitude.breaks(step.start - shift, step.end - shift)]
        return found


class Course:
    """Values of slots (a node and a direction, an edge) step by step: they stay until they are changed or removed."""

    def __init__(self) -> None:
        self._now: dict[int, tuple[float, int, int, Hold]] = {}  # slot to magnitude, amplitude, source, hold
        self._before: set[int] = set()  # slots set in an earlier step, which a new value replaces
        self._amplitudes: list[Amplitude | None] = [None]
        self._sources: list[tuple[str, Card]] = []
        self._first: dict[int, int] = {}  # slot to the source that set it first
        self._ends: list[dict[int, tuple[float, int, Hold]]] = []  # by step: slot to magnitude, amplitude, hold
        self._reached: dict[int, float] = {}  # values at the end of the last step

    def put(
        self, slots: IntArray, value: float, label: str, card: Card, amplitude: Amplitude | None, *, adds: bool
    ) -> None:
        """Give slots a value; what was set in this step is added to it, or replaced by it.

        Raises
        ------
        DeckError
            If both act, but with different amplitudes.
        """
        source = self._source(label, card)
        index = self._amplitude(amplitude)
        now, before = self._now, self._before
        for slot in slots.tolist():
            base, other, earlier, _ = now.get(slot, _UNSET) if slot not in before else _UNSET
            if base and value and other != index:
                self._refuse_two_amplitudes(index, other, self._sources[earlier][1], card)
            now[slot] = (base + value if adds else value, other if adds and not value else index, source, "value")
            before.discard(slot)
            self._first.setdefault(slot, source)

    def freeze(self, slots: IntArray, label: str, card: Card) -> None:
        """Hold slots where the last step left them: at the value that it took them to, or in whatever place."""
        source = self._source(label, card)
        for slot in slots.tolist():
            known = not self._ends or slot in self._reached
            self._now[slot] = (self._reached.get(slot, 0.0), 0, source, "value" if known else "place")
            self._before.discard(slot)
            self._first.setdefault(slot, source)

    def begin_step(self) -> None:
        """What there is was set before; the step replaces it where it sets anything."""
        self._before = set(self._now)

    def clear(self) -> None:
        """Remove every value (``OP=NEW``)."""
        self._now = {}

    def set_by(self, slot: int) -> Card | None:
        """The keyword whose value a slot has, None where it has none."""
        return self._sources[self._now[slot][2]][1] if slot in self._now else None

    @property
    def keywords(self) -> set[str]:
        """Keywords that have set what there is."""
        return {self._sources[source][1].keyword for source in {now[2] for now in self._now.values()}}

    @property
    def kept(self) -> set[int]:
        """Slots whose values are those of an earlier step."""
        return self._before & self._now.keys()

    @property
    def fresh(self) -> set[int]:
        """Slots with values of this step."""
        return self._now.keys() - self._before

    @property
    def plain(self) -> bool:
        """Whether this step gives any value but 0 that follows no amplitude."""
        return any(self._now[slot][0] and not self._now[slot][1] for slot in self.fresh)

    def end_step(self, step: DeckStep) -> None:
        """Note what there is at the end of a step; what follows an amplitude of the step's time stays as it ends."""
        self._ends.append({slot: (magnitude, index, hold) for slot, (magnitude, index, _, hold) in self._now.items()})
        ends = [
            1.0 if amplitude is None else amplitude.at(step.end if amplitude.total else step.period)
            for amplitude in self._amplitudes
        ]
        valued = [(slot, now) for slot, now in self._now.items() if now[3] == "value"]
        self._reached = {slot: magnitude * ends[index] for slot, (magnitude, index, _, _) in valued}
        over = {index for index, amplitude in enumerate(self._amplitudes) if amplitude and not amplitude.total}
        for slot, (magnitude, index, source, hold) in self._now.items():
            if index in over:
                self._now[slot] = (magnitude * ends[index], 0, source, hold)

    def _refuse_two_amplitudes(self, index: int, other: int, earlier: Card, card: Card) -> None:
        mine, its = (
            f"'{found.name}'" if found else "no amplitude"
            for found in map(self._amplitudes.__getitem__, (index, other))
        )
        raise card.error(
            f"acts with {mine} where line {earlier.line} of the same step acts with {its}; expected one amplitude for "
            "all that a step sets in one direction or on one face"
        )

    def patterns(self) -> Iterator[Pattern]:
        """Slots that change alike and bear one label, in the order in which the deck names them."""
        groups: dict[tuple[int, tuple[float, ...], tuple[int, ...], tuple[Hold, ...]], list[tuple[int, float]]] = {}
        labels: dict[str, int] = {}
        for slot, source in self._first.items():
            history = [ends.get(slot, _NOTHING) for ends in self._ends]
            size = max((value for value, _, _ in history), key=abs, default=0.0)
            shares = tuple(round(value / size, 12) if size else 0.0 for value, _, _ in history)
            named = labels.setdefault(self._sources[source][0], source)
            key = (named, shares, tuple(index for _, index, _ in history), tuple(hold for _, _, hold in history))
            groups.setdefault(key, []).append((slot, size))
        for (source, shares, indices, holds), members in groups.items():
            label, card = self._sources[source]
            members.sort()
            yield Pattern(
                label=label,
                card=card,
                slots=np.array([slot for slot, _ in members], np.int64),
                values=np.array([value for _, value in members]),
                shares=shares,
                amplitudes=tuple(self._amplitudes[index] for index in indices),
                holds=holds,
            )

    def _source(self, label: str, card: Card) -> int:
        if not self._sources or self._sources[-1] != (label, card):
            self._sources.append((label, card))
        return len(self._sources) - 1

    def _amplitude(self, amplitude: Amplitude | None) -> int:
        if amplitude not in self._amplitudes:
            self._amplitudes.append(amplitude)
        return self._amplitudes.index(amplitude)


def unique_label(label: str, taken: Container[str]) -> str:
    """The label, or with a number behind it if another bears it.

    >>> unique_label("top", {"top"})
    'top (2)'
    """
    number, name = 1, label
    while name in taken:
        number += 1
        name = f"{label} ({number})"
    return name
