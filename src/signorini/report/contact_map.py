# SPDX-License-Identifier: BSD-3-Clause
"""Maps of contacts in space as SVG: what a reader chooses to see of them, at the end of a step; page.js answers."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.plot.patch import Patch, patch_of, window_of
from signorini.plot.picture_data import PictureData
from signorini.plot.style import STATUS_INK, named, round_number
from signorini.plot.units import Units
from signorini.report.charts import BOTTOM, LEFT, RIGHT, TOP, WIDTH, Axis, drawn_axes, places
from signorini.report.markup import said

_MOST_FACES = 6000  # of a map: about half a megabyte of the page
_MOST_VALUES = 60_000  # of nodes times steps on a page; of more only some of the steps are there
_LEAST_HEIGHT, _MOST_HEIGHT = 140, 420  # of what is between the axes, in units of charts
_ROOM = 0.04  # of the size of a window: around it
_MARKS = 4  # of the shorter axis, at most about
_SHADES = 64  # colours of a range


class _Step(NamedTuple):
    """A contact at the end of a step, in words and as it is there."""

    words: str
    patch: Patch


def contact_maps(data: PictureData) -> Iterator[str]:
    """HTML of every contact in space whose faces are not too many for a page."""
    for i, last in enumerate(data.patches):
        if len(last.faces) <= _MOST_FACES:
            yield _map(last, _steps(data, i, last), data.units)


def _steps(data: PictureData, i: int, last: Patch) -> list[_Step]:
    """One contact at the ends of those steps whose faces are those of the last."""
    count = len(data.history.steps)
    some = np.linspace(1, count, min(count, max(1, _MOST_VALUES // max(len(last.points), 1))))
    found = []
    for number in sorted({count, *some.round().astype(int).tolist()}):
        step = data.history.steps[number - 1]
        patch = patch_of(data.model, step.contacts[i])
        if np.array_equal(patch.faces, last.faces):
            found.append(_Step(f"end of step {number}, {step.name}", patch))
    return found


def _map(last: Patch, steps: Sequence[_Step], units: Units) -> str:
    """Faces in colours, axes, choices, and numbers for the script."""
    chart, (across, up, height) = last.chart, _axes(last)
    right, down = places(across, up, chart.at[:, 0], chart.at[:, 1], height)
    names = [f"pressure, {units.pressure}", f"friction, {units.pressure}", f"slip, {units.length}"]
    tops = np.max([[values.max(initial=0.0) for values in _fields(step.patch)] for step in steps], axis=0)
    numbers = {
        "x": right.round(1).tolist(),
        "y": down.round(1).tolist(),
        "at": [f"({', '.join(f'{x:.6g}' for x in point)})" for point in last.points[chart.node].tolist()],
        "faces": chart.faces.tolist(),
        "names": names,
        "tops": tops.tolist(),
        "states": list(STATUS_INK.items()),
        "colours": _ramp(),
        "steps": [_numbers(step, chart.node) for step in steps],
    }
    axes = [named(f"{words}, length", units) for words in chart.labels]
    words = f"{last.contact}: {names[0]}, {steps[-1].words}"
    return (
        f'<figure class="map"><figcaption>{said(last.contact)}: on its surface{_choices(names, steps)}</figcaption>'
        f'<svg viewBox="0 0 {WIDTH} {height:.0f}" role="img" tabindex="0" aria-label="{said(words)}">'
        f'<svg x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{height - TOP - BOTTOM:.0f}" '
        f'viewBox="{LEFT} {TOP} {WIDTH - LEFT - RIGHT} {height - TOP - BOTTOM:.0f}">'
        f'<g class="faces">{_faces(last, right, down, float(tops[0]))}</g><circle class="cursor" r="5" cx="-9"/></svg>'
        f'{drawn_axes(across, up, (axes[0], axes[1]), height)}</svg><div class="legend"></div>'
        f'<p class="key">{said(names[0])}: 0 <span class="ramp"></span> {tops[0]:.4g}</p>'
        f'<output aria-live="polite"></output>'
        f'<script type="application/json">{json.dumps(numbers, separators=(",", ":")).replace("<", chr(92) + "u003c")}'
        "</script></figure>"
    )


def _choices(names: Sequence[str], steps: Sequence[_Step]) -> str:
    """What is shown, and of which step where there are several."""
    options = "".join(f'<option value="{k}">{said(name)}</option>' for k, name in enumerate([*names, "status"]))
    last = len(steps) - 1
    slider = f'<input type="range" min="0" max="{last}" value="{last}" aria-label="step">'
    when = f"<label><span>{said(steps[-1].words)}</span> {slider}</label>" if last else ""
    return f'<span class="screen"><select aria-label="what is shown">{options}</select> {when}</span>'


def _fields(patch: Patch) -> tuple[Array, Array, Array]:
    """Pressure, size of the friction and of the slip, (n,) each."""
    return patch.pressure, np.linalg.norm(patch.shear, axis=1), patch.slip


def _numbers(step: _Step, node: IntArray) -> dict[str, Any]:
    """What the script knows of a step, at the places of a chart."""
    codes = {words: k for k, words in enumerate(STATUS_INK)}
    values = [[float(f"{value:.5g}") for value in field[node].tolist()] for field in _fields(step.patch)]
    return {
        "name": step.words,
        "values": values,
        "status": [codes[words] for words in step.patch.status[node].tolist()],
    }


def _faces(patch: Patch, right: Array, down: Array, top: float) -> str:
    """Every face in the colour of its mean pressure, as the script does it."""
    shades = (_SHADES - 1) * np.clip(patch.pressure[patch.chart.node] / (top or 1.0), 0.0, 1.0)
    ways, ramp = [f"{x:.1f} {y:.1f}" for x, y in zip(right, down, strict=True)], _ramp()
    drawn = []
    for face in patch.chart.faces.tolist():
        ring = face[: 3 if face[2] == face[3] else 4]
        shade = ramp[round(float(np.mean(shades[ring])))]
        drawn.append(f'<path fill="{shade}" d="M{"L".join(ways[k] for k in ring)}Z"/>')
    return "".join(drawn)


def _ramp() -> list[str]:
    """Colours from nothing to the most."""
    import matplotlib
    from matplotlib.colors import to_hex

    return [to_hex(colour) for colour in matplotlib.colormaps["viridis"](np.linspace(0.0, 1.0, _SHADES))]


def _axes(patch: Patch) -> tuple[Axis, Axis, float]:
    """Axes of one scale around what touches, and the height of the drawing."""
    low, high = window_of(patch)
    room = _ROOM * float((high - low).max())
    size = np.maximum(high - low + 2.0 * room, 1e-300)
    wide = WIDTH - LEFT - RIGHT
    tall = float(np.clip(wide * size[1] / size[0], _LEAST_HEIGHT, _MOST_HEIGHT))
    scale = min(wide / size[0], tall / size[1])
    middle, half = 0.5 * (low + high), 0.5 * np.array([wide, tall]) / scale
    step = round_number(2.0 * float(half.min()) / _MARKS * 2.0)
    across, up = (Axis(float(m - h), float(m + h), step) for m, h in zip(middle, half, strict=True))
    return across, up, tall + TOP + BOTTOM
