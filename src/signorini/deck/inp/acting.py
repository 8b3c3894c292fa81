# SPDX-License-Identifier: BSD-3-Clause
"""What loads and supports refer to, and what of them acts: a course for every kind of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from signorini.arrays import Array
from signorini.deck.inp.amplitudes import Amplitude
from signorini.deck.inp.course import Course
from signorini.deck.inp.links import DeckRigid
from signorini.deck.inp.materials import Section
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.surfaces import ElementFaces, Surfaces

_SAME = 1e-9  # of an axis or a direction: vectors that differ by less are one, as written with ten digits


@dataclass(frozen=True, kw_only=True, eq=False)
class Known:
    """What keywords of loads refer to."""

    nodes: Sets
    elements: Sets
    surfaces: Surfaces
    edges: ElementFaces
    sections: tuple[Section, ...]
    amplitudes: Mapping[str, Amplitude]
    axisymmetric: bool
    dimension: int
    rigid: tuple[DeckRigid, ...]


@dataclass(frozen=True, kw_only=True)
class VolumeLoad:
    """What acts on the whole of a section when its value is 1.

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
        return _largest(mine - its) <= _SAME * _largest(mine) and _largest(apart) <= _SAME * far

    def given(self, value: float) -> dict[str, Any]:
        """The load of a value, as a model has it."""
        if self.kind != "CENTRIF":
            return {"body_force": tuple(value * part for part in self.direction)}
        line = {"centre": self.centre, "axis": self.direction}
        return {"centrifugal": math.sqrt(value), **{key: part for key, part in line.items() if part}}


def _largest(parts: Array) -> float:
    return float(np.abs(parts).max(initial=0.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Courses:
    """How everything that acts on the bodies changes with the steps.

    Attributes
    ----------
    displacement : slots ``STRIDE * node + axis``, length
    force : the same slots, force
    pressure : slots are keys of edges, force per area
    volume : slots are indices of volume_loads
    temperature : slots are nodes, above the initial temperature
    volume_loads : what acts on whole sections
    notes : where Abaqus and CalculiX differ, and which of them is followed
    """

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
