# SPDX-License-Identifier: BSD-3-Clause
"""A study as a picture: main answers over the parameter with the most values, a line for each of what else varies."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from signorini.errors import InputError
from signorini.plot.style import dress, entitle, literal
from signorini.plot.units import units_of
from signorini.study.row import StudyRow

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PANELS = (
    ("max_pressure", "largest pressure, force per area"),
    ("friction_force", "friction, force"),
    ("max_slip", "largest slip, length"),
    ("dissipation", "dissipation, work"),
)
_MOST_LINES = 10  # in a panel: more are told apart by no colour
_TANGENTIAL = re.compile(r"(.*)\.tangential_force_[xyz]")


def draw_sweep(rows: Sequence[StudyRow], title: str, units: str) -> Figure:
    """Draw a study.

    Parameters
    ----------
    rows : of the study; those without answers are left out
    title, units : of the problem

    Raises
    ------
    InputError
        If no parameter has two numbers for which there are answers.
    """
    from matplotlib.figure import Figure

    solved = [row for row in rows if row.solved]
    numbers = {key: {row.values[key] for row in solved} for key in (solved[0].values if solved else ())}
    known = [key for key, own in numbers.items() if len(own) > 1 and not any(isinstance(x, str) for x in own)]
    if not known:
        raise InputError(
            "there is no parameter with two numbers for which there are answers; expected one to draw over"
        )
    over = max(known, key=lambda key: len(numbers[key]))
    figure = Figure(figsize=(11.0, 8.0), layout="constrained")
    for axes, (quantity, words) in zip(figure.subplots(2, 2).flat, _PANELS, strict=True):
        lines = _lines(solved, over, quantity)
        for name, points in list(lines.items())[:_MOST_LINES]:
            axes.plot(*zip(*sorted(points), strict=True), "o-", ms=4, lw=1.3, label=name)
        dress(axes, x=over, y=words)
        if 1 < len(lines) <= _MOST_LINES:
            axes.legend(fontsize=8, frameon=False)
    entitle(figure, title, f"{len(solved)} of {len(rows)} rows are solved and certified")
    return literal(figure, units_of(units))


def _lines(rows: Sequence[StudyRow], over: str, quantity: str) -> dict[str, list[tuple[float, float]]]:
    """Points over a parameter, by contact and by what else varies."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        others = [f"{key} = {value}" for key, value in row.values.items() if key != over]
        for contact, value in _by_contact(row, quantity).items():
            found.setdefault(", ".join(filter(None, [contact, *others])), []).append((float(row.values[over]), value))
    return found


def _by_contact(row: StudyRow, quantity: str) -> dict[str, float]:
    """Contact to a quantity of it; the friction force is the size of its resultant."""
    if quantity != "friction_force":
        ending = f".{quantity}"
        return {name.removesuffix(ending): own for name, own in row.outputs.items() if name.endswith(ending)}
    found: dict[str, float] = {}
    for name, own in row.outputs.items():
        contact = _TANGENTIAL.fullmatch(name)
        if contact:
            found[contact[1]] = math.hypot(found.get(contact[1], 0.0), own)
    return found
