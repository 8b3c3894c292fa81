# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a load history: pressure and friction at the end of every step, and the contact forces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from signorini.plot.curve import Curve, closed_range
from signorini.plot.files import ResultFolder
from signorini.plot.style import INK, PRESSURE, TRACTION, dress

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMED = 12  # steps that a legend can hold


def draw_history(folder: ResultFolder) -> Figure:
    """One row a contact: pressure and friction traction of every step, and the sizes of the forces."""
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
    """Normal force, and friction force along the mean tangent with its sign, over the steps."""
    steps = folder.summary["steps"]
    normal = np.array([step["contacts"][i]["normal_force"] for step in steps])
    friction = np.array([step["contacts"][i]["tangential_force"] for step in steps])
    pressed = normal[np.argmax(np.linalg.norm(normal, axis=1))]
    tangent = np.array([pressed[1], -pressed[0]]) / (np.linalg.norm(pressed) or 1.0)
    numbers = np.arange(1, len(steps) + 1)
    axes.plot(numbers, np.linalg.norm(normal, axis=1), "o-", color=PRESSURE, label="normal force")
    axes.plot(numbers, friction @ tangent, "s-", color=TRACTION, label="friction force, along the tangent")
    axes.axhline(0.0, color=INK, lw=0.8)
    axes.set_xticks(numbers if len(steps) <= _NAMED else axes.get_xticks())
    if len(steps) <= _NAMED:
        axes.set_xticklabels([f"{k} {step['name']}" for k, step in zip(numbers, steps, strict=True)], fontsize=9)
    axes.set_xlim(0.5, len(steps) + 0.5)
    axes.set_xlabel("end of step", fontsize=10, color=INK)
    axes.set_ylabel("force on the nonmortar body", fontsize=10, color=INK)
    dress(axes)
    axes.legend(fontsize=8.5, frameon=True, framealpha=0.92, edgecolor="none")
