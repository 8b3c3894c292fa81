# SPDX-License-Identifier: BSD-3-Clause
"""Contacts of many pairs in the plane: what the interface takes beside the factorisation, by the shape of the body.

python -m benchmarks.wide [--shapes 1000x500 3000x60 ...] [--dry]

A block whose whole base lies on a foundation, friction 0.3, pressed and pushed at one end: one segment of an exact
path. Of PAIRSxHEIGHT the first is the number of pairs, the second that of cells over the height; cells are square.
CPU seconds, one thread, code warm, every run in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import numpy as np

from benchmarks import command, page
from signorini.clock import Clock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Plane

SHAPES = (
    *("500x250", "500x125", "500x50", "1000x500", "1000x250", "1000x100"),
    *("2000x500", "2000x200", "3000x750", "3000x300", "3000x60"),
)
HEAD = (
    *("pairs", "width / height", "unknowns", "factorisation s", "condensation s", "complementarity s"),
    *("both / factorisation", "model to answer s", "memory GB"),
)


def block(pairs: int, height: int) -> Model:
    """A block of square cells on a foundation, pressed at its top and pushed at its right side."""
    size = (10.0, 10.0 * height / (pairs - 1))
    mesh = rectangle(x=np.linspace(0.0, size[0], pairs), y=np.linspace(0.0, size[1], height + 1))
    return Model(
        join({"block": mesh}),
        bodies=[Body("block", Elastic(E=1000.0, nu=0.3))],
        loads=[
            Load("block.top", pressure=1.0, name="press"),
            Load("block.right", traction=(0.2, 0.0), name="push"),
        ],
        contacts=[Contact("block.bottom", Plane((0.0, 0.0), (0.0, 1.0)), friction=0.3, name="base")],
    )


def measure(pairs: int, height: int) -> dict[str, Any]:
    """One solve in this process."""
    solve_prepared(prepare(block(50, 25)))
    model, clock, began = block(pairs, height), Clock(timer=time.process_time), time.process_time()
    history = solve_prepared(prepare(model, clock=clock))
    return {
        "pairs": history.pairs,
        "height": height,
        "unknowns": model.number_of_dofs,
        "worst": history.last.certificate.worst,
        "seconds": time.process_time() - began,
        **{phase: clock.seconds[phase] for phase in ("factorisation", "condensation", "complementarity")},
        "memory": page.peak_memory(),
    }


def row(found: dict[str, Any]) -> list[object]:
    """A line of the table."""
    both = found["condensation"] + found["complementarity"]
    return [
        found["pairs"],
        f"{(found['pairs'] - 1) / found['height']:.0f}",
        found["unknowns"],
        *(page.seconds(found[phase]) for phase in ("factorisation", "condensation", "complementarity")),
        f"{both / found['factorisation']:.2f}",
        page.seconds(found["seconds"]),
        page.gigabytes(found["memory"]),
    ]


def shape(words: str) -> str:
    """A shape as it was given; argparse says what is wrong with another."""
    pairs, _, height = words.partition("x")
    if not (pairs.isdigit() and height.isdigit() and int(pairs) > 1 and int(height) > 0):
        raise argparse.ArgumentTypeError(f"{words!r} is no shape; expected PAIRSxHEIGHT, as 1000x500")
    return words


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--shapes", nargs="+", type=shape, default=list(SHAPES))
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        print(json.dumps([measure(*map(int, each.split("x"))) for each in options.shapes]))
        return
    found = []
    for each in options.shapes:
        found += page.measured("benchmarks.wide", "--shapes", each, keep=False)
        print(f"{each}: {found[-1]['seconds']:.1f} s", flush=True)
    text = f"{page.table(HEAD, [row(each) for each in found])}\n\nCPU seconds, one thread, {page.machine()}."
    command.publish(options, "wide", text)


if __name__ == "__main__":
    main()
