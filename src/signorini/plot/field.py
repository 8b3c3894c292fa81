# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the bodies: a field on the deformed mesh, and the mesh with its contact nodes."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.plot.components import Colours, Scalar, colours_of
from signorini.plot.look import Look
from signorini.plot.picture_data import PictureData
from signorini.plot.style import INK, STATUS_INK, colour_bar, entitle, frame, label, legend_below, round_number
from signorini.plot.walls import Wall, draw_walls

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BODIES = ("#e4ecf4", "#f6ead9", "#e3efe2", "#f0e3ec", "#ececea")
MAX_WINDOW = 0.4  # of the size of the bodies: a larger window shows nothing new
_MARGIN, _WALL_MARGIN = 0.02, 0.06  # of the size of the bodies: around them, and where obstacles need room
# triangles of a cell by the number of nodes around it
_CUTS = {
    3: [[0, 1, 2]],
    4: [[0, 1, 2], [0, 2, 3]],
    6: [[0, 1, 5], [1, 2, 3], [3, 4, 5], [1, 3, 5]],
    8: [[0, 1, 7], [1, 2, 3], [3, 4, 5], [5, 6, 7], [1, 3, 7], [3, 5, 7]],
}
Window = tuple[Array, Array]  # lower left and upper right corner
_PLAIN = Look()
_LEVELS = 25  # colours that a field is drawn with
_BEYOND_TOL = 1e-6  # of the range of colours: values beyond it by less are rounding
_MIN_SEEN = 0.01  # of the size of what is shown: displacements at least as large are drawn as they are


