# SPDX-License-Identifier: BSD-3-Clause
"""Public CalculiX decks of bodies that yield: what stops each, and how far CalculiX is from those that are read.

    python -m benchmarks.plastic_decks FOLDER [--write docs/inp.md]

FOLDER is the folder ``test`` of the CalculiX repository; nothing is fetched. Both programs solve every deck that has
``*PLASTIC`` and is read without ``NLGEOM`` and with full integration: the largest difference of a displacement at its
end as a part of the largest displacement; "-" where CalculiX finds nothing.

metalforming is also taken with springs that pull by a thousandth of what those of the deck do where its sides are
apart, and so with a die that comes down until its sheet yields.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import signorini as sg
from benchmarks import command, page
from benchmarks.decks import apart, by_calculix, plain, spelled
from signorini.deck import load_deck

_KINEMATIC = "CalculiX 2.20 has kinematic hardening with NLGEOM alone"
_SHARP, _FAR = "metalforming, sharp springs", "the same, the die 100 times as far"
_PULLS = "nothing yields; CalculiX's springs pull by up to 1 where sides are apart, the largest pressure is 0.05"
_WHY = {
    "metalforming": _PULLS,
    _SHARP: "not taken apart further",
    _FAR: "yields at its axis, to a plastic strain of 5.5 %; contact as before",
    "beampd": _KINEMATIC,
    "beampik": _KINEMATIC,
    "beampkin": _KINEMATIC,
}


def decks(folder: Path) -> Iterator[tuple[str, str]]:
    """Names and texts of all that yield."""
    for path in sorted(folder.glob("*.inp")):
        text = path.read_text(errors="replace")
        if re.search(r"(?im)^\*PLASTIC", text):
            yield path.stem, text
            if path.stem == "metalforming":
                sharp = text.replace("5000.0, 1.0", "5000.0, 0.001")
                yield _SHARP, sharp
                yield _FAR, sharp.replace("0.001,0.001, 0.0000001", "0.01,0.1, 0.0000001")


def outcome(name: str, text: str, folder: Path) -> list[str]:
    """A row: the name, nodes that are compared, the difference, and why, or what stops the deck."""
    deck = folder / "deck.inp"
    deck.write_text(plain(text))
    try:
        load_deck(deck, small_strain=True)
        values = by_calculix(plain(text), folder)
        difference = apart(deck, values) if values else None
    except (sg.InputError, sg.SolveFailed) as error:
        return [name, "", "", re.sub(r"^.*?\.inp:(\d+: )? ?", "", str(error))]
    if not values:
        sg.solve(load_deck(deck, small_strain=True).model)
    return [name, str(len(values)) if values else "", spelled(difference), _WHY.get(name, "")]


def main() -> None:
    parser = command.parser(__doc__, write=True)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    lines = ["| deck | nodes | difference | stopped by, or why |", "|---|---|---|---|"]
    print("\n".join(lines))
    with tempfile.TemporaryDirectory() as folder:
        for name, text in decks(options.folder):
            lines.append(f"| {' | '.join(outcome(name, text, Path(folder)))} |")
            print(lines[-1], flush=True)
    if options.write:
        page.write("plastic decks", "\n".join(lines), options.write)


if __name__ == "__main__":
    main()
