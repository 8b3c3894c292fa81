# SPDX-License-Identifier: BSD-3-Clause
"""Who solves rows: this process, several of this machine, or the ranks of MPI; each keeps what it has prepared."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, Protocol

from signorini.blas_threads import one_thread
from signorini.cores import threads
from signorini.errors import SignoriniError
from signorini.study.problem import Study
from signorini.study.row import StudyRow
from signorini.study.row_solver import RowSolver
from signorini.study.values import Value

_PERIOD = 0.01  # seconds between looks for messages of other ranks: waiting for them takes all of a processor


class Lanes(Protocol):
    """Places side by side, at each of which one row is solved at a time."""

    count: int

    def begin(self, lane: int, number: int, values: Mapping[str, Value]) -> None:
        """Begin a row at a free lane.

        Parameters
        ----------
        lane, number : of the lane and of the row
        values : of the row
        """
        ...

    def finished(self) -> tuple[int, int, StudyRow]:
        """Lane and number of the next row that is finished, and the row."""
        ...

    def close(self) -> None:
        """End what is still being solved."""
        ...


class HereLane:
    """This process, one row after the other.

    Parameters
    ----------
    study : whose rows
    """

    count = 1

    def __init__(self, study: Study) -> None:
        self._solver = RowSolver(study)
        self._next: tuple[int, Mapping[str, Value]] | None = None

    def begin(self, lane: int, number: int, values: Mapping[str, Value]) -> None:
        """Remember the row, see `Lanes`; ``lane`` is 0, ``number`` and ``values`` are the row's."""
        del lane
        self._next = number, values

    def finished(self) -> tuple[int, int, StudyRow]:
        """Solve the row."""
        assert self._next is not None
        number, values = self._next
        with one_thread():
            return 0, number, self._solver.row(values)

    def close(self) -> None:
        """Nothing is being solved."""


class ProcessLanes:
    """Processes of this machine; they end with this one, however it ends.

    Parameters
    ----------
    study : whose rows
    count : of processes
    each : threads that each of them may use
    """

    def __init__(self, study: Study, count: int, each: int) -> None:
        self.count = count
        # one process each: a row goes to the process that has prepared the model for it
        spawn = get_context("spawn")
        ears, self._line = spawn.Pipe(duplex=False)
        self._pools = [
            ProcessPoolExecutor(1, mp_context=spawn, initializer=_begin, initargs=(study, each, ears))
            for _ in range(count)
        ]
        self._running: dict[Future[StudyRow], tuple[int, int]] = {}

    def begin(self, lane: int, number: int, values: Mapping[str, Value]) -> None:
        """Send a row to a process: ``lane``, ``number`` and ``values`` as of `Lanes`."""
        self._running[self._pools[lane].submit(_row, dict(values))] = lane, number

    def finished(self) -> tuple[int, int, StudyRow]:
        """Wait for a row.

        Raises
        ------
        SignoriniError
            If a process was ended from outside.
        """
        future = next(iter(wait(self._running, return_when=FIRST_COMPLETED).done))
        lane, number = self._running.pop(future)
        try:
            return lane, number, future.result()
        except BrokenProcessPool as error:
            words = "a process that solved rows has ended, killed or out of memory; expected fewer (--processes)"
            raise SignoriniError(words) from error

    def ready(self) -> bool:
        """Whether a row is finished."""
        return any(future.done() for future in self._running)

    def close(self) -> None:
        """Stop the processes, also in the middle of rows."""
        self._line.close()
        for pool in self._pools:
            pool.shutdown(cancel_futures=True)


class _Served:
    """What a process keeps that solves rows for another one.

    Attributes
    ----------
    solver : of rows
    each : threads that it may use
    """

    solver: RowSolver
    each: int


def _begin(study: Study, each: int, ears: Connection) -> None:
    """Begin a process: the one that hands out rows decides when it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with, args=(ears,), daemon=True).start()
    _Served.solver, _Served.each = RowSolver(study), each


def _end_with(ears: Connection) -> None:
    """End the process at once when nobody is left at the other end of a line."""
    with suppress(EOFError, OSError):
        ears.recv()
    os._exit(1)


def _row(values: dict[str, Value]) -> StudyRow:
    with threads(_Served.each), one_thread():
        return _Served.solver.row(values)


class RankLanes:
    """Ranks of MPI; the first, which hands out rows and writes, has a process beside it, and the others call `serve`.

    Parameters
    ----------
    comm : communicator of all ranks, at least two
    study : whose rows
    """

    def __init__(self, comm: Any, study: Study) -> None:
        self._comm = comm
        self.count = int(comm.size)
        self._beside = ProcessLanes(study, 1, 1)  # if the first rank solved a row, others would wait until it is done
        self._busy: set[int] = set()

    def begin(self, lane: int, number: int, values: Mapping[str, Value]) -> None:
        """Send a row to a rank, or the process: ``lane``, ``number`` and ``values`` as of `Lanes`."""
        if lane == 0:
            self._beside.begin(lane, number, values)
            return
        self._comm.send((number, dict(values)), dest=lane)
        self._busy.add(lane)

    def finished(self) -> tuple[int, int, StudyRow]:
        """Wait for a row.

        Raises
        ------
        SignoriniError
            If the process was ended from outside.
        """
        while not self._beside.ready():
            for lane in sorted(self._busy):
                if self._comm.iprobe(source=lane):
                    number, row = self._comm.recv(source=lane)
                    self._busy.discard(lane)
                    return lane, number, row
            time.sleep(_PERIOD)
        return self._beside.finished()

    def close(self) -> None:
        """Let the ranks go; where some are at work, end all."""
        if self._busy:
            self._comm.Abort(1)
        self._beside.close()
        for lane in range(1, self.count):
            self._comm.send(None, dest=lane)


def serve(comm: Any, study: Study) -> None:
    """Solve what the first rank asks for, until it has no more.

    Parameters
    ----------
    comm : communicator of all ranks
    study : whose rows
    """
    solver = RowSolver(study)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # the first rank hears them too, and ends all
    with threads(1), one_thread():
        while True:
            while not comm.iprobe(source=0):
                time.sleep(_PERIOD)
            asked = comm.recv(source=0)
            if asked is None:
                return
            number, values = asked
            comm.send((number, solver.row(values)), dest=0)
