# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue as rows, what ``fatigue.csv`` holds, and as fields of the bodies. Columns are added, never changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, padded
from signorini.fem.stress import BodyStress
from signorini.output.atomic_write import write_csv
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History

_COLUMNS = (
    "request",
    "criterion",
    "body",
    "node",
    *"xyz",
    "parameter",
    "amplitude",
    "stress",
    *(f"plane_{axis}" for axis in "xyz"),
    "distance",
    "life",
)


def write_fatigue(history: History, path: Path) -> None:
    """Write every place of every criterion as ``fatigue.csv``; empty is what a criterion does not know."""
    labels = history.model.mesh.labels
    results = enumerate(history.fatigue_results, start=1)
    write_csv(_COLUMNS, (row for number, result in results for row in _rows(number, result, labels)), path)


def _rows(number: int, result: FatigueResult, labels: IntArray) -> Iterator[dict[str, Any]]:
    """The places of one criterion."""
    values = np.column_stack(
        [padded(result.points, 3), result.parameter, result.amplitude, result.stress, result.plane]
    )
    distance = result.request.distance
    for body, node, given, life in zip(
        result.body.tolist(), labels[result.node].tolist(), (values + 0.0).tolist(), result.life.tolist(), strict=True
    ):
        told = [*given, distance, life]
        known = ["" if value != value else value for value in told]
        yield dict(zip(_COLUMNS, [number, result.name, body, node, *known], strict=True))


def fatigue_fields(results: Sequence[FatigueResult], bodies: Sequence[BodyStress]) -> dict[str, Array]:
    """Parameters, and lives where they are known, at the points of all bodies one after the other; NaN elsewhere.

    Parameters
    ----------
    results : of criteria
    bodies : the nodes of every body, in the order of the points
    """
    start = dict(zip((body.body for body in bodies), np.cumsum([0, *(len(b.nodes) for b in bodies)]), strict=False))
    count = sum(len(body.nodes) for body in bodies)
    found = {}
    for number, result in enumerate(results, start=1):
        at = np.zeros(len(result.node), int)
        for body in bodies:
            own = result.body == body.body
            at[own] = start[body.body] + np.searchsorted(body.nodes, result.node[own])
        name = f"fatigue_{number}_{result.name.replace(' ', '_')}"
        known = {name: result.parameter} | ({f"{name}_life": result.life} if result.lives else {})
        for key, values in known.items():
            found[key] = np.full(count, np.nan)
            found[key][at] = values
    return found
