# SPDX-License-Identifier: BSD-3-Clause
"""fricloop of CalculiX's suite by its increments: its pairs are those of the beginning of each, and lag behind.

python -m benchmarks.lagging_pairs FOLDER [--page]     (FOLDER: the suite's; --page writes docs/inp.md)
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

import signorini as sg
from benchmarks import page
from tests.helpers.calculix import ccx_displacements

_PAGE = Path(__file__).parent.parent / "docs" / "inp.md"
_INCREMENTS = (0.1, 0.05, 0.025, 0.0125)  # of a step that is 1 long
_NODES = 16  # of its cubes


def deck(text: str, increment: float | None) -> str:
    """The deck without NLGEOM, with its displacements printed; None: increments as it asks for them."""
    text = text.replace(",NLGEOM", ",INC=1000").replace("*NODE FILE", "*NODE PRINT,NSET=Nall,FREQUENCY=1000")
    text = text.replace("*EL FILE\nS,NOE\n*CONTACT FILE\nCDISP,CSTRESS\n", "")
    if increment is not None:
        for asked in (".01,1.", ".02,2."):
            text = text.replace(f"*STATIC\n{asked}", f"*STATIC,DIRECT\n{increment:g},{asked.partition(',')[2]}")
    return text


def row(text: str, increment: float | None) -> list[str]:
    """The largest difference of a displacement at the end, of the largest there."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.inp"
        path.write_text(deck(text, increment))
        printed = ccx_displacements(path)[-1]
        own = sg.solve(sg.read(path)).steps[-1].displacement[:_NODES]
    largest = float(np.abs(own - printed).max() / np.abs(printed).max())
    return ["as the deck asks for them" if increment is None else f"{increment:g}", f"{largest:.1e}"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--page", action="store_true", help="write the table into docs/inp.md")
    given = parser.parse_args()
    text = (given.folder / "fricloop.inp").read_text(encoding="utf-8")
    rows = [row(text, increment) for increment in (None, *_INCREMENTS)]
    table = page.table(("increments of fricloop", "difference"), rows)
    print(table)
    if given.page:
        page.write("lagging pairs", table, _PAGE)


if __name__ == "__main__":
    main()
