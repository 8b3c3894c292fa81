# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a load history: pressure and friction at the end of every step, and the contact forces on the way."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.plot.curve import Curve, closed_range
from signorini.plot.files import ResultFolder
from signorini.plot.style import INK, PRESSURE, TRACTION, dress

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMED = 12  # steps that a legend can hold


def draw_history(folder: ResultFolder) -> Figure:
    """One row a contact: pressure and friction traction of every step; forces and dissipation on the way."""
    from matplotlib.figure import Figure

    steps = folder.steps
    contacts = [curve.contact for curve in steps[0]] if steps else []
    rows = max(len(contacts), 1)
    figure = Figure(figsize=(13.0, 0.8 + 4.2 * rows), layout="constrained")
    panels = figure.subplots(rows, 3, squeeze=False)
    for i in range(len(contacts)):
        curves = [step[i] for step in steps]
        _profiles(panels[i, 0], curves, "pressure")
        _profiles(panels[i, 1], curves, "traction")
        _forces(panels[i, 2], folder, i)
    if not contacts:
        for panel in panels.flat:
            panel.set_axis_off()
    elif len(steps) <= _NAMED:
        lines = panels[0, 0].get_lines()[: len(steps)]
        legend = figure.legend(handles=lines, loc="outside lower center", ncols=6, fontsize=9, frameon=False)
        legend.set_title("profiles at the end of step")
    figure.suptitle(folder.title, fontsize=12, color=INK)
    return figure


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


def _forces(axes: Axes, folder: ResultFolder, i: int) -> None:
    """Normal force, friction force along the mean tangent with its sign, and dissipation, at every instant."""
    steps = folder.summary["steps"]
    name = steps[0]["contacts"][i]["name"]
    rows = folder.instants_of(name)
    load, normal, friction = _column(rows, "load_factor"), _forces_of(rows, "normal"), _forces_of(rows, "tangential")
    pressed = normal[np.argmax(np.linalg.norm(normal, axis=1))]
    tangent = np.array([pressed[1], -pressed[0], 0.0]) / (np.linalg.norm(pressed) or 1.0)
    ends = np.append(np.flatnonzero(np.diff(_column(rows, "step"))), len(rows) - 1)
    for values, colour, mark, words in (
        (np.linalg.norm(normal, axis=1), PRESSURE, "o", "normal force"),
        (friction @ tangent, TRACTION, "s", "friction force, along the tangent"),
    ):
        axes.plot(load, values, "-", color=colour, lw=1.5)
        axes.plot(load[ends], values[ends], mark, color=colour, ms=5)
        axes.plot([], [], f"{mark}-", color=colour, label=words)
    axes.axhline(0.0, color=INK, lw=0.8)
    axes.set_xlim(0.0, len(steps) * 1.02)
    axes.set_ylabel("force on the nonmortar body", fontsize=10, color=INK)
    dress(axes)
    _steps_below(axes, steps)
    handles, labels = axes.get_legend_handles_labels()
    dissipation = _since_the_beginning(_column(rows, "dissipation"), ends)
    if dissipation.max() > 0.0:
        beside = axes.twinx()
        handles += beside.plot(load, dissipation, "-.", color=INK, lw=1.2)
        labels.append("dissipation since the beginning")
        beside.set_ylabel("work", fontsize=10, color=INK)
        beside.set_ylim(0.0, 1.3 * dissipation.max())
        beside.spines["top"].set_visible(False)
    axes.legend(handles, labels, fontsize=8.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


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
