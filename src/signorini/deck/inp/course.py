# SPDX-License-Identifier: BSD-3-Clause
"""Values on nodes, faces or bodies as they change from step to step: a course for every kind of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.deck.inp.amplitudes import Amplitude
from signorini.deck.inp.card import Card
from signorini.deck.inp.links import DeckRigid
from signorini.deck.inp.steps import DeckStep

_JUMP_TOL = 1e-9  # of a factor: less is rounding of times and factors with ten digits
_SAME_VECTOR_TOL = 1e-9  # of an axis or a direction, as written with ten digits

Hold = Literal["", "value", "place"]
"""What a slot is held at in a step: nothing, a value, or the place where the step finds it."""


class _Value(NamedTuple):
    """What a slot has: a magnitude, the index of its amplitude, that of its source, and what it is held at."""

    magnitude: float = 0.0
    amplitude: int = 0
    source: int = -1
    hold: Hold = ""


_UNSET = _Value()


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
        """The factor at a time in step k of the steps: of the amplitude, or on the straight line to the step's end."""
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
        jumps = abs(self.factor(k, steps, step.start) - self.at_end(k - 1, steps)) > _JUMP_TOL
        found = [step.start] if jumps else []
        if amplitude is not None:
            shift = 0.0 if amplitude.total else step.start
            found += [shift + float(t) for t in amplitude.breaks(step.start - shift, step.end - shift)]
        return found


class Course:
    """Values of slots (a node and a direction, an edge) step by step: they stay until they are changed or removed."""

    def __init__(self) -> None:
        self._now: dict[int, _Value] = {}
        self._before: set[int] = set()  # slots set in an earlier step, which a new value replaces
        self._amplitudes: list[Amplitude | None] = [None]
        self._sources: list[tuple[str, Card]] = []
        self._first: dict[int, int] = {}  # slot to the source that set it first
        self._ends: list[dict[int, _Value]] = []  # by step
        self._reached: dict[int, float] = {}  # values at the end of the last step

    def put(
        self, slots: IntArray, value: float, label: str, card: Card, amplitude: Amplitude | None, *, adds: bool
    ) -> None:
        """Give slots a value.

        Parameters
        ----------
        slots : (m,)
        value : of each
        label : what the deck calls the place
        card : the keyword, at its line
        amplitude : that the value follows, or None
        adds : the value is added to what was set in this step with the same amplitude, otherwise it replaces that
        """
        source = self._source(label, card)
        index = self._amplitude(amplitude)
        now, before = self._now, self._before
        for slot in slots.tolist():
            base, other, earlier, _ = now.get(slot, _UNSET) if slot not in before else _UNSET
            if base and value and other != index:
                self._refuse_two_amplitudes(index, other, self._sources[earlier][1], card)
            followed = other if adds and not value else index
            now[slot] = _Value(base + value if adds else value, followed, source, "value")
            before.discard(slot)
            self._first.setdefault(slot, source)

    def freeze(self, slots: IntArray, label: str, card: Card) -> None:
        """Hold slots where the last step left them: at the value that it took them to, or in whatever place.

        Parameters
        ----------
        slots : (m,)
        label : what the deck calls the place
        card : the keyword, at its line
        """
        source = self._source(label, card)
        for slot in slots.tolist():
            known = not self._ends or slot in self._reached
            self._now[slot] = _Value(self._reached.get(slot, 0.0), 0, source, "value" if known else "place")
            self._before.discard(slot)
            self._first.setdefault(slot, source)

    def begin_step(self) -> None:
        """Begin a step, which replaces earlier values where it sets any."""
        self._before = set(self._now)

    def clear(self) -> None:
        """Remove every value (``OP=NEW``)."""
        self._now = {}

    @property
    def keywords(self) -> set[str]:
        """Keywords that have set the present values."""
        return {self._sources[source][1].keyword for source in {now.source for now in self._now.values()}}

    @property
    def kept_slots(self) -> set[int]:
        """Slots whose values are those of an earlier step."""
        return self._before & self._now.keys()

    @property
    def new_slots(self) -> set[int]:
        """Slots with values of this step."""
        return self._now.keys() - self._before

    @property
    def sets_constants(self) -> bool:
        """Whether this step gives any value but 0 that follows no amplitude."""
        return any(self._now[slot].magnitude and not self._now[slot].amplitude for slot in self.new_slots)

    def end_step(self, step: DeckStep) -> None:
        """Note what there is at the end of a step; what follows an amplitude of the step's time stays as it ends."""
        self._ends.append(dict(self._now))
        ends = [
            1.0 if amplitude is None else amplitude.at(step.end if amplitude.total else step.period)
            for amplitude in self._amplitudes
        ]
        self._reached = {
            slot: now.magnitude * ends[now.amplitude] for slot, now in self._now.items() if now.hold == "value"
        }
        over = {index for index, amplitude in enumerate(self._amplitudes) if amplitude and not amplitude.total}
        for slot, (magnitude, index, source, hold) in self._now.items():
            if index in over:
                self._now[slot] = _Value(magnitude * ends[index], 0, source, hold)

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
            history = [ends.get(slot, _UNSET) for ends in self._ends]
            size = max((now.magnitude for now in history), key=abs, default=0.0)
            shares = tuple(round(now.magnitude / size, 12) if size else 0.0 for now in history)
            named = labels.setdefault(self._sources[source][0], source)
            key = (named, shares, tuple(now.amplitude for now in history), tuple(now.hold for now in history))
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


