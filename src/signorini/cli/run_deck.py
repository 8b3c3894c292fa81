# SPDX-License-Identifier: BSD-3-Clause
"""From a deck that was read to files and a table."""

from __future__ import annotations

import argparse
import re
import sys
import textwrap
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from signorini.arrays import stored
from signorini.blas_threads import one_thread
from signorini.checks import number
from signorini.cli.progress import progress
from signorini.clock import Clock
from signorini.deck import Deck
from signorini.deck.keys import check_keys
from signorini.distributed.ranks import lend
from signorini.engine.condensation import refuse_unknown
from signorini.engine.first_run import FIRST_SOLVE, compiles_first
from signorini.engine.solve import solve
from signorini.errors import InputError, SolveFailed
from signorini.memory import share_one_heap
from signorini.model.accuracy import Accuracy, Asked
from signorini.outcome import Outcome
from signorini.output.archive import read_archive
from signorini.output.checkpoint import read_checkpoint
from signorini.output.folder import Publisher, own_folder
from signorini.output.table import history_table
from signorini.solution.checkpoint import Checkpoint
from signorini.solution.history import History

_ACCURACY: dict[str, Callable[[str], Any]] = {"of": str, "nodes": int, "memory": float, "seconds": float}
"""What the command line may say behind an accuracy, and how it is read."""


@one_thread()
def run_deck(deck: Deck, options: argparse.Namespace, clock: Clock, started: float, log: Path | None = None) -> int:
    """Solve, write, print.

    Parameters
    ----------
    deck : as it was read
    options : ``folder``, ``start``, ``backend``, ``wellposed``, ``accuracy``, ``compress`` and ``quiet`` of the command
        line
    clock : with the seconds of reading
    started : ``time.perf_counter()`` at the beginning of the command
    log : file to which lines on what is done are added; None: none

    Returns
    -------
    The exit code: 0, 3, or 130 where it was interrupted: what was finished before is written
    """
    refuse_unknown(options.backend, ("--backend",))
    share_one_heap()
    start = _start(options.start)
    path = Path(options.folder) if options.folder else Path("out", deck.path.stem)
    note = FIRST_SOLVE if compiles_first(deck.model) else ""
    with own_folder(path, deck.path.name) as folder:
        quiet = options.quiet or options.json
        with progress(quiet=quiet, seconds=clock.seconds, note=note, log=log) as clock:
            publisher = Publisher(
                folder=folder,
                clock=clock,
                started=started,
                deck=deck.path.name,
                prints=deck.prints,
                compress=options.compress,
            )
            history = _solve(deck, options, clock, start, _kept(publisher))
            files = publisher.publish(history)
            clock.says(f"{history.status}: {history.message}" if history.message else str(history.status))
        return _told(deck, options, history, files, folder, started)


def _kept(publisher: Publisher) -> Callable[[History], None]:
    """Write finished steps; where that fails say so once, and solve on: the disk may have room at the end."""
    told = False

    def keep(history: History) -> None:
        nonlocal told
        try:
            publisher.keep(history)
        except OSError as error:
            if not told:
                print(f"signorini: {error.strerror}; the run goes on", file=sys.stderr)
            told = True

    return keep


def _told(
    deck: Deck, options: argparse.Namespace, history: History, files: Sequence[Path], folder: Path, started: float
) -> int:
    """Print what was found; the exit code."""
    if options.json:
        print((folder / "summary.json").read_text(encoding="utf-8"), end="")
    elif not options.quiet:
        if history.solved or history.steps:
            print(history_table(history, failure=False), end="\n\n")
        for note in deck.notes:
            print(textwrap.fill(f"deck: {note}", 112), end="\n\n")
        if stored(history, "escape") is not None:
            print(f"a picture of how bodies run away: signorini plot {folder} --what escape", end="\n\n")
        print(f"{_listed(files, folder)} in {folder} ({time.perf_counter() - started:.2f} s)")
    if history.solved:
        return 0
    sys.stdout.flush()
    if history.status == Outcome.INTERRUPTED:
        print(f"signorini: {deck.path}: {history.message}; results in {folder}", file=sys.stderr)
        return 130
    print(f"signorini: {deck.path}: no certified solution ({history.status}): {history.message}", file=sys.stderr)
    return 3


def _listed(files: Sequence[Path], folder: Path) -> str:
    """Names of the files; of those in folders of it only how many there are."""
    inner = Counter(file.parent.name for file in files if file.parent != folder)
    names = [file.name for file in files if file.parent == folder]
    return ", ".join([*names, *(f"{count} files in {name}" for name, count in inner.items())])


def _start(name: str | None) -> Checkpoint | None:
    """The state to go on from; read before the folder that holds it may be written to."""
    if name is None:
        return None
    path = Path(name)
    if path.suffix.lower() in (".h5", ".hdf5"):
        end = read_archive(path).end
        if end is None:
            raise InputError(f"'{path}' holds no finished step to go on from", where=("--from",))
        return end
    return read_checkpoint(path / "state.npz" if path.is_dir() else path)


def _accuracy(deck: Deck, given: str | None) -> Asked | None:
    """What the command line asks for, "0.01" or "0.01,of=energy,nodes=50000", or else the deck."""
    if given is None or given == "estimate":
        return deck.accuracy if given is None else "estimate"
    first, *rest = re.split(r",(?=\w+=)", given)
    asked = deck.accuracy if isinstance(deck.accuracy, Accuracy) else Accuracy(1.0)
    more = dict(part.split("=", 1) for part in rest)
    try:
        check_keys(more, (), known=_ACCURACY)
        bounds = {key: _ACCURACY[key](part) for key, part in more.items()}
        return replace(asked, error=number(float(first), ("error",), above=0.0), **bounds)
    except ValueError as wrong:
        words = "expected a relative error > 0, or 'estimate'"
        if isinstance(wrong, InputError) and wrong.where != ("error",):
            words = str(wrong)
        raise InputError(f"is '{given}'; {words}", where=("--accuracy",)) from wrong


def _solve(
    deck: Deck,
    options: argparse.Namespace,
    clock: Clock,
    start: Checkpoint | None,
    after_step: Callable[[History], None],
) -> History:
    """The history, finished or not; what is wrong with the deck is told with its line."""
    accuracy = _accuracy(deck, options.accuracy)
    follow = partial(
        solve,
        start=start,
        backend=options.backend,
        settings=deck.settings,
        raise_on_failure=False,
        wellposed=options.wellposed,
        clock=clock,
    )
    try:
        if accuracy is None:
            lend(deck.model.mesh)
            return follow(deck.model, after_step=after_step)
        from signorini.accuracy.refine import accurate, refuse_one_mesh  # not before an accuracy is asked for

        refuse_one_mesh(accuracy, **{"--from": start is not None})
        return accurate(deck.model, accuracy, follow)
    except InputError as error:
        raise deck.locate(error) from error
    except SolveFailed as failure:  # before there was any history
        return History(
            model=deck.model,
            status=failure.status,
            message=str(failure),
            steps=(),
            backend=options.backend,
            timings=dict(clock.seconds),
            pairs=0,
        )
