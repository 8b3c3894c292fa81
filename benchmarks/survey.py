# SPDX-License-Identifier: BSD-3-Clause
"""Public decks in bulk: which are read and solved, and which keyword refuses the others.

    python -m benchmarks.survey FOLDER [--write docs/inp.md]

FOLDER holds one folder for each repository; nothing is fetched. Every ``.inp`` file below is read, with small strains,
and solved, with its certificate, if it is read.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import signorini as sg
from benchmarks import command, page
from signorini.deck import load_deck


def outcome(deck: Path) -> str:
    """ "solved", the keyword that refuses a deck, or what it lacks."""
    try:
        sg.solve(load_deck(deck, small_strain=True).model)
    except (sg.InputError, sg.SolveFailed) as error:
        words = re.sub(r"^.*?\.inp:(\d+: )? ?", "", str(error))
        lacks = re.match(r"has no (\*[A-Z ]+)", words)
        if lacks:
            return f"no {lacks[1]}"
        keyword = re.match(r"\*[A-Z ]+", words)
        parameter = re.search(r"parameter ([A-Z]+)", words)
        return f"{keyword[0]}{', ' + parameter[1] if parameter else ''}" if keyword else words.split(";")[0][:60]
    return "solved"


def main() -> None:
    parser = command.parser(__doc__, write=True)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    rows = ["| repository | decks | solved | refused by, or lacking |", "|---|---|---|---|"]
    for home in sorted(path for path in options.folder.iterdir() if path.is_dir()):
        found = Counter(outcome(deck) for deck in sorted(home.rglob("*.inp")))
        rest = ", ".join(f"{count} {words}" for words, count in found.most_common() if words != "solved")
        rows.append(f"| {home.name} | {found.total()} | {found['solved']} | {rest} |")
        print(rows[-1], flush=True)
    if options.write:
        page.write("survey", "\n".join(rows), options.write)


if __name__ == "__main__":
    main()
