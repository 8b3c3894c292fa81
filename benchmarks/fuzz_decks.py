# SPDX-License-Identifier: BSD-3-Clause
"""Decks damaged at random: each must be read, or refused with one clear message, quickly and in little memory.

    python -m benchmarks.fuzz_decks FOLDER [--count 20000] [--seed 0]

FOLDER holds sound decks (``*.inp``). Every damaged deck is read and examined as ``signorini check`` does; nothing is
solved. The process may use 1 GB more than at its start, and 5 seconds for a deck.
"""

from __future__ import annotations

import random
import resource
import signal
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from types import FrameType

from benchmarks import command
from signorini.deck import load
from signorini.engine.prepare import examine
from signorini.errors import InputError

SECONDS, MEMORY = 5, 2**30
_LONGEST = 2000  # characters of a message

_WORDS = (
    *(
        "",
        "0",
        "-1",
        "1",
        "2",
        "3",
        "1.5",
        "1e400",
        "nan",
        "inf",
        "-0.0",
        "1e-320",
        "99999999999999999999",
        "1D3",
        "abc",
    ),
    *(
        "Top",
        "Base",
        "*",
        "**",
        ",",
        ",,,",
        '"',
        "=",
        "S1",
        "P9",
        "GENERATE",
        "\u00fc",
        "\x00",
        " ",
        "\t",
        "1 2",
        "-1e300",
    ),
)
_LINES = (
    *(
        "*NODE",
        "*ELEMENT, TYPE=CPE4",
        "*ELEMENT, TYPE=CAX8",
        "*NSET, NSET=Top",
        "*END STEP",
        "*STEP",
        "*STATIC",
        "*PART",
    ),
    *(
        "*BOUNDARY, OP=NEW",
        "*DLOAD, OP=NEW",
        "*STATIC, TIME RESET",
        "*ELEMENT, TYPE=T3D2, ELSET=s",
        "CENTRIF",
        "GRAV",
        "*INCLUDE, INPUT=deck.inp",
        "*NSET, NSET=a, GENERATE",
        "1, 1000000000, 1",
        "*INSTANCE, NAME=x",
    ),
    *(
        "*EQUATION",
        "2",
        "4, 1, 1., 5, 2, -1.",
        "*RIGID BODY, NSET=Top, REF NODE=99",
        "*RIGID BODY, ELSET=E, REF NODE=1",
    ),
    *("*AMPLITUDE, NAME=A", "*TIE", "*FRICTION", "*CONTACT PAIR", "*SURFACE, NAME=s, TYPE=NODE", "*END PART", "*DLOAD"),
)


def damaged(decks: Sequence[str], chance: random.Random) -> str:
    """One of the decks with one to three random changes."""
    lines = chance.choice(decks).split("\n")
    for _ in range(chance.randint(1, 3)):
        at = chance.randrange(len(lines))
        kind = chance.randrange(9)
        if kind == 0:
            del lines[at : at + chance.randint(1, 4)]
        elif kind == 1:
            lines[at:at] = [chance.choice(_LINES)]
        elif kind == 2:
            other = chance.choice(decks).split("\n")
            start = chance.randrange(len(other))
            lines[at:at] = other[start : start + chance.randint(1, 12)]
        elif kind == 3:
            other_at = chance.randrange(len(lines))
            lines[at], lines[other_at] = lines[other_at], lines[at]
        elif kind == 4:
            place = chance.randrange(len(lines[at]) + 1)
            lines[at] = lines[at][:place] + chance.choice(_WORDS) + lines[at][place + chance.randrange(3) :]
        elif kind == 5:
            lines[at:at] = lines[at : at + chance.randint(1, 6)]
        else:
            words = lines[at].split(",")
            words[chance.randrange(len(words))] = chance.choice(_WORDS)
            lines[at] = ",".join(words)
        lines = lines or [""]
    return "\n".join(lines)


def outcome(deck: Path) -> str:
    """Read and examine a deck: "read", or "refused"; anything else is raised."""
    try:
        examine(load(deck, small_strain=True).model)
    except InputError as error:
        return "refused" if len(str(error)) < _LONGEST else "refused with a message that is too long"
    return "read"


def _late(_: int, __: FrameType | None) -> None:
    raise TimeoutError(f"more than {SECONDS} s")


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    decks = [path.read_text() for path in sorted(options.folder.glob("*.inp"))]
    chance = random.Random(options.seed)
    counts: Counter[str] = Counter()
    slowest, started = 0.0, time.perf_counter()
    signal.signal(signal.SIGALRM, _late)
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder, "deck.inp")
        deck.write_text(decks[0])
        outcome(deck)  # what is compiled or imported once
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))
        for number in range(options.count):
            text = damaged(decks, chance)
            deck.write_text(text, errors="surrogateescape")
            begin = time.perf_counter()
            signal.alarm(SECONDS)
            try:
                counts[outcome(deck)] += 1
            except Exception as error:
                counts[f"{type(error).__name__}: {str(error)[:100]}"] += 1
                kept = Path(f"fuzz-{options.seed}-{number}.inp")
                kept.write_text(text, errors="surrogateescape")
                print(f"{kept}: {type(error).__name__}: {str(error)[:200]}")
            signal.alarm(0)
            slowest = max(slowest, time.perf_counter() - begin)
    print(f"{options.count} decks in {time.perf_counter() - started:.0f} s, the slowest {slowest:.2f} s")
    for words, count in counts.most_common():
        print(f"{count:8d}  {words}")


if __name__ == "__main__":
    main()
