# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a contact: pressure and friction along the surface, and where it is open, sticks and slips."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from signorini.plot.curve import Curve, closed_range, curves_of
from signorini.plot.patch import draw_patches, patches_of
from signorini.plot.style import BOUND, INK, PLAIN, PRESSURE, STATUS_COLOURS, TRACTION, dress
from signorini.solution.history import History
from signorini.solution.results import STICK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

_DOTTED = 100  # nodes that can be told apart as dots


def plot_contact(history: History) -> Figure:
    """Draw every contact at the end of the last step.

    Raises
    ------
    InputError
        If nothing was solved.
    """
    if history.model.dimension == 3:
        return draw_patches(patches_of(history, history.last), history.model.title)
    return draw_contacts(curves_of(history, history.last), history.model.title)


def draw_contacts(curves: Sequence[Curve], title: str) -> Figure:
    """One panel a contact, below each other."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.6, 0.7 + 3.9 * max(len(curves), 1)), layout="constrained")
    panels = figure.subplots(max(len(curves), 1), squeeze=False)[:, 0]
    for axes, curve in zip(panels, curves, strict=False):
        _draw(axes, curve)
    if not curves:
        panels[0].text(0.5, 0.5, "no contact", ha="center", va="center")
        panels[0].set_axis_off()
    if title:
        figure.suptitle(title, fontsize=12, color=INK)
    return figure


def _draw(axes: Axes, curve: Curve) -> None:
    shades = shade_status(axes, curve)
    single = len(curve.s) == 1
    dots, squares = ("o-", "s-") if len(curve.s) <= _DOTTED else ("-", "-")
    lines = axes.plot(curve.s, curve.pressure, dots, color=PRESSURE, ms=4, lw=1.8, label="pressure p")
    if curve.friction > 0:
        name = "friction traction, along the tangent"
        lines += axes.plot(curve.s, curve.traction, squares, color=TRACTION, ms=3.5, lw=1.5, label=name)
    if curve.has_bound:
        bound = curve.friction * curve.pressure
        signs = [sign for sign in (1.0, -1.0) if (sign * curve.traction > 0.01 * bound.max()).any()] or [1.0]
        name = {1: "μ p", 2: "± μ p"}[len(signs)] if signs[0] > 0 else "- μ p"
        for sign in signs:
            line = axes.plot(curve.s, sign * bound, "--", color=BOUND, lw=1.0, alpha=0.8)
        line[0].set_label(f"{name}, μ = {curve.friction:g}")
        lines += line
    axes.axhline(0.0, color=INK, lw=0.8)
    if not single:
        axes.set_xlim(*closed_range(curve))
    axes.set_xlabel(f"{curve.axis} along '{curve.contact}', undeformed", fontsize=10, color=INK)
    axes.set_ylabel("force per area", fontsize=10, color=INK)
    axes.set_title(f"{curve.contact}, end of step '{curve.step}'", fontsize=10, color=INK, loc="left")
    dress(axes)
    axes.legend(handles=[*lines, *shades], fontsize=8.5, frameon=True, framealpha=0.92, edgecolor="none", loc="best")


def shade_status(axes: Axes, curve: Curve) -> list[Patch]:
    """Colour the background by status, from halfway to the node before to halfway to the next; legend handles."""
    from matplotlib.patches import Patch

    middle = 0.5 * (curve.s[1:] + curve.s[:-1])
    edges = np.concatenate([curve.s[:1], middle, curve.s[-1:]])
    changes = np.nonzero(curve.status[1:] != curve.status[:-1])[0] + 1
    starts, ends = [0, *changes], [*changes, len(curve.s)]
    for start, end in zip(starts, ends, strict=True):
        axes.axvspan(edges[start], edges[end], color=STATUS_COLOURS[str(curve.status[start])], lw=0, zorder=0)
    present = [name for name in STATUS_COLOURS if (curve.status == name).any()]
    if curve.friction == 0.0:
        words = {"open": "open", "slip": PLAIN}
    else:
        words = {"open": "open", STICK: "stick", "slip": "slip"}
    return [Patch(color=STATUS_COLOURS[name], label=words.get(name, name)) for name in present]
