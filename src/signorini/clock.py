# SPDX-License-Identifier: BSD-3-Clause
"""Seconds spent in the phases of a solve, told to whoever shows progress."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listener = Callable[[str, float], None]

BEGINS = {"read": 0.0, "assembly": 0.02, "factorisation": 0.15, "condensation": 0.6, "output": 0.95}
"""Share of the whole that is done when a phase begins, as large models have it; increments fill what is between."""

INCREMENTS = (0.65, 0.95)


class Clock:
    """Adds up seconds by phase, and tells what is being done and how much of the whole is behind.

    Parameters
    ----------
    listener : called with words and the share that is done, to show progress
    timer : tells seconds; on a busy machine those of the CPU, ``time.process_time``, say more

    Examples
    --------
    >>> clock = Clock(lambda words, done: print(f"{done:.0%} {words}"))
    >>> with clock.phase("factorisation"):
    ...     clock.expect(4)
    ...     clock.increment("step 1")
    ...     with clock.again("the last way was lost"):
    ...         clock.says("step 1 at 2 %")
    15% factorisation
    65% step 1
    65% step 1 at 2 % (the last way was lost)
    >>> sorted(clock.seconds)
    ['factorisation']
    """

    def __init__(self, listener: Listener | None = None, timer: Callable[[], float] = time.perf_counter) -> None:
        self.seconds: dict[str, float] = {}
        self._listener, self._timer = listener, timer
        self._total, self._done, self._share = 1, 0, 0.0
        self._why = ""

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Time a block under a name, and tell that it begins."""
        if name in BEGINS:
            self._tell(name, BEGINS[name])
        with self.spending(name):
            yield

    @contextmanager
    def spending(self, name: str) -> Iterator[None]:
        """Time a block under a name, in between something else."""
        start = self._timer()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + self._timer() - start

    @contextmanager
    def again(self, why: str) -> Iterator[None]:
        """Say with all that is done inside why it is done once more; nothing where there are no words."""
        before, self._why = self._why, "; ".join(filter(None, (self._why, why)))
        try:
            yield
        finally:
            self._why = before

    def expect(self, increments: int) -> None:
        """Say how many increments will follow."""
        self._total, self._done = increments, 0

    def increment(self, words: str) -> None:
        """Say which increment comes next."""
        first, last = INCREMENTS
        self._tell(words, first + (last - first) * min(1.0, self._done / self._total))
        self._done += 1

    def says(self, words: str) -> None:
        """Say how far the increment is, or what is done for it."""
        self._tell(words, self._share)

    def _tell(self, words: str, done: float) -> None:
        self._share = done
        if self._listener is not None:
            self._listener(f"{words} ({self._why})" if self._why else words, done)
