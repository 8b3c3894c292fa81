# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a load history: contacts at the ends of its steps and on the way, and the contact forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array, IntArray, padded
from signorini.plot.curve import Curve, closed_range
from signorini.plot.picture_data import PictureData
from signorini.plot.style import HOOP, INK, PLAIN, PRESSURE, STATUS_INK, TRACTION, dress, entitle, label
from signorini.solution.history import History
from signorini.solution.results import OPEN, SLIP, STICK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MAX_NAMED_STEPS = 12  # in one legend, or below one axis
_MIN_SHARE = 0.01  # of the largest friction: smaller components are not worth a line or a digit


def draw_history(data: PictureData) -> Figure:
    """One row a contact. In the plane pressure and friction traction of every step, in space the largest pressure and
    what the nodes do on the way; forces and dissipation on the way.
    """
    from matplotlib.figure import Figure

    steps = [step.name for step in data.history.steps]
    names = [contact.label for contact in data.model.contacts]
    rows = max(len(names), 1)
    figure = Figure(figsize=(13.0, 0.8 + 4.2 * rows), layout="constrained")
    panels = figure.subplots(rows, 3, squeeze=False)
    ends = [] if data.solid else [data.curves(number) for number in range(1, len(steps) + 1)]
    for i, name in enumerate(names):
        forces = contact_forces(data.history, i)
        if data.solid:
            _largest_pressure(panels[i, 0], forces, name)
            _nodes(panels[i, 1], forces, name)
        else:
            curves = [step[i] for step in ends]
            _profiles(panels[i, 0], curves, steps, "pressure")
            _profiles(panels[i, 1], curves, steps, "traction")
        _resultants(panels[i, 2], forces, data)
        for axes in panels[i] if data.solid else panels[i, 2:]:
            axes.set_xlim(0.0, len(steps) * 1.02)
            _steps_below(axes, steps)
    if not names:
        for panel in panels.flat:
            panel.set_axis_off()
    elif not data.solid and len(steps) <= _MAX_NAMED_STEPS:
        lines = panels[0, 0].get_lines()[: len(steps)]
        legend = figure.legend(handles=lines, loc="outside lower center", ncols=6, fontsize=9, frameon=False)
        legend.set_title("profiles at the end of step")
    entitle(figure, data.model.title)
    return figure


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactForces:
    """A contact at the instants of a history, (m,) each, with its beginning where that is unloaded.

    Attributes
    ----------
    load : load factor
    normal, friction : (m, 3) forces on the nonmortar body, with twist the third the torque over the largest radius
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


def contact_forces(history: History, i: int) -> ContactForces:
    """The contact i of the model."""
    instants = [instant for step in history.steps for instant in step.instants]
    contacts = [instant.contacts[i] for instant in instants]
    load = np.array([instant.load_factor for instant in instants])
    counts = np.array([[contact.count(status) for status in (OPEN, STICK, SLIP)] for contact in contacts], float)
    ends = np.cumsum([len(step.instants) for step in history.steps]) - 1
    unloaded = load[0] > 0.0 and not history.loaded
    radius = float(contacts[0].points[:, 0].max()) if history.model.twists else 1.0

    def course(values: Array, first: Array | float = 0.0) -> Array:
        return np.concatenate([np.full_like(values[:1], first), values]) if unloaded else values

    return ContactForces(
        load=course(load),
        normal=course(padded(np.array([contact.normal_force for contact in contacts]), 3)),
        friction=course(padded(np.array([contact.tangential_force for contact in contacts]), 3) / [1.0, 1.0, radius]),
        largest=course(np.array([contact.pressure.max(initial=0.0) for contact in contacts])),
        counts=course(counts, np.array([counts[0].sum(), 0.0, 0.0])).T,
        dissipation=course(_since_the_beginning(np.array([contact.dissipation for contact in contacts]), ends)),
        ends=ends + unloaded,
    )


def _largest_pressure(axes: Axes, forces: ContactForces, name: str) -> None:
    axes.plot(forces.load, forces.largest, "-", color=PRESSURE, lw=1.5)
    axes.plot(forces.load[forces.ends], forces.largest[forces.ends], "o", color=PRESSURE, ms=5)
    dress(axes, y=f"largest pressure of '{name}', force per area")


def _nodes(axes: Axes, forces: ContactForces, name: str) -> None:
    """Numbers of nodes that stick and slip, from every instant back to the one before."""
    _, stick, slip = forces.counts
    slips = SLIP if np.any(forces.friction) else PLAIN
    for low, high, status in ((0.0 * stick, stick, STICK), (stick, stick + slip, slips)):
        if np.any(high > low):
            ink = STATUS_INK[status]
            axes.fill_between(forces.load, low, high, step="pre", color=ink, alpha=0.6, lw=0.0, label=status)
    axes.set_ylim(0.0, 1.15 * max(1.0, float((stick + slip).max())))
    dress(axes, y=f"nodes of '{name}', of {forces.counts[:, 0].sum():.0f}")
    axes.legend(fontsize=8.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def _profiles(axes: Axes, curves: list[Curve], steps: list[str], what: str) -> None:
    from matplotlib import colormaps

    colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(curves)))
    for number, (curve, step, colour) in enumerate(zip(curves, steps, colours, strict=True), start=1):
        axes.plot(curve.s, getattr(curve, what), "o-", ms=3, lw=1.5, color=colour, label=f"{number} {step}")
        if what == "traction" and curve.hoop is not None:
            axes.plot(curve.s, curve.hoop, "^--", ms=3, lw=1.2, color=colour)
    ranges = np.array([closed_range(curve) for curve in curves])
    if len(curves[0].s) > 1:
        axes.set_xlim(ranges[:, 0].min(), ranges[:, 1].max())
    words = "pressure" if what == "pressure" else "friction along the tangent"
    if what == "traction" and curves[0].hoop is not None:
        words = "friction, around the axis dashed"
    dress(axes, x=curves[0].place, y=f"{words}, force per area")


def _resultants(axes: Axes, forces: ContactForces, data: PictureData) -> None:
    """Normal force, friction force with its sign, torque over the radius, and dissipation, at every instant."""
    along, words = friction_direction(forces, data.solid)
    lines = [(np.linalg.norm(forces.normal, axis=1), PRESSURE, "o", "normal force")]
    if np.any(forces.friction):
        lines.append((forces.friction @ along, TRACTION, "s", f"friction force, {words}"))
    for values, colour, mark, said in lines:
        axes.plot(forces.load, values, "-", color=colour, lw=1.5)
        axes.plot(forces.load[forces.ends], values[forces.ends], mark, color=colour, ms=5)
        axes.plot([], [], f"{mark}-", color=colour, label=said)
    across = np.linalg.norm(forces.friction - np.outer(forces.friction @ along, along), axis=1)
    if data.model.twists:
        axes.plot(forces.load, forces.friction[:, 2], "--", color=HOOP, lw=1.5, label="torque over the largest radius")
    elif across.max() > _MIN_SHARE * np.abs(forces.friction).max():
        axes.plot(forces.load, across, ":", color=TRACTION, lw=1.5, label="friction force across that")
    dress(axes, y="force on the nonmortar body, force")
    handles, labels = axes.get_legend_handles_labels()
    if forces.dissipation.max() > 0.0:
        beside = axes.twinx()
        handles += beside.plot(forces.load, forces.dissipation, "-.", color=INK, lw=1.2)
        labels.append("dissipation since the beginning")
        label(beside, y="dissipated, work")
        low, high = axes.get_ylim()
        top = 1.3 * forces.dissipation.max()
        beside.set_ylim(low / high * top, top)  # one zero for both
        beside.spines["top"].set_visible(False)
        beside.spines["right"].set_color(INK)
        beside.tick_params(colors=INK, labelsize=9)
    axes.legend(handles, labels, fontsize=8.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)


def friction_direction(forces: ContactForces, solid: bool) -> tuple[Array, str]:
    """The direction along which friction is drawn, and its words: the mean tangent, or in space that of the largest."""
    if solid:
        size = np.linalg.norm(forces.friction, axis=1)
        largest = forces.friction[np.argmax(size)] / (size.max() or 1.0)
        along = largest * np.copysign(1.0, largest[np.argmax(np.abs(largest))])
        return along, f"along {'xyz'[along.argmax()]}" if along.max() > 1.0 - _MIN_SHARE else f"along {_spelled(along)}"
    pressed = forces.normal[np.argmax(np.linalg.norm(forces.normal, axis=1))]
    return np.array([pressed[1], -pressed[0], 0.0]) / (np.linalg.norm(pressed) or 1.0), "along the tangent"


def _spelled(vector: Array) -> str:
    """Components of a unit vector in words."""
    return f"({', '.join(f'{part:.2g}' for part in np.where(np.abs(vector) < _MIN_SHARE, 0.0, vector))})"


def _steps_below(axes: Axes, steps: list[str]) -> None:
    """Step k ends at the load factor k: its name is there, where names fit."""
    if len(steps) <= _MAX_NAMED_STEPS:
        numbers = range(1, len(steps) + 1)
        axes.set_xticks(numbers, [f"{k} {name}" for k, name in zip(numbers, steps, strict=True)], fontsize=9)
    label(axes, x="load factor: ends of steps")


def _since_the_beginning(values: Array, ends: IntArray) -> Array:
    """Values (m,) that count from the beginning of each step, counted from the beginning of the first."""
    before = np.concatenate([[0.0], np.cumsum(values[ends])[:-1]])
    total: Array = values + np.repeat(before, np.diff(np.append(-1, ends)))
    return total
