# SPDX-License-Identifier: BSD-3-Clause
"""``*DLOAD`` and ``*DSLOAD``: pressure on faces, and what acts on whole sections."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.acting import Courses, Known, VolumeLoad
from signorini.deck.inp.amplitudes import find_amplitude
from signorini.deck.inp.card import Row
from signorini.deck.inp.flatten import Placed


def read_dload(item: Placed, known: Known, courses: Courses) -> None:
    """Pressure on faces of elements, gravity, rotation and forces per volume."""
    card = item.card
    card.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        kind = row.text(1, "the kind of load, like P2").upper()
        if kind == "GRAV" and not row.fields[0]:  # as CAE writes it for the whole model
            label, elements = "", np.concatenate([section.elements for section in known.sections])
        else:
            label, elements = known.elements.find(row.text(0, "an element or an element set"), item.scope, row)
        if kind[:1] == "P" and kind[1:].isdigit():
            keys = known.edges.keys(elements, kind, row, "*DLOAD")
            value = row.number(2, "the pressure")
            name = f"{label} {kind}" if label in known.elements else "single elements"
            courses.pressure.put(keys, value, name, card.at(row), amplitude, adds=True)
            continue
        if kind == "GRAV":
            found = _gravity(row, label, elements, known)
        elif kind in ("BX", "BY", "BZ")[: known.dimension]:
            found = _force_per_volume(row, kind, label, elements, known)
        elif kind == "CENTRIF":
            found = _rotation(row, label, elements, known)
        else:
            raise row.error(f"*DLOAD: '{kind}' is not supported; expected P1, P2, ..., GRAV, CENTRIF, BX, BY or BZ")
        for load, value in found:
            slot = courses.volume_slot(load)
            if kind == "CENTRIF":
                _refuse_two_axes(load, slot, courses, row, known)
            courses.volume.put(np.array([slot]), value, load.label, card.at(row), amplitude, adds=True)


def _refuse_two_axes(load: VolumeLoad, slot: int, courses: Courses, row: Row, known: Known) -> None:
    """A body rotates about one axis; in a later step it may do so with another velocity."""
    for other, earlier in enumerate(courses.volume_loads):
        if (earlier.kind, earlier.section) != ("CENTRIF", load.section) or other in courses.volume.kept & {slot}:
            continue
        by = courses.volume.set_by(other)
        if by is not None:
            raise row.error(
                f"*DLOAD: '{known.sections[load.section].name}' rotates already by line {by.line}; expected one "
                "CENTRIF for an element, OP=NEW before another axis"
            )


def read_dsload(item: Placed, known: Known, courses: Courses) -> None:
    """Pressure on surfaces."""
    card = item.card
    card.refuse_unknown(("OP", "AMPLITUDE"), ("LOAD CASE",))
    amplitude = find_amplitude(card, known.amplitudes)
    for row in card.rows():
        kind = row.text(1, "the kind of load, P").upper()
        if kind != "P":
            raise row.error(f"*DSLOAD: '{kind}' is not supported; expected P")
        name = known.surfaces.find(row.text(0, "a surface"), item.scope, row)
        keys = known.surfaces.keys[name.upper()]
        known.surfaces.refuse_bare(name, known.edges, known.nodes, row)
        courses.pressure.put(keys, row.number(2, "the pressure"), name, card.at(row), amplitude, adds=True)


def _gravity(row: Row, label: str, elements: IntArray, known: Known) -> Iterator[tuple[VolumeLoad, float]]:
    """An acceleration and its direction."""
    acceleration = row.number(2, "the acceleration")
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
        per_volume = tuple(density * float(part / size) for part in direction[: known.dimension])
        name = f"gravity {known.sections[i].name}"
        yield VolumeLoad(kind="GRAV", place=label.upper(), section=i, label=name, direction=per_volume), acceleration


def _force_per_volume(
    row: Row, kind: str, label: str, elements: IntArray, known: Known
) -> Iterator[tuple[VolumeLoad, float]]:
    value = row.number(2, "the force per volume")
    direction = tuple(float(kind[1] == axis) for axis in "XYZ"[: known.dimension])
    for i in _whole_sections(elements, label, known, row):
        name = f"{kind} {known.sections[i].name}"
        yield VolumeLoad(kind=kind, place="", section=i, label=name, direction=direction), value


def _rotation(row: Row, label: str, elements: IntArray, known: Known) -> Iterator[tuple[VolumeLoad, float]]:
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
    centre: tuple[float, ...] = () if known.axisymmetric else (x, y, z)[: known.dimension]
    size = float(np.linalg.norm(axis))
    direction = tuple(part / size for part in axis) if known.dimension == 3 else ()
    for i in _whole_sections(elements, label, known, row):
        name = known.sections[i].name
        if known.sections[i].substance.density is None:
            raise row.error(f"*DLOAD: rotation needs *DENSITY in the material of '{name}'")
        yield (
            VolumeLoad(
                kind="CENTRIF",
                place="",
                section=i,
                label=f"rotation {name}",
                direction=direction,
                centre=centre,
            ),
            square,
        )


def _whole_sections(elements: IntArray, label: str, known: Known, row: Row) -> list[int]:
    """Indices of the sections that elements make up."""
    chosen = distinct(elements)
    found = [i for i, section in enumerate(known.sections) if np.isin(section.elements, chosen).all()]
    covered = sum(len(known.sections[i].elements) for i in found)
    if covered < len(chosen):
        raise row.error(f"*DLOAD: '{label}' holds a part of a section; expected whole sections")
    return found
