# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a contact: pressure and friction along the surface, and where it is open, sticks and slips."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array
from signorini.plot.curve import Curve, closed_range
from signorini.plot.patch import draw_patches
from signorini.plot.picture_data import PictureData
from signorini.plot.style import BOUND, HOOP, PRESSURE, STATUS_COLOURS, TRACTION, dress, entitle, label, legend_under

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEGEND_COLUMNS = 3  # that fit below a panel
_MAX_DOTS = 100  # nodes: more cannot be told apart as dots


def draw_contacts(data: PictureData) -> Figure:
    """Every contact, one below the other: as curves in the plane, in space as maps."""
    from matplotlib.figure import Figure

    if data.solid:
        return draw_patches(data.patches, data.model.title, data.when, data.look)
    curves = data.curves()
    figure = Figure(figsize=(7.6, 0.7 + 4.5 * max(len(curves), 1)), layout="constrained")
    panels = figure.subplots(max(len(curves), 1), squeeze=False)[:, 0]
    for axes, curve in zip(panels, curves, strict=False):
        _draw(axes, curve)
        label(axes, title=f"{curve.contact}, {data.when}")
        if zoom := data.look.corners("along"):
            axes.set_xlim(*zoom[0])
        if data.look.range is not None:
            axes.set_ylim(*data.look.range)
    if not curves:
        panels[0].text(0.5, 0.5, "no contact", ha="center", va="center")
        panels[0].set_axis_off()
    entitle(figure, data.model.title)
    return figure


def _draw(axes: Axes, curve: Curve) -> None:
    from matplotlib.patches import Patch

    shade_status(axes, curve.s, curve.status, STATUS_COLOURS)
    dots, squares = ("o-", "s-") if len(curve.s) <= _MAX_DOTS else ("-", "-")
    lines = axes.plot(curve.s, curve.pressure, dots, color=PRESSURE, ms=4, lw=1.8, label="pressure p")
    if curve.friction > 0:
        name = "friction traction, along the tangent"
        lines += axes.plot(curve.s, curve.traction, squares, color=TRACTION, ms=3.5, lw=1.5, label=name)
    tractions = [curve.traction]
    if curve.hoop is not None and curve.friction > 0:
        tractions.append(curve.hoop)
        name = "friction traction, around the axis"
        lines += axes.plot(curve.s, curve.hoop, dots.replace("o", "^"), color=HOOP, ms=4, lw=1.5, label=name)
    if curve.has_bound:
        bound = curve.friction * curve.pressure
        seen = np.concatenate(tractions)
        signs = [sign for sign in (1.0, -1.0) if (sign * seen > 0.01 * bound.max()).any()] or [1.0]
        name = {1: "μ p", 2: "± μ p"}[len(signs)] if signs[0] > 0 else "- μ p"
        for sign in signs:
            line = axes.plot(curve.s, sign * bound, "--", color=BOUND, lw=1.0, alpha=0.8)
        line[0].set_label(f"{name}, μ = {curve.friction:g}")
        lines += line
    if len(curve.s) > 1:
        axes.set_xlim(*closed_range(curve))
    dress(axes, x=curve.place, y="pressure and friction, force per area")
    states = [Patch(color=colour, label=words) for words, colour in STATUS_COLOURS.items() if words in curve.status]
    legend_under(axes, [*lines, *states], _LEGEND_COLUMNS)


def shade_status(axes: Axes, s: Array, status: NDArray[np.str_], colours: Mapping[str, str]) -> list[Artist]:
    """Colour the background of axes by the status (n,) of nodes at s (n,), each from halfway to halfway between them.

    Nothing is drawn for a status that has no entry in ``colours``.
    """
    edges = np.concatenate([s[:1], 0.5 * (s[1:] + s[:-1]), s[-1:]])
    changes = [0, *(np.flatnonzero(status[1:] != status[:-1]) + 1), len(s)]
    return [
        axes.axvspan(edges[start], edges[end], color=colours[str(status[start])], lw=0, zorder=0)
        for start, end in pairwise(changes)
        if status[start] in colours
    ]
