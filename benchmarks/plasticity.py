# SPDX-License-Identifier: BSD-3-Clause
"""The price of bodies that yield in contact, and CalculiX beside them; writes three tables of docs/plasticity.md.

    python -m benchmarks.plasticity price [--refine 2 10 20] [--repeats 3] [--page]
    python -m benchmarks.plasticity space [--cells 14] [--page]
    python -m benchmarks.plasticity calculix [--refine 2 4 5] [--page]
    python -m benchmarks.plasticity calculix --case 0.3 5 0.01 --increments 40 40

A quarter of a cylinder is pressed on a rigid plane, until p_0 of the elastic contact would be 2, 3, 5 and 8 times the
yield stress: in one increment beside one plain linear solve, or in ten and let go again in ten beside CalculiX.
In space a quarter of a ball is, in one increment until p_0 would be 4 times the yield stress.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from benchmarks import command, page
from benchmarks.peers.case import faces, node_set
from benchmarks.peers.run_calculix import missing
from signorini.api import solve
from signorini.arrays import Array
from signorini.bench import price as contact_price
from signorini.clock import Clock
from signorini.engine.plastic_solver import PlasticSolver
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.solve import solve_prepared
from signorini.engine.tangent_bodies import TangentBodies
from signorini.gallery.cylinder import NU, RADIUS, E, zhu_cylinder
from signorini.gallery.half_spaces import SOFT, ball, hertz
from signorini.model.body import Body
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.plastic import Plastic
from signorini.model.step import Step
from signorini.reference.hertz import contact_modulus
from signorini.solution.history import History
from signorini.solution.results import StepResult
from signorini.verify.yielding_points import yielding_points

DOCUMENT = Path(__file__).parent.parent / "docs" / "plasticity.md"
HALF_WIDTH = 0.5
"""Of the elastic contact."""
RATIOS = (2.0, 3.0, 5.0, 8.0)
"""p_0 of the elastic contact over the yield stress: first yield is at 1.79, flow without end beyond some 9."""
BALL_RATIO = 4.0
"""The same of the ball, whose first yield is at 1.61."""
FRICTION = (0.0, 0.3)
INCREMENTS = 10
"""Of either step beside CalculiX."""
LIMIT = 300
"""CPU seconds for CalculiX."""
LEFT = 0.02
"""Of the load, at the end beside CalculiX: there a body that nothing presses would be loose."""
PENALTY = 1000.0 * E
"""CalculiX's pressure per overlap: 100 times the modulus over the length of the coarsest cells."""
CASES = ((0.0, 4.0, 0.0), (0.3, 4.0, 0.02), (0.3, 5.0, 0.01))
"""Friction, p_0 over the yield stress, and hardening over the modulus; on finer meshes the second one alone."""


def pressed(refine: int, *, friction: float, ratio: float, hardening: float = 0.0, steps: tuple[Step, ...]) -> Model:
    """The cylinder, with cells of 0.1 / refine where it touches.

    Parameters
    ----------
    refine : every edge is divided by it
    friction : Coulomb's coefficient
    ratio : p_0 of the elastic contact over the yield stress
    hardening : slope of the yield stress over the modulus
    steps : of the load
    """
    modulus = contact_modulus((E, NU))
    force, p_0 = np.pi * HALF_WIDTH**2 * modulus / (4.0 * RADIUS), HALF_WIDTH * modulus / (2.0 * RADIUS)
    elastic = zhu_cylinder(
        friction=friction, refine=refine, contact_length=1.6, contact_spacing=0.1, force=force, steps=steps
    )
    law = Plastic(p_0 / ratio, hardening=hardening * E)
    return Model(
        elastic.mesh,
        title="Cylinder that yields on a rigid foundation",
        bodies=[Body("disk", Elastic(E=E, nu=NU, plastic=law))],
        supports=elastic.supports,
        loads=elastic.loads,
        contacts=elastic.contacts,
        steps=steps,
    )


