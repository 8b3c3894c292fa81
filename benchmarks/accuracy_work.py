# SPDX-License-Identifier: BSD-3-Clause
"""What all meshes of an accuracy take over the last one, where that takes a second: for :mod:`benchmarks.accuracy`.

Seconds are those of the CPU; the last mesh alone is solved several times, of which the median counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks import command
from signorini.accuracy.estimate import estimate
from signorini.api import solve
from signorini.gallery import coarse
from signorini.model.accuracy import Accuracy
from signorini.model.model import Model
from signorini.model.outputs import Output, force, halfwidth, pressure
from signorini.model.step import Step
from signorini.solution.accuracy import AccuracyResult
from signorini.solved import Solution

HEAD = ("problem", "asked, %", "nodes", "meshes", "estimated, %", "last solve, s", "its estimate, s", "work")
OUTPUTS_HEAD = ("problem", "output", "asked, %", "nodes", "meshes", "estimated, %", "last solve, s", "work")
NODES = 90_000
"""Of the finest meshes."""
REPEATS = 3
"""Of the last solve and its estimate, of which the median counts."""


def pressed_again(model: Model) -> Model:
    """In three steps, the second of half of the load."""
    (load,) = model.loads
    steps = [Step(name=f"step {k}", scale={load.label: size}) for k, size in enumerate((1.0, 0.5, 1.0))]
    return replace(model, steps=steps)


NORMS: tuple[tuple[str, Callable[[], Model], float], ...] = (
    ("two cylinders, friction 0.3", coarse.two_cylinders, 0.003),
    ("rounded punch, friction 0.3", coarse.rounded_punch, 0.001),
    ("the paper's cylinder, pressed, half, pressed", lambda: pressed_again(coarse.cylinder()), 0.001),
    ("the paper's cylinder, linear triangles", lambda: coarse.cylinder(order=1), 0.002),
    ("Hertz, line, linear triangles", lambda: coarse.hertz_line(order=1), 0.003),
)
"""Problems whose last solve takes a second, and a shorter one on cells that are solved soonest; what is asked."""

OUTPUTS: tuple[tuple[str, Callable[[], Model], Output, float], ...] = (
    ("two cylinders, friction 0.3", coarse.two_cylinders, pressure("seat").peak, 1e-4),
    ("two cylinders, friction 0.3", coarse.two_cylinders, force("seat", along=(0.0, 1.0)), 1e-4),
    ("rounded punch, friction 0.3", coarse.rounded_punch, pressure("seat").peak, 3e-4),
    (
        "the paper's cylinder, pressed, half, pressed",
        lambda: pressed_again(coarse.cylinder()),
        halfwidth("seat", about=(0.0, 0.0)),
        3e-4,
    ),
    (
        "the paper's cylinder, pressed, half, pressed",
        lambda: pressed_again(coarse.cylinder()),
        force("seat", along=(1.0, 0.0), of="friction"),
        3e-4,
    ),
    ("Hertz, point, in space", coarse.ball, pressure("seat").peak, 0.004),
)
"""The same for outputs by name."""


def of_norm(name: str, pose: Callable[[], Model], asked: float) -> tuple[object, ...]:
    """A row for the pressures.

    Parameters
    ----------
    name, pose : of the problem
    asked : error of the pressures
    """
    seconds, found, result = _all_meshes(pose, Accuracy(asked, nodes=NODES))
    last, estimated = _median(solve, found.model), _median(estimate, found)
    row = (name, f"{100 * asked:g}", _nodes(result), len(result.levels), f"{100 * result.pressure:.3f}")
    return _told((*row, f"{last:.2f}", f"{estimated:.2f}", f"{seconds / last:.1f}"))


def of_output(name: str, pose: Callable[[], Model], output: Output, asked: float) -> tuple[object, ...]:
    """A row for an output by name.

    Parameters
    ----------
    name, pose : of the problem
    output, asked : and its error
    """
    seconds, found, result = _all_meshes(pose, Accuracy(asked, of=output, nodes=NODES))
    last, error = _median(solve, found.model), float("inf") if result.output is None else result.output
    row = (name, output, f"{100 * asked:g}", _nodes(result), len(result.levels), f"{100 * error:.4f}")
    return _told((*row, f"{last:.2f}", f"{seconds / last:.1f}"))


def _all_meshes(pose: Callable[[], Model], asked: Accuracy) -> tuple[float, Solution, AccuracyResult]:
    seconds, found = command.cpu(lambda: solve(pose(), accuracy=asked))
    assert found.accuracy is not None
    return seconds, found, found.accuracy


def _median(do: Callable[..., Any], *given: Any) -> float:
    """CPU seconds of a call."""
    return float(np.median([command.cpu(do, *given)[0] for _ in range(REPEATS)]))


def _nodes(result: AccuracyResult) -> str:
    return f"{result.levels[-1].nodes}{'' if result.met else ' (most)'}"


def _told(row: tuple[object, ...]) -> tuple[object, ...]:
    print(*row, sep=" | ", flush=True)
    return row
