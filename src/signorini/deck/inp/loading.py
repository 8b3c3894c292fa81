# SPDX-License-Identifier: BSD-3-Clause
"""Loads and supports of a deck: what its steps set, change, keep and remove."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.amplitudes import Amplitude, find_amplitude
from signorini.deck.inp.block import Block, Row
from signorini.deck.inp.course import Course
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.links import STRIDE, DeckRigid, rigid_slots
from signorini.deck.inp.materials import Section
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.steps import DeckStep
from signorini.deck.inp.surfaces import Edges, Surfaces

_HELD, _PULLED = "single nodes", "forces on single nodes"  # labels where the deck gives numbers, not a set

_TYPES = {
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
    "PINNED": (1, 2, 3),
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Known:
    """What keywords of loads refer to."""

    nodes: Sets
    elements: Sets
    surfaces: Surfaces
    edges: Edges
    sections: tuple[Section, ...]
    amplitudes: Mapping[str, Amplitude]
    axisymmetric: bool
    dimension: int
    rigid: tuple[DeckRigid, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Courses:
    """How everything that acts on the bodies changes with the steps.

    Attributes
    ----------
    displacement : slots ``STRIDE * node + axis``, length
    force : the same slots, force
    pressure : slots are keys of edges, force per area
    body : slots ``STRIDE * section + axis``, force per volume
    temperature : slots are nodes, above the initial temperature
    rotation : slots are sections, squares of angular velocities
    centres : of rotation by label, centre and axis as a load has them
    """

    displacement: Course
    force: Course
    pressure: Course
    body: Course
    temperature: Course
    rotation: Course
    centres: dict[str, dict[str, tuple[float, ...]]]


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
    names = ("displacement", "force", "pressure", "body", "temperature", "rotation")
    courses = Courses(**{name: Course() for name in names}, centres={})
    initial = initial_temperatures(model, known)
    readers: Mapping[str, Callable[[Placed, Known, Courses], None]] = {
        "BOUNDARY": _boundary,
        "CLOAD": _cload,
        "DLOAD": _dload,
        "DSLOAD": _dsload,
        "TEMPERATURE": lambda item, known, courses: _temperature(item, known, courses, initial),
    }
    for item in model:
        if item.block.keyword == "BOUNDARY":
            _boundary(item, known, courses)
        elif item.block.keyword in readers:
            raise item.block.error("stands outside the steps; expected loads inside a *STEP")
    for step in steps:
        cleared: set[str] = set()
        for item in step.placed:
            block = item.block
            if block.keyword not in readers:
                continue
            if block.choice("OP", ("MOD", "NEW"), "MOD") == "NEW" and block.keyword not in cleared:
                cleared.add(block.keyword)
                for course in _of(block.keyword, courses):
                    course.clear()
            readers[block.keyword](item, known, courses)
        for name in names:
            getattr(courses, name).end_step(step)
    return courses


def _of(keyword: str, courses: Courses) -> tuple[Course, ...]:
    if keyword == "BOUNDARY":
        return (courses.displacement,)
    if keyword == "TEMPERATURE":
        return (courses.temperature,)
    return (courses.force,) if keyword == "CLOAD" else (courses.pressure, courses.body, courses.rotation)


def _boundary(item: Placed, known: Known, courses: Courses) -> None:
    block = item.block
    block.refuse_unknown(("OP", "AMPLITUDE", "TYPE", "FIXED"), ("LOAD CASE",))
    block.choice("TYPE", ("DISPLACEMENT",), "DISPLACEMENT")
    amplitude, fixed = find_amplitude(block, known.amplitudes), "FIXED" in block.parameters
    if fixed and amplitude is not None:
        raise block.error("FIXED goes with no AMPLITUDE: nodes stay where they are")
    for row in block.rows():
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
            courses.displacement.freeze(slots, label, block)
        else:
            courses.displacement.put(slots, value, label, block, amplitude, adds=False)


def _cload(item: Placed, known: Known, courses: Courses) -> None:
    block = item.block
    block.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(block, known.amplitudes)
    for row in block.rows():
        label, nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)
        label = _PULLED if label.startswith("node ") and label not in known.nodes else label
        axis = row.whole(1, "a direction")
        value = row.number(2, "the force")
        slots, rest = rigid_slots(known.rigid, nodes, [axis])
        if not 1 <= axis <= (known.dimension if len(rest) else 6):
            raise row.error(f"*CLOAD: direction {axis}; expected 1 to {known.dimension}")
        slots = np.append(slots, STRIDE * rest + axis - 1)
        courses.force.put(slots, value, label, block, amplitude, adds=True)


def _dload(item: Placed, known: Known, courses: Courses) -> None:
    block = item.block
    block.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(block, known.amplitudes)
    for row in block.rows():
        kind = row.text(1, "the kind of load, like P2").upper()
        label, elements = known.elements.find(row.text(0, "an element or an element set"), item.scope, row)
        if kind[:1] == "P" and kind[1:].isdigit():
            keys = known.edges.keys(elements, kind, row, "*DLOAD")
            value = row.number(2, "the pressure")
            name = f"{label} {kind}" if label in known.elements else "single elements"
            courses.pressure.put(keys, value, name, block, amplitude, adds=True)
        elif kind == "GRAV":
            gravity = row.number(2, "the acceleration")
            direction = np.array([row.number(i, "a component of the direction", 0.0) for i in (3, 4, 5)])
            size = np.linalg.norm(direction)
            if not size > 0.0:
                raise row.error("*DLOAD: gravity has no direction")
            if direction[2] and known.dimension == 2:
                raise row.error("*DLOAD: gravity leaves the plane of the model")
            for i in _whole_sections(elements, label, known, row):
                density = known.sections[i].substance.density
                if density is None:
                    raise row.error(f"*DLOAD: gravity needs *DENSITY in the material of '{known.sections[i].name}'")
                for axis in range(known.dimension):
                    force = density * gravity * float(direction[axis] / size)
                    slots = np.array([STRIDE * i + axis])
                    courses.body.put(slots, force, f"gravity {known.sections[i].name}", block, amplitude, adds=False)
        elif kind in ("BX", "BY", "BZ")[: known.dimension]:
            for i in _whole_sections(elements, label, known, row):
                slots = np.array([STRIDE * i + "XYZ".index(kind[1])])
                value = row.number(2, "the force per volume")
                courses.body.put(slots, value, f"{kind} {known.sections[i].name}", block, amplitude, adds=True)
        elif kind == "CENTRIF":
            _rotate(row, _whole_sections(elements, label, known, row), block, amplitude, known, courses)
        else:
            raise row.error(f"*DLOAD: '{kind}' is not supported; expected P1, P2, ..., GRAV, CENTRIF, BX, BY or BZ")


def _rotate(
    row: Row, sections: list[int], block: Block, amplitude: Amplitude | None, known: Known, courses: Courses
) -> None:
    """Square of the angular velocity, a point of the axis and its direction."""
    square = row.number(2, "the square of the angular velocity")
    if square < 0.0:
        raise row.error(f"*DLOAD: the square of the angular velocity is {square:g}; expected a number >= 0")
    x, y, z, *axis = (row.number(i, "a coordinate or direction", 0.0) for i in range(3, 9))
    along = np.flatnonzero(axis).tolist()
    if known.dimension == 3 and not along:
        raise row.error("*DLOAD: the axis of rotation has no direction")
    if (known.dimension == 2 and along != ([1] if known.axisymmetric else [2])) or (known.axisymmetric and x):
        expected = "the y axis, of symmetry" if known.axisymmetric else "across the plane, like 0, 0, 1"
        raise row.error(f"*DLOAD: the axis of rotation is along {axis}; expected {expected}")
    label = "rotation" if known.axisymmetric else f"rotation about ({x:g}, {y:g})"
    given: dict[str, tuple[float, ...]] = {} if known.axisymmetric else {"centre": (x, y)}
    if known.dimension == 3:
        size = float(np.linalg.norm(axis))
        given = {"centre": (x, y, z), "axis": tuple(part / size for part in axis)}
        label = f"rotation about {', '.join(f'{part:g}' for key in given for part in given[key])}"
    courses.centres[label] = given
    for i in sections:
        if known.sections[i].substance.density is None:
            raise row.error(f"*DLOAD: rotation needs *DENSITY in the material of '{known.sections[i].name}'")
        courses.rotation.put(np.array([i]), square, label, block, amplitude, adds=False)


def _dsload(item: Placed, known: Known, courses: Courses) -> None:
    block = item.block
    block.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(block, known.amplitudes)
    for row in block.rows():
        kind = row.text(1, "the kind of load, P").upper()
        if kind != "P":
            raise row.error(f"*DSLOAD: '{kind}' is not supported; expected P")
        name = known.surfaces.find(row.text(0, "a surface"), item.scope, row)
        keys = known.surfaces.keys[name.upper()]
        courses.pressure.put(keys, row.number(2, "the pressure"), name, block, amplitude, adds=True)


def _whole_sections(elements: IntArray, label: str, known: Known, row: Row) -> list[int]:
    """Indices of the sections that elements make up."""
    chosen = distinct(elements)
    found = [i for i, section in enumerate(known.sections) if np.isin(section.elements, chosen).all()]
    covered = sum(len(known.sections[i].elements) for i in found)
    if covered < len(chosen):
        raise row.error(f"*DLOAD: '{label}' holds a part of a section; expected whole sections")
    return found


def initial_temperatures(model: list[Placed], known: Known) -> Array:
    """Temperature of every node at the beginning, (n,), from ``*INITIAL CONDITIONS``; 0 where none is given."""
    temperatures = np.zeros(len(known.nodes.numbering.labels))
    for item in model:
        block = item.block
        if block.keyword == "INITIAL CONDITIONS":
            block.refuse_unknown(("TYPE",))
            block.choice("TYPE", ("TEMPERATURE",), "")
            for row in block.rows():
                nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)[1]
                temperatures[nodes] = row.number(1, "the temperature")
    return temperatures


def _temperature(item: Placed, known: Known, courses: Courses, initial: Array) -> None:
    block = item.block
    block.refuse_unknown(("OP", "AMPLITUDE"))
    amplitude = find_amplitude(block, known.amplitudes)
    for row in block.rows():
        nodes = known.nodes.find(row.text(0, "a node or a node set"), item.scope, row)[1]
        value = row.number(1, "the temperature")
        if amplitude is not None and initial[nodes].any():
            raise row.error("*TEMPERATURE: an amplitude together with initial temperatures is not supported")
        for start in np.unique(initial[nodes]):
            own = nodes[initial[nodes] == start]
            courses.temperature.put(own, value - float(start), "temperature", block, amplitude, adds=False)