def prices(refine: int, repeats: int) -> list[dict[str, Any]]:
    """One increment from nothing: rows of the contract with rounds and new factors, medians of repeats."""
    rows = []
    once = (Step(name="press", increments=1),)
    contact_price.warm_up(pressed(1, friction=0.3, ratio=5.0, steps=once), time.process_time)
    for friction in FRICTION:
        for ratio in RATIOS:
            model = pressed(refine, friction=friction, ratio=ratio, steps=once)
            rounds: list[int] = []

            def solved(prepared: Prepared, rounds: list[int] = rounds) -> History:
                history = solve_prepared(prepared)
                runs = [run for increment in history.last.trace for run in increment if run.method == "plastic flow"]
                rounds.append(sum(run.iterations for run in runs))
                return history

            spent: list[float] = []
            timed = mock.patch.object(PlasticSolver, "solve", _timed(PlasticSolver.solve, spent))
            made = mock.patch.object(TangentBodies, "solver", autospec=True, side_effect=TangentBodies.solver)
            with made as factorised, timed, mock.patch.object(contact_price, "solve_prepared", solved):
                found = contact_price.price("cylinder that yields", model, time.process_time, repeats=repeats)
            clock = Clock(timer=time.process_time)
            prepare(model, clock=clock)
            seconds = found["contact_seconds"] + found["assembly_seconds"] - clock.seconds["assembly"]
            rows.append(
                {"unknowns": found["dofs"], "friction": friction, "p_0 / Y": ratio}
                | {"rounds": rounds[-1], "tangents": factorised.call_count // len(rounds)}
                | {"seconds": seconds, "linear": found["linear_seconds"]}
                | {"of rounds": float(np.median(spent))}
            )
    return rows


def _timed(solve_increment: Callable[..., Any], spent: list[float]) -> Callable[..., Any]:
    """The same, with the CPU seconds of every call put into a list."""

    def timed(*given: Any) -> Any:
        began = time.process_time()
        answer = solve_increment(*given)
        spent.append(time.process_time() - began)
        return answer

    return timed


def balls(n: int) -> list[dict[str, Any]]:
    """A ball in one increment from nothing, beside the same one that does not yield: rows as of `prices`.

    Parameters
    ----------
    n : cells along half the side of the core of the ball, see `gallery.half_spaces.ball`
    """
    contact_price.warm_up(pressed_ball(2, friction=0.3), time.process_time)
    rows = []
    for friction in FRICTION:
        model = pressed_ball(n, friction=friction)
        (body,) = model.bodies
        elastic = Body(body.name, replace(body.material, plastic=None), formulation="mean dilatation")
        found = contact_price.price("elastic ball", replace(model, bodies=[elastic]), time.process_time, repeats=1)
        began, clock = time.process_time(), Clock(timer=time.process_time)
        prepared = prepare(model, clock=clock)
        assembly = clock.seconds["assembly"]
        with mock.patch.object(TangentBodies, "solver", autospec=True, side_effect=TangentBodies.solver) as factorised:
            history = solve_prepared(prepared)
        seconds = time.process_time() - began - assembly
        rows.append(
            {"unknowns": found["dofs"], "pairs": found["contact_pairs"], "friction": friction}
            | {"rounds": plastic_rounds(history.last), "tangents": factorised.call_count, "seconds": seconds}
            | {"elastic": found["contact_seconds"], "linear": found["linear_seconds"]}
            | {"memory": page.peak_memory()}
        )
        del prepared, history
    return rows


def pressed_ball(n: int, *, friction: float) -> Model:
    """A quarter of a ball on a rigid plane, see `balls`."""
    elastic = ball(n=n)
    law = Plastic(hertz(1).peak_pressure / BALL_RATIO)
    return replace(
        elastic,
        bodies=[Body(body.name, replace(SOFT, plastic=law)) for body in elastic.bodies],
        contacts=[replace(contact, friction=friction) for contact in elastic.contacts],
        steps=[Step(name="press", increments=1)],
    )


def plastic_rounds(step: StepResult) -> int:
    """Of all increments of a step."""
    return sum(run.iterations for runs in step.trace for run in runs if run.method == "plastic flow")


def ball_table(rows: list[dict[str, Any]]) -> str:
    """Of the document."""
    head = ("unknowns", "pairs", "mu", "rounds", "new factors", "CPU s", "elastic s", "linear solve s")
    head += ("price", "elastic price", "memory GB")
    lines = [
        [row["unknowns"], row["pairs"], row["friction"], row["rounds"], row["tangents"]]
        + [page.seconds(row[name]) for name in ("seconds", "elastic", "linear")]
        + [f"{row[name] / row['linear']:.1f}" for name in ("seconds", "elastic")]
        + [page.gigabytes(row["memory"])]
        for row in rows
    ]
    text = (
        f"{page.table(head, lines)}\n\nCPU seconds of all after the elastic assembly, of the same ball that does not "
    )
    text += (
        "yield, and of one plain linear solve of the same matrix with the contact nodes fixed; prices over that one; "
    )
    return f"{text}one thread, {page.machine()}."


def price_table(rows: list[dict[str, Any]]) -> str:
    """Of the document."""
    head = (
        "unknowns",
        "mu",
        "p_0 / Y",
        "rounds",
        "new factors",
        "CPU s",
        "linear solve s",
        "price",
        "price / round",
        "a round",
    )
    lines = [
        [
            row["unknowns"],
            row["friction"],
            f"{row['p_0 / Y']:g}",
            row["rounds"],
            row["tangents"],
            page.seconds(row["seconds"]),
            page.seconds(row["linear"]),
            f"{row['seconds'] / row['linear']:.1f}",
            f"{row['seconds'] / row['linear'] / row['rounds']:.2f}",
            f"{row['of rounds'] / row['linear'] / row['rounds']:.2f}",
        ]
        for row in rows
    ]
    text = f"{page.table(head, lines)}\n\nCPU seconds of all after the elastic assembly, over those of one plain "
    text += (
        "linear solve of the same matrix with the contact nodes fixed; a round: without the elastic bodies and what "
    )
    return f"{text}they do until they yield; one thread, {page.machine()}."


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """What a code finds at the ends of both steps.

    Attributes
    ----------
    stress : two of (cells, 4), means of the cells: xx, yy, zz, xy, force per area
    equivalent : two of (cells,), means of the equivalent plastic strain
    iterations, seconds : of all increments; CPU seconds of the whole process, or of the solve
    """

    stress: list[Array]
    equivalent: list[Array]
    iterations: int
    seconds: float


def ours(refine: int, friction: float, ratio: float, hardening: float, increments: int = INCREMENTS) -> Answer:
    """Both steps; the first one again, for its end."""
    press, release = Step(name="press", increments=increments), Step(scale={"cut": LEFT}, increments=increments)
    given = {"friction": friction, "ratio": ratio, "hardening": hardening}
    seconds, history = command.cpu(solve, pressed(refine, **given, steps=(press, release)))
    ends = [solve(pressed(refine, **given, steps=(press,))), history]
    cells = len(history.model.mesh.cells["quad"])
    points = [yielding_points(end) for end in ends]
    return Answer(
        stress=[each.stress.reshape(cells, -1, 4).mean(axis=1) for each in points],
        equivalent=[each.equivalent.reshape(cells, -1).mean(axis=1) for each in points],
        iterations=sum(
            run.iterations
            for step in history.steps
            for each in step.trace
            for run in each
            if run.method == "plastic flow"
        ),
        seconds=seconds,
    )


def theirs(refine: int, friction: float, ratio: float, hardening: float, increments: int = INCREMENTS) -> Answer | None:
    """CalculiX on the same mesh, on a stiff penalty; None where it finds no solution in time."""
    model = pressed(refine, friction=friction, ratio=ratio, hardening=hardening, steps=(Step(),))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "pressed.inp").write_text(deck(model, friction, increments))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            ["ccx", "pressed"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, **page.ONE_THREAD},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT)),
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if "Job finished" not in done.stdout:
            return None
        cells = len(model.mesh.cells["quad"])
        stresses, strains = (_printed(folder / "pressed.dat", words, cells) for words in ("stresses", "equivalent"))
        return Answer(
            stress=[table[:, :4] for table in stresses],
            equivalent=[table[:, 0] for table in strains],
            iterations=done.stdout.count("\n iteration"),
            seconds=after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime,
        )


