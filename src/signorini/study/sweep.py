# SPDX-License-Identifier: BSD-3-Clause
"""The Python door to parameter studies, and the way of all of them: rows that are left, solved here or elsewhere."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from signorini.checks import whole
from signorini.clock import Listener
from signorini.cores import number_of_threads, physical_cores
from signorini.errors import InputError
from signorini.model.model import Model
from signorini.output.folder import own_folder
from signorini.output.result_table import ResultTable
from signorini.short import Short
from signorini.study.lanes import HereLane, Lanes, ProcessLanes
from signorini.study.picture import draw_sweep
from signorini.study.problem import DeckFile, GivenModel, Study
from signorini.study.record import StudyRecord, table_of
from signorini.study.row import StudyRow
from signorini.study.schedule import Queue, solved_rows
from signorini.study.values import Value, combinations

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

_LEFT_SECONDS = 20.0
"""Seconds of rows that are left from which several processes pay, which have to begin and to prepare their own."""
_FIRST_ROWS = 2  # rows that tell how long one takes: the first has prepared the model

RESULTS = "results"
"""Folder of the result folders, in that of a study."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Sweep(Short):
    """A parameter study: a row for each combination of values, see :func:`sweep`.

    Attributes
    ----------
    rows : in the order of the values, the last parameter changes first; see `StudyRow`
    title, units : of the problem
    """

    rows: tuple[StudyRow, ...]
    title: str
    units: str

    @property
    def solved(self) -> bool:
        """Whether every row has a certified solution."""
        return all(row.solved for row in self.rows)

    @property
    def table(self) -> ResultTable:
        """Rows as columns: values by key, status, certificate, outputs, seconds, message."""
        return table_of(self.rows)

    def to_dataframe(self) -> pandas.DataFrame:
        """The rows as a pandas table.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        return self.table.to_dataframe()

    def plot(self) -> Figure:
        """Draw pressures, friction, slips and dissipation over the parameter with the most values.

        Raises
        ------
        InputError
            If no parameter has two numbers for which there are answers.
        """
        return draw_sweep(self.rows, self.title, self.units)


def sweep(
    problem: Model | str | Path,
    parameters: Mapping[str, Sequence[Value]],
    *,
    processes: int = 1,
    folder: str | Path | None = None,
    results: bool = False,
    backend: str = "auto",
) -> Sweep:
    """Solve a problem with all combinations of values of some parameters.

    Parameters
    ----------
    problem : a model, or the path of a deck
    parameters : key to values: ``"friction.CONTACT"``, ``"interference.CONTACT"``, ``"load.NAME"`` and
        ``"support.NAME"`` (factors), ``"E.BODY"`` and others that sensitivities know; of a TOML deck every key, as
        ``"mesh.nx"``. One preparation serves all values of friction, interferences, loads and moving supports
    processes : that share the rows. More than one need a script whose work is below ``if __name__ == "__main__":``
    folder : for ``sweep.json`` and ``sweep.csv``, written after every row; a study goes on from what is there
    results : whether every row gets a result folder there
    backend : of the factorisation

    Raises
    ------
    InputError
        For a wrong key or a value that is refused; what is wrong with a combination is in its row.

    Examples
    --------
    >>> from signorini.gallery.cylinder import zhu_cylinder
    >>> found = sweep(zhu_cylinder(), {"friction.foundation": [0.0, 0.4], "load.cut": [0.5, 1.0]})
    >>> found.table["foundation.normal_force_y"].round(6).tolist(), found.rows[0].status
    ([39.0, 78.0, 39.0, 78.0], 'solved')
    """
    source = GivenModel(problem) if isinstance(problem, Model) else DeckFile(path=Path(problem))
    values = {key: tuple(_plain(value) for value in own) for key, own in parameters.items()}
    place = None if folder is None else Path(folder)
    if results and place is None:
        raise InputError("are asked for without a folder; expected folder = ...", where=("results",))
    study = Study.of(source, values, backend, place / RESULTS if results and place is not None else None)
    return Sweeping(study, place).finished(whole(processes, ("processes",)))


class Sweeping:
    """A study that is being solved.

    Parameters
    ----------
    study : with its parameters
    folder : of its record; None: there is none
    """

    def __init__(self, study: Study, folder: Path | None) -> None:
        self._study, self._folder = study, folder
        self._rows = combinations({parameter.key: parameter.values for parameter in study.parameters})
        self.record = StudyRecord(study, self._rows, None)

    @property
    def count(self) -> int:
        """Rows that are asked for."""
        return len(self._rows)

    def finished(self, processes: int | None = 1, tell: Listener | None = None, lanes: Lanes | None = None) -> Sweep:
        """Solve what is left.

        Parameters
        ----------
        processes : that share the rows; None: as many as there are cores for, once it is known that it takes long
        tell : whom to tell how many rows are finished
        lanes : who solves, in place of processes

        Raises
        ------
        InputError
            If the folder cannot be written to, is used by another run, or holds another study.
        """
        base = self._study.base
        with ExitStack() as stack:
            if self._folder is not None:
                stack.enter_context(own_folder(self._folder, base.path.name))
                self.record = StudyRecord(self._study, self._rows, self._folder)
            queue = Queue(self.record.left, self._study.parameters)
            found = self._solved(queue, processes) if lanes is None else _closing(queue, lanes)
            done = self.count - len(queue)
            stack.callback(self.record.finish)
            for _, row in found:
                self.record.take(row)
                done += 1
                if tell is not None:
                    words = ", ".join(f"{key} = {value}" for key, value in row.values.items())
                    tell(f"{done} of {self.count} rows, {words}", done / self.count)
        return Sweep(rows=self.record.rows, title=base.model.title, units=base.model.units)

    def _solved(self, queue: Queue, processes: int | None) -> Iterator[tuple[int, StudyRow]]:
        """Rows here, or in processes: where nobody says how many, once it shows that it takes long."""
        if processes in (1, None):
            for k, (number, row) in enumerate(_closing(queue, HereLane(self._study)), start=1):
                yield number, row
                several = processes is None and physical_cores() > 1 and len(queue) > 1
                if several and k >= _FIRST_ROWS and row.wall_seconds * len(queue) > _LEFT_SECONDS:
                    break
        if len(queue):
            count = min(processes or physical_cores(), len(queue))
            yield from _closing(queue, ProcessLanes(self._study, count, max(1, number_of_threads() // count)))


def processes_beside(threads: int | None) -> int | None:
    """Processes that fit beside each other where each takes so many threads; None where nobody says how many.

    >>> processes_beside(None), processes_beside(10_000)
    (None, 1)
    """
    return None if threads is None else max(1, physical_cores() // threads)


def _closing(queue: Queue, lanes: Lanes) -> Iterator[tuple[int, StudyRow]]:
    """Rows from lanes that are closed behind the last, or whatever happens before it."""
    try:
        yield from solved_rows(queue, lanes)
    finally:
        lanes.close()


def _plain(value: Value) -> Value:
    """A number of Python's own in place of one of NumPy."""
    return value.item() if hasattr(value, "item") else value
