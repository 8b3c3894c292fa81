# SPDX-License-Identifier: BSD-3-Clause
"""What is asked of an accuracy beside what is true; writes tables and pictures of docs/accuracy.md.

    python -m benchmarks.accuracy [--dry] [--only plane work variations ...] [--processes 2]

"true" is the error against the same model asked for far more, of the ball against Hertz' pressure. "ratio" is the
estimate over it, "work" the CPU seconds of all meshes and estimates over those of the last mesh alone, its estimate
left out, and "uniform" the nodes that a mesh needs whose cells are all halved, again and again, for the same error.
Where a solve takes a second, work has tables of its own
(:mod:`benchmarks.accuracy_work`). Variations are problems drawn by a seed
(:mod:`benchmarks.accuracy_variations`). Of outputs by name (:mod:`benchmarks.accuracy_outputs`), what is smaller than
the reference's own estimated error is told as below that. Each table comes from one run; problems are shared among
processes.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks import accuracy_outputs, accuracy_work, command, page
from benchmarks.accuracy_variations import FAMILIES, variation
from signorini.accuracy.curves import curves_of
from signorini.api import solve
from signorini.gallery import coarse
from signorini.meshing.simplices import Simplices
from signorini.model.accuracy import Accuracy
from signorini.model.model import Model
from signorini.plot.accuracy import draw_accuracy
from signorini.plot.picture_data import PictureData
from signorini.solved import Solution

DOCUMENT = Path(__file__).parent.parent / "docs" / "accuracy.md"
PICTURE = DOCUMENT.parent / "figures" / "accuracy.png"
NODES = DOCUMENT.parent / "figures" / "accuracy_nodes.png"
HEAD = ("problem", "asked, %", "nodes", "meshes", "estimated, %", "true, %", "ratio", "work", "uniform")
ASKED = (0.03, 0.01, 0.003)
IN_SPACE = (0.1, 0.03, 0.01)
FINEST_IN_SPACE = (0.003,)
"""In a table of its own, which takes most of an hour."""
FINEST = 60_000
"""Nodes of the finest meshes but those of references, and of the ball."""
FINEST_BALL = 600_000
MEMORY_OF_BALL = 9e9
"""Bytes; its meshes are solved by iteration."""

KINDS: dict[str, Callable[[], Model]] = {
    "hertz": coarse.hertz_line,
    "rubbed": lambda: coarse.hertz_line(0.3),
    "cylinder": coarse.cylinder,
    "two": coarse.two_cylinders,
    "rounded": coarse.rounded_punch,
}
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
FLAT = "flat punch, stresses"
PROBLEMS = (*PLANE, FLAT)
DRAWN = ("Hertz, line", "the paper's cylinder", "two cylinders, friction 0.3")
TABLES = ("plane", "work", "work of outputs", "variations", "space", "ball", "outputs", "drawn")
FINE = Accuracy(8e-4, nodes=90_000)
"""Of what errors are measured against."""
VARIATIONS = 4
"""Of every family; those with odd numbers were not looked at while estimates were made."""
VARIED_HEAD = (
    "problem",
    "variations",
    "runs",
    "below what was asked",
    "most, of what was asked",
    "ratio",
    "ratios",
    "0.7 to 2",
)
_PARTS = 7
"""Of the edges of a facet on which Hertz' pressures are compared."""
Measured = tuple[list[tuple[object, ...]], list[tuple[int, float]], list[tuple[int, float]]]
"""Rows, and nodes and errors of uniform meshes and of those that were asked for."""
Varied = tuple[str, int, float, float, float, bool, int]
"""Family and number, what is asked, estimated, true, met or not, and nodes."""


