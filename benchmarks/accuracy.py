# SPDX-License-Identifier: BSD-3-Clause
"""What is asked of an accuracy beside what is true; writes a table and a picture of docs/accuracy.md.

    python -m benchmarks.accuracy [--dry]

"true" is the error against the same model asked for far more, of the ball against Hertz' pressure. "ratio" is the
estimate over it, "work" the CPU seconds of all meshes and estimates over those of the last mesh alone, its estimate
left out, and "uniform" the nodes that a mesh needs whose cells are all halved, again and again, for the same error.
Outputs by name have a table of their own.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks import command, page
from signorini.accuracy.curves import curves_of
from signorini.api import solve
from signorini.gallery import coarse
from signorini.meshing.simplices import Simplices
from signorini.model.accuracy import Accuracy
from signorini.model.model import Model
from signorini.model.outputs import Output, force, halfwidth, pressure
from signorini.plot.accuracy import draw_accuracy
from signorini.plot.picture_data import PictureData
from signorini.solved import Solution

DOCUMENT = Path(__file__).parent.parent / "docs" / "accuracy.md"
PICTURE = DOCUMENT.parent / "figures" / "accuracy.png"
HEAD = ("problem", "asked, %", "nodes", "meshes", "estimated, %", "true, %", "ratio", "work", "uniform")
ASKED = (0.03, 0.01, 0.003)
IN_SPACE = (0.1, 0.03, 0.01)
FINEST = 60_000
"""Nodes of the finest meshes but those of references, and of the ball."""
FINEST_BALL = 200_000
OUTPUT_HEAD = ("problem", "output", "asked, %", "nodes", "estimated, %", "true, %", "ratio")
OUTPUTS: tuple[tuple[str, Callable[[], Model], Output], ...] = (
    ("the paper's cylinder", coarse.cylinder, pressure("seat").peak),
    ("the paper's cylinder", coarse.cylinder, halfwidth("seat", about=(0.0, 0.0))),
    ("the paper's cylinder", coarse.cylinder, force("seat", along=(1.0, 0.0), of="friction")),
    ("two cylinders, friction 0.3", coarse.two_cylinders, pressure("seat").peak),
    ("two cylinders, friction 0.3", coarse.two_cylinders, force("seat", along=(0.0, 1.0))),
    ("rounded punch, friction 0.3", coarse.rounded_punch, pressure("seat").peak),
    ("rounded punch, friction 0.3", coarse.rounded_punch, force("seat", along=(0.0, 1.0))),
)

PLANE: dict[str, tuple[str, Callable[[], Model]]] = {
    "Hertz, line": ("hertz", coarse.hertz_line),
    "the same, linear triangles": ("hertz", lambda: coarse.hertz_line(order=1)),
    "the same, quadrilaterals": ("hertz", lambda: coarse.hertz_line(cells="quad", order=1)),
    "Hertz, line, friction 0.3": ("rubbed", lambda: coarse.hertz_line(0.3)),
    "the paper's cylinder": ("cylinder", coarse.cylinder),
    "the same, linear triangles ": ("cylinder", lambda: coarse.cylinder(order=1)),
    "the same, quadrilaterals ": ("cylinder", lambda: coarse.cylinder(cells="quad", order=1)),
    "two cylinders, friction 0.3": ("two", coarse.two_cylinders),
    "rounded punch, friction 0.3": ("rounded", coarse.rounded_punch),
}


def main() -> None:
    """Measure, print, write."""
    options = command.parser(__doc__, dry=True).parse_args()
    solve(coarse.cylinder(), accuracy=0.1)  # compiled before anything is measured
    rows, references = [], dict[str, Solution]()
    for name, (kind, pose) in PLANE.items():
        if kind not in references:
            references[kind] = solve(pose(), accuracy=Accuracy(6e-4, nodes=120_000))
        reference = references[kind]
        rows += measured(name, pose, ASKED, "pressure", lambda found, fine=reference: pressure_error(found, fine))
    fine = solve(coarse.flat_punch(), accuracy=Accuracy(6e-4, of="energy", nodes=120_000)).last.strain_energy
    rows += measured(
        "flat punch, stresses",
        coarse.flat_punch,
        ASKED,
        "energy",
        lambda found: abs(found.last.strain_energy / fine - 1) ** 0.5,
    )
    rows += measured("Hertz, point, in space", coarse.ball, IN_SPACE, "pressure", point_error, FINEST_BALL)
    ratios = np.array([float(row[6]) for row in rows])
    kept = sum(float(row[5]) <= float(row[1]) for row in rows)
    text = page.table(HEAD, rows)
    text += f"\n\n{kept} of {len(rows)} below what was asked for; ratios {ratios.min():.2f} to {ratios.max():.2f}."
    command.publish(options, "accuracy", text, DOCUMENT)
    command.publish(options, "outputs", page.table(OUTPUT_HEAD, outputs()), DOCUMENT)
    if not options.dry:
        draw_accuracy(PictureData(solve(coarse.cylinder(), accuracy=0.01))).savefig(PICTURE, dpi=110)


def measured(
    name: str,
    pose: Callable[[], Model],
    asked: tuple[float, ...],
    of: str,
    true: Callable[[Solution], float],
    nodes: int = FINEST,
) -> list[tuple[object, ...]]:
    """Rows of a problem.

    Parameters
    ----------
    name, pose : of the problem
    asked : errors that are asked for
    of : what is to be accurate
    true : error of a solution
    nodes : at most
    """
    uniform = uniformly(pose(), true)
    rows = []
    for error in asked:
        seconds, found = command.cpu(lambda error=error: solve(pose(), accuracy=Accuracy(error, of=of, nodes=nodes)))
        last = command.cpu(lambda found=found: solve(found.model))[0]
        result, exact = found.accuracy, true(found)
        assert result is not None
        estimate = getattr(result, of)
        told = f"{result.levels[-1].nodes}" if result.met else f"{result.levels[-1].nodes} (most)"
        row = (
            name.strip(),
            f"{100 * error:g}",
            told,
            len(result.levels),
            f"{100 * estimate:.2f}",
            f"{100 * exact:.2f}",
        )
        rows.append((*row, f"{estimate / exact:.2f}", f"{seconds / last:.1f}", needed(uniform, error)))
        print(*rows[-1], sep=" | ", flush=True)
    return rows


def outputs() -> list[tuple[object, ...]]:
    """Rows of outputs: beside the same asked for far more."""
    rows: list[tuple[object, ...]] = []
    for name, pose, output in OUTPUTS:
        fine = solve(pose(), accuracy=Accuracy(2e-5, of=output, nodes=90_000)).accuracy
        for error in (0.01, 0.001):
            found = solve(pose(), accuracy=Accuracy(error, of=output, nodes=FINEST)).accuracy
            assert fine is not None
            assert found is not None
            exact = abs(found.value / fine.value - 1.0)
            nodes = f"{found.levels[-1].nodes}{'' if found.met else ' (most)'}"
            told = f"{100 * found.output:.3f}", f"{100 * exact:.3f}", f"{found.output / exact:.1f}"
            rows.append((name, output, f"{100 * error:g}", nodes, *told))
            print(*rows[-1], sep=" | ", flush=True)
    return rows


def uniformly(model: Model, true: Callable[[Solution], float]) -> list[tuple[int, float]]:
    """Nodes and errors of meshes whose cells are all halved."""
    curves, simplices, found = curves_of(model.mesh), Simplices.of(model.mesh), []
    order = 1 if model.mesh.cells.keys() <= {"triangle", "tetra"} else 2
    while True:
        mesh = simplices.mesh(order, curves)
        if len(mesh.points) > FINEST:
            return found
        found.append((len(mesh.points), true(solve(Model(**{**vars(model), "mesh": mesh})))))
        simplices = simplices.refined(np.arange(len(simplices.cells)), curves)


def needed(uniform: list[tuple[int, float]], error: float) -> str:
    """Nodes of the first uniform mesh that is as accurate, between two by their power law."""
    for (few, large), (many, small) in itertools.pairwise(uniform):
        if small <= error:
            share = np.log(max(large, error) / error) / np.log(max(large, error * 1.001) / small)
            return f"{few * (many / few) ** share:.0f}"
    return f"> {uniform[-1][0]}"


def pressure_error(found: Solution, reference: Solution) -> float:
    """Of the pressures of a contact of the plane, between their nodes, root of the mean square."""
    (x, p), (fine, exact) = (_pressures(solution) for solution in (found, reference))
    touching = fine[exact > 0.0]
    room = 0.1 * float(np.ptp(touching))
    at = np.linspace(max(touching.min() - room, fine.min()), touching.max() + room, 40_001)
    true = np.interp(at, fine, exact)
    return float(np.sqrt(((np.interp(at, x, p) - true) ** 2).sum() / (true**2).sum()))


def point_error(found: Solution) -> float:
    """Of the pressures of the ball against Hertz', with the areas of the nodes."""
    contact = found.contact("seat")
    largest = 2.0 / np.pi * coarse.PLANE_MODULUS / 100.0
    true = largest * np.sqrt(np.maximum(1.0 - (contact.points[:, :2] ** 2).sum(axis=1), 0.0))
    return float(np.sqrt((contact.area @ (contact.pressure - true) ** 2) / (contact.area @ true**2)))


def _pressures(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    contact = solution.contact("seat")
    order = np.argsort(contact.points[:, 0])
    return contact.points[order, 0], contact.pressure[order]


if __name__ == "__main__":
    start = time.perf_counter()
    main()
    print(f"{time.perf_counter() - start:.0f} s")
