# SPDX-License-Identifier: BSD-3-Clause
"""The picture of an accuracy: where errors are on the mesh that came out, and how they fell with its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.plot.field import draw_edges
from signorini.plot.paint import Paint, paint_skin
from signorini.plot.picture_data import PictureData
from signorini.plot.shots import Shot, make_shots
from signorini.plot.style import INK, PRESSURE, TRACTION, colour_bar, entitle, frame, label
from signorini.solution.accuracy import AccuracyResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import LogNorm
    from matplotlib.figure import Figure

_DECADES = 4.0  # of shares that colours tell apart
_PANEL = 4.4  # inches
_MESH_COLOUR = (1.0, 1.0, 1.0, 0.30)  # on the dark colours of errors
_LINES = {"pressure": PRESSURE, "traction": TRACTION, "energy": "#4f8f3a"}
_Window = tuple[Array, Array]  # lower left and upper right corner
_WORDS = {"pressure": "pressure", "traction": "pressure and friction", "energy": "stresses, norm of energy"}


def draw_accuracy(data: PictureData) -> Figure:
    """Shares of the cells in the error of the stresses, whole and at the contact; beside them errors over nodes.

    Raises
    ------
    InputError
        If no accuracy was asked for.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm
    from matplotlib.figure import Figure

    found = data.history.accuracy
    if found is None:
        raise InputError("has no accuracy: none was asked for. Run it with --accuracy 0.01, or 'estimate'")
    top = max(float(found.cells.max()), 1e-300)
    scale = LogNorm(top * 10.0**-_DECADES, top)
    shots, frames = (make_shots(data), []) if data.solid else ([], _frames(data))
    shown, levels = len(shots) + len(frames), len(found.levels) > 1
    figure = Figure(figsize=(_PANEL * (shown + levels) + 0.8, _PANEL + 0.6), layout="constrained")
    panels = list(figure.subplots(1, shown + levels, squeeze=False)[0])
    bodies = panels[:shown]
    if data.solid:
        _draw_skin(data, found, list(zip(bodies, shots, strict=True)), scale)
    else:
        _draw_cells(data, found, list(zip(bodies, frames, strict=True)), scale)
    words = "share in the square of the error of the stresses"
    bar = colour_bar(figure, ScalarMappable(scale, "viridis"), bodies, words, shrink=0.8)
    bar.ax.yaxis.set_major_formatter(_plain)
    if levels:
        _draw_levels(panels[-1], found)
    verdict = "estimated" if found.asked is None else f"{found.asked.error:g} of the {found.asked.of} asked for"
    reached = f"{found.pressure:.2%} of the pressure" if found.output is None else f"{found.output:.2%}"
    entitle(figure, data.model.title, f"{data.size}\n{verdict}, {reached} reached")
    return figure


def _frames(data: PictureData) -> list[_Window]:
    """Corners of the whole, and of what is around the nodes that touch."""
    points, here = data.bodies.points, data.bodies.points[data.closed]
    margin = 0.02 * float(np.ptp(points, axis=0).max())
    whole = points.min(axis=0) - margin, points.max(axis=0) + margin
    if not len(here):
        return [whole]
    middle, half = 0.5 * (here.min(axis=0) + here.max(axis=0)), 0.7 * float(np.ptp(here, axis=0).max())
    return [whole, (np.maximum(middle - half, whole[0]), np.minimum(middle + half, whole[1]))] if half else [whole]


def _draw_cells(
    data: PictureData, found: AccuracyResult, panels: Sequence[tuple[Axes, _Window]], scale: LogNorm
) -> None:
    """Cells of a plane model by their shares, inside frames."""
    import matplotlib
    from matplotlib.collections import PolyCollection

    points = data.bodies.points
    colours = matplotlib.colormaps["viridis"](scale(np.maximum(found.cells, scale.vmin or 0.0)))
    for i, (axes, (low, high)) in enumerate(panels):
        frame(axes, low, high)
        first = 0
        for cells in data.outlines:
            own = colours[first : first + len(cells)]
            first += len(cells)
            axes.add_collection(PolyCollection(list(points[cells]), facecolors=own, edgecolors="none"), autolim=False)
        draw_edges(axes, data.outlines, points, colour="#ffffff", alpha=0.5)
        right, up = data.model.axes[0], data.model.axes[1]
        label(axes, x=f"{right}, length", y=f"{up}, length", title="at the contact" if i else "")
        axes.tick_params(colors=INK, labelsize=9)


def _draw_skin(data: PictureData, found: AccuracyResult, panels: Sequence[tuple[Axes, Shot]], scale: LogNorm) -> None:
    """The skin of bodies in space, every node by the largest share of its cells."""
    import matplotlib

    mesh, skin, colours = data.model.mesh, data.skin, matplotlib.colormaps["viridis"]
    nodal = np.full(len(mesh.points), scale.vmin or 0.0)
    for nodes, own in zip(mesh.cells.values(), mesh.by_family(np.arange(len(found.cells))), strict=True):
        np.maximum.at(nodal, nodes, found.cells[own][:, None])
    paint = Paint(
        values=np.log(skin.values(nodal)),
        colours=lambda shares: colours(scale(np.exp(shares)))[:, :3],
        mesh=_MESH_COLOUR,
    )
    for axes, shot in panels:
        frame(axes, *shot.frame(skin.points))
        axes.set_axis_off()
        label(axes, title=shot.title)
        paint_skin(axes, shot.skin, skin.points, shot.camera, paint)


def _plain(value: float, _: float) -> str:
    """A tick of an axis in powers of ten."""
    return f"{value:g}"


def _draw_levels(axes: Axes, found: AccuracyResult) -> None:
    """Errors of all meshes over their nodes."""
    from matplotlib.ticker import NullFormatter

    nodes = np.array([level.nodes for level in found.levels])
    for what, colour in _LINES.items():
        errors: Array = np.array([getattr(level, what) for level in found.levels])
        if errors.any() and (what == "energy" or found.levels[-1].pairs):
            axes.loglog(nodes, errors, "o-", ms=4, color=colour, label=_WORDS[what])
    if found.asked is not None and found.value is not None:
        known = [(level.nodes, level.output) for level in found.levels if level.output is not None]
        axes.loglog(*np.array(known).reshape(-1, 2).T, "s-", ms=4, color=INK, label=str(found.asked.of))
    if found.asked is not None:
        axes.axhline(found.asked.error, color=INK, lw=0.8, ls="--", label="asked for")
    label(axes, x="nodes", y="estimated relative error")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(_plain)
        axis.set_minor_formatter(NullFormatter())
    axes.tick_params(colors=INK, labelsize=9)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(fontsize=9, frameon=False)
