# SPDX-License-Identifier: BSD-3-Clause
"""A progress bar with what is being done, on a terminal; nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from signorini.clock import Clock, Listener


@contextmanager
def progress(*, quiet: bool, seconds: Mapping[str, float] | None = None, note: str = "") -> Iterator[Clock]:
    """A clock whose phases are shown while they last, unless quiet, below a note; with the seconds of another."""
    with progress_bar(quiet=quiet, note=note) as tell:
        clock = Clock(tell)
        clock.seconds |= seconds or {}
        yield clock


@contextmanager
def progress_bar(*, quiet: bool = False, note: str = "") -> Iterator[Listener | None]:
    """Whom to tell what is being done and how much of the whole is behind; None where nobody watches.

    What is printed meanwhile stands above the bar.
    """
    shown = not quiet and sys.stderr.isatty()
    if not shown:
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("{task.description}"),
    )
    console = Console(stderr=True)
    if note:
        console.print(note, highlight=False)
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("starting", total=1.0)
        yield lambda words, done: bar.update(task, description=words, completed=done)