def deck(model: Model, friction: float, increments: int) -> str:
    """Surface to surface contact on one fixed element below y = 0."""
    mesh, law = model.mesh, model.bodies[0].material.plastic  # type: ignore[union-attr]
    assert law is not None
    cells, n = mesh.cells["quad"], len(mesh.points)
    points = np.vstack([mesh.points, [(-1.0, -2.0), (9.0, -2.0), (9.0, 0.0), (-1.0, 0.0)]])
    (Y,) = law.curve[:, 1]
    (axis,), (cut,), (arc,) = (mesh.facets(name) for name in ("axis", "cut", "arc"))
    near = arc[mesh.points[arc][:, :, 0].max(axis=1) < 1.7]
    (load,) = model.loads
    assert load.force is not None
    traction = float(load.force[1] or 0.0) / RADIUS
    blocks = [
        "*NODE,NSET=EVERY\n" + "\n".join(f"{i},{x:.15g},{y:.15g},0." for i, (x, y) in enumerate(points, start=1)),
        "*ELEMENT,TYPE=CPE4,ELSET=DISK\n" + "\n".join(f"{i},{_list(c + 1)}" for i, c in enumerate(cells, start=1)),
        f"*ELEMENT,TYPE=CPE4,ELSET=GROUND\n{len(cells) + 1},{_list(n + 1 + np.arange(4))}",
        node_set("AXIS", np.unique(axis)),
        node_set("FIXED", n + np.arange(4)),
        "*SURFACE,NAME=SLAVE\n" + "\n".join(f"{cell},S{side}" for cell, side in faces(cells, near)),
        f"*SURFACE,NAME=MASTER\n{len(cells) + 1},S3",
        f"*MATERIAL,NAME=YIELDS\n*ELASTIC\n{E},{NU}\n*PLASTIC\n{Y:.15g},0.\n{Y + law.hardening:.15g},1.",
        f"*MATERIAL,NAME=ELASTIC\n*ELASTIC\n{E},{NU}",
        "*SOLID SECTION,ELSET=DISK,MATERIAL=YIELDS\n1.\n*SOLID SECTION,ELSET=GROUND,MATERIAL=ELASTIC\n1.",
        f"*SURFACE INTERACTION,NAME=LAW\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n{PENALTY:g}",
        *([f"*FRICTION\n{friction},{PENALTY / 10.0:g}"] if friction else []),
        "*CONTACT PAIR,INTERACTION=LAW,TYPE=SURFACE TO SURFACE\nSLAVE,MASTER",
        "*BOUNDARY\nAXIS,1,1\nFIXED,1,3",
    ]
    for part in (1.0, LEFT):
        sides = "\n".join(f"{cell},P{side},{-traction * part:.15g}" for cell, side in faces(cells, cut))
        blocks += [f"*STEP,INC=1000\n*STATIC,DIRECT\n{1.0 / increments},1.", f"*DLOAD\n{sides}"]
        blocks += [f"*EL PRINT,ELSET=DISK,FREQUENCY={increments}\nS,PEEQ\n*END STEP"]
    return "\n".join(blocks) + "\n"


