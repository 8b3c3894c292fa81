# SPDX-License-Identifier: BSD-3-Clause
"""The way of a history as rows: what ``history.csv`` holds, one row a contact and instant."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from signorini.output.atomic_write import write_csv
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult, Instant


class _Row(NamedTuple):
    """Data of one row."""

    step: int
    instant: Instant
    contact: ContactResult


def _component(force: str, axis: int) -> Callable[[_Row], float]:
    """A component of a resultant; the third is 0 in the plane."""
    return lambda row: _number((*getattr(row.contact, force), 0.0)[axis])


def _largest(values: str) -> Callable[[_Row], float]:
    """The largest value of the nodes, 0 without any."""
    return lambda row: _number(getattr(row.contact, values).max(initial=0.0))


def _number(value: float) -> float:
    return float(value) + 0.0  # + 0.0: no "-0.0"


_COLUMNS: Mapping[str, Callable[[_Row], str | int | float]] = {
    "step": lambda row: row.step,
    "load_factor": lambda row: row.instant.load_factor,
    "what": lambda row: row.instant.what,
    "contact": lambda row: row.contact.name,
    **{f"normal_force_{axis}": _component("normal_force", i) for i, axis in enumerate("xyz")},
    **{f"tangential_force_{axis}": _component("tangential_force", i) for i, axis in enumerate("xyz")},
    "max_pressure": _largest("pressure"),
    "open": lambda row: row.contact.count(OPEN),
    "stick": lambda row: row.contact.count(STICK),
    "slip": lambda row: row.contact.count(SLIP),
    "max_slip": _largest("slipped"),
    "max_sliding": _largest("sliding"),
    "dissipation": lambda row: _number(row.contact.dissipation),
    "work": lambda row: "" if math.isnan(row.instant.work) else float(row.instant.work),
    "plastic_dissipation": lambda row: "" if row.instant.plastic is None else row.instant.plastic.dissipation,
    "back_stress_energy": lambda row: "" if row.instant.plastic is None else row.instant.plastic.stored,
}
"""Work and dissipation count from the beginning of the step; work is empty where the bodies were not looked at.

Plastic dissipation counts from there too, back stresses and hardening included; both plastic columns are empty where no
body yields.
"""

_WEAR_COLUMNS: Mapping[str, Callable[[_Row], str | int | float]] = {
    "worn_volume": lambda row: "" if row.contact.wear is None else sum(row.contact.wear.volume),
    "max_depth": lambda row: "" if row.contact.wear is None else max(row.contact.wear.deepest),
    "cycles": lambda row: "" if row.contact.wear is None else row.contact.wear.cycles,
}
"""Behind the others where any contact wears: of both sides since the beginning; empty for contacts that do not."""


def write_history(history: History, path: Path) -> None:
    """Write every contact at every instant, an event, an increment, a kink of the loads, a time asked for or an end."""
    rows = (
        _Row(number, instant, contact)
        for number, step in enumerate(history.steps, start=1)
        for instant in step.instants
        for contact in instant.contacts
    )
    columns = {**_COLUMNS, **(_WEAR_COLUMNS if history.model.wears else {})}
    write_csv(columns, ({name: value(row) for name, value in columns.items()} for row in rows), path)
