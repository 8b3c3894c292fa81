# SPDX-License-Identifier: BSD-3-Clause
"""What is being done, on one changing line of a terminal; nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from signorini.clock import Clock, Listener


@contextmanager
def progress(*, quiet: bool, seconds: Mapping[str, float] | None = None) -> Iterator[Clock]:
    """A clock whose phases are shown while they last; it goes on from the seconds of another."""
    shown = not quiet and sys.stderr.isatty()
    if not shown:
        yield _clock(None, seconds)
        return
    from rich.console import Console

    with Console(stderr=True).status("starting") as line:
        yield _clock(lambda words: line.update(words), seconds)


def _clock(listener: Listener | None, seconds: Mapping[str, float] | None) -> Clock:
    clock = Clock(listener)
    clock.seconds |= seconds or {}
    return clock
