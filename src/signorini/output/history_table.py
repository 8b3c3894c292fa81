# SPDX-License-Identifier: BSD-3-Clause
"""A history as columns, one row an instant: loads, contacts, energies, and what acts on the bodies from outside."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from signorini.output.result_table import Column, ResultTable
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK


def history_columns(
    history: History, names: tuple[str, ...], outside: Callable[[], Mapping[str, Column]]
) -> ResultTable:
    """Every instant of a history: events, increments, kinks of the loads, times asked for, ends of steps.

    Columns: ``step``, ``name``, ``load_factor``, ``what``; factors of loads, ``factor.LOAD``; ``work``,
    ``dissipation`` (by friction) and ``plastic_dissipation`` since the beginning of the step; of every contact
    resultants on the nonmortar body, its moment about the origin, counts; then those found outside.

    Parameters
    ----------
    history : solved
    names, outside : of columns that take work, and what finds them
    """
    d = history.model.components
    instants = [(number, step, shot) for number, step in enumerate(history.steps, 1) for shot in step.instants]
    shots = [shot for _, _, shot in instants]
    columns: dict[str, Column] = {
        "step": np.array([number for number, _, _ in instants], np.int64),
        "name": np.array([step.name for _, step, _ in instants], np.str_),
        "load_factor": np.array([shot.load_factor for shot in shots]),
        "what": np.array([shot.what for shot in shots], np.str_),
    }
    for factor in dict.fromkeys(name for shot in shots for name in shot.factors):
        columns[f"factor.{factor}"] = np.array([shot.factors.get(factor, np.nan) for shot in shots])
    columns["work"] = np.array([shot.work for shot in shots])
    columns["dissipation"] = np.array([sum(contact.dissipation for contact in shot.contacts) for shot in shots])
    if history.model.yields:
        flowed = [np.nan if shot.plastic is None else shot.plastic.dissipation for shot in shots]
        columns["plastic_dissipation"] = np.array(flowed)
    turning = ["_x", "_y", "_z"] if history.model.dimension == 3 else [""]
    for i, law in enumerate(history.model.contacts):
        contacts, label = [shot.contacts[i] for shot in shots], law.label
        for force in ("normal_force", "tangential_force"):
            values = np.array([getattr(contact, force) for contact in contacts]).reshape(-1, d)
            columns |= {f"{label}.{force}_{axis}": values[:, k] for k, axis in enumerate("xyz"[:d])}
        moments = np.array([contact.moment(np.zeros(history.model.dimension)) for contact in contacts])
        moments = moments.reshape(len(contacts), -1)
        columns |= {f"{label}.moment{axis}": moments[:, k] for k, axis in enumerate(turning)}
        columns[f"{label}.max_pressure"] = np.array([contact.pressure.max(initial=0.0) for contact in contacts])
        columns[f"{label}.closed_area"] = np.array([contact.closed_area for contact in contacts])
        for status in (OPEN, STICK, SLIP):
            columns[f"{label}.{status}"] = np.array([contact.count(status) for contact in contacts], np.int64)
        columns[f"{label}.max_slip"] = np.array([contact.slipped.max(initial=0.0) for contact in contacts])
        columns[f"{label}.dissipation"] = np.array([contact.dissipation for contact in contacts])
    return ResultTable(columns, names, outside)
