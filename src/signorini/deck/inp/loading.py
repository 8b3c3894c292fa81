# SPDX-License-Identifier: BSD-3-Clause
"""Loads and supports of a deck: what its steps set, change, keep and remove, at nodes, on faces and on sections."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.amplitudes import find_amplitude
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.course import Course, Courses, VolumeLoad
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.known import Known
from signorini.deck.inp.links import SLOTS_PER_NODE, DeckRigid, NodeSlots, rigid_motion, rigid_slots
from signorini.deck.inp.materials import Section
from signorini.deck.inp.steps import DeckStep
from signorini.model.kind import revolves


def read_dload(card: Card, known: Known, courses: Courses) -> None:
    """Pressure on faces of elements, gravity, rotation and forces per volume.

    Parameters
    ----------
    card : the ``*DLOAD``
    known : elements with their sets and faces
    courses : what its loads become part of
    """
    card.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        kind = row.text(1, "the kind of load, like P2").upper()
        if kind == "GRAV" and not row.fields[0]:  # as CAE writes it for the whole model
            label, elements = "", np.concatenate([section.elements for section in known.sections])
        else:
            label, elements = known.elements.find(row.text(0, "an element or an element set"), row)
        at = card.at(row)
        if kind[:1] == "P" and kind[1:].isdigit():
            keys = known.faces.keys(elements, kind, row, "*DLOAD")
            name = f"{label} {kind}" if label in known.elements else "single elements"
            courses.pressure.put(keys, row.number(2, "the pressure"), name, at, amplitude, adds=True)
            continue
        if kind not in _VOLUME_LOADS or (kind == "BZ" and known.dimension == 2):
            raise row.error(f"*DLOAD: '{kind}' is not supported; expected P1, P2, ..., GRAV, CENTRIF, BX, BY or BZ")
        value, given = _VOLUME_LOADS[kind](row, known)
        for load in _on_sections(row, kind, label, _whole_sections(elements, label, known.sections, row), given):
            slot = courses.volume_slot(load)
            courses.volume.put(np.array([slot]), value, load.label, at, amplitude, adds=True)


def read_dsload(card: Card, known: Known, courses: Courses) -> None:
    """Pressure on surfaces.

    Parameters
    ----------
    card : the ``*DSLOAD``
    known : surfaces
    courses : what its loads become part of
    """
    card.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        kind = row.text(1, "the kind of load, P").upper()
        if kind != "P":
            raise row.error(f"*DSLOAD: '{kind}' is not supported; expected P")
        surface = known.surfaces.find(row.text(0, "a surface"), row)
        surface.refuse_bare(row)
        value = row.number(2, "the pressure")
        courses.pressure.put(surface.keys, value, surface.name, card.at(row), amplitude, adds=True)


def _gravity(row: Row, known: Known) -> tuple[float, dict[str, Any]]:
    """An acceleration and its direction."""
    acceleration = row.number(2, "the acceleration")
    direction = np.array([row.number(i, "a component of the direction", 0.0) for i in (3, 4, 5)])
    size = np.linalg.norm(direction)
    if not size > 0.0:
        raise row.error("*DLOAD: gravity has no direction")
    if direction[2] and known.dimension == 2:
        raise row.error("*DLOAD: gravity leaves the plane of the model")
    return acceleration, {"direction": tuple(float(part / size) for part in direction[: len(known.motions)])}


def _force_along(axis: int, row: Row, known: Known) -> tuple[float, dict[str, Any]]:
    """A force per volume along one of the axes."""
    return row.number(2, "the force per volume"), {
        "direction": tuple(float(i == axis) for i in range(len(known.motions)))
    }


def _rotation(row: Row, known: Known) -> tuple[float, dict[str, Any]]:
    """Square of the angular velocity, a point of the axis and its direction."""
    square = row.number(2, "the square of the angular velocity")
    if square < 0.0:
        raise row.error(f"*DLOAD: the square of the angular velocity is {square:g}; expected a number >= 0")
    x, y, z, *axis = (row.number(i, "a coordinate or direction", 0.0) for i in range(3, 9))
    along = np.flatnonzero(axis).tolist()
    if known.dimension == 3:
        if not along:
            raise row.error("*DLOAD: the axis of rotation has no direction")
        size = float(np.linalg.norm(axis))
        return square, {"direction": tuple(part / size for part in axis), "centre": (x, y, z)}
    axisymmetric = revolves(known.grid.kind)
    if along != ([1] if axisymmetric else [2]) or (axisymmetric and x):
        expected = "the y axis, of symmetry" if axisymmetric else "across the plane, like 0, 0, 1"
        raise row.error(f"*DLOAD: the axis of rotation is along {axis}; expected {expected}")
    return square, {"direction": (), "centre": () if axisymmetric else (x, y)}


_VOLUME_LOADS: Mapping[str, Callable[[Row, Known], tuple[float, dict[str, Any]]]] = {
    "GRAV": _gravity,
    "CENTRIF": _rotation,
    **{f"B{axis}": partial(_force_along, i) for i, axis in enumerate("XYZ")},
}
"""Readers of what acts on whole sections: value, and direction and centre of the load."""

_INERTIA = {"GRAV": "gravity", "CENTRIF": "rotation"}
"""Loads that need a density, in words."""


def _on_sections(
    row: Row, kind: str, label: str, sections: Iterable[tuple[int, Section]], given: Mapping[str, Any]
) -> Iterator[VolumeLoad]:
    """The load on every one of some sections with their indices."""
    for i, section in sections:
        density = section.substance.density
        if density is None and kind in _INERTIA:
            raise row.error(f"*DLOAD: {_INERTIA[kind]} needs *DENSITY in the material of '{section.name}'")
        name = f"{_INERTIA.get(kind, kind)} {section.name}"
        load = VolumeLoad(kind=kind, place="", section=i, label=name, **given)
        if kind == "GRAV" and density is not None:
            direction = tuple(density * part for part in load.direction)
            load = replace(load, place=label.upper(), direction=direction)
        yield load


def _whole_sections(elements: IntArray, label: str, sections: Sequence[Section], row: Row) -> list[tuple[int, Section]]:
    """The sections that elements make up, with their indices."""
    chosen = distinct(elements)
    found = [(i, each) for i, each in enumerate(sections) if np.isin(each.elements, chosen).all()]
    if sum(len(section.elements) for _, section in found) < len(chosen):
        raise row.error(f"*DLOAD: '{label}' holds a part of a section; expected whole sections")
    return found


_HELD_AXES = {  # by the words of Abaqus for them
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
    "PINNED": (1, 2, 3),
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
    "XASYMM": (2, 3, 4),
    "YASYMM": (1, 3, 5),
    "ZASYMM": (1, 2, 6),
}


def follow_steps(
    outside: Sequence[Card], steps: Sequence[DeckStep], known: Known, rigid: Sequence[DeckRigid]
) -> Courses:
    """Read boundaries and loads in the order of the steps.

    Parameters
    ----------
    outside : keywords outside the steps; boundaries there hold from the first step on
    steps : in order
    known : nodes, elements, sections, surfaces, amplitudes
    rigid : what has reference nodes

    Raises
    ------
    DeckError
        Of all keywords that are refused, together.
    """
    courses = Courses(rigid=rigid, initial=initial_temperatures(outside, known))
    for card in outside:
        with known.refusals.gather():
            if card.keyword == "BOUNDARY":
                _boundary(card, known, courses)
            elif card.keyword in _READERS:
                raise card.error("stands outside the steps; expected loads inside a *STEP")
    for step in steps:
        for course in courses.all:
            course.begin_step()
        cards = [card for card in step.cards if card.keyword in _READERS]
        for keywords, names in _REPLACED_TOGETHER.items():
            cleared = [getattr(courses, name) for name in names]
            _renew([card for card in cards if card.keyword in keywords], cleared, courses.notes)
        for card in cards:
            with known.refusals.gather():
                _READERS[card.keyword](card, known, courses)
        courses.notes.extend(_kept_beside(courses, step))
        if step.held and courses.displacement.sets_constants:
            courses.notes.append(
                f"supports move at the beginning of {step.name}, by its AMPLITUDE=STEP, as in CalculiX; Abaqus takes "
                "them linearly to the end of the step"
            )
        for course in courses.all:
            course.end_step(step)
    known.refusals.stop()
    return courses


def _renew(cards: Sequence[Card], cleared: Sequence[Course], notes: list[str]) -> None:
    """``OP=NEW`` of the first card of its kind in a step takes away what earlier steps have set, as in CalculiX."""
    new = [card for card in cards if card.choice("OP", ("MOD", "NEW"), "MOD") == "NEW"]
    if not new:
        return
    if new[0] is not cards[0]:
        notes.append(
            f"OP=NEW in line {new[0].line} takes nothing away, as in CalculiX: the first *{cards[0].keyword} of the "
            f"step, in line {cards[0].line}, does without"
        )
        return
    others = {word for course in cleared for word in course.keywords} - {card.keyword for card in new}
    if others:
        notes.append(
            f"*{cards[0].keyword}, OP=NEW in line {cards[0].line} takes away what *{others.pop()} has set too, as in "
            "CalculiX: to Abaqus they are apart"
        )
    for course in cleared:
        course.clear()


def _kept_beside(courses: Courses, step: DeckStep) -> Iterator[str]:
    """Gravity and rotation of earlier steps that go on beside those of this step, and rotation about several axes."""
    for kind, other, alike in (("GRAV", "direction or set", ", as in CalculiX,"), ("CENTRIF", "axis", "")):
        new, kept = (
            [courses.volume_loads[slot].section for slot in slots if courses.volume_loads[slot].kind == kind]
            for slots in (courses.volume.new_slots, courses.volume.kept_slots)
        )
        if set(new) & set(kept):
            yield (
                f"{kind} of {step.name} acts beside that of an earlier step on the same elements{alike} since its "
                f"{other} is another; OP=NEW takes the earlier one away"
            )
        if kind == "CENTRIF" and new and len({*new, *kept}) < len(new) + len(kept):
            yield (
                f"CENTRIF of {step.name} acts about several axes on the same elements; to CalculiX the first is the "
                "only one"
            )


def _boundary(card: Card, known: Known, courses: Courses) -> None:
    card.refuse_unknown(("OP", "AMPLITUDE", "TYPE", "FIXED"), ("LOAD CASE",))
    card.choice("TYPE", ("DISPLACEMENT",), "DISPLACEMENT")
    amplitude, fixed = find_amplitude(card, known.amplitudes), "FIXED" in card.parameters
    if fixed and amplitude is not None:
        raise card.error("FIXED goes with no AMPLITUDE: nodes stay where they are")
    for row in card.rows():
        label, nodes = _nodes(row, known, "single nodes")
        axes, value = _held(row, known.dimension)
        slots, rest = rigid_slots(courses.rigid, nodes, axes)
        if len(rest) and value != 0.0 and not known.motions.keys() >= set(axes):
            raise row.error(f"*BOUNDARY: direction {axes[-1]} moves by {value:g}; expected {known.spelled}")
        own = [NodeSlots.pack(rest, known.motions[axis]) for axis in axes if axis in known.motions]
        slots = np.concatenate([slots, *own])
        if not fixed:
            courses.displacement.put(slots, value, label, card.at(row), amplitude, adds=False)
        elif value:
            raise row.error(f"*BOUNDARY: FIXED goes with no displacement, {value:g}: nodes stay where they are")
        else:
            courses.displacement.freeze(slots, label, card.at(row))


def _held(row: Row, dimension: int) -> tuple[tuple[int, ...], float]:
    """Directions 1 .. 6 of a data line of ``*BOUNDARY``, and the displacement in them."""
    word = row.text(1, "a direction").upper()
    if word in _HELD_AXES:
        return _HELD_AXES[word], 0.0
    first = row.whole(1, "a direction")
    last = row.whole(2, "the last direction", first)
    value = row.number(3, "the displacement", 0.0)
    if first < 1 or last < first or last > 6:
        raise row.error(f"*BOUNDARY: directions {first} to {last}; expected 1 to {dimension}")
    return tuple(range(first, last + 1)), value


def _nodes(row: Row, known: Known, singly: str) -> tuple[str, IntArray]:
    """Label and nodes of a data line; the label ``singly`` where it gives a number, not a set."""
    label, nodes = known.nodes.find(row.text(0, "a node or a node set"), row)
    return singly if label.startswith("node ") and label not in known.nodes else label, nodes


def _cload(card: Card, known: Known, courses: Courses) -> None:
    card.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        label, nodes = _nodes(row, known, "forces on single nodes")
        axis = row.whole(1, "a direction")
        value = row.number(2, "the force")
        slots, rest = rigid_slots(courses.rigid, nodes, [axis])
        motions = [rigid_motion(i, known.grid.kind) for i in NodeSlots(slots).axes.tolist()]
        there = axis in (known.motions if len(rest) else range(1, SLOTS_PER_NODE + 1))
        if not there or not (len(rest) or (motions and None not in motions)):
            turns = "" if len(rest) else ", or a rotation of the rigid body"
            raise row.error(f"*CLOAD: direction {axis}; expected {known.spelled}{turns}")
        slots = np.append(slots, NodeSlots.pack(rest, known.motions.get(axis, 0)))
        courses.force.put(slots, value, label, card.at(row), amplitude, adds=True)


def initial_temperatures(outside: Sequence[Card], known: Known) -> Array:
    """Temperature of every node at the beginning, (n,), from ``*INITIAL CONDITIONS``; 0 where none is given.

    Parameters
    ----------
    outside : cards outside the steps
    known : what has a number or a name
    """
    temperatures = np.zeros(len(known.nodes.numbering.labels))
    for card in of_keyword(outside, "INITIAL CONDITIONS"):
        card.refuse_unknown(("TYPE",))
        card.choice("TYPE", ("TEMPERATURE",), "")
        for row in card.rows():
            nodes = known.nodes.find(row.text(0, "a node or a node set"), row)[1]
            temperatures[nodes] = row.number(1, "the temperature")
    return temperatures


def _temperature(card: Card, known: Known, courses: Courses) -> None:
    card.refuse_unknown(("OP", "AMPLITUDE"))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        nodes = known.nodes.find(row.text(0, "a node or a node set"), row)[1]
        value = row.number(1, "the temperature")
        initial = courses.initial[nodes]
        if amplitude is not None and initial.any():
            raise row.error("*TEMPERATURE: an amplitude together with initial temperatures is not supported")
        for start in np.unique(initial):
            own = nodes[initial == start]
            courses.temperature.put(own, value - float(start), "temperature", card.at(row), amplitude, adds=False)


_READERS: Mapping[str, Callable[[Card, Known, Courses], None]] = {
    "BOUNDARY": _boundary,
    "CLOAD": _cload,
    "DLOAD": read_dload,
    "DSLOAD": read_dsload,
    "TEMPERATURE": _temperature,
}
_REPLACED_TOGETHER = {  # keywords, and the courses that OP=NEW of one of them clears
    ("BOUNDARY",): ("displacement",),
    ("CLOAD",): ("force",),
    ("DLOAD", "DSLOAD"): ("pressure", "volume"),
    ("TEMPERATURE",): ("temperature",),
}
