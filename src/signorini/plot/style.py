# SPDX-License-Identifier: BSD-3-Clause
"""Colours and the look of axes, the same in every picture; distinguishable without colour vision."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PRESSURE, TRACTION, BOUND = "#1b4f8a", "#c4451c", "#c4451c"
STATUS_COLOURS = {"open": "#f1f1ef", "stick": "#cfe3f5", "slip": "#fbe3c6"}
STATUS_INK = {"open": "#9a9a96", "stick": "#2f78b7", "slip": "#dd8a1f"}
INK = "#333333"
PLAIN = "closed, without friction"
"""What "slip" means where there is no friction."""


def dress(axes: Axes) -> None:
    """Thin spines below and left, a light grid behind."""
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("bottom", "left"):
        axes.spines[side].set_color(INK)
    axes.tick_params(colors=INK, labelsize=9)
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)


def literal(figure: Figure) -> Figure:
    """Show every text of a figure as it is: dollars in the names of a deck enclose no formula."""
    import matplotlib.text as mtext

    for text in figure.findobj(mtext.Text):
        text.set_parse_math(False)
    return figure
