# SPDX-License-Identifier: BSD-3-Clause
"""Cycles that blocks of cycles take where a contact wears in partial slip: how many are followed for one block.

    python -m benchmarks.wear_blocks [--cycles 501] [--page]     (--page writes docs/wear.md)

Two equal cylinders with nodes at a fifth of the half-width are pulled to and fro below sliding. A cycle wears what a
coefficient of 0.2 for each side does, so that the annulus of slip is worn off after some hundred cycles.
"""

from __future__ import annotations

import argparse
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

import signorini as sg
from benchmarks import page
from signorini.arrays import Array
from signorini.gallery.half_planes import equal_half_planes

_PAGE = Path(__file__).parent.parent / "docs" / "wear.md"
_HEAD = (
    "pulled by, mu P",
    "block",
    "blocks",
    "longest",
    "single cycles",
    "cycles followed",
    "depth beside every cycle",
)
_SHARES = (0.7, 0.9, 0.95)  # of the force at which all would slide
_BLOCKS = (1, 10, 100, 1000, "auto")
_COEFFICIENT = 0.2  # area per force, of each side
_SPACING = 0.2  # of the nodes, in half-widths


def worn(share: float, cycles: int, block: int | str | None) -> tuple[Array, list[int]]:
    """Depths after some cycles, and numbers of blocks, of the longest, of single cycles and of those followed."""
    steps = [
        sg.Step(name="press", scale={"press": 1.0}),
        sg.Step(name="pull", scale={"pull": share}),
        sg.Step(name="cycles", scale={"pull": [-share, share]}, repeat=cycles, block=block),  # type: ignore[arg-type]
    ]
    model = equal_half_planes(steps[:2], spacing=_SPACING)
    contact = replace(model.contacts[0], wear=sg.Wear(_COEFFICIENT, mortar=_COEFFICIENT))
    solution = sg.solve(replace(model, steps=steps, contacts=[contact]))
    notes = [note for note in solution.last.notes if note.startswith("sides wore in")]
    wear = solution.last.contacts[0].wear
    assert wear is not None
    return wear.depth, [int(number) for note in notes for number in re.findall("[0-9]+", note)]


def rows(share: float, cycles: int) -> list[tuple[str, ...]]:
    """The rows of one force."""
    exact, _ = worn(share, cycles, None)
    table = [(f"{share:g}", "every cycle", "", "", f"{cycles}", f"{cycles}", "")]
    for block in _BLOCKS:
        depth, (blocks, longest, single, followed) = worn(share, cycles, block)
        error = float(np.abs(depth - exact).max() / exact.max())
        table.append(("", str(block), str(blocks), str(longest), str(single), str(followed), f"{error:.1e}"))
    return table


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cycles", type=int, default=501)
    parser.add_argument("--page", action="store_true", help="write the table into docs/wear.md")
    given = parser.parse_args()
    text = page.table(_HEAD, [row for share in _SHARES for row in rows(share, given.cycles)])
    print(text)
    if given.page:
        page.write("blocks", text, _PAGE)


if __name__ == "__main__":
    main()
