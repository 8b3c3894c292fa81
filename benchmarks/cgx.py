# SPDX-License-Identifier: BSD-3-Clause
"""Results in ``.frd`` files as cgx, CalculiX's own viewer, reads them: nodes, elements and displacements come back.

    python -m benchmarks.cgx DECK...

Needs ``cgx`` on the path. Every deck is solved, its ``.frd`` is read by ``cgx -bg``, which writes what it has read as
an Abaqus mesh and a table of displacements, with six decimals; both are compared with the model.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np

import signorini as sg
from benchmarks import command
from signorini.deck import load_deck

_COMMANDS = "read result.frd\nsend all abq\nds 1 e {}\nsend all abq ds1 e{}\nquit\n"


def blocks(text: str, keyword: str) -> list[list[float]]:
    """Rows of numbers under a keyword, rows that end with a comma going on in the next."""
    rows: list[list[float]] = []
    for part in re.findall(rf"(?im)^\*{keyword}[^\n]*\n([^*]*)", text):
        joined = re.sub(r",\s*\n", ",", part)
        rows += [[float(word) for word in line.split(",") if word.strip()] for line in joined.splitlines() if line]
    return rows


def check(deck: Path, folder: Path) -> str:
    """What comes back of a deck, in words."""
    solution = sg.solve(load_deck(deck, small_strain=True).model)
    solution.write(folder / "result.frd")
    mesh, first = solution.model.mesh, solution.steps[0]
    worst = 0.0
    for axis in range(mesh.points.shape[1]):
        (folder / "read.fbl").write_text(_COMMANDS.format(axis + 1, axis + 1))
        subprocess.run(["cgx", "-bg", "read.fbl"], cwd=folder, capture_output=True, check=False, timeout=60)
        table = (folder / f"all_ds1e{axis + 1}.dat").read_text()
        found = {int(node): value for node, value in re.findall(r"(?m)^\s*(\d+)\s*,\s*([-+.\dEe]+)", table)}
        row = {int(number): i for i, number in enumerate(mesh.labels)}
        apart = [abs(float(value) - first.displacement[row[node], axis]) for node, value in found.items()]
        worst = max(worst, max(apart, default=np.inf))
    text = (folder / "all.msh").read_text()
    nodes = {int(row[0]): row[1:4] for row in blocks(text, "NODE")}
    elements = {int(row[0]): [int(node) for node in row[1:]] for row in blocks(text, "ELEMENT")}
    every = [cell for cells in mesh.cells.values() for cell in cells]
    same = sum(
        elements.get(int(label)) == mesh.labels[cell].tolist()
        for label, cell in zip(mesh.cell_labels, every, strict=True)
    )
    away = max(
        float(abs(np.array(nodes[int(number)])[: mesh.points.shape[1]] - point).max())
        for number, point in zip(mesh.labels, mesh.points, strict=True)
        if int(number) in nodes
    )
    return (
        f"{deck.stem:16s} {len(nodes)} nodes within {away:.0e}, {same} of {len(every)} elements the same "
        f"({', '.join(mesh.cells)}), displacements within {worst:.0e}"
    )


if __name__ == "__main__":
    command.deck_by_deck(__doc__, check)
