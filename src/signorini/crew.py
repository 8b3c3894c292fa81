# SPDX-License-Identifier: BSD-3-Clause
"""Threads that run compiled loops side by side, of which whoever calls waits for all."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from threading import Condition
from types import TracebackType
from typing import NamedTuple, Self, TypeVar

T = TypeVar("T")


class Job(NamedTuple):
    """What one thread does once others are done.

    Attributes
    ----------
    call : does it
    needs : numbers of the jobs that have to be done before, all of them smaller
    """

    call: Callable[[], None]
    needs: tuple[int, ...] = ()


class Crew:
    """A number of threads; with one, whoever calls works itself.

    >>> said = []
    >>> with Crew(2) as crew:
    ...     crew.finish([Job(lambda: said.append("first")), Job(lambda: said.append("then"), needs=(0,))])
    ...     crew.each([lambda: 1, lambda: 2]), said
    ([1, 2], ['first', 'then'])

    Parameters
    ----------
    threads : that work at a time
    """

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self._pool = ThreadPoolExecutor(threads) if threads > 1 else None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    def each(self, calls: Sequence[Callable[[], T]]) -> list[T]:
        """What calls give that need nothing of each other."""
        if self._pool is None:
            return [call() for call in calls]
        return [future.result() for future in [self._pool.submit(call) for call in calls]]

    def finish(self, jobs: Sequence[Job]) -> None:
        """Do jobs, of those that can be done always the first; raise what the first one raises that fails."""
        if self._pool is None:
            for job in jobs:
                job.call()
            return
        jobs_left = _Jobs(jobs)
        workers = [self._pool.submit(jobs_left.work) for _ in range(self.threads)]
        try:
            for worker in workers:
                worker.result()
        finally:
            jobs_left.stop()
        if jobs_left.error is not None:
            raise jobs_left.error


class _Jobs:
    """Jobs of which several threads take the first that can be done."""

    def __init__(self, jobs: Sequence[Job]) -> None:
        self.error: Exception | None = None
        self._jobs = jobs
        self._end = len(jobs)  # jobs from here on are not done: one failed that comes before them
        self._missing = [len(job.needs) for job in jobs]
        self._next: list[list[int]] = [[] for _ in jobs]
        for number, job in enumerate(jobs):
            for needed in job.needs:
                self._next[needed].append(number)
        self._ready = [number for number, missing in enumerate(self._missing) if not missing]
        self._running = 0
        self._changed = Condition()

    def stop(self) -> None:
        """Begin no other job."""
        with self._changed:
            self._end = 0
            self._changed.notify_all()

    def work(self) -> None:
        """Do jobs until none is left."""
        while (number := self._take()) is not None:
            error = None
            try:
                self._jobs[number].call()
            except Exception as found:  # whoever waits is told
                error = found
            self._done(number, error)

    def _take(self) -> int | None:
        """The first job that can be done, as soon as there is one; None where none will be."""
        with self._changed:
            while True:
                if self._ready and self._ready[0] < self._end:
                    self._running += 1
                    return heapq.heappop(self._ready)
                if not self._running:
                    return None
                self._changed.wait()

    def _done(self, number: int, error: Exception | None) -> None:
        with self._changed:
            self._running -= 1
            if error is not None and number < self._end:
                self._end, self.error = number, error
            if error is None:
                for follower in self._next[number]:
                    self._missing[follower] -= 1
                    if not self._missing[follower]:
                        heapq.heappush(self._ready, follower)
            self._changed.notify_all()
