# SPDX-License-Identifier: BSD-3-Clause
"""From a deck that was read to the sensitivities of its answers."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from signorini.api import solve
from signorini.blas_threads import one_thread
from signorini.clock import Clock
from signorini.deck import Deck
from signorini.derivative.refusals import refuse_model
from signorini.errors import InputError
from signorini.output.sensitivities_file import write_sensitivities
from signorini.output.sensitivities_table import sensitivities_data, sensitivities_table


@one_thread()
def run_sensitivities(deck: Deck, options: argparse.Namespace, clock: Clock) -> int:
    """Solve, differentiate, print.

    Parameters
    ----------
    deck : as it was read
    options : ``json`` and ``output`` of the command line
    clock : that tells progress

    Returns
    -------
    The exit code, 0; what could not be solved is raised
    """
    try:
        refuse_model(deck.model)
        found = solve(deck.model, settings=deck.settings, clock=clock, tape=True).sensitivities()
    except InputError as error:
        raise deck.locate(error) from error
    if options.output:
        write_sensitivities(found, Path(options.output))
    if options.json:
        print(json.dumps(sensitivities_data(found), indent=1))
        return 0
    print(deck.model.title or "untitled", end="\n\n")
    print(sensitivities_table(found))
    for note in deck.notes:
        print(f"\ndeck: {note}")
    return 0