def main() -> None:
    """Measure, print, write."""
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--only", nargs="+", choices=TABLES, default=TABLES)
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    with ProcessPoolExecutor(options.processes) as pool:
        if "plane" in options.only:
            found = list(pool.map(problem, PROBLEMS))
            rows = [row for part, _, _ in found for row in part]
            command.publish(options, "accuracy", f"{page.table(HEAD, rows)}\n\n{summary(rows)}", DOCUMENT)
            if not options.dry:
                draw_nodes(found).savefig(NODES, dpi=110)
                draw_accuracy(PictureData(solve(coarse.cylinder(), accuracy=0.01))).savefig(PICTURE, dpi=110)
        if "variations" in options.only:
            drawn = list(itertools.product(FAMILIES, range(VARIATIONS)))
            text = varied(list(pool.map(variant, *zip(*drawn, strict=True))))
            command.publish(options, "variations", text, DOCUMENT)
        if "outputs" in options.only:
            found_rows = pool.map(accuracy_outputs.rows_of, range(len(accuracy_outputs.OUTPUTS)))
            text = page.table(accuracy_outputs.HEAD, [row for part in found_rows for row in part])
            command.publish(options, "outputs", text, DOCUMENT)
        if "drawn" in options.only:
            runs = pool.map(accuracy_outputs.variant, *zip(*accuracy_outputs.problems(), strict=True))
            text = accuracy_outputs.drawn([run for part in runs for run in part])
            command.publish(options, "drawn", text, DOCUMENT)
    if "work" in options.only:
        solve(coarse.cylinder(), accuracy=0.1)
        rows = [accuracy_work.of_norm(*one) for one in accuracy_work.NORMS]
        command.publish(options, "work", page.table(accuracy_work.HEAD, rows), DOCUMENT)
    if "work of outputs" in options.only:
        solve(coarse.cylinder(), accuracy=Accuracy(0.1, of="peak pressure"))
        rows = [accuracy_work.of_output(*one) for one in accuracy_work.OUTPUTS]
        command.publish(options, "work of outputs", page.table(accuracy_work.OUTPUTS_HEAD, rows), DOCUMENT)
    for table, errors in (("space", IN_SPACE), ("ball", FINEST_IN_SPACE)):
        if table in options.only:
            rows = measured("Hertz, point, in space", coarse.ball, errors, "pressure", point_error, in_space=True)[0]
            command.publish(options, table, page.table(HEAD, rows), DOCUMENT)


def problem(name: str) -> Measured:
    """Rows of a problem of the plane, what was solved for them and what uniform meshes have.

    Parameters
    ----------
    name : one of `PROBLEMS`
    """
    solve(coarse.cylinder(), accuracy=0.1)  # compiled before anything is measured
    if name == FLAT:
        fine = solve(coarse.flat_punch(), accuracy=Accuracy(8e-4, of="energy", nodes=90_000)).last.strain_energy
        return measured(
            name, coarse.flat_punch, ASKED, "energy", lambda found: abs(found.last.strain_energy / fine - 1) ** 0.5
        )
    kind, pose = PLANE[name]
    reference = solve(KINDS[kind](), accuracy=FINE)
    return measured(name, pose, ASKED, "pressure", lambda found: pressure_error(found, reference))


def variant(family: str, number: int) -> list[Varied]:
    """Of a variation, what comes out of every accuracy.

    Parameters
    ----------
    family, number : see :func:`benchmarks.accuracy_variations.variation`
    """
    model, found = variation(family, number), list[Varied]()
    reference = solve(model, accuracy=FINE)
    for asked in ASKED:
        solution = solve(model, accuracy=Accuracy(asked, nodes=FINEST))
        result, true = solution.accuracy, pressure_error(solution, reference)
        assert result is not None
        found.append((family, number, asked, result.pressure, true, result.met, result.levels[-1].nodes))
        print(*found[-1], sep=" | ", flush=True)
    return found


def varied(found: Sequence[list[Varied]]) -> str:
    """A table of the variations by their families, those looked at and those held out, and what was not met."""
    rows, missed = list[tuple[object, ...]](), list[str]()
    runs = [run for part in found for run in part]
    for family, held in [*itertools.product(FAMILIES, (False, True)), ("all", False), ("all", True)]:
        own = [run for run in runs if family in (run[0], "all") and bool(run[1] % 2) == held]
        ratios = np.array([run[3] / run[4] for run in own])
        excess = max(run[4] / run[2] for run in own if run[5])
        below = sum(run[4] <= run[2] for run in own)
        within = sum((ratios >= 0.7) & (ratios <= 2.0))
        words = "held out" if held else "looked at"
        told = f"{ratios.min():.2f} to {ratios.max():.2f}"
        rows.append((family, words, len(own), below, f"{excess:.2f}", f"{np.median(ratios):.2f}", told, within))
    for family, number, asked, seen, true, met, nodes in runs:
        if not met or true > asked:
            told = "" if met else ", told not to be met"
            words = f"{family} {number}, asked {100 * asked:g} %: {100 * true:.2f} % true, {100 * seen:.2f} % estimated"
            missed.append(f"- {words}, {nodes} nodes{told}")
    return "\n".join(
        [page.table(VARIED_HEAD, rows), "", "Above what was asked for, or not met:" if missed else "", *missed]
    )


