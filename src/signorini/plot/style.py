# SPDX-License-Identifier: BSD-3-Clause
"""Colours and the look of axes, the same in every picture; distinguishable without colour vision."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array
from signorini.plot.units import Units
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SCALE = "scale"
"""Mark of a length beside a picture, to which its unit is added."""

_NO_UNITS = Units()
_LEGEND_DISTANCE = 4.5  # font sizes from the axes to the legend: the label is between
_QUANTITY = re.compile(r", (force per area|force|length|work|volume)(?=$| \()")

PRESSURE, TRACTION, BOUND = "#1b4f8a", "#c4451c", "#c4451c"
HOOP = "#2a7f62"
INK = "#333333"
PLAIN = "closed, without friction"
"""Words for "slip" where there is no friction."""

STATUS_COLOURS = {OPEN: "#f1f1ef", STICK: "#cfe3f5", PLAIN: "#fbe3c6", SLIP: "#fbe3c6"}
STATUS_INK = {OPEN: "#9a9a96", STICK: "#2f78b7", PLAIN: "#dd8a1f", SLIP: "#dd8a1f"}
"""Of `status_words`, light for surfaces and strong for dots."""


def status_words(contact: ContactResult) -> NDArray[np.str_]:
    """What pairs do in words, (n,)."""
    plain = (contact.status == SLIP) & (not contact.traction.any())
    return np.where(plain, PLAIN, contact.status)


def dress(axes: Axes, *, x: str = "", y: str = "", title: str = "") -> None:
    """Give axes thin spines, a light grid and a line at y = 0; x, y and title are words as of :func:`label`."""
    label(axes, x=x, y=y, title=title)
    axes.axhline(0.0, color=INK, lw=0.8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("bottom", "left"):
        axes.spines[side].set_color(INK)
    axes.tick_params(colors=INK, labelsize=9)
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)


def frame(axes: Axes, low: Array, high: Array) -> None:
    """Show in axes what is between the corners ``low`` (left) and ``high`` (right), (2,), at one scale both ways."""
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")


def round_number(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is at most a positive number.

    >>> round_number(0.3), round_number(5.0)
    (0.2, 5.0)
    """
    power = 10.0 ** math.floor(math.log10(most))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-12))


def label(axes: Axes, *, x: str = "", y: str = "", title: str = "") -> None:
    """Write below and beside axes what x and y are, and above them a title; words that are empty are left out."""
    if x:
        axes.set_xlabel(x, fontsize=10, color=INK)
    if y:
        axes.set_ylabel(y, fontsize=10, color=INK)
    if title:
        axes.set_title(title, fontsize=10, color=INK, loc="left")


def entitle(figure: Figure, title: str, words: str = "") -> None:
    """Write above a figure the title of the model, and below that words on what is shown; empty ones are left out."""
    lines = [line for line in (title, words) if line]
    if lines:
        figure.suptitle("\n".join(lines), fontsize=10.5 if words else 12, color=INK)


def colour_bar(figure: Figure, mappable: Any, panels: Axes | Sequence[Axes], words: str, **shape: Any) -> Any:
    """Draw beside panels of a figure the colours of a mappable, with words on what they are; ``shape`` of the bar."""
    bar = figure.colorbar(mappable, ax=panels, **{"shrink": 0.85, "pad": 0.02} | shape)
    bar.set_label(words, fontsize=10, color=INK)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=9, colors=INK)
    return bar


def legend_below(figure: Figure, handles: Sequence[Any]) -> None:
    """All handles in one row below the panels."""
    figure.legend(handles=handles, fontsize=9, frameon=False, loc="outside lower center", ncols=len(handles))


def legend_under(axes: Axes, handles: Sequence[Any], columns: int) -> None:
    """Draw a legend of ``handles`` below axes, where it covers no data, in at most so many ``columns``."""
    axes.legend(
        handles=handles,
        fontsize=9,
        frameon=False,
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        borderaxespad=_LEGEND_DISTANCE,
        ncols=min(columns, max(len(handles), 1)),
    )


def named(words: str, units: Units) -> str:
    """The name of an axis with the unit of the quantity that it ends in.

    >>> named("slip, length", Units(length="mm")), named("slip, length", Units())
    ('slip, mm', 'slip')
    """
    return _QUANTITY.sub(lambda found: units.after_comma(found[1]), words)


def literal(figure: Figure, units: Units = _NO_UNITS) -> Figure:
    """Show every text of a figure as it is, and quantities on axes in their units.

    Dollars in the names of a deck enclose no formula. Names of axes end in the quantity, as "slip, length", which gives
    way to its unit; where that is not known, "force per area" stays, and the others, said already, are left out.

    Parameters
    ----------
    figure : to which nothing is added any more
    units : those of the model
    """
    import matplotlib.text as mtext

    for axes in figure.axes:
        for name in (axes.xaxis.label, axes.yaxis.label):
            name.set_text(named(name.get_text(), units))
    for text in figure.findobj(mtext.Text):
        text.set_parse_math(False)
        if text.get_gid() == SCALE and units.length != _NO_UNITS.length:
            text.set_text(f"{text.get_text()} {units.length}")
    return figure
