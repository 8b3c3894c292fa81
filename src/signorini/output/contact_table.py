# SPDX-License-Identifier: BSD-3-Clause
"""Contact nodes as columns: those of ``contact.csv`` and what follows from them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from signorini.arrays import Array, padded
from signorini.model.model import Model
from signorini.output.contact_csv import contact_columns
from signorini.output.result_table import Column, ResultTable
from signorini.solution.results import ContactResult
from signorini.solution.surface import arc_length

_FURTHER: Mapping[str, Callable[[ContactResult], Array]] = {
    **{f"normal_{axis}": lambda contact, i=i: padded(contact.normals, 3)[:, i] for i, axis in enumerate("xyz")},  # type: ignore[misc]
    **{f"force_{axis}": lambda contact, i=i: padded(contact.forces, 3)[:, i] for i, axis in enumerate("xyz")},  # type: ignore[misc]
    "sliding": lambda contact: contact.sliding,
    "slip_range": lambda contact: contact.slip_range,
    "slip_amplitude": lambda contact: 0.5 * contact.slip_range,
    "dissipation_per_area": lambda contact: contact.worn,
}
"""Unit normal from the mortar side; nodal force on the nonmortar body; distance slid in the step; range of the slip in
its last cycle, and half of it; work of friction per area since the step began."""


def contact_table(model: Model, states: Sequence[tuple[int, Sequence[ContactResult]]]) -> ResultTable:
    """Nonmortar nodes with area, one row each: the columns of ``contact.csv``, then normals, forces and slips.

    Parameters
    ----------
    model : of the contacts
    states : number of the step, from 1, and all contacts then
    """
    given = contact_columns(model)
    names = ("step", "contact", "node", *given, *(("arc_length",) if model.dimension == 2 else ()), *_FURTHER)
    parts: list[dict[str, Column]] = []
    for number, contacts in states:
        for contact in contacts:
            own, count = contact.area > 0, len(contact.area)
            columns: dict[str, Column] = {
                "step": np.full(count, number),
                "contact": np.full(count, contact.name),
                "node": model.mesh.labels[contact.node],
                **{name: _column(values(contact), count) for name, values in given.items()},
                **{name: values(contact) for name, values in _FURTHER.items()},
            }
            if model.dimension == 2:
                columns["arc_length"] = arc_length(model, contact)
            parts.append({name: columns[name][own] for name in names})
    if not parts:
        return ResultTable({name: np.zeros(0) for name in names})
    return ResultTable({name: np.concatenate([part[name] for part in parts]) for name in names})


def _column(values: Sequence[float | str], count: int) -> Column:
    """Values of a column of ``contact.csv``, NaN where it is empty."""
    if not len(values) or values[0] == "":
        return np.full(count, np.nan)
    return np.asarray(values)
