# SPDX-License-Identifier: BSD-3-Clause
"""Threads that run compiled loops side by side, of which whoever calls waits for all."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from contextvars import ContextVar, copy_context
from functools import partial
from itertools import pairwise
from threading import Condition
from types import TracebackType
from typing import NamedTuple, Self, TypeVar

from signorini.cores import number_of_threads

T = TypeVar("T")

_around: ContextVar[ThreadPoolExecutor | None] = ContextVar("crew", default=None)


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
    """A number of threads, whoever calls among them; with one, nobody else works.

    What is shared inside, by jobs in turn and by whoever calls, goes to the same threads, so that there are never more
    and none is begun anew, and BLAS has one meanwhile.

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
        self._pool: ThreadPoolExecutor | None = None
        self._open = ExitStack()

    def __enter__(self) -> Self:
        if self.threads > 1:
            self._pool = _around.get() or self._hired()
            self._open.callback(_around.reset, _around.set(self._pool))
        return self

    def _hired(self) -> ThreadPoolExecutor:
        from signorini.blas_threads import one_thread  # loads BLAS, which what is small may do without

        self._open.enter_context(one_thread())
        return self._open.enter_context(ThreadPoolExecutor(self.threads - 1))

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._open.close()

    def each(self, calls: Sequence[Callable[[], T]]) -> list[T]:
        """What calls give that need nothing of each other; raise what the first one raises that fails."""
        found: dict[int, T] = {}
        self.finish([Job(partial(_put, found, i, call)) for i, call in enumerate(calls)])
        return [found[i] for i in range(len(calls))]

    def finish(self, jobs: Sequence[Job]) -> None:
        """Do jobs, of those that can be done always the first; raise what the first one raises that fails."""
        if self._pool is None:
            for job in jobs:
                job.call()
            return
        jobs_left = _Jobs(jobs)
        try:
            for _ in range(min(self.threads, len(jobs)) - 1):
                self._pool.submit(copy_context().run, jobs_left.work)
            jobs_left.work()
        finally:
            jobs_left.stop()
        if jobs_left.error is not None:
            raise jobs_left.error


def _put(found: dict[int, T], place: int, call: Callable[[], T]) -> None:
    found[place] = call()


def shared(calls: Sequence[Callable[[], T]], worth: bool) -> list[T]:
    """What calls give that need nothing of each other, of as many threads as large models share.

    >>> shared([lambda: 1, lambda: 2], worth=False)
    [1, 2]

    Parameters
    ----------
    calls : that let go of the interpreter while they compute
    worth : whether they take so long that threads are to share them: tens of milliseconds
    """
    if not worth or len(calls) < 2:
        return [call() for call in calls]
    with Crew(number_of_threads()) as crew:
        return crew.each(calls)


def by_ranges(call: Callable[[int, int], T], count: int, worth: bool) -> list[T]:
    """What a function gives of ranges of numbers below a count: one a thread, which must not show in what they are.

    >>> by_ranges(lambda low, high: (low, high), 5, worth=False)
    [(0, 5)]

    Parameters
    ----------
    call : of the first number of a range and of that behind its last; lets go of the interpreter
    count, worth : how many numbers; see `shared`
    """
    if not worth:
        return [call(0, count)]
    parts = number_of_threads()
    cuts = [count * part // parts for part in range(parts + 1)]
    return shared([partial(call, low, high) for low, high in pairwise(cuts)], worth)


class _Jobs:
    """Jobs of which several threads take the first that can be done."""

    def __init__(self, jobs: Sequence[Job]) -> None:
        self.error: BaseException | None = None
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
        """Begin no other job, and hold on to none: threads that are busy may hear of these only later."""
        with self._changed:
            self._end, self._jobs = 0, ()
            self._changed.notify_all()

    def work(self) -> None:
        """Do jobs until none is left."""
        while (taken := self._take()) is not None:
            number, job = taken
            error = None
            try:
                job.call()
            except BaseException as found:  # whoever waits is told
                error = found
            self._done(number, error)

    def _take(self) -> tuple[int, Job] | None:
        """The first job that can be done, as soon as there is one; None where none will be."""
        with self._changed:
            while True:
                if self._ready and self._ready[0] < self._end:
                    self._running += 1
                    number = heapq.heappop(self._ready)
                    return number, self._jobs[number]
                if not self._running:
                    return None
                self._changed.wait()

    def _done(self, number: int, error: BaseException | None) -> None:
        with self._changed:
            self._running -= 1
            if error is not None and not isinstance(error, Exception):
                number = -1  # the run is to end
            if error is not None and number < self._end:
                self._end, self.error = number, error
            if error is None:
                for follower in self._next[number]:
                    self._missing[follower] -= 1
                    if not self._missing[follower]:
                        heapq.heappush(self._ready, follower)
            self._changed.notify_all()
