# SPDX-License-Identifier: BSD-3-Clause
"""A small cube pressed onto a larger one, as in CalculiX's deck contact4, and a ring onto a ring: finer meshes.

    python -m benchmarks.stamp [--write docs/inp.md]

Needs ``ccx``. Both programs solve the same decks. contact4 has one element a cube; there the two discretisations of
contact differ by percents, and so do both from the limit. The last columns are the mean displacements of the loaded
face.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import signorini as sg
from benchmarks import command, page
from benchmarks.decks import by_calculix

_FAMILIES = {"C3D8": "hexahedron", "C3D20": "hexahedron20", "CAX4": "quad", "CAX8": "quad8"}


def _deck(mesh: sg.Mesh, kind: str, height: int, faces: tuple[int, int, int], held: tuple[str, str], nu: float) -> str:
    """Two bodies, one on the other, no friction, stiff springs in CalculiX.

    Parameters
    ----------
    height : the axis along which they are pressed
    faces : numbers of the upper face of the lower, the lower and the upper face of the upper elements
    held : directions at the foot and at the top
    """
    ((_, cells),) = mesh.cells.items()
    points, middle = mesh.points, mesh.points[cells].mean(axis=1)[:, height]
    own = np.arange(len(cells)) < len(cells) // 2
    top = points[:, height].max()
    layers = {
        "LOWTOP": own & (middle > middle[own].max() - 1e-9),
        "HIGHBOTTOM": ~own & (middle < middle[~own].min() + 1e-9),
        "HIGHTOP": middle > middle.max() - 1e-9,
    }
    lines = ["*NODE", *(", ".join([str(i), *(f"{x:.12g}" for x in at)]) for i, at in enumerate(points, start=1))]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=ALL"]
    for number, nodes in enumerate((cells + 1).tolist(), start=1):
        words = [str(word) for word in (number, *nodes)]
        lines += [", ".join(words[start : start + 11]) + "," for start in range(0, len(words), 11)]
        lines[-1] = lines[-1].rstrip(",")
    for name, there in (("BASE", points[:, height] == 0.0), ("TOP", points[:, height] == top)):
        lines += [f"*NSET, NSET={name}", *(str(i + 1) for i in np.flatnonzero(there))]
    for name, there in layers.items():
        lines += [f"*ELSET, ELSET={name}", *(str(i + 1) for i in np.flatnonzero(there))]
    lines += ["*SURFACE, NAME=MASTER", f"LOWTOP, S{faces[0]}", "*SURFACE, NAME=SLAVE", f"HIGHBOTTOM, S{faces[1]}"]
    lines += ["*MATERIAL, NAME=EL", "*ELASTIC", f"210000., {nu}", "*SOLID SECTION, ELSET=ALL, MATERIAL=EL"]
    lines += ["*SURFACE INTERACTION, NAME=SI", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1.E9, 3."]
    lines += ["*CONTACT PAIR, INTERACTION=SI, TYPE=SURFACE TO SURFACE", "SLAVE, MASTER"]
    lines += ["*BOUNDARY", f"BASE, {held[0]}", *([f"TOP, {held[1]}"] if held[1] else [])]
    lines += ["*STEP", "*STATIC", "0.5, 1.", "*DLOAD", f"HIGHTOP, P{faces[2]}, 100.", "*END STEP", ""]
    return "\n".join(lines)


def stamp(kind: str, n: int) -> str:
    """Cubes of n elements along each edge, the upper half as large."""
    grid, family = np.linspace(0.0, 1.0, n + 1), _FAMILIES[kind]
    low = sg.box(x=grid, y=grid, z=grid, cells=family)
    high = sg.box(x=0.25 + grid / 2, y=0.25 + grid / 2, z=1.0 + grid / 2, cells=family)
    return _deck(sg.join({"low": low, "high": high}), kind, 2, (2, 1, 2), ("1, 3", "1, 2"), 0.0)


def rings(kind: str, n: int) -> str:
    """Two rings of one width on each other, n elements along each edge."""
    grid, family = np.linspace(0.0, 1.0, n + 1), _FAMILIES[kind]
    low, high = (sg.rectangle(x=1.0 + grid, y=y, cells=family) for y in (grid, 1.0 + grid / 2))
    return _deck(sg.join({"low": low, "high": high}), kind, 1, (3, 1, 3), ("1, 2", ""), 0.3)


def main() -> None:
    parser = command.parser(__doc__, write=True)
    options = parser.parse_args()
    rows = ["| elements | along an edge | difference | signorini | CalculiX |", "|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for kind in _FAMILIES:
            for n in (1, 2, 4, 6):
                text = stamp(kind, n) if kind.startswith("C3D") else rings(kind, n)
                deck = Path(folder, "stamp.inp")
                deck.write_text(text)
                theirs = by_calculix(text, Path(folder))
                step = sg.solve(sg.read(deck)).last
                d = step.displacement.shape[1]
                printed = np.array([theirs[i + 1][:d] for i in range(len(step.displacement))])
                top = sg.read(deck).mesh.nodes_of("TOP")
                apart = np.abs(step.displacement - printed).max() / np.abs(printed).max()
                means = [f"{values[top, -1].mean():.5e}" for values in (step.displacement, printed)]
                rows.append(f"| {kind} | {n} | {apart:.1e} | {' | '.join(means)} |")
                print(rows[-1], flush=True)
    if options.write:
        page.write("stamp", "\n".join(rows), options.write)


if __name__ == "__main__":
    main()
