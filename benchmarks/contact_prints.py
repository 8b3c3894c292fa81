# SPDX-License-Identifier: BSD-3-Clause
"""What both programs print of contact, row by row: tables of ``.dat`` and the field CONTACT of ``.frd``.

    python -m benchmarks.contact_prints [FOLDER NAME...] [--write docs/inp.md]

CalculiX (``ccx``) and this package compute the same decks in the increments of the deck, without large displacements:
two blocks of this script, pressed and dragged along both tangents, with the normal along every axis either way (the
worst of six), and decks NAME.inp of FOLDER, such as the folder ``test`` of the CalculiX repository; nothing is fetched.
One parser reads both programs' files by CalculiX's headings. A difference is the largest in a table, as a part of the
largest number of its kind there (openings, tangential displacements, pressures, shear stresses, forces, energies).
CalculiX smooths the springs of its contact where they begin to act, by a stress that decks give: "sharp" is the
difference with next to none of it. With ``--write`` the table replaces the one in a document.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks import command, page
from benchmarks.decks import fields, plain
from signorini.cli import main as run_here

_SECONDS = 300  # for CalculiX

# heading, what it is called here, kinds of its columns
_TABLES = (
    ("relative contact displacement", "CDIS", ("opening", "tangential", "tangential")),
    ("contact stress", "CSTR", ("pressure", "shear", "shear")),
    ("contact spring energy", "CELS", ("energy",)),
)
_SUMS = {"total CELS": ("energy",), "CF": ("force",) * 3, "area": ("area",)}
_CONTACT = ("opening", "tangential", "tangential", "pressure", "shear", "shear")
_WAYS = ("NODE TO SURFACE", "SURFACE TO SURFACE")
_SHARP = 1e-9  # stress of the smoothing
_WHY = {
    "blocks, node to surface": "springs of nodes turn with the deformed faces: falls with the load",
    "friction1": "contact follows the displaced sides there, springs stiffen: goes with the load, see above",
    **dict.fromkeys(("friction2", "friction3"), "equilibrium asks for a mean pressure of 100: 99.98 there"),
    "contactenergy": "points of faces there, nodes here: the total",
    "contact5": "contact of coarse quadratic faces",
}
_EXTRAPOLATED = "extrapolated from points of the faces there, at nodes here"

Rows = dict[int, NDArray[np.float64]]


def blocks(axis: int, sign: int, way: str) -> str:
    """Two cubes with friction, the upper one pressed along an axis, then dragged along both others."""
    grid = np.array([[i, j, k] for k in range(3) for j in range(3) for i in range(3)]) / 2.0
    corners = np.array([0, 1, 4, 3, 9, 10, 13, 12])
    cells = np.array([corners + i + 3 * j + 9 * k for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    turn = np.roll(np.eye(3), axis + 1, axis=0)  # z becomes the axis
    turn = turn * sign if sign < 0 else turn
    if np.linalg.det(turn) < 0:
        turn[:, 0] *= -1.0
    lines = ["*NODE, NSET=NALL"]
    for first, height in ((1, 0.0), (101, 1.0)):
        places = (grid + [0.0, 0.0, height]) @ turn.T
        lines += [f"{first + n}, {x:.6f}, {y:.6f}, {z:.6f}" for n, (x, y, z) in enumerate(places)]
    for name, first, number in (("LOW", 1, 1), ("UP", 101, 11)):
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET={name}")
        lines += [f"{number + e}, {', '.join(map(str, first + cell))}" for e, cell in enumerate(cells)]
    along = np.abs(turn).argmax(axis=0) + 1
    press, drag = -2.0e-6 * turn[along[2] - 1, 2], [8.0e-6 * turn[along[i] - 1, i] for i in (0, 1)]
    law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2.E6, 1.E-5\n*FRICTION\n0.3, 4.E5"
    steps = [[(along[2], press), (along[0], 0.0), (along[1], 0.0)], [(along[0], drag[0]), (along[1], 0.5 * drag[1])]]
    lines += [
        "*NSET, NSET=BASE, GENERATE\n1, 9\n*NSET, NSET=TOP, GENERATE\n119, 127",
        "*SURFACE, NAME=SLAVE\n11, S1\n12, S1\n13, S1\n14, S1\n*SURFACE, NAME=MASTER\n5, S2\n6, S2\n7, S2\n8, S2",
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=LOW, MATERIAL=M",
        f"*SOLID SECTION, ELSET=UP, MATERIAL=M\n*SURFACE INTERACTION, NAME=RUB\n{law}",
        f"*CONTACT PAIR, INTERACTION=RUB, TYPE={way}\nSLAVE, MASTER\n*BOUNDARY\nBASE, 1, 3",
    ]
    forces = "*CONTACT PRINT, SLAVE=SLAVE, MASTER=MASTER\nCF\n" if way == "SURFACE TO SURFACE" else ""
    for moves in steps:
        lines.append("*STEP, INC=1000\n*STATIC, DIRECT\n0.05, 1.\n*BOUNDARY")
        lines += [f"TOP, {direction}, {direction}, {value:.10f}" for direction, value in moves]
        lines.append(f"*CONTACT PRINT, FREQUENCY=1000\nCDIS, CSTR\n{forces}*CONTACT FILE\nCDIS, CSTR\n*END STEP")
    return "\n".join(lines) + "\n"


def plates() -> str:
    """Two plates of different thickness in plane stress, pressed and dragged.

    Without contraction: CalculiX's plane elements are solids of that thickness, which would rub across the plane too.
    """
    across = 4
    lines, top = ["*NODE, NSET=NALL"], 1001 + 2 * (across + 1)
    for first, height in ((1, 0.0), (1001, 1.0)):
        places = [(2.0 * i / across, height + 0.5 * j) for j in range(3) for i in range(across + 1)]
        lines += [f"{first + n}, {x:.6f}, {y}" for n, (x, y) in enumerate(places)]
    for name, first, number in (("LOW", 1, 1), ("UP", 1001, 1001)):
        lines.append(f"*ELEMENT, TYPE=CPS4, ELSET={name}")
        corners = [first + i + (across + 1) * j for j in (0, 1) for i in range(across)]
        lines += [f"{number + e}, {n}, {n + 1}, {n + across + 2}, {n + across + 1}" for e, n in enumerate(corners)]
    law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n2.E6, 1.E-5\n*FRICTION\n0.3, 4.E5"
    lines += [
        f"*NSET, NSET=BASE, GENERATE\n1, {across + 1}\n*NSET, NSET=TOP, GENERATE\n{top}, {top + across}",
        *("*SURFACE, NAME=SLAVE", *(f"{1001 + e}, S1" for e in range(across))),
        *("*SURFACE, NAME=MASTER", *(f"{1 + across + e}, S3" for e in range(across))),
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=LOW, MATERIAL=M\n2.",
        f"*SOLID SECTION, ELSET=UP, MATERIAL=M\n0.5\n*SURFACE INTERACTION, NAME=RUB\n{law}",
        "*CONTACT PAIR, INTERACTION=RUB, TYPE=SURFACE TO SURFACE\nSLAVE, MASTER\n*BOUNDARY\nBASE, 1, 2",
    ]
    for moves in ("TOP, 1\nTOP, 2, 2, -2.E-6", "TOP, 1, 1, 8.E-6"):
        asked = "*CONTACT PRINT, FREQUENCY=1000, SLAVE=SLAVE, MASTER=MASTER\nCF\n*END STEP"
        lines.append(f"*STEP, INC=1000\n*STATIC, DIRECT\n0.05, 1.\n*BOUNDARY\n{moves}\n{asked}")
    return "\n".join(lines) + "\n"


def sharp(text: str) -> str:
    """A deck whose springs of contact begin to act at once."""
    return re.sub(r"(?im)^(\*SURFACE *BEHAVIOR[^\n]*LINEAR[^\n]*\n *[-\d.EeDd+]+)[^\n]*", rf"\1, {_SHARP:.0E}", text)


def printed(path: Path) -> dict[str, Rows]:
    """The last table of every kind: nodal ones by node (not those of faces), forces as row 1, total energy as row 0."""
    text = path.read_text(errors="replace")
    found: dict[str, Rows] = {}
    for heading, name, _ in _TABLES:
        for rows in re.findall(rf"\n {heading} \(slave node[^\n]*\n\s*\n((?: +[-\d][^\n]*\n?)+)", text):
            words = [line.split() for line in rows.splitlines()]
            found[name] = {int(word[0]): np.array(word[1:], float) for word in words}
    for total in re.findall(r"\n total contact spring energy [^\n]*\n\s*\n([^\n]*)", text):
        found["total CELS"] = {0: np.array([float(total)])}
    for force in re.findall(r"\n   total surface force [^\n]*\n\s*\n([^\n]*)", text):
        found["CF"] = {1: np.array(force.split(), float)[:3]}
    for sizes in re.findall(r"\n   area, [^\n]*\n\s*\n([^\n]*)", text):
        found["area"] = {1: np.array(sizes.split(), float)[:1]}
    return found


def field(path: Path) -> Rows:
    """The last field CONTACT of a ``.frd`` file."""
    return (fields(path, "CONTACT", 6) or [{}])[-1]


def apart(here: Rows, there: Rows, kinds: tuple[str, ...]) -> float:
    """Largest difference of the rows that both have, as a part of the largest number of its kind."""
    nodes = [node for node in there if node in here]
    one, two = (np.array([rows[node] for node in nodes]) for rows in (here, there))
    worst = 0.0
    for kind in dict.fromkeys(kinds):
        own = [i for i, name in enumerate(kinds) if name == kind]
        size = float(np.abs(two[:, own]).max())
        if size > 0.0:
            worst = max(worst, float(np.abs(one[:, own] - two[:, own]).max()) / size)
    return worst


def compare(name: str, text: str, folder: Path) -> Iterator[tuple[str, int, float]]:
    """Table, rows and difference of everything that both programs print."""
    (folder / "deck.inp").write_text(text)
    done = subprocess.run(["ccx", "deck"], cwd=folder, capture_output=True, timeout=_SECONDS, check=False, text=True)
    if "Job finished" not in done.stdout:
        raise RuntimeError(f"{name}: CalculiX did not finish: {done.stdout[-300:]}")
    words = ["run", str(folder / "deck.inp"), "-o", str(folder / "out"), "--increments", "deck", "--quiet"]
    if run_here(words):
        raise RuntimeError(f"{name}: this package did not finish")
    there, here = printed(folder / "deck.dat"), printed(folder / "out" / "solution.dat")
    kinds = {name: columns for _, name, columns in _TABLES} | _SUMS
    for table in there:
        if table in here:
            yield table, len(there[table]), apart(here[table], there[table], kinds[table])
    contact = field(folder / "deck.frd") if "*CONTACT FILE" in text else {}
    if contact:
        touching = {node: row for node, row in contact.items() if row.any()}
        yield "CONTACT (.frd)", len(touching), apart(field(folder / "out" / "solution.frd"), touching, _CONTACT)


def document(found: list[tuple[str, str, int, float, float]]) -> str:
    """The table for a document."""
    head = "| deck | table | rows | difference | sharp | |\n|---|---|---|---|---|---|\n"
    return head + "".join(
        f"| {name} | {table} | {rows} | {difference:.1e} | {least:.1e} | {remark(name, table)} |\n"
        for name, table, rows, difference, least in found
    )


def remark(name: str, table: str) -> str:
    if "surface to surface" in name and table.startswith("CONTACT"):
        return _EXTRAPOLATED
    return _WHY.get(name, "")


def main() -> None:
    parser = command.parser(__doc__, write=True)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("names", nargs="*", help="decks in it, without .inp")
    options = parser.parse_args()
    if not shutil.which("ccx"):
        parser.error("there is no ccx; expected CalculiX on the path")
    sides = [(axis, sign) for axis in range(3) for sign in (1, -1)]
    decks = [(f"blocks, {way.lower()}", [blocks(*side, way) for side in sides]) for way in _WAYS]
    decks.append(("plates of thickness 2 and 0.5", [plates()]))
    decks += [(name, [plain((options.folder / f"{name}.inp").read_text())]) for name in options.names]
    found = []
    for title, texts in decks:
        worst: dict[str, tuple[int, float, float]] = {}
        for text in texts:
            with tempfile.TemporaryDirectory() as folder:
                given = list(compare(title, text, Path(folder)))
                least = compare(title, sharp(text), Path(folder))
                for (table, rows, difference), (_, _, left) in zip(given, least, strict=True):
                    before = worst.get(table, (rows, 0.0, 0.0))
                    worst[table] = rows, max(before[1], difference), max(before[2], left)
        for table, numbers in worst.items():
            found.append((title, table, *numbers))
            print("{:30s} {:15s} {:5d} {:9.1e} {:9.1e}".format(*found[-1]), flush=True)
    if options.write:
        page.write("contact prints", document(found), options.write)


if __name__ == "__main__":
    main()
