# SPDX-License-Identifier: BSD-3-Clause
"""What is being done: a bar on a terminal, a plain line every few seconds in a pipe, and a log in a file."""

from __future__ import annotations

import re
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from signorini.clock import Clock, Listener
from signorini.errors import InputError

LINE_PERIOD = 5.0  # seconds between lines in a pipe: a batch job shows that it lives, and fills no disk
_LOG_PERIOD = 1.0  # seconds between lines of a log on the same kind of work


@contextmanager
def progress(
    *, quiet: bool, seconds: Mapping[str, float] | None = None, note: str = "", log: Path | None = None
) -> Iterator[Clock]:
    """A clock whose phases are shown while they last.

    Parameters
    ----------
    quiet : nothing is shown; a log is written all the same
    seconds : of another clock, which this one goes on from
    note : above the bar
    log : file to which lines are added
    """
    with ExitStack() as stack:
        tells = [tell for tell in (stack.enter_context(progress_bar(quiet=quiet, note=note)),) if tell]
        tells += [stack.enter_context(_logged(log))] if log else []

        def tell(words: str, done: float) -> None:
            for listener in tells:
                listener(words, done)

        clock = Clock(tell if tells else None)
        clock.seconds |= seconds or {}
        yield clock


@contextmanager
def progress_bar(*, quiet: bool = False, note: str = "") -> Iterator[Listener | None]:
    """Whom to tell what is being done and how much of the whole is behind; None where nobody wants to know.

    What is printed meanwhile stands above the bar; where no terminal is, lines on standard error take its place.
    """
    if quiet:
        yield None
        return
    if not sys.stderr.isatty():
        with _lines(lambda line: print(line, file=sys.stderr, flush=True)) as tell:
            yield tell
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


@contextmanager
def _lines(say: Callable[[str], None]) -> Iterator[Listener]:
    """Say every `LINE_PERIOD` what is being done, from a thread of its own, since a factorisation tells nothing."""
    began, over = time.monotonic(), threading.Event()
    now = ("starting", 0.0)

    def tell(words: str, done: float) -> None:
        nonlocal now
        now = (words, done)

    def watch() -> None:
        while not over.wait(LINE_PERIOD):
            say(f"signorini: {time.monotonic() - began:.0f} s, {now[1]:.0%}: {now[0]}")

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield tell
    finally:
        over.set()
        thread.join()


@contextmanager
def _logged(path: Path) -> Iterator[Listener]:
    """Add lines to a file: whatever is new in kind, and of one kind of work one a second."""
    began, said, last = time.monotonic(), "", 0.0
    with path.open("a", encoding="utf-8", buffering=1) as file:

        def write(words: str) -> None:
            file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')}  {time.monotonic() - began:9.2f} s  {words}\n")

        def tell(words: str, done: float) -> None:
            nonlocal said, last
            kind, now = re.sub(r"[\d.,+-]+", "", words), time.monotonic()
            if kind != said or now - last >= _LOG_PERIOD:
                said, last = kind, now
                write(f"{done:4.0%}  {words}")

        try:
            yield tell
        except BaseException as error:
            write(f"{type(error).__name__}: {error}")
            raise


def open_log(name: str | None, words: str) -> Path | None:
    """Begin a log with a line; None where none is asked for.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    if name is None:
        return None
    path = Path(name)
    try:
        path.write_text(f"{time.strftime('%Y-%m-%d %H:%M:%S')}  {words}\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot write '{name}': {error.strerror}", where=("--log",)) from error
    return path
