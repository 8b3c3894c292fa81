# SPDX-License-Identifier: BSD-3-Clause
"""Public CalculiX decks against what CalculiX printed for them, and where the differences come from.

    python -m benchmarks.decks FOLDER [NAME...] [--ccx] [--write docs/inp.md]

FOLDER holds decks (``NAME.inp``) and what CalculiX printed for them (``NAME.dat.ref`` or ``NAME.frd.ref``), such as the
folder ``test`` of the CalculiX repository; nothing is fetched. Every deck that this package can solve is solved with
small strains, and the displacements of the last table are compared node by node: the largest difference, as a part of
the largest displacement in it.

With ``--large`` pairs of decks with ``NLGEOM`` follow the bodies. With ``--ccx`` CalculiX takes each difference apart:
it computes the deck again without ``NLGEOM`` and with elements that are integrated fully, as this package has them
("small"), and so with springs of the contacts a hundred times stiffer ("stiff"); this package solves the very same
texts. What is left in the last column is neither large displacements nor penalty. With ``--write`` the table replaces
the one in a document.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import signorini as sg
from benchmarks import command, page
from signorini.deck import load_deck

_TABLE = re.compile(r"displacements \(vx,vy,vz\) for set (\S+) and time +(\S+)\s*\n\s*\n((?:[ \d].*\n?)+)")
_SECONDS = 300  # for CalculiX
_STIFFER = 100.0

_LARGE = "large displacements"
_COARSE = "contact of coarse quadratic faces: see the stamp below"
_WEDGE = "CalculiX takes a wedge of 2 degrees for the ring: 1 - cos 1 degree = 1.5e-4"
_FOLLOWS = "contact that follows the displaced sides, soft springs: goes with the load, see below"
_WHY = {
    **dict.fromkeys(("contact4", "contact4_mortar", "contact5", "cubes", "cubesmortar", "cubesmortar2"), _COARSE),
    **dict.fromkeys(("contact13", "contact14"), f"{_LARGE}; {_COARSE}"),
    **dict.fromkeys(("ring1", "ring2"), f"{_LARGE}; {_WEDGE}"),
    **dict.fromkeys(("cubespring", "friction1"), _FOLLOWS),
    "contact2": f"{_LARGE} alone",
    "fricloop": "increments of CalculiX: pairs lag behind by one, see [there](#large-displacements)",
    "punch1": "a curved punch of 3 x 3 quadratic faces that touches a few nodes: far from finer meshes in both",
    "plate": "reduced integration; one quadratic edge in contact",
    "thread": "quadratic edges in contact and tied, of which one ends inside another; not taken apart further",
    "beamcontact": "curved sides of coarse quadratic and linear faces: goes with their size, see below",
}
"""What is known of the differences, from the columns and from finer meshes."""

Values = dict[int, NDArray[np.float64]]


@dataclass
class Compared:
    """One deck: parts of the largest displacement, None where there is nothing to compare."""

    name: str
    nodes: int
    printed: float | None
    small: float | None = None
    stiff: float | None = None


def tables(path: Path) -> list[Values]:
    """Displacements by node number of every table in a ``.dat`` file."""
    found = []
    for _, _, rows in _TABLE.findall(path.read_text(errors="replace")):
        words = [line.split() for line in rows.splitlines() if len(line.split()) == 4]
        found.append({int(word[0]): np.array(word[1:4], float) for word in words})
    return found


def fields(path: Path, name: str = "DISP", width: int = 3) -> list[Values]:
    """The same of every field of a name in a ``.frd`` file, so many numbers a node."""
    found: list[Values] = []
    inside = False
    for line in path.read_text(errors="replace").splitlines():
        if line.startswith(" -4"):
            inside = line.split()[1] == name
            if inside:
                found.append({})
        elif inside and line.startswith(" -1"):
            found[-1][int(line[3:13])] = np.array([line[13 + 12 * i : 25 + 12 * i] for i in range(width)], float)
        elif line.startswith(" -3"):
            inside = False
    return found


def reference(deck: Path) -> Values:
    """What was printed last for a deck."""
    for suffix, read in ((".dat.ref", tables), (".dat", tables), (".frd.ref", fields)):
        path = deck.with_suffix(suffix)
        found = read(path) if path.is_file() else []
        if found and found[-1]:
            return found[-1]
    return {}


def plain(text: str) -> str:
    """A deck without ``NLGEOM`` and without reduced integration."""
    text = re.sub(r"(?im)^(\*ELEMENT[^\n]*TYPE *= *[A-Z0-9]*?)R(?=\s*(,|$))", r"\1", text)
    return re.sub(r"(?im)^(\*STEP[^\n]*?), *NLGEOM(=[A-Z]+)?", r"\1", text)


def stiffer(text: str) -> str:
    """A deck whose contacts have stiffer springs; hard ones, which CalculiX has as springs too, get some."""
    modulus = max((float(m) for m in re.findall(r"(?im)^\*ELASTIC[^\n]*\n *([\d.EeDd+]+)", text)), default=1e5)

    def more(found: re.Match[str]) -> str:
        slope, rest = float(found[2].upper().replace("D", "E")), found[3]
        return f"{found[1]}{_STIFFER * slope:.4E}{rest}"

    text = re.sub(r"(?im)^(\*SURFACE *BEHAVIOR[^\n]*LINEAR[^\n]*\n *)([-\d.EeDd+]+)([^\n]*)", more, text)
    hard = rf"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{_STIFFER * 50.0 * modulus:.4E}, 3."
    return re.sub(r"(?im)^\*SURFACE *BEHAVIOR[^\n]*HARD[^\n]*", hard, text)


def by_calculix(text: str, folder: Path, seconds: float = _SECONDS) -> Values:
    """What CalculiX finds at the end of a deck; nothing if it fails or takes longer."""
    everything = "*NSET, NSET=EVERYTHING, GENERATE\n1, 999999\n"
    text = re.sub(r"(?im)^\*STEP", f"{everything}*STEP", text, count=1)
    text = re.sub(r"(?im)^\*(NODE|EL|CONTACT) *(PRINT|FILE)[^*]*", "", text)
    text = re.sub(
        r"(?im)^\*END *STEP", "*NODE PRINT, NSET=EVERYTHING, FREQUENCY=100000, GLOBAL=YES\nU\n*END STEP", text
    )
    (folder / "deck.inp").write_text(text)
    (folder / "deck.dat").unlink(missing_ok=True)
    try:
        done = subprocess.run(["ccx", "deck"], cwd=folder, capture_output=True, timeout=seconds, check=False, text=True)
    except subprocess.TimeoutExpired:
        return {}
    printed = folder / "deck.dat"
    found = tables(printed) if printed.is_file() and "Job finished" in done.stdout else []
    return found[-1] if found else {}


def apart(deck: Path, values: Values, *, large: bool = False) -> float | None:
    """Largest difference of the displacements, as a part of the largest; None without a reference."""
    solution = sg.solve(load_deck(deck, small_strain=not large).model)
    row = {int(number): i for i, number in enumerate(solution.model.mesh.labels)}
    nodes = [number for number in values if number in row]
    if not nodes:
        return None
    computed = solution.last.displacement[[row[number] for number in nodes]]
    printed = np.array([values[number] for number in nodes])[:, : computed.shape[1]]
    size = float(np.abs(printed).max())
    return float(np.abs(computed - printed).max()) / size if size else None


def compare(deck: Path, folder: Path, *, ccx: bool, large: bool = False) -> Compared | None:
    """All comparisons of a deck; None if there is none."""
    printed, text = reference(deck), deck.read_text(errors="replace")
    if not printed and not ccx:
        load_deck(deck, small_strain=not large)
        return None
    found = Compared(deck.stem, len(printed), apart(deck, printed, large=large) if printed else None)
    if ccx:
        small = plain(text)
        for key, changed in (("small", small), ("stiff", stiffer(small))):
            copy = folder / deck.name
            copy.write_text(changed)
            values = by_calculix(changed, folder)
            setattr(found, key, apart(copy, values) if values else None)
            found.nodes = found.nodes or len(values)
    return found


def spelled(value: float | None) -> str:
    return "-" if value is None else f"{value:.1e}"


def document(rows: list[Compared]) -> str:
    """The table for a document."""
    head = "| deck | nodes | printed | small | stiff | what is left, and why |\n|---|---|---|---|---|---|\n"
    lines = [
        f"| {row.name} | {row.nodes} | {spelled(row.printed)} | {spelled(row.small)} | {spelled(row.stiff)} | "
        f"{_WHY.get(row.name, '')} |\n"
        for row in rows
    ]
    return head + "".join(lines)


def main() -> None:
    parser = command.parser(__doc__, write=True)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="decks without .inp (default: all in the folder)")
    parser.add_argument("--ccx", action="store_true", help="let CalculiX take the differences apart")
    parser.add_argument("--large", action="store_true", help="pairs follow the bodies where a deck has NLGEOM")
    options = parser.parse_args()
    if options.ccx and not shutil.which("ccx"):
        parser.error("there is no ccx; expected CalculiX on the path")
    decks = [options.folder / f"{name}.inp" for name in options.names] or sorted(options.folder.glob("*.inp"))
    refused: Counter[str] = Counter()
    rows: list[Compared] = []
    print(f"{'deck':20s} {'nodes':>6s} {'printed':>9s} {'small':>9s} {'stiff':>9s} {'s':>7s}")
    with tempfile.TemporaryDirectory() as folder:
        for deck in decks:
            started = time.perf_counter()
            try:
                row = compare(deck, Path(folder), ccx=options.ccx, large=options.large)
            except (sg.InputError, sg.SolveFailed) as error:
                words = re.sub(r"^.*?\.inp:(\d+: )? ?", "", str(error))
                refused[
                    f"{deck.stem}: {words}" if options.names else re.sub(r"'[^']*'|[-\d.]+", "...", words)[:90]
                ] += 1
                continue
            if row is None:
                refused["read, but no printed displacements to compare with"] += 1
                continue
            rows.append(row)
            seconds = time.perf_counter() - started
            print(
                f"{row.name:20s} {row.nodes:6d} {spelled(row.printed):>9s} {spelled(row.small):>9s} "
                f"{spelled(row.stiff):>9s} {seconds:7.2f}",
                flush=True,
            )
    print("\nnot compared:")
    for words, count in refused.most_common(60):
        print(f"{count:5d}  {words}")
    if options.write:
        page.write("public decks", document(rows), options.write)


if __name__ == "__main__":
    main()
