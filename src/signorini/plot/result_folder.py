# SPDX-License-Identifier: BSD-3-Clause
"""Read a result folder back for drawing."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, brief
from signorini.meshio_fixes import read_meshio
from signorini.plot.curve import Curve, make_curve
from signorini.plot.patch import Patch, padded_faces
from signorini.plot.skin import Skin, make_skin
from signorini.plot.style import PLAIN, STATUS_INK
from signorini.plot.walls import Wall, read_walls
from signorini.solution.results import OPEN, SLIP, STICK

_TRACTIONS = ("traction_1", "traction_2")
_COUNTED = ("step", "node")
_OF_NODES = ("step", "contact", "node", "x", "y", "z", "gap", "pressure", *_TRACTIONS, "status")
_OF_INSTANTS = (
    *("step", "load_factor", "what", "contact", "max_pressure", OPEN, STICK, SLIP, "dissipation"),
    *(f"{what}_force_{axis}" for what in ("normal", "tangential") for axis in "xyz"),
)

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
        with _reading(file):
            found = dict(json.loads(file.read_text(encoding="utf-8")))
            names = [[contact["name"] for contact in step["contacts"]] for step in found["steps"]]
            if any(not isinstance(name, str) for each in names for name in each) or any(n != names[0] for n in names):
                raise ValueError("its steps have not the same contacts, each with a name")
            if not all(isinstance(step["name"], str) for step in found["steps"]):
                raise ValueError("its steps have no names")
            return found

    @cached_property
    def rows(self) -> list[dict[str, str]]:
        """``contact.csv``."""
        return self._table("contact.csv", _OF_NODES, words=("contact", "status"))

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
        with _reading(self._file("summary.json")):
            return read_walls(self.summary)

    @cached_property
    def instants(self) -> list[dict[str, str]]:
        """``history.csv``."""
        return self._table("history.csv", _OF_INSTANTS, words=("what", "contact", "work"))

    @property
    def archive(self) -> Path:
        """The file of the whole history, ``solution.h5``."""
        return self._file("solution.h5")

    @cached_property
    def grid(self) -> Grid:
        """``solution.vtu``."""
        file = self._file("solution.vtu")
        found = read_meshio(file)
        d = 3 if self.solid else 2
        with _reading(file):
            points, data = _numbers(found.points, (-1, 3)), found.point_data
            cells = [block.data if self.solid else block.data[:, _AROUND[block.type]] for block in found.cells]
            for block in cells:
                points[block]  # where all nodes are there
            return Grid(
                points=points[:, :d],
                displacement=_numbers(data["displacement"], (len(points), 3))[:, :d],
                von_mises=_numbers(data["von_mises"], (len(points),)),
                node=_numbers(data["node"], (len(points),)).astype(np.int64),
                families=tuple(block.type for block in found.cells),
                cells=tuple(cells),
                body=tuple(
                    _numbers(b, (len(c),)).astype(np.int64) for b, c in zip(found.cell_data["body"], cells, strict=True)
                ),
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
        file = self._file("contact.vtu")
        found, last = read_meshio(file), self.summary["steps"][-1]
        with _reading(file):
            return self._patches(found, last)

    def _patches(self, found: Any, last: dict[str, Any]) -> list[Patch]:
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
        """For every step, of which there is one at least, its contacts."""
        if not self.summary["steps"]:
            raise InputError(f"the results in '{self.path}' hold no step")
        numbers = range(1, len(self.summary["steps"]) + 1)
        with _reading(self._file("summary.json")):
            return [self._curves(number, step) for number, step in zip(numbers, self.summary["steps"], strict=True)]

    def _curves(self, number: int, step: dict[str, Any]) -> list[Curve]:
        curves = []
        for contact in step["contacts"]:
            own = [row for row in self.rows if row["step"] == str(number) and row["contact"] == contact["name"]]
            if not own:
                raise ValueError(f"contact.csv has no row of '{contact['name']}' in step {number}")
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

    def instants_of(self, contact: str) -> list[dict[str, str]]:
        """Rows of ``history.csv`` of one contact.

        Raises
        ------
        InputError
            If there are none.
        """
        found = [row for row in self.instants if row["contact"] == contact]
        if not found:
            raise InputError(f"'{self._file('history.csv')}' has no row of '{contact}'")
        return found

    def _table(self, name: str, columns: Sequence[str], words: Collection[str]) -> list[dict[str, str]]:
        """Rows of a file by column: numbers, but for columns of words; a status that is known."""
        path = self._file(name)
        with _reading(path), path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
            for number, row in enumerate(rows, start=2):
                for column in columns:
                    if not isinstance(row.get(column), str) or not (column in words or _is_number(row[column], column)):
                        raise ValueError(f"line {number} has {row.get(column)!r} under {column}")
                if row.get("status", OPEN) not in STATUS_INK:
                    raise ValueError(f"line {number} has the status '{row['status']}'")
            return rows

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


@contextmanager
def _reading(file: Path) -> Iterator[None]:
    """What is said of a file whose contents are not those that a run writes."""
    try:
        yield
    except InputError:
        raise
    except (ValueError, LookupError, TypeError, AttributeError, csv.Error) as error:
        raise InputError(f"'{file}' is not what a run writes: {brief(error)}") from error


def _is_number(word: str, column: str) -> bool:
    """Whether a word is a finite number; a whole one where things are counted."""
    try:
        return math.isfinite(float(word)) and (column not in _COUNTED or int(word) >= 0)
    except ValueError:
        return False


def _numbers(values: Any, shape: tuple[int, ...]) -> Array:
    """Finite numbers in a shape; -1: any length."""
    found = np.asarray(values, float)
    if found.ndim != len(shape) or any(n not in (-1, m) for n, m in zip(shape, found.shape, strict=True)):
        raise ValueError(f"an array has shape {found.shape}, not {shape}")
    if not np.isfinite(found).all():
        raise ValueError("an array holds what is no finite number")
    return found


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
