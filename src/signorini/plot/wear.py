# SPDX-License-Identifier: BSD-3-Clause
"""The picture of wear: profiles of sides and pressures over the cycles, depths, and the worn volume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.plot.curve import place_words, surface_coordinate
from signorini.plot.picture_data import PictureData
from signorini.plot.style import INK, PRESSURE, TRACTION, colour_bar, dress, entitle
from signorini.solution.contact_wear import ContactWear
from signorini.solution.history import History
from signorini.solution.results import ContactResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PROFILES = 9  # drawn: more cannot be told apart
_SHOWN = 0.25  # of what touched or is worn: so much more of the surface is shown on either side


def draw_wear(data: PictureData) -> Figure:
    """One row a contact that wears: depths of both sides and pressures along it over the cycles (in space a map of the
    depth at the end), and over the cycles the largest of them and the worn volume.

    Raises
    ------
    InputError
        If no contact wears.
    """
    from matplotlib.figure import Figure

    own = [i for i, contact in enumerate(data.model.contacts) if contact.wear is not None]
    if not own:
        raise InputError("has no contact that wears; expected another picture", where=("wear",))
    figure = Figure(figsize=(11.0, 0.6 + 7.4 * len(own)), layout="constrained")
    panels = figure.subplots(2 * len(own), 2, squeeze=False)
    for row, i in enumerate(own):
        upper, lower = panels[2 * row], panels[2 * row + 1]
        course = _course(data.history, i)
        (_maps if data.solid else _profiles)(figure, upper, course)
        _largest(lower[0], course)
        _volume(lower[1], course, data, i)
    entitle(figure, data.model.title)
    return figure


@dataclass(frozen=True, kw_only=True, eq=False)
class _Course:
    """A contact wherever the number of cycles behind it is another, at its last instant.

    Attributes
    ----------
    axes : letters of the model's axes
    cycles : (k,) numbers of them; steps that do not repeat are none, where others do
    contacts, worn : the contact, and its wear
    """

    axes: str
    cycles: Array
    contacts: list[ContactResult]
    worn: list[ContactWear]


def _course(history: History, i: int) -> _Course:
    last: dict[int, ContactResult] = {}
    repeats = any(step.cycles for step in history.steps)
    first = next((step.instants[0].contacts[i].wear for step in history.steps), None)
    behind, skipped, begin = 0, 0, 0 if first is None else first.cycles
    for step in history.steps:
        # between two of them pairs have slid on, and nothing of that is worn yet; blocks of cycles end without one
        for instant in [instant for instant in step.instants if instant.what == "wear"] or step.instants:
            contact = instant.contacts[i]
            if contact.wear is not None:
                behind = contact.wear.cycles - skipped
                if repeats and not step.cycles:
                    known = max(last, default=begin)
                    behind, skipped = known, skipped + behind - known
                last[behind] = contact
    cycles = sorted(last)
    contacts = [last[number] for number in cycles]
    return _Course(
        axes=history.model.axes,
        cycles=np.array(cycles, float),
        contacts=contacts,
        worn=[contact.wear for contact in contacts if contact.wear is not None],
    )


def _profiles(_: Figure, panels: Array, course: _Course) -> None:
    """Depths and pressures along the surface, of some of the cycles, the first and the last among them."""
    from matplotlib import colormaps
    from matplotlib.lines import Line2D

    chosen = np.unique(np.linspace(0, len(course.cycles) - 1, _PROFILES).round().astype(int))
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(chosen)))
    contact = course.contacts[-1]
    axis, s = surface_coordinate(contact.points)
    order = np.argsort(s, kind="stable")
    for k, colour in zip(chosen, colours, strict=True):
        wear, words = course.worn[k], f"{course.cycles[k]:.0f}"
        panels[1].plot(s[order], course.contacts[k].pressure[order], color=colour, lw=1.5, label=words)
        for mortar, line in ((False, "-"), (True, "--")):
            side = wear.on_mortar == mortar
            if side.any():
                x = _along(wear.points[side], axis)
                at = np.argsort(x, kind="stable")
                panels[0].plot(x[at], wear.depths[side][at], line, color=colour, lw=1.5)
    worn = course.worn[-1].depths > 0.0
    places = _along(course.worn[-1].points[worn], axis) if worn.any() else np.zeros(0)
    shown = np.concatenate([s[np.any([c.closed for c in course.contacts], axis=0)], places])
    low, high = shown.min(initial=np.inf), shown.max(initial=-np.inf)
    if high > low:
        for panel in panels:
            panel.set_xlim(low - _SHOWN * (high - low), high + _SHOWN * (high - low))
    place = place_words(axis, contact.name, course.axes)
    dress(panels[0], x=place, y="worn depth, length", title=f"depth of '{contact.nonmortar}' and '{contact.mortar}'")
    panels[0].invert_yaxis()
    sides = [Line2D([], [], color=INK, ls="-", label=contact.nonmortar)]
    if course.worn[-1].on_mortar.any():
        sides.append(Line2D([], [], color=INK, ls="--", label=contact.mortar))
    panels[0].legend(handles=sides, fontsize=8.5, frameon=False, loc="lower right")
    dress(panels[1], x=place, y="pressure, force per area", title="pressure after cycles")
    panels[1].legend(fontsize=8.5, frameon=False, loc="upper right")


def _along(points: Array, axis: str) -> Array:
    """(k,) Coordinate of points along the surface, as of `surface_coordinate`."""
    return np.asarray(points[:, "xy".index(axis)]) if axis in ("x", "y") else surface_coordinate(points)[1]


def _maps(figure: Figure, panels: Array, course: _Course) -> None:
    """Depth and pressure at the end, at the nodes of the nonmortar side, seen along its shortest extent."""
    contact, wear = course.contacts[-1], course.worn[-1]
    axes = np.sort(np.argsort(np.ptp(contact.points, axis=0))[1:])
    x, y = contact.points[:, axes].T
    for panel, values, words in (
        (panels[0], wear.depth, f"worn depth of '{contact.nonmortar}', length"),
        (panels[1], contact.pressure, "pressure, force per area"),
    ):
        points = panel.scatter(x, y, c=values, s=14, cmap="viridis")
        panel.set_aspect("equal")
        dress(
            panel,
            x=f"{'xyz'[axes[0]]}, length",
            y=f"{'xyz'[axes[1]]}, length",
            title=f"after {course.cycles[-1]:.0f} cycles",
        )
        colour_bar(figure, points, panel, words)


def _largest(axes: Axes, course: _Course) -> None:
    """The deepest place of both sides, and the largest pressure, over the cycles."""
    contact = course.contacts[-1]
    depths = np.array([wear.deepest for wear in course.worn])
    lines = axes.plot(
        course.cycles, depths[:, 0], "o-", color=TRACTION, ms=3.5, label=f"depth of '{contact.nonmortar}'"
    )
    if course.worn[-1].on_mortar.any():
        lines += axes.plot(course.cycles, depths[:, 1], "s--", color=TRACTION, ms=3.5, label=f"of '{contact.mortar}'")
    dress(axes, x="cycles", y="largest worn depth, length")
    beside = axes.twinx()
    pressures = [each.pressure.max(initial=0.0) for each in course.contacts]
    lines += beside.plot(course.cycles, pressures, "-", color=PRESSURE, lw=1.5, label="largest pressure")
    beside.set_ylim(0.0, 1.15 * max(pressures))
    dress(beside, y="largest pressure, force per area")
    beside.grid(visible=False)
    axes.legend(handles=lines, fontsize=8.5, frameon=False, loc="center right")


def _volume(axes: Axes, course: _Course, data: PictureData, i: int) -> None:
    """The worn volume of both sides, beside that of the whole force on the longest way that a pair has slid."""
    wear = data.model.contacts[i].wear
    assert wear is not None
    volume = [sum(each.volume) for each in course.worn]
    axes.plot(course.cycles, volume, "o-", color=INK, ms=3.5, label="worn")
    if not wear.by_energy:
        force = np.linalg.norm(course.contacts[-1].normal_force)
        ways = np.array([each.distance.max(initial=0.0) for each in course.worn])
        most = (wear.nonmortar + wear.mortar) * force * ways
        axes.plot(course.cycles, most, ":", color=PRESSURE, lw=1.8, label="coefficients x force x longest way slid")
    words = "volume" if data.solid or data.model.kind == "axisymmetric" else "area times thickness"
    dress(axes, x="cycles", y=f"worn {words}, volume")
    axes.legend(fontsize=8.5, frameon=False, loc="upper left")