def summary(rows: Sequence[tuple[object, ...]]) -> str:
    """In a sentence, how many are below what was asked for, and the ratios."""
    ratios = np.array([float(str(row[6])) for row in rows])
    kept = sum(float(str(row[5])) <= float(str(row[1])) for row in rows)
    return f"{kept} of {len(rows)} below what was asked for; ratios {ratios.min():.2f} to {ratios.max():.2f}."


def draw_nodes(found: Sequence[Measured]) -> Figure:
    """True errors over the nodes of meshes that are asked for and of uniform ones."""
    figure = Figure(figsize=(8.0, 4.5), layout="constrained")
    axes = figure.add_subplot()
    for i, (rows, uniform, asked) in enumerate(part for part in found if part[0][0][0] in DRAWN):
        colour = f"C{i}"
        axes.loglog(*zip(*asked, strict=True), "o-", color=colour, label=f"{rows[0][0]}, as asked for")
        axes.loglog(*zip(*uniform, strict=True), "s--", color=colour, label="all cells halved", mfc="none")
    axes.set(xlabel="nodes", ylabel="true error")
    axes.grid(which="both", alpha=0.2)
    axes.legend(fontsize=8)
    return figure


def measured(
    name: str,
    pose: Callable[[], Model],
    asked: tuple[float, ...],
    of: str,
    true: Callable[[Solution], float],
    *,
    in_space: bool = False,
) -> Measured:
    """Rows of a problem, nodes and errors of uniform meshes and of those that were asked for.

    Parameters
    ----------
    name, pose : of the problem
    asked : errors that are asked for
    of : what is to be accurate
    true : error of a solution
    in_space : whether it is the ball, on larger meshes, solved by iteration
    """
    nodes, memory, backend = (FINEST_BALL, MEMORY_OF_BALL, "iterative") if in_space else (FINEST, None, "auto")
    uniform = uniformly(pose(), true)
    rows, reached = list[tuple[object, ...]](), list[tuple[int, float]]()
    for error in asked:
        seconds, found = command.cpu(
            lambda error=error: solve(
                pose(), backend=backend, accuracy=Accuracy(error, of=of, nodes=nodes, memory=memory)
            )
        )
        last = command.cpu(lambda found=found: solve(found.model, backend=backend))[0]
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
        reached.append((result.levels[-1].nodes, exact))
        print(*rows[-1], sep=" | ", flush=True)
    return rows, uniform, reached


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


def point_error(found: Solution, radius: float = 1.0) -> float:
    """Of the pressures of the ball against Hertz' on a circle, between their nodes: of every facet a hundred points."""
    contact, mesh = found.contact("seat"), found.model.mesh
    pressure = np.zeros(len(mesh.points))
    pressure[contact.node] = contact.pressure
    corners = mesh.facets("top")[0][:, :3]
    i, j = (part.ravel() for part in np.mgrid[: 2 * _PARTS, : 2 * _PARTS])
    first, second = ((k[i + j < 2 * _PARTS - 1] + 0.5) / (2 * _PARTS) for k in (i, j))
    inside = np.column_stack([first, second, 1.0 - first - second])
    at = np.einsum("qk,mki->mqi", inside, mesh.points[corners])
    areas = np.linalg.norm(np.cross(*np.diff(mesh.points[corners], axis=1).transpose(1, 0, 2)), axis=1)
    largest = 2.0 / np.pi * coarse.PLANE_MODULUS / 100.0
    true = largest * np.sqrt(np.maximum(radius**2 - (at[..., :2] ** 2).sum(axis=2), 0.0))
    squares = [areas @ (part**2).mean(axis=1) for part in (pressure[corners] @ inside.T - true, true)]
    return float(np.sqrt(squares[0] / squares[1]))


def _pressures(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    contact = solution.contact("seat")
    order = np.argsort(contact.points[:, 0])
    return contact.points[order, 0], contact.pressure[order]


if __name__ == "__main__":
    start = time.perf_counter()
    main()
    print(f"{time.perf_counter() - start:.0f} s")
