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

    Examples
    --------
    >>> clock = Clock(lambda words, done: print(f"{done:.0%} {words}"))
    >>> with clock.phase("factorisation"):
    ...     clock.expect(4)
    ...     clock.increment("step 1")
    15% factorisation
    65% step 1
    >>> sorted(clock.seconds)
    ['factorisation']
    """

    def __init__(self, listener: Listener | None = None) -> None:
        self.seconds: dict[str, float] = {}
        self._listener = listener
        self._total, self._done = 1, 0

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
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start

    def expect(self, increments: int) -> None:
        """Say how many increments will follow."""
        self._total, self._done = increments, 0

    def increment(self, words: str) -> None:
        """Say which increment comes next."""
        first, last = INCREMENTS
        self._tell(words, first + (last - first) * min(1.0, self._done / self._total))
        self._done += 1

    def _tell(self, words: str, done: float) -> None:
        if self._listener is not None:
            self._listener(words, done)
