# SPDX-License-Identifier: BSD-3-Clause
"""The walk through the house: which files a run of a deck visits, from its text to its results.

python -m benchmarks.walk [DECK] [--chain] [--write docs/design.md]

A file is visited where one of its functions runs; what only importing runs is left out, and so is compiled code. With
``--chain`` every room is printed with its files in the order of their first visit. ``PYTHONPATH`` chooses the package:
an older one can be counted by the same script. With ``--write`` the numbers replace those in a document.
"""

from __future__ import annotations

import contextlib
import io
import sys
import tempfile
from pathlib import Path
from types import FrameType

from benchmarks import command, page

EXAMPLE = Path(__file__).parents[1] / "examples" / "zhu_cylinder.toml"


def visited(deck: Path) -> dict[str, list[str]]:
    """Files of the package that a run of a deck visits, each with its functions, in the order of their first visit."""
    import signorini
    from signorini.cli.main import main

    root = Path(signorini.__file__).parent
    found: dict[str, list[str]] = {}

    def look(frame: FrameType, event: str, _argument: object) -> None:
        path, name = frame.f_code.co_filename, frame.f_code.co_name
        if event == "call" and not name.startswith("<") and path.startswith(str(root)):
            names = found.setdefault(str(Path(path).relative_to(root).with_suffix("")), [])
            if name not in names:
                names.append(name)

    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        main(["run", str(deck), "-o", f"{folder}/once"])  # imports, and compiles where that was never done
        sys.setprofile(look)
        try:
            main(["run", str(deck), "-o", f"{folder}/again"])
        finally:
            sys.setprofile(None)
    return found


def told(found: dict[str, list[str]], *, chain: bool) -> str:
    """The numbers in a sentence; with the chain, a line a room."""
    rooms: dict[str, list[str]] = {}
    for file in found:
        room, _, name = file.partition("/")
        rooms.setdefault(room, []).append(name or room)
    words = f"{sum(map(len, found.values()))} functions in {len(found)} files of {len(rooms)} rooms"
    lines = [f"{room}: {', '.join(names)}" for room, names in rooms.items()]
    return "\n".join([*(lines if chain else ()), words])


def main_walk() -> None:
    """Count, and print."""
    parser = command.parser(__doc__, write=True)
    parser.add_argument("deck", nargs="?", type=Path, default=EXAMPLE)
    parser.add_argument("--chain", action="store_true", help="print the files of every room too")
    options = parser.parse_args()
    found = visited(options.deck)
    print(told(found, chain=options.chain))
    if options.write:
        page.write("walk", f"`{options.deck.name}`: {told(found, chain=False)}.", options.write)


if __name__ == "__main__":
    main_walk()
