# SPDX-License-Identifier: BSD-3-Clause
"""``signorini run``: a deck in, results out."""

from __future__ import annotations

import argparse
import time

from signorini.cli.progress import progress
from signorini.cli.reading import load_deck


def run(options: argparse.Namespace) -> int:
    """Read, solve, write, print; 0 if solved and certified, 3 if not."""
    started = time.perf_counter()
    with progress(quiet=options.quiet) as clock, clock.phase("read"):
        deck = load_deck(options)
    from signorini.cli.run_deck import solve_deck  # everything heavy: a wrong deck never waits for it

    return solve_deck(deck, options, clock, started)
