# SPDX-License-Identifier: BSD-3-Clause
"""From what the deck's steps set to the supports, the loads and the factors of a model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.card import Card
from signorini.deck.inp.course import Courses, Hold, Pattern
from signorini.deck.inp.known import Known
from signorini.deck.inp.links import (
    DeckEquation,
    DeckRigid,
    NodeSlots,
    node_motion,
    refuse_turned,
    rigid_motion,
)
from signorini.deck.inp.sets import unique_label
from signorini.deck.inp.steps import DeckStep
from signorini.model.conditions import Load, Support
from signorini.model.links import Equation, directions
from signorini.model.varying import Formula

_MAX_LOADS = 1000  # more would be a field, which takes memory for each of them
_OBLIQUE_NOTE = (
    "supports along directions of *TRANSFORM that are no axes of the model are equations: their forces are not among "
    "the reactions, nor in tables of RF"
)


@dataclass(kw_only=True)
class Conditions:
    """Supports and loads with their factors at the end of every step.

    Attributes
    ----------
    supports, loads : of the model
    cards : the keyword of each support and load, by label
    factors : label to its pattern, of what moves or loads
    holds : label of a support that some step takes away, brings or freezes to what it holds at, step by step
    equations : of what is held across the axes of the model
    notes : where Abaqus and CalculiX differ, and which of them is followed
    """

    supports: list[Support] = field(default_factory=list)
    loads: list[Load] = field(default_factory=list)
    cards: dict[str, Card] = field(default_factory=dict)
    factors: dict[str, Pattern] = field(default_factory=dict)
    holds: dict[str, tuple[Hold, ...]] = field(default_factory=dict)
    equations: list[DeckEquation] = field(default_factory=list)
    notes: Sequence[str] = ()

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
        if len(self.loads) >= _MAX_LOADS:
            raise pattern.card.error(f"makes more than {_MAX_LOADS} different loads; expected uniform ones")
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


def make_conditions(courses: Courses, known: Known) -> Conditions:
    """Turn courses into supports and loads."""
    conditions, sections = Conditions(notes=courses.notes), known.sections
    _supports(courses, conditions, known)
    _hold_idle(courses.rigid, conditions, known.dimension)
    _forces(courses, conditions, known)
    for pattern in courses.pressure.patterns():
        for value, keys in _by_value(pattern):
            for on in known.places.at_faces(keys, pattern.label) if value else ():
                conditions.add_load(pattern, on=on, pressure=value, name=on)
    for pattern in courses.volume.patterns():
        for slot, value in zip(pattern.slots.tolist(), pattern.values.tolist(), strict=True):
            load = courses.volume_loads[slot]
            if value:
                conditions.add_load(pattern, on=sections[load.section].name, name=load.label, **load.given(value))
    for pattern in courses.temperature.patterns():
        field = np.zeros(len(courses.initial))
        field[pattern.slots] = pattern.values
        for section in sections:  # temperatures act on every body that feels them
            if section.substance.feels_heat and field[section.nodes].any():
                conditions.add_load(pattern, on=section.name, temperature=field, name=f"temperature {section.name}")
    return conditions


def _apart(
    pattern: Pattern, rigid: Sequence[DeckRigid], known: Known
) -> tuple[Pattern, list[tuple[DeckRigid, int, float]]]:
    """What a pattern has on nodes; and rigid bodies with the motion and the value that it has on them."""
    found, packed = [], NodeSlots(pattern.slots)
    rest = np.ones(len(pattern.slots), bool)
    for item in rigid:
        own = packed.nodes == item.reference
        rest &= ~own
        for axis, value in zip(packed.axes[own].tolist(), pattern.values[own].tolist(), strict=True):
            motion = rigid_motion(axis, known.grid.kind)
            if motion is not None:
                refuse_turned(pattern.card, item.reference, known)
                found.append((item, motion, value))
    return (replace(pattern, slots=pattern.slots[rest], values=pattern.values[rest]) if found else pattern), found


def _only(which: int, value: Any, count: int, rest: float | None = None) -> tuple[Any, ...]:
    """A value in one of so many directions."""
    return tuple(value if i == which else rest for i in range(count))


def _supports(courses: Courses, conditions: Conditions, known: Known) -> None:
    """Supports at rest hold all directions of a place at once; those that move are one a direction."""
    components, words = len(known.motions), directions(known.dimension)
    resting: dict[tuple[str, tuple[Hold, ...]], list[Pattern]] = {}
    for whole in courses.displacement.patterns():
        pattern, rigid = _apart(whole, courses.rigid, known)
        pattern = _along_axes(pattern, conditions, known)
        for item, motion, value in rigid:
            u, name = _only(motion, value, len(words)), item.body.name
            conditions.add_support(pattern, on=name, u=u, name=f"{name} {words[motion]}")
        if any(pattern.shares):
            _moving(pattern, conditions, known)
        else:
            resting.setdefault((pattern.label, pattern.holds), []).append(pattern)
    for (label, _), patterns in resting.items():
        slots = distinct(np.concatenate([pattern.slots for pattern in patterns]))
        nodes, held = _by_node(slots, np.ones(len(slots)), components)
        for which in np.unique(held, axis=0)[::-1]:
            on = known.places.at_nodes(nodes[(held == which).all(axis=1)], label)
            conditions.add_support(patterns[0], on=on, u=tuple(0.0 if part else None for part in which), name=label)


def _along_axes(pattern: Pattern, conditions: Conditions, known: Known) -> Pattern:
    """What a pattern holds along the axes of the model; what it holds across them at rest becomes equations.

    Raises
    ------
    DeckError
        Where supports across the axes move, or come and go.
    """
    packed = NodeSlots(pattern.slots)
    own = known.axes.own(packed.nodes)
    if not own.any():
        return pattern
    nodes, axes = packed.nodes[own], packed.axes[own]
    units = known.axes.of(nodes)[np.arange(len(nodes)), axes]
    still = not any(pattern.shares)
    _, which, count = np.unique(nodes, return_inverse=True, return_counts=True)
    whole = still & (count[which] == known.dimension)  # a node at rest in all directions is so along any axes
    along = np.where(whole, axes, np.abs(units).argmax(axis=1))
    oblique = ~whole & (np.count_nonzero(units, axis=1) > 1)
    if oblique.any() and not (still and all(hold == "value" for hold in pattern.holds)):
        number = known.nodes.numbering.labels[nodes[oblique][0]]
        raise pattern.card.error(
            f"moves node {number} along direction {axes[oblique][0] + 1} of its *TRANSFORM, across the axes of the "
            "model, or holds it so in some steps only; expected nodes at rest there in all steps"
        )
    if oblique.any() and not conditions.equations:
        conditions.notes = [*conditions.notes, _OBLIQUE_NOTE]
    for node, axis in zip(nodes[oblique].tolist(), axes[oblique].tolist(), strict=True):
        equation = Equation(node_motion(node, axis, known))
        conditions.equations.append(DeckEquation(equation=equation, card=pattern.card))
    signs = np.where(whole, 1.0, np.sign(units[np.arange(len(nodes)), along]))
    slots = np.concatenate([pattern.slots[~own], NodeSlots.pack(nodes, along)[~oblique]])
    values = np.concatenate([pattern.values[~own], (pattern.values[own] * signs)[~oblique]])
    order = np.argsort(slots)
    return replace(pattern, slots=slots[order], values=values[order])


def _moving(pattern: Pattern, conditions: Conditions, known: Known) -> None:
    """Supports of nodes that are moved."""
    for value, slots in _by_value(pattern):
        packed = NodeSlots(slots)
        for direction, axis in known.motions.items():
            nodes = packed.nodes[packed.axes == axis]
            if len(nodes):
                moved = Formula(f"{value!r}*x") if direction > known.dimension else value  # an angle times the radius
                on, u = known.places.at_nodes(nodes, pattern.label), _only(axis, moved, len(known.motions))
                conditions.add_support(pattern, on=on, u=u, name=f"{pattern.label} u{direction}")


def _by_node(slots: IntArray, values: Array, components: int) -> tuple[IntArray, Array]:
    """Sorted nodes of slots, and (nodes, components) the values in all directions, 0 where there is none."""
    packed = NodeSlots(slots)
    nodes, where = np.unique(packed.nodes, return_inverse=True)
    table = np.zeros((len(nodes), components))
    table[where, packed.axes] = values
    return nodes, table


def _hold_idle(rigid: Sequence[DeckRigid], conditions: Conditions, dimension: int) -> None:
    """What nothing follows of the motion of a reference node stays at rest, unless the deck moves or holds it."""
    for item in rigid:
        held = [support.u for support in conditions.supports if support.on == item.body.name]
        idle = [i for i in item.idle if all(u[i] is None for u in held)]
        if idle:
            name = conditions.label(f"{item.body.name} idle")
            u = tuple(0.0 if i in idle else None for i in range(len(directions(dimension))))
            conditions.supports.append(Support(item.body.name, u=u, name=name))
            conditions.cards[name] = item.card


def _forces(courses: Courses, conditions: Conditions, known: Known) -> None:
    components, words = len(known.motions), directions(known.dimension)
    for whole in courses.force.patterns():
        pattern, rigid = _apart(whole, courses.rigid, known)
        for item, motion, value in rigid:
            if value and motion in item.idle:
                raise pattern.card.error(
                    f"acts on '{words[motion]}' of the reference node of line {item.card.line}, which nothing follows; "
                    "expected a load on what is coupled"
                )
            if value:
                name = item.body.name
                conditions.add_load(pattern, on=name, force=_only(motion, value, len(words), 0.0), name=name)
        nodes, forces = _by_node(pattern.slots, pattern.values, components)
        if known.twists:
            _refuse_torque_on_axis(pattern, nodes, forces, known)
            forces[:, 2] /= np.maximum(known.radii(nodes), 1e-300)  # torques: nodes of the axis bear none
        if known.axes.own(nodes).any():
            forces = np.einsum("ni,nij->nj", forces, known.axes.of(nodes))
        if not forces.any():
            continue
        on = known.places.at_nodes(nodes, pattern.label)
        if (forces == forces[0]).all():
            total = tuple(float(part) * len(nodes) for part in forces[0])
            conditions.add_load(pattern, on=on, force=total, name=pattern.label)
        else:
            conditions.add_load(pattern, on=on, nodal_forces=forces, name=pattern.label)


def _refuse_torque_on_axis(pattern: Pattern, nodes: IntArray, torques: Array, known: Known) -> None:
    wrong = nodes[(torques[:, 2] != 0.0) & (known.radii(nodes) <= 0.0)]
    if len(wrong):
        number = known.nodes.numbering.labels[wrong[0]]
        raise pattern.card.error(f"is a torque on node {number}, which is on the axis; expected one with a radius")


def _by_value(pattern: Pattern) -> Iterator[tuple[float, IntArray]]:
    """Values of a pattern and their slots."""
    values, which = np.unique(pattern.values, return_inverse=True)
    for i, value in enumerate(values):
        yield float(value), pattern.slots[which == i]
