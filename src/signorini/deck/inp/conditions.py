# SPDX-License-Identifier: BSD-3-Clause
"""From what the deck's steps set to the supports, the loads and the factors of a model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.acting import Courses, Known
from signorini.deck.inp.card import Card
from signorini.deck.inp.course import Course, Hold, Pattern, unique_label
from signorini.deck.inp.links import STRIDE, DeckRigid, component
from signorini.deck.inp.materials import Section
from signorini.deck.inp.places import Places
from signorini.deck.inp.steps import DeckStep
from signorini.model.conditions import Load, Support
from signorini.model.links import directions

_MOST = 1000  # loads of one kind: more would be a field, which takes memory for each


@dataclass(kw_only=True)
class Conditions:
    """Supports and loads with their factors at the end of every step.

    Attributes
    ----------
    supports, loads : of the model
    cards : the keyword of each support and load, by label
    factors : label to its pattern, of what moves or loads
    holds : label of a support that some step takes away, brings or freezes to what it holds at, step by step
    """

    supports: list[Support] = field(default_factory=list)
    loads: list[Load] = field(default_factory=list)
    cards: dict[str, Card] = field(default_factory=dict)
    factors: dict[str, Pattern] = field(default_factory=dict)
    holds: dict[str, tuple[Hold, ...]] = field(default_factory=dict)

    def label(self, name: str) -> str:
        """The name, or with a number behind it if another support or load bears it."""
        return unique_label(name, self.cards)

    def add_support(self, pattern: Pattern, **given: Any) -> None:
        """Add a support under a name of its own."""
        support = Support(name=self.label(given.pop("name")), **given)
        self.supports.append(support)
        self.cards[support.label] = pattern.card
        if support.moves:
            self.factors[support.label] = pattern
        if any(hold != "value" for hold in pattern.holds):
            self.holds[support.label] = pattern.holds

    def add_load(self, pattern: Pattern, **given: Any) -> None:
        """Add a load under a name of its own."""
        if len(self.loads) >= _MOST:
            raise pattern.card.error(f"makes more than {_MOST} different loads; expected uniform ones")
        load = Load(name=self.label(given.pop("name")), **given)
        self.loads.append(load)
        self.cards[load.label] = pattern.card
        self.factors[load.label] = pattern

    def scale(self, k: int, steps: Sequence[DeckStep]) -> dict[str, float | tuple[float, ...]]:
        """Factors by label at the end of step k, or at all times in it at which any of them turns."""
        step = steps[k]
        turns = {time for pattern in self.factors.values() for time in pattern.turns(k, steps)}
        times = [*sorted(turns), step.end]
        if len(times) == 1:
            return {label: pattern.at_end(k, steps) for label, pattern in self.factors.items()}
        return {
            label: tuple(pattern.factor(k, steps, time) for time in times) for label, pattern in self.factors.items()
        }

    def switched(self, k: int) -> dict[str, Any]:
        """Supports that step k takes away, freezes and takes to their values, as a step of the model has them."""
        found: dict[str, Any] = {}
        for key, hold in (("release", ""), ("hold", "place"), ("restore", "value")):
            names = tuple(
                label
                for label, holds in self.holds.items()
                if holds[k] == hold and (holds[k - 1] if k else "value") != hold
            )
            if names:
                found[key] = names
        return found


def make_conditions(courses: Courses, places: Places, known: Known) -> Conditions:
    """Turn courses into supports and loads."""
    conditions, sections = Conditions(), known.sections
    number_of_nodes = len(known.nodes.numbering.labels)
    _supports(courses.displacement, places, conditions, known)
    _hold_idle(conditions, known)
    _forces(courses.force, places, conditions, known)
    for pattern in courses.pressure.patterns():
        for value, keys in _by_value(pattern):
            for on in places.at_edges(keys, pattern.label) if value else ():
                conditions.add_load(pattern, on=on, pressure=value, name=on)
    for pattern in courses.volume.patterns():
        for slot, value in zip(pattern.slots.tolist(), pattern.values.tolist(), strict=True):
            load = courses.volume_loads[slot]
            if value:
                conditions.add_load(pattern, on=sections[load.section].name, name=load.label, **load.given(value))
    for pattern in courses.temperature.patterns():
        _heat(pattern, sections, number_of_nodes, conditions)
    return conditions


def _heat(pattern: Pattern, sections: Sequence[Section], count: int, conditions: Conditions) -> None:
    """Temperatures act on every body that expands."""
    field = np.zeros(count)
    field[pattern.slots] = pattern.values
    for section in sections:
        if section.substance.expansion and field[section.nodes].any():
            conditions.add_load(pattern, on=section.name, temperature=field, name=f"temperature {section.name}")


def _apart(pattern: Pattern, known: Known) -> tuple[Pattern, list[tuple[DeckRigid, int, float]]]:
    """What a pattern has on nodes, and component and value of what it has on rigid bodies."""
    found = []
    rest = np.ones(len(pattern.slots), bool)
    for item in known.rigid:
        own = pattern.slots // STRIDE == item.reference
        rest &= ~own
        for slot, value in zip(pattern.slots[own].tolist(), pattern.values[own].tolist(), strict=True):
            index = component(slot, known.dimension)
            if index is not None:
                found.append((item, index, value))
    return (replace(pattern, slots=pattern.slots[rest], values=pattern.values[rest]) if found else pattern), found


def _supports(course: Course, places: Places, conditions: Conditions, known: Known) -> None:
    """Supports at rest hold all directions of a place at once; those that move are one a direction."""
    dimension = known.dimension
    resting: dict[tuple[str, tuple[Hold, ...]], list[Pattern]] = {}
    for whole in course.patterns():
        pattern, rigid = _apart(whole, known)
        for item, index, value in rigid:
            words = directions(dimension)
            u = tuple(value if i == index else None for i in range(len(words)))
            name = item.body.name
            conditions.add_support(pattern, on=name, u=u, name=f"{name} {words[index]}")
        if not any(pattern.shares):
            resting.setdefault((pattern.label, pattern.holds), []).append(pattern)
            continue
        for value, slots in _by_value(pattern):
            for axis in range(dimension):
                nodes = slots[slots % STRIDE == axis] // STRIDE
                if len(nodes):
                    u = tuple(value if i == axis else None for i in range(dimension))
                    on = places.at_nodes(nodes, pattern.label)
                    conditions.add_support(pattern, on=on, u=u, name=f"{pattern.label} u{axis + 1}")
    for (label, _), patterns in resting.items():
        slots = distinct(np.concatenate([pattern.slots for pattern in patterns]))
        nodes, where = np.unique(slots // STRIDE, return_inverse=True)
        held = np.zeros((len(nodes), dimension), bool)
        held[where, slots % STRIDE] = True
        for which in np.unique(held, axis=0)[::-1]:
            own = nodes[(held == which).all(axis=1)]
            u = tuple(0.0 if part else None for part in which)
            conditions.add_support(patterns[0], on=places.at_nodes(own, label), u=u, name=label)


def _hold_idle(conditions: Conditions, known: Known) -> None:
    """What nothing follows of the motion of a reference node stays at rest, unless the deck moves or holds it."""
    for item in known.rigid:
        held = [support.u for support in conditions.supports if support.on == item.body.name]
        idle = [i for i in item.idle if all(u[i] is None for u in held)]
        if idle:
            name = conditions.label(f"{item.body.name} idle")
            u = tuple(0.0 if i in idle else None for i in range(len(directions(known.dimension))))
            conditions.supports.append(Support(item.body.name, u=u, name=name))
            conditions.cards[name] = item.card


def _forces(course: Course, places: Places, conditions: Conditions, known: Known) -> None:
    dimension = known.dimension
    for whole in course.patterns():
        pattern, rigid = _apart(whole, known)
        for item, index, value in rigid:
            if value and index in item.idle:
                raise pattern.card.error(
                    f"acts on '{directions(known.dimension)[index]}' of the reference node of line {item.card.line}, "
                    "which nothing follows; expected a load on what is coupled"
                )
            if value:
                size, name = len(directions(dimension)), item.body.name
                force = tuple(value if i == index else 0.0 for i in range(size))
                conditions.add_load(pattern, on=name, force=force, name=name)
        nodes, where = np.unique(pattern.slots // STRIDE, return_inverse=True)
        forces: Array = np.zeros((len(nodes), dimension))
        forces[where, pattern.slots % STRIDE] = pattern.values
        if not forces.any():
            continue
        on = places.at_nodes(nodes, pattern.label)
        if (forces == forces[0]).all():
            total = tuple(float(part) * len(nodes) for part in forces[0])
            conditions.add_load(pattern, on=on, force=total, name=pattern.label)
        else:
            conditions.add_load(pattern, on=on, nodal_forces=forces, name=pattern.label)


def _by_value(pattern: Pattern) -> Iterator[tuple[float, IntArray]]:
    """Values of a pattern and their slots."""
    values, which = np.unique(pattern.values, return_inverse=True)
    for i, value in enumerate(values):
        yield float(value), pattern.slots[which == i]
