# SPDX-License-Identifier: BSD-3-Clause
"""The data of pictures, from a history in memory or from files (``result_folder``)."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.output.contact_csv import contact_rows
from signorini.output.fields import BodyFields, Fields
from signorini.output.history_csv import history_rows
from signorini.output.summary import summary
from signorini.plot.curve import Curve, surface_coordinate
from signorini.plot.patch import Patch, padded_faces
from signorini.plot.skin import Skin, make_skin
from signorini.plot.style import PLAIN, STATUS_INK
from signorini.plot.walls import Wall, read_walls
from signorini.solution.history import History, find_contact
from signorini.solution.results import SLIP
from signorini.solution.surface import contact_faces, status_codes

Row = Mapping[str, Any]

# corners of cells of the plane and the nodes between them, in the order around
_CELL_OUTLINES = {
    "triangle": [0, 1, 2],
    "quad": [0, 1, 2, 3],
    "triangle6": [0, 3, 1, 4, 2, 5],
    "quad8": [0, 4, 1, 5, 2, 6, 3, 7],
    "quad9": [0, 4, 1, 5, 2, 6, 3, 7],
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Dots:
    """Contact nodes of one status, as pictures of the mesh show them.

    Attributes
    ----------
    label, colour : in a picture
    node : (n,) numbers in the mesh
    """

    label: str
    colour: str
    node: IntArray


class PictureData(ABC):
    """The data that pictures show of a run, each part made when it is first asked for."""

    @property
    @abstractmethod
    def summary(self) -> Mapping[str, Any]:
        """Contents of ``summary.json``, with a step at least."""

    @property
    @abstractmethod
    def instants(self) -> Sequence[Row]:
        """Rows of ``history.csv``."""

    @property
    @abstractmethod
    def bodies(self) -> BodyFields:
        """All bodies after the last step."""

    @property
    @abstractmethod
    def patches(self) -> Sequence[Patch]:
        """Every contact in space after the last step."""

    @abstractmethod
    def nodes_of(self, step: int, contact: str) -> Sequence[Row]:
        """Rows of ``contact.csv``, one at least: one contact after a step, which counts from 1."""

    def checking(self, _name: str) -> AbstractContextManager[None]:
        """A block in which it may show that the contents of a file are wrong."""
        return nullcontext()

    @property
    def solid(self) -> bool:
        """Whether the model is one in space."""
        return bool(self.summary.get("kind") == "3d")

    @property
    def title(self) -> str:
        """Title of the model."""
        return str(self.summary.get("title", ""))

    @property
    def size(self) -> str:
        """Size of the model in words."""
        size = self.summary["size"]
        return f"{size['nodes']} nodes, {size['elements']} elements, {size['contact_pairs']} contact pairs"

    @property
    def last_number(self) -> int:
        """Number of the last step, from 1."""
        return len(self.summary["steps"])

    @property
    def last_step(self) -> Mapping[str, Any]:
        """The last step in the summary."""
        return dict(self.summary["steps"][self.last_number - 1])

    @cached_property
    def last_nodes(self) -> list[Row]:
        """Nodes of all contacts after the last step."""
        contacts = self.last_step["contacts"]
        with self.checking("summary.json"):
            return [row for contact in contacts for row in self.nodes_of(self.last_number, contact["name"])]

    @cached_property
    def dots(self) -> list[Dots]:
        """The contact nodes after the last step by what they do."""
        rough = {row["contact"] for row in self.last_nodes if float(row["traction_1"]) or float(row["traction_2"])}
        kinds: dict[tuple[str, str], list[int]] = {}
        for row in self.last_nodes:
            words = PLAIN if row["status"] == SLIP and row["contact"] not in rough else row["status"]
            kinds.setdefault((words, STATUS_INK[row["status"]]), []).append(int(row["node"]))
        order = list(STATUS_INK.values())
        return [
            Dots(label=f"contact node, {words}", colour=colour, node=np.array(nodes))
            for (words, colour), nodes in sorted(kinds.items(), key=lambda kind: (order.index(kind[0][1]), kind[0][0]))
        ]

    def curves(self, number: int) -> list[Curve]:
        """Every contact of a plane model after a step, which counts from 1."""
        with self.checking("summary.json"):
            step = self.summary["steps"][number - 1]
            return [self._curve(number, step["name"], contact) for contact in step["contacts"]]

    def _curve(self, number: int, step: str, contact: Mapping[str, Any]) -> Curve:
        rows = self.nodes_of(number, contact["name"])
        friction = contact.get("friction", 0.0)
        other = contact.get("adhesion") or contact.get("shear_limit")
        axis, s = surface_coordinate(column(rows, "x", "y"))
        order = np.argsort(s, kind="stable")
        return Curve(
            contact=contact["name"],
            step=step,
            axis=axis,
            s=s[order],
            pressure=column(rows, "pressure")[order, 0],
            traction=column(rows, "traction_1")[order, 0],
            status=np.array([row["status"] for row in rows])[order],
            friction=math.inf if isinstance(friction, str) or other else float(friction),
        )

    def instants_of(self, contact: str) -> list[Row]:
        """Rows of ``history.csv`` of one contact."""
        return [row for row in self.instants if row["contact"] == contact]

    @cached_property
    def walls(self) -> list[Wall]:
        """Rigid obstacles of a plane model."""
        with self.checking("summary.json"):
            return read_walls(self.summary)

    @cached_property
    def outlines(self) -> list[IntArray]:
        """Cells of the plane, of every block (m, k) the points around them."""
        with self.checking("solution.vtu"):
            pairs = zip(self.bodies.families, self.bodies.cells, strict=True)
            return [cells[:, _CELL_OUTLINES[family]] for family, cells in pairs]

    @cached_property
    def skin(self) -> Skin:
        """The skin of the bodies of a model in space."""
        bodies = self.bodies
        with self.checking("solution.vtu"):
            return make_skin(bodies.points, list(zip(bodies.families, bodies.cells, bodies.body, strict=True)))


class HistoryData(PictureData):
    """The data of pictures of a history in memory.

    Parameters
    ----------
    history : with a step at least
    fields : of its model
    """

    def __init__(self, history: History, fields: Fields) -> None:
        self._history, self._fields = history, fields
        self._last = history.last

    @cached_property
    def summary(self) -> Mapping[str, Any]:
        """Contents that ``summary.json`` would have."""
        return summary(self._history, self._history.timings)

    @cached_property
    def instants(self) -> list[Row]:
        """Rows that ``history.csv`` would have."""
        return list(history_rows(self._history))

    @cached_property
    def bodies(self) -> BodyFields:
        """All bodies after the last step."""
        return self._fields.at(self._last)

    @cached_property
    def patches(self) -> list[Patch]:
        """Every contact in space after the last step."""
        return [
            Patch(
                contact=contact.name,
                step=self._last.name,
                points=contact.points,
                faces=padded_faces(*contact_faces(self._history.model, contact)),
                pressure=contact.pressure,
                shear=contact.shear,
                status=status_codes(contact),
            ).trimmed()
            for contact in self._last.contacts
        ]

    def nodes_of(self, step: int, contact: str) -> list[Row]:
        """Rows that ``contact.csv`` would have of one contact after a step, which counts from 1."""
        found = find_contact(self._history.steps[step - 1], contact)
        return list(contact_rows(step, found, self._history.model.mesh.labels))


def column(rows: Sequence[Row], *names: str) -> Array:
    """Numbers of some columns of rows, (rows, columns)."""
    return np.array([[float(row[name]) for name in names] for row in rows])
