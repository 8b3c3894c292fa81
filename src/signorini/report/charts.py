# SPDX-License-Identifier: BSD-3-Clause
"""Charts as SVG that stand without a script; page.js lets a reader ask them for numbers and choose a step."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.plot.style import round_number
from signorini.report.markup import said

WIDTH, HEIGHT = 640, 330  # of a chart, in its own units
LEFT, RIGHT, TOP, BOTTOM = 78, 14, 12, 52  # margins for numbers and names of axes
_MOST_POINTS = 3000  # of one line: more cannot be seen
_TICKS = 6  # of an axis, at most about


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """A line of a chart.

    Attributes
    ----------
    name : in the legend
    x, y : (n,)
    colour : number of the page's colours, 0 .. 4
    dashed : whether it is a bound rather than a result
    """

    name: str
    x: Array
    y: Array
    colour: int
    dashed: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class ChartData:
    """A chart of one group of lines, or of several of which one is seen at a time.

    Attributes
    ----------
    title, x, y : words above it and at its axes
    groups : name to lines; the last one is seen first
    """

    title: str
    x: str
    y: str
    groups: Mapping[str, Sequence[Line]]


def chart(data: ChartData) -> str:
    """HTML of a chart: its drawing, legend, numbers for the script, and a slider where there are several groups."""
    lines = [line for group in data.groups.values() for line in group]
    across, up = axis_of([line.x for line in lines], zero=False), axis_of([line.y for line in lines], zero=True)
    last = len(data.groups) - 1
    groups = "".join(
        f'<g class="group"{" hidden" * (number < last)}>{"".join(_drawn(line, across, up) for line in group)}</g>'
        for number, group in enumerate(data.groups.values())
    )
    box = f"0 0 {WIDTH} {HEIGHT}"
    words = f"{data.title}: {data.y} over {data.x}"
    slider = ""
    if last:
        slider = (
            f'<label class="screen">{said(list(data.groups)[-1])} '
            f'<input type="range" min="0" max="{last}" value="{last}" aria-label="step"></label>'
        )
    shown = list(data.groups.values())[-1]
    named = {line.name: f'<i class="c{line.colour}{" dashed" * line.dashed}"></i>' for line in shown}
    legend = "".join(f"<span>{look}{said(name)}</span>" for name, look in named.items())
    return (
        f'<figure class="chart"><figcaption>{said(data.title)}{slider}</figcaption>'
        f'<svg viewBox="{box}" role="img" tabindex="0" aria-label="{said(words)}">'
        f'{drawn_axes(across, up, (data.x, data.y))}{groups}<path class="cursor" d=""/></svg>'
        f'<div class="legend">{legend}</div><output aria-live="polite"></output>'
        f'<script type="application/json">{_data(data, across)}</script></figure>'
    )


@dataclass(frozen=True)
class Axis:
    """From ``low`` to ``high``, with a mark at every ``step``."""

    low: float
    high: float
    step: float

    @property
    def marks(self) -> list[float]:
        """Where marks are."""
        first, last = math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9)
        return [self.step * number for number in range(first, last + 1)]


def axis_of(values: Sequence[Array], *, zero: bool) -> Axis:
    """An axis that holds all values, each (n,), and zero with some room if that is to be seen."""
    every = np.concatenate([np.zeros(int(zero)), *(part[np.isfinite(part)] for part in values)])
    low, high = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
    wide = high - low
    if wide <= 1e-12 * max(abs(low), abs(high), 1e-300):
        wide = abs(high) or 1.0
        low, high = low - 0.5 * wide, high + 0.5 * wide
    room = 0.05 * wide if zero else 0.0
    return Axis(low - room * (low < 0.0), high + room * (high > 0.0), round_number(2.0 * wide / _TICKS))


def places(across: Axis, up: Axis, x: Array, y: Array, height: float = HEIGHT) -> tuple[Array, Array]:
    """Coordinates of a drawing of values x and y (n,).

    Parameters
    ----------
    across, up : its axes
    x, y : (n,)
    height : of the drawing
    """
    right = LEFT + (x - across.low) / (across.high - across.low) * (WIDTH - LEFT - RIGHT)
    down = height - BOTTOM - (y - up.low) / (up.high - up.low) * (height - TOP - BOTTOM)
    return right, down


def _drawn(line: Line, across: Axis, up: Axis) -> str:
    way, pen = [], "M"
    stride = -(-len(line.x) // _MOST_POINTS)
    found = places(across, up, line.x[::stride], line.y[::stride])
    for x, y in zip(*(part.tolist() for part in found), strict=True):
        if math.isfinite(x) and math.isfinite(y):
            way.append(f"{pen}{x:.1f} {y:.1f}")
            pen = "L"
        else:
            pen = "M"
    return f'<path class="line c{line.colour}{" dashed" * line.dashed}" d="{"".join(way)}"/>'


def drawn_axes(across: Axis, up: Axis, names: tuple[str, str], height: float = HEIGHT) -> str:
    """Axes, marks and words of a drawing.

    Parameters
    ----------
    across, up : the axes
    names : what they are
    height : of the drawing
    """
    floor, wall = height - BOTTOM, WIDTH - RIGHT
    marks = []
    for value in across.marks:
        x = LEFT + (value - across.low) / (across.high - across.low) * (wall - LEFT)
        marks.append(f'<path class="grid" d="M{x:.1f} {TOP}V{floor}"/>')
        marks.append(f'<text x="{x:.1f}" y="{floor + 17}" text-anchor="middle">{_number(value, across.step)}</text>')
    for value in up.marks:
        y = floor - (value - up.low) / (up.high - up.low) * (floor - TOP)
        kind = "zero" if abs(value) < 1e-9 * up.step else "grid"
        marks.append(f'<path class="{kind}" d="M{LEFT} {y:.1f}H{wall}"/>')
        marks.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{_number(value, up.step)}</text>')
    middle = 0.5 * (TOP + floor)
    words = (
        f'<text x="{0.5 * (LEFT + wall)}" y="{height - 12}" text-anchor="middle">{said(names[0])}</text>'
        f'<text transform="translate(14 {middle}) rotate(-90)" text-anchor="middle">{said(names[1])}</text>'
    )
    return "".join(marks) + words


def _number(value: float, step: float) -> str:
    return f"{0.0 if abs(value) < 1e-9 * step else value:.6g}"


def _data(data: ChartData, across: Axis) -> str:
    """Numbers for the script; a "<" in a name ends no script."""
    groups = [
        {
            "name": name,
            "lines": [
                {
                    "name": line.name,
                    "x": _rounded(line.x[:: -(-len(line.x) // _MOST_POINTS)]),
                    "y": _rounded(line.y[:: -(-len(line.x) // _MOST_POINTS)]),
                }
                for line in group
                if not line.dashed
            ],
        }
        for name, group in data.groups.items()
    ]
    frame = {"low": across.low, "high": across.high, "left": LEFT, "right": WIDTH - RIGHT}
    box = {"top": TOP, "bottom": HEIGHT - BOTTOM}
    text = json.dumps({"x": data.x, "groups": groups} | frame | box, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c")


def _rounded(values: Array) -> list[float | None]:
    return [float(f"{value:.6g}") if math.isfinite(value) else None for value in values.tolist()]
