# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a load history: contacts at the ends of its steps and on the way, and the contact forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.plot.curve import Curve, closed_range
from signorini.plot.result_folder import ResultFolder
from signorini.plot.style import INK, PRESSURE, STATUS_INK, TRACTION, dress
from signorini.solution.results import OPEN, SLIP, STICK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMED = 12  # steps that a legend can hold
_ACROSS = 0.01  # of the largest friction: what is worth a line of its own


def draw_history(folder: ResultFolder) -> Figure:
    """One row a contact. In the plane pressure and friction traction of every step, in space the largest pressure and
    what the nodes do on the way; forces and dissipation on the way.
    """
    from matplotlib.figure import Figure

    summary = folder.summary["steps"]
    names = [contact["name"] for contact in summary[0]["contacts"]] if summary else []
    rows = max(len(names), 1)
    figure = Figure(figsize=(13.0, 0.8 + 4.2 * rows), layout="constrained")
    panels = figure.subplots(rows, 3, squeeze=False)
    for i, name in enumerate(names):
        way = _way(folder, name)
        if folder.solid:
            _largest_pressure(panels[i, 0], way, name)
            _nodes(panels[i, 1], way, name)
        else:
            curves = [step[i] for step in folder.steps]
            _profiles(panels[i, 0], curves, "pressure")
            _profiles(panels[i, 1], curves, "traction")
        _forces(panels[i, 2], way, folder.solid)
        for axes in panels[i] if folder.solid else panels[i, 2:]:
            axes.set_xlim(0.0, len(summary) * 1.02)
            _steps_below(axes, summary)
    if not names:
        for panel in panels.flat:
            panel.set_axis_off()
    elif not folder.solid and len(summary) <= _NAMED:
        lines = panels[0, 0].get_lines()[: len(summary)]
        legend = figure.legend(handles=lines, loc="outside lower center", ncols=6, fontsize=9, frameon=False)
        legend.set_title("profiles at the end of step")
    figure.suptitle(folder.title, fontsize=12, color=INK)
    return figure


@dataclass(frozen=True, kw_only=True, eq=False)
class _Way:
    """A contact at the instants of a history, (m,) each, with its beginning where that is unloaded.

    Attributes
    ----------
    load : load factor
    normal, friction : (m, 3) forces on the nonmortar body
    largest : pressure
    counts : (3, m) nodes that are open, stick and slip
    dissipation : since the beginning
    ends : which of the instants are ends of steps
    """

    load: Array
    normal: Array
    friction: Array
    largest: Array
    counts: Array
    dissipation: Array
    ends: IntArray


def _way(folder: ResultFolder, name: str) -> _Way:
    rows = folder.instants_of(name)
    step, dissipation = _column(rows, "step"), _column(rows, "dissipation")
    ends = np.append(np.flatnonzero(np.diff(step)), len(rows) - 1)
    values = np.column_stack(
        [
            _column(rows, "load_factor"),
            _forces_of(rows, "normal"),
            _forces_of(rows, "tangential"),
            _column(rows, "max_pressure"),
            *(_column(rows, status) for status in (OPEN, STICK, SLIP)),
            _since_the_beginning(dissipation, ends),
        ]
    )
    if values[0, 0] > 0.0 and not folder.summary.get("goes_on", False):
        nothing = np.zeros_like(values[:1])
        nothing[0, 8] = values[0, 8:11].sum()
        values, ends = np.concatenate([nothing, values]), ends + 1
    return _Way(
        load=values[:, 0],
        normal=values[:, 1:4],
        friction=values[:, 4:7],
        largest=values[:, 7],
        counts=values[:, 8:11].T,
        dissipation=values[:, 11],
        ends=ends,
    )


def _largest_pressure(axes: Axes, way: _Way, name: str) -> None:
    axes.plot(way.load, way.largest, "-", color=PRESSURE, lw=1.5)
    axes.plot(way.load[way.ends], way.largest[way.ends], "o", color=PRESSURE, ms=5)
    axes.axhline(0.0, color=INK, lw=0.8)
    axes.set_ylabel(f"largest pressure of '{name}', force per area", fontsize=10, color=INK)
    dress(axes)


