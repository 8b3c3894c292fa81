# SPDX-License-Identifier: BSD-3-Clause
"""Public CalculiX decks against their printed references.

    python benchmarks/decks.py FOLDER [NAME...] [--ccx]

FOLDER holds decks (``NAME.inp``) and what CalculiX printed for them (``NAME.dat.ref`` or ``NAME.dat``), such as the
folder ``test`` of the CalculiX repository. Every deck that this package can solve is solved with small strains, and the
tables of displacements are compared node by node: the largest difference, as a part of the largest displacement of
the table. With ``--ccx`` CalculiX itself computes the references, from the decks as they are.
References with NLGEOM or with penalties differ from the exact law by their own share.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import signorini as sg
from signorini.deck import load

_TABLE = re.compile(r"displacements \(vx,vy,vz\) for set (\S+) and time +(\S+)\s*\n\s*\n((?:[ \d].*\n?)+)")


def references(path: Path) -> list[dict[int, NDArray[np.float64]]]:
    """Displacements by node number of every table in a ``.dat`` file."""
    found = []
    for _, _, rows in _TABLE.findall(path.read_text(errors="replace")):
        words = [line.split() for line in rows.splitlines() if len(line.split()) == 4]
        found.append({int(word[0]): np.array(word[1:4], float) for word in words})
    return found


def computed(deck: Path, folder: Path) -> Path | None:
    """What CalculiX prints of all displacements of a deck; None if it fails."""
    text = deck.read_text(errors="replace")
    everything = "*NSET, NSET=EVERYTHING, GENERATE\n1, 999999\n"
    text = re.sub(r"(?im)^\*STEP", f"{everything}*STEP", text, count=1)
    text = re.sub(r"(?im)^\*(NODE|EL|CONTACT) (PRINT|FILE)[^*]*", "", text)
    text = re.sub(r"(?im)^\*END STEP", "*NODE PRINT, NSET=EVERYTHING\nU\n*END STEP", text)
    (folder / deck.name).write_text(text)
    subprocess.run(["ccx", deck.stem], cwd=folder, capture_output=True, timeout=300, check=False)
    found = folder / f"{deck.stem}.dat"
    return found if found.is_file() and references(found) else None


def compare(deck: Path, reference: Path) -> tuple[float, float, int]:
    """Largest difference, largest displacement and number of nodes of the last table; seconds are the caller's."""
    solution = sg.solve(load(deck, small_strain=True).model)
    table = references(reference)[-1]
    row = {int(number): i for i, number in enumerate(solution.model.mesh.labels)}
    nodes = [number for number in table if number in row]
    computed = solution.last.displacement[[row[number] for number in nodes]]
    printed = np.array([table[number] for number in nodes])[:, : computed.shape[1]]
    return float(np.abs(computed - printed).max()), float(np.abs(printed).max()), len(nodes)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--ccx", action="store_true", help="let CalculiX compute the references")
    parser.add_argument("names", nargs="*", help="decks without .inp (default: all in the folder)")
    options = parser.parse_args()
    decks = [options.folder / f"{name}.inp" for name in options.names] or sorted(options.folder.glob("*.inp"))
    refused: Counter[str] = Counter()
    aside = tempfile.TemporaryDirectory()
    print(f"{'deck':24s} {'nodes':>6s} {'largest':>12s} {'difference':>12s} {'relative':>9s} {'s':>6s}")
    for deck in decks:
        printed = (deck.with_suffix(".dat.ref"), deck.with_suffix(".dat"))
        reference = next((path for path in printed if path.is_file()), None)
        if options.ccx:
            reference = computed(deck, Path(aside.name))
        started = time.perf_counter()
        try:
            if reference is None or not references(reference):
                load(deck, small_strain=True)
                refused["read, but no printed displacements to compare with"] += 1
                continue
            apart, size, nodes = compare(deck, reference)
        except (sg.InputError, sg.SolveFailed) as error:
            words = re.sub(r"^.*?\.inp:(\d+: )? ?", "", str(error))
            refused[words if options.names else re.sub(r"'[^']*'|[-\d.]+", "...", words)[:90]] += 1
            continue
        seconds = time.perf_counter() - started
        print(
            f"{deck.stem:24s} {nodes:6d} {size:12.5e} {apart:12.5e} {apart / size if size else 0:9.1e} {seconds:6.2f}"
        )
    print("\nnot compared:")
    for words, count in refused.most_common(40):
        print(f"{count:5d}  {words}")


if __name__ == "__main__":
    main()
