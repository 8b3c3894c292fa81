# SPDX-License-Identifier: BSD-3-Clause
"""The results of a history that pictures show."""

from __future__ import annotations

from functools import cached_property
from typing import Protocol

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.output.fatigue_csv import fatigue_fields
from signorini.output.fields import BodyFields, Fields, State
from signorini.plot.components import Scalar, displacement_component, stress_component
from signorini.plot.curve import Curve, curve_of
from signorini.plot.look import Look
from signorini.plot.patch import Patch, patch_of
from signorini.plot.skin import Skin, make_skin
from signorini.plot.style import STATUS_INK, status_words
from signorini.plot.units import Units, units_of
from signorini.plot.walls import Wall, walls_of
from signorini.solution.history import History
from signorini.solution.results import ContactResult

CELL_OUTLINES = {
    "triangle": [0, 1, 2],
    "quad": [0, 1, 2, 3],
    "triangle6": [0, 3, 1, 4, 2, 5],
    "quad8": [0, 4, 1, 5, 2, 6, 3, 7],
    "quad9": [0, 4, 1, 5, 2, 6, 3, 7],
}
"""Corners of cells of the plane and the nodes between them, in the order around."""

_PLAIN = Look()
_FLOWED = 0.05  # of the largest equivalent plastic strain: pictures look at what has flowed more


class Shown(Protocol):
    """What pictures ask of a moment of a history, see `signorini.moment.HistoryMoment`."""

    @property
    def contacts(self) -> tuple[ContactResult, ...]:
        """In the order of the model."""

    @property
    def state(self) -> State:
        """The bodies with their displacement."""


class PictureData:
    """What pictures show of a history at one of its moments, each part made when it is first asked for.

    Parameters
    ----------
    history : with a step at least
    fields : of its model, where there are any already
    moment : that is shown; the end of the last step if there is none
    when : the moment in words
    look : what the reader asks for
    """

    def __init__(
        self,
        history: History,
        fields: Fields | None = None,
        *,
        moment: Shown | None = None,
        when: str = "",
        look: Look = _PLAIN,
    ) -> None:
        self.history, self.model, self.look = history, history.model, look
        self._fields, self._moment, self._when = fields or Fields(history.model), moment, when

    @property
    def when(self) -> str:
        """The moment in words."""
        return self._when or f"end of step '{self.history.last.name}'"

    @property
    def contacts(self) -> tuple[ContactResult, ...]:
        """At the moment, in the order of the model."""
        return self.history.last.contacts if self._moment is None else self._moment.contacts

    @property
    def state(self) -> State:
        """The bodies at the moment."""
        return self.history.last if self._moment is None else self._moment.state

    @cached_property
    def units(self) -> Units:
        """Words for axes."""
        return units_of(self.model.units)

    @property
    def solid(self) -> bool:
        """Whether the model is one in space."""
        return self.model.dimension == 3

    @property
    def size(self) -> str:
        """Size of the model in words."""
        mesh = self.model.mesh
        return f"{len(mesh.points)} nodes, {mesh.number_of_cells} elements, {self.history.pairs} contact pairs"

    @cached_property
    def bodies(self) -> BodyFields:
        """All bodies."""
        return self._fields.at(self.state)

    @property
    def stress(self) -> Scalar:
        """The stress of the bodies that is asked for, otherwise von Mises'."""
        return stress_component(self.bodies, self.model.kind, self.look.component)

    @property
    def displacement(self) -> Scalar:
        """The displacement of the bodies that is asked for, otherwise its magnitude."""
        return displacement_component(self.bodies, self.model.axes, self.look.component)

    @property
    def peeq(self) -> Scalar:
        """Equivalent plastic strain of the bodies.

        Raises
        ------
        InputError
            If no body yields.
        """
        if self.bodies.plastic is None:
            raise InputError("has no body that yields; expected another picture", where=("peeq",))
        return Scalar(self.bodies.plastic.equivalent, "equivalent plastic strain{}")

    @cached_property
    def fatigue(self) -> list[Array]:
        """Parameters of every fatigue criterion at the points of the bodies, NaN where it was not asked for.

        Raises
        ------
        InputError
            If none was.
        """
        results = self.history.fatigue_results
        if not results:
            raise InputError(
                "was not asked for; expected [[fatigue]] in the deck, or another picture", where=("fatigue",)
            )
        fields = fatigue_fields(results, self._fields.stresses(self.history.last))
        return [values for name, values in fields.items() if not name.endswith("_life")]

    @property
    def yielded(self) -> BoolArray:
        """(points,) Which points of the bodies have flowed, by a twentieth of the most that any has."""
        plastic = self.bodies.plastic
        if plastic is None or not plastic.equivalent.any():
            return np.zeros(len(self.bodies.points), bool)
        found: BoolArray = plastic.equivalent > _FLOWED * plastic.equivalent.max()
        return found

    def points_of(self, contact: ContactResult, chosen: BoolArray) -> BoolArray:
        """(points,) Which points of the bodies have one of the chosen pairs (n,) of a contact, and an area."""
        return np.isin(self.bodies.node, self.model.mesh.labels[contact.node[chosen & (contact.area > 0)]])

    @cached_property
    def closed(self) -> BoolArray:
        """(points,) Which points of the bodies touch."""
        found = np.zeros(len(self.bodies.points), bool)
        for contact in self.contacts:
            found |= self.points_of(contact, contact.closed)
        return found

    @cached_property
    def dots(self) -> dict[str, IntArray]:
        """Points of the bodies with pairs, by what these do in words."""
        found: dict[str, IntArray] = {}
        for words in STATUS_INK:
            own = [self.points_of(contact, status_words(contact) == words) for contact in self.contacts]
            if np.any(own):
                found[words] = np.flatnonzero(np.any(own, axis=0))
        return found

    def curves(self, number: int | None = None) -> list[Curve]:
        """Every contact of a plane model after a step, which counts from 1; at the moment where there is no number."""
        contacts = self.contacts if number is None else self.history.steps[number - 1].contacts
        pairs = zip(self.model.contacts, contacts, self._touching, strict=True)
        return [curve_of(law, contact, touching, self.model.axes) for law, contact, touching in pairs]

    @cached_property
    def _touching(self) -> list[BoolArray]:
        """Of every contact (n,), which pairs touch at the end of any step."""
        ends = [step.contacts for step in self.history.steps]
        return [np.any([contact.closed for contact in every], axis=0) for every in zip(*ends, strict=True)]

    @cached_property
    def patches(self) -> list[Patch]:
        """Every contact in space."""
        return [patch_of(self.model, contact) for contact in self.contacts]

    @cached_property
    def walls(self) -> list[Wall]:
        """Rigid obstacles of a plane model."""
        return walls_of(self.model, self.state)

    @cached_property
    def outlines(self) -> list[IntArray]:
        """Cells of the plane, of every block (m, k) the points around them."""
        pairs = zip(self.bodies.families, self.bodies.cells, strict=True)
        return [cells[:, CELL_OUTLINES[family]] for family, cells in pairs]

    @cached_property
    def skin(self) -> Skin:
        """The skin of the bodies of a model in space."""
        bodies = self.bodies
        return make_skin(bodies.points, list(zip(bodies.families, bodies.cells, bodies.body, strict=True)))