def draw_field(data: PictureData, scalar: Scalar) -> Figure:
    """A field on the deformed bodies, whole and where they touch or have yielded, or the part that is asked for.

    The title says by what the displacements are multiplied. Colours end at the largest value there.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation

    grid = data.bodies
    displacement = grid.displacement[:, : grid.points.shape[1]]  # what goes around the axis leaves the picture as it is
    asked = _asked_window(data)
    window = asked or _window(data, grid.points + displacement)
    shown = grid.points if window is None else np.array(window)
    factor = drawn_factor(float(np.ptp(shown, axis=0).max()), displacement, data.look)
    moved = grid.points + factor * displacement
    inside = _inside(window, moved)
    colours = colours_of(scalar.values[inside], data.look.range)
    levels = np.linspace(colours.low, colours.high, _LEVELS)
    mesh = Triangulation(moved[:, 0], moved[:, 1], triangles(data.outlines))
    figure, panels = _canvas(moved, window, data.walls, closer_only=asked is not None)
    for axes in panels:
        axes.tricontourf(mesh, scalar.values, levels=levels, cmap=colours.map, extend="both")
        draw_edges(axes, data.outlines, moved, colour="#ffffff", alpha=0.35)
        if factor == 1.0:  # otherwise bodies are not drawn where obstacles have stopped them
            draw_walls(axes, data.walls, moved=True)
    words, extend = beyond(scalar, scalar.words.format(""), colours)
    scale = ScalarMappable(Normalize(colours.low, colours.high), colours.map)
    bar = colour_bar(figure, scale, panels, words, extend=extend, boundaries=levels, spacing="proportional")
    bar.ax.yaxis.set_major_locator(MaxNLocator(nbins=7, steps=[1, 2, 2.5, 5, 10]))
    _finish(data, panels, "where bodies have yielded" if data.yielded.any() else "at the contact")
    entitle(figure, data.model.title, f"{factor_words(factor)}; {data.when}")
    return figure


def beyond(scalar: Scalar, words: str, colours: Colours) -> tuple[str, str]:
    """Words of a colour bar and the ends at which it is open, where a field goes beyond its colours.

    Parameters
    ----------
    scalar, words : the field, and what it is
    colours : its range
    """
    low, high = float(scalar.values.min()), float(scalar.values.max())
    room = _BEYOND_TOL * (colours.high - colours.low)
    less, more = low < colours.low - room, high > colours.high + room
    ends = f"{low:.4g} to {high:.4g}" if less and more else f"down to {low:.4g}" if less else f"up to {high:.4g}"
    open_at = {(True, True): "both", (True, False): "min", (False, True): "max"}.get((less, more), "neither")
    return words + (f" (elsewhere {ends})" if less or more else ""), open_at


def draw_mesh(data: PictureData) -> Figure:
    """The undeformed mesh, a colour a body, and the contact nodes with their status."""
    from matplotlib.collections import PolyCollection

    grid, asked = data.bodies, _asked_window(data)
    figure, panels = _canvas(grid.points, asked or _window(data, grid.points), data.walls, closer_only=bool(asked))
    handles = body_handles(data)
    for axes in panels:
        for cells, body in zip(data.outlines, grid.body, strict=True):
            faces = [BODIES[i % len(BODIES)] for i in body]
            axes.add_collection(PolyCollection(list(grid.points[cells]), facecolors=faces, edgecolors="none"))
        draw_edges(axes, data.outlines, grid.points, colour="#7d7d7d", alpha=1.0)
        draw_walls(axes, data.walls, moved=False)
        for words, own in data.dots.items():
            x, y = grid.points[own].T
            drawn = axes.plot(x, y, "o", ms=4, color=STATUS_INK[words], label=f"contact node, {words}", zorder=3)
            handles += drawn if axes is panels[-1] else []
    legend_below(figure, handles)
    _finish(data, panels, "at the contact")
    entitle(figure, data.model.title, f"{data.size}; {data.when}")
    return figure


def body_handles(data: PictureData) -> list[Artist]:
    """A handle of a legend for every body, in its colour."""
    from matplotlib.patches import Patch

    look = zip(data.model.bodies, cycle(BODIES), strict=False)
    return [Patch(facecolor=colour, edgecolor="#7d7d7d", label=body.name) for body, colour in look]


def factor_words(factor: float) -> str:
    """How bodies are drawn, with displacements times a factor."""
    if factor == 0.0:
        return "undeformed"
    return "deformed, true displacements" if factor == 1.0 else f"deformed, displacements x {factor:g}"


def drawn_factor(size: float, displacement: Array, look: Look = _PLAIN) -> float:
    """The factor of displacements: 1 where they can be seen, otherwise 1, 2 or 5 times a power of ten.

    Parameters
    ----------
    size : of what is shown, length
    displacement : (n, 2) length
    look : what the reader asks for

    Examples
    --------
    >>> drawn_factor(10.0, np.array([[0.0, 0.001], [0.0, 0.0]]))
    200.0
    """
    if look.scale is not None:
        return look.scale
    largest = float(np.linalg.norm(displacement, axis=1).max())
    if largest == 0.0 or largest >= _MIN_SEEN * size:
        return 1.0
    return round_number(2.0 * _MIN_SEEN * size / largest)


def _asked_window(data: PictureData) -> Window | None:
    """The part that the reader asks for."""
    corners = data.look.corners("x y")
    return None if corners is None else (np.array(corners)[:, 0], np.array(corners)[:, 1])


def _window(data: PictureData, points: Array) -> Window | None:
    """The part around nodes that touch or have yielded; None if that is much of the picture."""
    here = points[data.closed | data.yielded]
    size = float(np.ptp(points, axis=0).max())
    if not len(here):
        return None
    half = max(0.85 * float(np.ptp(here, axis=0).max()), 0.02 * size)
    if 2.0 * half >= MAX_WINDOW * size:
        return None
    middle = 0.5 * (here.max(axis=0) + here.min(axis=0))
    edge = 0.03 * half
    return np.maximum(middle - half, points.min(axis=0) - edge), np.minimum(middle + half, points.max(axis=0) + edge)


def _inside(window: Window | None, points: Array) -> BoolArray:
    if window is None:
        return np.ones(len(points), bool)
    return np.asarray(((points >= window[0]) & (points <= window[1])).all(axis=1))


def _canvas(points: Array, window: Window | None, walls: list[Wall], *, closer_only: bool) -> tuple[Figure, list[Axes]]:
    """A figure of the shape of the bodies, with a second panel for the window if there is one, or of that alone."""
    from matplotlib.figure import Figure

    if closer_only and window is not None:
        size = 6.2 * np.maximum((window[1] - window[0]) / (window[1] - window[0]).max(), 0.25)
        figure = Figure(figsize=(max(size[0], 3.5) + 2.0, size[1] + 1.4), layout="constrained")
        axes = figure.add_subplot()
        frame(axes, *window)
        return figure, [axes]

    width, height = np.maximum(np.ptp(points, axis=0), 1e-300)
    shape = float(np.clip(height / width, 0.25, 4.0))
    across, up = (6.2, 6.2 * shape) if shape < 1.0 else (6.2 / shape, 6.2)
    if window is None:
        figure = Figure(figsize=(max(across, 3.5) + 2.0, up + 1.4), layout="constrained")
        panels = [figure.add_subplot()]
    else:
        low, high = window
        beside = 4.6 * (high - low) / (high - low).max()
        up = max(up, beside[1])
        figure = Figure(figsize=(max(across, 2.0) + beside[0] + 2.4, up + 1.4), layout="constrained")
        panels = list(figure.subplots(1, 2, width_ratios=[max(across, 2.0), beside[0]]))
        frame(panels[1], low, high)
        panels[0].indicate_inset((*low, *(high - low)), edgecolor=INK, lw=1.0, alpha=0.9)
    margin = (_WALL_MARGIN if walls else _MARGIN) * max(width, height)
    frame(panels[0], points.min(axis=0) - margin, points.max(axis=0) + margin)
    return figure, panels


def draw_edges(axes: Axes, outlines: list[IntArray], points: Array, *, colour: str, alpha: float) -> None:
    """Edges of the cells: thinner lines where more cells are in view, none to speak of where they would cover all.

    Parameters
    ----------
    axes : whose limits are set
    outlines, points : of the cells, see `PictureData.outlines`
    colour, alpha : of the lines
    """
    from matplotlib.collections import PolyCollection

    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    x, y = points[:, 0], points[:, 1]
    seen = int(((x >= left) & (x <= right) & (y >= low) & (y <= high)).sum())
    width = 0.7 if seen < 500 else 0.4 if seen < 3000 else 0.15 if seen < 20000 else 0.0
    for cells in outlines:
        axes.add_collection(
            PolyCollection(list(points[cells]), facecolors="none", edgecolors=colour, linewidths=width, alpha=alpha),
            autolim=False,
        )


def _finish(data: PictureData, panels: list[Axes], closer: str) -> None:
    """Label the axes, frame what is not the whole; ``closer`` says what that shows."""
    x, y = data.model.axes[0], data.model.axes[1]
    for axes in panels:
        for side in axes.spines.values():
            side.set_visible(axes is not panels[0])
            side.set_color(INK)
        axes.tick_params(colors=INK, labelsize=9)
        first = axes is panels[0]
        label(axes, x=f"{x}, length", y=f"{y}, length" if first else "", title="" if first else closer)


def triangles(outlines: list[IntArray]) -> IntArray:
    """Cells as triangles, (m, 3)."""
    return np.vstack([cells[:, corners] for cells in outlines for corners in _CUTS[cells.shape[1]]])