def _nodes(axes: Axes, way: _Way, name: str) -> None:
    """How many nodes stick and slip, from every instant back to the one before."""
    _, stick, slip = way.counts
    for low, high, status in ((0.0 * stick, stick, STICK), (stick, stick + slip, SLIP)):
        axes.fill_between(way.load, low, high, step="pre", color=STATUS_INK[status], alpha=0.6, lw=0.0, label=status)
    axes.set_ylim(0.0, 1.15 * max(1.0, float((stick + slip).max())))
    axes.set_ylabel(f"nodes of '{name}', of {way.counts[:, 0].sum():.0f}", fontsize=10, color=INK)
    dress(axes)
    axes.legend(fontsize=8.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def _profiles(axes: Axes, curves: list[Curve], what: str) -> None:
    from matplotlib import colormaps

    colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(curves)))
    for number, (curve, colour) in enumerate(zip(curves, colours, strict=True), start=1):
        axes.plot(curve.s, getattr(curve, what), "o-", ms=3, lw=1.5, color=colour, label=f"{number} {curve.step}")
    ranges = np.array([closed_range(curve) for curve in curves])
    if len(curves[0].s) > 1:
        axes.set_xlim(ranges[:, 0].min(), ranges[:, 1].max())
    axes.axhline(0.0, color=INK, lw=0.8)
    axes.set_xlabel(f"{curves[0].axis} along '{curves[0].contact}', undeformed", fontsize=10, color=INK)
    words = "pressure" if what == "pressure" else "friction along the tangent"
    axes.set_ylabel(f"{words}, force per area", fontsize=10, color=INK)
    dress(axes)


def _forces(axes: Axes, way: _Way, solid: bool) -> None:
    """Normal force, friction force with its sign, and dissipation, at every instant."""
    along, words = _direction(way, solid)
    for values, colour, mark, said in (
        (np.linalg.norm(way.normal, axis=1), PRESSURE, "o", "normal force"),
        (way.friction @ along, TRACTION, "s", f"friction force, {words}"),
    ):
        axes.plot(way.load, values, "-", color=colour, lw=1.5)
        axes.plot(way.load[way.ends], values[way.ends], mark, color=colour, ms=5)
        axes.plot([], [], f"{mark}-", color=colour, label=said)
    across = np.linalg.norm(way.friction - np.outer(way.friction @ along, along), axis=1)
    if across.max() > _ACROSS * np.abs(way.friction).max():
        axes.plot(way.load, across, ":", color=TRACTION, lw=1.5, label="friction force across that")
    axes.axhline(0.0, color=INK, lw=0.8)
    axes.set_ylabel("force on the nonmortar body", fontsize=10, color=INK)
    dress(axes)
    handles, labels = axes.get_legend_handles_labels()
    if way.dissipation.max() > 0.0:
        beside = axes.twinx()
        handles += beside.plot(way.load, way.dissipation, "-.", color=INK, lw=1.2)
        labels.append("dissipation since the beginning")
        beside.set_ylabel("work", fontsize=10, color=INK)
        beside.set_ylim(0.0, 1.3 * way.dissipation.max())
        beside.spines["top"].set_visible(False)
    axes.legend(handles, labels, fontsize=8.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def _direction(way: _Way, solid: bool) -> tuple[Array, str]:
    """The direction along which friction is drawn, and its words: the mean tangent, or in space that of the largest."""
    if solid:
        size = np.linalg.norm(way.friction, axis=1)
        largest = way.friction[np.argmax(size)] / (size.max() or 1.0)
        along = largest * np.copysign(1.0, largest[np.argmax(np.abs(largest))])
        return along, f"along {_spelled(along)}"
    pressed = way.normal[np.argmax(np.linalg.norm(way.normal, axis=1))]
    return np.array([pressed[1], -pressed[0], 0.0]) / (np.linalg.norm(pressed) or 1.0), "along the tangent"


def _spelled(vector: Array) -> str:
    """Components of a unit vector in words."""
    return f"({', '.join(f'{part:.2g}' for part in np.where(np.abs(vector) < _ACROSS, 0.0, vector))})"


def _steps_below(axes: Axes, steps: list[dict[str, Any]]) -> None:
    """Step k ends at the load factor k: its name is there, where names fit."""
    numbers = np.arange(1, len(steps) + 1)
    if len(steps) <= _NAMED:
        axes.set_xticks(numbers, [f"{k} {step['name']}" for k, step in zip(numbers, steps, strict=True)], fontsize=9)
    axes.set_xlabel("load factor: ends of steps", fontsize=10, color=INK)


def _since_the_beginning(values: Array, ends: IntArray) -> Array:
    """What counts from the beginning of each step, counted from the beginning of the first."""
    before = np.concatenate([[0.0], np.cumsum(values[ends])[:-1]])
    total: Array = values + np.repeat(before, np.diff(np.append(-1, ends)))
    return total


def _column(rows: list[dict[str, str]], name: str) -> Array:
    return np.array([float(row[name]) for row in rows])


def _forces_of(rows: list[dict[str, str]], what: str) -> Array:
    return np.stack([_column(rows, f"{what}_force_{axis}") for axis in "xyz"], axis=1)