def _list(numbers: Array) -> str:
    return ",".join(map(str, numbers))


def _printed(file: Path, words: str, cells: int) -> list[Array]:
    """Means over the points of the cells of every table whose title begins so, (cells, columns)."""
    found: list[list[list[float]]] = []
    inside = False
    for line in file.read_text().splitlines():
        if "time" in line:
            inside = line.strip().startswith(words)
            found += [[]] if inside else []
        elif inside and line.strip():
            found[-1].append([float(word) for word in line.split()])
    return [np.array(table)[:, 2:].reshape(cells, -1, len(table[0]) - 2).mean(axis=1) for table in found]


def beside(refine: int, cases: Sequence[Sequence[float]], increments: tuple[int, int]) -> list[list[object]]:
    """Rows of the table beside CalculiX, in so many increments of either code."""
    rows: list[list[object]] = []
    ours(1, *CASES[-1])  # loads what is compiled
    for friction, ratio, hardening in cases:
        case = refine, friction, ratio, hardening
        mine, other = ours(*case, increments[0]), theirs(*case, increments[1])
        model = pressed(refine, friction=friction, ratio=ratio, steps=(Step(),))
        Y = HALF_WIDTH * contact_modulus((E, NU)) / (2.0 * RADIUS) / ratio
        head: list[object] = [2 * len(model.mesh.points), friction, f"{ratio:g}", f"{hardening:g}"]
        head += [mine.iterations, page.seconds(mine.seconds)]
        if other is None:
            rows.append([*head, f"no solution in {LIMIT} CPU s", "", "", "", ""])
            continue
        off = [np.sqrt(((a - b) ** 2).mean()) / Y for a, b in zip(mine.stress, other.stress, strict=True)]
        largest = [max(float(each.max()) for each in found.equivalent) for found in (mine, other)]
        rows.append(
            [*head, other.iterations, page.seconds(other.seconds), f"{other.seconds / mine.seconds:.1f}"]
            + [", ".join(f"{part:.4f}" for part in off), ", ".join(f"{part:.4f}" for part in largest)]
        )
    return rows


