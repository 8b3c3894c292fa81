# SPDX-License-Identifier: BSD-3-Clause
"""Loads and supports of a deck: what its steps set, change, keep and remove."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from signorini.arrays import Array
from signorini.deck.inp.acting import Courses, Known
from signorini.deck.inp.amplitudes import find_amplitude
from signorini.deck.inp.card import Card
from signorini.deck.inp.course import Course
from signorini.deck.inp.distributed import read_dload, read_dsload
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.links import STRIDE, component, rigid_slots
from signorini.deck.inp.steps import DeckStep

_HELD, _PULLED = "single nodes", "forces on single nodes"  # labels where the deck gives numbers, not a set

_TYPES = {
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
    "PINNED": (1, 2, 3),
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
}
_DISTRIBUTED = ("DLOAD", "DSLOAD")


def follow_steps(model: list[Placed], steps: list[DeckStep], known: Known) -> Courses:
    """Read boundaries and loads in the order of the steps.

    Parameters
    ----------
    model : keywords outside the steps; boundaries there hold from the first step on

    Raises
    ------
    DeckError
        For what is not supported, with its line.
    """
    courses = Courses()
    initial = initial_temperatures(model, known)
    readers: Mapping[str, Callable[[Placed, Known, Courses], None]] = {
        "BOUNDARY": _boundary,
        "CLOAD": _cload,
        "DLOAD": read_dload,
        "DSLOAD": read_dsload,
        "TEMPERATURE": lambda item, known, courses: _temperature(item, known, courses, initial),
    }
    for item in model:
        if item.card.keyword == "BOUNDARY":
            _boundary(item, known, courses)
        elif item.card.keyword in readers:
            raise item.card.error("stands outside the steps; expected loads inside a *STEP")
    for step in steps:
        for course in courses.all:
            course.begin_step()
        cards = [item for item in step.placed if item.card.keyword in readers]
        for keywords in (("BOUNDARY",), ("CLOAD",), _DISTRIBUTED, ("TEMPERATURE",)):
            _renew([item.card for item in cards if item.card.keyword in keywords], courses)
        for item in cards:
            readers[item.card.keyword](item, known, courses)
        courses.notes.extend(_kept_beside(courses, step))
        if step.held and courses.displacement.plain:
            courses.notes.append(
                f"supports move at the beginning of {step.name}, by its AMPLITUDE=STEP, as in CalculiX; Abaqus takes "
                "them linearly to the end of the step"
            )
        for course in courses.all:
            course.end_step(step)
    return courses


def _renew(cards: Sequence[Card], courses: Courses) -> None:
    """``OP=NEW`` of the first card of its kind in a step takes away what earlier steps have set, as in CalculiX."""
    new = [card for card in cards if card.choice("OP", ("MOD", "NEW"), "MOD") == "NEW"]
    if not new:
        return
    if new[0] is not cards[0]:
        courses.notes.append(
            f"OP=NEW in line {new[0].line} takes nothing away, as in CalculiX: the first *{cards[0].keyword} of the "
            f"step, in line {cards[0].line}, does without"
        )
        return
    cleared = _of(cards[0].keyword, courses)
    others = {word for course in cleared for word in course.keywords} - {card.keyword for card in new}
    if others:
        courses.notes.append(
            f"*{cards[0].keyword}, OP=NEW in line {cards[0].line} takes away what *{others.pop()} has set too, as in "
            "CalculiX: to Abaqus they are apart"
        )
    for course in cleared:
        course.clear()


def _of(keyword: str, courses: Courses) -> tuple[Course, ...]:
    if keyword in _DISTRIBUTED:
        return courses.pressure, courses.volume
    return ({"BOUNDARY": courses.displacement, "CLOAD": courses.force, "TEMPERATURE": courses.temperature}[keyword],)


def _kept_beside(courses: Courses, step: DeckStep) -> Iterator[str]:
    """Gravity of earlier steps that goes on beside that of this step."""
    loads = courses.volume_loads
    kept = {loads[slot].section for slot in courses.volume.kept if loads[slot].kind == "GRAV"}
    if any(loads[slot].kind == "GRAV" and loads[slot].section in kept for slot in courses.volume.fresh):
        yield (
            f"GRAV of {step.name} acts beside that of an earlier step on the same elements, as in CalculiX, since its "
            "direction or set is another; OP=NEW takes the earlier one away"
        )


def _boundary(item: Placed, known: Known, courses: Courses) -> None:
    card = item.card
    card.refuse_unknown(("OP", "AMPLITUDE", "TYPE", "FIXED"), ("LOAD CASE",))
    card.choice("TYPE", ("DISPLACEMENT",), "DISPLACEMENT")
    amplitude, fixed = find_amplitude(card, known.amplitudes), "FIXED" in card.parameters
    if fixed and amplitude is not None:
        raise card.error("FIXED goes with no AMPLITUDE: nodes stay where they are")
    for row in card.rows():
        label, nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)
        label = _HELD if label.startswith("node ") and label not in known.nodes else label
        word = row.text(1, "a direction").upper()
        if word in _TYPES:
            axes, value = _TYPES[word], 0.0
        else:
            first = row.whole(1, "a direction")
            last = row.whole(2, "the last direction", first)
            value = row.number(3, "the displacement", 0.0)
            if first < 1 or last < first or last > 6:
                raise row.error(f"*BOUNDARY: directions {first} to {last}; expected 1 to {known.dimension}")
            axes = tuple(range(first, last + 1))
        slots, rest = rigid_slots(known.rigid, nodes, axes)
        if len(rest) and axes[-1] > known.dimension and value != 0.0:
            raise row.error(f"*BOUNDARY: direction {axes[-1]} moves by {value:g}; expected 1 to {known.dimension}")
        for axis in axes:
            if axis <= known.dimension:
                slots = np.append(slots, STRIDE * rest + axis - 1)
        if fixed and value:
            raise row.error(f"*BOUNDARY: FIXED goes with no displacement, {value:g}: nodes stay where they are")
        if fixed:
            courses.displacement.freeze(slots, label, card.at(row))
        else:
            courses.displacement.put(slots, value, label, card.at(row), amplitude, adds=False)


def _cload(item: Placed, known: Known, courses: Courses) -> None:
    card = item.card
    card.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        label, nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)
        label = _PULLED if label.startswith("node ") and label not in known.nodes else label
        axis = row.whole(1, "a direction")
        value = row.number(2, "the force")
        slots, rest = rigid_slots(known.rigid, nodes, [axis])
        there = len(slots) > 0 and all(component(slot, known.dimension) is not None for slot in slots.tolist())
        most = known.dimension if len(rest) else STRIDE
        if not 1 <= axis <= most or not (len(rest) or there):
            turns = "" if len(rest) else ", or a rotation of the rigid body"
            raise row.error(f"*CLOAD: direction {axis}; expected 1 to {known.dimension}{turns}")
        slots = np.append(slots, STRIDE * rest + axis - 1)
        courses.force.put(slots, value, label, card.at(row), amplitude, adds=True)


def initial_temperatures(model: list[Placed], known: Known) -> Array:
    """Temperature of every node at the beginning, (n,), from ``*INITIAL CONDITIONS``; 0 where none is given."""
    temperatures = np.zeros(len(known.nodes.numbering.labels))
    for item in model:
        card = item.card
        if card.keyword == "INITIAL CONDITIONS":
            card.refuse_unknown(("TYPE",))
            card.choice("TYPE", ("TEMPERATURE",), "")
            for row in card.rows():
                nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)[1]
                temperatures[nodes] = row.number(1, "the temperature")
    return temperatures


def _temperature(item: Placed, known: Known, courses: Courses, initial: Array) -> None:
    card = item.card
    card.refuse_unknown(("OP", "AMPLITUDE"))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)[1]
        value = row.number(1, "the temperature")
        if amplitude is not None and initial[nodes].any():
            raise row.error("*TEMPERATURE: an amplitude together with initial temperatures is not supported")
        for start in np.unique(initial[nodes]):
            own = nodes[initial[nodes] == start]
            courses.temperature.put(own, value - float(start), "temperature", card.at(row), amplitude, adds=False)
