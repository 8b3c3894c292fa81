# SPDX-License-Identifier: BSD-3-Clause
"""One moment of a solved history: its contacts, displacements, stresses and files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.engine.moments import whole_instant
from signorini.engine.recovery import Recovery
from signorini.errors import InputError, one_of
from signorini.fem.path import PathResult, along
from signorini.fem.stress import BodyStress
from signorini.model.model import Model
from signorini.output.contact_table import contact_table
from signorini.output.fields import Fields, State
from signorini.output.result_table import ResultTable
from signorini.output.vtu import write_bodies
from signorini.plasticity.fields import PlasticFields
from signorini.short import Short
from signorini.solution.history import History, find_contact
from signorini.solution.obstacle_result import ObstacleMotion
from signorini.solution.results import ContactResult, Instant

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HistoryMoment(Short):
    """A moment of a history: the end of a step, an event, the end of an increment, or any load of an exact path.

    Attributes
    ----------
    history : solved
    number : of the step, from 1
    instant : its contacts, load factors and work
    fields : of the bodies of the model
    recovery : what displacements that were not kept are found with, made when it is first asked for
    """

    history: History
    number: int
    instant: Instant
    fields: Fields
    recovery: Callable[[], Recovery]

    def __str__(self) -> str:
        return f"step {self.number} '{self.step}' at {self.load:.6g} of it: {self.instant.what}"

    @property
    def step(self) -> str:
        """Name of the step."""
        return self.history.steps[self.number - 1].name

    @property
    def load_factor(self) -> float:
        """Step k goes from k - 1 to k."""
        return self.instant.load_factor

    @property
    def load(self) -> float:
        """Part of the step that is behind, 0 .. 1."""
        return self.load_factor - (self.number - 1)

    @property
    def contacts(self) -> tuple[ContactResult, ...]:
        """In the order of the model."""
        return self.instant.contacts

    def contact(self, name: str) -> ContactResult:
        """A contact by name.

        Raises
        ------
        InputError
            If there is none of that name; the known ones are listed.
        """
        return find_contact(self.instant, name)

    @property
    def displacement(self) -> Array:
        """(nodes, d) length; found from the forces of the contacts where it was not kept.

        Raises
        ------
        InputError
            If it does not follow from them.
        """
        assert self.state.displacement is not None
        return self.state.displacement

    @property
    def motions(self) -> Mapping[str, ObstacleMotion]:
        """Of moving obstacles and rigid bodies, by name; empty where an older archive does not say them.

        Raises
        ------
        InputError
            If the displacements do not follow from the forces of the contacts.
        """
        return self.state.motions or {}

    @cached_property
    def state(self) -> State:
        """The bodies with their displacement, as files and pictures take them."""
        step = self.history.steps[self.number - 1]
        if self.instant is step.instants[-1]:
            return step
        if self.instant.displacement is not None:
            return self.instant
        return whole_instant(self.recovery(), self.history, self.number, self.instant)

    def stress(self, body: str) -> BodyStress:
        """Stress of a body at its nodes, not averaged with other bodies.

        Raises
        ------
        InputError
            If there is no such body.
        """
        return self.fields.stresses(self.state)[body_number(self.history.model, body)]

    def plastic(self, body: str) -> PlasticFields:
        """Plastic strain and back stress of a body at the nodes of its `stress`.

        Raises
        ------
        InputError
            If there is no such body, or none that yields.
        """
        number, found = body_number(self.history.model, body), self.fields.plastic(self.state)
        if not found:
            raise InputError("no body of the model yields; there is no plastic strain")
        return found[number]

    def along(self, points: ArrayLike, *, body: str) -> PathResult:
        """Displacement and stress of a body at points (n, d), say ``np.linspace(start, end, 50)``.

        Raises
        ------
        InputError
            If there is no such body, or a point lies outside it.
        """
        state, fields = self.state, self.fields
        given, plastic = np.asarray(points, float), fields.plastic_strains(state)
        return along(*fields.on(state), self.displacement, given, body=body, factors=state.factors, plastic=plastic)

    def contact_table(self) -> ResultTable:
        """Nonmortar nodes, one row each, as that of a solution."""
        return contact_table(self.history.model, [(self.number, self.contacts)])

    def to_dataframe(self) -> pandas.DataFrame:
        """`contact_table` as a pandas table.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        return self.contact_table().to_dataframe()

    def write(self, path: str | Path) -> None:
        """Write the bodies as ``*.vtu``, or `contact_table` as ``*.csv``.

        Raises
        ------
        InputError
            For any other name.
        """
        path = Path(path)
        if path.suffix.lower() not in (".vtu", ".csv"):
            raise InputError(f"is '{path}'; expected a name that ends in .vtu, .csv", where=("path",))
        if path.suffix.lower() == ".csv":
            self.contact_table().write(path)
        else:
            write_bodies(self.fields.at(self.state, strained=True), path)


def body_number(model: Model, name: str) -> int:
    """Which body of a model has a name.

    Raises
    ------
    InputError
        If there is none of that name; the known ones are listed.
    """
    names = [body.name for body in model.bodies]
    if name not in names:
        raise InputError(one_of(name, names, "body"))
    return names.index(name)
