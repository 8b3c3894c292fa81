# SPDX-License-Identifier: BSD-3-Clause
"""The CalculiX-Examples, whose meshes cgx and Gmsh make: what is solved, how far CalculiX is, and what is refused.

    python -m benchmarks.examples FOLDER [NAME...] [--write docs/inp.md]

FOLDER is a copy of the public repository calculix/CalculiX-Examples; nothing is fetched and nothing in it is changed.
Needs ``cgx`` and ``ccx``. Every example is built in a folder of its own by the scripts that come with it, less what
they draw and solve. Both programs solve the deck as it is, here always with small displacements ("large" is what
CalculiX's ``NLGEOM`` makes of it), without ``NLGEOM`` and with full integration ("small"), and so with a hundredth of
the loads ("light"): the largest difference of a displacement as a part of the largest displacement; "-" where CalculiX
finds nothing in a minute.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import signorini as sg
from benchmarks import command, page
from benchmarks.deck_text import deck_text
from benchmarks.decks import Values, by_calculix, plain, spelled
from signorini.deck import load_deck
from signorini.deck.inp.syntax import read_cards

_SECONDS = 60  # for what makes a mesh, and for each run of CalculiX
_DRAWN = re.compile(
    r"(?i) *(anim|capt|cmap|ds|font|frame|graph|hcpy|max|menu|min|minus|mm|movi|plot|plus|rot|steps|stack|text|tra|"
    r"ulin|view|zoom|quit|exit)\b| *sys +(?!echo\b)"
)
_CONSENT = "c\n" * 1000  # cgx asks before each "sys echo", which writes lists of files


@dataclass(frozen=True)
class Example:
    """A deck, how its mesh is made, and what is known of the differences."""

    deck: str
    made: tuple[str, ...]
    why: str = ""
    law: str = ""

    @property
    def name(self) -> str:
        folder = self.deck.rpartition("/")[0].rpartition("/")[2]
        return " ".join(word for word in (folder, self.deck.rpartition("/")[2], self.law) if word)


def _penalty(law: str) -> Example:
    return Example("Contact/Penalty/solve", ("cgx all.fbd", f"copy {law}.inc contact.inc"), law=law)


_SEAT = "coarse quadratic edges on the cone of the seat, less with smaller ones"
_WEDGES = "CalculiX makes wedges with few points of integration of triangles"

EXAMPLES = (
    Example("Linear/StressConc/Stress", ("param par.pre.fbl", "cgx pre.fbl"), _WEDGES),
    Example("Linear/StressConc1/Stress", ("param par.run.fbl", "cgx run.fbl"), _WEDGES),
    Example("Linear/BiaxBending/Biegung", ("param par.run.fbl", "cgx run.fbl")),
    Example("Linear/PSE/solve", ("param par.run.fbl", "cgx run.fbl")),
    Example("Linear/Plates/plates", ("cgx pre.fbd",), f"{_WEDGES}: CAX3, CAX6"),
    Example("Streifen/sck", ("cgx sck.fbd",)),
    Example("Contact/Valve/valve", ("param par.pre.fbd", "cgx pre.fbd"), _SEAT),
    Example("Contact/Hertz_axi/Hertz", ("cgx pre.fbd",), "the sphere is held by contact alone: CalculiX diverges"),
    Example(
        "Contact/Hertz_2D/Hertz", ("cgx pre.fbd",), "8 nodes of quadratic edges touch, at a hundredth of the load 2"
    ),
    Example("Contact/Tubes/solve", ("cgx pre.fbd",)),
    Example("Contact/Leafspring/solve", ("cgx pre.fbd",)),
    *(_penalty(law) for law in ("s2s-lin", "s2s-tie", "n2s-lin", "n2s-exp", "n2s-tab")),
    Example("Linear/StressConc1/Stress1", ("param par.run1.fbl", "cgx run1.fbl")),
    Example("NonLinear/Bolt/thermal", ("gmsh Bolt.geo", "cgx pre.fbd")),
    Example("Contact/Eyebar/eyebar", ("param par.eyebar.fbd", "cgx eyebar.fbd")),
    Example("Contact/Shell1/tie", ("cgx pre.fbd",)),
    Example("NonLinear/3PB/Biegung", ("param par.pre.fbl", "cgx pre.fbl")),
    Example("NonLinear/Cut/solve", ("param par.pre.fbd", "cgx pre.fbd")),
    Example("NonLinear/Sandwichtest/Biegung", ("cgx pre.fbl",)),
    Example("Drahtbiegen/Biegung/Biegung", ("cgx pre.fbd",)),
    Example("Streifen/b", ("cgx b.fbd",)),
)


def build(example: Example, source: Path, folder: Path) -> Path:
    """Copy an example and make its mesh; its deck."""
    home = folder / example.name
    shutil.copytree((source / example.deck).parent, home)
    makers: Mapping[str, Callable[[Path, list[str]], None]] = {
        "param": _expand, "cgx": _generate, "gmsh": _mesh, "copy": _copy
    }  # fmt: skip
    for step in example.made:
        command, *names = step.split()
        makers[command](home, names)
    for path in home.glob("*.sur"):
        text = path.read_text()
        if not re.search(r"(?im)^ *\*SURFACE", text):  # cgx before 2.18 leaves it to whoever includes the file
            path.write_text(f"*SURFACE, NAME=S{path.stem}\n{text}")
    return home / f"{example.deck.rpartition('/')[2]}.inp"


def _expand(home: Path, names: list[str]) -> None:
    """``<name=expression>`` and ``<expression>`` in a file ``par.NAME`` become values in the file ``NAME``."""
    known = {name: getattr(math, name) for name in dir(math) if name[0] != "_"} | {"int": int, "abs": abs}

    def value(found: re.Match[str]) -> str:
        name, equal, expression = found[1].rpartition("=")
        result = eval(expression.strip(), {"__builtins__": {}}, known)  # arithmetic
        if equal:
            known[name.strip()] = result
        return found[1] if equal else str(result)

    for name in names:
        text = (home / name).read_text(errors="replace")
        (home / name.removeprefix("par.")).write_text(re.sub(r"<([^<>\n]*)>", value, text))


def _generate(home: Path, names: list[str]) -> None:
    for name in names:
        lines = (home / name).read_text(errors="replace").splitlines()
        script = home / f"less_{name}"
        script.write_text("\n".join([*(line for line in lines if not _DRAWN.match(line)), ""]))
        _run(["cgx", "-bg", script.name], home)


def _mesh(home: Path, names: list[str]) -> None:
    gmsh = shutil.which("gmsh", path=str(Path(sys.executable).parent)) or "gmsh"
    for name in names:  # with the options in the file itself, as its own script does
        _run([sys.executable, gmsh, "-3", "-format", "inp", "-o", f"{Path(name).stem}-gmsh.inp", name], home)


def _copy(home: Path, names: list[str]) -> None:
    shutil.copy(home / names[0], home / names[1])


def _run(command: list[str], home: Path) -> None:
    """What is missing afterwards is said by whoever reads the deck."""
    subprocess.run(command, cwd=home, capture_output=True, timeout=_SECONDS, input=_CONSENT.encode(), check=False)


def apart(solution: sg.Solution, values: Values) -> float | None:
    """Largest difference of the displacements, as a part of the largest; None without values."""
    row = {int(number): i for i, number in enumerate(solution.model.mesh.labels)}
    nodes = [number for number in values if number in row]
    if not nodes:
        return None
    ours = solution.last.displacement[[row[number] for number in nodes]]
    theirs = np.array([values[number] for number in nodes])[:, : ours.shape[1]]
    return float(np.abs(ours - theirs).max() / np.abs(theirs).max())


def compared(deck: Path, folder: Path) -> list[str]:
    """Nodes and the three differences."""
    solution = sg.solve(load_deck(deck, small_strain=True).model)
    cards = read_cards(deck)
    text = deck_text(cards)
    found = [str(len(solution.model.mesh.points))]
    found.append(spelled(apart(solution, by_calculix(text, folder, _SECONDS)) if "NLGEOM" in text.upper() else None))
    for share in (1.0, 0.01):
        small = plain(deck_text(cards, share=share))
        own = folder / "own.inp"
        own.write_text(small)
        values = by_calculix(small, folder, _SECONDS)
        found.append(spelled(apart(sg.solve(load_deck(own, small_strain=True).model), values) if values else None))
    return found


def main() -> None:
    parser = command.parser(__doc__, write=True)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="examples (default: all)")
    options = parser.parse_args()
    for program in ("cgx", "ccx"):
        if not shutil.which(program):
            parser.error(f"there is no {program} on the path")
    solved = ["| example | nodes | large | small | light | what is left, and why |", "|---|---|---|---|---|---|"]
    refused = ["| example | refused |", "|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for example in EXAMPLES:
            if options.names and example.name not in options.names:
                continue
            deck = build(example, options.folder, Path(folder))
            try:
                solved.append(f"| {' | '.join([example.name, *compared(deck, Path(folder)), example.why])} |")
                print(solved[-1], flush=True)
            except (sg.InputError, sg.SolveFailed) as error:
                words = str(error).replace(f"{deck.parent}/", "").replace("|", "/")
                refused.append(f"| {example.name} | {words} |")
                print(refused[-1], flush=True)
    if options.write:
        tables = "\n".join([*solved, "", *refused, ""])
        page.write("examples", tables, options.write)


if __name__ == "__main__":
    main()
