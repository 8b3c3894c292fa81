# SPDX-License-Identifier: BSD-3-Clause
"""Outputs by name that are asked for, beside the same output asked for far more: tables for :mod:`benchmarks.accuracy`.

Of every problem that is drawn by a seed three outputs are drawn, too, out of the largest pressure, the half-width, the
force on a body that is moved or the motion of one that is loaded, and, of halves of problems with friction, its force
and, with a coefficient of 0.3 at most, what it dissipates. Problems with odd numbers, "held out", were not
looked at while estimates were made.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np

from benchmarks import command, page
from benchmarks.accuracy_variations import FAMILIES, variation
from signorini.api import solve
from signorini.gallery import coarse
from signorini.model.accuracy import Accuracy
from signorini.model.model import Model
from signorini.model.outputs import Output, displacement, dissipation, force, halfwidth, pressure
from signorini.solution.accuracy import AccuracyResult
from signorini.solved import Solution

HEAD = ("problem", "output", "asked, %", "nodes", "estimated, %", "true, %", "ratio", "work")
OUTPUTS: tuple[tuple[str, Callable[[], Model], Output], ...] = (
    ("the paper's cylinder", coarse.cylinder, pressure("seat").peak),
    ("the paper's cylinder", coarse.cylinder, halfwidth("seat", about=(0.0, 0.0))),
    ("the paper's cylinder", coarse.cylinder, force("seat", along=(1.0, 0.0), of="friction")),
    ("two cylinders, friction 0.3", coarse.two_cylinders, pressure("seat").peak),
    ("two cylinders, friction 0.3", coarse.two_cylinders, force("seat", along=(0.0, 1.0))),
    ("rounded punch, friction 0.3", coarse.rounded_punch, pressure("seat").peak),
    ("rounded punch, friction 0.3", coarse.rounded_punch, force("seat", along=(0.0, 1.0))),
)
ASKED, ASKED_DRAWN = (0.01, 0.001), (0.01, 0.003)
FINE, FINE_DRAWN, FINEST = 90_000, 50_000, 60_000
"""Nodes of the finest meshes: of references of the outputs above and of those that are drawn, and of others."""
FARTHER = 2e-5
"""What is asked of references: more than their nodes give."""
VARIATIONS = 4
"""Of every family."""
DRAWN_HEAD = (
    "outputs",
    "problems",
    "runs",
    "met",
    "below what was asked",
    "most, of what was asked",
    "ratio",
    "ratios",
    "0.7 to 2",
)
RESOLVED = 5.0
"""Times the reference's own estimated error: true errors of which ratios are told."""
_HALVES = ("block on a circle", "quarter of a disk", "rounded punch")
_SLIPS = 0.3
_DRAWN = 3
Run = tuple[str, str, float, float, float, float, bool, int]
"""Problem, output, what is asked, estimated, true and known of that at best, met or not, and nodes."""


def rows_of(number: int) -> list[tuple[object, ...]]:
    """Rows of an output: beside the same asked for far more, and all meshes over the last one.

    Parameters
    ----------
    number : of `OUTPUTS`
    """
    rows, (name, pose, output) = list[tuple[object, ...]](), OUTPUTS[number]
    _, fine = _asked(pose(), output, FARTHER, FINE)
    for error in ASKED:
        seconds, (solution, found) = command.cpu(_asked, pose(), output, error, FINEST)
        last = command.cpu(solve, solution.model)[0]
        exact, told = _apart(found, fine), _error(found)
        nodes = f"{found.levels[-1].nodes}{'' if found.met else ' (most)'}"
        known, signs = max(exact, _error(fine)), ("< ", "> ") if exact < _error(fine) else ("", "")
        row = (name, output, f"{100 * error:g}", nodes, f"{100 * told:.4f}", f"{signs[0]}{100 * known:.4f}")
        rows.append((*row, f"{signs[1]}{told / known:.1f}", f"{seconds / last:.1f}"))
        print(*rows[-1], sep=" | ", flush=True)
    return rows


