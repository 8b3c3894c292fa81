# SPDX-License-Identifier: BSD-3-Clause
"""What the command lines of the benchmarks share."""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import page


def parser(words: str | None, *, dry: bool = False, write: bool = False) -> argparse.ArgumentParser:
    """With a module's docstring for help.

    Parameters
    ----------
    dry : of a script that writes a page of its own, see `publish`
    write : of one that is told which
    """
    made = argparse.ArgumentParser(description=words, formatter_class=argparse.RawDescriptionHelpFormatter)
    if dry:
        made.add_argument("--dry", action="store_true", help="print, but leave the page as it is")
    if write:
        made.add_argument("--write", type=Path, metavar="DOCUMENT", help="put what is found between its marks")
    return made


def publish(options: argparse.Namespace, name: str, text: str, document: Path = page.PAGE) -> None:
    """Print a text and put it between the markers of a name, unless the page is to stay."""
    print(text, flush=True)
    if not options.dry:
        page.write(name, text, document)


def deck_by_deck(words: str | None, check: Callable[[Path, Path], str]) -> None:
    """Print what there is to say of every deck on the command line, each with an empty folder to work in."""
    made = parser(words)
    made.add_argument("decks", type=Path, nargs="+")
    for deck in made.parse_args().decks:
        with tempfile.TemporaryDirectory() as folder:
            print(check(deck, Path(folder)), flush=True)


def cpu(function: Callable[..., Any], *arguments: Any) -> tuple[float, Any]:
    """CPU seconds of a call, and what it returns."""
    start = time.process_time()
    result = function(*arguments)
    return time.process_time() - start, result


def exponent(x: Sequence[float], y: Sequence[float]) -> float:
    """Of the power law y of x that fits best.

    >>> round(exponent([1.0, 2.0, 4.0], [3.0, 12.0, 48.0]), 12)
    2.0
    """
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])
