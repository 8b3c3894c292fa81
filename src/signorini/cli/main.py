# SPDX-License-Identifier: BSD-3-Clause
"""From arguments to an exit code: 0 done, 2 the input is wrong, 3 no certified solution; never a traceback."""

from __future__ import annotations

import importlib
import os
import signal
import sys
import threading
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from signorini.cli.exit_codes import DONE, FAILED, INTERRUPTED, NO_SOLUTION, WRONG_INPUT
from signorini.cli.parser import make_parser
from signorini.cores import threads
from signorini.distributed.ranks import ON_RANKS, whole_team
from signorini.errors import InputError, SolveFailed

_COMMANDS = {
    "signorini.cli.deck_commands": ("run", "modes", "sensitivities", "check", "convert"),
    "signorini.cli.sweep_command": ("sweep",),
    "signorini.cli.result_commands": ("diff", "plot", "report", "table"),
    "signorini.cli.fatigue_command": ("fatigue",),
    "signorini.cli.word_commands": ("schema", "explain"),
    "signorini.cli.doctor": ("doctor",),
    "signorini.cli.mcp_command": ("mcp",),
    "signorini.cli.suite_commands": ("verify", "bench"),
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; every failure is one message on standard error.

    Parameters
    ----------
    arguments : without the program's name; those of the process by default

    Returns
    -------
    The exit code; wrong options leave by ``SystemExit(2)``, as is usual
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    if any(
        word.startswith("--b") and (after in ON_RANKS or word.partition("=")[2] in ON_RANKS)
        for word, after in _pairs(given)
    ):
        return _on_ranks(given)
    return _run(given)


def _pairs(given: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Every argument with the one that follows it."""
    return zip(given, [*given[1:], ""], strict=False)


def _on_ranks(given: Sequence[str]) -> int:
    """Run a command on the first of all ranks, which the others serve; all have its exit code, and it alone speaks."""
    try:
        with whole_team() as team:
            if team.first:
                try:
                    team.code = _run(given)
                except SystemExit as wrong:
                    team.code = int(wrong.code or 0)
        return team.code
    except InputError as error:
        return _say(f"signorini: {error}", WRONG_INPUT)


def _run(given: Sequence[str]) -> int:
    """Run a command; see `main`."""
    options = make_parser().parse_args(given)
    try:
        with _stoppable(), threads(getattr(options, "threads", None)):
            (home,) = (module for module, commands in _COMMANDS.items() if options.command in commands)
            code = int(getattr(importlib.import_module(home), options.command)(options))
        sys.stdout.flush()
        return code
    except InputError as error:
        return _say(f"signorini: {error}", WRONG_INPUT)
    except SolveFailed as failure:
        return _say(f"signorini: no certified solution ({failure.status}): {failure}", NO_SOLUTION)
    except KeyboardInterrupt:
        return _say("signorini: interrupted", INTERRUPTED)
    except BrokenPipeError:
        # whoever read the output has left; nothing is to be said, and nothing more to be written at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except OSError as error:  # the system refuses: a full disk, a place that is gone
        if options.debug:
            traceback.print_exc()
        at = f"'{error.filename}': " if error.filename else ""
        return _say(f"signorini: {at}{error.strerror or error}", FAILED)
    except MemoryError as error:  # more than was estimated, or a mesh beyond all estimates
        if options.debug:
            traceback.print_exc()
        from signorini.memory import out_of_memory

        return _say(f"signorini: {out_of_memory(error)}", FAILED)
    except Exception as error:  # the last resort: a user never sees a traceback unasked
        if options.debug:
            traceback.print_exc()
        words = " ".join(str(error).split()) or "no message"
        again = "" if options.debug else " (--debug shows where)"
        return _say(f"signorini: internal error: {type(error).__name__}: {words}; please report it{again}", FAILED)


def _say(words: str, code: int) -> int:
    print(words, file=sys.stderr)
    return code


@contextmanager
def _stoppable() -> Iterator[None]:
    """Raise KeyboardInterrupt on SIGTERM, by which batch systems end a run, while the block lasts.

    Handlers can be set in the main thread alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before or signal.SIG_DFL)  # None: one that was not set by Python
