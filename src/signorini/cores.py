# SPDX-License-Identifier: BSD-3-Clause
"""How many threads large models share."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path

from signorini.errors import InputError

_asked: ContextVar[int | None] = ContextVar("threads", default=None)


@contextmanager
def threads(number: int | None) -> Iterator[None]:
    """Let large models share a number of threads inside; None leaves it at what it is.

    Without it they share as many as the environment variable ``OMP_NUM_THREADS`` says, or as there are physical cores.
    Results are the same to the last bit.

    Raises
    ------
    InputError
        For fewer than one.

    Examples
    --------
    >>> with threads(3):
    ...     print(number_of_threads())
    3
    """
    if number is None:
        yield
        return
    if isinstance(number, bool) or not isinstance(number, int) or number < 1:
        raise InputError(f"threads = {number!r}; expected a whole number, at least 1")
    token = _asked.set(number)
    try:
        yield
    finally:
        _asked.reset(token)


def number_of_threads() -> int:
    """How many threads large models share; see `threads`."""
    asked = _asked.get()
    if asked is not None:
        return asked
    first = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()
    return int(first) if first.isdecimal() and int(first) > 0 else physical_cores()


@cache
def physical_cores() -> int:
    """Cores that this process may use, each counted once though it may run several threads.

    >>> physical_cores() >= 1
    True
    """
    mine = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set(range(os.cpu_count() or 1))
    cores = set()
    for cpu in mine:
        try:  # Linux; elsewhere every processor counts
            cores.add(Path(f"/sys/devices/system/cpu/cpu{cpu}/topology/thread_siblings_list").read_text())
        except OSError:
            cores.add(str(cpu))
    return len(cores)
