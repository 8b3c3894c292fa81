# SPDX-License-Identifier: BSD-3-Clause
"""The folder of a study: ``sweep.json`` with every finished row, ``sweep.csv`` as its table; a study goes on there."""

from __future__ import annotations

import hashlib
import json
import math
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from signorini._version import __version__
from signorini.deck import Deck
from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write
from signorini.output.dataclasses_json import AnyArray, to_plain
from signorini.output.folder import SWEEP, SWEEP_TABLE
from signorini.output.result_table import Column, ResultTable
from signorini.study.problem import Study
from signorini.study.row import BROKEN, StudyRow, unit_of
from signorini.study.row_solver import result_folder
from signorini.study.values import Value

RECORD, TABLE = SWEEP, SWEEP_TABLE

_DIGEST_SIZE = 16  # bytes
_MAX_TABLE_SHARE = 0.1  # of the time: more than that rows do not wait for their table


class StudyRecord:
    """Finished rows of a study, on disk after each of them.

    Parameters
    ----------
    study : whose rows
    rows : values of all rows that are asked for, in order
    folder : of the files; None: nothing is written

    Raises
    ------
    InputError
        If the folder holds the rows of another study.
    """

    def __init__(self, study: Study, rows: Sequence[Mapping[str, Value]], folder: Path | None) -> None:
        self._study, self._folder = study, folder
        self._asked = {_key(row): dict(row) for row in rows}
        self._digest = "" if folder is None else _digest(study)
        self._found: dict[str, StudyRow] = {}
        self._lines: dict[str, str] = {}  # of finished rows, in JSON: each is made once
        self._begun, self._spent = time.perf_counter(), 0.0
        if folder is not None and (folder / RECORD).is_file():
            for row in self._before(folder / RECORD):
                self._add(row)

    @property
    def left(self) -> dict[int, dict[str, Value]]:
        """Rows that are not finished, by number."""
        return {number: row for number, (key, row) in enumerate(self._asked.items()) if not self._kept(key, row)}

    @property
    def rows(self) -> tuple[StudyRow, ...]:
        """Finished rows that were asked for, in their order."""
        return tuple(self._found[key] for key in self._asked if key in self._found)

    def take(self, row: StudyRow) -> None:
        """Add a finished row and write the record; the table where that has taken at most a tenth of the time."""
        self._add(row)
        if self._folder is None:
            return
        self._write_record(self._folder)
        begin = time.perf_counter()
        if self._spent <= _MAX_TABLE_SHARE * (begin - self._begun):
            self._write_table(self._folder)
            self._spent += time.perf_counter() - begin

    def finish(self) -> None:
        """Write both files, of all that is finished."""
        if self._folder is not None:
            self._write_table(self._folder)
            self._write_record(self._folder)

    @property
    def text(self) -> str:
        """All that is known, as JSON."""
        base = self._study.base
        outputs = dict.fromkeys(name for row in self._found.values() for name in row.outputs)
        head = {
            "signorini": __version__,
            "deck": base.path.name,
            "title": base.model.title,
            "digest": self._digest,
            "parameters": {parameter.key: list(parameter.values) for parameter in self._study.parameters},
            "units": {name: unit_of(name, base.model.units) for name in outputs},
        }
        lines = [[self._lines[key] for key in self._asked if key in self._lines]]
        lines += [[line for key, line in self._lines.items() if key not in self._asked]]
        rows, further = (",\n".join(own) for own in lines)
        words = json.dumps(head, ensure_ascii=False).removesuffix("}")
        return f'{words},\n"rows": [\n{rows}\n],\n"further_rows": [\n{further}\n]}}\n'

    def _add(self, row: StudyRow) -> None:
        key = _key(row.values)
        self._found[key], self._lines[key] = row, json.dumps(_plain(row), ensure_ascii=False)

    def _write_record(self, folder: Path) -> None:
        with atomic_write(folder / RECORD) as aside:
            aside.write_text(self.text, encoding="utf-8")

    def _write_table(self, folder: Path) -> None:
        table_of(self.rows).write(folder / TABLE)

    def _kept(self, key: str, values: Mapping[str, Value]) -> bool:
        """Whether a row need not be solved: it was, and its results are there if they are asked for."""
        row = self._found.get(key)
        folder = result_folder(self._study, values)
        there = folder is None or (folder / "summary.json").is_file()
        return row is not None and row.status != BROKEN and (there or not row.solved)

    def _before(self, path: Path) -> list[StudyRow]:
        """Rows of an earlier study in the folder."""
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
            digest, deck = str(data["digest"]), str(data["deck"])
            keys = list(data["parameters"])
            rows = [_row(row) for row in (*data["rows"], *data["further_rows"])]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(f"'{path}' is no sweep that can be read; expected a folder of its own (-o)") from error
        mine = [parameter.key for parameter in self._study.parameters]
        why = ""
        if deck != self._study.base.path.name:
            why = f"of another deck, '{deck}'"
        elif sorted(keys) != sorted(mine):
            why = f"over {', '.join(keys)}"
        elif digest != self._digest:
            why = "of this deck as it was before, with other settings or by another version"
        if why:
            raise InputError(f"the folder '{path.parent}' holds a sweep {why}; expected a folder of its own (-o)")
        return rows


def table_of(rows: Sequence[StudyRow]) -> ResultTable:
    """Rows as columns: values by key, status, certificate, outputs, seconds, message.

    Parameters
    ----------
    rows : finished ones
    """
    keys = dict.fromkeys(key for row in rows for key in row.values)
    columns: dict[str, Column] = {key: np.array([row.values[key] for row in rows]) for key in keys}
    columns["status"] = np.array([row.status for row in rows], np.str_)
    columns["certified"] = np.array([row.certified for row in rows], bool)
    for name in dict.fromkeys(name for row in rows for name in row.outputs):
        found = [row.outputs.get(name, math.nan) for row in rows]
        columns[name] = np.array(found)
    for name in ("cpu_seconds", "wall_seconds"):
        columns[name] = np.array([getattr(row, name) for row in rows], float)
    columns["message"] = np.array([row.message for row in rows], np.str_)
    return ResultTable(columns)


def _plain(row: StudyRow) -> dict[str, Any]:
    plain = {name: getattr(row, name) for name in row.__dataclass_fields__}
    # lives without end: JSON has no infinity
    endless = {name: value if math.isfinite(value) else str(value) for name, value in row.outputs.items()}
    return plain | {"outputs": endless}


def _row(plain: Mapping[str, Any]) -> StudyRow:
    """The row that `_plain` was given."""
    return StudyRow(**{**plain, "outputs": {name: _number(value) for name, value in plain["outputs"].items()}})


def _number(value: Any) -> float:
    return float(value) if isinstance(value, str) else value


def _key(values: Mapping[str, Value]) -> str:
    """What a row is a row of, in letters."""
    return json.dumps([[key, values[key]] for key in sorted(values)])


def _digest(study: Study) -> str:
    """Letters that two studies share only if all is the same that their rows follow from but the values.

    Raises
    ------
    InputError
        If the model holds a function, of which nobody can tell whether it is the same.
    """
    base: Deck = study.base

    def keep(_: str, array: AnyArray, key: str) -> str:
        del array
        return key

    parts = {
        "version": __version__,
        "model": to_plain(base.model, "model", keep),
        "accuracy": to_plain(base.accuracy, "accuracy", keep),
        "settings": repr(base.settings),
        "backend": study.backend,
    }
    return hashlib.blake2b(json.dumps(parts).encode(), digest_size=_DIGEST_SIZE).hexdigest()
