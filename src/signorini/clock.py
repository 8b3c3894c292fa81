# SPDX-License-Identifier: BSD-3-Clause
"""Seconds spent in the phases of a solve, told to whoever shows progress."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listener = Callable[[str], None]


class Clock:
    """Adds up seconds by phase; nested phases are not counted twice.

    Parameters
    ----------
    listener : called with words whenever something begins, to show progress

    Examples
    --------
    >>> clock = Clock()
    >>> with clock.phase("assembly"):
    ...     pass
    >>> sorted(clock.seconds)
    ['assembly']
    """

    def __init__(self, listener: Listener | None = None) -> None:
        self.seconds: dict[str, float] = {}
        self._listener = listener

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Time a block under a name."""
        self.tell(name)
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start

    def tell(self, words: str) -> None:
        """Say what is being done."""
        if self._listener is not None:
            self._listener(words)
