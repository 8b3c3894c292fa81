# SPDX-License-Identifier: BSD-3-Clause
"""Read a result folder back for drawing."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.formats import complete_meshio
from signorini.plot.curve import Curve, make_curve
from signorini.plot.patch import Patch, padded_faces
from signorini.plot.skin import Skin, make_skin
from signorini.plot.style import PLAIN, STATUS_INK
from signorini.plot.walls import Wall, read_walls
from signorini.solution.results import SLIP

_TRACTIONS = ("traction_1", "traction_2")

# corners and nodes between them, in the order around a cell
_AROUND = {
    "triangle": [0, 1, 2],
    "quad": [0, 1, 2, 3],
    "triangle6": [0, 3, 1, 4, 2, 5],
    "quad8": [0, 4, 1, 5, 2, 6, 3, 7],
    "quad9": [0, 4, 1, 5, 2, 6, 3, 7],
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """The last state of all bodies.

    Attributes
    ----------
    points, displacement : (n, d) length
    von_mises : (n,) force per area
    node : (n,) number in the mesh
    families : of the cells
    cells : each (m, k), nodes in the order around the cells, in space in the order of meshio
    body : each (m,) which body the cells belong to
    """

    points: Array
    displacement: Array
    von_mises: Array
    node: IntArray
    families: tuple[str, ...]
    cells: tuple[IntArray, ...]
    body: tuple[IntArray, ...]

    @property
    def triangles(self) -> IntArray:
        """Cells of the plane as triangles, (m, 3)."""
        return np.vstack([cells[:, corners] for cells in self.cells for corners in _triangles(cells.shape[1])])


@dataclass(frozen=True, kw_only=True, eq=False)
class Dots:
    """Contact nodes that do the same.

    Attributes
    ----------
    label, colour : in a picture
    node : (n,) numbers in the mesh
    """

    label: str
    colour: str
    node: IntArray


@dataclass(frozen=True, kw_only=True)
class ResultFolder:
    """The files that ``signorini run`` leaves, read when asked for.

    Parameters
    ----------
    path : of the folder
    """

    path: Path

    @cached_property
    def summary(self) -> dict[str, Any]:
        """``summary.json``."""
        file = self._file("summary.json")
        try:
            return dict(json.loads(file.read_text(encoding="utf-8")))
        except ValueError as error:
            raise InputError(f"'{file}' is not a summary: {error}") from error

    @cached_property
    def rows(self) -> list[dict[str, str]]:
        """``contact.csv``."""
        with self._file("contact.csv").open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    @cached_property
    def last_rows(self) -> list[dict[str, str]]:
        """Rows of the contact nodes after the last step."""
        last = str(len(self.summary["steps"]))
        return [row for row in self.rows if row["step"] == last]

    @property
    def dots(self) -> list[Dots]:
        """The contact nodes after the last step by what they do."""
        rough = {row["contact"] for row in self.last_rows if any(float(row[name]) for name in _TRACTIONS)}
        kinds: dict[tuple[str, str], list[int]] = {}
        for row in self.last_rows:
            words = PLAIN if row["status"] == SLIP and row["contact"] not in rough else row["status"]
            kinds.setdefault((words, STATUS_INK[row["status"]]), []).append(int(row["node"]))
        order = list(STATUS_INK.values())
        return [
            Dots(label=f"contact node, {words}", colour=colour, node=np.array(nodes))
            for (words, colour), nodes in sorted(kinds.items(), key=lambda kind: (order.index(kind[0][1]), kind[0][0]))
        ]

    @cached_property
    def walls(self) -> list[Wall]:
        """Rigid obstacles of a plane model."""
        return read_walls(self.summary)

    @cached_property
    def instants(self) -> list[dict[str, str]]:
        """``history.csv``."""
        with self._file("history.csv").open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    @property
    def archive(self) -> Path:
        """The file of the whole history, ``solution.h5``."""
        return self._file("solution.h5")

    @cached_property
    def grid(self) -> Grid:
        """``solution.vtu``."""
        import meshio

        complete_meshio()
        file = self._file("solution.vtu")
        found = meshio.read(file)
        d = 3 if self.solid else 2
        cells = [block.data if self.solid else block.data[:, _AROUND[block.type]] for block in found.cells]
        return Grid(
            points=found.points[:, :d],
            displacement=found.point_data["displacement"][:, :d],
            von_mises=found.point_data["von_mises"],
            node=found.point_data["node"],
            families=tuple(block.type for block in found.cells),
            cells=tuple(cells),
            body=tuple(found.cell_data["body"]),
        )

    @cached_property
    def skin(self) -> Skin:
        """The skin of the bodies of a model in space."""
        return make_skin(self.grid.points, list(zip(self.grid.families, self.grid.cells, self.grid.body, strict=True)))

    @property
    def solid(self) -> bool:
        """Whether the model is one in space."""
        return bool(self.summary.get("kind") == "3d")

    @cached_property
    def patches(self) -> list[Patch]:
        """``contact.vtu``: every contact in space after the last step."""
        import meshio

        found, last = meshio.read(self._file("contact.vtu")), self.summary["steps"][-1]
        data, patches = found.point_data, []
        faces = padded_faces(*(block.data for block in found.cells))
        owner = np.concatenate(found.cell_data["contact"])
        for i, contact in enumerate(last["contacts"]):
            nodes, index = np.unique(faces[owner == i], return_inverse=True)
            patches.append(
                Patch(
                    contact=contact["name"],
                    step=last["name"],
                    points=found.points[nodes],
                    faces=index.reshape(-1, 4),
                    pressure=data["pressure"][nodes],
                    shear=data["traction"][nodes],
                    status=data["status"][nodes],
                )
            )
        return patches

    @property
    def title(self) -> str:
        """Of the model."""
        return str(self.summary.get("title", ""))

    @cached_property
    def steps(self) -> list[list[Curve]]:
        """For every step its contacts."""
        numbers = range(1, len(self.summary["steps"]) + 1)
        return [self._curves(number, step) for number, step in zip(numbers, self.summary["steps"], strict=True)]

    def _curves(self, number: int, step: dict[str, Any]) -> list[Curve]:
        curves = []
        for contact in step["contacts"]:
            own = [row for row in self.rows if row["step"] == str(number) and row["contact"] == contact["name"]]
            friction = contact.get("friction", 0.0)
            other = contact.get("adhesion") or contact.get("shear_limit")
            curves.append(
                make_curve(
                    contact=contact["name"],
                    step=step["name"],
                    points=_columns(own, "x", "y"),
                    pressure=_columns(own, "pressure")[:, 0],
                    traction=_columns(own, "traction_1")[:, 0],
                    status=np.array([row["status"] for row in own]),
                    friction=math.inf if isinstance(friction, str) or other else float(friction),
                )
            )
        return curves

    def _file(self, name: str) -> Path:
        file = self.path / name
        if not self.path.is_dir():
            raise InputError(f"there is no folder '{self.path}'; expected one that 'signorini run' has written")
        if not file.is_file():
            why = "" if name == "summary.json" else self._why_not()
            raise InputError(f"the folder '{self.path}' has no '{name}'{why}")
        return file

    def _why_not(self) -> str:
        """Words on a run that left no results."""
        status = self.summary.get("status")
        return "" if status == "solved" else f": the run ended with '{status}': {self.summary.get('message')}"


def _columns(rows: list[dict[str, str]], *names: str) -> Array:
    return np.array([[float(row[name]) for name in names] for row in rows])


def _triangles(around: int) -> list[list[int]]:
    """Triangles of a cell by the number of nodes around it."""
    return {
        3: [[0, 1, 2]],
        4: [[0, 1, 2], [0, 2, 3]],
        6: [[0, 1, 5], [1, 2, 3], [3, 4, 5], [1, 3, 5]],
        8: [[0, 1, 7], [1, 2, 3], [3, 4, 5], [5, 6, 7], [1, 3, 7], [3, 5, 7]],
    }[around]
