# SPDX-License-Identifier: BSD-3-Clause
"""``*DLOAD`` and ``*DSLOAD``: pressure on faces, and what acts on whole sections."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.amplitudes import find_amplitude
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.course import Courses, VolumeLoad
from signorini.deck.inp.known import Known
from signorini.deck.inp.materials import Section


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
    return acceleration, {"direction": tuple(float(part / size) for part in direction[: known.dimension])}


def _force_along(axis: int, row: Row, known: Known) -> tuple[float, dict[str, Any]]:
    """A force per volume along one of the axes."""
    return row.number(2, "the force per volume"), {"direction": tuple(float(i == axis) for i in range(known.dimension))}


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
    axisymmetric = known.grid.kind == "axisymmetric"
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
