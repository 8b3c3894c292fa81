# SPDX-License-Identifier: BSD-3-Clause
"""Seconds and memory to read a large deck of keywords into a model.

    python -m benchmarks.read_deck [--side 1000]

The deck is a square of side x side nodes and as many 4-node elements as fit, written to a temporary file.
"""

from __future__ import annotations

import resource
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks import command
from signorini.deck import load_deck

_END = """*ELSET, ELSET=ROW, GENERATE
1, {last}
*SURFACE, NAME=BOTTOM
ROW, S1
*MATERIAL, NAME=M
*ELASTIC
2.1E5, .3
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
2, 2
*STEP
*STATIC
*DSLOAD
BOTTOM, P, 1.
*END STEP
"""


def write(path: Path, side: int) -> None:
    """A square deck."""
    grid = np.arange(1, side * side + 1).reshape(side, side)
    corners = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1).reshape(-1, 4)
    with path.open("w") as file:
        file.write("*NODE, NSET=N\n")
        y, x = np.divmod(np.arange(side * side), side)
        np.savetxt(file, np.column_stack([grid.ravel(), 0.1 * x, 0.1 * y]), fmt="%d, %.12e, %.12e, 0.")
        file.write("*ELEMENT, TYPE=CPE4, ELSET=E\n")
        np.savetxt(file, np.column_stack([np.arange(1, len(corners) + 1), corners]), fmt="%d", delimiter=", ")
        file.write(_END.format(last=side - 1))


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("--side", type=int, default=1000)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder, "square.inp")
        write(deck, options.side)
        start = time.process_time()
        model = load_deck(deck).model
        seconds = time.process_time() - start
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        print(f"{deck.stat().st_size / 1e6:.0f} MB, {model.mesh}: {seconds:.1f} s (CPU), {memory / 1e9:.2f} GB at most")


if __name__ == "__main__":
    main()
