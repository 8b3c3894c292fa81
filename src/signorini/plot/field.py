# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the bodies: von Mises stress on the deformed mesh, and the mesh with its contact nodes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array
from signorini.plot.files import Grid, ResultFolder
from signorini.plot.style import INK, STATUS_INK

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BODIES = ("#e4ecf4", "#f6ead9", "#e3efe2", "#f0e3ec", "#ececea")
_SEEN = 0.01  # of the size of the bodies: displacements at least as large are drawn as they are


def draw_stress(folder: ResultFolder) -> Figure:
    """Von Mises stress of the last state on the deformed bodies; the title says how much they are exaggerated."""
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation

    grid = folder.grid
    factor = drawn_factor(grid.points, grid.displacement)
    moved = grid.points + factor * grid.displacement
    figure, axes = _canvas(moved)
    levels = np.linspace(0.0, max(float(grid.von_mises.max()), 1e-300), 25)
    mesh = Triangulation(moved[:, 0], moved[:, 1], grid.triangles)
    field = axes.tricontourf(mesh, grid.von_mises, levels=levels, cmap="viridis")
    _edges(axes, grid, moved, colour="#ffffff", width=_width(grid), alpha=0.35)
    bar = figure.colorbar(field, ax=axes, shrink=0.85, pad=0.02)
    bar.set_label("von Mises stress, force per area", fontsize=10, color=INK)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=9, colors=INK)
    bar.ax.yaxis.set_major_locator(MaxNLocator(nbins=7, steps=[1, 2, 2.5, 5, 10]))
    words = "deformed, true displacements" if factor == 1.0 else f"deformed, displacements x {factor:g}"
    _finish(axes, folder.title, f"{words}; end of step '{folder.summary['steps'][-1]['name']}'")
    return figure


def draw_mesh(folder: ResultFolder) -> Figure:
    """The undeformed mesh, a colour a body, and the contact nodes with their status after the last step."""
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Patch

    grid = folder.grid
    figure, axes = _canvas(grid.points)
    for cells, body in zip(grid.cells, grid.body, strict=True):
        faces = [_BODIES[i % len(_BODIES)] for i in body]
        axes.add_collection(PolyCollection(list(grid.points[cells]), facecolors=faces, edgecolors="none"))
    _edges(axes, grid, grid.points, colour="#7d7d7d", width=_width(grid), alpha=1.0)
    names = folder.summary.get("bodies", [])
    handles: list[Artist] = [
        Patch(facecolor=_BODIES[i % len(_BODIES)], edgecolor="#7d7d7d", label=n) for i, n in enumerate(names)
    ]
    last = str(len(folder.summary["steps"]))
    for status, colour in STATUS_INK.items():
        own = [row for row in folder.rows if row["step"] == last and row["status"] == status]
        if own:
            x, y = [float(row["x"]) for row in own], [float(row["y"]) for row in own]
            handles += axes.plot(x, y, "o", ms=4, color=colour, label=f"contact node, {status}", zorder=3)
    axes.autoscale_view()
    axes.legend(handles=handles, fontsize=8.5, frameon=False, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    size = folder.summary["size"]
    words = f"{size['nodes']} nodes, {size['elements']} elements, {size['contact_pairs']} contact pairs"
    _finish(axes, folder.title, words)
    return figure


def drawn_factor(points: Array, displacement: Array) -> float:
    """What displacements are multiplied with: 1 where they can be seen, otherwise 1, 2 or 5 times a power of ten.

    >>> drawn_factor(np.array([[0.0, 0.0], [10.0, 0.0]]), np.array([[0.0, 0.001], [0.0, 0.0]]))
    200.0
    """
    size, largest = float(np.ptp(points, axis=0).max()), float(np.linalg.norm(displacement, axis=1).max())
    if largest == 0.0 or largest >= _SEEN * size:
        return 1.0
    wanted = 2.0 * _SEEN * size / largest
    power = 10.0 ** math.floor(math.log10(wanted))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted * (1.0 + 1e-12))


def _canvas(points: Array) -> tuple[Figure, Axes]:
    """A figure of the shape of the bodies."""
    from matplotlib.figure import Figure

    width, height = np.maximum(np.ptp(points, axis=0), 1e-300)
    shape = float(np.clip(height / width, 0.35, 1.4))
    figure = Figure(figsize=(8.4, 0.9 + 6.2 * shape), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal", anchor="W")
    return figure, axes


def _edges(axes: Axes, grid: Grid, points: Array, *, colour: str, width: float, alpha: float) -> None:
    from matplotlib.collections import PolyCollection

    for cells in grid.cells:
        lines = PolyCollection(list(points[cells]), facecolors="none", edgecolors=colour, linewidths=width, alpha=alpha)
        axes.add_collection(lines)


def _width(grid: Grid) -> float:
    """Thinner lines where there are more cells, none to speak of where they would cover everything."""
    count = sum(len(cells) for cells in grid.cells)
    return 0.7 if count < 500 else 0.4 if count < 3000 else 0.15 if count < 20000 else 0.0


def _finish(axes: Axes, title: str, words: str) -> None:
    for side in axes.spines.values():
        side.set_visible(False)
    axes.tick_params(colors=INK, labelsize=9)
    axes.set_xlabel("x", fontsize=10, color=INK)
    axes.set_ylabel("y", fontsize=10, color=INK)
    axes.set_title(f"{title}\n{words}" if title else words, fontsize=10.5, color=INK, loc="left")