@dataclass(frozen=True, kw_only=True)
class VolumeLoad:
    """A load on the whole of a section, whose value is 1.

    Attributes
    ----------
    kind : as decks call it: GRAV, CENTRIF, BX, BY or BZ
    place : the set or element as the deck names it, in capitals; empty where loads of other names are the same
    section : index
    label : what the model calls it
    direction : force per volume; of CENTRIF the unit vector along the axis in space, empty in the plane
    centre : of CENTRIF a point on the axis, empty where the y axis is meant; its value is the square of the angular
        velocity
    """

    kind: str
    place: str
    section: int
    label: str
    direction: tuple[float, ...]
    centre: tuple[float, ...] = ()

    def is_same(self, other: VolumeLoad) -> bool:
        """Whether a value of the other replaces a value of this, or is added to it: same place, direction and axis."""
        if (self.kind, self.place, self.section) != (other.kind, other.place, other.section):
            return False
        mine, its = np.array(self.direction), np.array(other.direction)
        apart = np.subtract(self.centre, other.centre)
        if len(apart) == 3:
            apart = apart - (apart @ mine) * mine  # points of an axis are as good as each other
        far = _largest(np.array([*self.centre, *other.centre]))
        return _largest(mine - its) <= _SAME_VECTOR_TOL * _largest(mine) and _largest(apart) <= _SAME_VECTOR_TOL * far

    def given(self, value: float) -> dict[str, Any]:
        """Fields of the model's load of a value."""
        if self.kind != "CENTRIF":
            return {"body_force": tuple(value * part for part in self.direction)}
        line = {"centre": self.centre, "axis": self.direction}
        return {"centrifugal": math.sqrt(value), **{key: part for key, part in line.items() if part}}


def _largest(parts: Array) -> float:
    return float(np.abs(parts).max(initial=0.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Courses:
    """Everything that acts on the bodies as it changes with the steps.

    Attributes
    ----------
    rigid : what has reference nodes
    initial : (n,) temperature of every node at the beginning
    displacement : slots of nodes (:class:`signorini.deck.inp.links.NodeSlots`), length
    force : slots of nodes, force
    pressure : slots are keys of faces, force per area
    volume : slots are indices of volume_loads
    temperature : slots are nodes, above the initial temperature
    volume_loads : what acts on whole sections
    notes : where Abaqus and CalculiX differ, and which of them is followed
    """

    rigid: Sequence[DeckRigid]
    initial: Array
    displacement: Course = field(default_factory=Course)
    force: Course = field(default_factory=Course)
    pressure: Course = field(default_factory=Course)
    volume: Course = field(default_factory=Course)
    temperature: Course = field(default_factory=Course)
    volume_loads: list[VolumeLoad] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def all(self) -> tuple[Course, ...]:
        """Every course."""
        return self.displacement, self.force, self.pressure, self.volume, self.temperature

    def volume_slot(self, load: VolumeLoad) -> int:
        """The slot of a load on a section, new if there is none like it."""
        for slot, other in enumerate(self.volume_loads):
            if other.is_same(load):
                return slot
        self.volume_loads.append(load)
        return len(self.volume_loads) - 1
