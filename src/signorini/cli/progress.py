# SPDX-License-Identifier: BSD-3-Clause
"""What is being done, on one changing line of a terminal; nothing in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from signorini.clock import Clock


@contextmanager
def progress(*, quiet: bool) -> Iterator[Clock]:
    """A clock whose phases are shown while they last."""
    if quiet or not sys.stderr.isatty():
        yield Clock()
        return
    from rich.console import Console

    with Console(stderr=True).status("starting") as line:
        yield Clock(lambda words: line.update(words))
