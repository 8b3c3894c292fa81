# SPDX-License-Identifier: BSD-3-Clause
"""The data of pictures, read from a result folder."""

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

from signorini.arrays import Array
from signorini.errors import InputError, brief
from signorini.meshio_fixes import read_meshio
from signorini.output.fields import BodyFields
from signorini.output.folder import ARCHIVE, SUMMARY, SURFACES
from signorini.plot.patch import Patch, padded_faces
from signorini.plot.picture_data import PictureData, Row
from signorini.plot.style import STATUS_INK
from signorini.solution.results import OPEN, SLIP, STICK

_TRACTIONS = ("traction_1", "traction_2")
_COUNTED = ("step", "node")
_OF_NODES = ("step", "contact", "node", "x", "y", "z", "gap", "pressure", *_TRACTIONS, "status")
_OF_INSTANTS = (
    *("step", "load_factor", "what", "contact", "max_pressure", OPEN, STICK, SLIP, "dissipation"),
    *(f"{what}_force_{axis}" for what in ("normal", "tangential") for axis in "xyz"),
)


@dataclass(frozen=True, kw_only=True)
class ResultFolder(PictureData):
    """The files that ``signorini run`` leaves, read when asked for.

    Parameters
    ----------
    path : of the folder
    """

    path: Path

    @cached_property
    def summary(self) -> dict[str, Any]:
        """``summary.json``."""
        file = self._file(SUMMARY)
        with self.checking(SUMMARY):
            found = dict(json.loads(file.read_text(encoding="utf-8")))
            names = [[contact["name"] for contact in step["contacts"]] for step in found["steps"]]
            if any(not isinstance(name, str) for each in names for name in each) or any(n != names[0] for n in names):
                raise ValueError("its steps have not the same contacts, each with a name")
            if not all(isinstance(step["name"], str) for step in found["steps"]):
                raise ValueError("its steps have no names")
            return found

    @cached_property
    def rows(self) -> list[Row]:
        """``contact.csv``."""
        return self._table("contact.csv", _OF_NODES, words=("contact", "status"))

    @cached_property
    def instants(self) -> list[Row]:
        """``history.csv``."""
        return self._table("history.csv", _OF_INSTANTS, words=("what", "contact", "work"))

    @property
    def archive(self) -> Path:
        """The file of the whole history, ``solution.h5``."""
        return self._file(ARCHIVE)

    @cached_property
    def bodies(self) -> BodyFields:
        """``solution.vtu``."""
        found = read_meshio(self._file("solution.vtu"))
        d = 3 if self.solid else 2
        with self.checking("solution.vtu"):
            points, data = _numbers(found.points, (-1, 3)), found.point_data
            cells = [block.data for block in found.cells]
            for block in cells:
                points[block]  # where all nodes are there
            body = [_numbers(b, (len(c),)) for b, c in zip(found.cell_data["body"], cells, strict=True)]
            return BodyFields(
                points=points[:, :d],
                displacement=_numbers(data["displacement"], (len(points), 3))[:, :d],
                stress=_numbers(data["stress"], (len(points), 6)),
                node=_numbers(data["node"], (len(points),)).astype(np.int64),
                families=tuple(block.type for block in found.cells),
                cells=tuple(cells),
                body=tuple(owner.astype(np.int64) for owner in body),
            )

    @cached_property
    def patches(self) -> list[Patch]:
        """``contact.vtu``: every contact in space after the last step."""
        found, last = read_meshio(self._file(SURFACES)), self.last_step
        with self.checking(SURFACES):
            data, owner = found.point_data, np.concatenate(found.cell_data["contact"])
            faces = padded_faces(*(block.data for block in found.cells))
            return [
                Patch(
                    contact=contact["name"],
                    step=last["name"],
                    points=found.points,
                    faces=faces[owner == i],
                    pressure=data["pressure"],
                    shear=data["traction"],
                    status=data["status"],
                ).trimmed()
                for i, contact in enumerate(last["contacts"])
            ]

    @property
    def last_number(self) -> int:
        """Number of the last step; an InputError if there is none."""
        if not self.summary["steps"]:
            raise InputError(f"the results in '{self.path}' hold no step")
        return super().last_number

    def nodes_of(self, step: int, contact: str) -> list[Row]:
        """Rows of ``contact.csv`` of one contact after a step, which counts from 1."""
        found = self._nodes.get((str(step), contact), [])
        if not found:
            raise ValueError(f"contact.csv has no row of '{contact}' in step {step}")
        return found

    @cached_property
    def _nodes(self) -> dict[tuple[str, str], list[Row]]:
        found: dict[tuple[str, str], list[Row]] = {}
        for row in self.rows:
            found.setdefault((row["step"], row["contact"]), []).append(row)
        return found

    def instants_of(self, contact: str) -> list[Row]:
        """Rows of ``history.csv`` of one contact; an InputError if there are none."""
        found = super().instants_of(contact)
        if not found:
            raise InputError(f"'{self._file('history.csv')}' has no row of '{contact}'")
        return found

    @contextmanager
    def checking(self, name: str) -> Iterator[None]:
        """A block in which it may show that a file's contents are not those that a run writes."""
        try:
            yield
        except InputError:
            raise
        except (ValueError, LookupError, TypeError, AttributeError, csv.Error) as error:
            raise InputError(f"'{self._file(name)}' is not what a run writes: {brief(error)}") from error

    def _table(self, name: str, columns: Sequence[str], words: Collection[str]) -> list[Row]:
        """Rows of a file by column: numbers, but for columns of words; a status that is known."""
        path = self._file(name)
        with self.checking(name), path.open(newline="", encoding="utf-8") as file:
            rows: list[Row] = list(csv.DictReader(file))
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
            why = "" if name == SUMMARY else self._why_not()
            raise InputError(f"the folder '{self.path}' has no '{name}'{why}")
        return file

    def _why_not(self) -> str:
        """Words on a run that left no results."""
        status = self.summary.get("status")
        return "" if status == "solved" else f": the run ended with '{status}': {self.summary.get('message')}"


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
