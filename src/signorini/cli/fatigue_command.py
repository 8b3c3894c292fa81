# SPDX-License-Identifier: BSD-3-Clause
"""``signorini fatigue``: criteria of a file along a history that was solved before."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from signorini.clock import Clock
from signorini.deck.deck import located_error
from signorini.deck.fatigue import model_asking_for
from signorini.deck.syntax import parse
from signorini.engine.fatigue import assess_fatigue
from signorini.errors import InputError
from signorini.fem.space import make_space
from signorini.output.folder import Publisher, own_folder, read_results
from signorini.output.table import fatigue_lines
from signorini.solution.history import History


def fatigue(options: argparse.Namespace) -> int:
    """Write what ``run --fatigue`` would have written, and print the worst places; the exit code."""
    started, asked = time.perf_counter(), Path(options.asked)
    history = read_results(Path(options.results))
    if not history.solved:
        raise InputError(f"'{options.results}' ended with '{history.status}'; expected every step to be solved")
    history = _answered(history, asked)
    path = Path(options.folder) if options.folder else Path("out", asked.stem)
    with own_folder(path, asked.name) as folder:
        Publisher(folder=folder, clock=Clock(), started=started, deck=asked.name).publish(history)
    if not options.quiet:
        print("\n".join(fatigue_lines(history)).strip())
        print(f"\nfatigue.csv and all that was solved before in {folder} ({time.perf_counter() - started:.2f} s)")
    return 0


def _answered(history: History, asked: Path) -> History:
    """The history with the criteria of a file alone.

    Raises
    ------
    DeckError
        With file and line.
    """
    model = model_asking_for(history.model, asked)
    space = cache(partial(make_space, model.mesh, kind=model.kind))
    history, found = replace(history, model=model), []
    for i, request in enumerate(model.fatigue):
        try:
            found.append(assess_fatigue(history, request, space))
        except InputError as error:
            raise located_error(error.inside("fatigue", i), asked, parse(asked)[1]) from error
    return replace(history, fatigue_results=tuple(found))