def beside_table(rows: list[list[object]], increments: tuple[int, int]) -> str:
    """Of the document."""
    head = ("unknowns", "mu", "p_0 / Y", "H / E", "rounds", "CPU s", "ccx: iterations", "CPU s", "times")
    head += ("stress, rms / Y: loaded, let go", "largest PEEQ: ours, theirs")
    of_each, (mine, other) = f"{increments[0]} + {increments[0]}", increments
    words = of_each if mine == other else f"{of_each}, in CalculiX {other} + {other},"
    text = f"{page.table(head, rows)}\n\n{words} increments, means of cells, one thread, "
    return f"{text}{page.machine()}; CPU seconds of ccx as a whole, input and output too."


def main() -> None:
    parser = command.parser(__doc__)
    parser.add_argument("what", choices=("price", "space", "calculix"))
    parser.add_argument("--refine", type=int, nargs="+", default=[2, 4])
    parser.add_argument("--repeats", type=int, default=contact_price.REPEATS, help="of every price")
    parser.add_argument("--cells", type=int, nargs="+", default=[14], help="of the ball in space")
    parser.add_argument("--page", action="store_true", help=f"write the table into {DOCUMENT.name}")
    parser.add_argument("--one", action="store_true", help="measure prices in this process")
    parser.add_argument("--case", type=float, nargs=3, metavar=("MU", "RATIO", "HARDENING"))
    parser.add_argument("--increments", type=int, nargs=2, metavar=("OURS", "THEIRS"), default=[INCREMENTS, INCREMENTS])
    options = parser.parse_args()
    if options.one:
        if options.what == "space":
            print(json.dumps(balls(options.cells[0])))
        else:
            print(json.dumps(prices(options.refine[0], options.repeats)))
        return
    if options.what == "price":
        found = [
            row
            for refine in options.refine
            for row in page.measured("benchmarks.plasticity", "price", "--refine", refine, "--repeats", options.repeats)
        ]
        text = price_table(found)
    elif options.what == "space":
        measured = (page.measured("benchmarks.plasticity", "space", "--cells", n) for n in options.cells)
        text = ball_table([row for rows in measured for row in rows])
    else:
        reason = missing()
        if reason is not None:
            raise SystemExit(reason)
        mine, other = options.increments
        rows = []
        for i, refine in enumerate(options.refine):
            cases = [options.case] if options.case else CASES if i == 0 else CASES[1:2]
            rows += beside(refine, cases, (mine, other))
        text = beside_table(rows, (mine, other))
    options.dry = not options.page
    command.publish(options, f"plasticity {options.what}", text, DOCUMENT)


if __name__ == "__main__":
    main()
