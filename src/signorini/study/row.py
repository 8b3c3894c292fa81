# SPDX-License-Identifier: BSD-3-Clause
"""A row of a study: a combination of values, how its solve ended, and the main answers at the end of its history."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from signorini.errors import InputError
from signorini.outcome import Outcome
from signorini.output.history_table import history_columns
from signorini.plot.units import units_of
from signorini.short import Short
from signorini.solution.history import History
from signorini.study.values import Value

WRONG_INPUT, BROKEN = "wrong_input", "error"
"""Endings of a row besides those of a history: its values do not go together; the program or the machine failed."""

_NO_OUTPUT = re.compile(r"(step|name|load_factor|what|factor\..*)")
_QUANTITIES = (
    (r".*(normal|tangential)_force_[xyz]", "force"),
    (r".*\.moment(_[xyz])?|(.*[._])?(work|dissipation|energy)", "work"),
    (r".*\.max_pressure", "pressure"),
    (r".*\.closed_area", "area"),
    (r".*\.(max_slip|max_depth)", "length"),
)


@dataclass(frozen=True, kw_only=True, repr=False)
class StudyRow(Short):
    """One combination of a study.

    Attributes
    ----------
    values : of the parameters, by key
    status : "solved", or why not: as of a history, "wrong_input", or "error" of the program or the machine
    message : the same in words, empty where solved
    certified : whether every step has passed its certificate
    outputs : the main answers at the end of the history by name, as of `Solution.history_table`; none where not solved
    cpu_seconds, wall_seconds : spent on the row, on what was prepared for it and others in the first of these
    """

    values: Mapping[str, Value]
    status: str
    message: str = ""
    certified: bool = False
    outputs: Mapping[str, float]
    cpu_seconds: float = 0.0
    wall_seconds: float = 0.0

    @property
    def solved(self) -> bool:
        """Whether there are outputs that may be used."""
        return self.status == Outcome.SOLVED and self.certified


def outputs_of(history: History) -> dict[str, float]:
    """The main answers at the end of a history by name.

    Resultants, largest pressure, closed area, counts, largest slip of every contact, energies; with the errors of an
    accuracy, the largest equivalent plastic strain, worn depths and fatigue where these were asked for.

    Parameters
    ----------
    history : solved
    """
    last = replace(history.last, instants=history.last.instants[-1:])
    columns = history_columns(replace(history, steps=(last,)), (), dict)
    found = {name: columns[name][-1].item() for name in columns if not _NO_OUTPUT.fullmatch(name)}
    found["strain_energy"] = float(last.strain_energy)
    if last.yielding is not None:
        found["max_equivalent_strain"] = float(last.yielding.largest)
    for contact in last.contacts:
        if contact.wear is not None:
            found[f"{contact.name}.max_depth"] = float(max(contact.wear.deepest))
    for number, result in enumerate(history.fatigue_results, start=1):
        found[f"fatigue_{number}.parameter"] = float(result.at_worst.parameter[0])
        if result.lives:
            found[f"fatigue_{number}.life"] = float(result.at_worst.life[0])
    if history.accuracy is not None:
        found |= {"pressure_error": history.accuracy.pressure, "nodes": len(history.model.mesh.points)}
    return found


def unit_of(output: str, words: str) -> str:
    """Unit of an output, in the units that a model names; empty where it has none or none is named.

    Parameters
    ----------
    output : its name
    words : units of the model

    Examples
    --------
    >>> unit_of("c.max_pressure", "mm, N, MPa"), unit_of("work", "mm, N"), unit_of("c.stick", "mm, N")
    ('MPa', 'N mm', '')
    """
    units, plain = units_of(words), units_of("")
    quantity = next((kind for pattern, kind in _QUANTITIES if re.fullmatch(pattern, output)), "")
    if quantity == "area":
        return "" if units.length == plain.length else f"{units.length}^2"
    unit = str(getattr(units, quantity)) if quantity else ""
    return "" if quantity and unit == getattr(plain, quantity) else unit


def row_of(values: Mapping[str, Value], history: History) -> StudyRow:
    """The row of a history, finished or not.

    Parameters
    ----------
    values : of the parameters
    history : that was solved with them
    """
    passed = history.solved and all(step.certificate.passed for step in history.steps)
    return StudyRow(
        values=dict(values),
        status=str(history.status),
        message=in_a_line(history.message),
        certified=passed,
        outputs=outputs_of(history) if passed else {},
    )


def failed_row(values: Mapping[str, Value], error: Exception) -> StudyRow:
    """The row of a combination that has no history.

    Parameters
    ----------
    values : of the parameters
    error : that ended it
    """
    words = in_a_line(str(error))
    if isinstance(error, InputError):
        return StudyRow(values=dict(values), status=WRONG_INPUT, message=words, outputs={})
    return StudyRow(
        values=dict(values), status=BROKEN, message=f"{type(error).__name__}: {words}".rstrip(": "), outputs={}
    )


def in_a_line(message: str) -> str:
    """A message of several lines in one.

    >>> in_a_line("the body leaves\\n  what to do: hold it")
    'the body leaves; what to do: hold it'
    """
    return "; ".join(" ".join(line.split()) for line in message.splitlines())
