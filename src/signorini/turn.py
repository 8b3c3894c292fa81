# SPDX-License-Identifier: BSD-3-Clause
"""Processes that want to make the same file take turns: one makes it, the others wait."""

from __future__ import annotations

import importlib
import os
import time
from contextlib import suppress
from types import ModuleType

LONGEST_WAIT = 60.0
"""Seconds after which a process makes the file itself: no loop takes as long to compile, so that whoever has the turn
hangs, or was interrupted and lives on."""

_PERIOD = 0.02  # seconds between looks at whether the turn is free


def _locks() -> ModuleType | None:
    try:
        return importlib.import_module("fcntl")
    except ImportError:  # there are no such locks on Windows, where everybody makes the file
        return None


class Turn:
    """A turn at a file, by a lock on another one beside it, which ends with the process at the latest.

    Parameters
    ----------
    path : of the file that is locked

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     turn = Turn(os.path.join(folder, "loop.turn"))
    ...     turn.free(), turn.waited(), turn.end()
    (True, False, None)
    """

    def __init__(self, path: str) -> None:
        self._path = path
        self._file: int | None = None

    def waited(self) -> bool:
        """Take the turn, and tell whether another process had it, which may have made the file."""
        begin, waited = time.monotonic(), False
        while not self._taken() and time.monotonic() - begin < LONGEST_WAIT:
            waited = True
            time.sleep(_PERIOD)
        return waited

    def free(self) -> bool:
        """Whether no other process has the turn."""
        if self._file is not None:
            return True
        free = self._taken()
        self.end()
        return free

    def end(self) -> None:
        """Leave the turn to others."""
        if self._file is None:
            return
        with suppress(OSError):  # another one has removed it
            os.unlink(self._path)
        os.close(self._file)
        self._file = None

    def _taken(self) -> bool:
        """Lock the file; where nothing can be locked, everybody has the turn."""
        locks = _locks()
        if self._file is not None or locks is None:
            return True
        try:
            os.makedirs(os.path.dirname(self._path), exist_ok=True)
            file = os.open(self._path, os.O_CREAT | os.O_RDWR, 0o666)
        except OSError:
            return True
        try:
            locks.flock(file, locks.LOCK_EX | locks.LOCK_NB)
        except BlockingIOError:
            os.close(file)
            return False
        except OSError:
            os.close(file)
            return True
        self._file = file
        return True
