# SPDX-License-Identifier: BSD-3-Clause
"""Sensitivities beside the results of a run: ``sensitivities.json`` and ``sensitivities.csv``."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

from signorini.errors import InputError
from signorini.output.atomic_write import atomic_write, write_csv
from signorini.output.sensitivities_table import sensitivities_data
from signorini.solution.history import History
from signorini.solution.sensitivities import Sensitivities, Validity

NAME = "sensitivities.json"
"""Of the file in a folder of results."""

_SAME_PRESSURE = 1e-6  # of a peak pressure: what two solves of one deck may differ by


def write_sensitivities(found: Sensitivities, folder: Path) -> None:
    """Write ``sensitivities.json``, plain data, and ``sensitivities.csv``, a row for each parameter.

    Parameters
    ----------
    found : per cent for per cent
    folder : which is made where it is not there
    """
    folder.mkdir(parents=True, exist_ok=True)
    data = sensitivities_data(found)
    with atomic_write(folder / NAME) as aside:
        Path(aside).write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    rows = []
    for part in data["parameters"]:
        holds = part["holds_per_cent"]
        ends = {"holds_from_per_cent": holds["low"], "holds_to_per_cent": holds["high"]}
        answers = dict(zip(found.outputs, part["per_cent"], strict=True))
        rows.append({"parameter": part["parameter"], "value": part["value"], **answers, **ends})
    columns = ["parameter", "value", *found.outputs, "holds_from_per_cent", "holds_to_per_cent"]
    write_csv(columns, rows, folder / "sensitivities.csv")


def read_sensitivities(folder: Path) -> Sensitivities | None:
    """Read those of a folder of results; None where none were written.

    Raises
    ------
    InputError
        Where the file holds something else.
    """
    file = folder / NAME
    if not file.is_file():
        return None
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
        outputs, rows = data["outputs"], data["parameters"]
        return Sensitivities(
            outputs=tuple(str(part["output"]) for part in outputs),
            values=np.array([float(part["value"]) for part in outputs]),
            parameters=tuple(str(row["parameter"]) for row in rows),
            given=np.array([float(row["value"]) for row in rows]),
            per_cent=np.array([row["per_cent"] for row in rows], dtype=np.float64).reshape(len(rows), len(outputs)),
            holds=tuple(_validity(row["holds_per_cent"]) for row in rows),
            refused=tuple(str(words) for words in data["refused"]),
        )
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"holds no sensitivities: {error}", where=(str(file),)) from error


def of_this_run(found: Sensitivities, history: History) -> bool:
    """Whether sensitivities are of a history: their peak pressures are those of its end."""
    known = dict(zip(found.outputs, found.values, strict=True))
    for contact in history.steps[-1].contacts if history.steps else ():
        told = known.get(f"peak pressure of '{contact.name}'")
        if told is not None and not math.isclose(told, float(contact.pressure.max()), rel_tol=_SAME_PRESSURE):
            return False
    return bool(history.steps)


def _validity(given: dict[str, object]) -> Validity:
    """The interval of a parameter; infinite where nothing ends it."""
    low, high = given["low"], given["high"]
    first, second = given["ends"]  # type: ignore[misc]
    return Validity(
        low=-math.inf if low is None else float(low),  # type: ignore[arg-type]
        high=math.inf if high is None else float(high),  # type: ignore[arg-type]
        ends=(str(first), str(second)),  # type: ignore[has-type]
    )
