# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue as rows, what ``fatigue.csv`` holds, and as fields of the bodies. Columns are added, never changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray, padded, places_among
from signorini.fem.stress import BodyStress
from signorini.model.mesh import Mesh
from signorini.output.atomic_write import write_csv
from signorini.output.by_rows import portions
from signorini.output.fields import BodyFields, Fields
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
    results = enumerate(history.fatigue_results, start=1)
    write_csv(_COLUMNS, (row for number, result in results for row in _rows(number, result, history.model.mesh)), path)


def _rows(number: int, result: FatigueResult, mesh: Mesh) -> Iterator[dict[str, Any]]:
    """The places of one criterion, so many at a time."""
    for some in portions(result.count):
        part = result.among(some)
        values = np.column_stack([padded(part.points, 3), part.parameter, part.amplitude, part.stress, part.plane])
        labels, distance = mesh.labels_of(part.node), result.request.distance
        for body, node, given, life in zip(
            part.body.tolist(), labels.tolist(), (values + 0.0).tolist(), part.life.tolist(), strict=True
        ):
            told = [*given, distance, life]
            known = ["" if value != value else value for value in told]
            yield dict(zip(_COLUMNS, [number, result.name, body, node, *known], strict=True))


def fatigue_arrays(number: int, result: FatigueResult) -> dict[str, str]:
    """Names of the point arrays of a criterion: its parameter, and lives where they are known.

    Parameters
    ----------
    number, result : of the criterion, from 1
    """
    name = f"fatigue_{number}_{result.name.replace(' ', '_')}"
    return {name: "parameter"} | ({f"{name}_life": "life"} if result.lives else {})


def points_of(bodies: Sequence[BodyStress], body: NDArray[np.str_], node: IntArray) -> IntArray:
    """(k,) Where nodes of bodies are among the points of all bodies one after the other; -1 where they are not.

    Parameters
    ----------
    bodies : the nodes of every body, in the order of the points
    body, node : (k,) names of bodies, and nodes
    """
    at, first = np.full(len(node), -1), 0
    for each in bodies:
        own = np.flatnonzero(body == each.body)
        here, place = places_among(node[own], each.nodes)
        at[own[here]] = first + place
        first += len(each.nodes)
    return at


def fatigue_fields(results: Sequence[FatigueResult], bodies: Sequence[BodyStress]) -> dict[str, Array]:
    """Parameters, and lives where they are known, at the points of all bodies one after the other; NaN elsewhere.

    Parameters
    ----------
    results : of criteria
    bodies : the nodes of every body, in the order of the points
    """
    count, found = sum(len(body.nodes) for body in bodies), {}
    for number, result in enumerate(results, start=1):
        at = points_of(bodies, result.body, result.node)
        for key, what in fatigue_arrays(number, result).items():
            found[key] = np.full(count, np.nan)
            found[key][at] = getattr(result, what)
    return found


def with_fatigue_fields(fields: Fields, history: History) -> BodyFields:
    """The bodies at the end of a history, with what the criteria say that its model asks for.

    Parameters
    ----------
    fields, history : of the model, and solved
    """
    found = fields.at(history.last, strained=True)
    return replace(found, further=fatigue_fields(history.fatigue_results, fields.stresses(history.last)))
