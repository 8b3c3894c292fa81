# SPDX-License-Identifier: BSD-3-Clause
"""A small cube pressed onto a larger one, as in CalculiX's deck contact4, on finer and finer meshes: both programs.

    python benchmarks/stamp.py [--write docs/inp.md]

Needs ``ccx``. The deck has one element a cube; there the two discretisations of contact differ by percents, and so do
both from the limit. The last columns are the mean displacements of the loaded face.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from decks import by_calculix

import signorini as sg

_FAMILIES = {"C3D8": "hexahedron", "C3D20": "hexahedron20"}
_BEGIN, _END = "<!-- stamp -->\n", "<!-- end of stamp -->\n"


def stamp(kind: str, n: int) -> str:
    """A deck: cubes of n elements along each edge, no friction, stiff springs in CalculiX."""
    grid, family = np.linspace(0.0, 1.0, n + 1), _FAMILIES[kind]
    low = sg.box(x=grid, y=grid, z=grid, cells=family)
    high = sg.box(x=0.25 + grid / 2, y=0.25 + grid / 2, z=1.0 + grid / 2, cells=family)
    mesh = sg.join({"low": low, "high": high})
    points, cells = mesh.points, mesh.cells[family]
    height = points[cells].mean(axis=1)[:, 2]
    own = np.arange(len(cells)) < len(cells) // 2
    sets = {
        "LOWTOP": own & (height > 1.0 - 1.0 / n),
        "HIGHBOTTOM": ~own & (height < 1.0 + 0.5 / n),
        "HIGHTOP": ~own & (height > 1.5 - 0.5 / n),
    }
    lines = ["*NODE", *(f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(points, start=1))]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=ALL"]
    for number, nodes in enumerate((cells + 1).tolist(), start=1):
        words = [str(word) for word in (number, *nodes)]
        lines += [", ".join(words[start : start + 11]) + "," for start in range(0, len(words), 11)]
        lines[-1] = lines[-1].rstrip(",")
    for name, there in (("BASE", points[:, 2] == 0.0), ("TOP", points[:, 2] == 1.5)):
        lines += [f"*NSET, NSET={name}", *(str(i + 1) for i in np.flatnonzero(there))]
    for name, there in sets.items():
        lines += [f"*ELSET, ELSET={name}", *(str(i + 1) for i in np.flatnonzero(there))]
    lines += ["*SURFACE, NAME=MASTER", "LOWTOP, S2", "*SURFACE, NAME=SLAVE", "HIGHBOTTOM, S1"]
    lines += ["*MATERIAL, NAME=EL", "*ELASTIC", "210000., 0.", "*SOLID SECTION, ELSET=ALL, MATERIAL=EL"]
    lines += [
        "*CONTACT PAIR, INTERACTION=SI, TYPE=SURFACE TO SURFACE",
        "SLAVE, MASTER",
        "*SURFACE INTERACTION, NAME=SI",
    ]
    lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1.E9, 3.", "*BOUNDARY", "BASE, 1, 3", "TOP, 1, 2"]
    lines += ["*STEP", "*STATIC", "0.5, 1.", "*DLOAD", "HIGHTOP, P2, 100.", "*END STEP", ""]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", type=Path, metavar="DOCUMENT", help="put the table between its marks")
    options = parser.parse_args()
    rows = ["| elements | along an edge | difference | signorini | CalculiX |", "|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for kind in _FAMILIES:
            for n in (1, 2, 4, 6):
                text, deck = stamp(kind, n), Path(folder, "stamp.inp")
                deck.write_text(text)
                theirs = by_calculix(text, Path(folder))
                step = sg.solve(sg.read(deck)).last
                printed = np.array([theirs[i + 1] for i in range(len(step.displacement))])
                top = sg.read(deck).mesh.nodes_of("TOP")
                apart = np.abs(step.displacement - printed).max() / np.abs(printed).max()
                means = [f"{values[top, 2].mean():.5e}" for values in (step.displacement, printed)]
                rows.append(f"| {kind} | {n} | {apart:.1e} | {' | '.join(means)} |")
                print(rows[-1], flush=True)
    if options.write:
        text = options.write.read_text()
        head, _, rest = text.partition(_BEGIN)
        options.write.write_text(head + _BEGIN + "\n".join(rows) + "\n" + _END + rest.partition(_END)[2])


if __name__ == "__main__":
    main()
