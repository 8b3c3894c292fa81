# SPDX-License-Identifier: BSD-3-Clause
"""Contact nodes as rows: what ``contact.csv`` holds. Other programs read it: its columns do not change."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.output.atomic_write import atomic_write
from signorini.solution.history import History
from signorini.solution.results import ContactResult

COLUMNS = (
    "step",
    "contact",
    "node",
    "x",
    "y",
    "z",
    "area",
    "gap",
    "pressure",
    "traction_1",
    "traction_2",
    "slip_1",
    "slip_2",
    "status",
)


def write_rows(history: History, path: Path) -> None:
    """Write the end of every step, one row a nonmortar node with area."""
    with atomic_write(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for number, step in enumerate(history.steps, start=1):
            for contact in step.contacts:
                writer.writerows(contact_rows(number, contact, history.model.mesh.labels))


def contact_rows(step: int, contact: ContactResult, numbers: IntArray) -> Iterator[tuple[str, ...]]:
    """Rows of one contact in the order of COLUMNS; numbers are written so that they read back exactly.

    Parameters
    ----------
    step : number of the step, from 1
    contact : at the end of that step
    numbers : of the nodes, in the mesh or deck
    """
    for i in range(len(contact.node)):
        if contact.area[i] > 0:
            yield (
                str(step),
                contact.name,
                str(numbers[contact.node[i]]),
                *(_number(value) for value in (*_padded(contact.points[i], 3), contact.area[i], contact.gap[i])),
                *(_number(value) for value in (contact.pressure[i], *_padded(contact.traction[i], 2))),
                *(_number(value) for value in _padded(contact.slip[i], 2)),
                str(contact.status[i]),
            )


def _padded(values: Array, count: int) -> Array:
    """A row with zeros behind it: plane models have fewer components."""
    row = np.atleast_1d(values)
    return np.concatenate([row, np.zeros(count - len(row))])


def _number(value: float) -> str:
    return repr(float(value) + 0.0)  # + 0.0: no "-0.0"
