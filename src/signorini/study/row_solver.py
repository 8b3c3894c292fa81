# SPDX-License-Identifier: BSD-3-Clause
"""Rows of a study one after the other: a model is prepared once for all rows that leave its matrix as it is."""

from __future__ import annotations

import re
import time
import zlib
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from signorini.accuracy.refine import accurate
from signorini.clock import Clock
from signorini.deck import Deck
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve, solve_prepared
from signorini.errors import InputError, SolveFailed
from signorini.outcome import Outcome
from signorini.output.folder import Publisher, own_folder
from signorini.solution.history import History
from signorini.study.parameters import LOADS, Parameter
from signorini.study.problem import Study
from signorini.study.row import StudyRow, failed_row, in_a_line, row_of
from signorini.study.values import Value

_UNSAFE = re.compile(r"[^\w.=+-]+")  # letters that names of folders should not have
_LONGEST_NAME = 120  # letters of a folder: file systems allow 255


class RowSolver:
    """Solves combinations of a study, and keeps what it has prepared last.

    A row has the same numbers whichever rows came before it: what is shared is prepared with the values that the
    problem itself has of the parameters that leave the matrix as it is.

    Parameters
    ----------
    study : with its parameters
    """

    def __init__(self, study: Study) -> None:
        self._study = study
        self._fixed: Mapping[str, Value] | None = None
        self._deck: Deck | None = None
        self._prepared: Prepared | None = None
        self._alone = False

    def row(self, values: Mapping[str, Value]) -> StudyRow:
        """Solve a combination; whatever goes wrong with it is in the row.

        Raises
        ------
        KeyboardInterrupt
            Where the solve was interrupted.
        """
        cpu, wall = time.process_time(), time.perf_counter()
        try:
            history = self._history(values)
            if history.status == Outcome.INTERRUPTED:
                raise KeyboardInterrupt
            found = row_of(values, history)
            self._write(values, history, wall)
        except SolveFailed as failure:
            found = replace(failed_row(values, failure), status=str(failure.status), message=in_a_line(str(failure)))
        except Exception as error:  # of whatever kind: other rows may be solved all the same
            found = failed_row(values, error)
        return replace(found, cpu_seconds=time.process_time() - cpu, wall_seconds=time.perf_counter() - wall)

    def _history(self, values: Mapping[str, Value]) -> History:
        study = self._study
        fixed = {p.key: values[p.key] for p in study.parameters if not p.shares}
        if fixed != self._fixed:
            self._fixed, self._deck, self._prepared, self._alone = None, None, None, False
            self._deck = study.changed(fixed)
            self._fixed = fixed
        shared = [parameter for parameter in study.parameters if parameter.shares]
        assert self._deck is not None
        if not shared or self._alone or self._deck.accuracy is not None:
            return self._anew(values)
        if self._prepared is None:
            try:
                deck = self._deck
                self._prepared = prepare(deck.model, backend=study.backend, settings=deck.settings).keeping()
            except InputError:  # with the values of the problem itself, which this row may mend
                self._alone = True
                return self._anew(values)
        return solve_prepared(_under(self._prepared, shared, values), raise_on_failure=False)

    def _anew(self, values: Mapping[str, Value]) -> History:
        deck = self._study.changed(values)
        follow = partial(solve, backend=self._study.backend, settings=deck.settings, raise_on_failure=False)
        return follow(deck.model) if deck.accuracy is None else accurate(deck.model, deck.accuracy, follow)

    def _write(self, values: Mapping[str, Value], history: History, started: float) -> None:
        """The result folder of a row, where these are asked for."""
        if self._study.results is None:
            return
        deck = self._study.base
        clock = Clock()
        clock.seconds |= history.timings
        with own_folder(self._study.results / folder_name(values), deck.path.name) as folder:
            publisher = Publisher(folder=folder, clock=clock, started=started, deck=deck.path.name, prints=deck.prints)
            publisher.publish(history)


def folder_name(values: Mapping[str, Value]) -> str:
    """Name of the result folder of a combination.

    >>> folder_name({"friction.a b": 0.1, "mesh.nx": 8})
    'friction.a_b=0.1,mesh.nx=8'
    """
    parts = [f"{key}={value}" for key, value in values.items()]
    name, words = ",".join(_UNSAFE.sub("_", part) for part in parts), repr(parts)
    return name if len(name) <= _LONGEST_NAME else f"{name[:_LONGEST_NAME]}_{zlib.crc32(words.encode()):08x}"


def result_folder(study: Study, values: Mapping[str, Value]) -> Path | None:
    """Where the results of a combination are; None where none are asked for.

    Parameters
    ----------
    study, values : the combination
    """
    return None if study.results is None else study.results / folder_name(values)


def _under(prepared: Prepared, shared: list[Parameter], values: Mapping[str, Value]) -> Prepared:
    """What was prepared with the values of parameters that leave its matrix as it is."""
    laws: dict[str, dict[str, float]] = {"friction": {}, "interference": {}, "loads": {}}
    for parameter in shared:
        kind = "loads" if parameter.kind in LOADS else parameter.kind
        laws[kind][parameter.name] = float(values[parameter.key])
    return prepared.changed(**laws)
