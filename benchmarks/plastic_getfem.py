# SPDX-License-Identifier: BSD-3-Clause
"""A body that yields on a rigid plane beside GetFEM on the same mesh; writes a table of docs/plasticity.md.

    python -m benchmarks.plastic_getfem [--cells 4 8] [--page]

A paraboloid of nine-node quadrilaterals in plane strain, perfectly plastic, is driven down in ten increments without
friction. Both codes integrate the law at the same 3 x 3 points, without a mean dilatation, which GetFEM does not have.
Skipped, with the reason, where the system's Python has no GetFEM (Debian: python3-getfem).
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import command, page
from benchmarks.peers.run_getfem import PYTHON, environment, missing
from benchmarks.plasticity import DOCUMENT, plastic_rounds
from signorini.api import solve
from signorini.arrays import Array
from signorini.gallery.yielding import NU, E, round_body
from signorini.model.model import Model
from signorini.model.plastic import Plastic
from signorini.model.step import Step
from signorini.verify.yielding_points import yielding_points

SCRIPT = Path(__file__).parent / "peers" / "getfem_pressed.py"
INCREMENTS = 10
RADIUS, APPROACH = 100.0, 0.025
"""Length; the approach makes an elastic contact of half-width about 1."""
YIELD_STRESSES = (0.4, 0.25)
"""p_0 of the elastic contact is about 3 and 5 times that."""


def pressed(n: int, yield_stress: float) -> Model:
    """The body with so many cells in a length of 1 where it touches."""
    law = Plastic(yield_stress)
    step = Step(increments=INCREMENTS)
    model = round_body(n=n, plastic=law, cells="quad9", radius=RADIUS, size=20.0, approach=APPROACH, steps=[step])
    (body,) = model.bodies
    return replace(model, bodies=[replace(body, formulation="standard")])


def theirs(model: Model, yield_stress: float, folder: Path) -> tuple[dict[str, float], Array]:
    """What GetFEM prints, and its stresses (cells, 4)."""
    mesh = model.mesh
    sides = {"seat": "seat", "axis": "left", "top": "top"}
    arrays: dict[str, Any] = {key: np.unique(mesh.facets(name)[0]) for key, name in sides.items()}
    arrays |= {"E": E, "nu": NU, "Y": yield_stress, "approach": APPROACH, "increments": INCREMENTS}
    np.savez(folder / "case.npz", points=mesh.points, cells=mesh.cells["quad9"], **arrays)
    done = subprocess.run(
        [PYTHON, str(SCRIPT), str(folder / "case.npz"), str(folder / "found.npz")],
        capture_output=True,
        text=True,
        env=environment(),
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"GetFEM ended with {done.returncode}:\n{done.stderr[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1]), np.load(folder / "found.npz")["stress"]


def row(n: int, yield_stress: float) -> list[object]:
    """Of the table."""
    model = pressed(n, yield_stress)
    seconds, history = command.cpu(solve, model)
    with tempfile.TemporaryDirectory() as folder:
        found, stress = theirs(model, yield_stress, Path(folder))
    own = yielding_points(history).stress.reshape(len(stress), -1, 4).mean(axis=1)
    off = np.sqrt(((own - stress) ** 2).mean()) / yield_stress
    force = float(history.last.contacts[0].normal_force[1])
    share = float(np.mean(yielding_points(history).equivalent > 0.0))
    return [
        2 * len(model.mesh.points),
        f"{yield_stress:g}",
        f"{share:.2f}",
        plastic_rounds(history.last),
        page.seconds(seconds),
        found["iterations"],
        page.seconds(found["seconds"]),
        f"{found['seconds'] / seconds:.1f}",
        f"{off:.4f}",
        f"{force:.4f}, {found['force']:.4f}",
    ]


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("--cells", type=int, nargs="+", default=[4, 8])
    parser.add_argument("--page", action="store_true", help=f"write the table into {DOCUMENT.name}")
    options = parser.parse_args()
    reason = missing()
    if reason is not None:
        raise SystemExit(reason)
    solve(pressed(1, YIELD_STRESSES[-1]))  # loads what is compiled
    head = ["unknowns", "Y", "points that yield", "rounds", "CPU s", "GetFEM: iterations", "CPU s", "times"]
    rows = [row(n, yield_stress) for n in options.cells for yield_stress in YIELD_STRESSES]
    text = page.table([*head, "stress, rms / Y", "force: ours, GetFEM's"], rows)
    text += (
        f"\n\n{INCREMENTS} increments, means of cells, one thread, {page.machine()}; CPU seconds of all increments, "
    )
    text += "without input."
    options.dry = not options.page
    command.publish(options, "plasticity getfem", text, DOCUMENT)


if __name__ == "__main__":
    main()
