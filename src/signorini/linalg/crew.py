# SPDX-License-Identifier: BSD-3-Clause
"""Threads that run compiled loops side by side, of which whoever calls waits for all."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from types import TracebackType
from typing import Self, TypeVar

T = TypeVar("T")


class Crew:
    """A number of threads; with one, whoever calls works itself.

    >>> with Crew(2) as crew:
    ...     crew.each([lambda: 1, lambda: 2]), crew.run(lambda: 3), list(crew.ahead([lambda: 4, lambda: 5]))
    ([1, 2], 3, [4, 5])

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

    def run(self, call: Callable[[], T]) -> T:
        """One call, by a thread of the crew, so that never more of them work than there are."""
        return call() if self._pool is None else self._pool.submit(call).result()

    def each(self, calls: Sequence[Callable[[], T]]) -> list[T]:
        """What calls give that need nothing of each other."""
        if self._pool is None:
            return [call() for call in calls]
        return [future.result() for future in [self._pool.submit(call) for call in calls]]

    def ahead(self, calls: Iterable[Callable[[], T]]) -> Iterator[T]:
        """What calls give, one after the other, of which some are made ahead: twice as many as there are threads."""
        calls = iter(calls)
        if self._pool is None:
            for call in calls:
                yield call()
            return
        futures: deque[Future[T]] = deque(self._pool.submit(call) for call in islice(calls, 2 * self.threads))
        while futures:
            yield futures.popleft().result()
            futures.extend(self._pool.submit(call) for call in islice(calls, 1))
