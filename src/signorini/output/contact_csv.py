# SPDX-License-Identifier: BSD-3-Clause
"""Contact nodes as rows: what ``contact.csv`` holds. Other programs read it: its columns do not change."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from signorini.arrays import IntArray, padded
from signorini.model.model import Model
from signorini.output.atomic_write import write_csv
from signorini.solution.history import History
from signorini.solution.results import ContactResult

Columns = Mapping[str, Callable[[ContactResult], list[Any]]]


def _numbers(name: str, width: int, axis: int) -> Callable[[ContactResult], list[Any]]:
    """A component of values, 0 for those that a plane model lacks."""
    return lambda contact: (padded(getattr(contact, name), width)[:, axis] + 0.0).tolist()  # + 0.0: no "-0.0"


_COLUMNS: Columns = {
    **{axis: _numbers("points", 3, i) for i, axis in enumerate("xyz")},
    **{name: _numbers(name, 1, 0) for name in ("area", "gap", "pressure")},
    **{f"{name}_{i + 1}": _numbers(name, 2, i) for name in ("traction", "slip") for i in (0, 1)},
    "status": lambda contact: contact.status.tolist(),
}
_WEAR_COLUMNS: Columns = {
    "depth": lambda contact: _depths(contact, "depth"),
    "mortar_depth": lambda contact: _depths(contact, "mortar_depth"),
}
"""Behind the others where any contact wears: of the nonmortar side at its nodes, of the other as they see it."""


_BOND_COLUMNS: Columns = {"damage": lambda contact: [] if contact.damage is None else contact.damage.tolist()}
"""Behind the others where any contact is bonded: 0 where the bond holds, 1 where there is none."""


def _depths(contact: ContactResult, name: str) -> list[Any]:
    return [""] * len(contact.node) if contact.wear is None else getattr(contact.wear, name).tolist()


def contact_columns(model: Model) -> Columns:
    """Columns of the file by name, behind those that say which node it is."""
    bonds = _BOND_COLUMNS if any(contact.cohesion for contact in model.contacts) else {}
    return {**_COLUMNS, **(_WEAR_COLUMNS if model.wears else {}), **bonds}


def _rows(step: int, contact: ContactResult, labels: IntArray, names: Columns) -> Iterator[dict[str, Any]]:
    """Nonmortar nodes with area of one contact at the end of a step, which counts from 1; numbers of all nodes."""
    columns = zip(labels[contact.node].tolist(), *(values(contact) for values in names.values()), strict=True)
    for area, (node, *values) in zip(contact.area, columns, strict=True):
        if area > 0:
            yield {"step": step, "contact": contact.name, "node": node, **dict(zip(names, values, strict=True))}


def write_contacts(history: History, path: Path) -> None:
    """Write the contacts at the end of every step as ``contact.csv``; numbers read back exactly."""
    labels, names = history.model.mesh.labels, contact_columns(history.model)
    ends = ((number, contact) for number, step in enumerate(history.steps, start=1) for contact in step.contacts)
    rows = (row for number, contact in ends for row in _rows(number, contact, labels, names))
    write_csv(("step", "contact", "node", *names), rows, path)
