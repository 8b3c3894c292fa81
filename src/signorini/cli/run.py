# SPDX-License-Identifier: BSD-3-Clause
"""``signorini run``: a deck in, results out."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from signorini.api import solve
from signorini.cli.progress import progress
from signorini.clock import Clock
from signorini.deck import Deck, load
from signorini.errors import InputError, SolveFailed, one_of
from signorini.linalg.registry import BACKENDS
from signorini.output.folder import open_folder, publish
from signorini.output.table import history_table
from signorini.solution.history import History


def run(options: argparse.Namespace) -> int:
    """Solve, write, print; 0 if solved and certified, 3 if not."""
    started = time.perf_counter()
    if options.backend not in ("auto", *BACKENDS):
        raise InputError(one_of(options.backend, ["auto", *BACKENDS], "back end"), where=("--backend",))
    with progress(quiet=options.quiet) as clock:
        with clock.phase("read"):
            deck = load(options.deck)
        folder = open_folder(Path(options.folder) if options.folder else Path("out", deck.path.stem))
        history = _solve(deck, options.backend, clock)
        files = publish(history, folder, clock, started=started)
    if not options.quiet:
        print(history_table(history))
        print(f"\n{', '.join(file.name for file in files)} in {folder} ({time.perf_counter() - started:.2f} s)")
    if history.solved:
        return 0
    print(f"signorini: {deck.path}: no certified solution ({history.status}): {history.message}", file=sys.stderr)
    return 3


def _solve(deck: Deck, backend: str, clock: Clock) -> History:
    """The history, finished or not; what is wrong with the deck is told with its line."""
    try:
        return solve(deck.model, backend=backend, raise_on_failure=False, clock=clock)
    except InputError as error:
        raise deck.locate(error) from error
    except SolveFailed as failure:  # before there was any history
        return History(
            model=deck.model,
            status=failure.status,
            message=str(failure),
            steps=(),
            backend=backend,
            timings=dict(clock.seconds),
            pairs=0,
        )
