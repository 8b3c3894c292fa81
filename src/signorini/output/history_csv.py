# SPDX-License-Identifier: BSD-3-Clause
"""The way of a history as rows: what ``history.csv`` holds, one row a contact and instant."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from signorini.output.atomic_write import atomic_write
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult, Instant

COLUMNS = (
    "step",
    "load_factor",
    "what",
    "contact",
    "normal_force_x",
    "normal_force_y",
    "normal_force_z",
    "tangential_force_x",
    "tangential_force_y",
    "tangential_force_z",
    "max_pressure",
    "open",
    "stick",
    "slip",
    "max_slip",
    "max_sliding",
    "dissipation",
    "work",
)
"""Work and dissipation count from the beginning of the step; work is empty where the bodies were not looked at."""


def write_history(history: History, path: Path) -> None:
    """Write every instant of every step: events, increments, kinks of the loads, times asked for, ends."""
    with atomic_write(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for number, step in enumerate(history.steps, start=1):
            for instant in step.instants:
                writer.writerows(_row(number, instant, contact) for contact in instant.contacts)


def _row(number: int, instant: Instant, contact: ContactResult) -> tuple[str, ...]:
    forces = (contact.normal_force, contact.tangential_force)
    values = [part for force in forces for part in (*force, 0.0, 0.0)[:3]] + [contact.pressure.max(initial=0.0)]
    slid = (contact.slipped.max(initial=0.0), contact.sliding.max(initial=0.0), contact.dissipation)
    return (
        str(number),
        repr(instant.load_factor),
        instant.what,
        contact.name,
        *(repr(float(value) + 0.0) for value in values),
        *(str(contact.count(status)) for status in (OPEN, STICK, SLIP)),
        *(repr(float(value) + 0.0) for value in slid),
        "" if math.isnan(instant.work) else repr(float(instant.work)),
    )