def drawn_outputs(family: str, number: int, model: Model) -> dict[str, Output]:
    """Some outputs of a variation, by what they are.

    Parameters
    ----------
    family, number : see :func:`benchmarks.accuracy_variations.variation`
    model : that it is
    """
    half, friction = family in _HALVES, float(np.max([contact.friction or 0.0 for contact in model.contacts]))
    known: dict[str, Output] = {
        "peak pressure": pressure("seat").peak,
        "half-width": halfwidth("seat", about=(0.0, 0.0) if half else ()),
    }
    if half and friction:
        known["friction"] = force("seat", along=(1.0, 0.0), of="friction")
    if half and 0.0 < friction <= _SLIPS:
        known["dissipation"] = dissipation()
    if model.loads:
        x, y = model.mesh.points.T
        known["force or motion"] = displacement(int(np.lexsort((x, -y))[0]), along=(0.0, 1.0))
    else:
        known["force or motion"] = force("seat", along=(0.0, 1.0))
    random = np.random.default_rng((list(FAMILIES).index(family), number, _DRAWN))
    return {name: known[name] for name in random.permutation(list(known))[:_DRAWN]}


def variant(family: str, number: int) -> list[Run]:
    """Of the outputs of a variation, what comes out of every accuracy.

    Parameters
    ----------
    family, number : see :func:`benchmarks.accuracy_variations.variation`
    """
    model, found = variation(family, number), list[Run]()
    for name, output in drawn_outputs(family, number, model).items():
        _, fine = _asked(model, output, FARTHER, FINE_DRAWN)
        for asked in ASKED_DRAWN:
            _, result = _asked(model, output, asked, FINEST)
            run = (_apart(result, fine), _error(fine), result.met, result.levels[-1].nodes)
            found.append((f"{family} {number}", name, asked, _error(result), *run))
            print(*found[-1], sep=" | ", flush=True)
    return found


def drawn(runs: Sequence[Run]) -> str:
    """A table of the runs by their outputs, of problems looked at and held out, and what was missed."""
    rows, missed = list[tuple[object, ...]](), list[str]()
    kinds = list(dict.fromkeys(run[1] for run in runs))
    for kind, held in itertools.product([*kinds, "all"], (False, True)):
        own = [run for run in runs if kind in (run[1], "all") and bool(int(run[0].split()[-1]) % 2) == held]
        met = [run for run in own if run[6]]
        if not met:
            continue
        ratios = np.array([run[3] / run[4] for run in met if run[4] > RESOLVED * run[5]])
        median, ends = "", ""
        if len(ratios):
            median, ends = f"{np.median(ratios):.2f}", f"{ratios.min():.2f} to {ratios.max():.2f}"
        within = f"{int(((ratios >= 0.7) & (ratios <= 2.0)).sum())} of {len(ratios)}"
        most = max(run[4] / run[2] for run in met)
        below = sum(run[4] <= run[2] for run in met)
        counts = len(own), len(met), f"{below} of {len(met)}", f"{most:.2f}"
        words = "held out" if held else "looked at"
        rows.append((kind, words, *counts, median, ends, within))
    for problem, kind, asked, seen, true, _, met, nodes in runs:
        if not met or true > asked:
            words = (
                f"{kind} of {problem}, asked {100 * asked:g} %: {100 * true:.2f} % true, {100 * seen:.2f} % estimated"
            )
            missed.append(f"- {words}, {nodes} nodes{'' if met else ', told not to be met'}")
    text = page.table(DRAWN_HEAD, rows)
    return "\n".join([text, "", "Above what was asked for, or not met:", *missed] if missed else [text])


def problems() -> list[tuple[str, int]]:
    """Families and numbers of what is drawn."""
    return list(itertools.product(FAMILIES, range(VARIATIONS)))


def _asked(model: Model, output: Output, error: float, nodes: int) -> tuple[Solution, AccuracyResult]:
    solution = solve(model, accuracy=Accuracy(error, of=output, nodes=nodes))
    assert solution.accuracy is not None
    return solution, solution.accuracy


def _error(found: AccuracyResult) -> float:
    """Relative, as estimated; inf where it is not known."""
    return float("inf") if found.output is None else found.output


def _apart(found: AccuracyResult, fine: AccuracyResult) -> float:
    """Relative difference of an output from that of a reference."""
    assert found.value is not None
    assert fine.value is not None
    return abs(found.value / fine.value - 1.0)
